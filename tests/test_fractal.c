/* The fractal terrain of the tests: windows agree, seeds differ, and the bits never change. */
#include "tests/fractal.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <string.h>

static void windows_agree_wherever_they_start(void) {
    enum { COLUMNS = 700, ROWS = 40, MARGIN = 9 };
    static float whole_m[COLUMNS * ROWS], part_m[COLUMNS * ROWS];
    struct fractal fractal = {.seed = 42};
    fractal_window(&fractal, -350, -20, COLUMNS, ROWS, whole_m, COLUMNS);
    for (int32_t width = 1; width <= 301; width += 50) {
        memset(part_m, 0xff, sizeof part_m);
        fractal_window(&fractal, -350 + MARGIN * width / 10, -20 + MARGIN, width, ROWS - 2 * MARGIN, part_m, width + 3);
        unsigned different = 0, touched = 0;
        for (int32_t y = 0; y < ROWS - 2 * MARGIN; y++) {
            different += memcmp(part_m + y * (width + 3), whole_m + (y + MARGIN) * COLUMNS + MARGIN * width / 10,
                                (size_t)width * sizeof *part_m) != 0;
            for (int32_t x = width; x < width + 3; x++) touched += !isnan(part_m[y * (width + 3) + x]);
        }
        CU_ASSERT_EQUAL(different, 0);
        CU_ASSERT_EQUAL(touched, 0);
    }
}

static void seeds_and_rounding(void) {
    float one_m[64], other_m[64], whole_m[64];
    fractal_window(&(struct fractal){.seed = 1}, 0, 0, 8, 8, one_m, 8);
    fractal_window(&(struct fractal){.seed = 2}, 0, 0, 8, 8, other_m, 8);
    fractal_window(&(struct fractal){.seed = 1, .whole_metres = true}, 0, 0, 8, 8, whole_m, 8);
    CU_ASSERT_NOT_EQUAL(memcmp(one_m, other_m, sizeof one_m), 0);
    for (int i = 0; i < 64; i++) {
        CU_ASSERT_EQUAL(whole_m[i], floorf(whole_m[i]));
        CU_ASSERT_TRUE(fabsf(whole_m[i] - one_m[i]) <= 0.5f);
    }
}

static void it_is_terrain(void) {
    enum { SIDE = 512 };
    static float heights_m[SIDE * SIDE];
    fractal_window(&(struct fractal){.seed = 1}, INT64_C(1) << 33, -5000, SIDE, SIDE, heights_m, SIDE);
    float lowest_m = INFINITY, highest_m = -INFINITY, steepest_m = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        lowest_m = fminf(lowest_m, heights_m[i]);
        highest_m = fmaxf(highest_m, heights_m[i]);
        if (i % SIDE != 0) steepest_m = fmaxf(steepest_m, fabsf(heights_m[i] - heights_m[i - 1]));
    }
    CU_ASSERT_TRUE(lowest_m >= -500 && highest_m <= 4500);
    CU_ASSERT_TRUE(highest_m - lowest_m > 200);
    CU_ASSERT_TRUE(steepest_m < 100); /* no jump at a cell's border */
}

/* FNV-1a over the bits of the heights. A change of this number is a change of every fractal measurement. */
static void the_bits_stay_the_same(void) {
    static float heights_m[300 * 20];
    fractal_window(&(struct fractal){.seed = 2024}, -150, -10, 300, 20, heights_m, 300);
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < 300 * 20; i++) {
        uint32_t bits;
        memcpy(&bits, &heights_m[i], sizeof bits);
        for (int byte = 0; byte < 4; byte++) hash = (hash ^ (bits >> 8 * byte & 0xff)) * UINT64_C(0x100000001b3);
    }
    CU_ASSERT_EQUAL(hash, UINT64_C(0x675a57384bb4f9d3));
}

int suite_fractal(void) {
    CU_pSuite suite = CU_add_suite("fractal terrain", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, windows_agree_wherever_they_start);
    CU_ADD_TEST(suite, seeds_and_rounding);
    CU_ADD_TEST(suite, it_is_terrain);
    CU_ADD_TEST(suite, the_bits_stay_the_same);
    return 0;
}
