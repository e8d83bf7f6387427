#include "lod/slopes.h"

#include <stdbool.h>

#define LEAST_STEP_M 1e-3 /* at a pole eastward steps have no length, and no slope can be told */

enum scree_status slope_grid_allocate(struct scree_memory *memory, int32_t columns, int32_t rows, int32_t node_span,
                                      struct slope_grid *grid, struct scree_error *error) {
    *grid = (struct slope_grid){columns, rows, node_span, NULL};
    grid->nodes = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *grid->nodes, "a tile's slopes", error);
    return grid->nodes != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

void slope_grid_release(struct scree_memory *memory, struct slope_grid *grid) {
    scree_release(memory, grid->nodes);
    *grid = (struct slope_grid){0, 0, 0, NULL};
}

void slope_grid_from_posts(struct slope_grid *grid, const float *heights_m, int32_t stride, const double *east_m,
                           const double *north_m) {
    for (int32_t y = 0; y < grid->rows; y++) {
        float by_east = east_m[y] > LEAST_STEP_M ? (float)(0.5 / east_m[y]) : 0;
        float by_north = (float)(0.5 / north_m[y]);
        const float *row = heights_m + (int64_t)y * stride;
        struct slope *nodes = grid->nodes + (int64_t)y * grid->columns;
        for (int32_t x = 0; x < grid->columns; x++)
            nodes[x] =
                (struct slope){(row[x + 1] - row[x - 1]) * by_east, (row[x + stride] - row[x - stride]) * by_north};
    }
}

static struct slope node(const struct slope_grid *grid, int32_t x, int32_t y) {
    return grid->nodes[(int64_t)y * grid->columns + x];
}

static struct slope mean121(struct slope a, struct slope b, struct slope c) {
    return (struct slope){(a.east + 2 * b.east + c.east) * 0.25f, (a.north + 2 * b.north + c.north) * 0.25f};
}

static struct slope mean_along_row(const struct slope_grid *grid, int32_t x, int32_t y) {
    if (x == 0 || x == grid->columns - 1) return node(grid, x, y);
    return mean121(node(grid, x - 1, y), node(grid, x, y), node(grid, x + 1, y));
}

void slope_grid_reduce(const struct slope_grid *fine, struct slope_grid *coarse) {
    for (int32_t row = 0; row < coarse->rows; row++) {
        for (int32_t column = 0; column < coarse->columns; column++) {
            int32_t x = 2 * column, y = 2 * row;
            bool on_row = y == 0 || y == fine->rows - 1, on_column = x == 0 || x == fine->columns - 1;
            struct slope *at = &coarse->nodes[(int64_t)row * coarse->columns + column];
            if (on_row)
                *at = mean_along_row(fine, x, y);
            else if (on_column)
                *at = mean121(node(fine, x, y - 1), node(fine, x, y), node(fine, x, y + 1));
            else
                *at =
                    mean121(mean_along_row(fine, x, y - 1), mean_along_row(fine, x, y), mean_along_row(fine, x, y + 1));
        }
    }
}

void slope_grid_place(const struct slope_grid *child, int32_t column, int32_t row, struct slope_grid *grid) {
    for (int32_t y = 0; y < child->rows && row + y < grid->rows; y++)
        for (int32_t x = 0; x < child->columns && column + x < grid->columns; x++)
            grid->nodes[(int64_t)(row + y) * grid->columns + column + x] = node(child, x, y);
}

/* The node at or before a position, and how far beyond it the position lies. */
static int32_t split(int32_t position, int32_t span, int32_t count, float *weight) {
    int32_t at = position / span;
    *weight = (float)(position % span) / (float)span;
    if (at < count - 1) return at;
    *weight = 0;
    return count - 1;
}

static struct slope mix(struct slope a, struct slope b, float weight) {
    return (struct slope){a.east + (b.east - a.east) * weight, a.north + (b.north - a.north) * weight};
}

/* The slope within the cell of node (column, row), `right` and `up` cells from it. */
static struct slope within(const struct slope_grid *grid, int32_t column, int32_t row, float right, float up) {
    int32_t next_column = right > 0 ? column + 1 : column, next_row = up > 0 ? row + 1 : row;
    struct slope low = mix(node(grid, column, row), node(grid, next_column, row), right);
    struct slope high = mix(node(grid, column, next_row), node(grid, next_column, next_row), right);
    return mix(low, high, up);
}

struct slope slope_grid_at(const struct slope_grid *grid, int32_t x, int32_t y) {
    float right, up;
    int32_t column = split(x, grid->node_span, grid->columns, &right), row = split(y, grid->node_span, grid->rows, &up);
    return within(grid, column, row, right, up);
}

static int32_t split_between(double position, int32_t span, int32_t count, float *weight) {
    int32_t at = (int32_t)(position / span);
    *weight = (float)(position / span - at);
    if (at < count - 1) return at;
    *weight = 0;
    return count - 1;
}

struct slope slope_grid_between(const struct slope_grid *grid, double x, double y) {
    float right, up;
    int32_t column = split_between(x, grid->node_span, grid->columns, &right);
    int32_t row = split_between(y, grid->node_span, grid->rows, &up);
    return within(grid, column, row, right, up);
}
