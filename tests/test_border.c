/* The one-dimensional rule of the borders: what it promises about errors and sets, so that neighbours meet. */
#include "lod/border.h"
#include "lod/simplify.h"
#include "tests/fractal.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LENGTH 256

/* Lines are large: two at hand, the one that a test works on and one to compare with. */
static struct border_line line, other;

/* A line of posts of a fractal, whole metres so that ties are many. */
static void start_fractal(struct border_line *start, uint64_t seed, int32_t length, double curvature_m) {
    float heights_m[LENGTH + 1];
    struct fractal fractal = {seed, true};
    fractal_window(&fractal, 1000, 2000, length + 1, 1, heights_m, length + 1);
    start->curvature_m = curvature_m;
    start->vertex_count = start->sample_count = length + 1;
    for (int32_t i = 0; i <= length; i++)
        start->samples[i] = start->vertices[i] = (struct border_sample){i, heights_m[i]};
}

static void start_level(struct border_line *start, int32_t length, int32_t step, double curvature_m) {
    start->curvature_m = curvature_m;
    start->vertex_count = start->sample_count = length / step + 1;
    for (int32_t i = 0; i < start->vertex_count; i++)
        start->samples[i] = start->vertices[i] = (struct border_sample){i * step, 100};
}

static bool same_vertices(const struct border_line *a, const struct border_line *b) {
    if (a->vertex_count != b->vertex_count) return false;
    for (int32_t v = 0; v < a->vertex_count; v++)
        if (a->vertices[v].position != b->vertices[v].position || a->vertices[v].height_m != b->vertices[v].height_m)
            return false;
    return true;
}

/* The largest distance of the samples between two positions from the chord of two vertices, the ellipsoid's sagitta
 * included. */
static double chord_m(const struct border_line *of, const struct border_sample *a, const struct border_sample *c) {
    double largest_m = 0;
    for (int32_t s = 0; s < of->sample_count; s++) {
        const struct border_sample *at = &of->samples[s];
        if (at->position < a->position || at->position > c->position) continue;
        double share = (double)(at->position - a->position) / (c->position - a->position);
        double chord = a->height_m * (1 - share) + c->height_m * share;
        chord -= of->curvature_m * (at->position - a->position) * (double)(c->position - at->position);
        largest_m = fmax(largest_m, fabs(at->height_m - chord));
    }
    return largest_m;
}

static void every_rung_is_nested_exact_and_used_up(void) {
    static const double curvatures_m[] = {0, 0.01};
    for (uint64_t seed = 1; seed <= 4; seed++)
        for (int k = 0; k < 2; k++) {
            start_fractal(&line, seed, LENGTH, curvatures_m[k]);
            for (double tolerance_m = 0.5; tolerance_m < 300; tolerance_m *= 1.5) {
                other = line;
                border_reduce(&line, tolerance_m, 0);
                CU_ASSERT(line.vertex_count <= other.vertex_count);
                for (int32_t v = 0; v < line.vertex_count; v++)
                    CU_ASSERT_TRUE(border_keeps(&other, line.vertices[v].position));
                for (int32_t v = 1; v < line.vertex_count; v++) {
                    CU_ASSERT(line.vertices[v - 1].position < line.vertices[v].position);
                    CU_ASSERT(chord_m(&line, &line.vertices[v - 1], &line.vertices[v]) <= tolerance_m + 1e-9);
                    if (v + 1 < line.vertex_count) /* none is left that could still go */
                        CU_ASSERT(chord_m(&line, &line.vertices[v - 1], &line.vertices[v + 1]) > tolerance_m - 1e-9);
                }
                CU_ASSERT_EQUAL(line.vertices[0].position, 0);
                CU_ASSERT_EQUAL(line.vertices[line.vertex_count - 1].position, LENGTH);
            }
            CU_ASSERT(line.vertex_count < 20);
        }
}

/* Neighbours may have come by other rungs, if only the tolerances are the same at the end. */
static void sets_do_not_depend_on_the_way(void) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        start_fractal(&line, seed, LENGTH, 0.002);
        start_fractal(&other, seed, LENGTH, 0.002);
        for (double tolerance_m = 1; tolerance_m <= 64; tolerance_m *= 2) border_reduce(&line, tolerance_m, 0);
        border_reduce(&other, 64, 0);
        CU_ASSERT_TRUE(same_vertices(&line, &other));
        CU_ASSERT(line.vertex_count > 2 && line.vertex_count < LENGTH);
        border_reduce(&other, 64, 0); /* and once more changes nothing */
        CU_ASSERT_TRUE(same_vertices(&line, &other));
    }
}

static void an_error_of_just_the_tolerance_passes(void) {
    start_level(&line, 8, 1, 0);
    line.samples[4].height_m = line.vertices[4].height_m = 103;
    other = line;
    border_reduce(&line, 3, 0);
    CU_ASSERT_EQUAL(line.vertex_count, 2);
    border_reduce(&other, 2.9999, 0);
    CU_ASSERT_EQUAL(other.vertex_count, 3);
    CU_ASSERT_TRUE(border_keeps(&other, 4));
}

static void level_lines_keep_dyadic_sets_wherever_they_start(void) {
    for (double tolerance_m = 20; tolerance_m < 10000; tolerance_m *= 1.7) {
        start_level(&line, LENGTH, 1, 1);
        border_reduce(&line, tolerance_m, 0);
        int32_t spacing = LENGTH; /* a chord of n steps has a sagitta of n^2 / 4 */
        while (spacing * spacing / 4.0 > tolerance_m) spacing /= 2;
        CU_ASSERT_EQUAL(line.vertex_count, LENGTH / spacing + 1);
        for (int32_t v = 0; v < line.vertex_count; v++) CU_ASSERT_EQUAL(line.vertices[v].position, v * spacing);
        for (int32_t step = 2; step <= 4; step *= 2) {
            start_level(&other, LENGTH, step, 1);
            border_reduce(&other, tolerance_m, 0);
            CU_ASSERT_TRUE(same_vertices(&line, &other));
        }
    }
}

static void locked_positions_stay(void) {
    start_level(&line, LENGTH, 1, 0);
    border_reduce(&line, 1e6, 32);
    CU_ASSERT_EQUAL(line.vertex_count, LENGTH / 32 + 1);
    for (int32_t position = 0; position <= LENGTH; position++)
        CU_ASSERT_EQUAL(border_keeps(&line, position), position % 32 == 0);
    start_fractal(&line, 3, LENGTH, 0);
    border_reduce(&line, 20, 64);
    for (int32_t position = 0; position <= LENGTH; position += 64) CU_ASSERT_TRUE(border_keeps(&line, position));
}

/* Two lines of one span, as the halves of their parent's border see it, hold other codes. */
static void codes_are_distinct_afterwards(void) {
    static const int32_t offsets[] = {0, 1 << 17};
    for (size_t i = 0; i < 2; i++) {
        int64_t span = 1 << 18;
        int32_t length = 1 << 17, before = -1;
        line.vertex_count = 1025;
        line.sample_count = 0;
        for (int32_t v = 0; v < line.vertex_count; v++) /* places where eight steps are a code, all close to others */
            line.vertices[v] = (struct border_sample){v / 3 * 24 + v % 3 * 2, 0};
        line.vertices[1024].position = length;
        other = line;
        border_separate_codes(&line, 32767, offsets[i]);
        CU_ASSERT_TRUE(same_vertices(&line, &other)); /* every step has a code of its own */
        border_separate_codes(&line, span, offsets[i]);
        CU_ASSERT(line.vertex_count > 300 && line.vertex_count < 700);
        for (int32_t v = 0; v < line.vertex_count; v++) {
            int32_t code = position_code((int64_t)line.vertices[v].position + offsets[i], span);
            CU_ASSERT(code > before);
            CU_ASSERT_TRUE(border_keeps(&other, line.vertices[v].position));
            before = code;
        }
        CU_ASSERT_EQUAL(line.vertices[0].position, 0);
        CU_ASSERT_EQUAL(line.vertices[line.vertex_count - 1].position, length);
    }
}

/* The end keeps its code: what would share it goes. */
static void the_end_of_a_line_wins(void) {
    line.vertex_count = 3;
    line.sample_count = 0;
    line.vertices[0].position = 0;
    line.vertices[1].position = (1 << 18) - 1;
    line.vertices[2].position = 1 << 18;
    border_separate_codes(&line, 1 << 18, 0);
    CU_ASSERT_EQUAL(line.vertex_count, 2);
    CU_ASSERT_EQUAL(line.vertices[1].position, 1 << 18);
}

/* A line's samples hold a given height within a closed cell. */
static bool has_sample(const struct border_line *of, int32_t from, int32_t to, float height_m) {
    for (int32_t s = 0; s < of->sample_count; s++)
        if (of->samples[s].position >= from && of->samples[s].position <= to && of->samples[s].height_m == height_m)
            return true;
    return false;
}

static void check_extremes(const struct border_line *joined, const float *heights_m, int32_t length, int32_t span) {
    for (int32_t from = 0; from < length; from += span) {
        int32_t to = from + span < length ? from + span : length;
        float lowest_m = heights_m[from], highest_m = heights_m[from];
        for (int32_t i = from; i <= to; i++) {
            lowest_m = fminf(lowest_m, heights_m[i]);
            highest_m = fmaxf(highest_m, heights_m[i]);
        }
        CU_ASSERT_TRUE(has_sample(joined, from, to, lowest_m));
        CU_ASSERT_TRUE(has_sample(joined, from, to, highest_m));
    }
    for (int32_t s = 0; s < joined->sample_count; s++) {
        CU_ASSERT_EQUAL(joined->samples[s].height_m, heights_m[joined->samples[s].position]);
        if (s > 0) CU_ASSERT(joined->samples[s - 1].position <= joined->samples[s].position);
    }
    CU_ASSERT(joined->sample_count <= 2 * ((length + span - 1) / span));
}

static void joined_lines_keep_vertices_and_extremes(void) {
    float heights_m[2 * LENGTH + 1];
    struct fractal fractal = {9, true};
    struct border_line *second = malloc(sizeof *second);
    CU_ASSERT_PTR_NOT_NULL_FATAL(second);
    fractal_window(&fractal, 0, 0, 2 * LENGTH + 1, 1, heights_m, 0);
    for (int half = 0; half < 2; half++) {
        struct border_line *of = half == 0 ? &other : second;
        of->vertex_count = of->sample_count = LENGTH + 1;
        of->curvature_m = 0.25;
        for (int32_t i = 0; i <= LENGTH; i++)
            of->samples[i] = of->vertices[i] = (struct border_sample){i, heights_m[half * LENGTH + i]};
        border_reduce(of, 10, 0);
    }
    CU_ASSERT_TRUE(border_join(&other, second, LENGTH, 2, false, &line));
    CU_ASSERT_EQUAL(line.vertex_count, other.vertex_count + second->vertex_count - 1);
    CU_ASSERT_EQUAL(line.curvature_m, 0.25);
    for (int32_t i = 0; i <= 2 * LENGTH; i++)
        CU_ASSERT_EQUAL(border_keeps(&line, i),
                        i <= LENGTH ? border_keeps(&other, i) : border_keeps(second, i - LENGTH));
    check_extremes(&line, heights_m, 2 * LENGTH, 2);
    other = line;
    CU_ASSERT_TRUE(border_join(&other, NULL, 2 * LENGTH, 4, false, &line)); /* the window ends before a second one */
    CU_ASSERT_TRUE(same_vertices(&line, &other));
    check_extremes(&line, heights_m, 2 * LENGTH, 4);
    free(second);
}

/* Cells at the end of a window that is cut are shorter. */
static void cut_lines_have_a_short_last_cell(void) {
    float heights_m[6] = {4, 1, 3, 9, 2, 7};
    line.vertex_count = line.sample_count = 6;
    for (int32_t i = 0; i < 6; i++) line.samples[i] = line.vertices[i] = (struct border_sample){i, heights_m[i]};
    CU_ASSERT_TRUE(border_join(&line, NULL, 5, 2, false, &other));
    check_extremes(&other, heights_m, 5, 2);
}

static void too_many_vertices_are_refused(void) {
    struct border_line *joined = malloc(sizeof *joined);
    CU_ASSERT_PTR_NOT_NULL_FATAL(joined);
    for (int32_t extra = 0; extra <= 1; extra++) {
        line.vertex_count = 2049;
        other.vertex_count = 2049 + extra;
        line.sample_count = other.sample_count = 0;
        for (int32_t v = 0; v < 2050; v++) line.vertices[v].position = other.vertices[v].position = v;
        CU_ASSERT_EQUAL(border_join(&line, &other, 2048, 1 << 12, false, joined), extra == 0);
    }
    free(joined);
}

int suite_border(void) {
    CU_pSuite suite = CU_add_suite("border", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, every_rung_is_nested_exact_and_used_up);
    CU_ADD_TEST(suite, sets_do_not_depend_on_the_way);
    CU_ADD_TEST(suite, an_error_of_just_the_tolerance_passes);
    CU_ADD_TEST(suite, level_lines_keep_dyadic_sets_wherever_they_start);
    CU_ADD_TEST(suite, locked_positions_stay);
    CU_ADD_TEST(suite, codes_are_distinct_afterwards);
    CU_ADD_TEST(suite, the_end_of_a_line_wins);
    CU_ADD_TEST(suite, joined_lines_keep_vertices_and_extremes);
    CU_ADD_TEST(suite, cut_lines_have_a_short_last_cell);
    CU_ADD_TEST(suite, too_many_vertices_are_refused);
    return 0;
}
