/* Where a tile is, as the header of its stream says it. Pure. */
#ifndef SCREE_STREAM_PLACE_H
#define SCREE_STREAM_PLACE_H

#include "src/ladder.h"
#include <scree/stream.h>

/* All of a header but its rungs. */
void stream_place(const struct lattice *lattice, const struct ladder *ladder, struct tile_id id,
                  struct scree_stream_header *place);

/* Heights are multiples of 2 to this power, in metres. */
int32_t stream_height_exponent(const struct ladder *ladder);

#endif
