/* A tile's piece of a TIN: a triangulation of the whole tile. Pure.
 *
 * It has the TIN's points in the tile and those of its four sides (lod/tin_side.h), and all edges of the TIN, as far as
 * they lie in the tile: a constrained Delaunay triangulation, so that nothing overlaps whatever rounding did, and what
 * lies outside of the surface and in its holes is triangulated too. There the ground is level at the height outside,
 * with a wall around the surface. Where rounding to the lattice makes edges cross, the later one gives way. */
#ifndef SCREE_LOD_TIN_PIECE_H
#define SCREE_LOD_TIN_PIECE_H

#include "lod/constrained.h"
#include "lod/tin_side.h"

struct tin_piece {
    struct constrained mesh;
    struct tin_post *posts; /* one a point of the mesh */
    uint32_t post_capacity;
    struct tin_side sides[SIDE_COUNT];
};

enum scree_status tin_piece_make(struct scree_memory *memory, const struct tin_lattice *lattice,
                                 const struct tin_tile *tile, struct tin_piece *piece, struct scree_error *error);

/* Fine on a zeroed struct. */
void tin_piece_release(struct scree_memory *memory, struct tin_piece *piece);

#endif
