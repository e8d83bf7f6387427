/* The constrained Delaunay triangulation: whole and Delaunay whatever comes in, constraints there to stay, and points
 * that leave only where the topology allows it. */
#include "lod/constrained.h"
#include "lod/constrained_flip.h"
#include "lod/counter_random.h"

#include <CUnit/CUnit.h>
#include <stdlib.h>

#define NONE CONSTRAINED_NONE

static uint32_t draw(uint64_t *counter, uint32_t limit) {
    return counter_random_below(17, (*counter)++, limit);
}

/* All that holds for every triangulation, by looking at each triangle: areas, neighbours, local Delaunay. */
static void check_whole(const struct constrained *c) {
    int64_t area2 = 0;
    uint32_t flat = 0, torn = 0, not_delaunay = 0;
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        const struct constrained_triangle *triangle = &c->triangles[t];
        if (triangle->corner[0] == NONE) continue;
        const struct constrained_point *a = &c->points[triangle->corner[0]], *b = &c->points[triangle->corner[1]];
        const struct constrained_point *d = &c->points[triangle->corner[2]];
        int64_t own2 = constrained_area2(*a, *b, *d);
        area2 += own2;
        flat += own2 <= 0;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t edge = 3 * t + k, twin = triangle->twin[k];
            bool fixed = constrained_is_fixed(c, edge);
            torn += c->leaving[triangle->corner[k]] == NONE;
            if (twin == NONE) {
                torn += !fixed;
                continue;
            }
            torn += constrained_twin(c, twin) != edge;
            torn += constrained_origin(c, twin) != constrained_target(c, edge);
            torn += constrained_is_fixed(c, twin) ? !fixed : fixed;
            not_delaunay += !fixed && constrained_in_circle(*a, *b, *d, c->points[constrained_apex(c, twin)]);
        }
    }
    CU_ASSERT_EQUAL(area2, 2 * (int64_t)c->width * c->height);
    CU_ASSERT_EQUAL(flat, 0);
    CU_ASSERT_EQUAL(torn, 0);
    CU_ASSERT_EQUAL(not_delaunay, 0);
    CU_ASSERT_EQUAL(c->stack_count, 0);
}

/* No point in any triangle's circle, over all of them and in 128 bits: for triangulations without constraints. */
static void check_empty_circles(const struct constrained *c) {
    uint32_t intruders = 0;
    for (uint32_t t = 0; t < c->triangle_count; t++)
        for (uint32_t i = 0; i < c->point_count; i++) {
            __extension__ __int128 x[3], y[3], square[3];
            for (int k = 0; k < 3; k++) {
                const struct constrained_point *v = &c->points[c->triangles[t].corner[k]];
                x[k] = v->x - c->points[i].x;
                y[k] = v->y - c->points[i].y;
                square[k] = x[k] * x[k] + y[k] * y[k];
            }
            intruders += x[0] * (y[1] * square[2] - square[1] * y[2]) - y[0] * (x[1] * square[2] - square[1] * x[2]) +
                             square[0] * (x[1] * y[2] - y[1] * x[2]) >
                         0;
        }
    CU_ASSERT_EQUAL(intruders, 0);
}

static void begin(struct scree_memory *memory, int32_t width, int32_t height, struct constrained *c) {
    CU_ASSERT_EQUAL_FATAL(constrained_begin(memory, width, height, c, NULL), SCREE_OK);
}

static uint32_t add(struct constrained *c, int32_t x, int32_t y) {
    uint32_t point = NONE;
    CU_ASSERT_EQUAL_FATAL(constrained_insert(c, x, y, &point, NULL), SCREE_OK);
    return point;
}

static void end(struct constrained *c, struct scree_memory *memory) {
    constrained_release(c);
    constrained_release(c);
    CU_ASSERT_EQUAL(memory->used_bytes, 0);
}

/* Sides from tiny to the largest, points anywhere and on a coarse grid, where many are on a line or a circle. */
static void points_make_a_delaunay_triangulation(void) {
    const int32_t sides[][3] = {{8, 8, 1},
                                {1000, 1000, 1},
                                {1000, 50, 50},
                                {1 << 14, 1 << 14, 1 << 10},
                                {1 << 30, 1 << 30, 1},
                                {1 << 30, 1 << 12, 1 << 6}};
    uint64_t counter = 0;
    for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
        struct scree_memory memory = {0};
        struct constrained c;
        int32_t step = sides[s][2];
        begin(&memory, sides[s][0], sides[s][1], &c);
        for (int i = 0; i < 400; i++)
            add(&c, (int32_t)draw(&counter, (uint32_t)(sides[s][0] / step) + 1) * step,
                (int32_t)draw(&counter, (uint32_t)(sides[s][1] / step) + 1) * step);
        check_whole(&c);
        check_empty_circles(&c);
        end(&c, &memory);
    }
}

static void a_point_is_found_again(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    begin(&memory, 100, 60, &c);
    CU_ASSERT_EQUAL(add(&c, 0, 0), 0);
    CU_ASSERT_EQUAL(add(&c, 100, 0), 1);
    CU_ASSERT_EQUAL(add(&c, 100, 60), 2);
    CU_ASSERT_EQUAL(add(&c, 0, 60), 3);
    uint32_t on_border = add(&c, 40, 0), inside = add(&c, 50, 30);
    add(&c, 51, 30);
    CU_ASSERT_EQUAL(add(&c, 40, 0), on_border);
    CU_ASSERT_EQUAL(add(&c, 50, 30), inside);
    CU_ASSERT_EQUAL(c.point_count, 7);
    check_whole(&c);

    uint32_t point;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(constrained_insert(&c, 101, 5, &point, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(constrained_insert(&c, 5, -1, &point, NULL), SCREE_E_ARGUMENT);
    end(&c, &memory);
    CU_ASSERT_EQUAL(constrained_begin(&memory, 0, 5, &c, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(constrained_begin(&memory, 5, (1 << 30) + 1, &c, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- constraints ---- */

/* Whether a chain of constraints leads straight from a to b; by a search through all triangles. */
static bool is_joined(const struct constrained *c, uint32_t a, uint32_t b) {
    while (a != b) {
        uint32_t next = NONE;
        for (uint32_t edge = 0; edge < 3 * c->triangle_count && next == NONE; edge++) {
            if (c->triangles[edge / 3].corner[0] == NONE || !constrained_is_fixed(c, edge)) continue;
            uint32_t from = constrained_origin(c, edge), to = constrained_target(c, edge);
            if (to == a) {
                to = from;
                from = a;
            }
            if (from != a || constrained_area2(c->points[a], c->points[b], c->points[to]) != 0) continue;
            int64_t dx = c->points[b].x - c->points[a].x, dy = c->points[b].y - c->points[a].y;
            if (dx * (c->points[to].x - c->points[a].x) + dy * (c->points[to].y - c->points[a].y) > 0) next = to;
        }
        if (next == NONE) return false;
        a = next;
    }
    return true;
}

static void constraints_come_and_stay(void) {
    enum { MANY = 60 };
    uint64_t counter = 1000;
    for (int32_t step = 1; step <= 64; step *= 64) { /* on the coarse grid constraints pass through points */
        struct scree_memory memory = {0};
        struct constrained c;
        uint32_t ends[MANY][2], fixed = 0, refused = 0;
        uint32_t posts = (uint32_t)(1024 / step) + 1;
        begin(&memory, 1024, 1024, &c);
        for (int i = 0; i < 300; i++)
            add(&c, (int32_t)draw(&counter, posts) * step, (int32_t)draw(&counter, posts) * step);
        for (int i = 0; i < 4 * MANY && fixed < MANY; i++) {
            uint32_t a = draw(&counter, c.point_count), b = draw(&counter, c.point_count);
            if (a == b) continue;
            struct scree_error error = {0};
            if (constrained_fix(&c, a, b, &error) == SCREE_OK) {
                ends[fixed][0] = a;
                ends[fixed++][1] = b;
            } else {
                CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
                refused++;
            }
        }
        for (int i = 0; i < 300; i++) add(&c, (int32_t)draw(&counter, 1025), (int32_t)draw(&counter, 1025));
        CU_ASSERT_TRUE(fixed > 10 && refused > 10);
        for (uint32_t i = 0; i < fixed; i++) CU_ASSERT_TRUE(is_joined(&c, ends[i][0], ends[i][1]));
        check_whole(&c);
        end(&c, &memory);
    }
}

static void a_crossing_is_refused(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    begin(&memory, 100, 100, &c);
    uint32_t west = add(&c, 10, 50), east = add(&c, 90, 50), south = add(&c, 50, 10), north = add(&c, 50, 90);
    CU_ASSERT_EQUAL(constrained_fix(&c, west, east, NULL), SCREE_OK);
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(constrained_fix(&c, south, north, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_FALSE(is_joined(&c, south, north));
    check_whole(&c);

    /* A point on the constraint splits it, and then the other one may pass. */
    uint32_t middle = add(&c, 50, 50);
    CU_ASSERT_TRUE(is_joined(&c, west, middle) && is_joined(&c, middle, east) && is_joined(&c, west, east));
    CU_ASSERT_EQUAL(constrained_fix(&c, south, north, NULL), SCREE_OK);
    CU_ASSERT_TRUE(is_joined(&c, south, middle) && is_joined(&c, middle, north));
    check_whole(&c);
    end(&c, &memory);
}

/* ---- points leave ---- */

/* A bend a-p-b with another point somewhere: may p go? */
static bool bend_goes(int32_t other_x, int32_t other_y, bool closed) {
    struct scree_memory memory = {0};
    struct constrained c;
    begin(&memory, 100, 100, &c);
    uint32_t a = add(&c, 20, 20), p = add(&c, 50, 60), b = add(&c, 80, 20);
    uint32_t other = add(&c, other_x, other_y);
    constrained_fix(&c, a, p, NULL);
    constrained_fix(&c, p, b, NULL);
    if (closed) constrained_fix(&c, a, b, NULL);
    bool gone = constrained_shortcut(&c, p);
    CU_ASSERT_EQUAL(is_joined(&c, a, b), gone || closed);
    CU_ASSERT_EQUAL(c.leaving[p] == NONE, gone);
    CU_ASSERT_TRUE(c.leaving[other] != NONE);
    check_whole(&c);
    end(&c, &memory);
    return gone;
}

static void a_point_leaves_where_the_topology_stays(void) {
    CU_ASSERT_TRUE(bend_goes(50, 80, false));
    CU_ASSERT_TRUE(bend_goes(50, 10, false));
    CU_ASSERT_TRUE(bend_goes(95, 20, false));  /* beyond the end, on the same line */
    CU_ASSERT_FALSE(bend_goes(50, 40, false)); /* would change sides */
    CU_ASSERT_FALSE(bend_goes(50, 20, false)); /* would be touched */
    CU_ASSERT_TRUE(bend_goes(50, 19, false));
    CU_ASSERT_FALSE(bend_goes(50, 10, true)); /* two constraints would fall into one */
}

static void only_bends_leave(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    begin(&memory, 100, 100, &c);
    uint32_t a = add(&c, 20, 50), p = add(&c, 50, 50), b = add(&c, 80, 50), branch = add(&c, 50, 80);
    uint32_t on_border = add(&c, 50, 0);
    CU_ASSERT_FALSE(constrained_shortcut(&c, p)); /* no line */
    constrained_fix(&c, a, p, NULL);
    CU_ASSERT_FALSE(constrained_shortcut(&c, p)); /* an end */
    constrained_fix(&c, a, b, NULL);
    constrained_fix(&c, p, branch, NULL);
    CU_ASSERT_FALSE(constrained_shortcut(&c, p)); /* a branching */
    CU_ASSERT_FALSE(constrained_shortcut(&c, on_border));
    CU_ASSERT_FALSE(constrained_shortcut(&c, 0));
    CU_ASSERT_FALSE(constrained_shortcut(&c, 99));
    check_whole(&c);
    end(&c, &memory);
}

/* Of a straight line all inner points go; the points of a grid around it stay. */
static void a_straight_line_loses_its_points(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    uint32_t line[17];
    begin(&memory, 160, 160, &c);
    for (int32_t i = 0; i < 17; i++) {
        line[i] = add(&c, 10 * i, 80);
        add(&c, 10 * i, 70);
        add(&c, 10 * i, 90);
    }
    for (int i = 2; i < 16; i++) CU_ASSERT_EQUAL(constrained_fix(&c, line[i - 1], line[i], NULL), SCREE_OK);
    for (int i = 2; i < 15; i++) CU_ASSERT_TRUE(constrained_shortcut(&c, line[i]));
    CU_ASSERT_FALSE(constrained_shortcut(&c, line[5])); /* it has left already */
    CU_ASSERT_TRUE(is_joined(&c, line[1], line[15]));
    check_whole(&c);
    end(&c, &memory);
}

/* Lines at random, shortened at random: whole, Delaunay, and every slot is used again. */
static void many_leave_and_all_stays_whole(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    uint64_t counter = 5000;
    uint32_t gone = 0;
    begin(&memory, 4096, 4096, &c);
    for (int i = 0; i < 3000; i++) add(&c, (int32_t)draw(&counter, 129) * 32, (int32_t)draw(&counter, 129) * 32);
    for (int i = 0; i < 100; i++) {
        uint32_t at = draw(&counter, c.point_count);
        for (int k = 0; k < 4000; k++) {
            uint32_t to = draw(&counter, c.point_count);
            int32_t way = abs(c.points[at].x - c.points[to].x) + abs(c.points[at].y - c.points[to].y);
            if (way > 0 && way < 256 && constrained_fix(&c, at, to, NULL) == SCREE_OK) at = to;
        }
    }
    check_whole(&c);
    for (int round = 0; round < 3; round++)
        for (uint32_t i = 0; i < c.point_count; i++) gone += constrained_shortcut(&c, i);
    CU_ASSERT_TRUE(gone > 50);
    check_whole(&c);
    uint32_t triangles = c.triangle_count;
    for (uint32_t i = 0; i < gone; i++) add(&c, (int32_t)draw(&counter, 4095) + 1, (int32_t)draw(&counter, 4095) + 1);
    CU_ASSERT_TRUE(c.triangle_count <= triangles + 4);
    check_whole(&c);
    end(&c, &memory);
}

static void distances_to_constraints(void) {
    struct scree_memory memory = {0};
    struct constrained c;
    begin(&memory, 100, 100, &c);
    uint32_t a = add(&c, 20, 50), b = add(&c, 80, 50);
    constrained_fix(&c, a, b, NULL);
    CU_ASSERT_FALSE(constrained_is_clear(&c, 50, 59, 10));
    CU_ASSERT_TRUE(constrained_is_clear(&c, 50, 60, 10));
    CU_ASSERT_FALSE(constrained_is_clear(&c, 4, 50, 5)); /* the border */
    CU_ASSERT_TRUE(constrained_is_clear(&c, 5, 50, 5));
    end(&c, &memory);
}

static enum scree_status make_some(struct scree_memory *memory, struct constrained *c) {
    uint64_t counter = 0;
    uint32_t point;
    enum scree_status status = constrained_begin(memory, 1000, 1000, c, NULL);
    for (int i = 0; i < 600 && status == SCREE_OK; i++)
        status = constrained_insert(c, (int32_t)draw(&counter, 1001), (int32_t)draw(&counter, 1001), &point, NULL);
    return status == SCREE_OK ? constrained_fix(c, 0, 2, NULL) : status;
}

static void every_failed_request_is_survived(void) {
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 50) {
        struct scree_memory memory = {.fail_request = ++request};
        struct constrained c;
        status = make_some(&memory, &c);
        CU_ASSERT_TRUE(status == SCREE_OK || status == SCREE_E_MEMORY);
        if (c.memory != NULL) check_whole(&c);
        end(&c, &memory);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 9); /* the arrays have grown, and a constraint had edges in its way */
}

int suite_constrained(void) {
    CU_pSuite suite = CU_add_suite("constrained Delaunay triangulation", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, points_make_a_delaunay_triangulation);
    CU_ADD_TEST(suite, a_point_is_found_again);
    CU_ADD_TEST(suite, constraints_come_and_stay);
    CU_ADD_TEST(suite, a_crossing_is_refused);
    CU_ADD_TEST(suite, a_point_leaves_where_the_topology_stays);
    CU_ADD_TEST(suite, only_bends_leave);
    CU_ADD_TEST(suite, a_straight_line_loses_its_points);
    CU_ADD_TEST(suite, many_leave_and_all_stays_whole);
    CU_ADD_TEST(suite, distances_to_constraints);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
