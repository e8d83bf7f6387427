/* A tile of posts and border lines on its way from fine to coarse, for the methods of the literature, which make a mesh
 * of their own at every zoom. Pure.
 *
 * Its border lines take the very way of those in lod/tile.h, rung by rung, so all methods have the same borders and
 * neighbours agree. A parent's posts are every second one of its children's; where the lattice ends within a cell, the
 * last post stays. */
#ifndef SCREE_LOD_POST_TILE_H
#define SCREE_LOD_POST_TILE_H

#include "lod/tile.h"

struct post_tile {
    struct scree_memory *memory;
    int32_t columns, rows; /* cells; the last ones may be cut by the end of the lattice */
    int32_t cell_span;
    int32_t width, height; /* lattice steps */
    int64_t locked_step;
    float *heights_m; /* (rows + 1) x (columns + 1) */
    struct border_line lines[SIDE_COUNT];
    struct slope_grid slopes;
};

/* The three makers, as those of struct tile; on failure nothing is left to release. */
enum scree_status post_tile_from_posts(struct scree_memory *memory, const struct tile_geometry *geometry,
                                       const struct tile_posts *posts, struct post_tile *tile,
                                       struct scree_error *error);
enum scree_status post_tile_from_level(struct scree_memory *memory, const struct tile_geometry *geometry, int32_t step,
                                       double height_m, struct post_tile *tile, struct scree_error *error);
enum scree_status post_tile_from_children(struct scree_memory *memory, const struct tile_geometry *geometry,
                                          const struct post_tile *const children[4], struct post_tile *tile,
                                          struct scree_error *error);

/* What the parent needs, in a new block: the lines as they are, every second post and slope. */
enum scree_status post_tile_hand_up_new(const struct post_tile *tile, struct post_tile **coarse,
                                        struct scree_error *error);

/* Both are fine on zeroed structs and on NULL. */
void post_tile_release(struct post_tile *tile);
void post_tile_free(struct post_tile *coarse);

#endif
