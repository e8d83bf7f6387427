/* Streams altered on purpose: sizes and checksums made to fit again, so that an alteration reaches the decoder. */
#ifndef SCREE_TESTS_STREAM_FORGE_H
#define SCREE_TESTS_STREAM_FORGE_H

#include <stddef.h>
#include <stdint.h>

/* Where the fields of a stream's header lie (docs/stream.md). */
enum {
    FORGE_VERSION = 8,
    FORGE_HEADER_BYTES = 10,
    FORGE_PROFILE = 12,
    FORGE_ZOOM = 13,
    FORGE_EXPONENT = 14,
    FORGE_RESERVED = 15,
    FORGE_RUNG_COUNT = 16,
    FORGE_EXTENSION_BYTES = 18,
    FORGE_TILE_X = 20,
    FORGE_TILE_Y = 24,
    FORGE_COLUMNS = 28,
    FORGE_ROWS = 32,
    FORGE_WEST = 36,
    FORGE_METRES_X = 68,
    FORGE_METRES_Y = 76,
    FORGE_RUNGS = 84, /* the first of the rungs; offsets within one: */
    FORGE_RUNG_SIZE = 30,
    FORGE_VERTICES = 2,
    FORGE_TRIANGLES = 6,
    FORGE_MMQE = 10,
    FORGE_SVO = 14,
    FORGE_ERROR = 18,
    FORGE_BLOCK_BYTES = 22,
    FORGE_BLOCK_CHECKSUM = 26
};

/* `width_bytes` bytes at `at`, least significant first. */
void forge_put(unsigned char *at, uint64_t value, int width_bytes);
uint64_t forge_get(const unsigned char *at, int width_bytes);

/* Where block `rung` begins, as the header's sizes have it. */
size_t forge_block(const unsigned char *bytes, uint32_t rung);

/* Makes magic, version and all sizes those of a stream of `size_bytes` bytes, whatever they are now: blocks that reach
 * beyond the end are cut, the last one reaches to the end. Nothing is done where there is no room for a header. */
void forge_sizes(unsigned char *bytes, size_t size_bytes);

/* Makes the checksums true: of the header, and of all blocks that are whole. */
void forge_checksums(unsigned char *bytes, size_t size_bytes);

#endif
