/* fractal_las: writes points of the fractal terrain of tests/fractal.h, nowhere regular, as a LAS 1.2 file: three of
 * four on the ground (class 2), every fourth on a tree 12 m above it (class 5, first of two returns). */
#include "lod/counter_random.h"
#include "tests/fractal.h"
#include "tests/las_maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POST_M 30 /* of the fractal */
#define TREE_M 12

static const char help[] = "Usage: fractal_las -o FILE.las [options]\n"
                           "Writes points of seeded fractal terrain, in EPSG:32611.\n"
                           "  --points N     about so many (100000)\n"
                           "  --spacing-m M  mean distance between them (2)\n"
                           "  --epsg N       another CRS\n";

static struct {
    uint32_t side; /* points a side */
    double spacing_m;
    int32_t posts; /* a side */
    float *heights_m;
} terrain;

static double chance(uint64_t counter) {
    return (double)(counter_random(1, counter) >> 11) * 0x1p-53;
}

static double height_at(double x_m, double y_m) {
    int32_t column = (int32_t)(x_m / POST_M), row = (int32_t)(y_m / POST_M);
    const float *h = &terrain.heights_m[row * terrain.posts + column];
    double u = x_m / POST_M - column, v = y_m / POST_M - row;
    return (1 - v) * ((1 - u) * h[0] + u * h[1]) + v * ((1 - u) * h[terrain.posts] + u * h[terrain.posts + 1]);
}

static struct las_point point_of(uint32_t i) {
    double x_m = terrain.spacing_m * (i % terrain.side + chance(2 * (uint64_t)i));
    double y_m = terrain.spacing_m * (i / terrain.side + chance(2 * (uint64_t)i + 1));
    bool is_tree = i % 4 == 3;
    return (struct las_point){.x = 400000 + x_m,
                              .y = 3800000 + y_m,
                              .z = height_at(x_m, y_m) + (is_tree ? TREE_M : 0),
                              .class_number = is_tree ? 5 : 2,
                              .return_number = 1,
                              .return_count = is_tree ? 2 : 1};
}

int main(int argc, char **argv) {
    const char *path = NULL;
    double points = 100000;
    struct fractal fractal = {.seed = 1};
    struct las_fixture fixture = {
        .version_minor = 2, .point_format = 1, .point = point_of, .scale = 0.01, .offset = {400000, 3800000, 0}};
    fixture.epsg = 32611;
    terrain.spacing_m = 2;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "-o") == 0) path = argv[i + 1];
        if (strcmp(argv[i], "--points") == 0) points = strtod(argv[i + 1], NULL);
        if (strcmp(argv[i], "--spacing-m") == 0) terrain.spacing_m = strtod(argv[i + 1], NULL);
        if (strcmp(argv[i], "--epsg") == 0) fixture.epsg = (int)strtol(argv[i + 1], NULL, 10);
    }
    if (path == NULL || !(points >= 4 && points <= 1e8) || !(terrain.spacing_m > 0 && terrain.spacing_m < 1000)) {
        fputs(help, stderr);
        return 2;
    }
    terrain.side = (uint32_t)sqrt(points);
    fixture.count = terrain.side * terrain.side;
    terrain.posts = (int32_t)(terrain.side * terrain.spacing_m / POST_M) + 2;
    terrain.heights_m = malloc(sizeof *terrain.heights_m * (size_t)terrain.posts * (size_t)terrain.posts);
    if (terrain.heights_m == NULL) return 99;
    fractal_window(&fractal, 0, 0, terrain.posts, terrain.posts, terrain.heights_m, terrain.posts);
    size_t size;
    unsigned char *bytes = las_make(&fixture, &size);
    FILE *file = fopen(path, "wb");
    bool is_written = file != NULL && fwrite(bytes, 1, size, file) == size;
    is_written = (file == NULL || fclose(file) == 0) && is_written;
    if (!is_written) fprintf(stderr, "fractal_las: %s cannot be written\n", path);
    free(bytes);
    free(terrain.heights_m);
    return is_written ? 0 : 1;
}
