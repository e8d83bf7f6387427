/* One random post out of each cell of a coarse grid in space, between feature lines. Pure. "PS-Grid" of Campos et al.,
 * "3D Simplification Methods and Large Scale Terrain Tiling" (2020), section 4.3.2. */
#ifndef SCREE_LOD_METHOD_GRID_H
#define SCREE_LOD_METHOD_GRID_H

#include "lod/point_set.h"

struct method_grid_options {
    double cell_m; /* the side of the cubes that space is divided into; d_g; above 0 */
    struct point_set_options points;
};

enum scree_status method_grid(struct scree_memory *memory, const struct method_tile *tile,
                              const struct method_grid_options *options, struct method_mesh *mesh,
                              struct scree_error *error);

#endif
