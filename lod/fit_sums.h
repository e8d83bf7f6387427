/* What the samples inside a triangle say about the height of one of its corners: the sums of a least-squares fit, the
 * largest distance, and the heights within a bound. Pure.
 *
 * Every sample counts once in a mesh: one on an edge belongs to the triangle above or to the right of it, one at a
 * vertex to the triangle that the eastward ray from there enters. So samples on the northern and eastern border of a
 * tile belong to none; the border is not fitted, and their errors never change. */
#ifndef SCREE_LOD_FIT_SUMS_H
#define SCREE_LOD_FIT_SUMS_H

#include "lod/samples.h"

/* r: how far a sample is above the triangle; w: its weight of the corner, 1 there and 0 on the opposite side. */
struct fit_sums {
    double ww, wr, rr_m2;
    double max_m;      /* of |r| */
    double rounding_m; /* what the rounding of positions may add, see struct samples */
};

/* Adds a counter-clockwise triangle of positive area to the sums; max_m and rounding_m become the larger ones. */
void fit_add_triangle(const struct samples *samples, const struct sample *corner, const struct sample *b,
                      const struct sample *c, struct fit_sums *sums);

/* Narrows [low, high], how far the corner may move up, to what leaves no sample farther than `limit_m`. */
void fit_narrow(const struct samples *samples, const struct sample *corner, const struct sample *b,
                const struct sample *c, double limit_m, double *low_m, double *high_m);

#endif
