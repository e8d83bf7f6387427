/* The filter on a city made by code (tests/city_maker.h). What the paper's tables show is to show here: Goebbels and
 * Pohle-Froehlich 2015, section 6. */
#include "lod/context_filter.h"
#include "lod/square_subdivision.h"
#include "tests/city_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>

enum { SIDE = CITY_SIDE, POSTS = CITY_POSTS, MOST_STEPS = 6 };

#define EPSILON_M 0.2

static float heights_m[POSTS], filtered_m[POSTS];
static uint8_t uses[POSTS];
static uint32_t waters[POSTS];

static struct context_posts build_city(uint64_t seed) {
    city_make(seed, heights_m, uses);
    for (int32_t post = 0; post < POSTS; post++) waters[post] = uses[post] & GROUND_WATER ? 1 : 0;
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

/* Even and odd crossings of the outline to the east of a place. */
static bool is_inside(const struct city_outline *outline, double x, double y) {
    bool inside = false;
    for (size_t i = 0; i < outline->count; i++) {
        const double *a = outline->corners[i], *b = outline->corners[(i + 1) % outline->count];
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])) inside = !inside;
    }
    return inside;
}

/* The outlines that other programs are given say the same as the posts; rounded ones are a little smaller. */
static void outlines_are_where_posts_are(void) {
    static struct city_outline outline;
    uint32_t posts = 0, wrong = 0;
    build_city(4);
    for (int i = 0; i < CITY_OUTLINES; i++) {
        city_outline(i, &outline);
        CU_ASSERT_FATAL(outline.count <= CITY_CORNERS);
        for (int32_t y = 7; y < SIDE; y += 17)
            for (int32_t x = 3; x < SIDE; x += 3) {
                const uint8_t use = uses[y * SIDE + x];
                const bool hides = use & GROUND_BRIDGE && outline.use != GROUND_BRIDGE;
                if (hides || !is_inside(&outline, x, y)) continue;
                posts++;
                wrong += !(use & outline.use);
            }
    }
    uint32_t covered = 0;
    for (int32_t y = 7; y < SIDE; y += 17)
        for (int32_t x = 3; x < SIDE; x += 3)
            for (uint8_t use = uses[y * SIDE + x]; use != 0; use = (uint8_t)(use & (use - 1))) covered++;
    CU_ASSERT(posts > 500);
    CU_ASSERT_EQUAL(wrong, 0);
    CU_ASSERT(covered >= posts && covered - posts < posts / 100);
}

int suite_filter_city(void) {
    CU_pSuite suite = CU_add_suite("filtered city", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, some_steps_are_best);
    CU_ADD_TEST(suite, tails_need_the_fewest);
    CU_ADD_TEST(suite, what_people_look_at_stays);
    CU_ADD_TEST(suite, outlines_are_where_posts_are);
    return 0;
}
