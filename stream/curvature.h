/* Curvature of terrain at every post, and its sums over the nodes of a quadtree. Pure.
 *
 * After M. V. Cifuentes, M. J. Venere and A. Clausse, "Interactive remeshing for navigation over landscape models",
 * section II: the curvature of a post is the Frobenius norm of the curvature tensor, by central differences of a
 * gradient that is itself made of central differences (eqs. 1 to 3); a node has the sum over its posts (eq. 4).
 *
 * Curvature is a change of slope over two posts, so it has no unit. Over a square whose sides are n posts long, where
 * the second derivatives of height have the norm c, it adds up to 2 c d n^2 (d metres from post to post), and linear
 * interpolation over that square errs by about c (n d)^2 / 8 metres: the sum times d / 16. */
#ifndef SCREE_STREAM_CURVATURE_H
#define SCREE_STREAM_CURVATURE_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CURVATURE_MAX_POSTS 32769 /* a side */
#define CURVATURE_LEVELS    16    /* a node of the last one has 2^15 cells a side */

/* A rectangle of posts on a plane, row by row from the south, west to east. */
struct curvature_posts {
    const float *heights_m; /* of post (0, 0); rows of `stride` floats */
    int32_t columns, rows;  /* posts, 2 to CURVATURE_MAX_POSTS */
    int32_t stride;
    double east_m, north_m;           /* metres from post to post */
    double east_drop_m, north_drop_m; /* drop of the ellipsoid below the tangent plane over one post, squared; 0: the
                                         Earth is flat */
};

/* The curvature of each post of row `y`. At the border, where neighbours are missing, differences to the one side take
 * the place of central ones, scaled to the same distance. */
void curvature_row(const struct curvature_posts *posts, int32_t y, float *curvature);

/* A square of cells, cut to the rectangle. */
struct curvature_node {
    float sum;           /* of its posts' curvatures: those on an edge count half, at a corner a quarter, so that the
                            sum of a node is that of its children */
    float low_m, high_m; /* of its posts, borders included */
};

struct curvature_level {
    int32_t columns, rows;
    struct curvature_node *nodes; /* row by row from the south-west */
};

/* Every node of 2 cells a side and more: a node of level k has 2^k of them, and level[top] is one node. Level 0, the
 * cells, is not kept. */
struct curvature_pyramid {
    int32_t top; /* at least 1 */
    struct curvature_level level[CURVATURE_LEVELS];
};

/* Takes 4 bytes a post. SCREE_E_ARGUMENT where a number of posts, the stride or a distance is out of its range, or a
 * height is no finite number. On failure the pyramid is empty. */
enum scree_status curvature_pyramid_make(struct scree_memory *memory, const struct curvature_posts *posts,
                                         struct curvature_pyramid *pyramid, struct scree_error *error);

/* Fine on an empty pyramid, and twice. */
void curvature_pyramid_release(struct scree_memory *memory, struct curvature_pyramid *pyramid);

#ifdef __cplusplus
}
#endif
#endif
