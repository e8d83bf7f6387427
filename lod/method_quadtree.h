/* `quadtree`: the restricted quadtree of Cifuentes, Venere and Clausse (stream/quadtree.h) between given borders. Pure.
 *
 * The leaves of the tile's own posts are triangulated without regard to the lines; then the vertices of the lines are
 * put in, by fans of the triangles on the border, and what the lines do not keep is taken out, ear by ear. */
#ifndef SCREE_LOD_METHOD_QUADTREE_H
#define SCREE_LOD_METHOD_QUADTREE_H

#include "lod/method.h"

struct method_quadtree_options {
    double threshold; /* q_k: the largest sum of curvature (eq. 4, no unit) of a node that stays whole; >= 0 */
};

/* The threshold at which a node of even curvature errs by `error_m`. Terrain is not even: the largest error comes out
 * at two to five times as much, the RMS below a half. One threshold for all zooms makes errors that halve with each. */
double method_quadtree_threshold(const struct method_tile *tile, double error_m);

enum scree_status method_quadtree(struct scree_memory *memory, const struct method_tile *tile,
                                  const struct method_quadtree_options *options, struct method_mesh *mesh,
                                  struct scree_error *error);

#endif
