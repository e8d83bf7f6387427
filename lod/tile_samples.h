/* Samples of a TIN's tiles on their way up. Pure.
 *
 * A tile of a TIN is measured against all of its points. As long as the tiles above still get more cells (keeps_cells
 * of struct tile_geometry) they have all points of their children; from there on, like any coarse tile, the lowest and
 * the highest of each cell. */
#ifndef SCREE_LOD_TILE_SAMPLES_H
#define SCREE_LOD_TILE_SAMPLES_H

#include "lod/tile.h"

/* Whether one of the children, NULL outside of the lattice, hands up all of its samples. */
bool tile_samples_are_whole(const struct coarse_tile *const children[4]);

/* Gives a tile all samples of such children, and of the others what they hand up. */
enum scree_status tile_samples_join(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error);

/* What a tile with any number of samples a cell leaves to its parent: pairs, now; or all of them, when it is handed
 * up. */
void tile_samples_leave_pairs(struct tile *tile);
void tile_samples_hand_up(struct tile *tile);

#endif
