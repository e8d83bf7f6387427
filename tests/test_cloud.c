/* Tests of point clouds: what is done to points, their triangulation sampled at posts, and lines of text. */
#include "lod/cloud_grid.h"
#include "lod/counter_random.h"
#include "src/cloud_text.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double chance(uint64_t i) {
    return (double)(counter_random(7, i) >> 11) * 0x1p-53;
}

static void add(struct cloud *cloud, double x, double y, double z) {
    CU_ASSERT_EQUAL_FATAL(cloud_add(cloud, (struct cloud_point){x, y, z}, NULL), SCREE_OK);
}

static double plane(double x, double y) {
    return 3 * x - 2 * y + 100;
}

/* Points anywhere in a square, and its four corners. */
static void scatter(struct cloud *cloud, uint32_t count, double side, double (*height)(double x, double y)) {
    for (uint32_t i = 0; i < 4; i++) add(cloud, i % 2 * side, i / 2 * side, height(i % 2 * side, i / 2 * side));
    for (uint32_t i = 0; i < count; i++) {
        double x = side * chance(2 * i), y = side * chance(2 * i + 1);
        add(cloud, x, y, height(x, y));
    }
}

static float *sample(const struct cloud *cloud, const struct cloud_posts *posts, double longest, uint64_t *covered) {
    float *heights = malloc(sizeof *heights * (size_t)posts->columns * (size_t)posts->rows);
    CU_ASSERT_PTR_NOT_NULL_FATAL(heights);
    struct tin tin = {.memory = cloud->memory};
    CU_ASSERT_EQUAL_FATAL(tin_from_cloud(cloud, longest, &tin, NULL), SCREE_OK);
    *covered = tin_sample(&tin, posts, heights);
    tin_release(&tin);
    return heights;
}

/* A plane comes out as it is, at every post up to the border, whatever the order of the points. */
static void test_plane(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct cloud_posts posts;
    struct scree_error error = {0};
    scatter(&cloud, 5000, 80, plane);
    for (int i = 1; i < 320; i++) {
        double along = i % 80, side = i < 160 ? 0 : 80;
        if (i % 80 == 0) continue;
        add(&cloud, i / 80 % 2 ? along : side, i / 80 % 2 ? side : along,
            plane(i / 80 % 2 ? along : side, i / 80 % 2 ? side : along));
    }
    CU_ASSERT_EQUAL_FATAL(cloud_posts_choose(&cloud, 0.5, &posts, &error), SCREE_OK);
    CU_ASSERT_EQUAL(posts.columns, 161);
    CU_ASSERT_EQUAL(posts.rows, 161);
    uint64_t covered, again;
    float *heights = sample(&cloud, &posts, 1000, &covered);
    double largest = 0;
    for (int i = 0; i < 161 * 161; i++)
        largest = fmax(largest, fabs(heights[i] - plane(0.5 * (i % 161), 0.5 * (i / 161))));
    CU_ASSERT_EQUAL(covered, 161 * 161);
    CU_ASSERT_TRUE(largest < 1e-4);
    for (uint32_t i = 0; i < cloud.count / 2; i++) {
        struct cloud_point kept = cloud.points[i];
        cloud.points[i] = cloud.points[cloud.count - 1 - i];
        cloud.points[cloud.count - 1 - i] = kept;
    }
    float *turned = sample(&cloud, &posts, 1000, &again);
    CU_ASSERT_EQUAL(memcmp(heights, turned, sizeof *heights * 161 * 161), 0);
    CU_ASSERT_TRUE(memory.peak_bytes < 140 * (size_t)cloud.count + 65536);
    free(turned);
    free(heights);
    cloud_release(&cloud);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static double bowl(double x, double y) {
    return (x - 4) * (x - 4) + (y - 5) * (y - 5);
}

/* The height of a triangle at a place; infinite outside. */
static double inside(const struct cloud_point *a, const struct cloud_point *b, const struct cloud_point *c, double x,
                     double y) {
    double area = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
    double u = ((b->x - x) * (c->y - y) - (b->y - y) * (c->x - x)) / area;
    double v = ((c->x - x) * (a->y - y) - (c->y - y) * (a->x - x)) / area, w = 1 - u - v;
    return u < 0 || v < 0 || w < 0 || area == 0 ? INFINITY : u * a->z + v * b->z + w * c->z;
}

/* Of all triangles over a paraboloid those of Delaunay lie lowest: all of them are tried. */
static void test_delaunay(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct cloud_posts posts = {.west = 0.5, .south = 0.5, .spacing = 1, .columns = 10, .rows = 10};
    uint64_t covered;
    scatter(&cloud, 26, 10.5, bowl);
    float *heights = sample(&cloud, &posts, 100, &covered);
    double largest = 0;
    for (int i = 0; i < 100; i++) {
        double lowest = INFINITY, x = 0.5 + i % 10, y = 0.5 + i / 10;
        for (uint32_t a = 0; a < cloud.count; a++)
            for (uint32_t b = a + 1; b < cloud.count; b++)
                for (uint32_t c = b + 1; c < cloud.count; c++)
                    lowest = fmin(lowest, inside(&cloud.points[a], &cloud.points[b], &cloud.points[c], x, y));
        largest = fmax(largest, fabs(lowest - heights[i]));
    }
    CU_ASSERT_EQUAL(covered, 100);
    CU_ASSERT_TRUE(largest < 1e-4);
    free(heights);
    cloud_release(&cloud);
}

/* Two fields 60 apart: long triangles between them make no heights; of points in one place the lowest counts. */
static void test_long_triangles(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct cloud_posts posts;
    struct scree_error error = {0};
    for (int i = 0; i < 121; i++) {
        add(&cloud, i % 11, i / 11, 5);
        add(&cloud, 70 + i % 11, i / 11, 8);
        add(&cloud, i % 11, i / 11, 4);
    }
    CU_ASSERT_EQUAL_FATAL(cloud_posts_choose(&cloud, 1, &posts, &error), SCREE_OK);
    CU_ASSERT_EQUAL(posts.columns, 81);
    CU_ASSERT_EQUAL(posts.rows, 11);
    for (int turn = 0; turn < 2; turn++) {
        uint64_t covered;
        float *heights = sample(&cloud, &posts, turn == 0 ? 100 : 2, &covered);
        CU_ASSERT_EQUAL(covered, turn == 0 ? 81 * 11 : 22 * 11);
        for (int row = 0; row < 11; row++) {
            CU_ASSERT_EQUAL(heights[81 * row + 10], 4);
            CU_ASSERT_EQUAL(heights[81 * row + 70], 8);
            CU_ASSERT_TRUE(turn == 0 ? fabs(heights[81 * row + 40] - 6) < 1e-5 : isnan(heights[81 * row + 40]));
        }
        free(heights);
    }
    cloud_release(&cloud);
}

static void test_choose_posts(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct cloud_posts posts;
    struct scree_error error = {0};
    scatter(&cloud, 96, 1003.7, plane); /* 100 points: 100.37 apart in the mean */
    CU_ASSERT_EQUAL(cloud_posts_choose(&cloud, 0, &posts, &error), SCREE_OK);
    CU_ASSERT_EQUAL(posts.spacing, 100);
    CU_ASSERT_EQUAL(posts.columns, 11);
    for (uint32_t i = 0; i < cloud.count; i++) cloud.points[i].x += 4321;
    CU_ASSERT_EQUAL(cloud_posts_choose(&cloud, 7, &posts, &error), SCREE_OK);
    CU_ASSERT_EQUAL(posts.west, 4326); /* a multiple of 7 */
    CU_ASSERT_EQUAL(posts.south, 0);
    CU_ASSERT_EQUAL(cloud_posts_choose(&cloud, 2000, &posts, &error), SCREE_E_ARGUMENT);
    error = (struct scree_error){0};
    CU_ASSERT_EQUAL(cloud_posts_choose(&cloud, 1e-3, &posts, &error), SCREE_E_LIMIT);
    for (uint32_t i = 0; i < cloud.count; i++) cloud.points[i].x = 5;
    error = (struct scree_error){0};
    CU_ASSERT_EQUAL(cloud_posts_choose(&cloud, 1, &posts, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "one line"));
    cloud_release(&cloud);
}

/* One point a square: the one in the middle; nothing is left where nothing was. */
static void test_thin(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct scree_error error = {0};
    for (int i = 0; i < 900; i++) add(&cloud, -15 + i % 30, i / 30 + 0.25, i);
    add(&cloud, -13.5, 1.5, 7); /* the very centre of a square, twice */
    add(&cloud, -13.5, 1.5, 6);
    CU_ASSERT_EQUAL(cloud_thin(&cloud, 3, &error), SCREE_OK);
    CU_ASSERT_EQUAL(cloud.count, 100);
    int centres = 0;
    for (uint32_t i = 0; i < cloud.count; i++) {
        centres += cloud.points[i].z == 6 && cloud.points[i].x == -13.5;
        CU_ASSERT_TRUE(fabs(cloud.points[i].y / 3 - floor(cloud.points[i].y / 3) - 0.5) < 0.2);
    }
    CU_ASSERT_EQUAL(centres, 1);
    CU_ASSERT_EQUAL(cloud_thin(&cloud, 1e-12, &error), SCREE_E_ARGUMENT);
    cloud_release(&cloud);
}

static double slope(double x, double y) {
    return 0.3 * x - 0.2 * y;
}

/* A bird and a hole in a slope go; the slope stays, also where points are few. */
static void test_outliers(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct scree_error error = {0};
    scatter(&cloud, 4000, 200, slope);
    uint32_t before = cloud.count;
    add(&cloud, 50, 60, slope(50, 60) + 80);
    add(&cloud, 150, 20, slope(150, 20) - 80);
    CU_ASSERT_EQUAL(cloud_drop_outliers(&cloud, 20, &error), SCREE_OK);
    CU_ASSERT_EQUAL(cloud.count, before);
    for (uint32_t i = 0; i < cloud.count; i++)
        CU_ASSERT_TRUE(fabs(cloud.points[i].z - slope(cloud.points[i].x, cloud.points[i].y)) < 1e-9);
    cloud.count = 3;
    cloud.points[1].z = 1e6;
    CU_ASSERT_EQUAL(cloud_drop_outliers(&cloud, 1, &error), SCREE_OK);
    CU_ASSERT_EQUAL(cloud.count, 3);
    cloud.count = 0; /* all in one place */
    for (int i = 0; i < 50; i++) add(&cloud, 4, 4, i == 20 ? 99 : 0);
    CU_ASSERT_EQUAL(cloud_drop_outliers(&cloud, 1, &error), SCREE_OK);
    CU_ASSERT_EQUAL(cloud.count, 49);
    cloud_release(&cloud);
}

/* The n-th request for memory fails, for every n. */
static void test_no_memory(void) {
    uint64_t failed = 0;
    enum scree_status status = SCREE_E_MEMORY;
    for (uint64_t n = 1; status != SCREE_OK && n < 100; n++) {
        struct scree_memory memory = {.fail_request = n};
        struct cloud cloud = {.memory = &memory};
        struct scree_error error = {0};
        struct cloud_posts posts;
        float heights[441];
        struct tin tin = {.memory = &memory};
        status = SCREE_OK;
        for (int i = 0; i < 441 && status == SCREE_OK; i++)
            status = cloud_add(&cloud, (struct cloud_point){i % 21, i / 21, 0}, &error);
        if (status == SCREE_OK) status = cloud_drop_outliers(&cloud, 1, &error);
        if (status == SCREE_OK) status = cloud_thin(&cloud, 0.5, &error);
        if (status == SCREE_OK) status = cloud_posts_choose(&cloud, 1, &posts, &error);
        if (status == SCREE_OK) status = tin_from_cloud(&cloud, 9, &tin, &error);
        if (status == SCREE_OK) CU_ASSERT_EQUAL(tin_sample(&tin, &posts, heights), 441);
        failed += status == SCREE_E_MEMORY;
        tin_release(&tin);
        cloud_release(&cloud);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(failed >= 9);
}

/* ---- text ---- */

static void test_text(void) {
    static const struct {
        const char *line;
        enum scree_status status;
        bool has_point;
        double x, y, z;
    } lines[] = {
        {"1 2 3", SCREE_OK, true, 1, 2, 3},
        {"  -1.5\t2e3   3.25  9 9", SCREE_OK, true, -1.5, 2000, 3.25},
        {"1,2,3", SCREE_OK, true, 1, 2, 3},
        {"1 ; 2;3\r", SCREE_OK, true, 1, 2, 3},
        {"\xEF\xBB\xBF"
         "1 2 3",
         SCREE_OK, true, 1, 2, 3},
        {"", SCREE_OK, false, 0, 0, 0},
        {" \r", SCREE_OK, false, 0, 0, 0},
        {"# x y z", SCREE_OK, false, 0, 0, 0},
        {"//X Y Z", SCREE_OK, false, 0, 0, 0},
        {"class,Z,\"Easting\",Y", SCREE_OK, false, 0, 0, 0},
        {"1 2", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"1,,3", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"1 2 3m", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"1 nan 3", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"1 2 1e999", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"a b c", SCREE_E_CORRUPT, false, 0, 0, 0},
        {",1 2 3", SCREE_E_CORRUPT, false, 0, 0, 0},
        {"1 2 33333333333333333333333333333333333", SCREE_E_CORRUPT, false, 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        struct cloud_text text = {.name = "a.xyz"};
        struct cloud_point point = {0};
        struct scree_error error = {0};
        bool has_point;
        CU_ASSERT_EQUAL(cloud_text_take(&text, lines[i].line, &has_point, &point, &error), lines[i].status);
        CU_ASSERT_EQUAL(has_point, lines[i].has_point);
        CU_ASSERT_TRUE(point.x == lines[i].x && point.y == lines[i].y && point.z == lines[i].z);
        if (lines[i].status != SCREE_OK) CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "a.xyz: line 1"));
    }
    struct cloud_text text = {.name = "a.csv"};
    struct cloud_point point = {0};
    struct scree_error error = {0};
    bool has_point;
    CU_ASSERT_EQUAL(cloud_text_take(&text, "class,Z,\"Easting\",Y", &has_point, &point, &error), SCREE_OK);
    CU_ASSERT_EQUAL(cloud_text_take(&text, "ground,3,1,2", &has_point, &point, &error), SCREE_OK);
    CU_ASSERT_TRUE(has_point && point.x == 1 && point.y == 2 && point.z == 3);
    CU_ASSERT_EQUAL(cloud_text_take(&text, "ground,3,1", &has_point, &point, &error), SCREE_E_CORRUPT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "line 3"));
}

int suite_cloud(void) {
    CU_pSuite suite = CU_add_suite("cloud", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_plane);
    CU_ADD_TEST(suite, test_delaunay);
    CU_ADD_TEST(suite, test_long_triangles);
    CU_ADD_TEST(suite, test_choose_posts);
    CU_ADD_TEST(suite, test_thin);
    CU_ADD_TEST(suite, test_outliers);
    CU_ADD_TEST(suite, test_no_memory);
    CU_ADD_TEST(suite, test_text);
    return 0;
}
