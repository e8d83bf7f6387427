/* Tiles from posts, from children and from nothing: neighbours meet at every rung, parents are the union of their
 * children, and nothing that was measured is lost on the way up. */
#include "lod/tile.h"
#include "src/tile_build.h"
#include "tests/fractal.h"
#include "tests/mesh_maker.h"
#include "tests/raster_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OCTAVE   4 /* rungs */
#define UNIT_M   0.0625
#define MAX_SIDE 257

/* ---- tiles of a fractal field ---- */

static struct tile_geometry flat_geometry(int32_t columns, int32_t rows, int32_t cell_span) {
    return (struct tile_geometry){
        .columns = columns, .rows = rows, .cell_span = cell_span, .height_unit_m = UNIT_M, .east_m = 30, .north_m = 25};
}

/* The tile whose south-western post is (x, y) of the field. */
static enum scree_status tile_of_field(struct scree_memory *memory, int64_t x, int64_t y, int32_t columns, int32_t rows,
                                       struct tile *tile) {
    static float heights_m[(MAX_SIDE + 2) * (MAX_SIDE + 2)];
    double east_m[MAX_SIDE], north_m[MAX_SIDE];
    const struct fractal fractal = {21, true};
    const struct tile_geometry geometry = flat_geometry(columns, rows, 1);
    fractal_window(&fractal, x - 1, y - 1, columns + 3, rows + 3, heights_m, columns + 3);
    for (int32_t row = 0; row <= rows; row++) {
        east_m[row] = 30 - 1e-3 * (double)(y + row);
        north_m[row] = 25;
    }
    struct tile_posts posts = {heights_m + columns + 3 + 1, columns + 3, east_m, north_m};
    return tile_from_posts(memory, &geometry, &posts, tile, NULL);
}

static void check(const struct tile *tile) {
    const char *fault = mesh_fault(&tile->mesh, tile->geometry.columns, tile->geometry.rows);
    if (fault != NULL) printf("\n    %s\n", fault);
    CU_ASSERT_PTR_NULL_FATAL(fault);
}

static void advance(struct tile *tile, double tolerance_m) {
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(tile_advance(tile, tolerance_m, &error), SCREE_OK);
    if (error.status != SCREE_OK) printf("\n    %s\n", error.text);
    check(tile);
}

/* Heights of the mesh's vertices along a side, by position; INT32_MIN where there is none. */
static int32_t border_heights(const struct tile *tile, enum tile_side side, int32_t *heights, int32_t length) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t count = 0;
    for (int32_t i = 0; i <= length; i++) heights[i] = INT32_MIN;
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++) {
        const struct sample *at = &tile->mesh.vertices[v].at;
        if (tile->mesh.vertices[v].edge == MESH_NONE) continue;
        if (side == SIDE_WEST ? at->x != 0 : side == SIDE_EAST && at->x != geometry->columns) continue;
        if (side == SIDE_SOUTH ? at->y != 0 : side == SIDE_NORTH && at->y != geometry->rows) continue;
        heights[side == SIDE_WEST || side == SIDE_EAST ? at->y : at->x] = tile->mesh.heights[v];
        count++;
    }
    return count;
}

static void check_common_border(const struct tile *tile, enum tile_side side, const struct tile *other,
                                enum tile_side other_side) {
    bool upright = side == SIDE_WEST || side == SIDE_EAST;
    int32_t length = upright ? tile->geometry.rows : tile->geometry.columns;
    size_t size_bytes = ((size_t)length + 1) * sizeof(int32_t);
    int32_t *heights = malloc(size_bytes), *other_heights = malloc(size_bytes);
    CU_ASSERT_FATAL(heights != NULL && other_heights != NULL);
    int32_t count = border_heights(tile, side, heights, length);
    CU_ASSERT_EQUAL(border_heights(other, other_side, other_heights, length), count);
    CU_ASSERT_EQUAL(memcmp(heights, other_heights, size_bytes), 0);
    CU_ASSERT_EQUAL(tile->lines[side].vertex_count, count);
    free(other_heights);
    free(heights);
}

static void neighbours_meet_at_every_rung(void) {
    static struct tile tile, east, north;
    struct scree_memory memory = {0};
    CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 512, 256, 256, 256, &tile), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 768, 256, 256, 256, &east), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 512, 512, 256, 256, &north), SCREE_OK);
    advance(&north, 1.5); /* came another way */
    for (double tolerance_m = 3; tolerance_m < 200; tolerance_m *= 2) {
        advance(&tile, tolerance_m);
        advance(&east, tolerance_m);
        advance(&north, tolerance_m);
        check_common_border(&tile, SIDE_EAST, &east, SIDE_WEST);
        check_common_border(&tile, SIDE_NORTH, &north, SIDE_SOUTH);
        /* the first rung comes from the full grid; border sets are law for the others and may pass the tolerance */
        CU_ASSERT(tile_max_error_m(&tile) <= (tolerance_m == 3 ? 3 : 1.25 * tolerance_m));
    }
    CU_ASSERT(tile.lines[SIDE_EAST].vertex_count < 40);
    tile_release(&north);
    tile_release(&east);
    tile_release(&tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* Two octaves down to a written rung, one more to that of the zoom above: what border lines drop never makes a tile
 * pass a tolerance. A tile that does not look ahead does pass some. */
static void what_is_looked_ahead_at_is_within_reach(void) {
    static struct tile tile, blind;
    struct scree_memory memory = {0};
    struct tile_rung rungs[3 * OCTAVE + 1] = {0};
    const int count = 3 * OCTAVE + 1;
    int blind_passes = 0;
    for (int i = 0; i < count; i++) rungs[i].tolerance_m = exp2((double)i / OCTAVE);
    rungs[2 * OCTAVE].codes = (struct code_frame){256, 0, 0};
    rungs[count - 1].codes = (struct code_frame){512, 256, 0};
    for (int32_t columns = 256; columns > 1; columns /= 17) {
        CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 512, 256, columns, 256, &tile), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 512, 256, columns, 256, &blind), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_look_ahead(&tile, rungs, count, NULL), SCREE_OK);
        for (int i = 0; i < count; i++) {
            bool written = rungs[i].codes.span != 0;
            struct scree_error error = {0};
            if (i == 0) tile_set_codes(&tile, rungs[2 * OCTAVE].codes);
            if (i == 2 * OCTAVE + 1) tile_set_codes(&tile, rungs[count - 1].codes);
            CU_ASSERT_EQUAL((written ? tile_advance : tile_advance_between)(&tile, rungs[i].tolerance_m, &error),
                            SCREE_OK);
            if (error.status != SCREE_OK) printf("\n    %s\n", error.text);
            check(&tile);
            CU_ASSERT(tile_max_error_m(&tile) <= rungs[i].tolerance_m);
            CU_ASSERT_EQUAL(tile_advance_between(&blind, rungs[i].tolerance_m, NULL), SCREE_OK);
            blind_passes += tile_max_error_m(&blind) > rungs[i].tolerance_m;
            check_common_border(&tile, SIDE_EAST, &blind, SIDE_EAST);
        }
        CU_ASSERT(tile.mesh.live_triangles < 1.02 * blind.mesh.live_triangles + 20);
        tile_release(&blind);
        tile_release(&tile);
    }
    CU_ASSERT(blind_passes > 0);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- parents ---- */

/* The children of the parent at (x, y), taken down to a tolerance; `span` steps a side. */
static void make_children(struct scree_memory *memory, int64_t x, int64_t y, int32_t span, double tolerance_m,
                          struct coarse_tile *children[4]) {
    static struct tile tile;
    for (int i = 0; i < 4; i++) {
        CU_ASSERT_EQUAL_FATAL(tile_of_field(memory, x + i % 2 * span, y + i / 2 * span, span, span, &tile), SCREE_OK);
        advance(&tile, tolerance_m);
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(&tile, &children[i], NULL), SCREE_OK);
        tile_release(&tile);
    }
}

static enum scree_status make_parent(struct scree_memory *memory, int32_t columns, int32_t rows,
                                     struct coarse_tile *const children[4], struct tile *tile) {
    const struct coarse_tile *const views[4] = {children[0], children[1], children[2], children[3]};
    const struct tile_geometry geometry = flat_geometry(columns, rows, children[0]->cell_span);
    return tile_from_children(memory, &geometry, views, tile, NULL);
}

static void free_children(struct scree_memory *memory, struct coarse_tile *children[4]) {
    for (int i = 0; i < 4; i++) coarse_tile_free(memory, children[i]);
}

/* A triangle by its corners' places, the least first, so that equal ones look equal; a vertex has all three alike. */
struct shape {
    int32_t x[3], y[3], height[3];
};

static int by_bytes(const void *left, const void *right) {
    return memcmp(left, right, sizeof(struct shape));
}

static void add_shape(const struct scree_mesh *mesh, const uint32_t corner[3], int32_t x, int32_t y,
                      struct shape *shape) {
    int first = 0;
    for (int i = 1; i < 3; i++) {
        const struct scree_vertex *a = &mesh->vertices[corner[i]], *b = &mesh->vertices[corner[first]];
        if (a->x < b->x || (a->x == b->x && a->y < b->y)) first = i;
    }
    for (int i = 0; i < 3; i++) {
        const struct scree_vertex *at = &mesh->vertices[corner[(first + i) % 3]];
        shape->x[i] = at->x + x;
        shape->y[i] = at->y + y;
        shape->height[i] = at->height;
    }
}

/* Lists vertices and triangles, sorted and each once; returns how many. */
static size_t list_shapes(const struct scree_mesh *const meshes[], int count, int32_t span, struct shape *shapes) {
    size_t listed = 0, kept = 0;
    for (int m = 0; m < count; m++) {
        int32_t x = m % 2 * span, y = m / 2 * span;
        for (uint32_t v = 0; v < meshes[m]->vertex_count; v++)
            add_shape(meshes[m], (uint32_t[3]){v, v, v}, x, y, &shapes[listed++]);
        for (uint32_t t = 0; t < meshes[m]->triangle_count; t++)
            add_shape(meshes[m], meshes[m]->corners + 3 * (size_t)t, x, y, &shapes[listed++]);
    }
    qsort(shapes, listed, sizeof *shapes, by_bytes);
    for (size_t i = 0; i < listed; i++)
        if (kept == 0 || by_bytes(&shapes[kept - 1], &shapes[i]) != 0) shapes[kept++] = shapes[i];
    return kept;
}

static void a_parent_is_the_union_of_its_children(void) {
    enum { SPAN = 64, ROOM = 60000 };
    static struct tile tile;
    struct scree_memory memory = {0};
    struct coarse_tile *children[4];
    struct scree_mesh copy;
    struct shape *shapes = malloc(ROOM * sizeof *shapes), *own = malloc(ROOM * sizeof *own);
    CU_ASSERT_FATAL(shapes != NULL && own != NULL);
    make_children(&memory, 100, 200, SPAN, 4, children);
    CU_ASSERT_EQUAL_FATAL(make_parent(&memory, 2 * SPAN, 2 * SPAN, children, &tile), SCREE_OK);
    check(&tile);
    CU_ASSERT_EQUAL_FATAL(mesh_export_new(&memory, &tile.mesh, &copy, NULL), SCREE_OK);
    const struct scree_mesh *const meshes[4] = {&children[0]->mesh, &children[1]->mesh, &children[2]->mesh,
                                                &children[3]->mesh};
    const struct scree_mesh *const parent[1] = {&copy};
    size_t count = list_shapes(meshes, 4, SPAN, shapes);
    CU_ASSERT_EQUAL(count, copy.vertex_count + copy.triangle_count);
    CU_ASSERT_EQUAL(list_shapes(parent, 1, 0, own), count);
    CU_ASSERT_EQUAL(memcmp(shapes, own, count * sizeof *own), 0);
    scree_release(&memory, copy.corners);
    scree_release(&memory, copy.vertices);
    tile_release(&tile);
    free_children(&memory, children);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(own);
    free(shapes);
}

/* The two samples of every closed cell are posts of the field in it, no post is lower or higher. */
static void check_extremes(const struct sample *extremes, int32_t cells_x, int32_t cells_y, int32_t span, int64_t x,
                           int64_t y, int32_t columns, int32_t rows) {
    static float posts[(MAX_SIDE + 1) * MAX_SIDE];
    const struct fractal fractal = {21, true};
    int32_t stride = columns + 1;
    fractal_window(&fractal, x, y, stride, rows + 1, posts, stride);
    for (int32_t cell = 0; cell < cells_x * cells_y; cell++) {
        int32_t west = cell % cells_x * span, south = cell / cells_x * span;
        int32_t east = west + span < columns ? west + span : columns, north = south + span < rows ? south + span : rows;
        float lowest_m = INFINITY, highest_m = -INFINITY;
        for (int32_t j = south; j <= north; j++)
            for (int32_t i = west; i <= east; i++) {
                lowest_m = fminf(lowest_m, posts[j * stride + i]);
                highest_m = fmaxf(highest_m, posts[j * stride + i]);
            }
        const struct sample *pair = &extremes[2 * (size_t)cell];
        CU_ASSERT_EQUAL(pair[0].height_m, lowest_m);
        CU_ASSERT_EQUAL(pair[1].height_m, highest_m);
        for (int k = 0; k < 2; k++) {
            CU_ASSERT_FATAL(pair[k].x >= west && pair[k].x <= east && pair[k].y >= south && pair[k].y <= north);
            CU_ASSERT_EQUAL(posts[pair[k].y * stride + pair[k].x], pair[k].height_m);
        }
    }
}

static void parents_go_on_and_keep_extremes(void) {
    enum { SPAN = 64 };
    static struct tile tile;
    struct scree_memory memory = {0};
    struct coarse_tile *children[4], *coarse;
    make_children(&memory, 300, 200, SPAN, 4, children);
    CU_ASSERT_EQUAL_FATAL(make_parent(&memory, 2 * SPAN, 2 * SPAN, children, &tile), SCREE_OK);
    free_children(&memory, children);
    check_extremes(tile.extremes, SPAN, SPAN, 2, 300, 200, 2 * SPAN, 2 * SPAN);
    CU_ASSERT(tile_max_error_m(&tile) <= 4);
    double before_m2 = tile_mmqe_m2(&tile);
    for (double tolerance_m = 8; tolerance_m <= 64; tolerance_m *= 2) {
        int32_t vertices = tile.mesh.live_vertices;
        advance(&tile, tolerance_m);
        CU_ASSERT(tile.mesh.live_vertices < vertices);
    }
    CU_ASSERT(tile_max_error_m(&tile) <= 2 * 64); /* border vertices that have to go may pass the tolerance */
    CU_ASSERT(tile_mmqe_m2(&tile) > before_m2);
    CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(&tile, &coarse, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(coarse->max_error_m, tile_max_error_m(&tile));
    CU_ASSERT_EQUAL(coarse->mesh.vertex_count, (uint32_t)tile.mesh.live_vertices);
    check_extremes(coarse->extremes, SPAN / 2, SPAN / 2, 4, 300, 200, 2 * SPAN, 2 * SPAN);
    coarse_tile_free(&memory, coarse);
    tile_release(&tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void children_that_do_not_meet_are_refused(void) {
    static struct tile tile;
    struct scree_memory memory = {0};
    struct coarse_tile *children[4], *others[4];
    make_children(&memory, 100, 200, 64, 4, children);
    make_children(&memory, 100, 200, 64, 40, others); /* borders of another rung */
    struct coarse_tile *const mixed[4] = {children[0], others[1], children[2], others[3]};
    CU_ASSERT_EQUAL(make_parent(&memory, 128, 128, mixed, &tile), SCREE_E_CORRUPT);
    free_children(&memory, others);
    free_children(&memory, children);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- slopes ---- */

static void check_slopes_meet(const struct slope_grid *west, const struct slope_grid *east) {
    CU_ASSERT_EQUAL(west->rows, east->rows);
    for (int32_t row = 0; row < west->rows; row++)
        CU_ASSERT_EQUAL(memcmp(&west->nodes[row * west->columns + west->columns - 1], &east->nodes[row * east->columns],
                               sizeof *west->nodes),
                        0);
}

static void check_slopes_meet_north(const struct slope_grid *south, const struct slope_grid *north) {
    CU_ASSERT_EQUAL(south->columns, north->columns);
    CU_ASSERT_EQUAL(memcmp(&south->nodes[(south->rows - 1) * south->columns], north->nodes,
                           (size_t)south->columns * sizeof *south->nodes),
                    0);
}

/* Bit for bit, in two zooms of tiles: normals are continuous over borders. */
static void slopes_agree_on_common_borders(void) {
    enum { SPAN = 32 };
    static struct tile tile, east, north;
    struct scree_memory memory = {0};
    struct coarse_tile *children[4], *coarse[3];
    static struct tile *const tiles[3] = {&tile, &east, &north};
    tile_of_field(&memory, 0, 0, SPAN, SPAN, &tile);
    tile_of_field(&memory, SPAN, 0, SPAN, SPAN, &east);
    tile_of_field(&memory, 0, SPAN, SPAN, SPAN, &north);
    check_slopes_meet(&tile.slopes, &east.slopes);
    check_slopes_meet_north(&tile.slopes, &north.slopes);
    CU_ASSERT_NOT_EQUAL(tile.slopes.nodes[5].east, 0);
    for (int i = 0; i < 3; i++) tile_release(tiles[i]);
    for (int i = 0; i < 3; i++) {
        make_children(&memory, i % 2 * 2 * SPAN, i / 2 * 2 * SPAN, SPAN, 2, children);
        check_slopes_meet(&children[0]->slopes, &children[1]->slopes);
        check_slopes_meet_north(&children[0]->slopes, &children[2]->slopes);
        CU_ASSERT_EQUAL_FATAL(make_parent(&memory, 2 * SPAN, 2 * SPAN, children, tiles[i]), SCREE_OK);
        free_children(&memory, children);
    }
    check_slopes_meet(&tile.slopes, &east.slopes);
    check_slopes_meet_north(&tile.slopes, &north.slopes);
    for (int i = 0; i < 3; i++) CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(tiles[i], &coarse[i], NULL), SCREE_OK);
    check_slopes_meet(&coarse[0]->slopes, &coarse[1]->slopes);
    check_slopes_meet_north(&coarse[0]->slopes, &coarse[2]->slopes);
    CU_ASSERT_EQUAL(coarse[0]->slopes.node_span, 4);
    for (int i = 0; i < 3; i++) {
        coarse_tile_free(&memory, coarse[i]);
        tile_release(tiles[i]);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- windows that are cut ---- */

static void tiles_of_any_size_work(void) {
    static const int32_t sizes[][2] = {{1, 1}, {1, 19}, {19, 1}, {2, 3}, {37, 256}, {256, 5}, {255, 255}};
    static struct tile tile;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct scree_memory memory = {0};
        int32_t columns = sizes[i][0], rows = sizes[i][1];
        struct coarse_tile *children[4] = {NULL, NULL, NULL, NULL};
        CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 40, 50, columns, rows, &tile), SCREE_OK);
        check(&tile);
        for (double tolerance_m = 2; tolerance_m < 100; tolerance_m *= 5) {
            advance(&tile, tolerance_m);
            CU_ASSERT(tile_max_error_m(&tile) <= tolerance_m);
        }
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(&tile, &children[0], NULL), SCREE_OK);
        check_extremes(children[0]->extremes, (columns + 1) / 2, (rows + 1) / 2, 2, 40, 50, columns, rows);
        tile_release(&tile);
        CU_ASSERT_EQUAL_FATAL(make_parent(&memory, columns, rows, children, &tile), SCREE_OK); /* an only child */
        advance(&tile, 100);
        tile_release(&tile);
        coarse_tile_free(&memory, children[0]);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
}

/* A window of 64 + 21 x 64 + 1 steps: the other children are cut. */
static void cut_children_make_a_parent(void) {
    static struct tile tile;
    struct scree_memory memory = {0};
    struct coarse_tile *children[4];
    for (int i = 0; i < 4; i++) {
        int32_t columns = i % 2 == 0 ? 64 : 21, rows = i / 2 == 0 ? 64 : 1;
        CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 9 + i % 2 * 64, 8 + i / 2 * 64, columns, rows, &tile), SCREE_OK);
        advance(&tile, 4);
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(&tile, &children[i], NULL), SCREE_OK);
        tile_release(&tile);
    }
    CU_ASSERT_EQUAL_FATAL(make_parent(&memory, 85, 65, children, &tile), SCREE_OK);
    check(&tile);
    check_extremes(tile.extremes, 43, 33, 2, 9, 8, 85, 65);
    CU_ASSERT(tile_max_error_m(&tile) <= 4);
    advance(&tile, 30);
    free_children(&memory, children);
    tile_release(&tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- coarse codes, and who watches ---- */

/* Eight steps to a code, and so small a tolerance that the codes alone decide: still no triangle is flat in codes, and
 * neighbours of two parents meet. */
static void coarse_codes_leave_positive_triangles(void) {
    static struct tile tile, east;
    struct scree_memory memory = {0};
    const struct code_frame frame = {1 << 18, 1 << 17, 1 << 17}, other_frame = {1 << 18, 0, 1 << 17};
    CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 0, 0, 256, 256, &tile), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_of_field(&memory, 256, 0, 256, 256, &east), SCREE_OK);
    tile_set_codes(&tile, frame);
    tile_set_codes(&east, other_frame);
    advance(&tile, 3);
    advance(&east, 3);
    check_common_border(&tile, SIDE_EAST, &east, SIDE_WEST);
    for (int32_t t = 0; t < tile.mesh.triangle_count; t++) {
        const int32_t *corner = tile.mesh.triangles[t].vertex;
        if (corner[0] == MESH_NONE) continue;
        CU_ASSERT_TRUE(codes_positive(&frame, &tile.mesh.vertices[corner[0]].at, &tile.mesh.vertices[corner[1]].at,
                                      &tile.mesh.vertices[corner[2]].at));
    }
    CU_ASSERT(tile.mesh.live_vertices > 100);
    tile_release(&east);
    tile_release(&tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- tiles without data ---- */

static double level_m(double x, double y) {
    (void)x;
    (void)y;
    return 0;
}

/* Takes up a tile of zoom `id.zoom`, made of level posts of the finest zoom. */
static struct coarse_tile *climb(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                 struct scree_memory *memory) {
    static struct tile_walk walk; /* one at a time: children are done before their parent begins */
    struct coarse_tile *children[4], *coarse;
    if (id.zoom == plan->lattice->finest_zoom) {
        CU_ASSERT_EQUAL_FATAL(tile_build_finest(plan, id, reader, false, memory, &walk, NULL), SCREE_OK);
    } else {
        for (int i = 0; i < 4; i++) {
            struct tile_id child = {id.zoom + 1, 2 * id.x + (uint32_t)i % 2, 2 * id.y + (uint32_t)i / 2};
            children[i] = climb(plan, child, reader, memory);
        }
        const struct coarse_tile *const views[4] = {children[0], children[1], children[2], children[3]};
        CU_ASSERT_EQUAL_FATAL(tile_build_parent(plan, id, views, false, memory, &walk, NULL), SCREE_OK);
        free_children(memory, children);
    }
    CU_ASSERT_EQUAL_FATAL(tile_build_hand_up(plan, &walk, &coarse, NULL), SCREE_OK);
    tile_walk_release(&walk);
    return coarse;
}

/* A neighbour with data reaches a common border from its posts, one without starts at its own zoom. Both have to keep
 * the same vertices, at any latitude. */
static void level_tiles_meet_tiles_of_level_posts(void) {
    enum { FINEST = 5 };
    static const uint32_t rows[] = {0, 3, 5};
    static const double roots_m[] = {1000, 20000};
    struct raster_fixture fixture = {.path = "/vsimem/level.tif",
                                     .columns = 36,
                                     .rows = 18,
                                     .west = -180,
                                     .north = 90,
                                     .pixel_x = 10,
                                     .pixel_y = 10,
                                     .srs = "EPSG:4326",
                                     .height = level_m};
    static struct tile_walk walk;
    struct scree_memory memory = {0};
    struct opened opened;
    make_raster(&fixture);
    CU_ASSERT_TRUE_FATAL(open_one(fixture.path, FINEST, &opened));
    for (size_t root = 0; root < sizeof roots_m / sizeof *roots_m; root++)
        for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
            struct ladder_options options = {.root_error_m = roots_m[root], .relief_m = 100, .largest_height_m = 100};
            struct ladder ladder;
            CU_ASSERT_EQUAL_FATAL(ladder_make(&opened.lattice, &options, &ladder, NULL), SCREE_OK);
            const struct tile_plan plan = {.lattice = &opened.lattice, .ladder = &ladder};
            for (int zoom = FINEST; zoom >= FINEST - 1; zoom--) {
                struct tile_id id = {zoom, 9u >> (FINEST - zoom), rows[row] >> (FINEST - zoom)};
                struct coarse_tile *level, *risen = climb(&plan, id, opened.reader, &memory);
                CU_ASSERT_EQUAL_FATAL(tile_build_level(&plan, id, false, &memory, &walk, NULL), SCREE_OK);
                check(&walk.tile);
                CU_ASSERT_EQUAL_FATAL(tile_build_hand_up(&plan, &walk, &level, NULL), SCREE_OK);
                tile_walk_release(&walk);
                for (int side = 0; side < SIDE_COUNT; side++) {
                    const struct border_line *line = &level->lines[side], *other = &risen->lines[side];
                    CU_ASSERT_EQUAL_FATAL(line->vertex_count, other->vertex_count);
                    for (int32_t v = 0; v < line->vertex_count; v++)
                        CU_ASSERT_EQUAL(line->vertices[v].position, other->vertices[v].position);
                }
                CU_ASSERT(level->lines[SIDE_WEST].vertex_count > 2); /* the curvature is not lost */
                coarse_tile_free(&memory, level);
                coarse_tile_free(&memory, risen);
            }
        }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    close_raster(&opened);
}

/* ---- memory ---- */

static enum scree_status hand_up(struct tile *tile, struct coarse_tile **coarse) {
    enum scree_status status = tile_hand_up_new(tile, coarse, NULL);
    tile_release(tile);
    return status;
}

/* One tile of posts, handed up, and a parent of it, handed up. */
static enum scree_status one_life(struct scree_memory *memory) {
    static struct tile tile;
    struct coarse_tile *children[4] = {NULL, NULL, NULL, NULL}, *coarse = NULL;
    enum scree_status status = tile_of_field(memory, 3, 4, 9, 7, &tile);
    if (status == SCREE_OK) status = hand_up(&tile, &children[0]);
    if (status == SCREE_OK) status = make_parent(memory, 9, 7, children, &tile);
    if (status == SCREE_OK) status = hand_up(&tile, &coarse);
    coarse_tile_free(memory, coarse);
    coarse_tile_free(memory, children[0]);
    return status;
}

static void lack_of_memory_leaves_nothing_behind(void) {
    struct scree_memory memory = {0};
    CU_ASSERT_EQUAL_FATAL(one_life(&memory), SCREE_OK);
    CU_ASSERT(memory.requests > 20);
    for (uint64_t n = 1; n <= memory.requests; n++) {
        struct scree_memory failing = {.fail_request = n};
        CU_ASSERT_EQUAL(one_life(&failing), SCREE_E_MEMORY);
        CU_ASSERT_EQUAL(failing.used_bytes, 0);
    }
}

static void lack_of_memory_leaves_no_level_tile(void) {
    static struct tile tile;
    float east_drop_m[9] = {0};
    struct tile_geometry geometry = flat_geometry(64, 64, 8);
    geometry.east_drop_m = east_drop_m;
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t n = 0;
    while (status != SCREE_OK) {
        struct scree_memory failing = {.fail_request = ++n};
        status = tile_from_level(&failing, &geometry, 16, 12, &tile, NULL);
        CU_ASSERT(status == SCREE_OK || status == SCREE_E_MEMORY);
        if (status == SCREE_OK) tile_release(&tile);
        CU_ASSERT_EQUAL(failing.used_bytes, 0);
    }
    CU_ASSERT(n > 10);
}

int suite_tile(void) {
    CU_pSuite suite = CU_add_suite("tile", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, neighbours_meet_at_every_rung);
    CU_ADD_TEST(suite, what_is_looked_ahead_at_is_within_reach);
    CU_ADD_TEST(suite, a_parent_is_the_union_of_its_children);
    CU_ADD_TEST(suite, parents_go_on_and_keep_extremes);
    CU_ADD_TEST(suite, children_that_do_not_meet_are_refused);
    CU_ADD_TEST(suite, slopes_agree_on_common_borders);
    CU_ADD_TEST(suite, tiles_of_any_size_work);
    CU_ADD_TEST(suite, cut_children_make_a_parent);
    CU_ADD_TEST(suite, coarse_codes_leave_positive_triangles);
    CU_ADD_TEST(suite, level_tiles_meet_tiles_of_level_posts);
    CU_ADD_TEST(suite, lack_of_memory_leaves_nothing_behind);
    CU_ADD_TEST(suite, lack_of_memory_leaves_no_level_tile);
    return 0;
}
