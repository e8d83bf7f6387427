/* Tests of the measure at a TIN's points, and of points that rounding has put into one place. */
#include "src/point_residual.h"
#include "src/tin_twins.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct lattice square_lattice(int64_t steps) {
    struct lattice lattice;
    CU_ASSERT_EQUAL_FATAL(lattice_local(steps + 1, steps + 1, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_OK);
    return lattice;
}

static float plane(int32_t x, int32_t y) {
    return 0.25F * (float)x - 0.5F * (float)y + 7;
}

static struct tin_post post_of(int32_t x, int32_t y, float above_m) {
    return (struct tin_post){.x = x, .y = y, .height_m = plane(x, y) + above_m};
}

/* Points on a plane, one above it, two beside the tile; the mesh is the tile's square in two triangles. */
static void test_mesh(void) {
    struct lattice lattice = square_lattice(512);
    const struct tile_id id = {1, 1, 0};
    const struct scree_vertex vertices[4] = {{0, 0, 0}, {256, 0, 256}, {256, 256, -256}, {0, 256, -512}};
    const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    const struct post_mesh mesh = {vertices, corners, 2, 0.25};
    struct tin_post posts[64];
    uint32_t count = 0;
    /* in steps from (200, 0), so that the tile begins at 56; the plane is 0 at the tile's corner */
    for (int32_t y = 0; y <= 256; y += 64)
        for (int32_t x = 56; x <= 312; x += 64) posts[count++] = post_of(x, y, -7 - 0.25F * 56);
    posts[count++] = post_of(100, 33, 3 - 7 - 0.25F * 56);
    posts[count++] = post_of(55, 20, 100); /* beside it */
    posts[count++] = post_of(70, 257, 100);
    struct scree_memory memory = {0};
    struct residual_points points;
    CU_ASSERT_EQUAL_FATAL(residual_points_begin(&memory, posts, count, 200, 0, &points, NULL), SCREE_OK);
    for (int turn = 0; turn < 2; turn++) {
        struct residuals *found = calloc(1, sizeof *found);
        CU_ASSERT_PTR_NOT_NULL_FATAL(found);
        residual_points_add_mesh(&lattice, id, &mesh, turn == 0, turn == 0, &points, found);
        CU_ASSERT_EQUAL(found->posts, turn == 0 ? 26 : 17); /* without those of the neighbours in the east and north */
        CU_ASSERT_DOUBLE_EQUAL(found->height.max_m, 3, 1e-6);
        CU_ASSERT_DOUBLE_EQUAL(found->drawn.max_m, 3, 1e-6);
        CU_ASSERT_EQUAL(found->height.max_x, 300);
        CU_ASSERT_EQUAL(found->height.max_y, 33);
        CU_ASSERT_DOUBLE_EQUAL(found->height.sum_m, 3, 1e-4);
        free(found);
    }
    const struct lattice_window near = {455, 0, 10, 10}, far = {1000, 0, 10, 10};
    CU_ASSERT_TRUE(residual_points_touch(&points, &near));
    CU_ASSERT_FALSE(residual_points_touch(&points, &far));
    residual_points_release(&points);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* A tile of more steps than codes: a pinnacle of 100 m stands at an odd step, which codes cannot name, and the edge of
 * a thin triangle passes it by two steps. What is measured there is the pinnacle itself, and what a vertex that is no
 * point may have moved does not count. */
static void test_rounded_tile(void) {
    struct lattice lattice = square_lattice(65536);
    uint16_t u[6], v[6], h[6] = {0, 0, 0, 0, 32767, 0};
    const int32_t at[6][2] = {{0, 0}, {65536, 0}, {65536, 65536}, {0, 65536}, {30001, 30001}, {30003, 30001}};
    for (int i = 0; i < 6; i++) {
        u[i] = (uint16_t)lrint(at[i][0] * 32767.0 / 65536);
        v[i] = (uint16_t)lrint(at[i][1] * 32767.0 / 65536);
    }
    uint32_t corners[24] = {0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 4, 5, 2, 3, 4, 3, 0, 4};
    struct decoded_tile tile = {.height_min_m = 0,
                                .height_max_m = 100,
                                .vertex_count = 6,
                                .u = u,
                                .v = v,
                                .h = h,
                                .triangle_count = 6,
                                .corners = corners};
    struct tin_post posts[4] = {{.x = 30001, .y = 30001, .height_m = 100},
                                {.x = 0, .y = 0},
                                {.x = 30001, .y = 60000},
                                {.x = 65536, .y = 65536}};
    double expected_m = 100 * (65536.0 - 60000) / (65536 - 30001); /* on the slope from the pinnacle to the north */
    posts[2].height_m = (float)expected_m + 1;
    struct scree_memory memory = {0};
    struct residual_points points;
    struct residuals *found = calloc(1, sizeof *found);
    CU_ASSERT_PTR_NOT_NULL_FATAL(found);
    CU_ASSERT_EQUAL_FATAL(residual_points_begin(&memory, posts, 4, 0, 0, &points, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(residual_points_add(&lattice, (struct tile_id){0, 0, 0}, &tile, true, true, &points, found, NULL),
                    SCREE_OK);
    CU_ASSERT_EQUAL(found->posts, 4);
    CU_ASSERT_DOUBLE_EQUAL(found->height.max_m, 1, 0.01);
    CU_ASSERT_EQUAL(found->height.max_y, 60000);
    residual_points_release(&points);
    posts[0].height_m = 90; /* which the mesh has not got */
    memset(found, 0, sizeof *found);
    CU_ASSERT_EQUAL_FATAL(residual_points_begin(&memory, posts, 4, 0, 0, &points, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(residual_points_add(&lattice, (struct tile_id){0, 0, 0}, &tile, true, true, &points, found, NULL),
                    SCREE_OK);
    CU_ASSERT_DOUBLE_EQUAL(found->height.max_m, 10, 0.01);
    residual_points_release(&points);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(found);
}

static void test_twins(void) {
    struct tin_post posts[1000];
    struct scree_memory memory = {0};
    for (int i = 0; i < 1000; i++) /* ten of a hundred places */
        posts[i] = (struct tin_post){.x = i % 100 * 20000000, .y = -i % 100, .height_m = (float)((i * 37) % 1000)};
    CU_ASSERT_EQUAL(tin_twins_level(&memory, posts, 1000, NULL), SCREE_OK);
    for (int i = 0; i < 1000; i++) {
        int lowest = 1000;
        for (int k = i % 100; k < 1000; k += 100) lowest = k * 37 % 1000 < lowest ? k * 37 % 1000 : lowest;
        CU_ASSERT_EQUAL(posts[i].height_m, (float)lowest);
        CU_ASSERT_EQUAL(posts[i].y, -i % 100);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    memory.fail_request = memory.requests + 1;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(tin_twins_level(&memory, posts, 1000, &error), SCREE_E_MEMORY);
}

static void test_no_memory(void) {
    struct tin_post posts[9];
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t failed = 0;
    for (int i = 0; i < 9; i++) posts[i] = post_of(i % 3 * 50, i / 3 * 50, 0);
    for (uint64_t n = 1; status != SCREE_OK && n < 20; n++, failed++) {
        struct scree_memory memory = {.fail_request = n};
        struct residual_points points;
        struct scree_error error = {0};
        status = residual_points_begin(&memory, posts, 9, 0, 0, &points, &error);
        residual_points_release(&points);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(failed > 5);
}

int suite_point_residual(void) {
    CU_pSuite suite = CU_add_suite("point residual", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_mesh);
    CU_ADD_TEST(suite, test_rounded_tile);
    CU_ADD_TEST(suite, test_twins);
    CU_ADD_TEST(suite, test_no_memory);
    return 0;
}
