/* Greedy insertion after Garland and Heckbert, "Fast Polygonal Approximation of Terrains and Height Fields" (1995),
 * algorithm IV: the Delaunay triangulation of the posts chosen so far gains, again and again, the post whose vertical
 * error is the largest, until no post is farther than the tolerance from the surface. Pure.
 *
 * It is the reference that other simplifiers are measured against, and a method in its own right. The triangulation
 * is exact (integer predicates); the order of insertion is total (largest error first, ties by triangle slot), so that
 * the mesh depends on nothing but the posts. */
#ifndef SCREE_LOD_GREEDY_H
#define SCREE_LOD_GREEDY_H

#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>

#define GREEDY_MAX_POSTS 8193 /* a side: the in-circle test then stays below 2^56 */

struct greedy_options {
    double tolerance_m;    /* every post ends up at most this far from the surface, measured vertically; >= 0 */
    uint32_t max_vertices; /* stop at so many even if the tolerance is not reached; 0: no limit */
};

/* Triangulates a rectangle of posts.
 *
 * heights_m: rows of `columns` finite heights, `stride` floats from row to row, row 0 being y = 0.
 * columns, rows: 2 to GREEDY_MAX_POSTS.
 * mesh: vertices are posts (x the column, y the row; `height` is 0, the heights being those of the posts), the four
 *     corners first, then in order of insertion; triangles are counter-clockwise with y to the north. Its arrays belong
 *     to `memory`: hand them back with greedy_free. Untouched on failure.
 * max_error_m: the largest vertical error that is left; NULL when nobody asks.
 *
 * The bound is exact where all heights are whole numbers below 2^24. For others each triangle's error carries a bound
 * on its own rounding, and what lies below that (about 1e-10 m) counts as no error. */
enum scree_status greedy_triangulate(const float *heights_m, int columns, int rows, int stride,
                                     const struct greedy_options *options, struct scree_memory *memory,
                                     struct scree_mesh *mesh, double *max_error_m, struct scree_error *error);

/* Gives the mesh's arrays back and leaves it empty; fine on an empty mesh. */
void greedy_free(struct scree_mesh *mesh, struct scree_memory *memory);

#endif
