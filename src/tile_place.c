#include "src/tile_place.h"

#include "src/tin_source_io.h"

#include <math.h>

/* Corners of the tiles of this zoom stay at all zooms above it: over longer distances a globe is no height field over
 * a plane, and its roundness must not hang on measured errors alone. */
#define LOCKED_ZOOM 4

#define MARGIN 1 /* posts around a tile, for slopes on its border */

/* A TIN's leaf tiles may have few points, and few cells; coarser ones have more of both. */
int32_t tile_place_cells(const struct tile_plan *plan, int zoom) {
    int32_t cells = plan->tin != NULL ? plan->tin->cells : TILE_CELLS;
    for (int above = plan->ladder->finest_zoom; above > zoom && cells < TILE_CELLS; above--) cells *= 2;
    return cells;
}

struct tile_geometry tile_place_geometry(const struct tile_plan *plan, struct tile_id id, struct tile_drops *drops) {
    const struct lattice *lattice = plan->lattice;
    struct lattice_window window = lattice_tile_window(lattice, id);
    struct tile_geometry geometry = {
        .columns = window.columns,
        .rows = window.rows,
        .cell_span = (int32_t)(lattice_tile_span(lattice, id.zoom) / tile_place_cells(plan, id.zoom)),
        .keeps_cells = id.zoom > 0 && tile_place_cells(plan, id.zoom - 1) > tile_place_cells(plan, id.zoom),
        .height_unit_m = plan->ladder->height_unit_m};
    double top = (double)window.y + window.rows, equator = -lattice->south / lattice->spacing_y;
    lattice_steps_m(lattice, fmin(fmax(equator, (double)window.y), top), &geometry.east_m, &geometry.north_m);
    for (int32_t row = 0; row * geometry.cell_span < window.rows + geometry.cell_span; row++)
        drops->east_m[row] =
            (float)lattice_parallel_drop_m(lattice, (double)window.y + (double)row * geometry.cell_span);
    geometry.east_drop_m = lattice->profile == PROFILE_GEODETIC ? drops->east_m : NULL;
    geometry.north_drop_m = (float)lattice_meridian_drop_m(lattice);
    geometry.side_drop_m[SIDE_SOUTH] = lattice_parallel_drop_m(lattice, (double)window.y);
    geometry.side_drop_m[SIDE_NORTH] = lattice_parallel_drop_m(lattice, top);
    geometry.side_drop_m[SIDE_EAST] = geometry.side_drop_m[SIDE_WEST] = lattice_meridian_drop_m(lattice);
    if (lattice->profile == PROFILE_GEODETIC)
        geometry.locked_step = (int64_t)ldexp(TILE_CELLS, lattice->finest_zoom - LOCKED_ZOOM);
    return geometry;
}

struct code_frame tile_place_frame(const struct tile_plan *plan, struct tile_id id, int zoom) {
    int64_t span = lattice_tile_span(plan->lattice, zoom);
    if (zoom == id.zoom) return (struct code_frame){span, 0, 0};
    return (struct code_frame){span, id.x % 2 != 0 ? (int32_t)(span / 2) : 0, id.y % 2 != 0 ? (int32_t)(span / 2) : 0};
}

/* The widest grid, of a power of two, whose sagitta is far below what the border lines of the tile's coarsest rung
 * bear: two halvings finer than they will keep. */
int32_t tile_place_level_step(const struct tile_plan *plan, struct tile_id id, const struct tile_geometry *geometry) {
    double tolerance_m = plan->ladder->tolerance_m[id.zoom];
    double drop_m = geometry->north_drop_m; /* eastward steps are no longer */
    int64_t step = lattice_tile_span(plan->lattice, id.zoom) / 4;
    while (step > geometry->cell_span && drop_m * 0.25 * (double)step * (double)step > tolerance_m * BORDER_SHARE / 16)
        step /= 2;
    if (geometry->locked_step > 0 && step > geometry->locked_step) step = geometry->locked_step;
    return (int32_t)step;
}

enum scree_status placed_posts_read(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    struct scree_memory *memory, struct placed_posts *posts,
                                    struct scree_error *error) {
    struct lattice_window window = lattice_tile_window(plan->lattice, id);
    int32_t columns = window.columns + 1 + 2 * MARGIN, rows = window.rows + 1 + 2 * MARGIN;
    posts->heights_m = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *posts->heights_m, "posts", error);
    if (posts->heights_m == NULL) return SCREE_E_MEMORY;
    for (int32_t y = 0; y <= window.rows; y++)
        lattice_steps_m(plan->lattice, (double)(window.y + y), &posts->east_m[y], &posts->north_m[y]);
    posts->posts =
        (struct tile_posts){posts->heights_m + MARGIN * columns + MARGIN, columns, posts->east_m, posts->north_m};
    return raster_read(reader, window.x - MARGIN, window.y - MARGIN, columns, rows, posts->heights_m, columns, error);
}

void placed_posts_release(struct scree_memory *memory, struct placed_posts *posts) {
    scree_release(memory, posts->heights_m);
    posts->heights_m = NULL;
}
