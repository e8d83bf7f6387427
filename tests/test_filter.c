/* The context-sensitive filter: splines that are the best there are, wavelets that give back what they took and keep
 * within their thresholds, classes and their rule, and the measure of triangles. */
#include "lod/context_filter.h"
#include "lod/post_gaps.h"
#include "lod/spline_filter.h"
#include "lod/square_subdivision.h"
#include "tests/fractal.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 700, ROWS = 530, POSTS = COLUMNS * ROWS, LINE = 65 };

static float heights_m[POSTS], filtered_m[POSTS], other_m[POSTS];
static uint8_t uses[POSTS];
static uint32_t waters[POSTS];
static struct haar_block block;

static void fill_fractal(uint64_t seed) {
    const struct fractal fractal = {.seed = seed};
    fractal_window(&fractal, 500, 40, COLUMNS, ROWS, heights_m, COLUMNS);
}

static struct context_posts whole(void) {
    return (struct context_posts){.heights_m = heights_m, .columns = COLUMNS, .rows = ROWS};
}

static struct context_counts filter(const struct context_posts *posts, const struct context_options *options,
                                    float *to_m) {
    struct scree_memory memory = {0};
    struct context_counts counts;
    CU_ASSERT_EQUAL_FATAL(context_filter(&memory, posts, options, to_m, &counts, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return counts;
}

/* ---- splines ---- */

static void planes_stay_planes(void) {
    static const int32_t sizes[][2] = {{2, 2}, {3, 2}, {2, 5}, {9, 9}, {10, 7}, {41, 33}, {100, 77}, {64, 129}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int32_t steps = 1; steps <= SPLINE_MAX_STEPS; steps++) {
            const int32_t columns = sizes[s][0], rows = sizes[s][1];
            struct scree_memory memory = {0};
            struct spline spline;
            for (int32_t i = 0; i < columns * rows; i++)
                heights_m[i] = (float)(300 - 2 * (i % columns) + 3 * (i / columns));
            CU_ASSERT_EQUAL_FATAL(spline_make(&memory, heights_m, columns, rows, steps, &spline, NULL), SCREE_OK);
            double most_m = 0;
            for (int32_t y = 0; y < rows; y++) {
                spline_row(&spline, y, columns, filtered_m);
                for (int32_t x = 0; x < columns; x++)
                    most_m = fmax(most_m, fabs((double)filtered_m[x] - heights_m[y * columns + x]));
            }
            CU_ASSERT(most_m < 2e-3);
            spline_release(&memory, &spline);
            CU_ASSERT_EQUAL(memory.used_bytes, 0);
        }
}

/* The integral of the product of a line of `fine` posts with the hat around coarse post k, by Simpson's rule, which is
 * exact for it; hats are twice as wide as the posts are apart. */
static double product(const double *fine, int32_t count, int32_t k) {
    double sum = 0;
    for (int32_t cell = 0; cell + 1 < count; cell++) {
        const double left = fmax(0, 1 - fabs(cell / 2.0 - k)), right = fmax(0, 1 - fabs((cell + 1) / 2.0 - k));
        const double middle = (fine[cell] + fine[cell + 1]) * (left + right);
        sum += (fine[cell] * left + middle + fine[cell + 1] * right) / 6;
    }
    return sum;
}

/* Gauss-Jordan with the full matrix of products of hats. */
static void solve_densely(const double *fine, int32_t count, int32_t unknowns, double *solution) {
    static double matrix[LINE][LINE + 1], hat[2 * LINE];
    for (int32_t j = 0; j < unknowns; j++) {
        for (int32_t i = 0; i < count; i++) hat[i] = fmax(0, 1 - fabs(i / 2.0 - j));
        for (int32_t k = 0; k < unknowns; k++) matrix[k][j] = product(hat, count, k);
        matrix[j][unknowns] = product(fine, count, j);
    }
    for (int32_t j = 0; j < unknowns; j++)
        for (int32_t k = 0; k < unknowns; k++) {
            const double share = k == j ? 0 : matrix[k][j] / matrix[j][j];
            for (int32_t i = 0; i <= unknowns; i++) matrix[k][i] -= share * matrix[j][i];
        }
    for (int32_t j = 0; j < unknowns; j++) solution[j] = matrix[j][unknowns] / matrix[j][j];
}

/* A ridge along each axis, any profile across it: the other direction stays as it is. */
static void splines_are_the_best(void) {
    for (int32_t count = 3; count <= LINE; count += 2)
        for (int turned = 0; turned < 2; turned++) {
            double fine[LINE], best[LINE];
            const int32_t unknowns = count / 2 + 1, columns = turned ? 3 : count, rows = turned ? count : 3;
            for (int32_t i = 0; i < count; i++) fine[i] = 50 * sin(i * i * 0.37) + (i > 20 ? 30 : 0);
            for (int32_t y = 0; y < rows; y++)
                for (int32_t x = 0; x < columns; x++) heights_m[y * columns + x] = (float)fine[turned ? y : x];
            struct scree_memory memory = {0};
            struct spline spline;
            CU_ASSERT_EQUAL_FATAL(spline_make(&memory, heights_m, columns, rows, 1, &spline, NULL), SCREE_OK);
            CU_ASSERT_EQUAL(turned ? spline.rows : spline.columns, unknowns);
            solve_densely(fine, count, unknowns, best);
            for (int32_t y = 0; y < spline.rows; y++)
                for (int32_t x = 0; x < spline.columns; x++)
                    CU_ASSERT_DOUBLE_EQUAL(spline.heights_m[y * spline.columns + x], best[turned ? y : x], 1e-4);
            spline_release(&memory, &spline);
        }
}

/* At the spline's own posts interpolation changes nothing; between them it stays within the four around. */
static void rows_go_through_the_splines_posts(void) {
    struct scree_memory memory = {0};
    struct spline spline;
    fill_fractal(3);
    CU_ASSERT_EQUAL_FATAL(spline_make(&memory, heights_m, COLUMNS, ROWS, 3, &spline, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(spline.columns, 89); /* 88 cells of 8 posts hold the 699 steps of a row */
    for (int32_t y = 0; y < ROWS; y++) {
        spline_row(&spline, y, COLUMNS, filtered_m);
        for (int32_t x = 0; x < COLUMNS; x++) {
            const float *sw = spline.heights_m + (y / 8) * spline.columns + x / 8, *nw = sw + spline.columns;
            const float low_m = fminf(fminf(sw[0], sw[1]), fminf(nw[0], nw[1]));
            const float high_m = fmaxf(fmaxf(sw[0], sw[1]), fmaxf(nw[0], nw[1]));
            if (x % 8 == 0 && y % 8 == 0) CU_ASSERT_EQUAL(filtered_m[x], sw[0]);
            CU_ASSERT(filtered_m[x] > low_m - 1e-3 && filtered_m[x] < high_m + 1e-3);
        }
    }
    spline_release(&memory, &spline);
    CU_ASSERT_EQUAL(spline_make(&memory, heights_m, 1, 5, 1, &spline, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(spline_make(&memory, heights_m, 5, 5, 0, &spline, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(spline_make(&memory, heights_m, 5, 5, SPLINE_MAX_STEPS + 1, &spline, NULL), SCREE_E_ARGUMENT);
}

/* ---- wavelets ---- */

static void load_block(void) {
    fill_fractal(5);
    for (int32_t y = 0; y < HAAR_SIDE; y++)
        for (int32_t x = 0; x < HAAR_SIDE; x++) block.coefficients[y * HAAR_SIDE + x] = heights_m[y * COLUMNS + x];
    haar_transform(&block);
}

static void zero_thresholds_give_all_back(void) {
    const double none_m[HAAR_LEVELS] = {0};
    load_block();
    double mean_m = 0;
    for (int32_t y = 0; y < HAAR_SIDE; y++)
        for (int32_t x = 0; x < HAAR_SIDE; x++) {
            const float height_m = heights_m[y * COLUMNS + x];
            mean_m += height_m / (HAAR_SIDE * (double)HAAR_SIDE);
            CU_ASSERT_EQUAL((float)haar_height_m(&block, x, y, none_m, HAAR_TAIL), height_m);
            CU_ASSERT_EQUAL((float)haar_height_m(&block, x, y, none_m, HAAR_EACH), height_m);
        }
    CU_ASSERT_DOUBLE_EQUAL(block.means[0], mean_m, 1e-6);
}

/* What is left out is smaller than its threshold, twice at each level. */
static void thresholds_bound_the_difference(void) {
    const struct context_options options = context_defaults();
    load_block();
    for (int class = 0; class < CONTEXT_FOREST; class ++) {
        double bound_m = 0, most_m[2] = {0, 0}, sum_m[2] = {0, 0};
        for (int i = 0; i < HAAR_LEVELS; i++) bound_m += 2 * options.thresholds_m[class][i];
        for (int32_t y = 0; y < HAAR_SIDE; y++)
            for (int32_t x = 0; x < HAAR_SIDE; x++)
                for (int variant = 0; variant < 2; variant++) {
                    const double got_m =
                        haar_height_m(&block, x, y, options.thresholds_m[class], (enum haar_variant)variant);
                    const double away_m = fabs(got_m - heights_m[y * COLUMNS + x]);
                    most_m[variant] = fmax(most_m[variant], away_m);
                    sum_m[variant] += away_m;
                }
        CU_ASSERT(most_m[HAAR_TAIL] > 0 && most_m[HAAR_TAIL] <= bound_m);
        CU_ASSERT(most_m[HAAR_EACH] <= bound_m);
        CU_ASSERT(sum_m[HAAR_TAIL] < sum_m[HAAR_EACH]); /* it keeps more */
    }
}

/* A step of 0.02 m between halves and one of 1 m between neighbours: only the latter reaches its threshold. */
static void variants_differ_in_the_middle(void) {
    const double thresholds_m[HAAR_LEVELS] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
    for (int32_t y = 0; y < HAAR_SIDE; y++)
        for (int32_t x = 0; x < HAAR_SIDE; x++)
            block.coefficients[y * HAAR_SIDE + x] = 100 + (x < HAAR_SIDE / 2 ? 0.02 : 0) + (y == 7 && x == 9 ? 1 : 0);
    haar_transform(&block);
    CU_ASSERT_DOUBLE_EQUAL(haar_height_m(&block, 9, 7, thresholds_m, HAAR_TAIL), 101.02, 1e-9);
    CU_ASSERT(haar_height_m(&block, 9, 7, thresholds_m, HAAR_EACH) < 101.01);
    /* Far from both, the mean of the block is all that is left. */
    CU_ASSERT_DOUBLE_EQUAL(haar_height_m(&block, 300, 300, thresholds_m, HAAR_TAIL), block.means[0], 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(block.means[0], 100.01, 1e-4);
}

/* ---- classes ---- */

static void use(int32_t x, int32_t y, int32_t columns, int32_t rows, uint8_t bit) {
    for (int32_t j = y; j < y + rows; j++)
        for (int32_t i = x; i < x + columns; i++) uses[j * COLUMNS + i] |= bit;
}

static void neighbourhoods_are_nine_posts_wide(void) {
    const struct context_options options = context_defaults();
    struct context_posts posts = whole();
    memset(heights_m, 0, sizeof heights_m);
    memset(uses, 0, sizeof uses);
    posts.uses = uses;
    use(100, 100, 1, 1, GROUND_BRIDGE);
    CU_ASSERT_EQUAL(filter(&posts, &options, filtered_m).posts[CONTEXT_NEAR], 81);
    use(0, 0, 1, 1, GROUND_SHORE);
    use(COLUMNS - 1, ROWS - 1, 1, 1, GROUND_RAMP);
    CU_ASSERT_EQUAL(filter(&posts, &options, filtered_m).posts[CONTEXT_NEAR], 81 + 2 * 25);
    use(104, 101, 1, 1, GROUND_BRIDGE); /* its square overlaps with the first one's */
    CU_ASSERT_EQUAL(filter(&posts, &options, filtered_m).posts[CONTEXT_NEAR], 2 * 81 - 5 * 8 + 2 * 25);
    use(300, 300, 20, 30, GROUND_RAILWAY);
    struct context_counts counts = filter(&posts, &options, filtered_m);
    CU_ASSERT_EQUAL(counts.posts[CONTEXT_RAILWAY], 600);
    CU_ASSERT_EQUAL(counts.posts[CONTEXT_NEAR], 2 * 81 - 5 * 8 + 2 * 25 + 28 * 38 - 600);
    use(500, 200, 100, 100, GROUND_WATER); /* only where it ends: 4 posts out, 4 from the outermost ones in */
    const uint64_t before = counts.posts[CONTEXT_NEAR];
    counts = filter(&posts, &options, filtered_m);
    CU_ASSERT_EQUAL(counts.posts[CONTEXT_NEAR] - before, 108 * 108 - 90 * 90);
    CU_ASSERT_EQUAL(counts.detailed, 0);
}

/* A flat field with a cone on it: class 2 is where the spline fails by more than delta, and nothing else changes. */
static void steep_hills_keep_their_heights(void) {
    struct context_options options = context_defaults();
    struct context_posts posts = whole();
    for (int32_t i = 0; i < POSTS; i++) {
        const double x = i % COLUMNS - 350.0, y = i / COLUMNS - 260.0;
        heights_m[i] = (float)fmax(0, 40 - 8 * sqrt(x * x + y * y));
    }
    struct context_counts counts = filter(&posts, &options, filtered_m);
    CU_ASSERT(counts.posts[CONTEXT_HILL] > 4 && counts.posts[CONTEXT_HILL] < 150);
    CU_ASSERT_EQUAL(counts.posts[CONTEXT_HILL] + counts.posts[CONTEXT_REST], POSTS);
    CU_ASSERT_DOUBLE_EQUAL(filtered_m[260 * COLUMNS + 350], 40, 2);
    CU_ASSERT_DOUBLE_EQUAL(filtered_m[0], 0, 1e-3);
    options.detail = CONTEXT_UNFILTERED;
    filter(&posts, &options, other_m);
    CU_ASSERT_EQUAL(other_m[260 * COLUMNS + 350], 40);
    options.detail = CONTEXT_NONE;
    CU_ASSERT_EQUAL(filter(&posts, &options, other_m).detailed, 0);
    CU_ASSERT(other_m[260 * COLUMNS + 350] < 36);
    /* Under trees the same detail is not worth while: thresholds of 20 m. */
    options.detail = CONTEXT_FILTERED;
    memset(uses, GROUND_FOREST, sizeof uses);
    posts.uses = uses;
    counts = filter(&posts, &options, other_m);
    CU_ASSERT(counts.posts[CONTEXT_FOREST] > 4 && counts.posts[CONTEXT_HILL] == 0);
    CU_ASSERT(other_m[260 * COLUMNS + 350] < filtered_m[260 * COLUMNS + 350] - 2);
}

/* Everything of class 1: no post is farther off than its thresholds and the 0.3 m rule allow. */
static void class_1_keeps_its_accuracy(void) {
    const struct context_options options = context_defaults();
    struct context_posts posts = whole();
    fill_fractal(11);
    for (int turn = 0; turn < 2; turn++) {
        memset(uses, turn == 0 ? GROUND_BRIDGE : GROUND_RAILWAY, sizeof uses);
        posts.uses = uses;
        const enum context_class class = turn == 0 ? CONTEXT_NEAR : CONTEXT_RAILWAY;
        double bound_m = options.least_m, most_m = 0;
        for (int i = 0; i < HAAR_LEVELS; i++) bound_m += 2 * options.thresholds_m[class][i];
        const struct context_counts counts = filter(&posts, &options, filtered_m);
        CU_ASSERT_EQUAL(counts.posts[class], POSTS);
        for (int32_t i = 0; i < POSTS; i++) most_m = fmax(most_m, fabs((double)filtered_m[i] - heights_m[i]));
        CU_ASSERT(most_m > 0.3 && most_m <= bound_m + 1e-3);
    }
}

static void waters_take_their_means(void) {
    const struct context_options options = context_defaults();
    struct scree_memory memory = {0};
    struct context_counts counts;
    struct context_posts posts = whole();
    fill_fractal(2);
    memset(waters, 0, sizeof waters);
    double sums_m[2] = {0, 0};
    for (int32_t i = 0; i < 50 * COLUMNS; i++) {
        waters[i] = i % COLUMNS < 100 ? 1 : i % COLUMNS >= 600 ? 3 : 0;
        if (waters[i] > 0) sums_m[waters[i] / 2] += heights_m[i];
    }
    posts.waters = waters;
    posts.water_count = 3; /* the second one has no post */
    counts = filter(&posts, &options, filtered_m);
    CU_ASSERT_EQUAL(counts.levelled, 2 * 50 * 100);
    for (int32_t i = 0; i < POSTS; i++)
        if (waters[i] > 0) CU_ASSERT_DOUBLE_EQUAL(filtered_m[i], sums_m[waters[i] / 2] / 5000, 1e-3);
    posts.water_count = 2;
    CU_ASSERT_EQUAL(context_filter(&memory, &posts, &options, filtered_m, &counts, NULL), SCREE_E_ARGUMENT);
}

static void odd_sizes_and_little_memory(void) {
    static const int32_t sizes[][2] = {{2, 2}, {2, 40}, {57, 3}, {512, 2}, {513, 9}, {511, 4}};
    const struct context_options options = context_defaults();
    fill_fractal(4);
    memset(uses, GROUND_RAILWAY, sizeof uses);
    memset(waters, 0, sizeof waters);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const struct context_posts posts = {heights_m, sizes[s][0], sizes[s][1], uses, waters, 1};
        const struct context_counts counts = filter(&posts, &options, filtered_m);
        CU_ASSERT_EQUAL(counts.posts[CONTEXT_RAILWAY], (uint64_t)sizes[s][0] * (uint64_t)sizes[s][1]);
        filter(&posts, &options, other_m);
        const size_t bytes = (size_t)sizes[s][0] * (size_t)sizes[s][1] * sizeof *other_m;
        CU_ASSERT_EQUAL(memcmp(filtered_m, other_m, bytes), 0);
    }
    const struct context_posts posts = {heights_m, 57, 20, uses, waters, 1};
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t n = 1;
    for (; status != SCREE_OK && n < 100; n++) {
        struct scree_memory memory = {.fail_request = n};
        struct scree_error error = {0};
        struct context_counts counts;
        status = context_filter(&memory, &posts, &options, filtered_m, &counts, &error);
        CU_ASSERT_EQUAL(error.status, status);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT(n > 10 && n < 100);
}

/* ---- gaps, and triangles ---- */

static void gaps_are_bridged(void) {
    float row_m[] = {9, 1, 9, 9, 4, 9}, rows_m[6 * 5];
    const uint8_t gaps[] = {1, 0, 1, 1, 0, 1};
    const float wanted_m[] = {1, 1, 2, 3, 4, 4};
    uint8_t row_gaps[6 * 5];
    CU_ASSERT_TRUE(post_gaps_fill(row_m, gaps, 6, 1));
    CU_ASSERT_EQUAL(memcmp(row_m, wanted_m, sizeof row_m), 0);
    memset(row_gaps, 1, sizeof row_gaps);
    CU_ASSERT_FALSE(post_gaps_fill(rows_m, row_gaps, 6, 5));
    for (int32_t i = 0; i < 6 * 5; i++) {
        const bool has_height = i / 6 == 1 || i / 6 == 4;
        rows_m[i] = has_height ? (float)(i / 6) : -1;
        row_gaps[i] = !has_height;
    }
    CU_ASSERT_TRUE(post_gaps_fill(rows_m, row_gaps, 6, 5));
    for (int32_t i = 0; i < 6 * 5; i++) CU_ASSERT_EQUAL(rows_m[i], i / 6 < 3 ? 1 : 4);
}

static void squares_are_split_where_they_bend(void) {
    memset(heights_m, 0, sizeof heights_m);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 129, 129, 0.1), 2);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 257, 129, 0.1), 4);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 2, 2, 0.1), 2);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 130, 129, 0.1), 2 + 2 * 128);
    heights_m[3 * 129 + 3] = 1; /* inside of one square of 4 cells: each split makes 3 squares more */
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 129, 129, 0.1), 2 * (1 + 3 * 7));
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 129, 129, 1), 2);
    for (int32_t i = 0; i < 129 * 129; i++) heights_m[i] = (float)(i % 129 * 3 - i / 129);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, 129, 129, 1e-3), 2);
    fill_fractal(6);
    CU_ASSERT_EQUAL(subdivision_triangles(heights_m, COLUMNS, ROWS, 0), 2ull * (COLUMNS - 1) * (ROWS - 1));
    CU_ASSERT(subdivision_triangles(heights_m, COLUMNS, ROWS, 5) < subdivision_triangles(heights_m, COLUMNS, ROWS, 2));
}

int suite_filter(void) {
    CU_pSuite suite = CU_add_suite("filter", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, planes_stay_planes);
    CU_ADD_TEST(suite, splines_are_the_best);
    CU_ADD_TEST(suite, rows_go_through_the_splines_posts);
    CU_ADD_TEST(suite, zero_thresholds_give_all_back);
    CU_ADD_TEST(suite, thresholds_bound_the_difference);
    CU_ADD_TEST(suite, variants_differ_in_the_middle);
    CU_ADD_TEST(suite, neighbourhoods_are_nine_posts_wide);
    CU_ADD_TEST(suite, steep_hills_keep_their_heights);
    CU_ADD_TEST(suite, class_1_keeps_its_accuracy);
    CU_ADD_TEST(suite, waters_take_their_means);
    CU_ADD_TEST(suite, odd_sizes_and_little_memory);
    CU_ADD_TEST(suite, gaps_are_bridged);
    CU_ADD_TEST(suite, squares_are_split_where_they_bend);
    return 0;
}
