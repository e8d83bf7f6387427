/* Points between feature lines that drift to where the surface is and away from one another: smooths noise, spreads
 * evenly. Pure.
 *
 * Huang, Li, Zhang, Ascher and Cohen-Or, "Consolidation of Unorganized Point Clouds for Surface Reconstruction" (2009),
 * section 3: the weighted locally optimal projection (WLOP), in metres. A random sample of the posts moves in every
 * iteration to the mean of the posts around it, weighted by exp(-16 r^2 / radius^2) / r and less where posts are dense,
 * and 0.45 times the mean way from the other samples around it, weighted likewise and more where samples are dense.
 * "PS-WLOP" of Campos et al. (2020), section 4.3.2. Points end up off the posts. */
#ifndef SCREE_LOD_METHOD_WLOP_H
#define SCREE_LOD_METHOD_WLOP_H

#include "lod/point_set.h"

#define WLOP_ITERATIONS   15
#define WLOP_RADIUS_CELLS 8
#define WLOP_REACH_CELLS  32 /* posts farther away in the grid are not looked at, whatever the radius */

struct method_wlop_options {
    double kept_percent; /* of the posts between the features; w_p; 0 to 100 */
    double radius_m;     /* of the ball in which neighbours count; w_r; 0: WLOP_RADIUS_CELLS cells */
    int32_t iterations;  /* w_i; 0: WLOP_ITERATIONS */
    struct point_set_options points;
};

enum scree_status method_wlop(struct scree_memory *memory, const struct method_tile *tile,
                              const struct method_wlop_options *options, struct method_mesh *mesh,
                              struct scree_error *error);

#endif
