/* A city's ground by code: flat fields, a railway's embankment, a river, a road over a bridge with its ramps, a heap
 * and a wood, under the noise of a scanner. What S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of
 * terrain data based on multi scale analysis" (GRAPP 2015), section 6, have in theirs. Pure. */
#ifndef SCREE_TESTS_CITY_MAKER_H
#define SCREE_TESTS_CITY_MAKER_H

#include <stddef.h>
#include <stdint.h>

enum { CITY_SIDE = 5 * 128 + 1, CITY_POSTS = CITY_SIDE * CITY_SIDE };

/* Heights in metres, x to the east, y to the north, and of each post its bits of enum ground_use
 * (lod/context_filter.h). */
void city_make(uint64_t seed, float *heights_m, uint8_t *uses);

/* The same uses as outlines: rings of corners in posts, x and y, not closed. The water goes on under the bridge. */
enum { CITY_OUTLINES = 6, CITY_CORNERS = 2 * CITY_SIDE + 4 };

struct city_outline {
    uint8_t use; /* the bit */
    size_t count;
    double corners[CITY_CORNERS][2];
};

void city_outline(int which, struct city_outline *outline);

#endif
