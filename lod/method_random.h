/* Random points between feature lines: what any other method should beat. Pure. "PS-Random" of Campos et al., "3D
 * Simplification Methods and Large Scale Terrain Tiling" (2020), section 4.3.2. */
#ifndef SCREE_LOD_METHOD_RANDOM_H
#define SCREE_LOD_METHOD_RANDOM_H

#include "lod/point_set.h"

struct method_random_options {
    double removed_percent; /* of the posts between the features; r_r; 0 to 100 */
    struct point_set_options points;
};

/* Exactly the percentage goes, rounded to whole posts; each set of posts is as likely as any other. */
enum scree_status method_random(struct scree_memory *memory, const struct method_tile *tile,
                                const struct method_random_options *options, struct method_mesh *mesh,
                                struct scree_error *error);

#endif
