/* What a TIN leaves along a side of a tile: a line of posts that both tiles of the side know. Pure.
 *
 * The line has the corners of the tile, what the TIN's edges leave where they cross it, and where the surface ends the
 * foot of the wall around it; along the level ground outside of it also posts at whole multiples of a step, as a tile
 * without data has them. It depends on nothing but the triangles that touch the side. */
#ifndef SCREE_LOD_TIN_SIDE_H
#define SCREE_LOD_TIN_SIDE_H

#include "lod/border.h"
#include "lod/tin_patch.h"

/* Where a tile lies in its frame, and what is outside of the surface. */
struct tin_tile {
    int32_t column, row;   /* of the frame's tiles */
    int32_t columns, rows; /* lattice steps that the tile covers: fewer than a whole one's at the lattice's end */
    int32_t level_step;    /* between posts on level ground: divides the sides of a whole tile */
    int32_t wall_steps;
    float outside_m;
};

struct tin_side {
    struct tin_post *posts; /* from the west or the south on, both corners included */
    uint32_t count, capacity;
};

/* SCREE_E_LIMIT when there would be more than BORDER_MAX_VERTICES. */
enum scree_status tin_side_make(const struct tin_patch *patch, const struct tin_tile *tile, enum tile_side which,
                                struct tin_side *side, struct scree_error *error);

/* Fine on a zeroed struct. */
void tin_side_release(struct scree_memory *memory, struct tin_side *side);

#endif
