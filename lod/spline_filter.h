/* L2-best continuous linear splines on ever coarser grids of posts. Pure.
 *
 * After S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi scale analysis"
 * (GRAPP 2015), section 3 and Algorithm 1: a step takes each row, then each column, to the best approximation by hat
 * functions that are twice as wide. The normal equations are tridiagonal and solved by the Thomas algorithm.
 *
 * A line of an even number of posts has no half: it is extended by one post, its last but one reflected at the last, so
 * that a straight line stays one. */
#ifndef SCREE_LOD_SPLINE_FILTER_H
#define SCREE_LOD_SPLINE_FILTER_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define SPLINE_MAX_STEPS 9

/* Posts 2^steps posts apart, row by row from the south-western one; the last ones may lie beyond the source's. */
struct spline {
    int32_t columns, rows; /* at least 2 */
    int32_t steps;
    float *heights_m;
};

/* Coarsens `columns` x `rows` posts (at least 2 each), row by row, in so many steps (1 to SPLINE_MAX_STEPS). Takes 3
 * bytes a post while it works and leaves 4 / 4^steps of them. SCREE_E_ARGUMENT: a number is out of its range. On
 * failure the spline is empty. */
enum scree_status spline_make(struct scree_memory *memory, const float *heights_m, int32_t columns, int32_t rows,
                              int32_t steps, struct spline *spline, struct scree_error *error);

/* Fine on an empty spline, and twice. */
void spline_release(struct scree_memory *memory, struct spline *spline);

/* The spline's heights at the first `columns` posts of row `row` of the source, interpolated over the triangles of
 * lod/square.h. */
void spline_row(const struct spline *spline, int32_t row, int32_t columns, float *heights_m);

#endif
