/* Tests of TINs: made of clouds, and mended: what can be put right is, what is no surface over the plane is refused
 * with the place. Whether triangles lie one above the other is tried against all pairs of them. */
#include "lod/counter_random.h"
#include "lod/tin.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t chance(uint64_t *counter, uint64_t below) {
    return counter_random(11, (*counter)++) % below;
}

/* Room for one more: twice as much whenever the count is a power of two. */
static void *grow(struct tin *tin, void *block, uint32_t count, size_t size_bytes) {
    if (count != 0 && (count & (count - 1)) != 0) return block;
    void *grown = scree_reallocate(tin->memory, block, count == 0 ? 1 : 2 * (size_t)count, size_bytes, "", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(grown);
    return grown;
}

static uint32_t add_point(struct tin *tin, double x, double y, double z) {
    tin->points = grow(tin, tin->points, tin->point_count, sizeof *tin->points);
    tin->points[tin->point_count] = (struct cloud_point){x, y, z};
    return tin->point_count++;
}

static void add_triangle(struct tin *tin, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corners[3] = {a, b, c};
    tin->corners = grow(tin, tin->corners, tin->triangle_count, sizeof corners);
    memcpy(&tin->corners[3 * (size_t)tin->triangle_count++], corners, sizeof corners);
}

static double plan_area2(const struct tin *tin, size_t triangle) {
    const struct cloud_point *p[3];
    for (size_t k = 0; k < 3; k++) p[k] = &tin->points[tin->corners[3 * triangle + k]];
    return (p[1]->x - p[0]->x) * (p[2]->y - p[0]->y) - (p[1]->y - p[0]->y) * (p[2]->x - p[0]->x);
}

static double area_of(const struct tin *tin) {
    double area = 0;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        CU_ASSERT_TRUE(plan_area2(tin, t) > 0);
        area += plan_area2(tin, t) / 2;
    }
    return area;
}

/* ---- clouds ---- */

/* Every triangle's circle is empty of points, none is turned over, and together they cover the hull, which is the
 * square: a triangulation is Delaunay's when that holds. */
static void test_cloud(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct tin tin = {.memory = &memory};
    struct tin_mended mended;
    struct scree_error error = {0};
    uint64_t counter = 0;
    for (int i = 0; i < 300; i++) {
        const struct cloud_point point = {i < 4 ? i % 2 * 100 : 0.001 * (double)chance(&counter, 100000),
                                          i < 4 ? i / 2 * 100 : 0.001 * (double)chance(&counter, 100000), i};
        CU_ASSERT_EQUAL_FATAL(cloud_add(&cloud, point, &error), SCREE_OK);
        const struct cloud_point above = {point.x, point.y, i + 1};
        if (i % 3 == 0) CU_ASSERT_EQUAL_FATAL(cloud_add(&cloud, above, &error), SCREE_OK);
    }
    CU_ASSERT_EQUAL_FATAL(tin_from_cloud(&cloud, 1000, &tin, &error), SCREE_OK);
    CU_ASSERT_EQUAL(tin.point_count, 300);
    CU_ASSERT_DOUBLE_EQUAL(area_of(&tin), 100 * 100, 100 * 100 * 0.005);
    for (uint32_t i = 0; i < tin.point_count; i++) CU_ASSERT_TRUE(tin.points[i].z == floor(tin.points[i].z));
    for (size_t t = 0; t < tin.triangle_count; t++)
        for (uint32_t i = 0; i < tin.point_count; i++) {
            double row[3][3];
            for (size_t k = 0; k < 3; k++) {
                const struct cloud_point *p = &tin.points[tin.corners[3 * t + k]];
                row[k][0] = p->x - tin.points[i].x;
                row[k][1] = p->y - tin.points[i].y;
                row[k][2] = row[k][0] * row[k][0] + row[k][1] * row[k][1];
            }
            CU_ASSERT_TRUE(row[0][0] * (row[1][1] * row[2][2] - row[1][2] * row[2][1]) -
                               row[0][1] * (row[1][0] * row[2][2] - row[1][2] * row[2][0]) +
                               row[0][2] * (row[1][0] * row[2][1] - row[1][1] * row[2][0]) <
                           1);
        }
    const uint32_t triangles = tin.triangle_count;
    CU_ASSERT_EQUAL(tin_mend(&tin, &mended, &error), SCREE_OK);
    CU_ASSERT_EQUAL(mended.welded + mended.dropped + mended.turned + mended.unused, 0);
    CU_ASSERT_EQUAL(tin.triangle_count, triangles);
    tin_release(&tin);
    CU_ASSERT_EQUAL(tin_from_cloud(&cloud, 12, &tin, &error), SCREE_OK);
    CU_ASSERT_TRUE(tin.triangle_count < triangles && tin.point_count > 200);
    for (size_t t = 0; t < tin.triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            const struct cloud_point *a = &tin.points[tin.corners[3 * t + k]];
            const struct cloud_point *b = &tin.points[tin.corners[3 * t + (k + 1) % 3]];
            CU_ASSERT_TRUE(hypot(a->x - b->x, a->y - b->y) <= 12);
        }
    tin_release(&tin);
    CU_ASSERT_EQUAL(tin_from_cloud(&cloud, 1e-3, &tin, &error), SCREE_E_CORRUPT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "--max-edge"));
    cloud_release(&cloud);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* Points on one line, and none at all. */
static void test_no_surface(void) {
    struct scree_memory memory = {0};
    struct cloud cloud = {.memory = &memory};
    struct tin tin = {.memory = &memory};
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(tin_from_cloud(&cloud, 10, &tin, &error), SCREE_E_CORRUPT);
    for (int i = 0; i < 5; i++) cloud_add(&cloud, (struct cloud_point){i, 2 * i, i * i}, &error);
    error = (struct scree_error){0};
    CU_ASSERT_EQUAL(tin_from_cloud(&cloud, 10, &tin, &error), SCREE_E_CORRUPT);
    tin_release(&tin);
    cloud_release(&cloud);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- what is put right ---- */

static double wave(int x, int y) {
    return 5 * sin(0.7 * x) * cos(0.4 * y);
}

/* A square of 2 * side^2 triangles, each with points of its own, turned and rotated by chance, in any order; every
 * tenth is there twice, and there are lines and points that nobody uses. */
static void scramble(struct tin *tin, int side, uint32_t *copies) {
    uint64_t counter = 5;
    uint32_t order[2 * 40 * 40], count = 2 * (uint32_t)(side * side);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = (uint32_t)chance(&counter, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
    *copies = 0;
    for (uint32_t i = 0; i < count; i++) {
        const int x = (int)(order[i] / 2) % side, y = (int)(order[i] / 2) / side;
        const int places[2][3][2] = {{{x, y}, {x + 1, y}, {x + 1, y + 1}}, {{x, y}, {x + 1, y + 1}, {x, y + 1}}};
        for (int copy = 0; copy <= (i % 10 == 0); copy++) {
            const uint64_t turned = chance(&counter, 2), first = chance(&counter, 3);
            uint32_t corners[3];
            for (uint64_t k = 0; k < 3; k++) {
                const int *place = places[order[i] % 2][(first + (turned ? 3 - k : k)) % 3];
                corners[k] =
                    add_point(tin, 500000.1 + 0.1 * place[0], 4000000.3 + 0.1 * place[1], wave(place[0], place[1]));
            }
            add_triangle(tin, corners[0], corners[1], corners[2]);
            *copies += copy == 1;
        }
    }
    add_triangle(tin, 0, 1, 1);
    add_point(tin, 500000.1, 4000000.3 - 7, 3);
}

static void test_scrambled(void) {
    const int side = 40;
    struct scree_memory memory = {0};
    struct tin tin = {.memory = &memory};
    struct tin_mended mended;
    struct scree_error error = {0};
    uint32_t copies;
    scramble(&tin, side, &copies);
    const uint32_t points = tin.point_count;
    if (tin_mend(&tin, &mended, &error) != SCREE_OK) CU_FAIL(error.text);
    CU_ASSERT_EQUAL(tin.point_count, (side + 1) * (side + 1));
    CU_ASSERT_EQUAL(tin.triangle_count, 2 * side * side);
    CU_ASSERT_EQUAL(mended.dropped, copies + 1);
    CU_ASSERT_EQUAL(mended.welded, points - 1 - tin.point_count);
    CU_ASSERT_EQUAL(mended.unused, 1);
    CU_ASSERT_TRUE(mended.turned > 1000 && mended.turned < 2500);
    CU_ASSERT_DOUBLE_EQUAL(area_of(&tin), 0.01 * side * side, 1e-6);
    tin_release(&tin);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* Meshes by hand: points, then triangles by letters. */
struct drawn {
    const char *what;
    double points[12][3];
    int point_count;
    const char *triangles; /* "abc bcd" */
    const char *word;      /* of the refusal; NULL: it is fine */
    uint32_t left;         /* triangles */
};

static const struct drawn drawns[] = {
    {"one triangle", {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}}, 3, "abc", NULL, 1},
    {"upside down", {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}, {4, 4, 2}}, 4, "acb cdb", NULL, 2},
    {"two that touch at a point", {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}, {-3, 0, 0}, {0, -3, 2}}, 5, "abc ade", NULL, 2},
    {"two apart", {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}, {5, 5, 0}, {9, 5, 0}, {5, 9, 1}}, 6, "abc def", NULL, 2},
    {"heights that are almost one",
     {{0, 0, 0}, {4, 0, 0}, {0, 4, 100}, {0, 4, 100.00000005}, {4, 0, 1e-8}, {4, 4, 7}},
     6,
     "abc efd",
     NULL,
     2},
    {"a hole",
     {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {3, 3, 1}, {6, 3, 1}, {6, 6, 1}, {3, 6, 1}},
     8,
     "abf afe bcg bgf cdh chg dae deh",
     NULL,
     8},
    {"a point on a neighbour's edge",
     {{0, 0, 0}, {4, 0, 0}, {2, 4, 0}, {2, 0, 0}, {0, -4, 0}, {4, -4, 0}},
     6,
     "abc adf bed",
     "one above the other",
     0},
    {"edges that halve each other",
     {{0, 0, 0}, {4, 0, 0}, {2, 4, 0}, {2, 0, 0}, {2, -4, 1}},
     5,
     "abc aed deb",
     NULL,
     3},
    {"a line and a needle", {{0, 0, 0}, {4, 0, 0}, {2, 4, 0}, {2, 0, 0}, {2, 1e-12, 0}}, 5, "abc abd abe", NULL, 1},
    {"a wall",
     {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 4, 0}},
     4,
     "abd abc",
     "vertical face at 2.666666667 0, from "
     "height 0 to 3",
     0},
    {"a wall whose corners lie nowhere above each other",
     {{0, 0, 0}, {4, 0, 0}, {1, 0, 3}},
     3,
     "abc",
     "vertical face at",
     0},
    {"a fin",
     {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {1, 3, 5}},
     5,
     "abc adb abe",
     "3 triangles share the edge from 0 0 0 to 4 0 0",
     0},
    {"a book", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 4, 5}, {0, 4, 9}}, 5, "abc abd abe", "3 triangles share", 0},
    {"a fold", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 3, 5}}, 4, "abc abd", "overhang along the edge from 0 0 0", 0},
    {"one turned against its neighbours",
     {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {3, 2, 1}},
     5,
     "abe bce cde dae "
     "ace",
     "",
     0},
    {"a roof",
     {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}, {0, 0, 3}, {4, 0, 3}, {0, 4, 4}},
     6,
     "abc def",
     "one above the other at",
     0},
    {"a roof with more triangles",
     {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}, {0, 0, 3}, {4, 0, 3}, {0, 4, 4}, {1, 1, 5}},
     7,
     "abc deg efg fdg",
     "one above the other at",
     0},
    {"a deck",
     {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {4, -3, 8}, {5, -3, 8}, {5, 12, 8}, {4, 12, 8}},
     8,
     "abc acd efg egh",
     "one above the other at",
     0},
    {"a bird over a field",
     {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {2, 2, 50}, {3, 2, 50}, {2, 3, 50}},
     6,
     "abc def",
     "at heights 0 and 50",
     0},
    {"no number", {{0, 0, 0}, {9, 0, 0}, {0, NAN, 0}}, 3, "abc", "no position", 0},
    {"no height", {{0, 0, 0}, {9, 0, 0}, {0, 9, -INFINITY}}, 3, "abc", "no position", 0},
    {"far away", {{0, 0, 0}, {9, 0, 0}, {0, 9e18, 0}}, 3, "abc", "no position", 0},
    {"no point", {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, 3, "abd", "corner at point 3 of 3", 0},
    {"nothing but lines", {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, 3, "aab bbb", "no triangle", 0},
    {"nothing", {{0, 0, 0}}, 0, "", "no points", 0},
};

static void draw(const struct drawn *drawn, struct tin *tin) {
    for (int i = 0; i < drawn->point_count; i++)
        add_point(tin, drawn->points[i][0], drawn->points[i][1], drawn->points[i][2]);
    for (const char *at = drawn->triangles; *at != '\0'; at += at[3] == ' ' ? 4 : 3)
        add_triangle(tin, (uint32_t)(at[0] - 'a'), (uint32_t)(at[1] - 'a'), (uint32_t)(at[2] - 'a'));
}

static void test_drawn(void) {
    for (size_t i = 0; i < sizeof drawns / sizeof *drawns; i++) {
        const struct drawn *drawn = &drawns[i];
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        draw(drawn, &tin);
        const enum scree_status status = tin_mend(&tin, &mended, &error);
        const bool is_right = drawn->word == NULL ? status == SCREE_OK && tin.triangle_count == drawn->left
                                                  : status == SCREE_E_CORRUPT && strstr(error.text, drawn->word);
        if (!is_right) {
            printf("\n%s: %s, %u left\n", drawn->what, error.text, (unsigned)tin.triangle_count);
            CU_FAIL("");
        }
        tin_release(&tin);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
}

/* Parts that meet along a border on which each has points of its own, rounded to millimetres: fine however they lie. */
static void test_borders(void) {
    for (int turn = 0; turn < 90; turn++) {
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        const double angle = 0.1 + turn * 0.07, c = cos(angle), s = sin(angle);
        for (int part = 0; part < 2; part++) {
            const int pieces = part == 0 ? 7 : 5;
            uint32_t points[2][8];
            for (int i = 0; i <= pieces; i++)
                for (int row = 0; row < 2; row++) {
                    const double x = 1000.0 * i / pieces, y = row * (part == 0 ? 300 : -300);
                    points[row][i] = add_point(&tin, nearbyint((500000 + c * x - s * y) * 1000) / 1000,
                                               nearbyint((4000000 + s * x + c * y) * 1000) / 1000, 10 + row);
                }
            for (int i = 0; i < pieces; i++) {
                add_triangle(&tin, points[0][i], points[0][i + 1], points[1][i]);
                add_triangle(&tin, points[0][i + 1], points[1][i + 1], points[1][i]);
            }
        }
        if (tin_mend(&tin, &mended, &error) != SCREE_OK) CU_FAIL(error.text);
        CU_ASSERT_EQUAL(tin.triangle_count, 24);
        CU_ASSERT_EQUAL(mended.welded, 2);
        tin_release(&tin);
    }
}

/* A triangulated cloud whose points are turned and then rounded, some of them on lines close together: slivers that
 * this turns over or makes flat are no reason to refuse it. */
static void test_rounded(void) {
    uint32_t dropped = 0;
    for (int turn = 0; turn < 8; turn++) {
        struct scree_memory memory = {0};
        struct cloud cloud = {.memory = &memory};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        uint64_t counter = (uint64_t)turn * 10000;
        for (int i = 0; i < 3000; i++) {
            const double x = 0.05 * i / 5, y = 10 * (i % 5) + 0.5 * x + 1e-6 * (double)chance(&counter, 400);
            const struct cloud_point point = {x, y, 0.1 * y + sin(x)};
            CU_ASSERT_EQUAL_FATAL(cloud_add(&cloud, point, &error), SCREE_OK);
        }
        CU_ASSERT_EQUAL_FATAL(tin_from_cloud(&cloud, 1000, &tin, &error), SCREE_OK);
        const double area = area_of(&tin), c = cos(0.2 + turn), s = sin(0.2 + turn);
        for (uint32_t i = 0; i < tin.point_count; i++) {
            const struct cloud_point was = tin.points[i];
            tin.points[i].x = nearbyint((500000 + c * was.x - s * was.y) * 1000) / 1000;
            tin.points[i].y = nearbyint((4000000 + s * was.x + c * was.y) * 1000) / 1000;
        }
        const enum scree_status status = tin_mend(&tin, &mended, &error);
        if (status != SCREE_OK) printf("\n%s\n", error.text);
        CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
        CU_ASSERT_DOUBLE_EQUAL(area_of(&tin), area, 1);
        dropped += mended.dropped;
        CU_ASSERT_EQUAL(mended.turned, 0);
        tin_release(&tin);
        cloud_release(&cloud);
    }
    CU_ASSERT_TRUE(dropped > 1000);
}

/* A ramp that winds around twice: no edge of it crosses another one's triangle but at its ends. */
static void test_ramp(void) {
    for (int steps = 8; steps <= 17; steps++) {
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        for (int i = 0; i <= steps; i++) {
            const double angle = i * 2 * 3.14159265358979 / 8;
            add_point(&tin, cos(angle), sin(angle), 0.1 * i);
            add_point(&tin, 2 * cos(angle), 2 * sin(angle), 0.1 * i);
        }
        for (uint32_t i = 0; i < (uint32_t)steps; i++) {
            add_triangle(&tin, 2 * i, 2 * i + 1, 2 * i + 3);
            add_triangle(&tin, 2 * i, 2 * i + 3, 2 * i + 2);
        }
        const enum scree_status status = tin_mend(&tin, &mended, &error);
        CU_ASSERT_EQUAL(status, steps == 8 ? SCREE_OK : SCREE_E_CORRUPT);
        tin_release(&tin);
    }
}

/* Long thin triangles side by side, every one's box over half of all edges: they are told apart all the same. A search
 * by boxes alone takes minutes. */
static void test_long_triangles(void) {
    struct scree_memory memory = {0};
    struct tin tin = {.memory = &memory};
    struct tin_mended mended;
    struct scree_error error = {0};
    const uint32_t count = 20000;
    for (uint32_t i = 0; i <= count; i++) {
        add_point(&tin, i * 0.1, 0, 0);
        add_point(&tin, i * 0.1 + 6000, 6000, 1);
    }
    for (uint32_t i = 0; i < 2 * count; i += 2) {
        add_triangle(&tin, i, i + 2, i + 3);
        add_triangle(&tin, i, i + 3, i + 1);
    }
    if (tin_mend(&tin, &mended, &error) != SCREE_OK) CU_FAIL(error.text);
    CU_ASSERT_EQUAL(tin.triangle_count, 2 * count);
    tin_release(&tin);
}

/* ---- all pairs ---- */

/* Twice the area of whole coordinates. */
static int64_t whole_area2(const int *a, const int *b, const int *c) {
    return (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether two triangles with area, corners counter-clockwise, share some area: no edge's line parts them. */
static bool share_area(int first[3][2], int second[3][2]) {
    for (int turn = 0; turn < 2; turn++) {
        int(*a)[2] = turn == 0 ? first : second, (*b)[2] = turn == 0 ? second : first;
        for (int k = 0; k < 3; k++) {
            int outside = 0;
            for (int i = 0; i < 3; i++) outside += whole_area2(a[k], a[(k + 1) % 3], b[i]) <= 0;
            if (outside == 3) return false;
        }
    }
    return true;
}

/* Of three points on a line in plan: is one above another, or higher above the line between the others than a quarter
 * of its length? */
static bool is_wall(const struct cloud_point *a, const struct cloud_point *b, const struct cloud_point *c) {
    const struct cloud_point *p[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        const struct cloud_point *from = p[k], *to = p[(k + 1) % 3], *third = p[(k + 2) % 3];
        const double length = hypot(to->x - from->x, to->y - from->y);
        const double at = hypot(third->x - from->x, third->y - from->y);
        if (length < 1e-9) return at > 1e-9 && from->z != to->z;
        const bool is_between = at <= length && hypot(third->x - to->x, third->y - to->y) <= length;
        if (is_between && fabs(third->z - from->z - at / length * (to->z - from->z)) > length / 4) return true;
    }
    return false;
}

/* A few triangles between a few points, somewhere: refused exactly when a pair of them shares area, or one is a wall.
 */
static void test_all_pairs(void) {
    uint64_t counter = 100;
    int fine = 0, refused = 0;
    for (int round = 0; round < 40000; round++) {
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        int places[8][2], heights[8], count = 0, kept[6][3], corners[6][3][2];
        const int width = 3 + round % 7, triangles = 2 + round / 7 % 4;
        const double unit = round % 2 == 0 && width <= 3 ? 1 : 0.123456; /* of which rounding is seen, or it is not */
        bool is_bad = false;
        for (int i = 0; i < 8; i++) {
            places[i][0] = (int)chance(&counter, (uint64_t)width);
            places[i][1] = (int)chance(&counter, (uint64_t)width);
            heights[i] = (int)chance(&counter, 2);
            add_point(&tin, places[i][0] * unit + 3000, places[i][1] * unit - 2000, heights[i]);
        }
        for (int t = 0; t < triangles; t++) {
            int p[3];
            for (int k = 0; k < 3; k++) p[k] = (int)chance(&counter, 8);
            add_triangle(&tin, (uint32_t)p[0], (uint32_t)p[1], (uint32_t)p[2]);
            const int64_t area2 = whole_area2(places[p[0]], places[p[1]], places[p[2]]);
            if (area2 == 0) {
                is_bad |= is_wall(&tin.points[p[0]], &tin.points[p[1]], &tin.points[p[2]]);
                continue;
            }
            if (area2 < 0) {
                const int held = p[1];
                p[1] = p[2];
                p[2] = held;
            }
            for (int k = 0; k < 3; k++) memcpy(corners[count][k], places[p[k]], sizeof places[0]);
            memcpy(kept[count], p, sizeof p);
            bool is_copy = false;
            for (int other = 0; other < count; other++)
                for (int shift = 0; shift < 3; shift++) {
                    int same = 0;
                    for (int k = 0; k < 3; k++) {
                        const int a = p[k], b = kept[other][(k + shift) % 3];
                        same +=
                            places[a][0] == places[b][0] && places[a][1] == places[b][1] && heights[a] == heights[b];
                    }
                    is_copy |= same == 3;
                }
            for (int other = 0; other < count && !is_copy; other++)
                is_bad |= share_area(corners[count], corners[other]);
            if (!is_copy) count++;
        }
        const enum scree_status status = tin_mend(&tin, &mended, &error);
        if (count == 0) is_bad = true;
        CU_ASSERT_EQUAL(status, is_bad ? SCREE_E_CORRUPT : SCREE_OK);
        if (status == SCREE_OK) CU_ASSERT_EQUAL(tin.triangle_count, count);
        fine += !is_bad;
        refused += is_bad;
        tin_release(&tin);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_TRUE(fine > 3000 && refused > 3000);
}

static void test_no_memory(void) {
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t n = 1;
    for (; status == SCREE_E_MEMORY && n < 50; n++) {
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct tin_mended mended;
        struct scree_error error = {0};
        draw(&drawns[5], &tin);
        memory.fail_request = memory.requests + n;
        status = tin_mend(&tin, &mended, &error);
        tin_release(&tin);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(n > 8);
}

int suite_tin(void) {
    CU_pSuite suite = CU_add_suite("tin", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_cloud);
    CU_ADD_TEST(suite, test_no_surface);
    CU_ADD_TEST(suite, test_scrambled);
    CU_ADD_TEST(suite, test_drawn);
    CU_ADD_TEST(suite, test_borders);
    CU_ADD_TEST(suite, test_rounded);
    CU_ADD_TEST(suite, test_ramp);
    CU_ADD_TEST(suite, test_long_triangles);
    CU_ADD_TEST(suite, test_all_pairs);
    CU_ADD_TEST(suite, test_no_memory);
    return 0;
}
