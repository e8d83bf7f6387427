/* Cuts of the quadtree: tiles of any zooms that do not overlap, as a viewer draws them, and who lies beside whom.
 *
 * A cut is a plain array sorted by scree_tile_compare. scree_select hands its tiles out in this order. */
#ifndef SCREE_CUT_H
#define SCREE_CUT_H

#include <scree/player.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SCREE_MAX_ZOOM 30

struct scree_tile_id {
    int32_t zoom; /* 0 .. SCREE_MAX_ZOOM */
    uint32_t x;   /* from the west: below 2^zoom, in the geodetic profile below 2^(zoom + 1) */
    uint32_t y;   /* from the south: below 2^zoom */
};

/* The order along the Z curve from the south-west; a tile comes just before those within it. Negative, 0 or positive;
 * 0 for the same tile only. */
SCREE_API int scree_tile_compare(const struct scree_tile_id *a, const struct scree_tile_id *b);

/* The tiles of a cut that share a piece of one side of `tile`, from west to east or from south to north, as indices
 * into `cut`. On the globe the westernmost column is the eastern neighbour of the easternmost. Returns how many there
 * are, of which at most `capacity` are written; there are never more than the cut has tiles. `tile` itself need not be
 * part of the cut. */
SCREE_API uint32_t scree_cut_neighbours(const struct scree_tile_id *cut, uint32_t count, enum scree_profile profile,
                                        const struct scree_tile_id *tile, enum scree_side side, uint32_t *neighbours,
                                        uint32_t capacity);

#ifdef __cplusplus
}
#endif
#endif
