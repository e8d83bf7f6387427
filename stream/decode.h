/* From the blocks of a stream to splits, one block after the other. Pure.
 *
 * What comes out of any bytes is bounded and consistent: every index names something earlier, every triangle is
 * counter-clockwise in the lattice plane, and counts are those of the header; else SCREE_E_CORRUPT. */
#ifndef SCREE_STREAM_DECODE_H
#define SCREE_STREAM_DECODE_H

#include "stream/memory.h"
#include "stream/progressive.h"
#include <scree/stream.h>

struct stream_decoder;

/* `header`, as read by stream_header_read, stays the caller's and must live as long as the decoder. All memory comes
 * from `memory`; what is needed is known from the header and checked against the blocks' sizes first. */
enum scree_status stream_decoder_new(struct scree_memory *memory, const struct scree_stream_header *header,
                                     struct stream_decoder **decoder, struct scree_error *error);
void stream_decoder_free(struct stream_decoder *decoder);

/* Decodes the next block: the first call the base mesh, each further one an increment. `bytes` are the whole block,
 * whose checksum has been looked at. After a failure `progressive` is as it was and the decoder takes no more. */
enum scree_status stream_decode_block(struct stream_decoder *decoder, const void *bytes, size_t size_bytes,
                                      struct scree_error *error);

/* What has been decoded; owned by the decoder. Arrays do not move, but for fix-ups. */
const struct progressive *stream_decoded(const struct stream_decoder *decoder);

#endif
