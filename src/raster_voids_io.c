/* Voids inside of the data are interpolated by GDALFillNodata.
 *
 * A void lies inside when its row or its column has heights on both sides of it that are no farther apart than the
 * fill distance. Both that rule and GDALFillNodata look no farther than the fill distance, so a margin of that
 * size makes a post's height the same in whatever region it is computed. */
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct box {
    int left, top, right, bottom; /* inclusive */
};

/* Marks the voids of a row or column that have heights at both ends of their run; `step` leads from post to post. */
static void mark_runs(const float *line_m, unsigned char *marks, int count, size_t step, int distance) {
    int run = 0;
    bool is_bounded = false;
    for (int i = 0; i < count; i++) {
        if (isnan(line_m[(size_t)i * step])) {
            run++;
            continue;
        }
        if (is_bounded && run > 0 && run <= distance)
            for (int k = i - run; k < i; k++) marks[(size_t)k * step] = 1;
        run = 0;
        is_bounded = true;
    }
}

/* The box around the marked posts of the inner part; false when there are none. */
static bool find_marked(const unsigned char *marks, int columns, int rows, int margin, struct box *box) {
    *box = (struct box){columns, rows, -1, -1};
    for (int row = margin; row < rows - margin; row++)
        for (int column = margin; column < columns - margin; column++)
            if (marks[(size_t)row * (size_t)columns + (size_t)column]) {
                if (column < box->left) box->left = column;
                if (column > box->right) box->right = column;
                if (row < box->top) box->top = row;
                if (row > box->bottom) box->bottom = row;
            }
    return box->right >= 0;
}

/* A band that lies on an array. */
static GDALRasterBandH add_band(GDALDatasetH dataset, GDALDataType type, void *first, size_t line_bytes) {
    char pointer[64], line[32];
    int length = CPLPrintPointer(pointer, first, sizeof pointer - 1);
    pointer[length] = '\0';
    snprintf(line, sizeof line, "%zu", line_bytes);
    char **options = CSLSetNameValue(NULL, "DATAPOINTER", pointer);
    options = CSLSetNameValue(options, "LINEOFFSET", line);
    CPLErr failed = GDALAddBand(dataset, type, options);
    CSLDestroy(options);
    return failed == CE_None ? GDALGetRasterBand(dataset, GDALGetRasterCount(dataset)) : NULL;
}

bool raster_fill_nodata(float *heights_m, unsigned char *valid, int stride, int columns, int rows, int distance) {
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("MEM"), "", columns, rows, 0, GDT_Float32, NULL);
    if (dataset == NULL) return false;
    GDALRasterBandH target = add_band(dataset, GDT_Float32, heights_m, (size_t)stride * sizeof *heights_m);
    GDALRasterBandH mask = add_band(dataset, GDT_Byte, valid, (size_t)stride);
    char **options = CSLSetNameValue(NULL, "TEMP_FILE_DRIVER", "MEM");
    bool is_filled =
        target != NULL && mask != NULL && GDALFillNodata(target, mask, distance, 0, 0, options, NULL, NULL) == CE_None;
    CSLDestroy(options);
    GDALClose(dataset);
    return is_filled;
}

static struct box grown(struct box box, int by, int columns, int rows) {
    box.left = box.left > by ? box.left - by : 0;
    box.top = box.top > by ? box.top - by : 0;
    box.right = box.right < columns - 1 - by ? box.right + by : columns - 1;
    box.bottom = box.bottom < rows - 1 - by ? box.bottom + by : rows - 1;
    return box;
}

enum scree_status raster_voids_fill(float *region_m, int columns, int rows, int margin, int distance,
                                    struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct raster_trap trap;
    raster_trap_set(&trap);
    size_t count = (size_t)columns * (size_t)rows;
    unsigned char *marks = calloc(count, 2);
    float *filled_m = NULL;
    if (marks == NULL) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory to fill voids");
        goto cleanup;
    }
    if (distance > 0) {
        for (int row = 0; row < rows; row++)
            mark_runs(region_m + (size_t)row * (size_t)columns, marks + (size_t)row * (size_t)columns, columns, 1,
                      distance);
        for (int column = 0; column < columns; column++)
            mark_runs(region_m + column, marks + column, rows, (size_t)columns, distance);
    }
    struct box box;
    if (find_marked(marks, columns, rows, margin, &box)) {
        unsigned char *valid = marks + count;
        filled_m = malloc(count * sizeof *filled_m);
        if (filled_m == NULL) {
            status = scree_fail(error, SCREE_E_MEMORY, "no memory to fill voids");
            goto cleanup;
        }
        memcpy(filled_m, region_m, count * sizeof *filled_m);
        for (size_t i = 0; i < count; i++) valid[i] = !isnan(region_m[i]);
        box = grown(box, margin, columns, rows);
        size_t first = (size_t)box.top * (size_t)columns + (size_t)box.left;
        if (!raster_fill_nodata(filled_m + first, valid + first, columns, box.right - box.left + 1,
                                box.bottom - box.top + 1, distance)) {
            status = raster_trap_fail(&trap, "filling voids", error);
            goto cleanup;
        }
    }
    for (int row = margin; row < rows - margin; row++)
        for (int column = margin; column < columns - margin; column++) {
            size_t i = (size_t)row * (size_t)columns + (size_t)column;
            if (marks[i]) region_m[i] = filled_m[i];
        }
cleanup:
    free(filled_m);
    free(marks);
    raster_trap_clear();
    return status;
}
