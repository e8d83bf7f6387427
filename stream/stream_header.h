/* The header of a stream as bytes. Pure.
 *
 * What a reader lets pass is consistent, so that whoever decodes may size things by it:
 * - the tile: a zoom of 0 .. 30 and a number of it, 1 .. SCREE_MAX_TILE_STEPS columns and rows, positive spacings,
 *   height steps of 2^-30 .. 2^30 m; geodetic: within -180 .. 180 and -90 .. 90 degrees; local: coordinates within
 *   +-10^15 units and sides of at most 10^9 m;
 * - the base mesh triangulates a rectangle: at least 4 vertices, and with v vertices v - 2 .. 2 v - 6 triangles;
 * - an increment adds between as many and twice as many triangles as vertices;
 * - the finest mesh has at most SCREE_MAX_VERTICES vertices, and no more than the tile has posts;
 * - a block of n bytes adds at most STREAM_VERTICES_PER_BYTE x n vertices (four of the base mesh, its corners, are
 *   free), so memory is at most a multiple of the bytes that came;
 * - rungs ascend; MMQE, SVO and max error are finite and not negative; SVO does not grow with detail. */
#ifndef SCREE_STREAM_STREAM_HEADER_H
#define SCREE_STREAM_STREAM_HEADER_H

#include <scree/stream.h>

#define STREAM_VERTICES_PER_BYTE 16 /* level ground with a vertex on every post has 2, terraces up to 6 */

/* Bytes that a header with so many rungs takes. */
size_t stream_header_bound(uint32_t rung_count);

/* Writes the header, whose blocks' sizes and checksums are set; sets version, size_bytes and every offset_bytes of
 * `header`. Returns the bytes written, 0 when they do not fit: the capacity, or a number its field. */
size_t stream_header_write(struct scree_stream_header *header, void *bytes, size_t capacity_bytes);

/* Reads a header. SCREE_MORE: not all of it is there yet. SCREE_E_CORRUPT, SCREE_E_UNSUPPORTED: with a line. `header`
 * is whole after SCREE_OK only. */
enum scree_status stream_header_read(const void *bytes, size_t size_bytes, struct scree_stream_header *header,
                                     struct scree_error *error);

#endif
