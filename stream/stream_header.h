/* The header of a stream as bytes. Pure. */
#ifndef SCREE_STREAM_STREAM_HEADER_H
#define SCREE_STREAM_STREAM_HEADER_H

#include <scree/stream.h>

/* Bytes that a header with so many rungs takes. */
size_t stream_header_bound(uint32_t rung_count);

/* Writes the header, whose blocks' sizes and checksums are set; sets size_bytes and every offset_bytes of `header`.
 * Returns the bytes written, 0 when they do not fit. */
size_t stream_header_write(struct scree_stream_header *header, void *bytes, size_t capacity_bytes);

/* Reads a header. SCREE_MORE: not all of it is there yet. SCREE_E_CORRUPT, SCREE_E_UNSUPPORTED: with a line. */
enum scree_status stream_header_read(const void *bytes, size_t size_bytes, struct scree_stream_header *header,
                                     struct scree_error *error);

#endif
