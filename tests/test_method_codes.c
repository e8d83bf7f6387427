/* Meshes of methods in position codes: places that are kept, triangles that rounding turns over, vertices that fall
 * together, tiles that end within a cell. */
#include "lod/method_codes.h"
#include "lod/method_greedy.h"
#include "lod/position_code.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct method_frame frame_of(const struct method_tile *tile) {
    struct method_frame frame = {.span = 256 * (int64_t)tile->cell_span,
                                 .width = method_width(tile),
                                 .height = method_height(tile),
                                 .height_unit_m = 1.0 / 64};
    memcpy(frame.lines, tile->lines, sizeof frame.lines);
    return frame;
}

/* Codes and back: a triangulation with the very border, and nowhere farther off than a code. */
static void check(const struct method_tile *tile, const struct method_mesh *mesh, uint32_t *vertices) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct method_frame frame = frame_of(tile);
    struct scree_mesh coded = {0};
    struct method_mesh back = {0};
    CU_ASSERT_EQUAL_FATAL(method_to_codes_new(&memory, tile, &frame, mesh, &coded, &error), SCREE_OK);
    uint32_t turned = 0;
    for (uint32_t t = 0; t < coded.triangle_count; t++) {
        const struct scree_vertex *at[3];
        for (uint32_t k = 0; k < 3; k++) at[k] = &coded.vertices[coded.corners[3 * t + k]];
        turned += (int64_t)(at[1]->x - at[0]->x) * (at[2]->y - at[0]->y) <=
                  (int64_t)(at[1]->y - at[0]->y) * (at[2]->x - at[0]->x);
    }
    CU_ASSERT_EQUAL(turned, 0);
    CU_ASSERT_EQUAL_FATAL(method_from_codes_new(&memory, tile, &frame, &coded, &back, &error), SCREE_OK);
    if (back.vertex_count == mesh->vertex_count)
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            double code = (double)tile->cell_span / 127;
            CU_ASSERT_TRUE(fabs(back.vertices[v].x - mesh->vertices[v].x) <= code);
            CU_ASSERT_TRUE(fabs(back.vertices[v].y - mesh->vertices[v].y) <= code);
            CU_ASSERT_TRUE(fabs(back.vertices[v].height_m - mesh->vertices[v].height_m) <= frame.height_unit_m / 2);
        }
    uint32_t on_border = 0, ring = 0;
    for (uint32_t v = 0; v < coded.vertex_count; v++)
        on_border += coded.vertices[v].x == 0 || coded.vertices[v].y == 0 ||
                     coded.vertices[v].x == position_code(frame.width, frame.span) ||
                     coded.vertices[v].y == position_code(frame.height, frame.span);
    for (int side = 0; side < SIDE_COUNT; side++) ring += (uint32_t)tile->lines[side]->vertex_count - 1;
    CU_ASSERT_EQUAL(on_border, ring);
    CU_ASSERT_EQUAL(coded.triangle_count, 2 * coded.vertex_count - 2 - ring); /* Euler: no hole, nothing twice */
    *vertices = coded.vertex_count;
    method_mesh_release(&memory, &back);
    scree_release(&memory, coded.corners);
    scree_release(&memory, coded.vertices);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* How many triangles plain rounding turns over. */
static uint32_t turned_by_rounding(const struct method_tile *tile, const struct method_mesh *mesh) {
    uint32_t turned = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        int64_t x[3], y[3];
        for (uint32_t k = 0; k < 3; k++) {
            const struct method_vertex *at = &mesh->vertices[mesh->corners[3 * t + k]];
            x[k] = llround(at->x * POSITION_TOP / (256.0 * tile->cell_span));
            y[k] = llround(at->y * POSITION_TOP / (256.0 * tile->cell_span));
        }
        turned += (x[1] - x[0]) * (y[2] - y[0]) <= (y[1] - y[0]) * (x[2] - x[0]);
    }
    return turned;
}

/* A vertex in every fifth triangle, so near to one of its edges that rounding may put it beyond. */
static struct method_mesh with_slivers(const struct method_mesh *mesh) {
    uint32_t more = mesh->triangle_count / 5;
    struct method_mesh out = {mesh->vertex_count, mesh->triangle_count, NULL, NULL};
    out.vertices = malloc((mesh->vertex_count + more) * sizeof *out.vertices);
    out.corners = malloc(3 * (size_t)(mesh->triangle_count + 2 * more) * sizeof *out.corners);
    CU_ASSERT_FATAL(out.vertices != NULL && out.corners != NULL);
    memcpy(out.vertices, mesh->vertices, mesh->vertex_count * sizeof *out.vertices);
    memcpy(out.corners, mesh->corners, 3 * (size_t)mesh->triangle_count * sizeof *out.corners);
    for (uint32_t t = 0; t < more; t++) {
        uint32_t *corner = out.corners + 15 * (size_t)t, p = out.vertex_count++, c = corner[2];
        const struct method_vertex *a = &out.vertices[corner[0]], *b = &out.vertices[corner[1]];
        const struct method_vertex *top = &out.vertices[c];
        struct method_vertex *at = &out.vertices[p];
        at->x = 0.666 * a->x + 0.333 * b->x + 0.001 * top->x; /* a third on: there is no other from the other side */
        at->y = 0.666 * a->y + 0.333 * b->y + 0.001 * top->y;
        at->height_m = a->height_m;
        corner[2] = p; /* (a, b, c) becomes (a, b, p), (b, c, p), (c, a, p) */
        memcpy(out.corners + 3 * (size_t)out.triangle_count++, (uint32_t[3]){corner[1], c, p}, 3 * sizeof p);
        memcpy(out.corners + 3 * (size_t)out.triangle_count++, (uint32_t[3]){c, corner[0], p}, 3 * sizeof p);
    }
    return out;
}

static void turned_triangles_are_mended(void) {
    for (int32_t span = 1; span <= 64; span *= 64) {
        struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){
            .columns = 256, .rows = 256, .cell_span = span, .border_tolerance_m = 8, .metres_a_step = 30.0 / span});
        struct scree_memory memory = {0};
        struct method_mesh mesh = {0};
        struct method_greedy_options options = {.tolerance_m = 8};
        uint32_t vertices;
        CU_ASSERT_EQUAL_FATAL(method_greedy(&memory, &made->tile, &options, &mesh, NULL), SCREE_OK);
        check(&made->tile, &mesh, &vertices);
        CU_ASSERT_EQUAL(vertices, mesh.vertex_count);
        struct method_mesh thin = with_slivers(&mesh);
        CU_ASSERT_TRUE(turned_by_rounding(&made->tile, &thin) > 100);
        check(&made->tile, &thin, &vertices);
        CU_ASSERT_EQUAL(vertices, thin.vertex_count);
        free(thin.corners);
        free(thin.vertices);
        method_mesh_release(&memory, &mesh);
        made_method_tile_free(made);
    }
}

/* A square of four triangles around a vertex that is off its middle, and maybe a twin of it. */
static struct method_mesh fan(struct method_vertex vertices[6], uint32_t corners[18], double x, double y, bool twin) {
    const double ends[4][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    struct method_mesh mesh = {5, 4, vertices, corners};
    vertices[4] = (struct method_vertex){x, y, 7};
    for (uint32_t k = 0; k < 4; k++) {
        vertices[k] = (struct method_vertex){ends[k][0], ends[k][1], 0};
        memcpy(corners + 3 * k, (uint32_t[3]){k, (k + 1) % 4, 4}, 3 * sizeof *corners);
    }
    if (!twin) return mesh;
    vertices[5] = (struct method_vertex){x, y + 1e-4, 9}; /* in the triangle to the north: (2, 3, 4) becomes three */
    memcpy(corners + 6, (uint32_t[3]){2, 3, 5}, 3 * sizeof *corners);
    memcpy(corners + 12, (uint32_t[3]){3, 4, 5}, 3 * sizeof *corners);
    memcpy(corners + 15, (uint32_t[3]){4, 2, 5}, 3 * sizeof *corners);
    mesh.vertex_count = mesh.triangle_count = 6;
    return mesh;
}

static void what_falls_together_is_one(void) {
    static const float level_m[25];
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 4, .rows = 4, .border_tolerance_m = 1, .given_heights_m = level_m});
    struct method_vertex vertices[6];
    uint32_t corners[18], left;
    struct method_mesh mesh = fan(vertices, corners, 1.7, 2.2, false);
    check(&made->tile, &mesh, &left);
    CU_ASSERT_EQUAL(left, 5);
    mesh = fan(vertices, corners, 1.7, 2.2, true);
    CU_ASSERT_TRUE(method_judge(&made->tile, &mesh).is_triangulation);
    check(&made->tile, &mesh, &left);
    CU_ASSERT_EQUAL(left, 5);
    mesh = fan(vertices, corners, 1e-9, 2.2, false); /* next to the border, but not on it */
    check(&made->tile, &mesh, &left);
    CU_ASSERT_EQUAL(left, 5);
    mesh = fan(vertices, corners, 4 - 1e-9, 4 - 1e-9, false);
    check(&made->tile, &mesh, &left);
    CU_ASSERT_EQUAL(left, 5);
    made_method_tile_free(made);
}

static void cut_tiles_are_stretched_back(void) {
    static const float level_m[25];
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){
        .columns = 4, .rows = 4, .cell_span = 8, .border_tolerance_m = 0.1, .given_heights_m = level_m});
    static struct border_line cut[SIDE_COUNT]; /* 29 x 32 steps, stretched to 32 x 32 */
    struct method_frame frame = frame_of(&made->tile);
    struct scree_memory memory = {0};
    struct scree_mesh coded = {0};
    struct method_mesh mesh = {0}, back = {0};
    frame.width = 29;
    for (int side = 0; side < SIDE_COUNT; side++) {
        cut[side] = made->lines[side];
        for (int32_t v = 0; v < cut[side].vertex_count && (side == SIDE_SOUTH || side == SIDE_NORTH); v++)
            cut[side].vertices[v].position = cut[side].vertices[v].position * 29 / 32;
        frame.lines[side] = &cut[side];
    }
    CU_ASSERT_TRUE(cut[SIDE_SOUTH].vertex_count > 3); /* the made lines keep the middles of cells */
    CU_ASSERT_EQUAL_FATAL(
        method_greedy(&memory, &made->tile, &(struct method_greedy_options){.grid_cells = 4}, &mesh, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(method_to_codes_new(&memory, &made->tile, &frame, &mesh, &coded, NULL), SCREE_OK);
    int32_t east = position_code(29, frame.span);
    for (uint32_t v = 0; v < coded.vertex_count; v++) {
        const struct scree_vertex *at = &coded.vertices[v];
        CU_ASSERT_TRUE(at->x >= 0 && at->x <= east);
        if (at->y != 0 || at->x == 0 || at->x == east) continue;
        bool found = false; /* the codes of the cut line's own steps, which a neighbour has too */
        for (int32_t i = 0; i < cut[SIDE_SOUTH].vertex_count; i++)
            found = found || at->x == position_code(cut[SIDE_SOUTH].vertices[i].position, frame.span);
        CU_ASSERT_TRUE(found);
    }
    CU_ASSERT_EQUAL(method_from_codes_new(&memory, &made->tile, &frame, &coded, &back, NULL), SCREE_OK);
    for (uint32_t v = 0; v < back.vertex_count; v++) CU_ASSERT_TRUE(back.vertices[v].x <= 32);
    frame.width = 0;
    struct scree_error error = {0};
    struct scree_mesh none = {0};
    CU_ASSERT_EQUAL(method_to_codes_new(&memory, &made->tile, &frame, &mesh, &none, &error), SCREE_E_LIMIT);
    method_mesh_release(&memory, &back);
    method_mesh_release(&memory, &mesh);
    scree_release(&memory, coded.corners);
    scree_release(&memory, coded.vertices);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void every_failed_request_is_survived(void) {
    static const float level_m[25];
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 4, .rows = 4, .border_tolerance_m = 1, .given_heights_m = level_m});
    struct method_frame frame = frame_of(&made->tile);
    struct method_vertex vertices[6];
    uint32_t corners[18];
    struct method_mesh mesh = fan(vertices, corners, 1.7, 2.2, true);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 50) {
        struct scree_memory memory = {.fail_request = ++request};
        struct scree_mesh coded = {0};
        status = method_to_codes_new(&memory, &made->tile, &frame, &mesh, &coded, NULL);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && coded.vertices == NULL));
        scree_release(&memory, coded.corners);
        scree_release(&memory, coded.vertices);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 6);
    made_method_tile_free(made);
}

int suite_method_codes(void) {
    CU_pSuite suite = CU_add_suite("methods in codes", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, turned_triangles_are_mended);
    CU_ADD_TEST(suite, what_falls_together_is_one);
    CU_ADD_TEST(suite, cut_tiles_are_stretched_back);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
