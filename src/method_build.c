#include "src/method_build.h"

#include "lod/method_codes.h"
#include "lod/method_error.h"
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
    walk(plan, id, RUNGS_A_ZOOM * id.zoom, tile_coarsest_rung(id), tile);
    return post_tile_hand_up_new(tile, coarse, error);
}

/* ---- what a method sees ---- */

/* A tile as a method sees it. Whole cells: where the lattice ends within one, posts are interpolated from the first to
 * the last one at equal distances, and the border lines are stretched to match. */
struct view {
    struct method_tile tile;
    struct method_frame frame;
    float *stretched_m;         /* posts; NULL: they are the tile's own */
    struct border_line *border; /* SIDE_COUNT lines; NULL: they are the tile's own */
};

/* Post `index` of those at equal distances, as a post of the tile and the way on to the next one. */
static int32_t post_before(int32_t index, int32_t count, int32_t length, int32_t span, double *share) {
    double position = (double)index * length / count;
    int32_t before = (int32_t)(position / span);
    if (before > count - 1) before = count - 1;
    double next = fmin((before + 1.0) * span, length);
    *share = (position - (double)before * span) / (next - (double)before * span);
    return before;
}

static enum scree_status stretch_posts(const struct post_tile *tile, struct view *view, struct scree_error *error) {
    int32_t across = tile->columns + 1;
    view->stretched_m = scree_allocate(tile->memory, (size_t)across * (size_t)(tile->rows + 1),
                                       sizeof *view->stretched_m, "posts at the end of the lattice", error);
    if (view->stretched_m == NULL) return SCREE_E_MEMORY;
    for (int32_t row = 0; row <= tile->rows; row++)
        for (int32_t column = 0; column <= tile->columns; column++) {
            double right, up;
            int32_t x = post_before(column, tile->columns, tile->width, tile->cell_span, &right);
            int32_t y = post_before(row, tile->rows, tile->height, tile->cell_span, &up);
            const float *low = tile->heights_m + (int64_t)y * across + x, *high = low + across;
            double south_m = low[0] + right * (low[1] - low[0]), north_m = high[0] + right * (high[1] - high[0]);
            view->stretched_m[(int64_t)row * across + column] = (float)(south_m + up * (north_m - south_m));
        }
    return SCREE_OK;
}

/* Positions grow by a factor of at least 1, so those of different vertices stay apart. */
static enum scree_status stretch_lines(const struct post_tile *tile, struct view *view, struct scree_error *error) {
    view->border = scree_allocate(tile->memory, SIDE_COUNT, sizeof *view->border, "a tile's border", error);
    if (view->border == NULL) return SCREE_E_MEMORY;
    for (int side = 0; side < SIDE_COUNT; side++) {
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
        double whole = (double)(horizontal ? tile->columns : tile->rows) * tile->cell_span;
        double factor = whole / (horizontal ? tile->width : tile->height);
        struct border_line *line = &view->border[side];
        *line = tile->lines[side];
        for (int32_t v = 0; v < line->vertex_count; v++)
            line->vertices[v].position = (int32_t)floor(line->vertices[v].position * factor + 0.5);
        line->curvature_m /= factor * factor;
        view->tile.lines[side] = line;
    }
    return SCREE_OK;
}

static enum scree_status view_tile(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                   struct view *view, struct scree_error *error) {
    struct lattice_window window = lattice_tile_window(plan->lattice, id);
    double middle = (double)window.y + 0.5 * window.rows;
    double stretch_x = (double)tile->columns * tile->cell_span / tile->width;
    double stretch_y = (double)tile->rows * tile->cell_span / tile->height;
    *view = (struct view){.tile = {.columns = tile->columns,
                                   .rows = tile->rows,
                                   .cell_span = tile->cell_span,
                                   .heights_m = tile->heights_m,
                                   .stride = tile->columns + 1},
                          .frame = {.span = lattice_tile_span(plan->lattice, id.zoom),
                                    .width = tile->width,
                                    .height = tile->height,
                                    .height_unit_m = plan->ladder->height_unit_m}};
    lattice_steps_m(plan->lattice, middle, &view->tile.east_m, &view->tile.north_m);
    view->tile.east_m /= stretch_x;
    view->tile.north_m /= stretch_y;
    if (plan->lattice->profile == PROFILE_GEODETIC) {
        view->tile.east_drop_m = lattice_parallel_drop_m(plan->lattice, middle) / (stretch_x * stretch_x);
        view->tile.north_drop_m = lattice_meridian_drop_m(plan->lattice) / (stretch_y * stretch_y);
    }
    for (int side = 0; side < SIDE_COUNT; side++) view->tile.lines[side] = view->frame.lines[side] = &tile->lines[side];
    if (stretch_x == 1 && stretch_y == 1) return SCREE_OK;
    enum scree_status status = stretch_posts(tile, view, error);
    if (status != SCREE_OK) return status;
    view->tile.heights_m = view->stretched_m;
    return stretch_lines(tile, view, error);
}

static void view_release(struct scree_memory *memory, struct view *view) {
    scree_release(memory, view->border);
    scree_release(memory, view->stretched_m);
}

/* ---- figures ---- */

static enum scree_status measure_errors(const struct view *view, const struct scree_mesh *coded,
                                        struct scree_memory *memory, struct terrain_tile_statistics *statistics,
                                        struct scree_error *error) {
    struct method_mesh drawn;
    struct method_error errors = {0};
    enum scree_status status = method_from_codes_new(memory, &view->tile, &view->frame, coded, &drawn, error);
    if (status == SCREE_OK) status = method_error_measure(memory, &view->tile, &drawn, &errors, error);
    method_mesh_release(memory, &drawn);
    statistics->max_error_m = errors.max_m;
    return status;
}

/* The mean minimum quadric error, of the mesh in codes. */
static enum scree_status measure_scale(const struct view *view, const struct scree_mesh *coded,
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

static enum scree_status write_coded(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                     const struct scree_mesh *coded, const float *slopes, struct tile_store *store,
                                     struct terrain_tile_statistics *statistics, struct scree_error *error) {
    unsigned char *bytes = NULL;
    size_t size_bytes, written_bytes = 0;
    const struct terrain_tile terrain = {.lattice = plan->lattice,
                                         .id = id,
                                         .mesh = coded,
                                         .is_coded = true,
                                         .slopes = slopes,
                                         .height_unit_m = plan->ladder->height_unit_m,
                                         .border_step = plan->ladder->border_step[id.zoom]};
    enum scree_status status = quantized_mesh_encode_new(tile->memory, &terrain, &bytes, &size_bytes, error);
    if (status == SCREE_OK)
        status = tile_store_write(store, id, bytes, size_bytes, !plan->plain, &written_bytes, error);
    scree_release(tile->memory, bytes);
    statistics->vertices = coded->vertex_count;
    statistics->triangles = coded->triangle_count;
    statistics->bytes = written_bytes;
    return status;
}

enum scree_status method_build_write(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                     struct tile_store *store, struct terrain_tile_statistics *statistics,
                                     struct scree_error *error) {
    struct scree_memory *memory = tile->memory;
    double tolerance_m = plan->ladder->tolerance_m[id.zoom];
    struct method_mesh mesh = {0};
    struct scree_mesh coded = {0};
    float *slopes = NULL;
    struct view view;
    enum scree_status status = view_tile(plan, id, tile, &view, error);
    if (status == SCREE_OK) status = method_run(plan->method, id.zoom, tolerance_m, memory, &view.tile, &mesh, error);
    if (status == SCREE_OK) status = method_to_codes_new(memory, &view.tile, &view.frame, &mesh, &coded, error);
    method_mesh_release(memory, &mesh);
    if (status == SCREE_OK) status = measure_errors(&view, &coded, memory, statistics, error);
    if (status == SCREE_OK) status = measure_scale(&view, &coded, memory, statistics, error);
    if (status == SCREE_OK && !plan->no_normals && (slopes = slopes_new(tile, &view.frame, &coded, error)) == NULL)
        status = SCREE_E_MEMORY;
    if (status == SCREE_OK) status = write_coded(plan, id, tile, &coded, slopes, store, statistics, error);
    statistics->tolerance_m = tolerance_m;
    scree_release(memory, slopes);
    scree_release(memory, coded.corners);
    scree_release(memory, coded.vertices);
    view_release(memory, &view);
    return status;
}
