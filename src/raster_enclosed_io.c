/* Voids wider than the fill distance, yet enclosed by data (large lakes, radar shadow): no pits there either.
 *
 * While inputs are scanned, each group's heights are averaged into a coarse grid of cells. Empty cells that reach the
 * grid's border are outside of the data; the other empty ones are enclosed, and GDALFillNodata interpolates them from
 * their surroundings. What nothing else fills takes its height from there, except next to the outside. */
#include "src/raster_parts_io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CELLS = 256 }; /* along the longer side */

enum scree_status raster_enclosed_make(struct raster_group *group, struct scree_error *error) {
    struct raster_enclosed *enclosed = &group->enclosed;
    int longest = group->columns > group->rows ? group->columns : group->rows;
    enclosed->cell = (longest - 1) / MOST_CELLS + 1;
    enclosed->columns = (group->columns - 1) / enclosed->cell + 1;
    enclosed->rows = (group->rows - 1) / enclosed->cell + 1;
    size_t count = (size_t)enclosed->columns * (size_t)enclosed->rows;
    enclosed->sums_m = calloc(count, sizeof *enclosed->sums_m);
    enclosed->counts = calloc(count, sizeof *enclosed->counts);
    if (enclosed->sums_m == NULL || enclosed->counts == NULL)
        return scree_fail(error, SCREE_E_MEMORY, "no memory to look for voids");
    return SCREE_OK;
}

void raster_enclosed_free(struct raster_enclosed *enclosed) {
    free(enclosed->sums_m);
    free(enclosed->counts);
    free(enclosed->heights_m);
    *enclosed = (struct raster_enclosed){0};
}

void raster_enclosed_add(struct raster_group *group, int column, int row, int columns, int rows,
                         const float *heights_m) {
    struct raster_enclosed *enclosed = &group->enclosed;
    int cell = enclosed->cell;
    for (int j = 0; j < rows; j++) {
        const float *line_m = heights_m + (size_t)j * (size_t)columns;
        size_t cells = (size_t)((row + j) / cell) * (size_t)enclosed->columns;
        for (int i = 0; i < columns;) {
            int at = (column + i) % group->columns; /* the repeated column of a closed turn is its first one */
            int end = i + cell - at % cell;
            if (end > columns) end = columns;
            if (end > i + group->columns - at) end = i + group->columns - at;
            double sum_m = 0;
            uint64_t count = 0;
            for (; i < end; i++)
                if (!isnan(line_m[i])) {
                    sum_m += line_m[i];
                    count++;
                }
            enclosed->sums_m[cells + (size_t)(at / cell)] += sum_m;
            enclosed->counts[cells + (size_t)(at / cell)] += count;
            enclosed->valid += count;
        }
    }
}

/* Marks the empty cells that are connected with the border; columns that go around the globe have none. */
static bool mark_outside(const struct raster_group *group, unsigned char *outside) {
    const struct raster_enclosed *enclosed = &group->enclosed;
    int columns = enclosed->columns, rows = enclosed->rows;
    size_t count = (size_t)columns * (size_t)rows, waiting = 0;
    size_t *stack = malloc(count * sizeof *stack);
    if (stack == NULL) return false;
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            bool is_side = !group->is_around && (column == 0 || column == columns - 1);
            size_t i = (size_t)row * (size_t)columns + (size_t)column;
            if ((!is_side && row > 0 && row < rows - 1) || enclosed->counts[i] > 0) continue;
            outside[i] = 1;
            stack[waiting++] = i;
        }
    while (waiting > 0) {
        size_t i = stack[--waiting];
        int at_row = (int)(i / (size_t)columns), at_column = (int)(i % (size_t)columns);
        for (int k = 0; k < 9; k++) {
            int row = at_row + k / 3 - 1, column = at_column + k % 3 - 1;
            if (group->is_around) column = (column + columns) % columns;
            if (row < 0 || row >= rows || column < 0 || column >= columns) continue;
            size_t next = (size_t)row * (size_t)columns + (size_t)column;
            if (outside[next] || enclosed->counts[next] > 0) continue;
            outside[next] = 1;
            stack[waiting++] = next;
        }
    }
    free(stack);
    return true;
}

static bool touches_outside(const struct raster_group *group, const unsigned char *outside, int at_column, int at_row) {
    int columns = group->enclosed.columns, rows = group->enclosed.rows;
    for (int k = 0; k < 9; k++) {
        int row = at_row + k / 3 - 1, column = at_column + k % 3 - 1;
        if (group->is_around) column = (column + columns) % columns;
        if (row < 0 || row >= rows || column < 0 || column >= columns) continue;
        if (outside[(size_t)row * (size_t)columns + (size_t)column]) return true;
    }
    return false;
}

enum scree_status raster_enclosed_finish(struct raster_group *group, struct scree_error *error) {
    struct raster_enclosed *enclosed = &group->enclosed;
    size_t count = (size_t)enclosed->columns * (size_t)enclosed->rows;
    enum scree_status status = SCREE_OK;
    unsigned char *flags = NULL;
    float *heights_m = NULL;
    if (enclosed->valid == 0 || enclosed->valid >= (uint64_t)group->columns * (uint64_t)group->rows) {
        raster_enclosed_free(enclosed); /* nothing to fill from, or nothing to fill */
        return SCREE_OK;
    }
    flags = calloc(count, 2);
    heights_m = malloc(count * sizeof *heights_m);
    if (flags == NULL || heights_m == NULL || !mark_outside(group, flags)) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory to look for voids");
        goto cleanup;
    }
    unsigned char *outside = flags, *valid = flags + count;
    for (size_t i = 0; i < count; i++) {
        valid[i] = enclosed->counts[i] > 0;
        heights_m[i] = valid[i] ? (float)(enclosed->sums_m[i] / (double)enclosed->counts[i]) : NAN;
    }
    if (!raster_fill_nodata(heights_m, valid, enclosed->columns, enclosed->columns, enclosed->rows, 2 * MOST_CELLS)) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory to fill voids");
        goto cleanup;
    }
    for (int row = 0; row < enclosed->rows; row++)
        for (int column = 0; column < enclosed->columns; column++)
            if (touches_outside(group, outside, column, row))
                heights_m[(size_t)row * (size_t)enclosed->columns + (size_t)column] = NAN;
    free(enclosed->sums_m);
    free(enclosed->counts);
    enclosed->sums_m = NULL;
    enclosed->counts = NULL;
    enclosed->heights_m = heights_m;
    heights_m = NULL;
cleanup:
    free(heights_m);
    free(flags);
    return status;
}

static int clamped(int value, int top) {
    return value < 0 ? 0 : value > top ? top : value;
}

void raster_enclosed_read(const struct raster_group *group, int column, int row, int columns, int rows,
                          float *heights_m) {
    const struct raster_enclosed *enclosed = &group->enclosed;
    for (int j = 0; j < rows; j++) {
        double v = (row + j + 0.5) / enclosed->cell - 0.5;
        int low = (int)floor(v);
        const float *south_m =
            enclosed->heights_m + (size_t)clamped(low, enclosed->rows - 1) * (size_t)enclosed->columns;
        const float *north_m =
            enclosed->heights_m + (size_t)clamped(low + 1, enclosed->rows - 1) * (size_t)enclosed->columns;
        for (int i = 0; i < columns; i++) {
            double u = (column + i + 0.5) / enclosed->cell - 0.5;
            int left = (int)floor(u);
            int west = clamped(left, enclosed->columns - 1), east = clamped(left + 1, enclosed->columns - 1);
            double along = u - left, up = v - low;
            heights_m[(size_t)j * (size_t)columns + (size_t)i] =
                (float)((south_m[west] * (1 - along) + south_m[east] * along) * (1 - up) +
                        (north_m[west] * (1 - along) + north_m[east] * along) * up);
        }
    }
}
