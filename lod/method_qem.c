#include "lod/method_qem.h"

#include "lod/fit.h"
#include "lod/method_greedy.h"
#include "lod/simplify.h"

#include <math.h>
#include <string.h>

#define FINEST_CLASS_M 1e-3 /* without a bound: growths below that of an error of this size are all alike */

/* A tile while it is simplified. The mesh begins as the grid of all inner posts, joined to the border's vertices by a
 * strip of triangles one cell wide. */
struct work {
    const struct method_tile *tile;
    struct scree_memory *memory;
    struct scree_error *error;
    struct method_vertex *ring;
    uint32_t ring_count, corners[4];
    struct mesh mesh;
    struct samples samples;
    struct sample *posts; /* where cells are wider than a step: two a cell */
    float *drops_m;
    struct simplifier simplifier;
};

/* ---- the full mesh ---- */

/* Inner posts come behind the ring. */
static int32_t inner(const struct work *work, int32_t column, int32_t row) {
    return (int32_t)work->ring_count + (row - 1) * (work->tile->columns - 1) + column - 1;
}

static void add_triangle(struct mesh *mesh, int32_t a, int32_t b, int32_t c) {
    memcpy(mesh->triangles[mesh->triangle_count++].vertex, (int32_t[3]){a, b, c}, 3 * sizeof a);
}

static int32_t distance(const struct sample *a, const struct sample *b) {
    int32_t dx = a->x > b->x ? a->x - b->x : b->x - a->x, dy = a->y > b->y ? a->y - b->y : b->y - a->y;
    return dx + dy; /* along a side one of them is 0 */
}

/* Joins one side of the border to the row of inner posts beside it, going on where the way is shorter. */
static void make_strip(struct work *work, enum tile_side side) {
    static const struct {
        bool from_east, from_north; /* where the side begins, going round counter-clockwise */
        int32_t column_step, row_step;
    } ways[SIDE_COUNT] = {{false, false, 1, 0}, {true, false, 0, 1}, {true, true, -1, 0}, {false, true, 0, -1}};
    const struct method_tile *tile = work->tile;
    struct mesh *mesh = &work->mesh;
    int32_t column = ways[side].from_east ? tile->columns - 1 : 1, row = ways[side].from_north ? tile->rows - 1 : 1;
    int32_t steps = (side == SIDE_SOUTH || side == SIDE_NORTH ? tile->columns : tile->rows) - 2;
    int32_t at = (int32_t)work->corners[side];
    int32_t end = side + 1 < SIDE_COUNT ? (int32_t)work->corners[side + 1] : (int32_t)work->ring_count;
    const struct sample corner = mesh->vertices[at].at;
    while (at < end || steps > 0) {
        int32_t post = inner(work, column, row), next = at + 1 == (int32_t)work->ring_count ? 0 : at + 1;
        int32_t next_post = steps > 0 ? inner(work, column + ways[side].column_step, row + ways[side].row_step) : post;
        bool go_along = steps == 0;
        if (at < end && steps > 0) {
            int32_t to_post = distance(&corner, &mesh->vertices[next_post].at) - tile->cell_span;
            go_along = distance(&corner, &mesh->vertices[next].at) <= to_post;
        }
        if (go_along) {
            add_triangle(mesh, at, next, post);
            at++;
        } else {
            add_triangle(mesh, at == (int32_t)work->ring_count ? 0 : at, next_post, post);
            column += ways[side].column_step;
            row += ways[side].row_step;
            steps--;
        }
    }
}

/* Two triangles a cell, with alternating diagonals. */
static void make_inner_cells(struct work *work) {
    for (int32_t row = 1; row < work->tile->rows - 1; row++)
        for (int32_t column = 1; column < work->tile->columns - 1; column++) {
            int32_t a = inner(work, column, row), b = inner(work, column + 1, row);
            int32_t c = inner(work, column, row + 1), d = inner(work, column + 1, row + 1);
            bool rising = ((column + row) & 1) == 0;
            add_triangle(&work->mesh, a, b, rising ? d : c);
            add_triangle(&work->mesh, d, c, rising ? a : b);
        }
}

static enum scree_status make_mesh(struct work *work) {
    const struct method_tile *tile = work->tile;
    int32_t columns = tile->columns - 1, rows = tile->rows - 1; /* of inner posts */
    int32_t vertices = (int32_t)work->ring_count + columns * rows;
    /* Euler: 2 v - 2 - (vertices on the border) */
    int32_t triangles = 2 * vertices - 2 - (int32_t)work->ring_count;
    struct mesh *mesh = &work->mesh;
    enum scree_status status = mesh_allocate(work->memory, vertices, triangles, mesh, work->error);
    if (status != SCREE_OK) return status;
    for (uint32_t i = 0; i < work->ring_count; i++)
        mesh->vertices[mesh->vertex_count++].at =
            (struct sample){(int32_t)work->ring[i].x, (int32_t)work->ring[i].y, (float)work->ring[i].height_m};
    for (int32_t row = 1; row <= rows; row++)
        for (int32_t column = 1; column <= columns; column++)
            mesh->vertices[mesh->vertex_count++].at =
                (struct sample){column * tile->cell_span, row * tile->cell_span, method_post_m(tile, column, row)};
    for (int side = 0; side < SIDE_COUNT; side++) make_strip(work, (enum tile_side)side);
    make_inner_cells(work);
    mesh->live_vertices = mesh->vertex_count;
    mesh->live_triangles = mesh->triangle_count;
    return mesh_connect(work->memory, mesh, work->error);
}

/* ---- what it is measured against ---- */

/* All posts as two samples a cell: those in its south-western and its north-eastern corner. The other two corners of
 * the tile are vertices anyway. */
static enum scree_status list_posts(struct work *work) {
    const struct method_tile *tile = work->tile;
    int32_t span = tile->cell_span;
    work->posts = scree_allocate(work->memory, 2 * (size_t)tile->columns * (size_t)tile->rows, sizeof *work->posts,
                                 "the posts of a tile", work->error);
    if (work->posts == NULL) return SCREE_E_MEMORY;
    struct sample *post = work->posts;
    for (int32_t row = 0; row < tile->rows; row++)
        for (int32_t column = 0; column < tile->columns; column++) {
            *post++ = (struct sample){column * span, row * span, method_post_m(tile, column, row)};
            *post++ = (struct sample){(column + 1) * span, (row + 1) * span, method_post_m(tile, column + 1, row + 1)};
        }
    work->samples.extremes = work->posts;
    return SCREE_OK;
}

static enum scree_status make_samples(struct work *work) {
    const struct method_tile *tile = work->tile;
    work->samples = (struct samples){.columns = tile->columns,
                                     .rows = tile->rows,
                                     .cell_span = tile->cell_span,
                                     .posts = tile->cell_span == 1 ? tile->heights_m : NULL,
                                     .stride = tile->stride};
    if (tile->east_drop_m != 0 || tile->north_drop_m != 0) {
        work->drops_m = scree_allocate(work->memory, (size_t)tile->rows + 1, sizeof *work->drops_m,
                                       "the drops of a tile", work->error);
        if (work->drops_m == NULL) return SCREE_E_MEMORY;
        for (int32_t row = 0; row <= tile->rows; row++) work->drops_m[row] = (float)tile->east_drop_m;
        work->samples.east_drop_m = work->drops_m;
        work->samples.north_drop_m = (float)tile->north_drop_m;
    }
    return tile->cell_span == 1 ? SCREE_OK : list_posts(work);
}

/* ---- the whole ---- */

static enum scree_status simplify(struct work *work, const struct method_qem_options *options) {
    const struct simplify_options own = {.is_unbounded = options->is_unbounded,
                                         .least_vertices = (int32_t)fmin(options->least_vertices, INT32_MAX)};
    mesh_measure(&work->mesh, &work->samples);
    enum scree_status status =
        simplifier_start(work->memory, &work->mesh, &work->samples, &own, &work->simplifier, work->error);
    if (status != SCREE_OK) return status;
    simplify_interior(&work->simplifier, options->is_unbounded ? (float)FINEST_CLASS_M : (float)options->tolerance_m);
    simplifier_release(&work->simplifier);
    if (!options->fits) return SCREE_OK;
    const struct fit_options fit = {.tolerance_m = options->is_unbounded ? INFINITY : options->tolerance_m,
                                    .thins = !options->is_unbounded,
                                    .least_vertices = own.least_vertices};
    return fit_mesh(work->memory, &work->mesh, &work->samples, &fit, work->error);
}

static enum scree_status hand_out(const struct work *work, struct method_mesh *mesh) {
    const struct mesh *made = &work->mesh;
    uint32_t *numbers =
        scree_allocate(work->memory, (size_t)made->vertex_count, sizeof *numbers, "a tile's vertices", work->error);
    mesh->vertices = scree_allocate(work->memory, (size_t)made->live_vertices, sizeof *mesh->vertices,
                                    "a method's vertices", work->error);
    mesh->corners = scree_allocate(work->memory, 3 * (size_t)made->live_triangles, sizeof *mesh->corners,
                                   "a method's triangles", work->error);
    if (numbers == NULL || mesh->vertices == NULL || mesh->corners == NULL) {
        scree_release(work->memory, numbers);
        method_mesh_release(work->memory, mesh);
        return SCREE_E_MEMORY;
    }
    for (int32_t v = 0; v < made->vertex_count; v++) {
        const struct mesh_vertex *vertex = &made->vertices[v];
        if (vertex->edge == MESH_NONE) continue;
        numbers[v] = mesh->vertex_count;
        mesh->vertices[mesh->vertex_count++] =
            (struct method_vertex){vertex->at.x, vertex->at.y, (double)vertex->at.height_m};
    }
    for (int32_t t = 0; t < made->triangle_count; t++) {
        const struct mesh_triangle *triangle = &made->triangles[t];
        if (triangle->vertex[0] == MESH_NONE) continue;
        uint32_t *corner = mesh->corners + 3 * (size_t)mesh->triangle_count++;
        for (int k = 0; k < 3; k++) corner[k] = numbers[triangle->vertex[k]];
    }
    scree_release(work->memory, numbers);
    return SCREE_OK;
}

enum scree_status method_qem(struct scree_memory *memory, const struct method_tile *tile,
                             const struct method_qem_options *options, struct method_mesh *mesh,
                             struct scree_error *error) {
    struct work work = {.tile = tile, .memory = memory, .error = error};
    *mesh = (struct method_mesh){0};
    if (!(options->tolerance_m >= 0) && !options->is_unbounded)
        return scree_fail(error, SCREE_E_ARGUMENT, "qem: a tolerance of %g m is below 0", options->tolerance_m);
    if (tile->columns == 1 || tile->rows == 1) /* no inner posts: the border alone is triangulated */
        return method_greedy(memory, tile, &(struct method_greedy_options){.tolerance_m = INFINITY}, mesh, error);
    enum scree_status status = method_ring_new(memory, tile, &work.ring, &work.ring_count, work.corners, error);
    if (status == SCREE_OK) status = make_mesh(&work);
    if (status == SCREE_OK) status = make_samples(&work);
    if (status == SCREE_OK) status = simplify(&work, options);
    if (status == SCREE_OK) status = hand_out(&work, mesh);
    scree_release(memory, work.drops_m);
    scree_release(memory, work.posts);
    mesh_release(memory, &work.mesh);
    scree_release(memory, work.ring);
    return status;
}
