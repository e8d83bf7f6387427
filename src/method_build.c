#include "src/method_build.h"

#include "lod/method_codes.h"
#include "lod/method_error.h"
#include "lod/position_code.h"
#include "lod/quadric.h"
#include "lod/tile_lines.h"
#include "src/methods.h"
#include "src/quantized_mesh.h"

#include <math.h>
#include <string.h>

/* ---- lines from rung to rung ---- */

static void take_to(const struct tile_plan *plan, struct tile_id id, int rung, struct post_tile *tile) {
    int zoom = tile_zoom_ahead(id, rung);
    struct code_frame codes = {0, 0, 0};
    bool is_static = rung_is_static(rung, zoom);
    if (is_static) codes = tile_place_frame(plan, id, zoom);
    tile_lines_reduce(tile->lines, ladder_rung_tolerance_m(plan->ladder, rung), tile->locked_step,
                      is_static ? &codes : NULL);
}

static void walk(const struct tile_plan *plan, struct tile_id id, int rung, int last_rung, struct post_tile *tile) {
    while (rung > last_rung) take_to(plan, id, --rung, tile);
}

/* ---- the three makers ---- */

enum scree_status method_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                      struct scree_memory *memory, struct post_tile *tile, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    struct placed_posts placed;
    enum scree_status status = placed_posts_read(plan, id, reader, memory, &placed, error);
    if (status == SCREE_OK) status = post_tile_from_posts(memory, &geometry, &placed.posts, tile, error);
    placed_posts_release(memory, &placed);
    if (status != SCREE_OK) return status;
    int finest = plan->ladder->finest_rung;
    if (!plan->ladder->lossless) take_to(plan, id, finest, tile);
    walk(plan, id, finest, RUNGS_A_ZOOM * id.zoom, tile);
    return SCREE_OK;
}

enum scree_status method_build_level(const struct tile_plan *plan, struct tile_id id, struct scree_memory *memory,
                                     struct post_tile *tile, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    int32_t step = tile_place_level_step(plan, id, &geometry);
    int64_t locked_step = geometry.locked_step, half = lattice_tile_span(plan->lattice, id.zoom) / 2;
    bool has_children = id.zoom < plan->lattice->finest_zoom;
    /* like its neighbours it is, at its finest rung, what four children would be: their corners are there */
    if (has_children && (locked_step == 0 || half < locked_step)) geometry.locked_step = half;
    enum scree_status status = post_tile_from_level(memory, &geometry, step, plan->nodata_height_m, tile, error);
    if (status != SCREE_OK) return status;
    take_to(plan, id, RUNGS_A_ZOOM * id.zoom, tile);
    tile->locked_step = locked_step;
    return SCREE_OK;
}

enum scree_status method_build_parent(const struct tile_plan *plan, struct tile_id id,
                                      const struct post_tile *const children[4], struct scree_memory *memory,
                                      struct post_tile *tile, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    return post_tile_from_children(memory, &geometry, children, tile, error);
}

enum scree_status method_build_hand_up(const struct tile_plan *plan, struct tile_id id, struct post_tile *tile,
                                       struct post_tile **coarse, struct scree_error *error) {
    walk(plan, id, RUNGS_A_ZOOM * id.zoom, tile_coarsest_rung(plan, id), tile);
    return post_tile_hand_up_new(tile, coarse, error);
}

/* ---- figures ---- */

/* A method takes the ellipsoid to be as round everywhere as it is in the middle of the tile. How far that may be off
 * where its triangles are. */
static double largest_bend_m(const struct lattice *lattice, struct tile_id id, const struct scree_mesh *coded) {
    struct lattice_window window = lattice_tile_window(lattice, id);
    double steps = (double)lattice_tile_span(lattice, id.zoom) / POSITION_TOP, largest_m = 0;
    double middle_m = lattice_parallel_drop_m(lattice, (double)window.y + 0.5 * window.rows);
    if (lattice->profile != PROFILE_GEODETIC) return 0;
    for (uint32_t t = 0; t < coded->triangle_count; t++) {
        const uint32_t *corner = coded->corners + 3 * (size_t)t;
        const struct scree_vertex *a = &coded->vertices[corner[0]], *b = &coded->vertices[corner[1]];
        const struct scree_vertex *c = &coded->vertices[corner[2]];
        double width = steps * (fmax(a->x, fmax(b->x, c->x)) - fmin(a->x, fmin(b->x, c->x)));
        double row = (double)window.y + steps * ((double)a->y + b->y + c->y) / 3;
        double off_m = fabs(lattice_parallel_drop_m(lattice, row) - middle_m);
        largest_m = fmax(largest_m, off_m * 0.25 * width * width);
    }
    return largest_m;
}

static enum scree_status measure_errors(const struct tile_plan *plan, struct tile_id id, const struct method_view *view,
                                        const struct scree_mesh *coded, struct scree_memory *memory,
                                        struct terrain_tile_statistics *statistics, struct scree_error *error) {
    struct method_mesh drawn;
    struct method_error errors = {0};
    enum scree_status status = method_from_codes_new(memory, &view->tile, &view->frame, coded, &drawn, error);
    if (status == SCREE_OK) status = method_error_measure(memory, &view->tile, &drawn, &errors, error);
    method_mesh_release(memory, &drawn);
    statistics->max_error_m = errors.max_m + largest_bend_m(plan->lattice, id, coded);
    return status;
}

/* The mean minimum quadric error, of the mesh in codes. */
static enum scree_status measure_scale(const struct method_view *view, const struct scree_mesh *coded,
                                       struct scree_memory *memory, struct terrain_tile_statistics *statistics,
                                       struct scree_error *error) {
    struct mesh mesh = {0};
    double steps = (double)view->frame.span / POSITION_TOP; /* of a code, unstretched ones */
    double east = steps * method_width(&view->tile) / view->frame.width;
    double north = steps * method_height(&view->tile) / view->frame.height;
    const float east_drop_m[2] = {(float)(view->tile.east_drop_m * east * east),
                                  (float)(view->tile.east_drop_m * east * east)};
    const struct samples samples = {.columns = 1,
                                    .rows = 1,
                                    .cell_span = POSITION_TOP,
                                    .east_drop_m = view->tile.east_drop_m != 0 ? east_drop_m : NULL,
                                    .north_drop_m = (float)(view->tile.north_drop_m * north * north)};
    enum scree_status status =
        mesh_allocate(memory, (int32_t)coded->vertex_count, (int32_t)coded->triangle_count, &mesh, error);
    if (status != SCREE_OK) return status;
    mesh.vertex_count = mesh.live_vertices = (int32_t)coded->vertex_count;
    mesh.triangle_count = mesh.live_triangles = (int32_t)coded->triangle_count;
    for (uint32_t v = 0; v < coded->vertex_count; v++) {
        const struct scree_vertex *at = &coded->vertices[v];
        mesh.vertices[v].at = (struct sample){at->x, at->y, (float)(at->height * view->frame.height_unit_m)};
    }
    for (uint32_t t = 0; t < coded->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) mesh.triangles[t].vertex[k] = (int32_t)coded->corners[3 * (size_t)t + k];
    status = mesh_connect(memory, &mesh, error);
    if (status == SCREE_OK)
        statistics->mmqe_m2 = quadric_mmqe_m2(&mesh, &samples, view->tile.east_m * east, view->tile.north_m * north);
    mesh_release(memory, &mesh);
    return status;
}

/* ---- writing ---- */

/* Slopes where vertices are written; border vertices are at whole steps, so that neighbours agree. */
static float *slopes_new(const struct post_tile *tile, const struct method_frame *frame, const struct scree_mesh *coded,
                         struct scree_error *error) {
    float *slopes = scree_allocate(tile->memory, 2 * (size_t)coded->vertex_count, sizeof *slopes, "normals", error);
    for (uint32_t v = 0; slopes != NULL && v < coded->vertex_count; v++) {
        double x = (double)coded->vertices[v].x * (double)frame->span / POSITION_TOP;
        double y = (double)coded->vertices[v].y * (double)frame->span / POSITION_TOP;
        struct slope slope = slope_grid_between(&tile->slopes, x, y);
        slopes[2 * (size_t)v] = slope.east;
        slopes[2 * (size_t)v + 1] = slope.north;
    }
    return slopes;
}

enum scree_status method_build_encode(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                      const struct method_view *view, const struct method_mesh *mesh,
                                      struct scree_mesh *coded, unsigned char **bytes, size_t *size_bytes,
                                      struct scree_error *error) {
    float *slopes = NULL;
    struct terrain_tile terrain = {.lattice = plan->lattice,
                                   .id = id,
                                   .mesh = coded,
                                   .is_coded = true,
                                   .height_unit_m = plan->ladder->height_unit_m,
                                   .border_step = plan->ladder->border_step[id.zoom]};
    enum scree_status status = method_to_codes_new(tile->memory, &view->tile, &view->frame, mesh, coded, error);
    if (status == SCREE_OK && !plan->no_normals &&
        (terrain.slopes = slopes = slopes_new(tile, &view->frame, coded, error)) == NULL)
        status = SCREE_E_MEMORY;
    if (status == SCREE_OK) status = quantized_mesh_encode_new(tile->memory, &terrain, bytes, size_bytes, error);
    scree_release(tile->memory, slopes);
    return status;
}

enum scree_status method_build_write(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                     struct tile_store *store, struct terrain_tile_statistics *statistics,
                                     struct scree_error *error) {
    struct scree_memory *memory = tile->memory;
    double tolerance_m = plan->ladder->tolerance_m[id.zoom];
    struct method_mesh mesh = {0};
    struct scree_mesh coded = {0};
    unsigned char *bytes = NULL;
    size_t size_bytes = 0, written_bytes = 0;
    struct method_view view;
    enum scree_status status = method_view_make(plan, id, tile, &view, error);
    if (status == SCREE_OK) status = method_run(plan->method, id.zoom, tolerance_m, memory, &view.tile, &mesh, error);
    if (status == SCREE_OK)
        status = method_build_encode(plan, id, tile, &view, &mesh, &coded, &bytes, &size_bytes, error);
    method_mesh_release(memory, &mesh);
    if (status == SCREE_OK) status = measure_errors(plan, id, &view, &coded, memory, statistics, error);
    if (status == SCREE_OK) status = measure_scale(&view, &coded, memory, statistics, error);
    if (status == SCREE_OK)
        status = tile_store_write(store, id, bytes, size_bytes, !plan->plain, &written_bytes, error);
    statistics->vertices = coded.vertex_count;
    statistics->triangles = coded.triangle_count;
    statistics->bytes = written_bytes;
    statistics->tolerance_m = tolerance_m;
    scree_release(memory, bytes);
    scree_release(memory, coded.corners);
    scree_release(memory, coded.vertices);
    method_view_release(memory, &view);
    return status;
}
