/* Best approximation by linear splines: see the header. */
#include "lod/spline_filter.h"

#include "lod/square.h"

/* Six times the normal equations of heights (not of coefficients, hence the halves of Algorithm 1): 2 4 4 ... 4 2 on
 * the diagonal, 1 beside it; on the right side these weights of the five nearest posts, and at either end of three. */
#define NEAR_WEIGHT  1.5
#define FAR_WEIGHT   0.25
#define OWN_WEIGHT   2.5
#define FIRST_WEIGHT 1.25

/* Half a line of an odd number of posts. */
static int32_t half(int32_t posts) {
    return posts / 2 + 1;
}

/* What the elimination divides by, for `count` unknowns. It depends on nothing else. */
static void find_ratios(int32_t count, double *ratio) {
    ratio[0] = 1.0 / 2;
    for (int32_t k = 1; k < count; k++) ratio[k] = 1 / ((k + 1 < count ? 4 : 2) - ratio[k - 1]);
}

/* One line of 2 * count - 1 posts becomes `count`; `solution` has room for them. */
static void coarsen_line(const double *fine, int32_t count, const double *ratio, double *solution, float *coarse) {
    const int32_t last = count - 1;
    solution[0] = (FIRST_WEIGHT * fine[0] + NEAR_WEIGHT * fine[1] + FAR_WEIGHT * fine[2]) * ratio[0];
    for (int32_t k = 1; k < last; k++) {
        const double *f = fine + 2 * k;
        const double right = FAR_WEIGHT * (f[-2] + f[2]) + NEAR_WEIGHT * (f[-1] + f[1]) + OWN_WEIGHT * f[0];
        solution[k] = (right - solution[k - 1]) * ratio[k];
    }
    const double *f = fine + 2 * last;
    const double right = FIRST_WEIGHT * f[0] + NEAR_WEIGHT * f[-1] + FAR_WEIGHT * f[-2];
    solution[last] = (right - solution[last - 1]) * ratio[last];
    coarse[last] = (float)solution[last];
    for (int32_t k = last - 1; k >= 0; k--) {
        solution[k] -= ratio[k] * solution[k + 1];
        coarse[k] = (float)solution[k];
    }
}

/* Every row; `line` has room for columns + 1 posts and their solution. */
static void coarsen_rows(const float *fine_m, int32_t columns, int32_t rows, const double *ratio, double *line,
                         float *coarse_m) {
    const int32_t count = half(columns);
    for (int32_t y = 0; y < rows; y++) {
        const float *row_m = fine_m + (size_t)y * (size_t)columns;
        for (int32_t x = 0; x < columns; x++) line[x] = row_m[x];
        if (columns % 2 == 0) line[columns] = 2 * line[columns - 1] - line[columns - 2];
        coarsen_line(line, count, ratio, line + columns + 1, coarse_m + (size_t)y * (size_t)count);
    }
}

/* A row's right side less the row before it, times its ratio, all columns at once. */
static void eliminate(const float *const near_m[5], const float *before_m, double ratio, int32_t columns, float *to_m) {
    for (int32_t x = 0; x < columns; x++) {
        const double right = FAR_WEIGHT * ((double)near_m[0][x] + near_m[4][x]) +
                             NEAR_WEIGHT * ((double)near_m[1][x] + near_m[3][x]) + OWN_WEIGHT * near_m[2][x];
        to_m[x] = (float)((right - before_m[x]) * ratio);
    }
}

static void eliminate_end(const float *own_m, const float *near_m, const float *far_m, const float *before_m,
                          double ratio, int32_t columns, float *to_m) {
    for (int32_t x = 0; x < columns; x++) {
        const double right = FIRST_WEIGHT * own_m[x] + NEAR_WEIGHT * near_m[x] + FAR_WEIGHT * far_m[x];
        to_m[x] = (float)((right - (before_m != NULL ? before_m[x] : 0)) * ratio);
    }
}

/* Every column, row after row, so that neighbours in memory are worked on together. `beyond_m` is a row of room. */
static void coarsen_columns(const float *fine_m, int32_t columns, int32_t rows, const double *ratio, float *beyond_m,
                            float *coarse_m) {
    const int32_t last = half(rows) - 1;
    const size_t width = (size_t)columns;
    const float *end_m = fine_m + 2 * (size_t)last * width;
    if (rows % 2 == 0) {
        const float *last_m = fine_m + (size_t)(rows - 1) * width;
        for (size_t x = 0; x < width; x++) beyond_m[x] = 2 * last_m[x] - last_m[x - width];
        end_m = beyond_m;
    }
    eliminate_end(fine_m, fine_m + width, rows > 2 ? fine_m + 2 * width : end_m, NULL, ratio[0], columns, coarse_m);
    for (int32_t k = 1; k < last; k++) {
        const float *f = fine_m + 2 * (size_t)k * width;
        const float *far_m = k + 1 < last ? f + 2 * width : end_m;
        const float *const near_m[5] = {f - 2 * width, f - width, f, f + width, far_m};
        float *to_m = coarse_m + (size_t)k * width;
        eliminate(near_m, to_m - width, ratio[k], columns, to_m);
    }
    float *to_m = coarse_m + (size_t)last * width;
    const float *f = fine_m + 2 * (size_t)last * width;
    eliminate_end(end_m, f - width, f - 2 * width, to_m - width, ratio[last], columns, to_m);
    for (int32_t k = last - 1; k >= 0; k--) {
        to_m = coarse_m + (size_t)k * width;
        for (size_t x = 0; x < width; x++) to_m[x] = (float)(to_m[x] - ratio[k] * to_m[x + width]);
    }
}

static enum scree_status coarsen(struct scree_memory *memory, const float *fine_m, int32_t columns, int32_t rows,
                                 struct spline *spline, struct scree_error *error) {
    static const char what[] = "the spline's heights";
    const int32_t wide = half(columns), high = half(rows), most = wide > high ? wide : high;
    double *ratio = scree_allocate(memory, (size_t)most, sizeof *ratio, what, error);
    double *line = scree_allocate(memory, (size_t)columns + 1 + (size_t)wide, sizeof *line, what, error);
    float *beyond_m = scree_allocate(memory, (size_t)wide, sizeof *beyond_m, what, error);
    float *middle_m = scree_allocate(memory, (size_t)wide * (size_t)rows, sizeof *middle_m, what, error);
    spline->heights_m = scree_allocate(memory, (size_t)wide * (size_t)high, sizeof *middle_m, what, error);
    const bool has_room =
        ratio != NULL && line != NULL && beyond_m != NULL && middle_m != NULL && spline->heights_m != NULL;
    if (has_room) {
        find_ratios(wide, ratio);
        coarsen_rows(fine_m, columns, rows, ratio, line, middle_m);
        find_ratios(high, ratio);
        coarsen_columns(middle_m, wide, rows, ratio, beyond_m, spline->heights_m);
    }
    scree_release(memory, middle_m);
    scree_release(memory, beyond_m);
    scree_release(memory, line);
    scree_release(memory, ratio);
    spline->columns = wide;
    spline->rows = high;
    return has_room ? SCREE_OK : SCREE_E_MEMORY;
}

enum scree_status spline_make(struct scree_memory *memory, const float *heights_m, int32_t columns, int32_t rows,
                              int32_t steps, struct spline *spline, struct scree_error *error) {
    *spline = (struct spline){.columns = columns, .rows = rows, .steps = steps};
    if (columns < 2 || rows < 2 || steps < 1 || steps > SPLINE_MAX_STEPS)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%d steps of splines over %d x %d posts: 1 to %d over 2 x 2 and more", (int)steps,
                          (int)columns, (int)rows, SPLINE_MAX_STEPS);
    enum scree_status status = SCREE_OK;
    for (int32_t step = 0; step < steps && status == SCREE_OK; step++) {
        float *fine_m = spline->heights_m;
        status = coarsen(memory, step == 0 ? heights_m : fine_m, spline->columns, spline->rows, spline, error);
        scree_release(memory, fine_m);
    }
    if (status != SCREE_OK) spline_release(memory, spline);
    return status;
}

void spline_release(struct scree_memory *memory, struct spline *spline) {
    scree_release(memory, spline->heights_m);
    *spline = (struct spline){.heights_m = NULL};
}

void spline_row(const struct spline *spline, int32_t row, int32_t columns, float *heights_m) {
    const int32_t span = 1 << spline->steps;
    const int32_t below = row >> spline->steps < spline->rows - 1 ? row >> spline->steps : spline->rows - 2;
    const float *south_m = spline->heights_m + (size_t)below * (size_t)spline->columns;
    const float *north_m = south_m + spline->columns;
    const float y = (float)(row - below * span) / (float)span, step = 1 / (float)span;
    for (int32_t x = 0, cell = 0; x < columns; cell++) {
        const bool is_last = cell == spline->columns - 2;
        const int32_t first = x, end = is_last || columns - x < span ? columns : x + span;
        const struct square square = square_of(south_m[cell], south_m[cell + 1], north_m[cell], north_m[cell + 1]);
        for (; x < end; x++) heights_m[x] = square_height_m(&square, (float)(x - first) * step, y);
    }
}
