/* Which tiles show the whole terrain once at a zoom. Pure.
 *
 * All tiles of the zoom; and where a coarser tile has a child without a file (the data do not touch it), that tile's
 * quarter there. A tile at its finest rung is the union of its children at their coarsest, so no triangle of it crosses
 * into another quarter; a tile that has no children at all is shown whole. */
#ifndef SCREE_STREAM_COVER_H
#define SCREE_STREAM_COVER_H

#include "src/lattice.h"
#include "src/tile_list.h"
#include "stream/memory.h"
#include <scree/error.h>

struct stream_piece {
    struct tile_id id;
    bool is_part;                 /* of a coarser zoom: shown at the tile's finest rung */
    struct lattice_window window; /* what of the tile is shown: a quarter, or all that it covers */
};

struct stream_cover {
    uint32_t count, room;
    struct stream_piece *pieces;
};

/* `tiles` are those of all zooms, each sorted. The cover is to be freed in any case. */
enum scree_status stream_cover_new(struct scree_memory *memory, const struct lattice *lattice,
                                   const struct tile_list tiles[MAX_ZOOM + 1], int min_zoom, int zoom,
                                   struct stream_cover *cover, struct scree_error *error);
void stream_cover_free(struct scree_memory *memory, struct stream_cover *cover);

/* The child of a tile in the order south-west, south-east, north-west, north-east. */
struct tile_id stream_child(struct tile_id id, int child);

#endif
