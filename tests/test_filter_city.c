/* The filter on a city made by code: flat fields, a railway's embankment, a river, a bridge with its ramps, a heap and
 * a wood. What the paper's tables show is to show here: Goebbels and Pohle-Froehlich 2015, section 6. */
#include "lod/context_filter.h"
#include "lod/square_subdivision.h"
#include "tests/fractal.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

enum { SIDE = 5 * 128 + 1, POSTS = SIDE * SIDE, MOST_STEPS = 6 };

#define EPSILON_M 0.2

static float heights_m[POSTS], filtered_m[POSTS];
static uint8_t uses[POSTS];
static uint32_t waters[POSTS];

/* 1 within `half` posts, 0 beyond `half + slope`. */
static double shelf(double distance, double half, double slope) {
    return fmin(fmax(1 - (distance - half) / slope, 0), 1);
}

static double height_m(int32_t x, int32_t y, double roughness, uint8_t *use) {
    const double river = fabs(x - 200 - 30 * sin(y / 60.0)), rails = fabs(0.6 * x + 0.8 * y - 480);
    const double road = fabs(y - 330.0), bridge = fabs(x - 200 - 30 * sin(330 / 60.0));
    const double heap = hypot(x - 500, y - 470), wood = hypot(x - 480, y - 130);
    double z = 30 + 1.5 * sin(x / 70.0) * cos(y / 90.0);
    z += 25 * shelf(heap, 25, 30) + fmin(roughness, 1) * 0.5 * shelf(heap, 40, 10);
    z += 6 * shelf(wood, 20, 60) + 0.6 * roughness * shelf(wood, 70, 4);
    if (wood < 70) *use |= GROUND_FOREST;
    z += (36 - z) * shelf(rails, 3, 5);
    if (rails < 8) *use |= GROUND_RAILWAY;
    z += (27 - z) * shelf(river, 8, 5);
    if (river < 9) *use |= GROUND_WATER;
    const double deck_m = 30 + 6 * shelf(bridge, 18, 60);
    z += (fmax(deck_m, z) - z) * shelf(road, 3, 2);
    if (road < 4 && bridge < 18) *use = GROUND_BRIDGE;
    if (road < 4 && bridge >= 18 && bridge < 80) *use |= GROUND_RAMP;
    return z + 0.12 * roughness; /* the noise of a scanner */
}

static struct context_posts build_city(uint64_t seed) {
    const struct fractal fractal = {.seed = seed};
    memset(uses, 0, sizeof uses);
    /* The fractal's finest octaves only: how far a post is from the mean of its neighbours. */
    fractal_window(&fractal, 0, 0, SIDE, SIDE, filtered_m, SIDE);
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            const int32_t post = y * SIDE + x, west = x > 0 ? post - 1 : post, east = x + 1 < SIDE ? post + 1 : post;
            const double roughness = filtered_m[post] - (filtered_m[west] + filtered_m[east]) / 2;
            heights_m[post] = (float)height_m(x, y, fmax(fmin(roughness, 2), -2), &uses[post]);
            waters[post] = uses[post] & GROUND_WATER ? 1 : 0;
        }
    return (struct context_posts){heights_m, SIDE, SIDE, uses, waters, 1};
}

static uint64_t triangles_of(const struct context_posts *posts, const struct context_options *options) {
    struct scree_memory memory = {0};
    struct context_counts counts;
    CU_ASSERT_EQUAL_FATAL(context_filter(&memory, posts, options, filtered_m, &counts, NULL), SCREE_OK);
    return subdivision_triangles(filtered_m, SIDE, SIDE, EPSILON_M);
}

static int best_steps(const struct context_posts *posts, struct context_options options, uint64_t *fewest) {
    int best = 0;
    for (int steps = 1; steps <= MOST_STEPS; steps++) {
        options.spline_steps = steps;
        const uint64_t triangles = triangles_of(posts, &options);
        if (best == 0 || triangles < *fewest) {
            best = steps;
            *fewest = triangles;
        }
    }
    return best;
}

/* Table 3: too many steps make detail of what is flat, too few make the spline detailed. Table 4: the smaller delta is,
 * the fewer steps are best. */
static void some_steps_are_best(void) {
    struct context_options options = context_defaults();
    const struct context_posts posts = build_city(1);
    const uint64_t unfiltered = subdivision_triangles(heights_m, SIDE, SIDE, EPSILON_M);
    uint64_t fewest = 0, more = 0;
    const int best = best_steps(&posts, options, &fewest);
    CU_ASSERT(best > 1 && best < MOST_STEPS);
    CU_ASSERT(3 * fewest < unfiltered);
    options.delta_m = 1;
    CU_ASSERT(best_steps(&posts, options, &more) <= best);
    CU_ASSERT(more > fewest);
}

/* Table 2: filtered detail needs fewer triangles than unfiltered one, and fewer still where only tails go. */
static void tails_need_the_fewest(void) {
    struct context_options options = context_defaults();
    const struct context_posts posts = build_city(2);
    const uint64_t tail = triangles_of(&posts, &options);
    options.variant = HAAR_EACH;
    const uint64_t each = triangles_of(&posts, &options);
    options.detail = CONTEXT_UNFILTERED;
    const uint64_t exact = triangles_of(&posts, &options);
    CU_ASSERT(tail < each);
    CU_ASSERT(each < exact);
    CU_ASSERT(exact < subdivision_triangles(heights_m, SIDE, SIDE, EPSILON_M));
}

/* Embankment, bridge and ramps stay as accurate as their thresholds are; the river becomes flat. */
static void what_people_look_at_stays(void) {
    const struct context_options options = context_defaults();
    const struct context_posts posts = build_city(3);
    double bound_m[2] = {options.least_m, options.least_m}, most_m[2] = {0, 0};
    for (int i = 0; i < HAAR_LEVELS; i++)
        for (int class = CONTEXT_NEAR; class <= CONTEXT_RAILWAY; class ++)
            bound_m[class] += 2 * options.thresholds_m[class][i];
    triangles_of(&posts, &options);
    const float *level_m = NULL;
    double elsewhere_m = 0;
    for (int32_t post = 0; post < POSTS; post++) {
        const double away_m = fabs((double)filtered_m[post] - heights_m[post]);
        if (waters[post]) {
            if (level_m == NULL) level_m = &filtered_m[post];
            CU_ASSERT_EQUAL(filtered_m[post], *level_m);
        } else if (uses[post] & GROUND_RAILWAY)
            most_m[CONTEXT_RAILWAY] = fmax(most_m[CONTEXT_RAILWAY], away_m);
        else if (uses[post] & (GROUND_BRIDGE | GROUND_RAMP))
            most_m[CONTEXT_NEAR] = fmax(most_m[CONTEXT_NEAR], away_m);
        else
            elsewhere_m = fmax(elsewhere_m, away_m);
    }
    CU_ASSERT(most_m[CONTEXT_RAILWAY] > 0 && most_m[CONTEXT_RAILWAY] <= bound_m[CONTEXT_RAILWAY] + 1e-3);
    CU_ASSERT(most_m[CONTEXT_NEAR] > 0 && most_m[CONTEXT_NEAR] <= bound_m[CONTEXT_NEAR] + 1e-3);
    CU_ASSERT(elsewhere_m > most_m[CONTEXT_RAILWAY]);
}

int suite_filter_city(void) {
    CU_pSuite suite = CU_add_suite("filtered city", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, some_steps_are_best);
    CU_ADD_TEST(suite, tails_need_the_fewest);
    CU_ADD_TEST(suite, what_people_look_at_stays);
    return 0;
}
