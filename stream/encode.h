/* From a recorded simplification to the bytes of a stream. Pure. */
#ifndef SCREE_STREAM_ENCODE_H
#define SCREE_STREAM_ENCODE_H

#include "stream/memory.h"
#include "stream/recording.h"
#include <scree/stream.h>

/* What a block's bits were spent on, for measurements. */
struct encode_bits {
    double connectivity, position, height; /* connectivity: order and polygons */
};

struct encode_options {
    uint32_t rungs_per_increment; /* merges so many rungs into one block; 0: 1 */
    struct encode_bits *bits;     /* gets the sums over all blocks; NULL: not wanted */
};

/* Encodes a tile. `place` tells all of the header but its rungs; the bytes are released with scree_release. The same
 * recording gives the same bytes. SCREE_E_ARGUMENT when the recording is not one of a triangulated rectangle. */
enum scree_status stream_encode_new(struct scree_memory *memory, const struct scree_stream_header *place,
                                    const struct recording *recording, const struct encode_options *options,
                                    unsigned char **bytes, size_t *size_bytes, struct scree_error *error);

#endif
