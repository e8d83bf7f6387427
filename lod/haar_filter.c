/* The Haar transform and its thresholds: see the header. */
#include "lod/haar_filter.h"

#include <math.h>
#include <string.h>

/* Rows 2 * pair and 2 * pair + 1 of the square of `side` means: a step along both rows, then one across the means. */
static void transform_pair(const double *block, int32_t side, int32_t pair, double *room) {
    const double *first = block + 2 * (size_t)pair * HAAR_SIDE, *second = first + HAAR_SIDE;
    double *means = room + (size_t)pair * HAAR_SIDE, *across = room + (size_t)(pair + side / 2) * HAAR_SIDE;
    double *along = room + 2 * (size_t)pair * HAAR_SIDE + side / 2;
    for (int32_t k = 0; k < side / 2; k++) {
        const double upper = (first[2 * k] + first[2 * k + 1]) / 2, lower = (second[2 * k] + second[2 * k + 1]) / 2;
        along[k] = (first[2 * k] - first[2 * k + 1]) / 2;
        along[HAAR_SIDE + k] = (second[2 * k] - second[2 * k + 1]) / 2;
        means[k] = (upper + lower) / 2;
        across[k] = (upper - lower) / 2;
    }
}

/* Where the means of a level begin: 4^0 + 4^1 ... are before them. */
static size_t means_before(int level) {
    return (((size_t)1 << 2 * level) - 1) / 3;
}

void haar_transform(struct haar_block *block) {
    for (int level = HAAR_LEVELS - 1; level >= 0; level--) {
        const int32_t side = 2 << level, half = 1 << level;
        for (int32_t pair = 0; pair < half; pair++) transform_pair(block->coefficients, side, pair, block->room);
        for (int32_t row = 0; row < side; row++) {
            const double *from = block->room + (size_t)row * HAAR_SIDE;
            memcpy(block->coefficients + (size_t)row * HAAR_SIDE, from, (size_t)side * sizeof *from);
            if (row < half)
                memcpy(block->means + means_before(level) + (size_t)row * (size_t)half, from,
                       (size_t)half * sizeof *from);
        }
    }
}

/* The coefficients of level i that a post's height is made of, with the sign that it takes them. */
static double across_of(const double *block, int32_t column, int32_t row, int i) {
    const int shift = HAAR_LEVELS - i;
    const double c = block[(size_t)((1 << i) + (row >> shift)) * HAAR_SIDE + (size_t)(column >> shift)];
    return row >> (shift - 1) & 1 ? -c : c;
}

static double along_of(const double *block, int32_t column, int32_t row, int i) {
    const int shift = HAAR_LEVELS - i;
    const double c = block[(size_t)(row >> (shift - 1)) * HAAR_SIDE + (size_t)((1 << i) + (column >> shift))];
    return column >> (shift - 1) & 1 ? -c : c;
}

/* The mean of the post's square of level i: every coefficient of the levels before. */
static double mean_of(const struct haar_block *block, int32_t column, int32_t row, int i) {
    const int shift = HAAR_LEVELS - i;
    return block->means[means_before(i) + ((size_t)(row >> shift) << i) + (size_t)(column >> shift)];
}

static double sum_each(const struct haar_block *block, int32_t column, int32_t row, const double *thresholds_m) {
    double height_m = block->means[0];
    for (int i = 0; i < HAAR_LEVELS; i++) {
        const double across = across_of(block->coefficients, column, row, i);
        const double along = along_of(block->coefficients, column, row, i);
        if (fabs(across) >= thresholds_m[i]) height_m += across;
        if (fabs(along) >= thresholds_m[i]) height_m += along;
    }
    return height_m;
}

/* From fine to coarse, across before along: the first coefficient that reaches its threshold, and all after it. */
static double sum_tail(const struct haar_block *block, int32_t column, int32_t row, const double *thresholds_m) {
    for (int i = HAAR_LEVELS - 1; i >= 0; i--) {
        const double across = across_of(block->coefficients, column, row, i);
        const double along = along_of(block->coefficients, column, row, i);
        if (fabs(across) >= thresholds_m[i]) return mean_of(block, column, row, i) + across + along;
        if (fabs(along) >= thresholds_m[i]) return mean_of(block, column, row, i) + along;
    }
    return block->means[0];
}

double haar_height_m(const struct haar_block *block, int32_t column, int32_t row,
                     const double thresholds_m[HAAR_LEVELS], enum haar_variant variant) {
    return variant == HAAR_TAIL ? sum_tail(block, column, row, thresholds_m)
                                : sum_each(block, column, row, thresholds_m);
}
