/* Clusters of posts between feature lines, split until each is small and flat; one post of each is kept. Pure.
 *
 * Pauly, Gross and Kobbelt, "Efficient Simplification of Point-Sampled Surfaces" (2002), section 3.1: a cluster with
 * too many points, or of too much surface variation, is cut through its mean across its longest axis. The variation is
 * the least of the three principal variances over their sum: 0 on a plane, 1/3 where no direction is preferred. As in
 * "PS-Hierarchy" of Campos et al. (2020), section 4.3.2, the post nearest to the mean stands for a cluster, so that
 * heights are those of posts. */
#ifndef SCREE_LOD_METHOD_HIERARCHY_H
#define SCREE_LOD_METHOD_HIERARCHY_H

#include "lod/point_set.h"

struct method_hierarchy_options {
    uint32_t most_posts;   /* in a cluster; h_c; at least 1 */
    double most_variation; /* surface variation of a cluster; h_v; 0 to 1/3 */
    struct point_set_options points;
};

enum scree_status method_hierarchy(struct scree_memory *memory, const struct method_tile *tile,
                                   const struct method_hierarchy_options *options, struct method_mesh *mesh,
                                   struct scree_error *error);

#endif
