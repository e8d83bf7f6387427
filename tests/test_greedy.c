/* Greedy insertion: the bound holds at every post (as another piece of code measures it), the triangulation is whole
 * and Delaunay, and failures leave nothing behind. */
#include "lod/greedy.h"
#include "lod/grid_error.h"
#include "tests/fractal.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 129 };

static void make_terrain(float *heights_m, int columns, int rows, bool whole_metres) {
    struct fractal fractal = {.seed = 7, .whole_metres = whole_metres};
    fractal_window(&fractal, 1000, -300, columns, rows, heights_m, columns);
}

/* Triangulates, has the result judged, and checks what holds for every result. Returns the triangles. */
static uint32_t check_triangulation(const float *heights_m, int columns, int rows, int stride, double tolerance_m,
                                    uint32_t max_vertices, struct grid_error *judged) {
    struct greedy_options options = {tolerance_m, max_vertices};
    struct scree_memory memory = {0};
    struct scree_mesh mesh = {0};
    struct scree_error error = {0};
    double max_error_m = -1;
    enum scree_status status =
        greedy_triangulate(heights_m, columns, rows, stride, &options, &memory, &mesh, &max_error_m, &error);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    status = grid_error_measure(heights_m, columns, rows, stride, &mesh, NULL, &memory, judged, &error);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    CU_ASSERT_TRUE(judged->covers);
    CU_ASSERT_DOUBLE_EQUAL(max_error_m, judged->max_m, 1e-7);
    if (max_vertices == 0) CU_ASSERT_TRUE(judged->max_m <= tolerance_m);
    if (max_vertices != 0) CU_ASSERT_TRUE(mesh.vertex_count <= max_vertices);
    uint32_t triangle_count = mesh.triangle_count;
    greedy_free(&mesh, &memory);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return triangle_count;
}

static void the_bound_holds_at_every_post(void) {
    static float heights_m[SIDE * SIDE];
    const double tolerances_m[] = {50, 20, 5, 1, 0.5, 0};
    for (int whole = 0; whole < 2; whole++) {
        make_terrain(heights_m, SIDE, SIDE, whole);
        uint32_t before = 0;
        for (size_t i = 0; i < sizeof tolerances_m / sizeof *tolerances_m; i++) {
            struct grid_error judged;
            uint32_t triangles = check_triangulation(heights_m, SIDE, SIDE, SIDE, tolerances_m[i], 0, &judged);
            CU_ASSERT_TRUE(triangles > before); /* rough terrain: less tolerance, more triangles */
            before = triangles;
        }
    }
}

static void a_plane_takes_two_triangles(void) {
    static float heights_m[33 * 65];
    for (int y = 0; y < 33; y++)
        for (int x = 0; x < 65; x++) heights_m[y * 65 + x] = (float)(1000 - 3 * x + 7 * y);
    struct grid_error judged;
    CU_ASSERT_EQUAL(check_triangulation(heights_m, 65, 33, 65, 0, 0, &judged), 2);
    heights_m[16 * 65 + 32] += 10; /* a spike: first its post, then the four beside it */
    uint32_t triangles = check_triangulation(heights_m, 65, 33, 65, 0, 0, &judged);
    CU_ASSERT_TRUE(triangles >= 12 && triangles < 40);
}

static void any_shape_and_stride(void) {
    const int shapes[][2] = {{2, 2}, {2, 40}, {40, 2}, {3, 3}, {5, 100}, {129, 17}};
    static float heights_m[SIDE * SIDE];
    make_terrain(heights_m, SIDE, SIDE, true);
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        struct grid_error judged;
        check_triangulation(heights_m, shapes[i][0], shapes[i][1], SIDE, 2, 0, &judged);
        uint32_t triangles = check_triangulation(heights_m, shapes[i][0], shapes[i][1], SIDE, 0, 0, &judged);
        CU_ASSERT_TRUE(triangles >= 2);
        CU_ASSERT_EQUAL(judged.max_m, 0);
    }
}

static void vertices_are_limited(void) {
    static float heights_m[SIDE * SIDE];
    make_terrain(heights_m, SIDE, SIDE, true);
    double before_m = INFINITY;
    for (uint32_t limit = 4; limit <= 4096; limit *= 4) {
        struct grid_error judged;
        check_triangulation(heights_m, SIDE, SIDE, SIDE, 0, limit, &judged);
        CU_ASSERT_TRUE(judged.rms_m < before_m);
        before_m = judged.rms_m;
    }
}

/* No vertex strictly inside a triangle's circle: here in 128 bits and over all vertices, for a mesh of some size. */
static void the_triangulation_is_delaunay(void) {
    static float heights_m[SIDE * SIDE];
    make_terrain(heights_m, SIDE, SIDE, true);
    struct scree_memory memory = {0};
    struct scree_mesh mesh = {0};
    CU_ASSERT_EQUAL_FATAL(
        greedy_triangulate(heights_m, SIDE, SIDE, SIDE, &(struct greedy_options){3, 0}, &memory, &mesh, NULL, NULL),
        SCREE_OK);
    uint32_t intruders = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        for (uint32_t i = 0; i < mesh.vertex_count; i++) {
            const struct scree_vertex *d = &mesh.vertices[i];
            __extension__ __int128 x[3], y[3], square[3];
            for (int k = 0; k < 3; k++) {
                const struct scree_vertex *v = &mesh.vertices[mesh.corners[3 * t + (uint32_t)k]];
                x[k] = v->x - d->x;
                y[k] = v->y - d->y;
                square[k] = x[k] * x[k] + y[k] * y[k];
            }
            intruders += x[0] * (y[1] * square[2] - square[1] * y[2]) - y[0] * (x[1] * square[2] - square[1] * x[2]) +
                             square[0] * (x[1] * y[2] - y[1] * x[2]) >
                         0;
        }
    CU_ASSERT_TRUE(mesh.triangle_count > 500);
    CU_ASSERT_EQUAL(intruders, 0);
    greedy_free(&mesh, &memory);
}

/* The largest side that is taken, so that the widest numbers meet: relief in two far corners only. */
static void the_widest_grid_is_exact(void) {
    const int columns = GREEDY_MAX_POSTS, rows = GREEDY_MAX_POSTS / 64;
    float *heights_m = calloc((size_t)columns * (size_t)rows, sizeof *heights_m);
    CU_ASSERT_PTR_NOT_NULL_FATAL(heights_m);
    for (int i = 0; i < 2000; i++) heights_m[(size_t)i * 2654435761U % ((size_t)columns * (size_t)rows)] = (float)i;
    struct grid_error judged;
    uint32_t triangles = check_triangulation(heights_m, columns, rows, columns, 3, 0, &judged);
    CU_ASSERT_TRUE(triangles > 4000);
    free(heights_m);
}

static void bad_arguments_are_refused(void) {
    float heights_m[9] = {0};
    struct scree_memory memory = {0};
    struct scree_mesh mesh = {0};
    const struct {
        int columns, rows, stride;
        double tolerance_m;
        uint32_t max_vertices;
    } bad[] = {
        {1, 3, 3, 1, 0},  {3, 1, 3, 1, 0},   {3, 3, 2, 1, 0}, {3, 0, 3, 1, 0}, {GREEDY_MAX_POSTS + 1, 3, 9000, 1, 0},
        {3, 3, 3, -1, 0}, {3, 3, 3, NAN, 0}, {3, 3, 3, 1, 3}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct scree_error error = {0};
        struct greedy_options options = {bad[i].tolerance_m, bad[i].max_vertices};
        CU_ASSERT_EQUAL(greedy_triangulate(heights_m, bad[i].columns, bad[i].rows, bad[i].stride, &options, &memory,
                                           &mesh, NULL, &error),
                        SCREE_E_ARGUMENT);
        CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
    }
    const float odd[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        struct scree_error error = {0};
        heights_m[5] = odd[i];
        CU_ASSERT_EQUAL(
            greedy_triangulate(heights_m, 3, 3, 3, &(struct greedy_options){1, 0}, &memory, &mesh, NULL, &error),
            SCREE_E_ARGUMENT);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "post 2, 1"));
    }
    CU_ASSERT_PTR_NULL(mesh.vertices);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void every_failed_request_is_survived(void) {
    static float heights_m[SIDE * SIDE];
    make_terrain(heights_m, SIDE, SIDE, true);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct scree_mesh mesh = {0};
        struct scree_error error = {0};
        status = greedy_triangulate(heights_m, SIDE, SIDE, SIDE, &(struct greedy_options){1, 0}, &memory, &mesh, NULL,
                                    &error);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
        greedy_free(&mesh, &memory);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 8); /* the arrays have grown at least once */

    struct scree_memory small = {.limit_bytes = 10000};
    struct scree_mesh mesh = {0};
    CU_ASSERT_EQUAL(
        greedy_triangulate(heights_m, SIDE, SIDE, SIDE, &(struct greedy_options){1, 0}, &small, &mesh, NULL, NULL),
        SCREE_E_LIMIT);
    CU_ASSERT_EQUAL(small.used_bytes, 0);
}

int suite_greedy(void) {
    CU_pSuite suite = CU_add_suite("greedy insertion", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, the_bound_holds_at_every_post);
    CU_ADD_TEST(suite, a_plane_takes_two_triangles);
    CU_ADD_TEST(suite, any_shape_and_stride);
    CU_ADD_TEST(suite, vertices_are_limited);
    CU_ADD_TEST(suite, the_triangulation_is_delaunay);
    CU_ADD_TEST(suite, the_widest_grid_is_exact);
    CU_ADD_TEST(suite, bad_arguments_are_refused);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
