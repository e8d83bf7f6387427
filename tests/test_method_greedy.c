/* Greedy insertion between given borders, and the Delaunay triangulation that it grows: the bound holds at every inner
 * post, borders are kept to the letter, and failures leave nothing behind. */
#include "lod/delaunay.h"
#include "lod/method_greedy.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

static uint32_t check(const struct method_recipe *recipe, const struct method_greedy_options *options, double slack_m) {
    struct made_method_tile *made = made_method_tile_new(recipe);
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0}, again = {0};
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(method_greedy(&memory, &made->tile, options, &mesh, &error), SCREE_OK);
    struct method_verdict verdict = method_judge(&made->tile, &mesh);
    CU_ASSERT_TRUE(verdict.is_triangulation);
    CU_ASSERT_PTR_NULL(verdict.fault);
    if (options->max_vertices == 0)
        CU_ASSERT_TRUE(verdict.max_m <= fmax(options->tolerance_m, recipe->border_tolerance_m) + slack_m);
    CU_ASSERT_EQUAL(method_greedy(&memory, &made->tile, options, &again, &error), SCREE_OK);
    CU_ASSERT_TRUE(method_meshes_equal(&mesh, &again));
    uint32_t triangles = mesh.triangle_count;
    method_mesh_release(&memory, &again);
    method_mesh_release(&memory, &mesh);
    method_mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
    return triangles;
}

static void the_bound_holds_between_given_borders(void) {
    const double tolerances_m[] = {100, 20, 5, 1, 0};
    uint32_t before = 0;
    for (size_t i = 0; i < sizeof tolerances_m / sizeof *tolerances_m; i++) {
        struct method_recipe recipe = {.columns = 64, .rows = 48, .border_tolerance_m = 0.7 * tolerances_m[i]};
        struct method_greedy_options options = {.tolerance_m = tolerances_m[i]};
        uint32_t triangles = check(&recipe, &options, 1e-7);
        CU_ASSERT_TRUE(triangles > before);
        before = triangles;
        recipe.whole_metres = true;
        check(&recipe, &options, 0);
    }
    CU_ASSERT_TRUE(before > 5000); /* at 0 m nearly all posts are there */
}

static void border_vertices_may_lie_between_posts(void) {
    const int32_t spans[] = {2, 8, 64, 1024, 1 << 22};
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++) {
        struct method_recipe recipe = {.columns = 40,
                                       .rows = 56,
                                       .cell_span = spans[i],
                                       .border_tolerance_m = 5,
                                       .metres_a_step = 30.0 / spans[i]};
        check(&recipe, &(struct method_greedy_options){.tolerance_m = 10}, 1e-6);
        check(&recipe, &(struct method_greedy_options){.tolerance_m = 1000}, 1e-6);
    }
}

static void a_round_earth_bends_flat_triangles(void) {
    static float level_m[33 * 33];
    struct method_recipe recipe = {.columns = 32,
                                   .rows = 32,
                                   .cell_span = 4,
                                   .border_tolerance_m = 20,
                                   .metres_a_step = 1000,
                                   .is_round = true,
                                   .given_heights_m = level_m};
    struct method_greedy_options options = {.tolerance_m = 30};
    /* 128 km of sea: the middle is 322 m above the plane of the border's corners */
    CU_ASSERT_TRUE(check(&recipe, &options, 0.01) > 20);
    recipe.is_round = false;
    recipe.border_tolerance_m = 1;
    CU_ASSERT_EQUAL(check(&recipe, &options, 0), 2);
    recipe.cell_span = 1;
    CU_ASSERT_EQUAL(check(&recipe, &options, 0), 2);
}

static void any_shape(void) {
    const int32_t shapes[][2] = {{1, 1}, {1, 30}, {30, 1}, {2, 2}, {3, 100}, {100, 3}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (int32_t span = 1; span <= 16; span *= 4) {
            struct method_recipe recipe = {
                .columns = shapes[i][0], .rows = shapes[i][1], .cell_span = span, .border_tolerance_m = 1};
            check(&recipe, &(struct method_greedy_options){.tolerance_m = 2}, 1e-6);
            check(&recipe, &(struct method_greedy_options){.tolerance_m = 2, .grid_cells = 7}, 1e-6);
        }
}

static void a_grid_comes_first(void) {
    struct method_recipe recipe = {.columns = 50, .rows = 40, .border_tolerance_m = 1e6};
    struct method_greedy_options options = {.tolerance_m = 1e6, .grid_cells = 10};
    CU_ASSERT_EQUAL(check(&recipe, &options, 0), 2 + 2 * 81);
    options.grid_cells = 1000; /* finer than the posts: all inner ones */
    CU_ASSERT_EQUAL(check(&recipe, &options, 0), 2 + 2 * 49 * 39);
    options.grid_cells = 1;
    CU_ASSERT_EQUAL(check(&recipe, &options, 0), 2);
}

static void vertices_are_limited(void) {
    struct method_recipe recipe = {.columns = 64, .rows = 64, .border_tolerance_m = 1e6};
    for (uint32_t limit = 4; limit < 1000; limit *= 3)
        CU_ASSERT_EQUAL(check(&recipe, &(struct method_greedy_options){.max_vertices = limit}, 0), 2 * limit - 6);
}

/* Wide coordinates: in-circle tests of 120 bits, judged here by long double, which tells all but ties apart. */
static void wide_triangulations_are_delaunay(void) {
    const int32_t side = 1 << 30;
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct delaunay mesh;
    uint64_t state = 1;
    CU_ASSERT_EQUAL_FATAL(delaunay_start(&memory, side, side, &mesh, &error), SCREE_OK);
    for (int i = 0; i < 400; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        struct delaunay_point point = {(int32_t)(state >> 34), (int32_t)(state >> 4 & 0x3fffffff)};
        uint32_t triangle = delaunay_find(&mesh, mesh.triangle_count / 2, point);
        CU_ASSERT_FALSE(delaunay_is_corner(&mesh, triangle, point));
        delaunay_insert(&mesh, triangle, point);
    }
    uint32_t intruders = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        for (uint32_t i = 0; i < mesh.point_count; i++) {
            long double x[3], y[3], square[3];
            for (int k = 0; k < 3; k++) {
                struct delaunay_point at = mesh.points[mesh.triangles[t].corner[k]];
                x[k] = at.x - mesh.points[i].x;
                y[k] = at.y - mesh.points[i].y;
                square[k] = x[k] * x[k] + y[k] * y[k];
            }
            intruders += x[0] * (y[1] * square[2] - square[1] * y[2]) - y[0] * (x[1] * square[2] - square[1] * x[2]) +
                             square[0] * (x[1] * y[2] - y[1] * x[2]) >
                         1e24L; /* of 1e36 at the most, far above long double's rounding */
        }
    CU_ASSERT_EQUAL(intruders, 0);
    CU_ASSERT_EQUAL(mesh.triangle_count, 2 + 2 * 400);
    delaunay_release(&mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void bad_arguments_are_refused(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 8, .rows = 8});
    const struct method_greedy_options bad[] = {
        {.tolerance_m = -1}, {.tolerance_m = (double)NAN}, {.tolerance_m = 1, .grid_cells = -1}};
    struct scree_memory memory = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct method_mesh mesh = {0};
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(method_greedy(&memory, &made->tile, &bad[i], &mesh, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "greedy insertion"));
        CU_ASSERT_PTR_NULL(mesh.vertices);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void every_failed_request_is_survived(void) {
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 64, .rows = 64, .border_tolerance_m = 1, .is_round = true});
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct method_mesh mesh = {0};
        status = method_greedy(&memory, &made->tile, &(struct method_greedy_options){1, 0, 0}, &mesh, NULL);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
        method_mesh_release(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 10);
    made_method_tile_free(made);
}

int suite_method_greedy(void) {
    CU_pSuite suite = CU_add_suite("greedy between borders", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, the_bound_holds_between_given_borders);
    CU_ADD_TEST(suite, border_vertices_may_lie_between_posts);
    CU_ADD_TEST(suite, a_round_earth_bends_flat_triangles);
    CU_ADD_TEST(suite, any_shape);
    CU_ADD_TEST(suite, a_grid_comes_first);
    CU_ADD_TEST(suite, vertices_are_limited);
    CU_ADD_TEST(suite, wide_triangulations_are_delaunay);
    CU_ADD_TEST(suite, bad_arguments_are_refused);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
