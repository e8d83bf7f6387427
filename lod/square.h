/* A square of four posts drawn as two triangles: which diagonal, and how high they are in between. Pure.
 *
 * After S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi scale analysis"
 * (GRAPP 2015), section 2 and eq. 1: the diagonal leaves out the post that differs most from the mean of the four. */
#ifndef SCREE_LOD_SQUARE_H
#define SCREE_LOD_SQUARE_H

#include <math.h>
#include <stdbool.h>

/* Heights of the posts at the west or east, south or north corner. */
struct square {
    float sw_m, se_m, nw_m, ne_m;
    bool is_rising; /* the diagonal goes from the south-west to the north-east */
};

static inline struct square square_of(float sw_m, float se_m, float nw_m, float ne_m) {
    const float mean_m = (sw_m + se_m + nw_m + ne_m) / 4;
    const float rising_m = fmaxf(fabsf(sw_m - mean_m), fabsf(ne_m - mean_m));
    const float falling_m = fmaxf(fabsf(se_m - mean_m), fabsf(nw_m - mean_m));
    return (struct square){sw_m, se_m, nw_m, ne_m, rising_m <= falling_m};
}

/* The height at x, y in 0..1 from the south-western post. */
static inline float square_height_m(const struct square *square, float x, float y) {
    if (square->is_rising)
        return x >= y ? square->sw_m + x * (square->se_m - square->sw_m) + y * (square->ne_m - square->se_m)
                      : square->sw_m + y * (square->nw_m - square->sw_m) + x * (square->ne_m - square->nw_m);
    return x + y <= 1
               ? square->sw_m + x * (square->se_m - square->sw_m) + y * (square->nw_m - square->sw_m)
               : square->ne_m + (1 - x) * (square->nw_m - square->ne_m) + (1 - y) * (square->se_m - square->ne_m);
}

#endif
