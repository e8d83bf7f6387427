#include "src/tile_build.h"

#include "src/quantized_mesh.h"

#include <math.h>

/* Corners of the tiles of this zoom stay at all zooms above it: over longer distances a globe is no height field over
 * a plane, and its roundness must not hang on measured errors alone. */
#define LOCKED_ZOOM 4

#define MARGIN 1 /* posts around a tile, for slopes on its border */

static struct tile_geometry geometry_of(const struct tile_plan *plan, struct tile_id id,
                                        float east_drop_m[TILE_CELLS + 1]) {
    const struct lattice *lattice = plan->lattice;
    struct lattice_window window = lattice_tile_window(lattice, id);
    struct tile_geometry geometry = {.columns = window.columns,
                                     .rows = window.rows,
                                     .cell_span = (int32_t)(lattice_tile_span(lattice, id.zoom) / TILE_CELLS),
                                     .height_unit_m = plan->ladder->height_unit_m};
    double south_m, north_m, top = (double)window.y + window.rows;
    lattice_steps_m(lattice, (double)window.y, &south_m, &geometry.north_m);
    lattice_steps_m(lattice, top, &north_m, &geometry.north_m);
    geometry.east_m = fmax(south_m, north_m);
    for (int32_t row = 0; row * geometry.cell_span < window.rows + geometry.cell_span; row++)
        east_drop_m[row] = (float)lattice_parallel_drop_m(lattice, (double)window.y + (double)row * geometry.cell_span);
    geometry.east_drop_m = lattice->profile == PROFILE_GEODETIC ? east_drop_m : NULL;
    geometry.north_drop_m = (float)lattice_meridian_drop_m(lattice);
    geometry.side_drop_m[SIDE_SOUTH] = lattice_parallel_drop_m(lattice, (double)window.y);
    geometry.side_drop_m[SIDE_NORTH] = lattice_parallel_drop_m(lattice, top);
    geometry.side_drop_m[SIDE_EAST] = geometry.side_drop_m[SIDE_WEST] = lattice_meridian_drop_m(lattice);
    if (lattice->profile == PROFILE_GEODETIC)
        geometry.locked_step = (int64_t)ldexp(TILE_CELLS, lattice->finest_zoom - LOCKED_ZOOM);
    return geometry;
}

/* The frame in which a tile of `zoom` will be written, as the tile `id` sees it: its own, or its parent's. */
static struct code_frame frame_of(const struct tile_plan *plan, struct tile_id id, int zoom) {
    int64_t span = lattice_tile_span(plan->lattice, zoom);
    if (zoom == id.zoom) return (struct code_frame){span, 0, 0};
    return (struct code_frame){span, id.x % 2 != 0 ? (int32_t)(span / 2) : 0, id.y % 2 != 0 ? (int32_t)(span / 2) : 0};
}

static enum scree_status advance_to(const struct tile_plan *plan, struct tile_id id, int zoom, struct tile *tile,
                                    struct scree_error *error) {
    tile_set_codes(tile, frame_of(plan, id, zoom));
    return tile_advance(tile, plan->ladder->tolerance_m[zoom], error);
}

enum scree_status tile_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    struct scree_memory *memory, struct tile *tile, struct scree_error *error) {
    struct lattice_window window = lattice_tile_window(plan->lattice, id);
    float east_drop_m[TILE_CELLS + 1];
    struct tile_geometry geometry = geometry_of(plan, id, east_drop_m);
    int32_t columns = window.columns + 1 + 2 * MARGIN, rows = window.rows + 1 + 2 * MARGIN;
    enum scree_status status = SCREE_E_MEMORY;
    float *heights_m = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *heights_m, "posts", error);
    double east_m[TILE_CELLS + 1], north_m[TILE_CELLS + 1];
    if (heights_m == NULL) goto cleanup;
    status = raster_read(reader, window.x - MARGIN, window.y - MARGIN, columns, rows, heights_m, columns, error);
    if (status != SCREE_OK) goto cleanup;
    for (int32_t y = 0; y <= window.rows; y++)
        lattice_steps_m(plan->lattice, (double)(window.y + y), &east_m[y], &north_m[y]);
    struct tile_posts posts = {heights_m + MARGIN * columns + MARGIN, columns, east_m, north_m};
    status = tile_from_posts(memory, &geometry, &posts, tile, error);
    if (status == SCREE_OK) status = advance_to(plan, id, id.zoom, tile, error);
cleanup:
    scree_release(memory, heights_m);
    return status;
}

/* The widest grid, of a power of two, whose sagitta is far below what the border lines of the tile's coarsest rung
 * bear: two halvings finer than they will keep. */
static int32_t level_step(const struct tile_plan *plan, struct tile_id id, const struct tile_geometry *geometry) {
    double tolerance_m = plan->ladder->tolerance_m[id.zoom];
    double drop_m = geometry->north_drop_m; /* eastward steps are no longer */
    int64_t step = lattice_tile_span(plan->lattice, id.zoom) / 4;
    while (step > geometry->cell_span && drop_m * 0.25 * (double)step * (double)step > tolerance_m * BORDER_SHARE / 16)
        step /= 2;
    if (geometry->locked_step > 0 && step > geometry->locked_step) step = geometry->locked_step;
    return (int32_t)step;
}

enum scree_status tile_build_level(const struct tile_plan *plan, struct tile_id id, struct scree_memory *memory,
                                   struct tile *tile, struct scree_error *error) {
    float east_drop_m[TILE_CELLS + 1];
    struct tile_geometry geometry = geometry_of(plan, id, east_drop_m);
    int32_t step = level_step(plan, id, &geometry);
    enum scree_status status = tile_from_level(memory, &geometry, step, plan->nodata_height_m, tile, error);
    return status == SCREE_OK ? advance_to(plan, id, id.zoom, tile, error) : status;
}

enum scree_status tile_build_parent(const struct tile_plan *plan, struct tile_id id,
                                    const struct coarse_tile *const children[4], struct scree_memory *memory,
                                    struct tile *tile, struct scree_error *error) {
    float east_drop_m[TILE_CELLS + 1];
    struct tile_geometry geometry = geometry_of(plan, id, east_drop_m);
    return tile_from_children(memory, &geometry, children, tile, error);
}

static float *vertex_slopes_new(const struct tile *tile, const struct scree_mesh *mesh, struct scree_error *error) {
    float *slopes = scree_allocate(tile->memory, 2 * (size_t)mesh->vertex_count, sizeof *slopes, "normals", error);
    for (uint32_t v = 0; slopes != NULL && v < mesh->vertex_count; v++) {
        struct slope slope = slope_grid_at(&tile->slopes, mesh->vertices[v].x, mesh->vertices[v].y);
        slopes[2 * v] = slope.east;
        slopes[2 * v + 1] = slope.north;
    }
    return slopes;
}

enum scree_status tile_build_write(const struct tile_plan *plan, struct tile_id id, const struct tile *tile,
                                   struct tile_store *store, struct terrain_tile_statistics *statistics,
                                   struct scree_error *error) {
    struct scree_memory *memory = tile->memory;
    struct scree_mesh mesh = {0};
    unsigned char *bytes = NULL;
    float *slopes = NULL;
    size_t size_bytes, written_bytes;
    enum scree_status status = mesh_export_new(memory, &tile->mesh, &mesh, error);
    if (status != SCREE_OK) goto cleanup;
    if (!plan->no_normals && (slopes = vertex_slopes_new(tile, &mesh, error)) == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    struct terrain_tile terrain = {.lattice = plan->lattice,
                                   .id = id,
                                   .mesh = &mesh,
                                   .slopes = slopes,
                                   .height_unit_m = plan->ladder->height_unit_m,
                                   .border_step = plan->ladder->border_step[id.zoom]};
    status = quantized_mesh_encode_new(memory, &terrain, &bytes, &size_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    status = tile_store_write(store, id, bytes, size_bytes, !plan->plain, &written_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    statistics->vertices = mesh.vertex_count;
    statistics->triangles = mesh.triangle_count;
    statistics->bytes = written_bytes;
cleanup:
    scree_release(memory, bytes);
    scree_release(memory, slopes);
    scree_release(memory, mesh.corners);
    scree_release(memory, mesh.vertices);
    return status;
}

enum scree_status tile_build_hand_up(const struct tile_plan *plan, struct tile_id id, struct tile *tile,
                                     struct coarse_tile **coarse, struct scree_error *error) {
    enum scree_status status = advance_to(plan, id, id.zoom - 1, tile, error);
    if (status == SCREE_OK) status = tile_hand_up_new(tile, coarse, error);
    tile_release(tile);
    return status;
}
