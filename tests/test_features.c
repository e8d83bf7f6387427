/* Feature lines: found where two planes make a sharp angle, traced through what belongs together, and nowhere else. */
#include "lod/features.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 16, POSTS = CELLS + 1 };

/* A tile of 30 m a cell with given heights, and the lines that are found in it. */
struct found {
    struct scree_memory memory;
    struct made_method_tile *made;
    struct feature_lines lines;
};

static struct found find(const float *heights_m, int32_t columns, int32_t rows, double border_tolerance_m,
                         struct feature_options options) {
    struct found found = {0};
    found.made = made_method_tile_new(&(struct method_recipe){
        .columns = columns, .rows = rows, .border_tolerance_m = border_tolerance_m, .given_heights_m = heights_m});
    CU_ASSERT_EQUAL_FATAL(features_find(&found.memory, &found.made->tile, &options, &found.lines, NULL), SCREE_OK);
    return found;
}

static void release(struct found *found) {
    feature_lines_release(&found->memory, &found->lines);
    feature_lines_release(&found->memory, &found->lines);
    CU_ASSERT_EQUAL(found->memory.used_bytes, 0);
    made_method_tile_free(found->made);
}

static uint32_t edges_of(const struct feature_lines *lines, uint32_t line) {
    return lines->starts[line + 1] - lines->starts[line] - 1;
}

/* Heights by a function of the way from the middle, in cells. */
static void shape(float heights_m[POSTS * POSTS], double (*height_m)(int x, int y)) {
    for (int y = 0; y < POSTS; y++)
        for (int x = 0; x < POSTS; x++) heights_m[y * POSTS + x] = (float)height_m(x - CELLS / 2, y - CELLS / 2);
}

static double level(int x, int y) {
    (void)x;
    (void)y;
    return 100;
}
static double slope(int x, int y) {
    return 90.0 * x - 40.0 * y;
}
/* 30 m a cell down on both sides: 90 degrees between the planes. */
static double ridge(int x, int y) {
    (void)y;
    return -30.0 * abs(x);
}
static double diagonal_ridge(int x, int y) {
    return -60.0 * abs(x - y);
}
static double falling_ridge(int x, int y) {
    return -60.0 * abs(x + y);
}
static double pyramid(int x, int y) {
    return -60.0 * (abs(x) > abs(y) ? abs(x) : abs(y));
}
/* A cliff of 100 m in a cell around a square. */
static double plateau(int x, int y) {
    return abs(x) <= 4 && abs(y) <= 4 ? 100 : 0;
}

static void smooth_ground_has_none(void) {
    float heights_m[POSTS * POSTS];
    double (*const shapes[])(int, int) = {level, slope};
    for (int i = 0; i < 4; i++) {
        shape(heights_m, shapes[i % 2]);
        struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.in_unit_cube = i >= 2});
        CU_ASSERT_EQUAL(found.lines.line_count, 0);
        release(&found);
    }
}

/* A ridge through the tile is one line from border to border where the border keeps its post, else to the last posts
 * before. */
static void a_ridge_is_a_line(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, ridge);
    for (int kept = 0; kept < 2; kept++) {
        struct found found = find(heights_m, CELLS, CELLS, kept ? 0 : 1000, (struct feature_options){0});
        CU_ASSERT_EQUAL_FATAL(found.lines.line_count, 1);
        CU_ASSERT_EQUAL(edges_of(&found.lines, 0), kept ? CELLS : CELLS - 2);
        for (uint32_t i = 0; i < found.lines.starts[1]; i++) {
            CU_ASSERT_EQUAL(found.lines.posts[i].column, CELLS / 2);
            CU_ASSERT_EQUAL(found.lines.posts[i].row, (int32_t)i + (kept ? 0 : 1));
        }
        release(&found);
    }
}

static void the_angle_decides(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, ridge);
    const struct {
        double angle_deg;
        uint32_t lines;
    } cases[] = {{89, 1}, {91, 0}, {180, 0}};
    for (int i = 0; i < 3; i++) {
        struct found found =
            find(heights_m, CELLS, CELLS, 0, (struct feature_options){.angle_deg = cases[i].angle_deg});
        CU_ASSERT_EQUAL(found.lines.line_count, cases[i].lines);
        release(&found);
    }
    /* A tenth of the height: 11 degrees in metres. In a cube the tile's 480 m and the ridge's 24 m are as long. */
    for (int i = 0; i < POSTS * POSTS; i++) heights_m[i] *= 0.1f;
    for (int cube = 0; cube < 2; cube++) {
        struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.in_unit_cube = cube});
        CU_ASSERT_EQUAL(found.lines.line_count, (uint32_t)cube);
        release(&found);
    }
}

static void short_lines_are_dropped(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, ridge);
    for (int32_t more = 0; more < 2; more++) {
        struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.least_edges = CELLS + more});
        CU_ASSERT_EQUAL(found.lines.line_count, more == 0);
        release(&found);
    }
    shape(heights_m, level);
    heights_m[8 * POSTS + 8] = 500; /* one spike: short lines around it */
    struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.least_edges = 9});
    CU_ASSERT_EQUAL(found.lines.line_count, 0);
    release(&found);
    found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.least_edges = 1});
    CU_ASSERT_TRUE(found.lines.line_count > 0);
    release(&found);
}

/* Cells are cut along the ridge, so that it is one straight line whichever diagonal it follows. */
static void diagonals_follow_the_ridge(void) {
    float heights_m[POSTS * POSTS];
    double (*const shapes[])(int, int) = {diagonal_ridge, falling_ridge};
    for (int i = 0; i < 2; i++) {
        shape(heights_m, shapes[i]);
        struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){0});
        CU_ASSERT_EQUAL_FATAL(found.lines.line_count, 1);
        CU_ASSERT_EQUAL(edges_of(&found.lines, 0), CELLS);
        release(&found);
    }
}

static void lines_end_where_they_meet(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, pyramid);
    struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){0});
    CU_ASSERT_EQUAL_FATAL(found.lines.line_count, 4);
    for (uint32_t line = 0; line < 4; line++) {
        const struct feature_post *first = &found.lines.posts[found.lines.starts[line]];
        const struct feature_post *last = &found.lines.posts[found.lines.starts[line + 1] - 1];
        CU_ASSERT_EQUAL(edges_of(&found.lines, line), CELLS / 2);
        CU_ASSERT_TRUE((first->column == CELLS / 2 && first->row == CELLS / 2) ||
                       (last->column == CELLS / 2 && last->row == CELLS / 2));
    }
    release(&found);
}

static void a_ring_is_closed(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, plateau);
    struct found found = find(heights_m, CELLS, CELLS, 0, (struct feature_options){.least_edges = 20});
    CU_ASSERT_EQUAL_FATAL(found.lines.line_count, 2); /* the upper edge of the cliff and the lower one */
    for (uint32_t line = 0; line < 2; line++) {
        const struct feature_post *first = &found.lines.posts[found.lines.starts[line]];
        const struct feature_post *last = &found.lines.posts[found.lines.starts[line + 1] - 1];
        CU_ASSERT_TRUE(first->column == last->column && first->row == last->row);
        CU_ASSERT_TRUE(edges_of(&found.lines, line) >= 32);
    }
    release(&found);
}

/* On rough ground: neighbours are neighbours, no edge is in two lines, inner posts are in one line only. */
static void lines_share_nothing_but_ends(void) {
    enum { SIDE = 64 };
    struct scree_memory memory = {0};
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = SIDE, .rows = SIDE, .metres_a_step = 3});
    struct feature_lines lines = {0};
    static unsigned char inner[(SIDE + 1) * (SIDE + 1)], any[(SIDE + 1) * (SIDE + 1)];
    memset(inner, 0, sizeof inner);
    memset(any, 0, sizeof any);
    uint32_t wrong = 0;
    CU_ASSERT_EQUAL_FATAL(
        features_find(&memory, &made->tile, &(struct feature_options){.least_edges = 2}, &lines, NULL), SCREE_OK);
    CU_ASSERT_TRUE_FATAL(lines.line_count > 20);
    for (uint32_t line = 0; line < lines.line_count; line++)
        for (uint32_t i = lines.starts[line]; i < lines.starts[line + 1]; i++) {
            const struct feature_post *at = &lines.posts[i];
            bool end = i == lines.starts[line] || i == lines.starts[line + 1] - 1;
            bool on_border = at->column == 0 || at->row == 0 || at->column == SIDE || at->row == SIDE;
            int32_t post = at->row * (SIDE + 1) + at->column;
            wrong += !end && (on_border || any[post]);
            wrong += end && inner[post];
            inner[post] |= !end;
            any[post] = 1;
            if (i == lines.starts[line]) continue;
            int32_t dx = abs(at->column - at[-1].column), dy = abs(at->row - at[-1].row);
            wrong += dx > 1 || dy > 1 || dx + dy == 0;
        }
    CU_ASSERT_EQUAL(wrong, 0);
    feature_lines_release(&memory, &lines);
    made_method_tile_free(made);
}

static void the_smallest_tiles(void) {
    const int32_t shapes[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}};
    for (int i = 0; i < 4; i++) {
        float heights_m[20];
        for (int k = 0; k < 20; k++) heights_m[k] = k % 2 == 0 ? 0 : 500;
        struct found found = find(heights_m, shapes[i][0], shapes[i][1], 0, (struct feature_options){.least_edges = 1});
        for (uint32_t p = 0; i < 3 && p < found.lines.starts[found.lines.line_count]; p++)
            CU_FAIL("a line although there is no post inside");
        release(&found);
    }
}

static void bad_options_are_refused(void) {
    struct scree_memory memory = {0};
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 4, .rows = 4});
    struct feature_lines lines = {0};
    const struct feature_options bad[] = {{-1, 5, false}, {181, 5, false}, {NAN, 5, false}, {60, -1, false}};
    for (int i = 0; i < 4; i++) {
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(features_find(&memory, &made->tile, &bad[i], &lines, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
        CU_ASSERT_PTR_NULL(lines.posts);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void every_failed_request_is_survived(void) {
    float heights_m[POSTS * POSTS];
    shape(heights_m, pyramid);
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = CELLS, .rows = CELLS, .given_heights_m = heights_m});
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 20) {
        struct scree_memory memory = {.fail_request = ++request};
        struct feature_lines lines = {0};
        status = features_find(&memory, &made->tile, &(struct feature_options){0}, &lines, NULL);
        CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && lines.posts == NULL));
        feature_lines_release(&memory, &lines);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT_TRUE(request > 5);
    made_method_tile_free(made);
}

int suite_features(void) {
    CU_pSuite suite = CU_add_suite("feature lines", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, smooth_ground_has_none);
    CU_ADD_TEST(suite, a_ridge_is_a_line);
    CU_ADD_TEST(suite, the_angle_decides);
    CU_ADD_TEST(suite, short_lines_are_dropped);
    CU_ADD_TEST(suite, diagonals_follow_the_ridge);
    CU_ADD_TEST(suite, lines_end_where_they_meet);
    CU_ADD_TEST(suite, a_ring_is_closed);
    CU_ADD_TEST(suite, lines_share_nothing_but_ends);
    CU_ADD_TEST(suite, the_smallest_tiles);
    CU_ADD_TEST(suite, bad_options_are_refused);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
