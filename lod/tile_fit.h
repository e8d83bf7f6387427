/* Tiles' meshes fitted for their static form; the tiles go on with their own, so that streams know nothing of it.
 * Pure.
 *
 * A tile of the finest zoom is fitted to its posts. A coarser one is the union of its children at their coarsest rung,
 * and so is its fitted mesh: each child is fitted to its own samples there, which are finer than the parent's, and the
 * lines between them stay as their neighbours know them. */
#ifndef SCREE_LOD_TILE_FIT_H
#define SCREE_LOD_TILE_FIT_H

#include "lod/tile.h"

/* Fits a copy of the tile's mesh (lod/fit.h) within the tolerance, for writing in `codes`. `fitted` belongs to the
 * tile's memory; on failure it is empty. */
enum scree_status tile_fit_new(const struct tile *tile, struct code_frame codes, double tolerance_m,
                               struct fitted_tile *fitted, struct scree_error *error);

/* The union of what was fitted of the children from which the tile was made. */
enum scree_status tile_fit_join_new(const struct tile *tile, const struct coarse_tile *const children[4],
                                    struct fitted_tile *fitted, struct scree_error *error);

/* Fine on an empty one. */
void fitted_tile_release(struct scree_memory *memory, struct fitted_tile *fitted);

#endif
