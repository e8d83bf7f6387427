/* A tile without data. */
#include "lod/tile_parts.h"

/* Samples of a level tile: one a step, in the middle of it, is enough; what is handed up has all cells. */
static enum scree_status use_level(struct tile *tile, int32_t step, float height_m, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t columns = geometry->columns / step, rows = geometry->rows / step, cells = step / geometry->cell_span;
    tile->extremes =
        scree_allocate(tile->memory, 2 * (size_t)columns * (size_t)rows, sizeof *tile->extremes, "extremes", error);
    if (tile->extremes == NULL) return SCREE_E_MEMORY;
    for (int32_t i = 0; i < 2 * columns * rows; i++)
        tile->extremes[i] =
            (struct sample){i / 2 % columns * step + step / 2, i / 2 / columns * step + step / 2, height_m};
    for (int32_t row = 0; tile->east_drop_m != NULL && row <= rows; row++)
        tile->east_drop_m[row] = tile->east_drop_m[row * cells];
    tile->samples = tile_own_samples(tile);
    tile->samples.columns = columns;
    tile->samples.rows = rows;
    tile->samples.cell_span = step;
    tile->samples.extremes = tile->extremes;
    enum scree_status status =
        slope_grid_allocate(tile->memory, geometry->columns / geometry->cell_span + 1,
                            geometry->rows / geometry->cell_span + 1, geometry->cell_span, &tile->slopes, error);
    if (status == SCREE_OK) status = tile_begin_rest(tile, error);
    if (status != SCREE_OK) return status;
    struct coarse_tile *rest = tile->rest;
    for (int32_t i = 0; i < 2 * rest->cell_columns * rest->cell_rows; i++) {
        int32_t x = i / 2 % rest->cell_columns, y = i / 2 / rest->cell_columns, half = rest->cell_span / 2;
        rest->extremes[i] = (struct sample){x * rest->cell_span + half, y * rest->cell_span + half, height_m};
    }
    return SCREE_OK;
}

enum scree_status tile_from_level(struct scree_memory *memory, const struct tile_geometry *geometry, int32_t step,
                                  double height_m, struct tile *tile, struct scree_error *error) {
    enum scree_status status;
    float height = (float)height_m;
    if ((status = tile_begin(memory, geometry, tile, error)) != SCREE_OK) return status;
    if ((status = tile_make_grid(tile, step, error)) != SCREE_OK) goto failed;
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++) tile->mesh.heights[v] = tile_height_units(tile, height_m);
    for (int side = 0; side < SIDE_COUNT; side++) tile_start_line(tile, (enum tile_side)side, step, &height, 0);
    tile_place_vertices(tile);
    if ((status = use_level(tile, step, height, error)) != SCREE_OK) goto failed;
    mesh_measure(&tile->mesh, &tile->samples);
    if ((status = tile_begin_simplifier(tile, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    tile_release(tile);
    return status;
}

enum scree_status tile_lock(struct tile *tile, int64_t locked_step, struct scree_error *error) {
    const struct code_frame codes = tile->simplifier.options.codes;
    const struct samples samples = tile->simplifier.samples; /* with its position rounding */
    simplifier_release(&tile->simplifier);
    tile->geometry.locked_step = locked_step;
    enum scree_status status = tile_begin_simplifier(tile, error);
    if (status != SCREE_OK) return status;
    tile->simplifier.options.codes = codes;
    tile->simplifier.samples = samples;
    return SCREE_OK;
}
