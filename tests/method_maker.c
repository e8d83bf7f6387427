#include "tests/method_maker.h"

#include "tests/fractal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *must_allocate(size_t count, size_t size_bytes) {
    void *block = calloc(count + 1, size_bytes);
    if (block == NULL) {
        fprintf(stderr, "no memory for a test's tile\n");
        exit(1);
    }
    return block;
}

/* ---- making ---- */

/* A border's samples: every post, and between two posts the middle where there is one. The middle's height is its own
 * for the fractal, for given heights it is half a metre above the chord, so that something is there to be kept. */
static void make_line(const struct method_recipe *recipe, enum tile_side side, struct made_method_tile *made) {
    const struct method_tile *tile = &made->tile;
    struct border_line *line = &made->lines[side];
    bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
    int32_t span = tile->cell_span, cells = horizontal ? tile->columns : tile->rows;
    int32_t column = side == SIDE_EAST ? tile->columns : 0, row = side == SIDE_NORTH ? tile->rows : 0;
    const struct fractal fractal = {recipe->seed != 0 ? recipe->seed : 7, recipe->whole_metres};
    line->curvature_m = horizontal ? tile->east_drop_m : tile->north_drop_m;
    for (int32_t i = 0; i <= cells; i++) {
        int32_t x = horizontal ? i : column, y = horizontal ? row : i;
        float here_m = method_post_m(tile, x, y);
        line->samples[line->sample_count++] = (struct border_sample){i * span, here_m};
        if (i == cells || span < 2) continue;
        float middle_m = 0.5f * (here_m + method_post_m(tile, horizontal ? i + 1 : x, horizontal ? y : i + 1)) + 0.5f;
        if (recipe->given_heights_m == NULL)
            fractal_window(&fractal, x * span + (horizontal ? span / 2 : 0), y * span + (horizontal ? 0 : span / 2), 1,
                           1, &middle_m, 1);
        line->samples[line->sample_count++] = (struct border_sample){i * span + span / 2, middle_m};
    }
    line->vertex_count = line->sample_count;
    memcpy(line->vertices, line->samples, sizeof *line->samples * (size_t)line->sample_count);
    border_reduce(line, recipe->border_tolerance_m, 0);
}

struct made_method_tile *made_method_tile_new(const struct method_recipe *recipe) {
    struct made_method_tile *made = must_allocate(1, sizeof *made);
    struct method_tile *tile = &made->tile;
    const struct fractal fractal = {recipe->seed != 0 ? recipe->seed : 7, recipe->whole_metres};
    int32_t across = recipe->columns + 1;
    made->heights_m = must_allocate((size_t)across * (size_t)(recipe->rows + 1), sizeof *made->heights_m);
    tile->columns = recipe->columns;
    tile->rows = recipe->rows;
    tile->cell_span = recipe->cell_span > 0 ? recipe->cell_span : 1;
    tile->stride = across;
    tile->heights_m = made->heights_m;
    tile->east_m = tile->north_m = recipe->metres_a_step > 0 ? recipe->metres_a_step : 30;
    if (recipe->is_round) tile->east_drop_m = tile->north_drop_m = tile->east_m * tile->east_m / (2 * 6371000.0);
    for (int32_t y = 0; y <= recipe->rows; y++)
        for (int32_t x = 0; x <= recipe->columns; x++)
            if (recipe->given_heights_m != NULL)
                made->heights_m[y * across + x] = recipe->given_heights_m[y * across + x];
            else
                fractal_window(&fractal, (int64_t)x * tile->cell_span, (int64_t)y * tile->cell_span, 1, 1,
                               &made->heights_m[y * across + x], 1);
    for (int side = 0; side < SIDE_COUNT; side++) {
        make_line(recipe, (enum tile_side)side, made);
        tile->lines[side] = &made->lines[side];
    }
    return made;
}

void made_method_tile_free(struct made_method_tile *made) {
    if (made == NULL) return;
    free(made->heights_m);
    free(made);
}

/* ---- judging ---- */

/* Which side's inside a vertex lies on, as bits; 0: inside of the tile. */
static unsigned sides_of(const struct method_tile *tile, const struct method_vertex *vertex) {
    double width = (double)tile->columns * tile->cell_span, height = (double)tile->rows * tile->cell_span;
    return (vertex->y == 0 ? 1u << SIDE_SOUTH : 0) | (vertex->x == width ? 1u << SIDE_EAST : 0) |
           (vertex->y == height ? 1u << SIDE_NORTH : 0) | (vertex->x == 0 ? 1u << SIDE_WEST : 0);
}

static const char *judge_vertices(const struct method_tile *tile, const struct method_mesh *mesh) {
    double width = (double)tile->columns * tile->cell_span, height = (double)tile->rows * tile->cell_span;
    uint32_t on_side[SIDE_COUNT] = {0};
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const struct method_vertex *vertex = &mesh->vertices[v];
        unsigned sides = sides_of(tile, vertex);
        if (!isfinite(vertex->height_m)) return "a height is not finite";
        if (!(vertex->x >= 0 && vertex->x <= width && vertex->y >= 0 && vertex->y <= height))
            return "a vertex is outside";
        for (int side = 0; side < SIDE_COUNT; side++) {
            if ((sides & 1u << side) == 0) continue;
            double along = side == SIDE_SOUTH || side == SIDE_NORTH ? vertex->x : vertex->y;
            const struct border_line *line = tile->lines[side];
            if (along != floor(along) || !border_keeps(line, (int32_t)along))
                return "a vertex on the border is not on its line";
            if ((double)line->vertices[border_before(line, (int32_t)along)].height_m != vertex->height_m)
                return "a border vertex has another height than its line";
            on_side[side]++;
        }
    }
    for (int side = 0; side < SIDE_COUNT; side++)
        if (on_side[side] != (uint32_t)tile->lines[side]->vertex_count)
            return "a border line's vertices are not there once each";
    return NULL;
}

static int compare_keys(const void *left, const void *right) {
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

/* Whether a directed edge that has no twin leads along the border, counter-clockwise, to the line's next vertex. */
static bool is_border_edge(const struct method_tile *tile, const struct method_mesh *mesh, uint32_t from, uint32_t to) {
    const struct method_vertex *a = &mesh->vertices[from], *b = &mesh->vertices[to];
    unsigned common = sides_of(tile, a) & sides_of(tile, b);
    for (int side = 0; side < SIDE_COUNT; side++) {
        if ((common & 1u << side) == 0) continue;
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH, back = side == SIDE_NORTH || side == SIDE_WEST;
        int32_t at = border_before(tile->lines[side], (int32_t)(horizontal ? a->x : a->y));
        int32_t next = border_before(tile->lines[side], (int32_t)(horizontal ? b->x : b->y));
        return next == (back ? at - 1 : at + 1);
    }
    return false;
}

static const char *judge_edges(const struct method_tile *tile, const struct method_mesh *mesh) {
    size_t count = 3 * (size_t)mesh->triangle_count, open = 0, ring = 0;
    uint64_t *edges = must_allocate(count, sizeof *edges);
    const char *fault = NULL;
    for (size_t c = 0; c < count; c++) {
        uint64_t from = mesh->corners[c], to = mesh->corners[c % 3 == 2 ? c - 2 : c + 1];
        edges[c] = from << 32 | to;
    }
    qsort(edges, count, sizeof *edges, compare_keys);
    for (size_t c = 0; c < count && fault == NULL; c++) {
        uint64_t back = edges[c] << 32 | edges[c] >> 32;
        if (c > 0 && edges[c] == edges[c - 1]) fault = "an edge has two triangles on one side";
        if (bsearch(&back, edges, count, sizeof *edges, compare_keys) != NULL) continue;
        open++;
        if (!is_border_edge(tile, mesh, (uint32_t)(edges[c] >> 32), (uint32_t)edges[c])) fault = "an edge is open";
    }
    for (int side = 0; side < SIDE_COUNT; side++) ring += (size_t)tile->lines[side]->vertex_count - 1;
    if (fault == NULL && open != ring) fault = "the border is not closed";
    free(edges);
    return fault;
}

static const char *judge_triangles(const struct method_tile *tile, const struct method_mesh *mesh) {
    double sum = 0, whole = 2.0 * tile->columns * tile->cell_span * (double)tile->rows * tile->cell_span;
    unsigned char *used = must_allocate(mesh->vertex_count, 1);
    uint32_t used_count = 0;
    const char *fault = NULL;
    for (uint32_t t = 0; t < mesh->triangle_count && fault == NULL; t++) {
        const struct method_vertex *at[3];
        for (int k = 0; k < 3; k++) {
            uint32_t corner = mesh->corners[3 * (size_t)t + (size_t)k];
            if (corner >= mesh->vertex_count) {
                free(used);
                return "a triangle has a corner that does not exist";
            }
            at[k] = &mesh->vertices[corner];
            used_count += !used[corner];
            used[corner] = 1;
        }
        double area2 = (at[1]->x - at[0]->x) * (at[2]->y - at[0]->y) - (at[1]->y - at[0]->y) * (at[2]->x - at[0]->x);
        if (!(area2 > 0)) fault = "a triangle is flat or clockwise";
        sum += area2;
    }
    free(used);
    if (fault == NULL && used_count != mesh->vertex_count) fault = "a vertex belongs to no triangle";
    if (fault == NULL && !(fabs(sum - whole) <= 1e-9 * whole)) fault = "the areas do not add up to the tile's";
    return fault;
}

/* Each triangle's posts, one by one over its bounding box; the mesh covers the tile, so every post is met. */
static void judge_error(const struct method_tile *tile, const struct method_mesh *mesh,
                        struct method_verdict *verdict) {
    int32_t across = tile->columns + 1, span = tile->cell_span;
    double *error_m = must_allocate((size_t)across * (size_t)(tile->rows + 1), sizeof *error_m), sum_m2 = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const struct method_vertex *a = &mesh->vertices[mesh->corners[3 * (size_t)t]];
        const struct method_vertex *b = &mesh->vertices[mesh->corners[3 * (size_t)t + 1]];
        const struct method_vertex *c = &mesh->vertices[mesh->corners[3 * (size_t)t + 2]];
        double za = a->height_m - method_drop_m(tile, a->x, a->y), zb = b->height_m - method_drop_m(tile, b->x, b->y);
        double zc = c->height_m - method_drop_m(tile, c->x, c->y);
        double area2 = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
        for (int32_t y = (int32_t)(fmin(a->y, fmin(b->y, c->y)) / span); y <= fmax(a->y, fmax(b->y, c->y)) / span; y++)
            for (int32_t x = (int32_t)(fmin(a->x, fmin(b->x, c->x)) / span); x <= fmax(a->x, fmax(b->x, c->x)) / span;
                 x++) {
                double px = (double)x * span, py = (double)y * span;
                double wb = ((px - a->x) * (c->y - a->y) - (py - a->y) * (c->x - a->x)) / area2;
                double wc = ((b->x - a->x) * (py - a->y) - (b->y - a->y) * (px - a->x)) / area2;
                if (wb < -1e-9 || wc < -1e-9 || wb + wc > 1 + 1e-9) continue;
                double post_m = (double)method_post_m(tile, x, y) - method_drop_m(tile, px, py);
                error_m[y * across + x] = fabs(post_m - (za + wb * (zb - za) + wc * (zc - za)));
            }
    }
    for (int32_t i = 0; i < across * (tile->rows + 1); i++) {
        verdict->max_m = fmax(verdict->max_m, error_m[i]);
        sum_m2 += error_m[i] * error_m[i];
    }
    verdict->rms_m = sqrt(sum_m2 / (across * (tile->rows + 1)));
    free(error_m);
}

struct method_verdict method_judge(const struct method_tile *tile, const struct method_mesh *mesh) {
    struct method_verdict verdict = {.fault = judge_vertices(tile, mesh)};
    if (verdict.fault == NULL) verdict.fault = judge_triangles(tile, mesh);
    if (verdict.fault == NULL) verdict.fault = judge_edges(tile, mesh);
    verdict.is_triangulation = verdict.fault == NULL;
    if (verdict.is_triangulation) judge_error(tile, mesh, &verdict);
    return verdict;
}

bool method_meshes_equal(const struct method_mesh *one, const struct method_mesh *other) {
    if (one->vertex_count != other->vertex_count || one->triangle_count != other->triangle_count) return false;
    for (uint32_t v = 0; v < one->vertex_count; v++)
        if (one->vertices[v].x != other->vertices[v].x || one->vertices[v].y != other->vertices[v].y ||
            one->vertices[v].height_m != other->vertices[v].height_m)
            return false;
    return memcmp(one->corners, other->corners, 3 * sizeof *one->corners * one->triangle_count) == 0;
}
