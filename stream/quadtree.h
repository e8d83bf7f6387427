/* A restricted quadtree over posts, and the mesh that it shows to an observer. Pure.
 *
 * After M. V. Cifuentes, M. J. Venere and A. Clausse, "Interactive remeshing for navigation over landscape models":
 * nodes are merged where the curvature summed over them is small (stream/curvature.h), neighbours differ by one level
 * at the most, each leaf is triangulated by one of a few templates so that leaves conform, and the nearer the observer
 * is, the less curvature a node may have. The hierarchy is made once; a mesh for a position comes out of it in time
 * proportional to the mesh.
 *
 *     struct quadtree tree;
 *     struct quadtree_mesh mesh = {0};
 *     quadtree_make(&memory, &posts, &tree, &error);
 *     for each position:
 *         quadtree_extract(&memory, &tree, &view, &mesh, &error);
 *         ... mesh.mesh: vertices are posts, with their heights ...
 *     quadtree_mesh_release(&memory, &mesh);
 *     quadtree_release(&memory, &tree);
 *
 * Any numbers of posts will do: nodes are cut at the border of the rectangle. */
#ifndef SCREE_STREAM_QUADTREE_H
#define SCREE_STREAM_QUADTREE_H

#include "stream/curvature.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct quadtree {
    struct curvature_posts posts; /* the heights stay the caller's, and have to stay */
    struct curvature_pyramid pyramid;
    uint8_t *split[CURVATURE_LEVELS]; /* which nodes of a level the last mesh has split; scratch */
    uint32_t *number;                 /* of the vertex at each post, plus one; scratch: 0 between extractions */
};

/* Takes 9 bytes a post, heights not counted. Fails as curvature_pyramid_make does; the tree is empty then. */
enum scree_status quadtree_make(struct scree_memory *memory, const struct curvature_posts *posts, struct quadtree *tree,
                                struct scree_error *error);

/* Fine on an empty tree, and twice. */
void quadtree_release(struct scree_memory *memory, struct quadtree *tree);

struct quadtree_view {
    double threshold;  /* nodes whose curvature sums up to more are split; 0: those without any stay whole */
    bool has_observer; /* else the threshold holds everywhere */
    double x, y;       /* the observer's place in posts, which may be outside */
    double height_m;
    double reach_m; /* where the threshold holds as it is: it grows in proportion to the distance from the
                       observer to the box around a node; above 0 */
};

struct quadtree_mesh {
    struct scree_mesh mesh; /* x the column, y the row; `height` is 0, the heights being those of the posts */
    uint32_t vertex_room, triangle_room;
};

/* Makes `mesh` (zeroed, or from an earlier extraction, whose arrays it takes over) the mesh for a view; two different
 * threads need two trees. It depends on nothing but the posts and the view. SCREE_E_ARGUMENT when the view holds
 * numbers that make no sense. On failure the mesh is empty. */
enum scree_status quadtree_extract(struct scree_memory *memory, struct quadtree *tree, const struct quadtree_view *view,
                                   struct quadtree_mesh *mesh, struct scree_error *error);

/* The level of the leaf that holds the cell (x, y) in the last extraction: its sides have 2^level cells. */
int32_t quadtree_leaf_level(const struct quadtree *tree, int32_t x, int32_t y);

/* Fine on an empty mesh, and twice. */
void quadtree_mesh_release(struct scree_memory *memory, struct quadtree_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
