#include "tests/stream_forge.h"

#include <scree/stream.h>
#include <string.h>
#include <zlib.h>

enum { CHECKSUM_BYTES = 4 };

void forge_put(unsigned char *at, uint64_t value, int width_bytes) {
    for (int i = 0; i < width_bytes; i++) at[i] = (unsigned char)(value >> (8 * i));
}

uint64_t forge_get(const unsigned char *at, int width_bytes) {
    uint64_t value = 0;
    for (int i = 0; i < width_bytes; i++) value |= (uint64_t)at[i] << (8 * i);
    return value;
}

size_t forge_block(const unsigned char *bytes, uint32_t rung) {
    size_t at_bytes = (size_t)forge_get(bytes + FORGE_HEADER_BYTES, 2);
    for (uint32_t i = 0; i < rung; i++)
        at_bytes += (size_t)forge_get(bytes + FORGE_RUNGS + i * FORGE_RUNG_SIZE + FORGE_BLOCK_BYTES, 4);
    return at_bytes;
}

void forge_sizes(unsigned char *bytes, size_t size_bytes) {
    static const unsigned char magic[8] = {0x89, 'S', 'c', 'r', 'e', 'e', '\r', '\n'};
    const size_t least_bytes = FORGE_RUNGS + FORGE_RUNG_SIZE + CHECKSUM_BYTES;
    if (size_bytes < least_bytes) return;
    uint64_t rungs = forge_get(bytes + FORGE_RUNG_COUNT, 2), room = (size_bytes - least_bytes) / FORGE_RUNG_SIZE + 1;
    if (rungs < 1) rungs = 1;
    if (rungs > room) rungs = room;
    if (rungs > SCREE_MAX_RUNGS) rungs = SCREE_MAX_RUNGS;
    size_t extension_bytes = (size_t)forge_get(bytes + FORGE_EXTENSION_BYTES, 2);
    size_t header_bytes = FORGE_RUNGS + FORGE_RUNG_SIZE * (size_t)rungs + CHECKSUM_BYTES;
    if (extension_bytes > size_bytes - header_bytes || header_bytes + extension_bytes > UINT16_MAX) extension_bytes = 0;
    header_bytes += extension_bytes;
    memcpy(bytes, magic, sizeof magic);
    forge_put(bytes + FORGE_VERSION, SCREE_STREAM_VERSION, 2);
    forge_put(bytes + FORGE_HEADER_BYTES, header_bytes, 2);
    forge_put(bytes + FORGE_RUNG_COUNT, rungs, 2);
    forge_put(bytes + FORGE_EXTENSION_BYTES, extension_bytes, 2);
    size_t left_bytes = size_bytes - header_bytes;
    for (uint64_t i = 0; i < rungs; i++) {
        unsigned char *block_bytes = bytes + FORGE_RUNGS + i * FORGE_RUNG_SIZE + FORGE_BLOCK_BYTES;
        size_t stated_bytes = (size_t)forge_get(block_bytes, 4);
        if (stated_bytes > left_bytes || i == rungs - 1) stated_bytes = left_bytes;
        forge_put(block_bytes, stated_bytes, 4);
        left_bytes -= stated_bytes;
    }
}

void forge_checksums(unsigned char *bytes, size_t size_bytes) {
    if (size_bytes < FORGE_RUNGS + CHECKSUM_BYTES) return;
    size_t header_bytes = (size_t)forge_get(bytes + FORGE_HEADER_BYTES, 2), at_bytes = header_bytes;
    uint64_t rungs = forge_get(bytes + FORGE_RUNG_COUNT, 2);
    if (header_bytes > size_bytes || header_bytes < FORGE_RUNGS + FORGE_RUNG_SIZE * rungs + CHECKSUM_BYTES) return;
    for (uint64_t i = 0; i < rungs; i++) {
        unsigned char *rung = bytes + FORGE_RUNGS + i * FORGE_RUNG_SIZE;
        size_t block_bytes = (size_t)forge_get(rung + FORGE_BLOCK_BYTES, 4);
        if (block_bytes > size_bytes - at_bytes) break;
        forge_put(rung + FORGE_BLOCK_CHECKSUM, crc32(0, bytes + at_bytes, (uInt)block_bytes), 4);
        at_bytes += block_bytes;
    }
    forge_put(bytes + header_bytes - CHECKSUM_BYTES, crc32(0, bytes, (uInt)(header_bytes - CHECKSUM_BYTES)), 4);
}
