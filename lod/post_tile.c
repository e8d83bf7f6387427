#include "lod/post_tile.h"

#include "lod/extremes.h"
#include "lod/tile_lines.h"

#include <string.h>

static int64_t post_count(const struct post_tile *tile) {
    return (int64_t)(tile->columns + 1) * (tile->rows + 1);
}

/* The beginning of every tile: room for posts and slopes. */
static enum scree_status start(struct scree_memory *memory, const struct tile_geometry *geometry,
                               struct post_tile *tile, struct scree_error *error) {
    memset(tile, 0, sizeof *tile);
    tile->memory = memory;
    tile->columns = extremes_cells(geometry->columns, geometry->cell_span);
    tile->rows = extremes_cells(geometry->rows, geometry->cell_span);
    tile->cell_span = geometry->cell_span;
    tile->width = geometry->columns;
    tile->height = geometry->rows;
    tile->locked_step = geometry->locked_step;
    tile->heights_m = scree_allocate(memory, (size_t)post_count(tile), sizeof *tile->heights_m, "posts", error);
    if (tile->heights_m == NULL) return SCREE_E_MEMORY;
    /* nodes of slopes are at whole cells only */
    return slope_grid_allocate(memory, geometry->columns / geometry->cell_span + 1,
                               geometry->rows / geometry->cell_span + 1, geometry->cell_span, &tile->slopes, error);
}

static void start_line(struct post_tile *tile, const struct tile_geometry *geometry, enum tile_side side, int32_t step,
                       const float *heights_m, int32_t stride) {
    int32_t length = side == SIDE_SOUTH || side == SIDE_NORTH ? geometry->columns : geometry->rows;
    tile_line_start(&tile->lines[side], length, step, geometry->side_drop_m[side], geometry->height_unit_m, heights_m,
                    stride);
}

enum scree_status post_tile_from_posts(struct scree_memory *memory, const struct tile_geometry *geometry,
                                       const struct tile_posts *posts, struct post_tile *tile,
                                       struct scree_error *error) {
    int32_t across = geometry->columns + 1;
    enum scree_status status = start(memory, geometry, tile, error);
    if (status != SCREE_OK) {
        post_tile_release(tile);
        return status;
    }
    for (int32_t y = 0; y <= geometry->rows; y++)
        memcpy(tile->heights_m + (int64_t)y * across, posts->heights_m + (int64_t)y * posts->stride,
               (size_t)across * sizeof *tile->heights_m);
    start_line(tile, geometry, SIDE_SOUTH, 1, tile->heights_m, 1);
    start_line(tile, geometry, SIDE_EAST, 1, tile->heights_m + geometry->columns, across);
    start_line(tile, geometry, SIDE_NORTH, 1, tile->heights_m + (int64_t)geometry->rows * across, 1);
    start_line(tile, geometry, SIDE_WEST, 1, tile->heights_m, across);
    slope_grid_from_posts(&tile->slopes, posts->heights_m, posts->stride, posts->east_m, posts->north_m);
    return SCREE_OK;
}

enum scree_status post_tile_from_level(struct scree_memory *memory, const struct tile_geometry *geometry, int32_t step,
                                       double height_m, struct post_tile *tile, struct scree_error *error) {
    float height = (float)height_m;
    enum scree_status status = start(memory, geometry, tile, error);
    if (status != SCREE_OK) {
        post_tile_release(tile);
        return status;
    }
    for (int64_t i = 0; i < post_count(tile); i++) tile->heights_m[i] = height;
    for (int side = 0; side < SIDE_COUNT; side++) start_line(tile, geometry, (enum tile_side)side, step, &height, 0);
    return SCREE_OK;
}

/* ---- from children ---- */

/* The side of a child, in lattice steps: it is where the other children begin. */
static int32_t side_of(const struct post_tile *const children[4]) {
    if (children[1] != NULL) return children[0]->width;
    if (children[2] != NULL) return children[0]->height;
    return children[0]->width > children[0]->height ? children[0]->width : children[0]->height;
}

static void place_posts(const struct post_tile *child, int32_t column, int32_t row, struct post_tile *tile) {
    for (int32_t y = 0; y <= child->rows; y++)
        memcpy(tile->heights_m + (int64_t)(row + y) * (tile->columns + 1) + column,
               child->heights_m + (int64_t)y * (child->columns + 1),
               ((size_t)child->columns + 1) * sizeof *tile->heights_m);
}

enum scree_status post_tile_from_children(struct scree_memory *memory, const struct tile_geometry *geometry,
                                          const struct post_tile *const children[4], struct post_tile *tile,
                                          struct scree_error *error) {
    const struct border_line *lines[4];
    int32_t child_span = side_of(children), span = geometry->cell_span;
    enum scree_status status = start(memory, geometry, tile, error);
    for (int i = 0; i < 4; i++) {
        lines[i] = children[i] != NULL ? children[i]->lines : NULL;
        if (children[i] == NULL || status != SCREE_OK) continue;
        int32_t column = i % 2 * child_span / span, row = i / 2 * child_span / span;
        place_posts(children[i], column, row, tile);
        slope_grid_place(&children[i]->slopes, column, row, &tile->slopes);
    }
    if (status == SCREE_OK)
        status = tile_lines_join(lines, child_span, span, false, geometry->side_drop_m, tile->lines, error);
    if (status != SCREE_OK) post_tile_release(tile);
    return status;
}

/* ---- on the way up ---- */

static int32_t every_second(int32_t index, int32_t last) {
    return 2 * index < last ? 2 * index : last;
}

enum scree_status post_tile_hand_up_new(const struct post_tile *tile, struct post_tile **coarse,
                                        struct scree_error *error) {
    struct post_tile *half = scree_allocate(tile->memory, 1, sizeof *half, "a tile's remains", error);
    if (half == NULL) return SCREE_E_MEMORY;
    *half = *tile;
    half->columns = (tile->columns + 1) / 2;
    half->rows = (tile->rows + 1) / 2;
    half->cell_span = 2 * tile->cell_span;
    half->slopes = (struct slope_grid){0, 0, 0, NULL};
    half->heights_m =
        scree_allocate(tile->memory, (size_t)post_count(half), sizeof *half->heights_m, "every second post", error);
    enum scree_status status = SCREE_E_MEMORY;
    if (half->heights_m != NULL)
        status = slope_grid_allocate(tile->memory, (tile->slopes.columns - 1) / 2 + 1, (tile->slopes.rows - 1) / 2 + 1,
                                     half->cell_span, &half->slopes, error);
    if (status != SCREE_OK) {
        post_tile_free(half);
        return status;
    }
    for (int32_t y = 0; y <= half->rows; y++)
        for (int32_t x = 0; x <= half->columns; x++)
            half->heights_m[(int64_t)y * (half->columns + 1) + x] =
                tile->heights_m[(int64_t)every_second(y, tile->rows) * (tile->columns + 1) +
                                every_second(x, tile->columns)];
    slope_grid_reduce(&tile->slopes, &half->slopes);
    *coarse = half;
    return SCREE_OK;
}

void post_tile_release(struct post_tile *tile) {
    if (tile == NULL || tile->memory == NULL) return;
    slope_grid_release(tile->memory, &tile->slopes);
    scree_release(tile->memory, tile->heights_m);
    memset(tile, 0, sizeof *tile);
}

void post_tile_free(struct post_tile *coarse) {
    if (coarse == NULL) return;
    struct scree_memory *memory = coarse->memory;
    post_tile_release(coarse);
    scree_release(memory, coarse);
}
