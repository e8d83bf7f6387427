/* `greedy`: Garland and Heckbert's greedy insertion between given borders, as in Campos et al. (2020), section 4.1.
 * Pure.
 *
 * The Delaunay triangulation of the border vertices, and of an initial grid where one is asked for, gains the inner
 * post with the largest vertical error until none is beyond the tolerance. Errors are vertical, less the drop of the
 * ellipsoid. */
#ifndef SCREE_LOD_METHOD_GREEDY_H
#define SCREE_LOD_METHOD_GREEDY_H

#include "lod/method.h"

#define GREEDY_MAX_CELLS 8192 /* a side */

struct method_greedy_options {
    double tolerance_m;    /* g_e: no inner post ends up farther from the surface; >= 0 */
    int32_t grid_cells;    /* g_g: cells a side of the grid of posts to begin with; 0 and 1: none */
    uint32_t max_vertices; /* stop at so many, border included, even if the tolerance is not reached; 0: no limit */
};

enum scree_status method_greedy(struct scree_memory *memory, const struct method_tile *tile,
                                const struct method_greedy_options *options, struct method_mesh *mesh,
                                struct scree_error *error);

#endif
