/* What the ways to make a tile (lod/tile.h) have in common. Pure. */
#ifndef SCREE_LOD_TILE_PARTS_H
#define SCREE_LOD_TILE_PARTS_H

#include "lod/tile.h"

/* The beginning of every tile; it is to be released from here on. */
enum scree_status tile_begin(struct scree_memory *memory, const struct tile_geometry *geometry, struct tile *tile,
                             struct scree_error *error);

/* Samples without heights: where they are, and the drop of the ellipsoid. */
struct samples tile_own_samples(const struct tile *tile);

int32_t tile_height_units(const struct tile *tile, double height_m);

/* Gives the mesh's vertices the heights that are counted in units. */
void tile_place_vertices(struct tile *tile);

/* The full grid of a tile, with alternating diagonals; `step` lattice steps from post to post. */
enum scree_status tile_make_grid(struct tile *tile, int32_t step, struct scree_error *error);

/* The border line of such a grid: heights `stride` floats apart. */
void tile_start_line(struct tile *tile, enum tile_side side, int32_t step, const float *heights_m, int32_t stride);

/* Makes what will be handed up; its extremes and slopes are to be filled. */
enum scree_status tile_begin_rest(struct tile *tile, struct scree_error *error);

void tile_hand_up_slopes(struct tile *tile);

/* Once mesh and samples are there. */
enum scree_status tile_begin_simplifier(struct tile *tile, struct scree_error *error);

#endif
