/* Scree's own collapse as a method on one tile's posts: with its bound, which holds, and without. */
#include "lod/method_greedy.h"
#include "lod/method_qem.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>

static struct method_verdict run(const struct method_tile *tile, const struct method_qem_options *options,
                                 uint32_t *triangles) {
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0}, again = {0};
    CU_ASSERT_EQUAL_FATAL(method_qem(&memory, tile, options, &mesh, NULL), SCREE_OK);
    struct method_verdict verdict = method_judge(tile, &mesh);
    CU_ASSERT_TRUE(verdict.is_triangulation);
    CU_ASSERT_PTR_NULL(verdict.fault);
    CU_ASSERT_EQUAL(method_qem(&memory, tile, options, &again, NULL), SCREE_OK);
    CU_ASSERT_TRUE(method_meshes_equal(&mesh, &again));
    *triangles = mesh.triangle_count;
    method_mesh_release(&memory, &again);
    method_mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return verdict;
}

static void the_bound_holds_in_any_shape(void) {
    const int32_t shapes[][2] = {{1, 1}, {1, 9}, {2, 2}, {2, 30}, {30, 2}, {3, 3}, {64, 48}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (int32_t span = 1; span <= 1024; span *= 32) {
            struct method_recipe recipe = {.columns = shapes[i][0],
                                           .rows = shapes[i][1],
                                           .cell_span = span,
                                           .border_tolerance_m = 5,
                                           .metres_a_step = 30.0 / span};
            struct made_method_tile *made = made_method_tile_new(&recipe);
            uint32_t triangles, fewer;
            struct method_verdict verdict =
                run(&made->tile, &(struct method_qem_options){.tolerance_m = 8}, &triangles);
            if (shapes[i][0] > 1 && shapes[i][1] > 1) CU_ASSERT_TRUE(verdict.max_m <= 8 + 1e-3);
            run(&made->tile, &(struct method_qem_options){.tolerance_m = 40}, &fewer);
            CU_ASSERT_TRUE(fewer <= triangles);
            made_method_tile_free(made);
        }
}

static void it_beats_greedy_insertion(void) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct method_recipe recipe = {.columns = 128, .rows = 128, .border_tolerance_m = 7, .seed = seed};
        struct made_method_tile *made = made_method_tile_new(&recipe);
        struct scree_memory memory = {0};
        struct method_mesh greedy = {0};
        uint32_t triangles;
        run(&made->tile, &(struct method_qem_options){.tolerance_m = 10}, &triangles);
        CU_ASSERT_EQUAL(
            method_greedy(&memory, &made->tile, &(struct method_greedy_options){.tolerance_m = 10}, &greedy, NULL),
            SCREE_OK);
        CU_ASSERT_TRUE(triangles < 0.85 * greedy.triangle_count);
        method_mesh_release(&memory, &greedy);
        made_method_tile_free(made);
    }
}

static void without_a_bound_the_mean_is_better(void) {
    struct method_recipe recipe = {.columns = 128, .rows = 128, .border_tolerance_m = 7, .is_round = true};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    uint32_t bounded, free_ones;
    struct method_verdict with = run(&made->tile, &(struct method_qem_options){.tolerance_m = 20}, &bounded);
    uint32_t ring = 0;
    for (int side = 0; side < SIDE_COUNT; side++) ring += (uint32_t)made->lines[side].vertex_count - 1;
    struct method_qem_options options = {.is_unbounded = true, .least_vertices = (bounded + ring + 2) / 2};
    struct method_verdict without = run(&made->tile, &options, &free_ones);
    CU_ASSERT_EQUAL(free_ones, 2 * options.least_vertices - 2 - ring);
    CU_ASSERT_TRUE(without.rms_m < with.rms_m);
    CU_ASSERT_TRUE(without.max_m > with.max_m);
    options.least_vertices = 0;
    run(&made->tile, &options, &free_ones);
    CU_ASSERT_TRUE(free_ones < 3 * ring); /* hardly anything but the border is left */
    made_method_tile_free(made);
}

static void failures_leave_nothing_behind(void) {
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 32, .rows = 32, .cell_span = 4, .border_tolerance_m = 1, .is_round = true});
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct method_mesh mesh = {0};
        status = method_qem(&memory, &made->tile, &(struct method_qem_options){.tolerance_m = 5}, &mesh, NULL);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
        method_mesh_release(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 8);
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0};
    CU_ASSERT_EQUAL(
        method_qem(&memory, &made->tile, &(struct method_qem_options){.tolerance_m = (double)NAN}, &mesh, NULL),
        SCREE_E_ARGUMENT);
    made_method_tile_free(made);
}

int suite_method_qem(void) {
    CU_pSuite suite = CU_add_suite("collapse as a method", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, the_bound_holds_in_any_shape);
    CU_ADD_TEST(suite, it_beats_greedy_insertion);
    CU_ADD_TEST(suite, without_a_bound_the_mean_is_better);
    CU_ADD_TEST(suite, failures_leave_nothing_behind);
    return 0;
}
