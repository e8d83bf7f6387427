/* Low-pass filtering of heights by thresholds on coefficients of the Haar wavelet. Pure.
 *
 * After S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi scale analysis"
 * (GRAPP 2015), section 4: the non-standard transform (their Algorithms 2 and 3) with Kopp and Purgathofer's change
 * (columns of means only), and both reconstructions of single heights: each coefficient for itself (eq. 3), or all up
 * to the finest that reaches its threshold (eq. 4).
 *
 * Blocks of 512 x 512 posts are transformed by themselves: a grid of m such blocks a side is their m * 2^9 posts.
 * Coefficients are doubles, in which the sums and differences of whole steps of a common size are exact. */
#ifndef SCREE_LOD_HAAR_FILTER_H
#define SCREE_LOD_HAAR_FILTER_H

#include <stdint.h>

#define HAAR_LEVELS 9
#define HAAR_SIDE   (1 << HAAR_LEVELS)

enum haar_variant {
    HAAR_TAIL, /* eq. 4: only what is finer than every coefficient that reaches its threshold is left out */
    HAAR_EACH  /* eq. 3: whatever stays below its threshold is left out */
};

#define HAAR_MEANS ((HAAR_SIDE * HAAR_SIDE - 1) / 3)

struct haar_block {
    double coefficients[HAAR_SIDE * HAAR_SIDE]; /* rows; heights, until they are transformed */
    double means[HAAR_MEANS];                   /* of 1, 2 x 2, 4 x 4 ... squares: all coarser coefficients summed up */
    double room[HAAR_SIDE * HAAR_SIDE];         /* for the transform */
};

/* Transforms the heights in `coefficients` in place. */
void haar_transform(struct haar_block *block);

/* The filtered height of a post of the block. thresholds_m[i] is for the coefficients of level i, 0 the coarsest; zeros
 * give the height back. */
double haar_height_m(const struct haar_block *block, int32_t column, int32_t row,
                     const double thresholds_m[HAAR_LEVELS], enum haar_variant variant);

#endif
