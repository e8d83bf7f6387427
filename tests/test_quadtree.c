/* Curvature of surfaces that are known, its sums, and the meshes of the quadtree: triangulations in which leaves meet,
 * of any rectangle, finer where the observer is, and the same whenever they are asked for. */
#include "lod/grid_error.h"
#include "stream/quadtree.h"
#include "tests/fractal.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 129, MOST_EDGES = 6 * SIDE * SIDE };

static float heights_m[SIDE * SIDE];

static struct curvature_posts posts_of(int32_t columns, int32_t rows) {
    return (struct curvature_posts){
        .heights_m = heights_m, .columns = columns, .rows = rows, .stride = SIDE, .east_m = 30, .north_m = 30};
}

static struct curvature_posts mountains(int32_t columns, int32_t rows) {
    const struct fractal fractal = {.seed = 7};
    fractal_window(&fractal, 1000, -300, SIDE, SIDE, heights_m, SIDE);
    return posts_of(columns, rows);
}

/* ---- curvature ---- */

static void a_plane_has_no_curvature(void) {
    float curvature[SIDE];
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) heights_m[y * SIDE + x] = (float)(100 - 3 * x + 7 * y);
    for (int32_t columns = 2; columns < 9; columns++)
        for (int32_t rows = 2; rows < 9; rows++) {
            const struct curvature_posts posts = posts_of(columns, rows);
            for (int32_t y = 0; y < rows; y++) {
                curvature_row(&posts, y, curvature);
                for (int32_t x = 0; x < columns; x++) CU_ASSERT_EQUAL(curvature[x], 0);
            }
        }
}

/* Of z = (xx x^2 + yy y^2) / 2 + xy x y, everywhere: the tensor times two posts, along each axis. */
static void a_paraboloid_has_one_curvature(void) {
    const double xx = 0.002, xy = -0.0011, yy = 0.0007, east_m = 20, north_m = 30;
    const double wanted = 2 * sqrt(east_m * east_m * (xx * xx + xy * xy) + north_m * north_m * (xy * xy + yy * yy));
    float curvature[SIDE];
    struct curvature_posts posts = posts_of(40, 23);
    posts.east_m = east_m;
    posts.north_m = north_m;
    for (int turn = 0; turn < 2; turn++) { /* as heights, and as what the ellipsoid drops */
        const double drop = turn == 0 ? 0 : 1e-3;
        posts.east_drop_m = drop * east_m * east_m;
        posts.north_drop_m = drop * north_m * north_m;
        for (int32_t y = 0; y < posts.rows; y++)
            for (int32_t x = 0; x < posts.columns; x++) {
                double e = x * east_m, n = y * north_m;
                heights_m[y * SIDE + x] =
                    (float)((xx / 2 + drop) * e * e + (yy / 2 + drop) * n * n + xy * e * n); /* metres: some 500 */
            }
        for (int32_t y = 0; y < posts.rows; y++) {
            curvature_row(&posts, y, curvature);
            for (int32_t x = 0; x < posts.columns; x++) CU_ASSERT_DOUBLE_EQUAL(curvature[x], wanted, 1e-3 * wanted);
        }
    }
}

static void a_sphere_has_that_of_its_derivatives(void) {
    const double radius_m = 6000, spacing_m = 30, middle = (SIDE - 1) / 2.0;
    float curvature[SIDE];
    const struct curvature_posts posts = posts_of(SIDE, SIDE);
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            double e = (x - middle) * spacing_m, n = (y - middle) * spacing_m;
            heights_m[y * SIDE + x] = (float)sqrt(radius_m * radius_m - e * e - n * n);
        }
    for (int32_t y = 2; y < SIDE - 2; y++) {
        curvature_row(&posts, y, curvature);
        for (int32_t x = 2; x < SIDE - 2; x++) {
            double e = (x - middle) * spacing_m, n = (y - middle) * spacing_m;
            double up = sqrt(radius_m * radius_m - e * e - n * n), cube = up * up * up;
            double xx = (radius_m * radius_m - n * n) / cube, yy = (radius_m * radius_m - e * e) / cube;
            double xy = e * n / cube, wanted = 2 * spacing_m * sqrt(xx * xx + 2 * xy * xy + yy * yy);
            CU_ASSERT_DOUBLE_EQUAL(curvature[x], wanted, 0.005 * wanted);
        }
    }
}

/* A node against its posts, one by one. */
static void check_node(const struct curvature_posts *posts, const struct curvature_pyramid *pyramid, int32_t level,
                       int32_t column, int32_t row) {
    float curvature[SIDE];
    double sum = 0, low_m = INFINITY, high_m = -INFINITY;
    int32_t west = column << level, south = row << level, east = west + (1 << level), north = south + (1 << level);
    if (east > posts->columns - 1) east = posts->columns - 1;
    if (north > posts->rows - 1) north = posts->rows - 1;
    for (int32_t y = south; y <= north; y++) {
        curvature_row(posts, y, curvature);
        for (int32_t x = west; x <= east; x++) {
            double weight = x == west || x == east ? 0.5 : 1;
            sum += curvature[x] * weight * (y == south || y == north ? 0.5 : 1);
            low_m = fmin(low_m, heights_m[y * SIDE + x]);
            high_m = fmax(high_m, heights_m[y * SIDE + x]);
        }
    }
    const struct curvature_level *nodes = &pyramid->level[level];
    const struct curvature_node *node = &nodes->nodes[row * nodes->columns + column];
    CU_ASSERT_DOUBLE_EQUAL(node->sum, sum, 1e-5 * sum);
    CU_ASSERT_EQUAL(node->low_m, low_m);
    CU_ASSERT_EQUAL(node->high_m, high_m);
}

static void nodes_hold_the_sums_of_their_posts(void) {
    const struct curvature_posts posts = mountains(77, 50);
    struct scree_memory memory = {0};
    struct curvature_pyramid pyramid;
    CU_ASSERT_EQUAL_FATAL(curvature_pyramid_make(&memory, &posts, &pyramid, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(pyramid.top, 7);
    for (int32_t level = 1; level <= pyramid.top; level++)
        for (int32_t row = 0; row < pyramid.level[level].rows; row++)
            for (int32_t column = 0; column < pyramid.level[level].columns; column++)
                check_node(&posts, &pyramid, level, column, row);
    curvature_pyramid_release(&memory, &pyramid);
    curvature_pyramid_release(&memory, &pyramid);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- meshes ---- */

static int compare_edges(const void *a, const void *b) {
    uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return left < right ? -1 : left > right ? 1 : 0;
}

/* Every edge has a triangle on either side, those of the rectangle's border excepted: no vertex stands in the middle
 * of another leaf's side. */
static bool leaves_meet(const struct scree_mesh *mesh, int32_t columns, int32_t rows) {
    static uint64_t edges[MOST_EDGES];
    const size_t count = 3 * (size_t)mesh->triangle_count;
    uint32_t alone = 0;
    CU_ASSERT_TRUE_FATAL(count <= MOST_EDGES);
    for (size_t i = 0; i < count; i++) {
        size_t next = i % 3 == 2 ? i - 2 : i + 1;
        edges[i] = (uint64_t)mesh->corners[i] << 32 | mesh->corners[next];
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++) {
        const uint64_t twin = edges[i] << 32 | edges[i] >> 32;
        const struct scree_vertex *a = &mesh->vertices[edges[i] >> 32], *b = &mesh->vertices[edges[i] & UINT32_MAX];
        bool on_border =
            (a->x == b->x && (a->x == 0 || a->x == columns - 1)) || (a->y == b->y && (a->y == 0 || a->y == rows - 1));
        bool has_twin = bsearch(&twin, edges, count, sizeof *edges, compare_edges) != NULL;
        alone += has_twin == on_border;
        alone += i > 0 && edges[i] == edges[i - 1];
    }
    return alone == 0;
}

static int32_t steepest_step(const struct quadtree *tree) {
    int32_t steepest = 0;
    for (int32_t y = 0; y < tree->posts.rows - 1; y++)
        for (int32_t x = 0; x < tree->posts.columns - 1; x++) {
            int32_t here = quadtree_leaf_level(tree, x, y);
            if (x > 0) steepest = (int32_t)fmax(steepest, abs(here - quadtree_leaf_level(tree, x - 1, y)));
            if (y > 0) steepest = (int32_t)fmax(steepest, abs(here - quadtree_leaf_level(tree, x, y - 1)));
        }
    return steepest;
}

/* Extracts and checks what holds for every mesh; returns its triangles. */
static uint32_t check_view(struct scree_memory *memory, struct quadtree *tree, const struct quadtree_view *view,
                           struct quadtree_mesh *made, struct grid_error *judged) {
    const struct curvature_posts *posts = &tree->posts;
    CU_ASSERT_EQUAL_FATAL(quadtree_extract(memory, tree, view, made, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(grid_error_measure(posts->heights_m, posts->columns, posts->rows, posts->stride, &made->mesh,
                                             NULL, memory, judged, NULL),
                          SCREE_OK);
    CU_ASSERT_TRUE(judged->covers);
    CU_ASSERT_TRUE(leaves_meet(&made->mesh, posts->columns, posts->rows));
    CU_ASSERT_TRUE(steepest_step(tree) <= 1);
    return made->mesh.triangle_count;
}

static void check_shape(int32_t columns, int32_t rows) {
    const struct curvature_posts posts = posts_of(columns, rows);
    struct scree_memory memory = {0};
    struct quadtree tree;
    struct quadtree_mesh mesh = {0};
    struct grid_error judged;
    CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &posts, &tree, NULL), SCREE_OK);
    check_view(&memory, &tree, &(struct quadtree_view){.threshold = 4}, &mesh, &judged);
    check_view(&memory, &tree,
               &(struct quadtree_view){.threshold = 4, .has_observer = true, .x = columns / 3.0, .reach_m = 200}, &mesh,
               &judged);
    uint32_t all = check_view(&memory, &tree, &(struct quadtree_view){.threshold = 0}, &mesh, &judged);
    CU_ASSERT_EQUAL(judged.max_m, 0);
    CU_ASSERT_TRUE(all <= 2 * (uint32_t)(columns - 1) * (uint32_t)(rows - 1));
    uint32_t none = check_view(&memory, &tree, &(struct quadtree_view){.threshold = 1e9}, &mesh, &judged);
    CU_ASSERT_EQUAL(none, 2);
    quadtree_mesh_release(&memory, &mesh);
    quadtree_release(&memory, &tree);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void any_rectangle_is_triangulated(void) {
    mountains(SIDE, SIDE);
    for (int32_t side = 2; side <= 70; side++) {
        check_shape(side, side);
        check_shape(side, 72 - side);
        check_shape(side, 2);
        check_shape(2, side);
    }
    check_shape(SIDE, SIDE);
    check_shape(SIDE - 1, 17);
}

static void leaves_have_little_curvature(void) {
    const struct curvature_posts posts = mountains(SIDE, 100);
    struct scree_memory memory = {0};
    struct quadtree tree;
    struct quadtree_mesh mesh = {0};
    struct grid_error judged;
    uint32_t before = UINT32_MAX, merged = 0;
    CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &posts, &tree, NULL), SCREE_OK);
    for (double threshold = 1; threshold < 100; threshold *= 2) {
        uint32_t triangles =
            check_view(&memory, &tree, &(struct quadtree_view){.threshold = threshold}, &mesh, &judged);
        CU_ASSERT_TRUE(triangles < before);
        before = triangles;
        for (int32_t y = 0; y < posts.rows - 1; y++)
            for (int32_t x = 0; x < posts.columns - 1; x++) {
                int32_t level = quadtree_leaf_level(&tree, x, y);
                if (level == 0) continue;
                const struct curvature_level *nodes = &tree.pyramid.level[level];
                CU_ASSERT_TRUE(nodes->nodes[(y >> level) * nodes->columns + (x >> level)].sum <= threshold);
                merged++;
            }
    }
    CU_ASSERT_TRUE(merged > 10000);
    quadtree_mesh_release(&memory, &mesh);
    quadtree_release(&memory, &tree);
}

/* A spike on a plain: cells around it, and leaves that grow with the distance. */
static void a_spike_is_kept(void) {
    memset(heights_m, 0, sizeof heights_m);
    heights_m[40 * SIDE + 90] = 100;
    const struct curvature_posts posts = posts_of(SIDE, SIDE);
    struct scree_memory memory = {0};
    struct quadtree tree;
    struct quadtree_mesh mesh = {0};
    struct grid_error judged;
    CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &posts, &tree, NULL), SCREE_OK);
    uint32_t triangles = check_view(&memory, &tree, &(struct quadtree_view){.threshold = 0}, &mesh, &judged);
    CU_ASSERT_EQUAL(judged.max_m, 0);
    CU_ASSERT_TRUE(triangles > 50 && triangles < 500);
    CU_ASSERT_EQUAL(quadtree_leaf_level(&tree, 90, 40), 0);
    CU_ASSERT_TRUE(quadtree_leaf_level(&tree, 10, 100) >= 5);
    quadtree_mesh_release(&memory, &mesh);
    quadtree_release(&memory, &tree);
}

/* Mean level of the cells within so many cells of a place. */
static double mean_level(const struct quadtree *tree, int32_t x, int32_t y, int32_t radius) {
    double sum = 0, count = 0;
    for (int32_t j = y - radius; j < y + radius; j++)
        for (int32_t i = x - radius; i < x + radius; i++) {
            sum += quadtree_leaf_level(tree, i, j);
            count++;
        }
    return sum / count;
}

static void near_is_finer(void) {
    const struct curvature_posts posts = mountains(SIDE, SIDE);
    struct scree_memory memory = {0};
    struct quadtree tree;
    struct quadtree_mesh mesh = {0};
    struct grid_error judged;
    CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &posts, &tree, NULL), SCREE_OK);
    struct quadtree_view view = {.threshold = 8, .has_observer = true, .x = 20, .y = 30, .reach_m = 1000};
    view.height_m = heights_m[30 * SIDE + 20];
    uint32_t low = check_view(&memory, &tree, &view, &mesh, &judged);
    CU_ASSERT_EQUAL(quadtree_leaf_level(&tree, 20, 30), 0);
    double near_first = mean_level(&tree, 20, 30, 10), near_second = mean_level(&tree, 100, 90, 10);
    CU_ASSERT_TRUE(near_first + 1 < near_second);

    view.x = 100, view.y = 90; /* and it follows */
    check_view(&memory, &tree, &view, &mesh, &judged);
    CU_ASSERT_TRUE(mean_level(&tree, 100, 90, 10) < near_second);
    CU_ASSERT_TRUE(mean_level(&tree, 20, 30, 10) > near_first);

    uint32_t before = low;
    for (double up_m = 1000; up_m < 40000; up_m *= 2) { /* from higher up, less of it */
        view.height_m = 3000 + up_m;
        uint32_t triangles = check_view(&memory, &tree, &view, &mesh, &judged);
        CU_ASSERT_TRUE(triangles < before);
        before = triangles;
    }
    view.x = -1e5; /* from the side too */
    view.height_m = 0;
    CU_ASSERT_TRUE(check_view(&memory, &tree, &view, &mesh, &judged) < 10);
    quadtree_mesh_release(&memory, &mesh);
    quadtree_release(&memory, &tree);
}

static bool is_same(const struct scree_mesh *a, const struct scree_mesh *b) {
    return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
           memcmp(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices) == 0 &&
           memcmp(a->corners, b->corners, 3 * (size_t)a->triangle_count * sizeof *a->corners) == 0;
}

static void a_mesh_depends_on_its_view_alone(void) {
    const struct curvature_posts posts = mountains(SIDE, 120);
    struct scree_memory memory = {0};
    struct quadtree trees[2];
    struct quadtree_mesh first = {0}, second = {0};
    struct grid_error judged;
    struct quadtree_view view = {.threshold = 5, .has_observer = true, .x = 64, .y = 10, .reach_m = 500};
    for (int i = 0; i < 2; i++) CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &posts, &trees[i], NULL), SCREE_OK);
    check_view(&memory, &trees[0], &view, &first, &judged);
    for (double x = 0; x < SIDE; x += 10) { /* a walk, and back */
        struct quadtree_view elsewhere = view;
        elsewhere.x = x;
        check_view(&memory, &trees[1], &elsewhere, &second, &judged);
        CU_ASSERT_FALSE(is_same(&first.mesh, &second.mesh));
    }
    check_view(&memory, &trees[1], &view, &second, &judged);
    CU_ASSERT_TRUE(is_same(&first.mesh, &second.mesh));
    quadtree_mesh_release(&memory, &first);
    quadtree_mesh_release(&memory, &second);
    for (int i = 0; i < 2; i++) quadtree_release(&memory, &trees[i]);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- failures ---- */

static void bad_arguments_are_refused(void) {
    struct scree_memory memory = {0};
    struct quadtree tree;
    const struct curvature_posts good = mountains(20, 10);
    struct curvature_posts bad[8];
    for (int i = 0; i < 8; i++) bad[i] = good;
    bad[0].columns = 1;
    bad[1].rows = 1;
    bad[2].stride = 19;
    bad[3].columns = bad[3].stride = CURVATURE_MAX_POSTS + 1;
    bad[4].east_m = 0;
    bad[5].north_m = NAN;
    bad[6].north_drop_m = INFINITY;
    bad[7].rows = -3;
    for (int i = 0; i < 8; i++) {
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(quadtree_make(&memory, &bad[i], &tree, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
    }
    struct scree_error error = {0};
    heights_m[9 * SIDE + 19] = NAN;
    CU_ASSERT_EQUAL(quadtree_make(&memory, &good, &tree, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "post 19, 9"));
    heights_m[9 * SIDE + 19] = 5;

    CU_ASSERT_EQUAL_FATAL(quadtree_make(&memory, &good, &tree, NULL), SCREE_OK);
    const struct quadtree_view views[] = {{.threshold = -1},
                                          {.threshold = NAN},
                                          {.threshold = 1e300},
                                          {.threshold = 1, .has_observer = true},
                                          {.threshold = 1, .has_observer = true, .reach_m = -1},
                                          {.threshold = 1, .has_observer = true, .reach_m = NAN},
                                          {.threshold = 1, .has_observer = true, .reach_m = 1, .x = NAN},
                                          {.threshold = 1, .has_observer = true, .reach_m = 1, .height_m = INFINITY}};
    struct quadtree_mesh mesh = {0};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        struct scree_error wrong = {0};
        CU_ASSERT_EQUAL(quadtree_extract(&memory, &tree, &views[i], &mesh, &wrong), SCREE_E_ARGUMENT);
        CU_ASSERT_NOT_EQUAL(wrong.text[0], '\0');
        CU_ASSERT_PTR_NULL(mesh.mesh.vertices);
    }
    quadtree_release(&memory, &tree);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void every_failed_request_is_survived(void) {
    const struct curvature_posts posts = mountains(SIDE, SIDE);
    const struct quadtree_view view = {.threshold = 0.5};
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct quadtree tree;
        struct quadtree_mesh mesh = {0};
        status = quadtree_make(&memory, &posts, &tree, NULL);
        if (status == SCREE_OK) {
            status = quadtree_extract(&memory, &tree, &view, &mesh, NULL);
            if (status != SCREE_OK) { /* and the tree is as good as before */
                struct grid_error judged;
                CU_ASSERT_PTR_NULL(mesh.mesh.vertices);
                CU_ASSERT_TRUE(check_view(&memory, &tree, &view, &mesh, &judged) > 1000);
            }
        }
        CU_ASSERT_TRUE(status == SCREE_OK || status == SCREE_E_MEMORY);
        quadtree_mesh_release(&memory, &mesh);
        quadtree_release(&memory, &tree);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 20);
}

int suite_quadtree(void) {
    CU_pSuite suite = CU_add_suite("restricted quadtree", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_plane_has_no_curvature);
    CU_ADD_TEST(suite, a_paraboloid_has_one_curvature);
    CU_ADD_TEST(suite, a_sphere_has_that_of_its_derivatives);
    CU_ADD_TEST(suite, nodes_hold_the_sums_of_their_posts);
    CU_ADD_TEST(suite, any_rectangle_is_triangulated);
    CU_ADD_TEST(suite, leaves_have_little_curvature);
    CU_ADD_TEST(suite, a_spike_is_kept);
    CU_ADD_TEST(suite, near_is_finer);
    CU_ADD_TEST(suite, a_mesh_depends_on_its_view_alone);
    CU_ADD_TEST(suite, bad_arguments_are_refused);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
