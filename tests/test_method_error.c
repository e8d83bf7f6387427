/* The exhaustive comparison of a mesh whose vertices may stand anywhere: known distances, and every way of not being a
 * triangulation. */
#include "lod/method_error.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

#define CELLS 8
#define POSTS ((CELLS + 1) * (CELLS + 1))

/* A fan around a vertex that stands between the posts. */
static struct method_vertex fan[] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {3.3, 4.7, 0}};
static uint32_t fan_corners[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};

static double plane_m(double x, double y) {
    return 100 + 2 * x - 0.5 * y;
}

static struct method_tile make_tile(float heights_m[POSTS]) {
    for (int i = 0; i < POSTS; i++) heights_m[i] = (float)plane_m(i % (CELLS + 1), (double)(i / (CELLS + 1)));
    return (struct method_tile){.columns = CELLS,
                                .rows = CELLS,
                                .cell_span = 1,
                                .heights_m = heights_m,
                                .stride = CELLS + 1,
                                .east_m = 30,
                                .north_m = 30};
}

static struct method_mesh make_fan(struct method_vertex vertices[5], double lift_m) {
    memcpy(vertices, fan, sizeof fan);
    for (int i = 0; i < 5; i++) vertices[i].height_m = plane_m(vertices[i].x, vertices[i].y) + lift_m;
    return (struct method_mesh){5, 4, vertices, fan_corners};
}

static struct method_error measure(const struct method_tile *tile, const struct method_mesh *mesh) {
    struct scree_memory memory = {0};
    struct method_error result;
    CU_ASSERT_EQUAL_FATAL(method_error_measure(&memory, tile, mesh, &result, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return result;
}

static void distances_are_vertical_and_counted_once(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    struct method_error result = measure(&tile, &mesh);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 0, 1e-12);
    CU_ASSERT_EQUAL(result.posts_covered, POSTS);
    CU_ASSERT_TRUE(result.covers);

    mesh = make_fan(vertices, 3);
    result = measure(&tile, &mesh);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 3, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(result.mean_m, 3, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(result.rms_m, 3, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(result.sum_squares_m2, 9 * POSTS, 1e-9);

    mesh = make_fan(vertices, 0);
    heights_m[5 * (CELLS + 1) + 6] += 9; /* one post of 81 */
    result = measure(&tile, &mesh);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 9, 1e-5);
    CU_ASSERT_EQUAL(result.max_column, 6);
    CU_ASSERT_EQUAL(result.max_row, 5);
    CU_ASSERT_DOUBLE_EQUAL(result.rms_m, 1, 1e-5);
    CU_ASSERT_DOUBLE_EQUAL(result.mean_m, 9.0 / POSTS, 1e-5);
}

/* A summit that is not at a post: the posts around it hang below by what the cone's sides say. */
static void a_vertex_between_posts_counts_where_it_stands(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    vertices[4].height_m += 10;
    struct method_error result = measure(&tile, &mesh);
    /* the post below it to the left (3, 4) lies in the southern triangle; the one above (3, 5) is nearer: in the
     * western triangle 10 * 3 / 3.3, and in the northern one 10 * 3 / 3.3 too, as the lesser of both holds */
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 10 * fmin(3 / 3.3, (8 - 5) / (8 - 4.7)), 1e-9);
    CU_ASSERT_EQUAL(result.posts_covered, POSTS);
}

static void whole_cells_and_steps_measure_the_same(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    vertices[4].height_m += 10;
    struct method_error fine = measure(&tile, &mesh);
    tile.cell_span = 1 << 20;
    for (int i = 0; i < 5; i++) {
        vertices[i].x *= tile.cell_span;
        vertices[i].y *= tile.cell_span;
    }
    struct method_error coarse = measure(&tile, &mesh);
    CU_ASSERT_EQUAL(coarse.max_m, fine.max_m);
    CU_ASSERT_EQUAL(coarse.rms_m, fine.rms_m);
    CU_ASSERT_TRUE(coarse.covers);
}

static void flat_triangles_hang_below_a_round_earth(void) {
    float heights_m[POSTS] = {0};
    struct method_vertex vertices[5];
    memcpy(vertices, fan, sizeof fan);
    vertices[4] = (struct method_vertex){4, 4, 0};
    struct method_mesh mesh = {5, 4, vertices, fan_corners};
    struct method_tile tile = make_tile(heights_m);
    memset(heights_m, 0, sizeof heights_m);
    CU_ASSERT_EQUAL(measure(&tile, &mesh).max_m, 0);
    tile.east_drop_m = tile.north_drop_m = 0.25;
    /* the middle of an edge of 8 steps: a chord lies drop * 4 * 4 below the arc */
    CU_ASSERT_EQUAL(measure(&tile, &mesh).max_m, 4);
}

/* A sliver ends beside a post: its plane, taken just a hair's breadth beyond it, would be anywhere. */
static void slivers_are_left_to_their_neighbours(void) {
    float heights_m[POSTS];
    struct method_tile tile = make_tile(heights_m);
    double hair = 1e-11;
    struct method_vertex vertices[] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {4, 4, 0}, {4, 4 + hair, 50}};
    uint32_t corners[] = {0, 1, 4, 1, 2, 4, 2, 5, 4, 2, 3, 5, 3, 0, 5, 0, 4, 5};
    struct method_mesh mesh = {6, 6, vertices, corners};
    memset(heights_m, 0, sizeof heights_m);
    struct method_error result = measure(&tile, &mesh);
    CU_ASSERT_TRUE(result.covers);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 50, 1e-6); /* the cliff is real, and the post stands on its edge */
}

/* A grid that keeps its border and is bent inside. */
static void the_judge_of_the_tests_agrees(void) {
    enum { ACROSS = 31, UP = 24 };
    const struct method_recipe recipe = {
        .columns = ACROSS - 1, .rows = UP - 1, .border_tolerance_m = -1, .is_round = true};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    struct method_vertex vertices[ACROSS * UP];
    uint32_t corners[6 * ACROSS * UP], at = 0;
    for (int32_t row = 0; row < UP; row++)
        for (int32_t column = 0; column < ACROSS; column++) {
            bool is_inside = column > 0 && row > 0 && column < ACROSS - 1 && row < UP - 1;
            int32_t i = ACROSS * row + column;
            double bend = is_inside ? 0.3 : 0;
            vertices[i] = (struct method_vertex){column + bend * sin(1.7 * i), row + bend * cos(2.9 * i),
                                                 (double)method_post_m(&made->tile, column, row) + 40 * bend};
        }
    for (uint32_t row = 0; row < UP - 1; row++)
        for (uint32_t column = 0; column < ACROSS - 1; column++) {
            uint32_t a = ACROSS * row + column, cell[6] = {a, a + 1, a + ACROSS + 1, a, a + ACROSS + 1, a + ACROSS};
            for (int k = 0; k < 6; k++) corners[at++] = cell[k];
        }
    struct method_mesh mesh = {ACROSS * UP, at / 3, vertices, corners};
    struct method_verdict verdict = method_judge(&made->tile, &mesh);
    struct method_error result = measure(&made->tile, &mesh);
    CU_ASSERT_TRUE(verdict.is_triangulation);
    CU_ASSERT_TRUE(result.covers);
    CU_ASSERT_TRUE(result.max_m > 12);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, verdict.max_m, 1e-9);
    CU_ASSERT_DOUBLE_EQUAL(result.rms_m, verdict.rms_m, 1e-9);
    made_method_tile_free(made);
}

static void what_is_no_triangulation_is_seen(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    mesh.triangle_count = 3;
    struct method_error result = measure(&tile, &mesh);
    CU_ASSERT_FALSE(result.areas_add_up);
    CU_ASSERT_FALSE(result.covers);
    CU_ASSERT_TRUE(result.posts_covered < POSTS);

    uint32_t turned[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 3, 4};
    mesh = (struct method_mesh){5, 4, vertices, turned};
    result = measure(&tile, &mesh);
    CU_ASSERT_EQUAL(result.triangles_without_area, 1);
    CU_ASSERT_FALSE(result.covers);

    uint32_t flat[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 4, 4};
    mesh = (struct method_mesh){5, 5, vertices, flat};
    result = measure(&tile, &mesh);
    CU_ASSERT_EQUAL(result.triangles_without_area, 1);
    CU_ASSERT_TRUE(result.areas_add_up);
    CU_ASSERT_FALSE(result.covers);
}

static void no_number_is_an_endless_error(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    heights_m[40] = NAN;
    CU_ASSERT_EQUAL(measure(&tile, &mesh).max_m, HUGE_VAL);
    heights_m[40] = 0;
    vertices[2].height_m = NAN;
    CU_ASSERT_EQUAL(measure(&tile, &mesh).max_m, HUGE_VAL);
}

static void bad_meshes_are_refused(void) {
    float heights_m[POSTS];
    struct method_vertex vertices[5];
    struct scree_memory memory = {0};
    struct method_error result;
    struct method_tile tile = make_tile(heights_m);
    struct method_mesh mesh = make_fan(vertices, 0);
    const double nowhere[] = {-0.001, 8.001, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        mesh = make_fan(vertices, 0);
        vertices[4].x = nowhere[i];
        CU_ASSERT_EQUAL(method_error_measure(&memory, &tile, &mesh, &result, NULL), SCREE_E_ARGUMENT);
    }
    mesh = make_fan(vertices, 0);
    mesh.vertex_count = 4;
    CU_ASSERT_EQUAL(method_error_measure(&memory, &tile, &mesh, &result, NULL), SCREE_E_ARGUMENT);
    mesh.vertex_count = 5;
    memory.fail_request = 1;
    CU_ASSERT_EQUAL(method_error_measure(&memory, &tile, &mesh, &result, NULL), SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_method_error(void) {
    CU_pSuite suite = CU_add_suite("error of a method", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, distances_are_vertical_and_counted_once);
    CU_ADD_TEST(suite, a_vertex_between_posts_counts_where_it_stands);
    CU_ADD_TEST(suite, whole_cells_and_steps_measure_the_same);
    CU_ADD_TEST(suite, flat_triangles_hang_below_a_round_earth);
    CU_ADD_TEST(suite, slivers_are_left_to_their_neighbours);
    CU_ADD_TEST(suite, the_judge_of_the_tests_agrees);
    CU_ADD_TEST(suite, what_is_no_triangulation_is_seen);
    CU_ADD_TEST(suite, no_number_is_an_endless_error);
    CU_ADD_TEST(suite, bad_meshes_are_refused);
    return 0;
}
