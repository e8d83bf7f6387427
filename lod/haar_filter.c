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

void haar_transform(double *block, double *room) {
    for (int32_t side = HAAR_SIDE; side > 1; side /= 2) {
        for (int32_t pair = 0; pair < side / 2; pair++) transform_pair(block, side, pair, room);
        for (int32_t row = 0; row < side; row++)
            memcpy(block + (size_t)row * HAAR_SIDE, room + (size_t)row * HAAR_SIDE, (size_t)side * sizeof *block);
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

static double sum_each(const double *block, int32_t column, int32_t row, const double *thresholds_m) {
    double height_m = block[0];
    for (int i = 0; i < HAAR_LEVELS; i++) {
        const double across = across_of(block, column, row, i), along = along_of(block, column, row, i);
        if (fabs(across) >= thresholds_m[i]) height_m += across;
        if (fabs(along) >= thresholds_m[i]) height_m += along;
    }
    return height_m;
}

static double sum_tail(const double *block, int32_t column, int32_t row, const double *thresholds_m) {
    int most_along = HAAR_LEVELS - 1, most_across = HAAR_LEVELS - 1; /* m_1 and m_2 of the paper */
    while (most_across >= 0 && fabs(across_of(block, column, row, most_across)) < thresholds_m[most_across])
        most_across--;
    while (most_along >= 0 && fabs(along_of(block, column, row, most_along)) < thresholds_m[most_along]) most_along--;
    const int last_across = most_along - 1 > most_across ? most_along - 1 : most_across;
    const int last_along = most_along > most_across ? most_along : most_across;
    double height_m = block[0];
    for (int i = 0; i <= last_along; i++) {
        if (i <= last_across) height_m += across_of(block, column, row, i);
        height_m += along_of(block, column, row, i);
    }
    return height_m;
}

double haar_height_m(const double *block, int32_t column, int32_t row, const double thresholds_m[HAAR_LEVELS],
                     enum haar_variant variant) {
    return variant == HAAR_TAIL ? sum_tail(block, column, row, thresholds_m)
                                : sum_each(block, column, row, thresholds_m);
}
