/* The exhaustive comparison of a mesh with its posts: known distances, and every way of not being a triangulation. */
#include "lod/grid_error.h"

#include <CUnit/CUnit.h>
#include <math.h>

/* A square of 3 x 3 posts with a summit, as two triangles. */
static const float summit_m[9] = {0, 0, 0, 0, 6, 0, 0, 0, 0};
static struct scree_vertex square[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
static uint32_t halves[] = {0, 1, 2, 0, 2, 3};
static uint32_t quarters[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};

static struct grid_error measure(const float *heights_m, const double *vertex_heights_m, uint32_t *corners,
                                 uint32_t triangle_count) {
    struct scree_mesh mesh = {5, triangle_count, square, corners};
    struct scree_memory memory = {0};
    struct grid_error result;
    CU_ASSERT_EQUAL_FATAL(grid_error_measure(heights_m, 3, 3, 3, &mesh, vertex_heights_m, &memory, &result, NULL),
                          SCREE_OK);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return result;
}

static void distances_are_vertical_and_counted_once(void) {
    struct grid_error result = measure(summit_m, NULL, halves, 2);
    CU_ASSERT_EQUAL(result.max_m, 6); /* the summit lies on the diagonal, in both triangles */
    CU_ASSERT_EQUAL(result.max_x, 1);
    CU_ASSERT_EQUAL(result.max_y, 1);
    CU_ASSERT_DOUBLE_EQUAL(result.mean_m, 6.0 / 9, 1e-15);
    CU_ASSERT_DOUBLE_EQUAL(result.rms_m, 2, 1e-15);
    CU_ASSERT_EQUAL(result.posts_covered, 9);
    CU_ASSERT_TRUE(result.covers);

    CU_ASSERT_EQUAL(measure(summit_m, NULL, quarters, 4).max_m, 0);
    const double lifted_m[5] = {1, 1, 1, 1, 7};
    result = measure(summit_m, lifted_m, quarters, 4);
    CU_ASSERT_EQUAL(result.max_m, 1);
    CU_ASSERT_EQUAL(result.mean_m, 1);
    CU_ASSERT_EQUAL(result.rms_m, 1);
}

static void what_is_no_triangulation_is_seen(void) {
    uint32_t one[] = {0, 1, 2};
    struct grid_error result = measure(summit_m, NULL, one, 1);
    CU_ASSERT_FALSE(result.areas_add_up);
    CU_ASSERT_FALSE(result.covers);
    CU_ASSERT_EQUAL(result.posts_covered, 6);

    uint32_t turned[] = {0, 1, 2, 0, 3, 2};
    result = measure(summit_m, NULL, turned, 2);
    CU_ASSERT_EQUAL(result.turned_triangles, 1);
    CU_ASSERT_FALSE(result.covers);

    uint32_t flat[] = {0, 1, 2, 0, 2, 3, 0, 2, 4};
    result = measure(summit_m, NULL, flat, 3);
    CU_ASSERT_EQUAL(result.flat_triangles, 1);
    CU_ASSERT_TRUE(result.areas_add_up);
    CU_ASSERT_FALSE(result.covers);

    uint32_t twice[] = {0, 1, 2, 0, 1, 2}; /* the right area in the wrong place */
    result = measure(summit_m, NULL, twice, 2);
    CU_ASSERT_TRUE(result.areas_add_up);
    CU_ASSERT_FALSE(result.covers);
}

static void no_number_is_an_endless_error(void) {
    float heights_m[9] = {0};
    heights_m[4] = NAN;
    CU_ASSERT_EQUAL(measure(heights_m, NULL, halves, 2).max_m, HUGE_VAL);
    const double vertex_heights_m[5] = {0, NAN, 0, 0, 0};
    CU_ASSERT_EQUAL(measure(summit_m, vertex_heights_m, halves, 2).max_m, HUGE_VAL);
}

/* Against arithmetic of another kind: a slanted triangle pair on a large odd rectangle and a paraboloid. */
static void slanted_triangles_agree_with_brute_force(void) {
    enum { COLUMNS = 61, ROWS = 47 };
    static float heights_m[COLUMNS * ROWS];
    for (int i = 0; i < COLUMNS * ROWS; i++) heights_m[i] = (float)((i % COLUMNS) * (i % COLUMNS) - 3 * (i / COLUMNS));
    struct scree_vertex vertices[] = {{0, 0, 0}, {60, 0, 0}, {60, 46, 0}, {0, 46, 0}, {17, 29, 0}};
    struct scree_mesh mesh = {5, 4, vertices, quarters};
    struct scree_memory memory = {0};
    struct grid_error result;
    CU_ASSERT_EQUAL_FATAL(grid_error_measure(heights_m, COLUMNS, ROWS, COLUMNS, &mesh, NULL, &memory, &result, NULL),
                          SCREE_OK);
    double max_m = 0, sum_squares_m2 = 0;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            double nearest_m = HUGE_VAL;
            for (int t = 0; t < 4; t++) {
                const struct scree_vertex *a = &vertices[quarters[3 * t]], *b = &vertices[quarters[3 * t + 1]],
                                          *c = &vertices[quarters[3 * t + 2]];
                double whole = (double)(b->x - a->x) * (c->y - a->y) - (double)(c->x - a->x) * (b->y - a->y);
                double u = ((double)(x - a->x) * (c->y - a->y) - (double)(c->x - a->x) * (y - a->y)) / whole;
                double v = ((double)(b->x - a->x) * (y - a->y) - (double)(x - a->x) * (b->y - a->y)) / whole;
                if (u < -1e-12 || v < -1e-12 || u + v > 1 + 1e-12) continue;
                double za = heights_m[a->y * COLUMNS + a->x], zb = heights_m[b->y * COLUMNS + b->x],
                       zc = heights_m[c->y * COLUMNS + c->x];
                nearest_m = fabs(za + u * (zb - za) + v * (zc - za) - heights_m[y * COLUMNS + x]);
            }
            if (nearest_m > max_m) max_m = nearest_m;
            sum_squares_m2 += nearest_m * nearest_m;
        }
    CU_ASSERT_TRUE(result.covers);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, max_m, 1e-9);
    CU_ASSERT_DOUBLE_EQUAL(result.rms_m, sqrt(sum_squares_m2 / (COLUMNS * ROWS)), 1e-9);
}

static void bad_meshes_are_refused(void) {
    struct scree_memory memory = {0};
    struct grid_error result;
    struct scree_vertex outside[] = {{0, 0, 0}, {3, 0, 0}, {2, 2, 0}, {-1, 2, 0}};
    uint32_t wild[] = {0, 1, 5};
    struct scree_mesh far_out = {4, 2, outside, halves}, wrong = {5, 1, square, wild}, fine = {5, 2, square, halves};
    CU_ASSERT_EQUAL(grid_error_measure(summit_m, 3, 3, 3, &far_out, NULL, &memory, &result, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(grid_error_measure(summit_m, 3, 3, 3, &wrong, NULL, &memory, &result, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(grid_error_measure(summit_m, 0, 3, 3, &fine, NULL, &memory, &result, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(grid_error_measure(summit_m, 3, 3, 2, &fine, NULL, &memory, &result, NULL), SCREE_E_ARGUMENT);
    memory.fail_request = memory.requests + 1;
    CU_ASSERT_EQUAL(grid_error_measure(summit_m, 3, 3, 3, &fine, NULL, &memory, &result, NULL), SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_grid_error(void) {
    CU_pSuite suite = CU_add_suite("error against a grid", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, distances_are_vertical_and_counted_once);
    CU_ADD_TEST(suite, what_is_no_triangulation_is_seen);
    CU_ADD_TEST(suite, no_number_is_an_endless_error);
    CU_ADD_TEST(suite, slanted_triangles_agree_with_brute_force);
    CU_ADD_TEST(suite, bad_meshes_are_refused);
    return 0;
}
