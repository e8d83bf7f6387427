/* From triangles to posts: a TIN, most often that of a cloud, sampled where the posts of a regular grid lie. Pure. */
#ifndef SCREE_LOD_CLOUD_GRID_H
#define SCREE_LOD_CLOUD_GRID_H

#include "lod/tin.h"

/* Posts at whole multiples of the spacing, so that the grids of neighbouring clouds fit together. */
struct cloud_posts {
    double west, south; /* of the first post */
    double spacing;
    int32_t columns, rows;
};

/* The posts within the points' bounds. `spacing` 0: 1, 2 or 5 times a power of ten, the largest that is at most the
 * mean distance of points. SCREE_E_ARGUMENT: fewer than two posts a side; SCREE_E_LIMIT: more than 2^31 in all. */
enum scree_status cloud_posts_choose(const struct cloud *cloud, double spacing, struct cloud_posts *posts,
                                     struct scree_error *error);

/* Heights of all posts, row by row from the south; NaN where a post is outside of all triangles. Where triangles lie
 * one above the other the highest counts; they may be turned either way. Returns how many posts have a height. */
uint64_t tin_sample(const struct tin *tin, const struct cloud_posts *posts, float *heights);

#endif
