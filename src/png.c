/* Pictures as PNG files (ISO/IEC 15948): see the header. */
#include "src/png.h"

#include <string.h>
#include <zlib.h>

#define CHUNK_EXTRA_BYTES 12 /* length, kind, checksum */
#define HEADER_BYTES      13

static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

static void put_u32(unsigned char *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* Closes the chunk whose data have been written behind `at + 8`. */
static unsigned char *end_chunk(unsigned char *at, const char kind[5], size_t data_bytes) {
    put_u32(at, (uint32_t)data_bytes);
    memcpy(at + 4, kind, 4);
    put_u32(at + 8 + data_bytes, (uint32_t)crc32(0, at + 4, (uInt)(4 + data_bytes)));
    return at + CHUNK_EXTRA_BYTES + data_bytes;
}

/* Every row with the number of its filter before it: each byte less the one of the pixel to the left. */
static void filter_rows(const uint8_t *rgb, uint32_t width_px, uint32_t height_px, unsigned char *rows) {
    size_t row_bytes = 3 * (size_t)width_px;
    for (uint32_t y = 0; y < height_px; y++) {
        const uint8_t *from = rgb + y * row_bytes;
        unsigned char *to = rows + y * (row_bytes + 1);
        *to++ = 1;
        for (size_t i = 0; i < row_bytes; i++) to[i] = (unsigned char)(from[i] - (i < 3 ? 0 : from[i - 3]));
    }
}

enum scree_status png_encode_new(struct scree_memory *memory, const uint8_t *rgb, uint32_t width_px, uint32_t height_px,
                                 unsigned char **bytes, size_t *size_bytes, struct scree_error *error) {
    if (width_px < 1 || height_px < 1 || width_px > PNG_MOST_PX || height_px > PNG_MOST_PX)
        return scree_fail(error, SCREE_E_ARGUMENT, "a picture of %u x %u pixels cannot be written", (unsigned)width_px,
                          (unsigned)height_px);
    size_t rows_bytes = (3 * (size_t)width_px + 1) * height_px;
    uLong packed_bytes = compressBound((uLong)rows_bytes);
    enum scree_status status = SCREE_E_MEMORY;
    unsigned char *rows = scree_allocate(memory, rows_bytes, 1, "a picture", error);
    unsigned char *file = scree_allocate(memory, sizeof signature + 3 * CHUNK_EXTRA_BYTES + HEADER_BYTES + packed_bytes,
                                         1, "a picture", error);
    if (rows == NULL || file == NULL) goto cleanup;
    memcpy(file, signature, sizeof signature);
    unsigned char *at = file + sizeof signature;
    put_u32(at + 8, width_px);
    put_u32(at + 12, height_px);
    memcpy(at + 16, "\x08\x02\x00\x00\x00", 5); /* 8 bits a channel, red green blue, deflate, filters, no interlace */
    at = end_chunk(at, "IHDR", HEADER_BYTES);
    filter_rows(rgb, width_px, height_px, rows);
    if (compress2(at + 8, &packed_bytes, rows, (uLong)rows_bytes, 9) != Z_OK) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for compressing a picture");
        goto cleanup;
    }
    at = end_chunk(at, "IDAT", packed_bytes);
    at = end_chunk(at, "IEND", 0);
    *bytes = file;
    *size_bytes = (size_t)(at - file);
    status = SCREE_OK;
cleanup:
    scree_release(memory, rows);
    if (status != SCREE_OK) scree_release(memory, file);
    return status;
}
