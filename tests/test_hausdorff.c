/* Distances between surfaces: known ones, and the index against asking every triangle. */
#include "lod/hausdorff.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

#define SIDE     24 /* cells of the test's grids */
#define VERTICES ((SIDE + 1) * (SIDE + 1))
#define CORNERS  (6 * SIDE * SIDE)

struct grid {
    struct vector3 vertices_m[VERTICES];
    uint32_t corners[CORNERS];
};

static const struct hausdorff_options usual = {HAUSDORFF_POINTS, HAUSDORFF_POINTS, 1};

/* A level square of SIDE x SIDE metres, its first corner at (x, y). */
static struct space_mesh make_grid(struct grid *grid, double x, double y, double z) {
    uint32_t at = 0;
    for (uint32_t row = 0; row <= SIDE; row++)
        for (uint32_t column = 0; column <= SIDE; column++)
            grid->vertices_m[row * (SIDE + 1) + column] = (struct vector3){x + column, y + row, z};
    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; column < SIDE; column++) {
            uint32_t a = row * (SIDE + 1) + column, cell[6] = {a, a + 1, a + SIDE + 2, a, a + SIDE + 2, a + SIDE + 1};
            for (int k = 0; k < 6; k++) grid->corners[at++] = cell[k];
        }
    return (struct space_mesh){VERTICES, CORNERS / 3, grid->vertices_m, grid->corners};
}

static struct hausdorff compare(const struct space_mesh *a, const struct space_mesh *b,
                                const struct hausdorff_options *options, double *distances_m) {
    struct scree_memory memory = {0};
    struct hausdorff_surface first, second;
    CU_ASSERT_EQUAL_FATAL(hausdorff_prepare(&memory, a, options, &first, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(hausdorff_prepare(&memory, b, options, &second, NULL), SCREE_OK);
    struct hausdorff result = hausdorff_measure(&first, &second, distances_m);
    hausdorff_release(&memory, &first);
    hausdorff_release(&memory, &second);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return result;
}

static void a_triangle_has_a_face_edges_and_corners(void) {
    struct vector3 a = {0, 0, 0}, b = {4, 0, 0}, c = {0, 3, 0};
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){1, 1, 5}, a, b, c), 5);
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){1, 1, 0}, a, b, c), 0);
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){2, -3, 4}, a, b, c), 5);
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){-3, -4, 0}, a, b, c), 5);
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){8, 0, 3}, a, b, c), 5);
    CU_ASSERT_DOUBLE_EQUAL(triangle_distance_m((struct vector3){4, 3, 0}, a, b, c), 2.4, 1e-15);
    /* a line, a point, and next to a line */
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){2, 0, 7}, a, b, (struct vector3){1, 0, 0}), 7);
    CU_ASSERT_EQUAL(triangle_distance_m((struct vector3){2, 0, 0}, a, a, a), 2);
    struct vector3 sliver = {1, 1e-9, 0};
    CU_ASSERT_DOUBLE_EQUAL(triangle_distance_m((struct vector3){3, 0, 7}, a, b, sliver), 7, 1e-8);
}

static void parallel_planes_are_as_far_apart_as_they_are(void) {
    static struct grid low, high;
    struct space_mesh a = make_grid(&low, 0, 0, 100), b = make_grid(&high, 0, 0, 105);
    struct hausdorff result = compare(&a, &b, &usual, NULL);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 5, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(result.mean_m, 5, 1e-12);
    CU_ASSERT_EQUAL(result.sample_count, 2 * (VERTICES + 2 * HAUSDORFF_POINTS));
    result = compare(&a, &a, &usual, NULL);
    CU_ASSERT_DOUBLE_EQUAL(result.max_m, 0, 1e-12);
}

static void a_shifted_plane_is_off_by_the_shift(void) {
    static struct grid grid, shifted;
    struct space_mesh a = make_grid(&grid, 0, 0, 0), b = make_grid(&shifted, 3, 0, 0);
    struct hausdorff result = compare(&a, &b, &usual, NULL);
    CU_ASSERT_EQUAL(result.max_m, 3);
    CU_ASSERT_EQUAL(result.from_first_m, 3);
    CU_ASSERT_EQUAL(result.from_second_m, 3);
    CU_ASSERT_TRUE(result.mean_m > 0.1 && result.mean_m < 0.5); /* 3 of 24 metres, 1.5 on average: 0.19, and vertices */
    b = make_grid(&shifted, 1000, 0, 0);
    CU_ASSERT_EQUAL(compare(&a, &b, &usual, NULL).max_m, 1000);
}

static void a_spike_is_farther_from_the_plane_than_the_plane_from_it(void) {
    static struct grid plane, spiked;
    struct space_mesh a = make_grid(&plane, 0, 0, 0), b = make_grid(&spiked, 0, 0, 0);
    uint32_t middle = SIDE / 2 * (SIDE + 1) + SIDE / 2;
    spiked.vertices_m[middle].z = 10;
    struct hausdorff result = compare(&a, &b, &usual, NULL);
    CU_ASSERT_EQUAL(result.from_second_m, 10);
    /* the plane's vertex under the summit; the steepest sides fall by 10 m from there to the edge from (0, 1) to (-1,
     * 0), in the plane z = 10 - 10 (y - x), and to the one across */
    CU_ASSERT_DOUBLE_EQUAL(result.from_first_m, 10 / sqrt(201), 1e-12);
    CU_ASSERT_EQUAL(result.max_m, 10);
}

static double wave(double x, double y) {
    return 3 * sin(0.9 * x) * cos(0.7 * y) + 0.3 * sin(5 * x + y);
}

/* Waves, thin triangles and a wall; points within, beside, above and far away. */
static void the_index_finds_what_asking_all_triangles_finds(void) {
    static struct grid grid;
    struct scree_memory memory = {0};
    struct distance_index index;
    struct space_mesh mesh = make_grid(&grid, -5, 7, 0);
    for (uint32_t i = 0; i < VERTICES; i++) {
        struct vector3 *v = &grid.vertices_m[i];
        v->z = wave(v->x, v->y);
        if (i % 7 == 0) v->x += 0.999;
        if (i % 11 == 0) v->z += 20;
    }
    memcpy(grid.corners, (uint32_t[]){0, SIDE, VERTICES - 1}, 3 * sizeof *grid.corners);
    CU_ASSERT_EQUAL_FATAL(distance_index_make(&memory, &mesh, &index, NULL), SCREE_OK);
    for (int i = 0; i < 2000; i++) {
        double reach = i % 10 == 0 ? 500 : 20;
        struct vector3 point = {7 + reach * sin(1.3 * i), 19 + reach * sin(2.1 * i + 1), 3 + reach * sin(0.37 * i)};
        double nearest_m = HUGE_VAL;
        for (uint32_t t = 0; t < mesh.triangle_count; t++)
            nearest_m = fmin(nearest_m, triangle_distance_m(point, grid.vertices_m[grid.corners[3 * t]],
                                                            grid.vertices_m[grid.corners[3 * t + 1]],
                                                            grid.vertices_m[grid.corners[3 * t + 2]]));
        CU_ASSERT_DOUBLE_EQUAL(mesh_distance_m(&index, point), nearest_m, 1e-9);
    }
    distance_index_release(&memory, &index);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void samples_lie_on_the_surface_where_it_is_large(void) {
    struct vector3 vertices_m[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-9, 0, 9}}; /* areas 0.5 and 9 / sqrt(2) */
    uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    struct space_mesh mesh = {4, 2, vertices_m, corners};
    struct hausdorff_options options = {4000, 4000, 5};
    struct hausdorff_surface prepared;
    struct scree_memory memory = {0};
    uint32_t small = 0, steep = 0;
    CU_ASSERT_EQUAL_FATAL(hausdorff_prepare(&memory, &mesh, &options, &prepared, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(prepared.sample_count, 8004);
    for (uint32_t i = 0; i < prepared.sample_count; i++)
        CU_ASSERT_TRUE(mesh_distance_m(&prepared.index, prepared.samples_m[i]) < 1e-12);
    for (uint32_t i = 4; i < 4004; i++) small += prepared.samples_m[i].x > 0;
    for (uint32_t i = 4004; i < 8004; i++) steep += prepared.samples_m[i].z > 0;
    CU_ASSERT_DOUBLE_EQUAL(small / 4000.0, 0.5 / (0.5 + 9 / sqrt(2)), 0.015);
    /* edges: 1, 1 and sqrt(2) below, sqrt(162) and sqrt(163) that rise; the shared one counts once */
    double rising = sqrt(162) + sqrt(163);
    CU_ASSERT_DOUBLE_EQUAL(steep / 4000.0, rising / (rising + 2 + sqrt(2)), 0.015);
    hausdorff_release(&memory, &prepared);
}

static void a_seed_gives_the_same_points_again(void) {
    static struct grid grid, other;
    static double first_m[2 * (VERTICES + 100)], again_m[2 * (VERTICES + 100)];
    struct hausdorff_options options = {50, 50, 7};
    struct space_mesh a = make_grid(&grid, 0, 0, 0), b = make_grid(&other, 0.25, 0.5, 0);
    for (uint32_t i = 0; i < VERTICES; i++) other.vertices_m[i].z = wave(i % (SIDE + 1), i / (double)(SIDE + 1));
    struct hausdorff result = compare(&a, &b, &options, first_m), again = compare(&a, &b, &options, again_m);
    CU_ASSERT_EQUAL_FATAL(result.sample_count, 2 * (VERTICES + 100));
    CU_ASSERT_EQUAL(memcmp(&result, &again, sizeof result), 0);
    CU_ASSERT_EQUAL(memcmp(first_m, again_m, sizeof first_m), 0);
    double sum_m = 0;
    for (uint32_t i = 0; i < result.sample_count; i++) {
        CU_ASSERT_TRUE(i == 0 || first_m[i] >= first_m[i - 1]);
        sum_m += first_m[i];
    }
    CU_ASSERT_EQUAL(first_m[result.sample_count - 1], result.max_m);
    CU_ASSERT_DOUBLE_EQUAL(sum_m / result.sample_count, result.mean_m, 1e-12);
    options.seed = 8;
    again = compare(&a, &b, &options, again_m);
    CU_ASSERT_NOT_EQUAL(again.mean_m, result.mean_m);
    CU_ASSERT_DOUBLE_EQUAL(again.mean_m, result.mean_m, 0.05 * result.mean_m);
}

static void degenerate_meshes_are_refused_or_measured(void) {
    struct vector3 vertices_m[] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}};
    uint32_t corners[] = {0, 1, 2, 0, 2, 3}, point[] = {0, 0, 0}, beyond[] = {0, 1, 4};
    struct space_mesh wall = {4, 2, vertices_m, corners}, dot = {1, 1, vertices_m, point};
    struct scree_memory memory = {0};
    struct hausdorff_surface prepared;
    CU_ASSERT_EQUAL(compare(&wall, &dot, &usual, NULL).max_m, 5);
    CU_ASSERT_EQUAL(compare(&dot, &dot, &usual, NULL).max_m, 0);

    struct space_mesh none = {4, 0, vertices_m, corners};
    CU_ASSERT_EQUAL(hausdorff_prepare(&memory, &none, &usual, &prepared, NULL), SCREE_E_ARGUMENT);
    struct space_mesh out = {4, 1, vertices_m, beyond};
    CU_ASSERT_EQUAL(hausdorff_prepare(&memory, &out, &usual, &prepared, NULL), SCREE_E_ARGUMENT);
    vertices_m[2].y = NAN;
    CU_ASSERT_EQUAL(hausdorff_prepare(&memory, &wall, &usual, &prepared, NULL), SCREE_E_ARGUMENT);
    vertices_m[2].y = INFINITY;
    CU_ASSERT_EQUAL(hausdorff_prepare(&memory, &wall, &usual, &prepared, NULL), SCREE_E_ARGUMENT);
    hausdorff_release(&memory, &prepared);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void no_memory_is_told_and_nothing_is_lost(void) {
    static struct grid grid;
    struct space_mesh mesh = make_grid(&grid, 0, 0, 0);
    for (uint64_t n = 1;; n++) {
        struct scree_memory memory = {.fail_request = n};
        struct hausdorff_surface prepared;
        enum scree_status status = hausdorff_prepare(&memory, &mesh, &usual, &prepared, NULL);
        if (status == SCREE_OK) {
            CU_ASSERT_TRUE(n > 4);
            hausdorff_release(&memory, &prepared);
            break;
        }
        CU_ASSERT_EQUAL_FATAL(status, SCREE_E_MEMORY);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
}

int suite_hausdorff(void) {
    CU_pSuite suite = CU_add_suite("distances between surfaces", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_triangle_has_a_face_edges_and_corners);
    CU_ADD_TEST(suite, parallel_planes_are_as_far_apart_as_they_are);
    CU_ADD_TEST(suite, a_shifted_plane_is_off_by_the_shift);
    CU_ADD_TEST(suite, a_spike_is_farther_from_the_plane_than_the_plane_from_it);
    CU_ADD_TEST(suite, the_index_finds_what_asking_all_triangles_finds);
    CU_ADD_TEST(suite, samples_lie_on_the_surface_where_it_is_large);
    CU_ADD_TEST(suite, a_seed_gives_the_same_points_again);
    CU_ADD_TEST(suite, degenerate_meshes_are_refused_or_measured);
    CU_ADD_TEST(suite, no_memory_is_told_and_nothing_is_lost);
    return 0;
}
