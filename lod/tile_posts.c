/* A tile of the finest zoom out of posts. */
#include "lod/extremes.h"
#include "lod/tile_parts.h"

#include <string.h>

static enum scree_status use_posts(struct tile *tile, const struct tile_posts *posts, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t across = geometry->columns + 1;
    tile->posts = scree_allocate(tile->memory, (size_t)across * (size_t)(geometry->rows + 1), sizeof *tile->posts,
                                 "a tile's posts", error);
    if (tile->posts == NULL) return SCREE_E_MEMORY;
    for (int32_t y = 0; y <= geometry->rows; y++) {
        const float *row = posts->heights_m + (int64_t)y * posts->stride;
        memcpy(tile->posts + y * across, row, (size_t)across * sizeof *row);
        for (int32_t x = 0; x <= geometry->columns; x++)
            tile->mesh.heights[y * across + x] = tile_height_units(tile, row[x]);
    }
    tile_place_vertices(tile);
    tile->samples = tile_own_samples(tile);
    tile->samples.posts = tile->posts;
    tile->samples.stride = across;
    return SCREE_OK;
}

enum scree_status tile_from_posts(struct scree_memory *memory, const struct tile_geometry *geometry,
                                  const struct tile_posts *posts, struct tile *tile, struct scree_error *error) {
    enum scree_status status;
    const float *heights_m = posts->heights_m;
    const int64_t last_row = (int64_t)geometry->rows * posts->stride;
    if ((status = tile_begin(memory, geometry, tile, error)) != SCREE_OK) return status;
    if ((status = tile_make_grid(tile, 1, error)) != SCREE_OK) goto failed;
    if ((status = use_posts(tile, posts, error)) != SCREE_OK) goto failed;
    tile_start_line(tile, SIDE_SOUTH, 1, heights_m, 1);
    tile_start_line(tile, SIDE_EAST, 1, heights_m + geometry->columns, posts->stride);
    tile_start_line(tile, SIDE_NORTH, 1, heights_m + last_row, 1);
    tile_start_line(tile, SIDE_WEST, 1, heights_m, posts->stride);
    status = slope_grid_allocate(memory, geometry->columns + 1, geometry->rows + 1, 1, &tile->slopes, error);
    if (status != SCREE_OK) goto failed;
    slope_grid_from_posts(&tile->slopes, heights_m, posts->stride, posts->east_m, posts->north_m);
    if ((status = tile_begin_rest(tile, error)) != SCREE_OK) goto failed;
    extremes_from_posts(heights_m, posts->stride, geometry->columns, geometry->rows, tile->rest->extremes);
    slope_grid_reduce(&tile->slopes, &tile->rest->slopes);
    if ((status = tile_begin_simplifier(tile, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    tile_release(tile);
    return status;
}
