/* From points to posts: the Delaunay triangulation of a cloud, sampled where the posts of a regular grid lie. Pure.
 *
 * The triangulation is exact, on positions rounded to 2^-24 of the longer side or finer; heights are interpolated
 * between the positions as they are. Of points in one place the lowest counts. The result depends on the points alone:
 * they are inserted along a Hilbert curve. Takes about 130 bytes a point at its peak, those of the cloud included. */
#ifndef SCREE_LOD_CLOUD_GRID_H
#define SCREE_LOD_CLOUD_GRID_H

#include "lod/cloud.h"

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

/* Heights of all posts, row by row from the south; NaN where a post is outside of all triangles, or in one that has an
 * edge longer than `longest_edge`. The outline is that of the convex hull but for slivers along it, at most half a per
 * cent as high as they are long. Counts the posts that have a height. */
enum scree_status cloud_sample(const struct cloud *cloud, const struct cloud_posts *posts, double longest_edge,
                               float *heights, uint64_t *covered, struct scree_error *error);

#endif
