/* picture: what tests ask of pictures.
 *     picture count FILE RRGGBB    prints how many pixels have just this colour
 *     picture differ FILE FILE     prints the mean difference of all channels (0 .. 255) and the share, in percent, of
 *                                  pixels of which one differs by more than 16
 *     picture spread FILE          prints how many different colours there are
 * Exit code 1 and a line of what is wrong when a picture cannot be read or two have different sizes. */
#include <gdal.h>

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct picture {
    int width, height;
    uint8_t *pixels; /* three bytes each, row by row */
};

static bool read_picture(const char *path, struct picture *picture) {
    *picture = (struct picture){0};
    GDALDatasetH file = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    bool is_read = false;
    if (file == NULL || GDALGetRasterCount(file) < 3) goto cleanup;
    picture->width = GDALGetRasterXSize(file);
    picture->height = GDALGetRasterYSize(file);
    picture->pixels = calloc((size_t)picture->width * (size_t)picture->height, 3);
    if (picture->pixels == NULL) goto cleanup;
    is_read =
        GDALDatasetRasterIOEx(file, GF_Read, 0, 0, picture->width, picture->height, picture->pixels, picture->width,
                              picture->height, GDT_Byte, 3, NULL, 3, 3 * (GSpacing)picture->width, 1, NULL) == CE_None;
cleanup:
    if (!is_read) printf("%s: no picture\n", path);
    if (file != NULL) GDALClose(file);
    return is_read;
}

static uint32_t colour_at(const struct picture *picture, size_t index) {
    const uint8_t *pixel = picture->pixels + 3 * index;
    return (uint32_t)pixel[0] << 16 | (uint32_t)pixel[1] << 8 | pixel[2];
}

static size_t pixel_count(const struct picture *picture) {
    return (size_t)picture->width * (size_t)picture->height;
}

static int compare_colours(const void *left, const void *right) {
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

static void print_count(const struct picture *picture, uint32_t colour) {
    size_t count = 0;
    for (size_t i = 0; i < pixel_count(picture); i++) count += colour_at(picture, i) == colour;
    printf("%zu\n", count);
}

static bool print_spread(const struct picture *picture) {
    size_t count = pixel_count(picture), different = 1;
    uint32_t *colours = calloc(count, sizeof *colours);
    if (colours == NULL) return false;
    for (size_t i = 0; i < count; i++) colours[i] = colour_at(picture, i);
    qsort(colours, count, sizeof *colours, compare_colours); /* equal ones are the same: their order does not matter */
    for (size_t i = 1; i < count; i++) different += colours[i] != colours[i - 1];
    printf("%zu\n", different);
    free(colours);
    return true;
}

static bool print_difference(const struct picture *a, const struct picture *b) {
    if (a->width != b->width || a->height != b->height) {
        printf("the pictures have different sizes\n");
        return false;
    }
    uint64_t sum = 0;
    size_t count = pixel_count(a), far = 0;
    for (size_t i = 0; i < count; i++) {
        int most = 0;
        for (int channel = 0; channel < 3; channel++) {
            int difference = abs(a->pixels[3 * i + (size_t)channel] - b->pixels[3 * i + (size_t)channel]);
            sum += (uint64_t)difference;
            if (difference > most) most = difference;
        }
        far += most > 16;
    }
    printf("%.5f %.4f\n", (double)sum / (3.0 * (double)count), 100.0 * (double)far / (double)count);
    return true;
}

int main(int argc, char **argv) {
    struct picture a = {0}, b = {0};
    bool is_fine = false;
    GDALAllRegister();
    if (argc == 4 && strcmp(argv[1], "count") == 0) {
        is_fine = read_picture(argv[2], &a);
        if (is_fine) print_count(&a, (uint32_t)strtoul(argv[3], NULL, 16));
    } else if (argc == 4 && strcmp(argv[1], "differ") == 0) {
        is_fine = read_picture(argv[2], &a) && read_picture(argv[3], &b) && print_difference(&a, &b);
    } else if (argc == 3 && strcmp(argv[1], "spread") == 0) {
        is_fine = read_picture(argv[2], &a) && print_spread(&a);
    } else {
        printf("Usage: picture count FILE RRGGBB | differ FILE FILE | spread FILE\n");
    }
    free(a.pixels);
    free(b.pixels);
    return is_fine ? 0 : 1;
}
