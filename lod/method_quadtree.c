#include "lod/method_quadtree.h"

#include "lod/mesh.h"
#include "lod/strip.h"
#include "stream/quadtree.h"

#include <math.h>
#include <string.h>

#define SUM_PER_ERROR 16 /* stream/curvature.h says why */

double method_quadtree_threshold(const struct method_tile *tile, double error_m) {
    return SUM_PER_ERROR * error_m / (tile->cell_span * sqrt(tile->east_m * tile->north_m));
}

/* ---- the leaves, with the vertices of the lines ---- */

/* The working mesh: vertices of the lines first, counter-clockwise (as method_ring_new has them), then the leaves'
 * corners; where the two coincide the latter are left out. */
struct weaving {
    const struct method_tile *tile;
    struct mesh *mesh;
    uint32_t ring_count, corners[SIDE_COUNT];
};

/* The side that both points lie on, and their positions; SIDE_COUNT: none. */
static enum tile_side common_side(const struct method_tile *tile, const struct sample *a, const struct sample *b,
                                  int32_t position[2]) {
    bool is_column = a->x == b->x && (a->x == 0 || a->x == method_width(tile));
    bool is_row = a->y == b->y && (a->y == 0 || a->y == method_height(tile));
    if (!is_column && !is_row) return SIDE_COUNT;
    position[0] = is_column ? a->y : a->x;
    position[1] = is_column ? b->y : b->x;
    if (is_column) return a->x == 0 ? SIDE_WEST : SIDE_EAST;
    return a->y == 0 ? SIDE_SOUTH : SIDE_NORTH;
}

static int32_t ring_number(const struct weaving *weaving, enum tile_side side, int32_t in_line) {
    bool is_back = side == SIDE_NORTH || side == SIDE_WEST;
    int32_t last = weaving->tile->lines[side]->vertex_count - 1;
    return (int32_t)((weaving->corners[side] + (uint32_t)(is_back ? last - in_line : in_line)) % weaving->ring_count);
}

/* Where a line has vertices on a side of the triangle, a fan takes its place. At most two sides are on the border, so
 * this calls itself twice at the most. */
static void weave(const struct weaving *weaving, const int32_t corner[3]) {
    struct mesh *mesh = weaving->mesh;
    for (int k = 0; k < 3; k++) {
        int32_t from = corner[k], to = corner[(k + 1) % 3], apex = corner[(k + 2) % 3], position[2];
        enum tile_side side = common_side(weaving->tile, &mesh->vertices[from].at, &mesh->vertices[to].at, position);
        if (side == SIDE_COUNT) continue;
        const struct border_line *line = weaving->tile->lines[side];
        int32_t step = position[0] < position[1] ? 1 : -1; /* the first vertex behind `from`, seen from there */
        int32_t at = border_before(line, step > 0 ? position[0] : position[0] - 1) + (step > 0);
        if ((line->vertices[at].position - position[1]) * step >= 0) continue;
        for (; (line->vertices[at].position - position[1]) * step < 0; at += step) {
            int32_t next = ring_number(weaving, side, at);
            weave(weaving, (int32_t[3]){from, next, apex});
            from = next;
        }
        weave(weaving, (int32_t[3]){from, to, apex});
        return;
    }
    memcpy(mesh->triangles[mesh->triangle_count++].vertex, corner, 3 * sizeof *corner);
}

/* The vertex of a leaf's corner: that of the line where it is kept, else the next one. */
static int32_t vertex_at(const struct weaving *weaving, const struct sample *at) {
    int32_t position[2];
    enum tile_side side = common_side(weaving->tile, at, at, position);
    if (side != SIDE_COUNT && border_keeps(weaving->tile->lines[side], position[0]))
        return ring_number(weaving, side, border_before(weaving->tile->lines[side], position[0]));
    weaving->mesh->vertices[weaving->mesh->vertex_count].at = *at;
    return weaving->mesh->vertex_count++;
}

static enum scree_status fill(struct scree_memory *memory, const struct scree_mesh *leaves, struct weaving *weaving,
                              struct scree_error *error) {
    const struct method_tile *tile = weaving->tile;
    struct mesh *mesh = weaving->mesh;
    struct method_vertex *ring = NULL;
    int32_t *number = NULL;
    enum scree_status status = method_ring_new(memory, tile, &ring, &weaving->ring_count, weaving->corners, error);
    if (status != SCREE_OK) goto cleanup;
    status = mesh_allocate(memory, (int32_t)(leaves->vertex_count + weaving->ring_count),
                           (int32_t)(leaves->triangle_count + weaving->ring_count), mesh, error);
    if (status != SCREE_OK) goto cleanup;
    number = scree_allocate(memory, leaves->vertex_count, sizeof *number, "the numbers of a tile's vertices", error);
    if (number == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    for (uint32_t i = 0; i < weaving->ring_count; i++)
        mesh->vertices[mesh->vertex_count++].at =
            (struct sample){(int32_t)ring[i].x, (int32_t)ring[i].y, (float)ring[i].height_m};
    for (uint32_t i = 0; i < leaves->vertex_count; i++) {
        const struct scree_vertex *at = &leaves->vertices[i];
        number[i] = vertex_at(weaving, &(struct sample){at->x * tile->cell_span, at->y * tile->cell_span,
                                                        method_post_m(tile, at->x, at->y)});
    }
    for (uint32_t t = 0; t < leaves->triangle_count; t++) {
        const uint32_t *corner = leaves->corners + 3 * (size_t)t;
        weave(weaving, (int32_t[3]){number[corner[0]], number[corner[1]], number[corner[2]]});
    }
    status = mesh_connect(memory, mesh, error);
cleanup:
    scree_release(memory, number);
    scree_release(memory, ring);
    return status;
}

static enum scree_status triangulate_leaves(struct scree_memory *memory, const struct method_tile *tile,
                                            double threshold, struct weaving *weaving, struct scree_error *error) {
    const double span = tile->cell_span;
    const struct curvature_posts posts = {.heights_m = tile->heights_m,
                                          .columns = tile->columns + 1,
                                          .rows = tile->rows + 1,
                                          .stride = tile->stride,
                                          .east_m = tile->east_m * span,
                                          .north_m = tile->north_m * span,
                                          .east_drop_m = tile->east_drop_m * span * span,
                                          .north_drop_m = tile->north_drop_m * span * span};
    const struct quadtree_view view = {.threshold = threshold};
    struct quadtree tree;
    struct quadtree_mesh leaves = {0};
    enum scree_status status = quadtree_make(memory, &posts, &tree, error);
    if (status == SCREE_OK) status = quadtree_extract(memory, &tree, &view, &leaves, error);
    quadtree_release(memory, &tree);
    if (status == SCREE_OK) status = fill(memory, &leaves.mesh, weaving, error);
    quadtree_mesh_release(memory, &leaves);
    return status;
}

/* ---- the border ---- */

/* Takes out the leaves' corners that the lines do not keep; in the order of a quadtree's levels, from the finest, so
 * that holes stay small. */
static enum scree_status clear_border(const struct weaving *weaving, struct scree_error *error) {
    const struct method_tile *tile = weaving->tile;
    struct mesh *mesh = weaving->mesh;
    struct star star;
    for (int32_t step = 1; step < tile->columns || step < tile->rows; step *= 2)
        for (int32_t v = (int32_t)weaving->ring_count; v < mesh->vertex_count; v++) {
            int32_t position;
            enum tile_side side =
                border_side(method_width(tile), method_height(tile), &mesh->vertices[v].at, &position);
            if (side == SIDE_COUNT || mesh->vertices[v].edge == MESH_NONE) continue;
            if (position / tile->cell_span % (2 * step) != step) continue;
            if (!mesh_star(mesh, v, &star))
                return scree_fail(error, SCREE_E_LIMIT,
                                  "the tile's border has so many more vertices than its inside that more than %d "
                                  "triangles meet; lower the quadtree's threshold",
                                  MESH_MAX_DEGREE);
            strip_vertex(mesh, &star);
        }
    return SCREE_OK;
}

/* What is left: vertices of the lines, then those inside in the order of the leaves. */
static enum scree_status hand_over(struct scree_memory *memory, const struct mesh *work, struct method_mesh *mesh,
                                   struct scree_error *error) {
    uint32_t *number =
        scree_allocate(memory, (size_t)work->vertex_count, sizeof *number, "the numbers of a tile's vertices", error);
    mesh->vertices =
        scree_allocate(memory, (size_t)work->live_vertices, sizeof *mesh->vertices, "a tile's vertices", error);
    mesh->corners =
        scree_allocate(memory, (size_t)work->live_triangles, 3 * sizeof *mesh->corners, "a tile's triangles", error);
    bool has_memory = number != NULL && mesh->vertices != NULL && mesh->corners != NULL;
    for (int32_t v = 0; v < work->vertex_count && has_memory; v++) {
        const struct sample *at = &work->vertices[v].at;
        if (work->vertices[v].edge == MESH_NONE) continue;
        number[v] = mesh->vertex_count;
        mesh->vertices[mesh->vertex_count++] = (struct method_vertex){at->x, at->y, (double)at->height_m};
    }
    for (int32_t t = 0; t < work->triangle_count && has_memory; t++) {
        const int32_t *corner = work->triangles[t].vertex;
        if (corner[0] == MESH_NONE) continue;
        for (int k = 0; k < 3; k++) mesh->corners[3 * (size_t)mesh->triangle_count + (size_t)k] = number[corner[k]];
        mesh->triangle_count++;
    }
    scree_release(memory, number);
    return has_memory ? SCREE_OK : SCREE_E_MEMORY;
}

enum scree_status method_quadtree(struct scree_memory *memory, const struct method_tile *tile,
                                  const struct method_quadtree_options *options, struct method_mesh *mesh,
                                  struct scree_error *error) {
    struct mesh work = {0};
    struct weaving weaving = {.tile = tile, .mesh = &work};
    *mesh = (struct method_mesh){0};
    enum scree_status status = method_tile_check(tile, error);
    if (status == SCREE_OK) status = triangulate_leaves(memory, tile, options->threshold, &weaving, error);
    if (status == SCREE_OK) status = clear_border(&weaving, error);
    if (status == SCREE_OK) status = hand_over(memory, &work, mesh, error);
    if (status != SCREE_OK) method_mesh_release(memory, mesh);
    mesh_release(memory, &work);
    return status;
}
