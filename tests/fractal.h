/* Terrain by code: seeded fractal mountains whose height at any post follows from its coordinates alone, so that any
 * window of an endless raster can be made by itself, with the same bits on every machine. Pure.
 *
 * At about 30 m from post to post it looks like, and simplifies like, a mountain range with plains in between. */
#ifndef SCREE_TESTS_FRACTAL_H
#define SCREE_TESTS_FRACTAL_H

#include <stdbool.h>
#include <stdint.h>

struct fractal {
    uint64_t seed;
    bool whole_metres; /* round the heights, as integer rasters do */
};

/* Fills `rows` rows of `columns` heights in metres from post (x, y) on; `stride` floats from row to row, x to the east,
 * y to the north. Heights lie between -500 and 4500 m. Coordinates may be negative and up to 2^40. */
void fractal_window(const struct fractal *fractal, int64_t x, int64_t y, int32_t columns, int32_t rows,
                    float *heights_m, int32_t stride);

#endif
