#include "lod/method_greedy.h"

#include "lod/insertion.h"

#include <math.h>
#include <string.h>

/* A tile while vertices are put into it. */
struct work {
    const struct method_tile *tile;
    struct scree_memory *memory;
    struct scree_error *error;
    float *drawn_m; /* the posts less the drop; NULL: the Earth is flat */
    struct method_vertex *ring;
    uint32_t ring_count;
    struct insertion insertion;
};

static enum scree_status check_arguments(const struct method_tile *tile, const struct method_greedy_options *options,
                                         struct scree_error *error) {
    if (tile->columns > GREEDY_MAX_CELLS || tile->rows > GREEDY_MAX_CELLS)
        return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: %d x %d cells; it takes up to %d a side",
                          (int)tile->columns, (int)tile->rows, GREEDY_MAX_CELLS);
    if (!(options->tolerance_m >= 0) || options->grid_cells < 0)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "greedy insertion: a tolerance of %g m and a grid of %d cells a side; neither is below 0",
                          options->tolerance_m, (int)options->grid_cells);
    return SCREE_OK;
}

static bool is_round(const struct method_tile *tile) {
    return tile->east_drop_m != 0 || tile->north_drop_m != 0;
}

/* On a round Earth flat triangles are measured against what they are drawn beside: heights less the drop. */
static enum scree_status draw_posts(struct work *work) {
    const struct method_tile *tile = work->tile;
    int32_t across = tile->columns + 1, span = tile->cell_span;
    if (!is_round(tile)) return SCREE_OK;
    work->drawn_m = scree_allocate(work->memory, (size_t)across * (size_t)(tile->rows + 1), sizeof *work->drawn_m,
                                   "posts less the drop of the ellipsoid", work->error);
    if (work->drawn_m == NULL) return work->error->status;
    for (int32_t row = 0; row <= tile->rows; row++)
        for (int32_t column = 0; column <= tile->columns; column++)
            work->drawn_m[(int64_t)row * across + column] =
                (float)((double)method_post_m(tile, column, row) -
                        method_drop_m(tile, (double)column * span, (double)row * span));
    return SCREE_OK;
}

static enum scree_status start(struct work *work) {
    const struct method_tile *tile = work->tile;
    struct insertion_posts posts = {tile->heights_m, tile->columns + 1, tile->rows + 1,
                                    tile->stride,    tile->cell_span,   1};
    double largest_m = 0;
    bool whole = true;
    if (work->drawn_m != NULL) {
        posts.heights_m = work->drawn_m;
        posts.stride = posts.columns;
    }
    for (uint32_t i = 0; i < work->ring_count; i++) {
        struct method_vertex *vertex = &work->ring[i];
        vertex->height_m -= method_drop_m(tile, vertex->x, vertex->y);
        largest_m = fmax(largest_m, fabs(vertex->height_m));
        whole = whole && vertex->height_m == floor(vertex->height_m);
    }
    return insertion_start(work->memory, &posts, largest_m, whole, &work->insertion, work->error);
}

static enum scree_status place_border(struct work *work) {
    enum scree_status status = SCREE_OK;
    for (uint32_t i = 0; i < work->ring_count && status == SCREE_OK; i++)
        status = insertion_place(&work->insertion,
                                 (struct delaunay_point){(int32_t)work->ring[i].x, (int32_t)work->ring[i].y},
                                 work->ring[i].height_m, work->error);
    return status;
}

/* The posts next to the corners of a grid of cells_a_side x cells_a_side cells, those on the border left out. */
static enum scree_status place_grid(struct work *work, int32_t cells_a_side) {
    const struct insertion_posts *posts = &work->insertion.posts;
    enum scree_status status = SCREE_OK;
    for (int32_t j = 1; j < cells_a_side; j++)
        for (int32_t i = 1; i < cells_a_side && status == SCREE_OK; i++) {
            int32_t column = (int32_t)((int64_t)i * (posts->columns - 1) / cells_a_side);
            int32_t row = (int32_t)((int64_t)j * (posts->rows - 1) / cells_a_side);
            if (column < 1 || row < 1) continue; /* a grid that is finer than the posts */
            double height_m = (double)posts->heights_m[(int64_t)row * posts->stride + column];
            status = insertion_place(&work->insertion, (struct delaunay_point){column * posts->span, row * posts->span},
                                     height_m, work->error);
        }
    return status;
}

/* The heights of the tile, not those less the drop, which have been rounded: border vertices as the lines have them. */
static double height_of(const struct work *work, uint32_t vertex) {
    const struct method_tile *tile = work->tile;
    struct delaunay_point at = work->insertion.mesh.points[vertex];
    int32_t position;
    const struct sample place = {at.x, at.y, 0};
    enum tile_side side = border_side(method_width(tile), method_height(tile), &place, &position);
    bool is_corner = (at.x == 0 || at.x == method_width(tile)) && (at.y == 0 || at.y == method_height(tile));
    if (is_corner) {
        side = at.y == 0 ? SIDE_SOUTH : SIDE_NORTH;
        position = at.x;
    }
    if (side == SIDE_COUNT) return (double)method_post_m(tile, at.x / tile->cell_span, at.y / tile->cell_span);
    return (double)tile->lines[side]->vertices[border_before(tile->lines[side], position)].height_m;
}

static enum scree_status hand_out(const struct work *work, struct method_mesh *mesh) {
    const struct delaunay *made = &work->insertion.mesh;
    struct method_mesh out = {.vertex_count = made->point_count, .triangle_count = made->triangle_count};
    out.vertices =
        scree_allocate(work->memory, out.vertex_count, sizeof *out.vertices, "a method's vertices", work->error);
    out.corners = scree_allocate(work->memory, 3 * (size_t)out.triangle_count, sizeof *out.corners,
                                 "a method's triangles", work->error);
    if (out.vertices == NULL || out.corners == NULL) {
        method_mesh_release(work->memory, &out);
        return work->error->status;
    }
    for (uint32_t v = 0; v < out.vertex_count; v++)
        out.vertices[v] = (struct method_vertex){made->points[v].x, made->points[v].y, height_of(work, v)};
    for (uint32_t t = 0; t < out.triangle_count; t++)
        memcpy(out.corners + 3 * (size_t)t, made->triangles[t].corner, sizeof made->triangles[t].corner);
    *mesh = out;
    return SCREE_OK;
}

enum scree_status method_greedy(struct scree_memory *memory, const struct method_tile *tile,
                                const struct method_greedy_options *options, struct method_mesh *mesh,
                                struct scree_error *error) {
    struct scree_error own_error = {0};
    if (error == NULL) error = &own_error;
    struct work work = {.tile = tile, .memory = memory, .error = error, .insertion = {.memory = memory}};
    uint32_t most = options->max_vertices != 0 ? options->max_vertices : UINT32_MAX;
    *mesh = (struct method_mesh){0};
    enum scree_status status = check_arguments(tile, options, error);
    if (status == SCREE_OK) status = method_ring_new(memory, tile, &work.ring, &work.ring_count, NULL, error);
    if (status == SCREE_OK) status = draw_posts(&work);
    if (status == SCREE_OK) status = start(&work);
    if (status == SCREE_OK) status = place_border(&work);
    if (status == SCREE_OK) status = place_grid(&work, options->grid_cells);
    if (status == SCREE_OK) status = insertion_run(&work.insertion, options->tolerance_m, most, error);
    if (status == SCREE_OK) status = hand_out(&work, mesh);
    insertion_release(&work.insertion);
    scree_release(memory, work.drawn_m);
    scree_release(memory, work.ring);
    return status;
}
