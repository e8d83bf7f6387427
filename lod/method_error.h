/* How far a method's mesh is from the posts of its tile: every post looked at, nothing sampled. Pure.
 *
 * The judge of all methods, so it shares no code with any of them. Vertices need not be at posts (lod/grid_error.h is
 * for those that are); distances are vertical, less the drop of the ellipsoid, so that the sagitta of a flat triangle
 * of a globe counts. */
#ifndef SCREE_LOD_METHOD_ERROR_H
#define SCREE_LOD_METHOD_ERROR_H

#include "lod/method.h"
#include <stdbool.h>

struct method_error {
    double max_m;                    /* HUGE_VAL where a height is no number */
    double rms_m, mean_m;            /* of the distances, each covered post counted once */
    double sum_squares_m2;           /* the same, for adding up tiles */
    int32_t max_column, max_row;     /* the post of max_m */
    int64_t posts_covered;           /* posts that lie in a triangle, its border included */
    uint32_t triangles_without_area; /* seen from above: flat or clockwise */
    bool areas_add_up;               /* to the tile's, to one part in 10^9 */
    bool covers;                     /* no triangle without area, areas add up, every post covered */
};

/* Compares the mesh of a method with the tile that it was made of. Works to 10^-9 of a cell: a post that is no farther
 * than that from a triangle lies in it, and a triangle that is no higher than that is left to its neighbours. A mesh
 * that names vertices which it has not, or whose vertices lie outside of the tile or nowhere, is SCREE_E_ARGUMENT. */
enum scree_status method_error_measure(struct scree_memory *memory, const struct method_tile *tile,
                                       const struct method_mesh *mesh, struct method_error *result,
                                       struct scree_error *error);

#endif
