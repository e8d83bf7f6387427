#include "lod/tile.h"

#include "lod/code_collapse.h"
#include "lod/extremes.h"
#include "lod/merge.h"
#include "lod/quadric.h"
#include "lod/tile_lines.h"
#include "lod/tile_parts.h"
#include "lod/tile_samples.h"

#include <math.h>
#include <string.h>

#define ROUNDING_SHARE 0.125f /* of the tolerance, for what position codes may move */

/* ---- heights ---- */

int32_t tile_height_units(const struct tile *tile, double height_m) {
    return (int32_t)lround(height_m / tile->geometry.height_unit_m);
}

void tile_place_vertices(struct tile *tile) {
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++)
        tile->mesh.vertices[v].at.height_m = (float)(tile->mesh.heights[v] * tile->geometry.height_unit_m);
}

enum scree_status tile_begin(struct scree_memory *memory, const struct tile_geometry *geometry, struct tile *tile,
                             struct scree_error *error) {
    memset(tile, 0, sizeof *tile);
    tile->memory = memory;
    tile->geometry = *geometry;
    if (geometry->east_drop_m == NULL) return SCREE_OK;
    size_t rows = (size_t)extremes_cells(geometry->rows, geometry->cell_span) + 1;
    tile->east_drop_m = scree_allocate(memory, rows, sizeof *tile->east_drop_m, "a tile's rows", error);
    if (tile->east_drop_m == NULL) return SCREE_E_MEMORY;
    memcpy(tile->east_drop_m, geometry->east_drop_m, rows * sizeof *tile->east_drop_m);
    return SCREE_OK;
}

struct samples tile_own_samples(const struct tile *tile) {
    const struct tile_geometry *geometry = &tile->geometry;
    return (struct samples){.columns = extremes_cells(geometry->columns, geometry->cell_span),
                            .rows = extremes_cells(geometry->rows, geometry->cell_span),
                            .cell_span = geometry->cell_span,
                            .east_drop_m = tile->east_drop_m,
                            .north_drop_m = geometry->north_drop_m};
}

/* ---- a tile of posts ---- */

/* The two triangles of cell (x, y), with its diagonal rising from the south-west or falling from the north-west:
 *
 *     c---d   rising: (a, b, d), (d, c, a); falling: (a, b, c), (d, c, b). Half-edge 0 of the first lies in the south,
 *     | / |   of the second in the north; the vertical ones are 1 in triangles with the diagonal at 2 (rising) and
 *     a---b   2 in those with the diagonal at 1 (falling). */
static void make_cell(struct mesh *mesh, int32_t columns, int32_t rows, int32_t x, int32_t y) {
    int32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
    int32_t first = 2 * (y * columns + x), second = first + 1;
    bool rising = ((x + y) & 1) == 0;
    struct mesh_triangle *low = &mesh->triangles[first], *high = &mesh->triangles[second];
    memcpy(low->vertex, (int32_t[3]){a, b, rising ? d : c}, sizeof low->vertex);
    memcpy(high->vertex, (int32_t[3]){d, c, rising ? a : b}, sizeof high->vertex);
    int diagonal = rising ? 2 : 1, upright = rising ? 1 : 2;
    low->twin[0] = y > 0 ? 4 * (second - 2 * columns) : MESH_NONE;
    high->twin[0] = y < rows - 1 ? 4 * (first + 2 * columns) : MESH_NONE;
    low->twin[diagonal] = 4 * second + diagonal;
    high->twin[diagonal] = 4 * first + diagonal;
    /* a rising cell has its low triangle in the east, a falling one in the west; neighbours are the other kind */
    int32_t east = rising ? first : second, west = rising ? second : first;
    mesh->triangles[east].twin[upright] = x < columns - 1 ? 4 * (east + 2) + 3 - upright : MESH_NONE;
    mesh->triangles[west].twin[upright] = x > 0 ? 4 * (west - 2) + 3 - upright : MESH_NONE;
}

/* Gives every vertex its outgoing edge; on the border the border edge, which has the last word. */
static void give_edges(struct mesh *mesh) {
    for (int pass = 0; pass < 2; pass++)
        for (int32_t t = 0; t < mesh->triangle_count; t++)
            for (int i = 0; i < 3; i++)
                if (pass == 0 || mesh->triangles[t].twin[i] == MESH_NONE)
                    mesh->vertices[mesh->triangles[t].vertex[i]].edge = 4 * t + i;
}

/* The full grid of a tile, with alternating diagonals; `step` lattice steps from post to post. */
static enum scree_status make_grid(struct tile *tile, int32_t step, struct scree_error *error) {
    int32_t columns = tile->geometry.columns / step, rows = tile->geometry.rows / step;
    enum scree_status status =
        mesh_allocate(tile->memory, (columns + 1) * (rows + 1), 2 * columns * rows, &tile->mesh, error);
    if (status != SCREE_OK) return status;
    struct mesh *mesh = &tile->mesh;
    for (int32_t y = 0; y <= rows; y++)
        for (int32_t x = 0; x <= columns; x++)
            mesh->vertices[mesh->vertex_count++].at = (struct sample){x * step, y * step, 0};
    mesh->live_vertices = mesh->vertex_count;
    mesh->live_triangles = mesh->triangle_count = mesh->triangle_capacity;
    for (int32_t y = 0; y < rows; y++)
        for (int32_t x = 0; x < columns; x++) make_cell(mesh, columns, rows, x, y);
    give_edges(mesh);
    return SCREE_OK;
}

static void start_line(struct tile *tile, enum tile_side side, int32_t step, const float *heights_m, int32_t stride) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t length = side == SIDE_SOUTH || side == SIDE_NORTH ? geometry->columns : geometry->rows;
    tile_line_start(&tile->lines[side], length, step, geometry->side_drop_m[side], geometry->height_unit_m, heights_m,
                    stride);
}

enum scree_status tile_begin_rest(struct tile *tile, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    struct coarse_tile *rest = scree_allocate(tile->memory, 1, sizeof *rest, "a tile's remains", error);
    if (rest == NULL) return SCREE_E_MEMORY;
    tile->rest = rest;
    rest->columns = geometry->columns;
    rest->rows = geometry->rows;
    rest->cell_span = (geometry->keeps_cells ? 1 : 2) * geometry->cell_span;
    rest->cell_columns = extremes_cells(geometry->columns, rest->cell_span);
    rest->cell_rows = extremes_cells(geometry->rows, rest->cell_span);
    bool leaves_pairs = tile->cell_first == NULL || !geometry->keeps_cells;
    if (leaves_pairs)
        rest->extremes = scree_allocate(tile->memory, 2 * (size_t)rest->cell_columns * (size_t)rest->cell_rows,
                                        sizeof *rest->extremes, "a tile's extremes", error);
    if (leaves_pairs && rest->extremes == NULL) return SCREE_E_MEMORY;
    int32_t across = geometry->keeps_cells ? 1 : 2;
    return slope_grid_allocate(tile->memory, (tile->slopes.columns - 1) / across + 1,
                               (tile->slopes.rows - 1) / across + 1, rest->cell_span, &rest->slopes, error);
}

enum scree_status tile_begin_simplifier(struct tile *tile, struct scree_error *error) {
    struct simplify_options options = {.locked_step = tile->geometry.locked_step};
    return simplifier_start(tile->memory, &tile->mesh, &tile->samples, &options, &tile->simplifier, error);
}

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
    if ((status = make_grid(tile, 1, error)) != SCREE_OK) goto failed;
    if ((status = use_posts(tile, posts, error)) != SCREE_OK) goto failed;
    start_line(tile, SIDE_SOUTH, 1, heights_m, 1);
    start_line(tile, SIDE_EAST, 1, heights_m + geometry->columns, posts->stride);
    start_line(tile, SIDE_NORTH, 1, heights_m + last_row, 1);
    start_line(tile, SIDE_WEST, 1, heights_m, posts->stride);
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

/* ---- a tile of extremes ---- */

static enum scree_status use_extremes(struct tile *tile, const struct coarse_tile *const children[4],
                                      int32_t child_span, struct scree_error *error) {
    tile->samples = tile_own_samples(tile);
    tile->extremes = scree_allocate(tile->memory, 2 * (size_t)tile->samples.columns * (size_t)tile->samples.rows,
                                    sizeof *tile->extremes, "extremes", error);
    if (tile->extremes == NULL) return SCREE_E_MEMORY;
    tile->samples.extremes = tile->extremes;
    for (int i = 0; i < 4; i++) {
        if (children[i] == NULL) continue;
        int32_t x = i % 2 * child_span, y = i / 2 * child_span, span = tile->geometry.cell_span;
        extremes_place(children[i]->extremes, children[i]->cell_columns, children[i]->cell_rows, x / span, y / span, x,
                       y, tile->extremes, tile->samples.columns);
    }
    return SCREE_OK;
}

static enum scree_status use_slopes(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t span = geometry->cell_span;
    enum scree_status status = slope_grid_allocate(tile->memory, geometry->columns / span + 1,
                                                   geometry->rows / span + 1, span, &tile->slopes, error);
    for (int i = 0; i < 4 && status == SCREE_OK; i++)
        if (children[i] != NULL)
            slope_grid_place(&children[i]->slopes, i % 2 * child_span / span, i / 2 * child_span / span, &tile->slopes);
    return status;
}

void tile_hand_up_slopes(struct tile *tile) {
    struct slope_grid *handed = &tile->rest->slopes;
    if (tile->geometry.keeps_cells)
        slope_grid_place(&tile->slopes, 0, 0, handed);
    else
        slope_grid_reduce(&tile->slopes, handed);
}

static enum scree_status finish_extremes(struct tile *tile, struct scree_error *error) {
    enum scree_status status = tile_begin_rest(tile, error);
    if (status != SCREE_OK) return status;
    if (tile->cell_first != NULL && !tile->geometry.keeps_cells)
        tile_samples_leave_pairs(tile);
    else if (tile->cell_first == NULL && tile->geometry.keeps_cells)
        memcpy(tile->rest->extremes, tile->extremes,
               2 * (size_t)tile->samples.columns * (size_t)tile->samples.rows * sizeof *tile->extremes);
    else if (tile->cell_first == NULL)
        extremes_reduce(tile->extremes, tile->samples.columns, tile->samples.rows, tile->rest->extremes);
    tile_hand_up_slopes(tile);
    return SCREE_OK;
}

static enum scree_status border_is_closed(const struct tile *tile, struct scree_error *error) {
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++) {
        const struct mesh_vertex *vertex = &tile->mesh.vertices[v];
        const struct sample *at = &vertex->at;
        bool on_border = at->x == 0 || at->y == 0 || at->x == tile->geometry.columns || at->y == tile->geometry.rows;
        if (!on_border && mesh_twin(&tile->mesh, vertex->edge) == MESH_NONE)
            return scree_fail(error, SCREE_E_CORRUPT, "tiles disagree about the vertices of a common border");
    }
    return SCREE_OK;
}

static enum scree_status join_lines(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error) {
    const struct border_line *lines[4];
    for (int i = 0; i < 4; i++) lines[i] = children[i] != NULL ? children[i]->lines : NULL;
    return tile_lines_join(lines, child_span, tile->geometry.cell_span, tile->cell_first != NULL,
                           tile->geometry.side_drop_m, tile->lines, error);
}

int32_t tile_child_span(const struct coarse_tile *const children[4]) {
    if (children[2] != NULL) return children[0]->rows;
    if (children[1] != NULL) return children[0]->columns;
    return children[0]->columns > children[0]->rows ? children[0]->columns : children[0]->rows;
}

enum scree_status tile_from_children(struct scree_memory *memory, const struct tile_geometry *geometry,
                                     const struct coarse_tile *const children[4], struct tile *tile,
                                     struct scree_error *error) {
    enum scree_status status;
    const struct scree_mesh *meshes[4];
    int32_t child_span = tile_child_span(children);
    if ((status = tile_begin(memory, geometry, tile, error)) != SCREE_OK) return status;
    for (int i = 0; i < 4; i++) meshes[i] = children[i] != NULL ? &children[i]->mesh : NULL;
    if ((status = mesh_merge(memory, meshes, child_span, &tile->mesh, error)) != SCREE_OK) goto failed;
    if ((status = border_is_closed(tile, error)) != SCREE_OK) goto failed;
    status = tile_samples_are_whole(children) ? tile_samples_join(tile, children, child_span, error)
                                              : use_extremes(tile, children, child_span, error);
    if (status != SCREE_OK) goto failed;
    if ((status = use_slopes(tile, children, child_span, error)) != SCREE_OK) goto failed;
    if ((status = join_lines(tile, children, child_span, error)) != SCREE_OK) goto failed;
    tile_place_vertices(tile);
    if ((status = finish_extremes(tile, error)) != SCREE_OK) goto failed;
    mesh_measure(&tile->mesh, &tile->samples);
    if ((status = tile_begin_simplifier(tile, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    tile_release(tile);
    return status;
}

/* ---- a tile without data ---- */

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
    if ((status = make_grid(tile, step, error)) != SCREE_OK) goto failed;
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++) tile->mesh.heights[v] = tile_height_units(tile, height_m);
    for (int side = 0; side < SIDE_COUNT; side++) start_line(tile, (enum tile_side)side, step, &height, 0);
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

/* ---- any tile ---- */

/* A code is off by half a step at the most. */
static float rounding_steps(struct code_frame codes) {
    return (float)(0.5 * (double)codes.span / POSITION_TOP);
}

struct samples tile_samples_written(const struct tile *tile, struct code_frame codes, double tolerance_m) {
    struct samples samples = tile->samples;
    samples.rounding_steps = rounding_steps(codes);
    samples.rounding_limit_m = ROUNDING_SHARE * (float)tolerance_m;
    return samples;
}

void tile_set_codes(struct tile *tile, struct code_frame codes) {
    tile->simplifier.options.codes = codes;
    tile->simplifier.samples.rounding_steps = rounding_steps(codes);
}

/* The first rung to come has come, as far as the border goes. */
static void look_further(struct tile *tile) {
    tile->ahead.next++;
    if (tile->ahead.next == tile->ahead.count) tile->simplifier.options.ahead = NULL;
}

static enum scree_status advance(struct tile *tile, double tolerance_m, bool written, struct scree_error *error) {
    struct simplifier *simplifier = &tile->simplifier;
    bool looks_ahead = simplifier->options.ahead != NULL;
    float bound_m = looks_ahead ? tile->ahead.rungs[tile->ahead.next].tolerance_m : (float)tolerance_m;
    simplifier->samples.rounding_limit_m = looks_ahead && !written ? 0 : ROUNDING_SHARE * bound_m;
    tile_lines_reduce(tile->lines, tolerance_m, tile->geometry.locked_step,
                      written ? &simplifier->options.codes : NULL);
    enum scree_status status =
        border_collapse(simplifier, tile->lines, tile->geometry.columns, tile->geometry.rows, bound_m, error);
    if (status != SCREE_OK) return status;
    if (looks_ahead) look_further(tile);
    simplify_interior(simplifier, bound_m);
    if (!written || code_collapse(simplifier) == 0) return SCREE_OK;
    return scree_fail(error, SCREE_E_LIMIT, "a tile's triangles are too small for the position codes of a coarse zoom");
}

enum scree_status tile_advance(struct tile *tile, double tolerance_m, struct scree_error *error) {
    return advance(tile, tolerance_m, true, error);
}

enum scree_status tile_advance_between(struct tile *tile, double tolerance_m, struct scree_error *error) {
    return advance(tile, tolerance_m, false, error);
}

/* The rounding of positions comes with a written rung; room is left for it in the rungs before. */
static float bound_of(const struct tile_rung *rung) {
    if (rung->codes.span != 0) return (float)rung->tolerance_m;
    const struct tile_rung *written = rung;
    while (written->codes.span == 0) written++;
    return fminf((float)rung->tolerance_m, (1 - ROUNDING_SHARE) * (float)written->tolerance_m);
}

enum scree_status tile_look_ahead(struct tile *tile, const struct tile_rung *rungs, int count,
                                  struct scree_error *error) {
    struct ahead *ahead = &tile->ahead;
    ahead->rungs = scree_allocate(tile->memory, (size_t)count, sizeof *ahead->rungs, "rungs to come", error);
    if (ahead->rungs == NULL) return SCREE_E_MEMORY;
    ahead->columns = tile->geometry.columns;
    ahead->rows = tile->geometry.rows;
    ahead->count = count;
    for (int i = 0; i < count; i++) {
        struct ahead_rung *rung = &ahead->rungs[i];
        rung->tolerance_m = bound_of(&rungs[i]);
        rung->codes = rungs[i].codes;
        rung->samples = tile->samples;
        rung->samples.rounding_steps = rounding_steps(rung->codes);
        rung->samples.rounding_limit_m = ROUNDING_SHARE * rung->tolerance_m;
        memcpy(rung->lines, i == 0 ? tile->lines : rung[-1].lines, sizeof rung->lines);
        tile_lines_reduce(rung->lines, rungs[i].tolerance_m, tile->geometry.locked_step,
                          rung->codes.span != 0 ? &rung->codes : NULL);
    }
    tile->simplifier.options.ahead = ahead;
    return SCREE_OK;
}

double tile_max_error_m(const struct tile *tile) {
    return mesh_max_error_m(&tile->mesh, &tile->samples);
}

double tile_mmqe_m2(const struct tile *tile) {
    return quadric_mmqe_m2(&tile->mesh, &tile->samples, tile->geometry.east_m, tile->geometry.north_m);
}

enum scree_status tile_hand_up_new(struct tile *tile, struct coarse_tile **coarse, struct scree_error *error) {
    enum scree_status status = mesh_export_new(tile->memory, &tile->mesh, &tile->rest->mesh, error);
    if (status != SCREE_OK) return status;
    memcpy(tile->rest->lines, tile->lines, sizeof tile->lines);
    tile->rest->max_error_m = tile_max_error_m(tile);
    if (tile->cell_first != NULL && tile->geometry.keeps_cells) tile_samples_hand_up(tile);
    *coarse = tile->rest;
    tile->rest = NULL;
    return SCREE_OK;
}

void tile_release(struct tile *tile) {
    if (tile == NULL || tile->memory == NULL) return;
    if (tile->simplifier.memory != NULL) simplifier_release(&tile->simplifier);
    coarse_tile_free(tile->memory, tile->rest);
    slope_grid_release(tile->memory, &tile->slopes);
    scree_release(tile->memory, tile->extremes);
    scree_release(tile->memory, tile->cell_first);
    scree_release(tile->memory, tile->posts);
    scree_release(tile->memory, tile->east_drop_m);
    scree_release(tile->memory, tile->ahead.rungs);
    mesh_release(tile->memory, &tile->mesh);
    memset(tile, 0, sizeof *tile);
}

void coarse_tile_free(struct scree_memory *memory, struct coarse_tile *coarse) {
    if (coarse == NULL) return;
    scree_release(memory, coarse->mesh.corners);
    scree_release(memory, coarse->mesh.vertices);
    scree_release(memory, coarse->fitted.mesh.corners);
    scree_release(memory, coarse->fitted.mesh.vertices);
    slope_grid_release(memory, &coarse->slopes);
    scree_release(memory, coarse->extremes);
    scree_release(memory, coarse->cell_first);
    scree_release(memory, coarse);
}
