#include "lod/cloud.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define FIRST_POINTS      4096
#define POINTS_A_SQUARE   8
#define LEAST_NEIGHBOURS  4
#define MOST_SQUARES_SIDE 2147483647.0

void cloud_release(struct cloud *cloud) {
    scree_release(cloud->memory, cloud->points);
    *cloud = (struct cloud){.memory = cloud->memory};
}

enum scree_status cloud_add(struct cloud *cloud, struct cloud_point point, struct scree_error *error) {
    if (cloud->count == CLOUD_MOST_POINTS)
        return scree_fail(error, SCREE_E_LIMIT, "more than %d points", CLOUD_MOST_POINTS);
    if (cloud->count == cloud->capacity) {
        uint32_t capacity = cloud->capacity == 0 ? FIRST_POINTS : cloud->capacity + cloud->capacity / 2;
        struct cloud_point *points =
            scree_reallocate(cloud->memory, cloud->points, capacity, sizeof *points, "the points of a cloud", error);
        if (points == NULL) return error->status;
        cloud->points = points;
        cloud->capacity = capacity;
    }
    cloud->points[cloud->count++] = point;
    return SCREE_OK;
}

void cloud_bounds(const struct cloud *cloud, double bounds[4]) {
    bounds[0] = bounds[2] = cloud->points[0].x;
    bounds[1] = bounds[3] = cloud->points[0].y;
    for (uint32_t i = 1; i < cloud->count; i++) {
        bounds[0] = fmin(bounds[0], cloud->points[i].x);
        bounds[1] = fmin(bounds[1], cloud->points[i].y);
        bounds[2] = fmax(bounds[2], cloud->points[i].x);
        bounds[3] = fmax(bounds[3], cloud->points[i].y);
    }
}

static int compare(double a, double b) {
    return (a > b) - (a < b);
}

/* Two points that are equal in all of this are the same, whichever comes first. */
static int compare_points(const struct cloud_point *a, const struct cloud_point *b) {
    int order = compare(a->z, b->z);
    if (order == 0) order = compare(a->y, b->y);
    return order != 0 ? order : compare(a->x, b->x);
}

/* ---- thinning ---- */

struct placed_point {
    int32_t column, row;
    double distance2; /* to the square's centre, in squares */
    struct cloud_point point;
};

static int compare_placed(const void *first, const void *second) {
    const struct placed_point *a = first, *b = second;
    if (a->row != b->row) return a->row < b->row ? -1 : 1;
    if (a->column != b->column) return a->column < b->column ? -1 : 1;
    int order = compare(a->distance2, b->distance2);
    return order != 0 ? order : compare_points(&a->point, &b->point);
}

enum scree_status cloud_thin(struct cloud *cloud, double side, struct scree_error *error) {
    if (cloud->count == 0) return SCREE_OK;
    struct placed_point *placed =
        scree_allocate(cloud->memory, cloud->count, sizeof *placed, "the points to thin", error);
    if (placed == NULL) return error->status;
    enum scree_status status = SCREE_OK;
    for (uint32_t i = 0; i < cloud->count; i++) {
        double x = cloud->points[i].x / side, y = cloud->points[i].y / side;
        if (!(fabs(x) < MOST_SQUARES_SIDE && fabs(y) < MOST_SQUARES_SIDE)) {
            status = scree_fail(error, SCREE_E_ARGUMENT, "squares of %g are too small to thin points at %g %g", side,
                                cloud->points[i].x, cloud->points[i].y);
            goto cleanup;
        }
        double dx = x - floor(x) - 0.5, dy = y - floor(y) - 0.5;
        placed[i] = (struct placed_point){(int32_t)floor(x), (int32_t)floor(y), dx * dx + dy * dy, cloud->points[i]};
    }
    qsort(placed, cloud->count, sizeof *placed, compare_placed);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < cloud->count; i++)
        if (i == 0 || placed[i].column != placed[i - 1].column || placed[i].row != placed[i - 1].row)
            cloud->points[kept++] = placed[i].point;
    cloud->count = kept;
cleanup:
    scree_release(cloud->memory, placed);
    return status;
}

/* ---- outliers ---- */

struct squares {
    double west, south, side;
    uint32_t columns, rows;
    uint32_t *start; /* of each square in `members`; one more than there are squares */
    uint32_t *members;
    double *heights; /* room for all */
};

static uint32_t square_of(const struct squares *squares, const struct cloud_point *point) {
    uint32_t column = (uint32_t)((point->x - squares->west) / squares->side);
    uint32_t row = (uint32_t)((point->y - squares->south) / squares->side);
    return row * squares->columns + column;
}

/* Squares so large that there are never more of them than points, or few. */
static void choose_squares(const struct cloud *cloud, struct squares *squares) {
    double bounds[4];
    cloud_bounds(cloud, bounds);
    double width = bounds[2] - bounds[0], height = bounds[3] - bounds[1],
           share = (double)POINTS_A_SQUARE / cloud->count;
    double side = fmax(sqrt(width * height * share), fmax(width, height) * share);
    if (!(side > 0)) side = 1;
    squares->west = bounds[0];
    squares->south = bounds[1];
    squares->side = side;
    squares->columns = (uint32_t)(width / side) + 1;
    squares->rows = (uint32_t)(height / side) + 1;
}

static void sort_into_squares(const struct cloud *cloud, struct squares *squares) {
    uint32_t count = squares->columns * squares->rows;
    for (uint32_t i = 0; i < cloud->count; i++) squares->start[square_of(squares, &cloud->points[i])]++;
    uint32_t sum = 0;
    for (uint32_t s = 0; s <= count; s++) {
        uint32_t here = s < count ? squares->start[s] : 0;
        squares->start[s] = sum;
        sum += here;
    }
    for (uint32_t i = 0; i < cloud->count; i++)
        squares->members[squares->start[square_of(squares, &cloud->points[i])]++] = i;
    for (uint32_t s = count; s > 0; s--) squares->start[s] = squares->start[s - 1];
    squares->start[0] = 0;
}

static int compare_heights(const void *a, const void *b) {
    return compare(*(const double *)a, *(const double *)b);
}

/* The median height around a square; false: there are too few points. */
static bool find_median(const struct cloud *cloud, struct squares *squares, uint32_t column, uint32_t row,
                        double *median) {
    uint32_t count = 0;
    for (uint32_t y = row == 0 ? 0 : row - 1; y <= row + 1 && y < squares->rows; y++)
        for (uint32_t x = column == 0 ? 0 : column - 1; x <= column + 1 && x < squares->columns; x++) {
            uint32_t square = y * squares->columns + x;
            for (uint32_t i = squares->start[square]; i < squares->start[square + 1]; i++)
                squares->heights[count++] = cloud->points[squares->members[i]].z;
        }
    if (count < LEAST_NEIGHBOURS) return false;
    qsort(squares->heights, count, sizeof *squares->heights, compare_heights);
    *median = squares->heights[count / 2];
    return true;
}

/* Judges every point by what is around its square. */
static void mark_outliers(struct cloud *cloud, struct squares *squares, double distance, bool *is_outlier) {
    for (uint32_t row = 0; row < squares->rows; row++)
        for (uint32_t column = 0; column < squares->columns; column++) {
            uint32_t square = row * squares->columns + column;
            double median;
            if (squares->start[square] == squares->start[square + 1] ||
                !find_median(cloud, squares, column, row, &median))
                continue;
            for (uint32_t i = squares->start[square]; i < squares->start[square + 1]; i++)
                is_outlier[squares->members[i]] = fabs(cloud->points[squares->members[i]].z - median) > distance;
        }
}

enum scree_status cloud_drop_outliers(struct cloud *cloud, double distance, struct scree_error *error) {
    static const char what[] = "the neighbours of a cloud's points";
    struct squares squares = {0};
    bool *is_outlier = NULL;
    enum scree_status status = SCREE_OK;
    if (cloud->count == 0) return SCREE_OK;
    choose_squares(cloud, &squares);
    size_t count = (size_t)squares.columns * squares.rows;
    squares.start = scree_allocate(cloud->memory, count + 1, sizeof *squares.start, what, error);
    squares.members = scree_allocate(cloud->memory, cloud->count, sizeof *squares.members, what, error);
    squares.heights = scree_allocate(cloud->memory, cloud->count, sizeof *squares.heights, what, error);
    is_outlier = scree_allocate(cloud->memory, cloud->count, sizeof *is_outlier, what, error);
    if (squares.start == NULL || squares.members == NULL || squares.heights == NULL || is_outlier == NULL) {
        status = error->status;
        goto cleanup;
    }
    sort_into_squares(cloud, &squares);
    mark_outliers(cloud, &squares, distance, is_outlier);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < cloud->count; i++)
        if (!is_outlier[i]) cloud->points[kept++] = cloud->points[i];
    cloud->count = kept;
cleanup:
    scree_release(cloud->memory, is_outlier);
    scree_release(cloud->memory, squares.heights);
    scree_release(cloud->memory, squares.members);
    scree_release(cloud->memory, squares.start);
    return status;
}
