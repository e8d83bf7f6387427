/* The quadtree between given borders: whatever the lines keep or add, the mesh is a triangulation with exactly their
 * vertices; inside it follows the threshold. */
#include "lod/method_quadtree.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

/* Runs it on a tile made so, has the mesh judged and hands back its triangles. */
static uint32_t check(const struct method_recipe *recipe, double threshold, struct method_verdict *verdict) {
    const struct method_quadtree_options options = {threshold};
    struct made_method_tile *made = made_method_tile_new(recipe);
    struct scree_memory memory = {0};
    struct method_mesh mesh;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(method_quadtree(&memory, &made->tile, &options, &mesh, &error), SCREE_OK);
    *verdict = method_judge(&made->tile, &mesh);
    CU_ASSERT_TRUE(verdict->is_triangulation);
    if (!verdict->is_triangulation) CU_FAIL(verdict->fault);
    uint32_t triangle_count = mesh.triangle_count;
    method_mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
    return triangle_count;
}

static void a_larger_threshold_leaves_fewer_triangles(void) {
    const struct method_recipe recipe = {.columns = 128, .rows = 128, .border_tolerance_m = 3};
    struct method_verdict verdict;
    uint32_t before = UINT32_MAX;
    double before_m = -1;
    for (double threshold = 0.5; threshold < 20; threshold *= 2) {
        uint32_t triangles = check(&recipe, threshold, &verdict);
        CU_ASSERT_TRUE(triangles < before);
        CU_ASSERT_TRUE(verdict.rms_m > before_m);
        before = triangles;
        before_m = verdict.rms_m;
    }
}

static void without_thresholds_all_posts_stay(void) {
    const struct method_recipe recipe = {.columns = 64, .rows = 64};
    struct method_verdict verdict;
    CU_ASSERT_EQUAL(check(&recipe, 0, &verdict), 2 * 64 * 64);
    CU_ASSERT_EQUAL(verdict.max_m, 0);
}

/* Lines with next to nothing under fine leaves, with everything under coarse ones, with vertices between the posts. */
static void any_line_is_met(void) {
    const int32_t sizes[][2] = {{1, 1}, {1, 40}, {40, 1}, {2, 3}, {5, 5}, {31, 33}, {64, 64}, {100, 7}};
    const double tolerances_m[] = {0, 2, 20, 1e6}, thresholds[] = {0, 1, 10, 1e9};
    struct method_verdict verdict;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (size_t i = 0; i < 4; i++)
            for (size_t k = 0; k < 4; k++)
                for (int32_t span = 1; span <= 4; span += 3) {
                    const struct method_recipe recipe = {.columns = sizes[s][0],
                                                         .rows = sizes[s][1],
                                                         .cell_span = span,
                                                         .border_tolerance_m = tolerances_m[i]};
                    check(&recipe, thresholds[k], &verdict);
                }
}

static void a_whole_tile_meets_bare_lines(void) {
    const struct method_recipe recipe = {.columns = 256, .rows = 256, .border_tolerance_m = 1e6};
    struct method_verdict verdict;
    CU_ASSERT_TRUE(check(&recipe, 0, &verdict) > 2 * 254 * 254);
}

/* A level tile of a coarse zoom is bent all the same. */
static void a_globe_is_round(void) {
    static float level_m[65 * 65];
    struct method_recipe recipe = {
        .columns = 64, .rows = 64, .cell_span = 2, .metres_a_step = 3000, .given_heights_m = level_m};
    struct method_verdict verdict;
    recipe.border_tolerance_m = 10;
    CU_ASSERT_EQUAL(check(&recipe, 0.5, &verdict), 2);
    recipe.is_round = true;
    CU_ASSERT_TRUE(check(&recipe, 0.5, &verdict) > 100);
    CU_ASSERT_TRUE(verdict.max_m < 100);
}

static void thresholds_stand_for_errors(void) {
    struct method_recipe recipe = {.columns = 256, .rows = 256, .cell_span = 1};
    for (int32_t span = 1; span <= 2; span++) {
        struct method_verdict verdict;
        recipe.cell_span = span;
        struct made_method_tile *made = made_method_tile_new(&recipe);
        double threshold = method_quadtree_threshold(&made->tile, 5);
        made_method_tile_free(made);
        check(&recipe, threshold, &verdict);
        CU_ASSERT_TRUE(verdict.rms_m > 0.5 && verdict.rms_m < 5);
        CU_ASSERT_TRUE(verdict.max_m > 5 && verdict.max_m < 50);
    }
}

static void the_same_comes_out_again(void) {
    const struct method_recipe recipe = {.columns = 100, .rows = 80, .border_tolerance_m = 5};
    const struct method_quadtree_options options = {2};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    struct scree_memory memory = {0};
    struct method_mesh one, other;
    CU_ASSERT_EQUAL_FATAL(method_quadtree(&memory, &made->tile, &options, &one, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(method_quadtree(&memory, &made->tile, &options, &other, NULL), SCREE_OK);
    CU_ASSERT_TRUE(method_meshes_equal(&one, &other));
    method_mesh_release(&memory, &one);
    method_mesh_release(&memory, &other);
    made_method_tile_free(made);
}

static void failures_leave_nothing_behind(void) {
    const struct method_recipe recipe = {.columns = 64, .rows = 50, .border_tolerance_m = 5};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    const double bad[] = {-1, NAN, INFINITY};
    for (int i = 0; i < 3; i++) {
        struct scree_memory memory = {0};
        struct method_mesh mesh;
        struct scree_error error = {0};
        const struct method_quadtree_options options = {bad[i]};
        CU_ASSERT_EQUAL(method_quadtree(&memory, &made->tile, &options, &mesh, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "threshold"));
        CU_ASSERT_PTR_NULL(mesh.vertices);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct method_mesh mesh;
        const struct method_quadtree_options options = {1};
        status = method_quadtree(&memory, &made->tile, &options, &mesh, NULL);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
        method_mesh_release(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 20);
    made_method_tile_free(made);
}

int suite_method_quadtree(void) {
    CU_pSuite suite = CU_add_suite("the method quadtree", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_larger_threshold_leaves_fewer_triangles);
    CU_ADD_TEST(suite, without_thresholds_all_posts_stay);
    CU_ADD_TEST(suite, any_line_is_met);
    CU_ADD_TEST(suite, a_whole_tile_meets_bare_lines);
    CU_ADD_TEST(suite, a_globe_is_round);
    CU_ADD_TEST(suite, thresholds_stand_for_errors);
    CU_ADD_TEST(suite, the_same_comes_out_again);
    CU_ADD_TEST(suite, failures_leave_nothing_behind);
    return 0;
}
