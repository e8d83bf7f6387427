/* The header of a stream: what is written is read, what is cut is asked for, and what no writer makes is refused. */
#include "stream/cursor.h"
#include "stream/stream_header.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { RUNGS = 28, HEADER_BYTES = 84 + 30 * RUNGS + 4, PLACE_BYTES = 84, RUNG_BYTES = 30 };

/* A header that could be a real tile's: every rung adds a fifth. */
static struct scree_stream_header make_header(uint32_t rung_count) {
    struct scree_stream_header header = {.profile = SCREE_LOCAL,
                                         .zoom = 2,
                                         .tile_x = 3,
                                         .tile_y = 1,
                                         .columns = 256,
                                         .rows = 255,
                                         .west = 377000.5,
                                         .south = 3790000.25,
                                         .spacing_x = 30,
                                         .spacing_y = 30.5,
                                         .metres_x = 30,
                                         .metres_y = 30.5,
                                         .height_exponent = -3,
                                         .rung_count = rung_count};
    uint32_t vertices = 100;
    for (uint32_t i = 0; i < rung_count; i++) {
        header.rungs[i] = (struct scree_rung){.rung = (int32_t)i - 5,
                                              .vertex_count = vertices,
                                              .triangle_count = 2 * vertices - 30,
                                              .mmqe_m2 = 1000.0f / (float)(i + 1),
                                              .svo_m = 100.0f / (float)(i + 1),
                                              .max_error_m = 300.0f / (float)(i + 1),
                                              .size_bytes = vertices,
                                              .checksum = 0x12345678u + i};
        vertices += vertices / 5 > 0 && vertices < 50000 ? vertices / 5 : 1;
    }
    return header;
}

static void same_headers(const struct scree_stream_header *a, const struct scree_stream_header *b) {
    CU_ASSERT_EQUAL(a->version, b->version);
    CU_ASSERT_EQUAL(a->profile, b->profile);
    CU_ASSERT_EQUAL(a->zoom, b->zoom);
    CU_ASSERT_EQUAL(a->tile_x, b->tile_x);
    CU_ASSERT_EQUAL(a->tile_y, b->tile_y);
    CU_ASSERT_EQUAL(a->columns, b->columns);
    CU_ASSERT_EQUAL(a->rows, b->rows);
    CU_ASSERT_EQUAL(a->west, b->west);
    CU_ASSERT_EQUAL(a->south, b->south);
    CU_ASSERT_EQUAL(a->spacing_x, b->spacing_x);
    CU_ASSERT_EQUAL(a->spacing_y, b->spacing_y);
    CU_ASSERT_EQUAL(a->metres_x, b->metres_x);
    CU_ASSERT_EQUAL(a->metres_y, b->metres_y);
    CU_ASSERT_EQUAL(a->height_exponent, b->height_exponent);
    CU_ASSERT_EQUAL(a->size_bytes, b->size_bytes);
    CU_ASSERT_EQUAL_FATAL(a->rung_count, b->rung_count);
    for (uint32_t i = 0; i < a->rung_count; i++) {
        CU_ASSERT_EQUAL(a->rungs[i].rung, b->rungs[i].rung);
        CU_ASSERT_EQUAL(a->rungs[i].vertex_count, b->rungs[i].vertex_count);
        CU_ASSERT_EQUAL(a->rungs[i].triangle_count, b->rungs[i].triangle_count);
        CU_ASSERT_EQUAL(a->rungs[i].mmqe_m2, b->rungs[i].mmqe_m2);
        CU_ASSERT_EQUAL(a->rungs[i].svo_m, b->rungs[i].svo_m);
        CU_ASSERT_EQUAL(a->rungs[i].max_error_m, b->rungs[i].max_error_m);
        CU_ASSERT_EQUAL(a->rungs[i].size_bytes, b->rungs[i].size_bytes);
        CU_ASSERT_EQUAL(a->rungs[i].checksum, b->rungs[i].checksum);
        CU_ASSERT_EQUAL(a->rungs[i].offset_bytes, b->rungs[i].offset_bytes);
    }
}

static void what_is_written_is_read(void) {
    static const uint32_t counts[] = {1, 2, RUNGS, SCREE_MAX_RUNGS};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        struct scree_stream_header header = make_header(counts[i]), read;
        size_t size_bytes = stream_header_bound(counts[i]);
        unsigned char *bytes = malloc(size_bytes);
        CU_ASSERT_EQUAL(stream_header_write(&header, bytes, size_bytes), size_bytes);
        CU_ASSERT_EQUAL(header.version, SCREE_STREAM_VERSION);
        CU_ASSERT_EQUAL(header.size_bytes, size_bytes);
        uint64_t offset_bytes = size_bytes;
        for (uint32_t r = 0; r < header.rung_count; r++) {
            CU_ASSERT_EQUAL(header.rungs[r].offset_bytes, offset_bytes);
            offset_bytes += header.rungs[r].size_bytes;
        }
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, &error), SCREE_OK);
        CU_ASSERT_STRING_EQUAL(error.text, "");
        same_headers(&header, &read);
        free(bytes);
    }
}

static void a_geodetic_tile_has_no_metres(void) {
    struct scree_stream_header header = make_header(3), read;
    unsigned char bytes[HEADER_BYTES];
    header.profile = SCREE_GEODETIC;
    header.metres_x = header.metres_y = 0;
    header.zoom = 0;
    header.tile_x = 1;
    header.tile_y = 0;
    header.west = 0;
    header.south = -90;
    header.spacing_x = header.spacing_y = 180.0 / 256;
    header.rows = 256;
    size_t size_bytes = stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, NULL), SCREE_OK);
    same_headers(&header, &read);
    header.west = 1; /* ends at 181 degrees */
    stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, NULL), SCREE_E_CORRUPT);
    header.west = 0;
    header.south = -91;
    stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, NULL), SCREE_E_CORRUPT);
    header.south = -90;
    header.metres_x = 1;
    stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, NULL), SCREE_E_CORRUPT);
}

static void a_flat_tile_may_add_nothing(void) {
    struct scree_stream_header header = make_header(2), read;
    unsigned char bytes[HEADER_BYTES];
    for (int i = 0; i < 2; i++) {
        header.rungs[i].vertex_count = 4;
        header.rungs[i].triangle_count = 2;
        header.rungs[i].size_bytes = 0;
    }
    size_t size_bytes = stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(stream_header_read(bytes, size_bytes, &read, NULL), SCREE_OK);
    same_headers(&header, &read);
}

static void what_does_not_fit_is_not_written(void) {
    struct scree_stream_header header = make_header(RUNGS);
    unsigned char bytes[HEADER_BYTES];
    for (size_t capacity_bytes = 0; capacity_bytes < HEADER_BYTES; capacity_bytes++)
        CU_ASSERT_EQUAL(stream_header_write(&header, bytes, capacity_bytes), 0);
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), HEADER_BYTES);
    header.rungs[1].rung = 32768;
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), 0);
    header = make_header(RUNGS);
    header.zoom = 128;
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), 0);
    header = make_header(RUNGS);
    header.height_exponent = -129;
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), 0);
    header = make_header(0);
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), 0);
    header.rung_count = SCREE_MAX_RUNGS + 1;
    CU_ASSERT_EQUAL(stream_header_write(&header, bytes, HEADER_BYTES), 0);
}

/* Reads from a heap copy without a byte to spare, so that a sanitizer sees a read beyond the end. */
static enum scree_status read_exactly(const unsigned char *bytes, size_t size_bytes, struct scree_stream_header *header,
                                      struct scree_error *error) {
    unsigned char *copy = malloc(size_bytes + (size_bytes == 0));
    if (size_bytes > 0) memcpy(copy, bytes, size_bytes);
    enum scree_status status = stream_header_read(copy, size_bytes, header, error);
    free(copy);
    return status;
}

static void every_prefix_asks_for_more(void) {
    struct scree_stream_header header = make_header(RUNGS), read;
    unsigned char bytes[HEADER_BYTES];
    stream_header_write(&header, bytes, sizeof bytes);
    struct scree_error error = {0};
    for (size_t size_bytes = 0; size_bytes < HEADER_BYTES; size_bytes++)
        CU_ASSERT_EQUAL(read_exactly(bytes, size_bytes, &read, &error), SCREE_MORE);
    CU_ASSERT_EQUAL(error.status, SCREE_OK);
    CU_ASSERT_EQUAL(stream_header_read(NULL, 0, &read, &error), SCREE_MORE);
    CU_ASSERT_EQUAL(read_exactly(bytes, HEADER_BYTES, &read, &error), SCREE_OK);
}

static void every_changed_byte_is_refused(void) {
    struct scree_stream_header header = make_header(2), read;
    unsigned char bytes[HEADER_BYTES];
    size_t size_bytes = stream_header_write(&header, bytes, sizeof bytes);
    unsigned accepted = 0, untold = 0;
    for (size_t i = 0; i < size_bytes; i++) {
        for (unsigned change = 1; change < 256; change++) {
            struct scree_error error = {0};
            bytes[i] ^= (unsigned char)change;
            enum scree_status status = read_exactly(bytes, size_bytes, &read, &error);
            bytes[i] ^= (unsigned char)change;
            accepted += status >= SCREE_OK; /* nor may it wait for bytes that never come */
            untold += error.text[0] == '\0';
        }
    }
    CU_ASSERT_EQUAL(accepted, 0);
    CU_ASSERT_EQUAL(untold, 0);
}

/* Makes the checksum that a header ends with true again. */
static void repair(unsigned char *bytes, size_t size_bytes) {
    struct scree_writer writer = scree_writer(bytes + size_bytes - 4, 4);
    scree_write_u32(&writer, (uint32_t)crc32(0, bytes, (uInt)size_bytes - 4));
}

/* A header of three rungs with `width_bytes` bytes at `at_bytes` replaced by `value`, its checksum right. */
static enum scree_status read_altered(size_t at_bytes, size_t width_bytes, uint64_t value) {
    struct scree_stream_header header = make_header(3), read;
    struct scree_error error = {0};
    unsigned char bytes[HEADER_BYTES];
    size_t size_bytes = stream_header_write(&header, bytes, sizeof bytes);
    for (size_t i = 0; i < width_bytes; i++) bytes[at_bytes + i] = (unsigned char)(value >> (8 * i));
    repair(bytes, size_bytes);
    enum scree_status status = read_exactly(bytes, size_bytes, &read, &error);
    CU_ASSERT_EQUAL(error.status, status == SCREE_MORE ? SCREE_OK : status);
    return status;
}

static uint64_t bits_of_double(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint64_t bits_of_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void layouts_that_lie_are_refused(void) {
    CU_ASSERT_EQUAL(read_altered(0, 1, 0), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(8, 2, 0), SCREE_E_UNSUPPORTED);
    CU_ASSERT_EQUAL(read_altered(8, 2, 2), SCREE_E_UNSUPPORTED);
    CU_ASSERT_EQUAL(read_altered(10, 2, 0), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(10, 2, 0xffff), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(12, 1, 2), SCREE_E_UNSUPPORTED);
    CU_ASSERT_EQUAL(read_altered(15, 1, 1), SCREE_E_UNSUPPORTED);
    CU_ASSERT_EQUAL(read_altered(16, 2, 0), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(16, 2, 2), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(16, 2, 257), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(18, 2, 4), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(18, 2, 0xffff), SCREE_E_CORRUPT);
}

static void places_that_cannot_be_are_refused(void) {
    CU_ASSERT_EQUAL(read_altered(13, 1, 31), SCREE_E_CORRUPT); /* zoom */
    CU_ASSERT_EQUAL(read_altered(13, 1, 0xff), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(14, 1, 30), SCREE_OK); /* height exponent */
    CU_ASSERT_EQUAL(read_altered(14, 1, 31), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(14, 1, (uint8_t)-31), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(20, 4, 4), SCREE_E_CORRUPT); /* zoom 2 has 4 x 4 tiles */
    CU_ASSERT_EQUAL(read_altered(24, 4, 4), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(24, 4, UINT32_MAX), SCREE_E_CORRUPT);
    for (size_t at_bytes = 28; at_bytes <= 32; at_bytes += 4) { /* columns, rows */
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, 0), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, UINT32_MAX), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, 1 << 24), SCREE_OK);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, SCREE_MAX_TILE_STEPS + 1), SCREE_E_CORRUPT);
    }
    for (size_t at_bytes = 36; at_bytes < PLACE_BYTES; at_bytes += 8) {
        CU_ASSERT_EQUAL(read_altered(at_bytes, 8, bits_of_double(NAN)), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 8, bits_of_double(INFINITY)), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 8, bits_of_double(-INFINITY)), SCREE_E_CORRUPT);
    }
    for (size_t at_bytes = 52; at_bytes < PLACE_BYTES; at_bytes += 8) { /* spacings, metres */
        CU_ASSERT_EQUAL(read_altered(at_bytes, 8, bits_of_double(0)), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 8, bits_of_double(-1)), SCREE_E_CORRUPT);
    }
    CU_ASSERT_EQUAL(read_altered(52, 8, bits_of_double(1e13)), SCREE_E_CORRUPT); /* its eastern edge is out of reach */
    CU_ASSERT_EQUAL(read_altered(36, 8, bits_of_double(-1e16)), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(68, 8, bits_of_double(1e7)), SCREE_E_CORRUPT); /* as wide as a small star */
    CU_ASSERT_EQUAL(read_altered(12, 1, SCREE_GEODETIC), SCREE_E_CORRUPT);      /* has metres */
}

/* The header of three rungs has 100, 120 and 144 vertices, 170, 210 and 258 triangles. */
static void rungs_that_cannot_be_are_refused(void) {
    const size_t base = PLACE_BYTES, second = base + RUNG_BYTES, third = second + RUNG_BYTES;
    CU_ASSERT_EQUAL(read_altered(second, 2, (uint16_t)-5), SCREE_E_CORRUPT); /* L */
    CU_ASSERT_EQUAL(read_altered(second, 2, (uint16_t)-3), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(base + 2, 4, 3), SCREE_E_CORRUPT); /* vertices */
    CU_ASSERT_EQUAL(read_altered(base + 2, 4, 0), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(second + 2, 4, 99), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(third + 2, 4, UINT32_MAX), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(third + 2, 4, SCREE_MAX_VERTICES + 1), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(base + 6, 4, 97), SCREE_E_CORRUPT); /* triangles: 98 .. 194 of 100 vertices */
    CU_ASSERT_EQUAL(read_altered(base + 6, 4, 195), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(base + 6, 4, UINT32_MAX), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(third + 6, 4, 210 + 23), SCREE_E_CORRUPT); /* 24 .. 48 for 24 vertices more */
    CU_ASSERT_EQUAL(read_altered(third + 6, 4, 210 + 24), SCREE_OK);
    CU_ASSERT_EQUAL(read_altered(third + 6, 4, 210 + 49), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(third + 6, 4, 0), SCREE_E_CORRUPT);
    for (size_t at_bytes = base + 10; at_bytes <= base + 18; at_bytes += 4) { /* MMQE, SVO, max error */
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, bits_of_float(NAN)), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, bits_of_float(INFINITY)), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(read_altered(at_bytes, 4, bits_of_float(-1)), SCREE_E_CORRUPT);
    }
    CU_ASSERT_EQUAL(read_altered(second + 14, 4, bits_of_float(100.0f)), SCREE_OK);
    CU_ASSERT_EQUAL(read_altered(second + 14, 4, bits_of_float(100.5f)), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(base + 22, 4, 6), SCREE_OK); /* bytes: 96 vertices and the corners */
    CU_ASSERT_EQUAL(read_altered(base + 22, 4, 5), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(second + 22, 4, 0), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(read_altered(second + 22, 4, UINT32_MAX), SCREE_OK); /* to be waited for, not believed */
}

/* More vertices than the tile has posts. */
static void a_tile_has_no_more_vertices_than_posts(void) {
    CU_ASSERT_EQUAL(read_altered(28, 8, 11 | (uint64_t)11 << 32), SCREE_OK); /* 12 x 12 posts, 144 vertices */
    CU_ASSERT_EQUAL(read_altered(28, 8, 11 | (uint64_t)10 << 32), SCREE_E_CORRUPT);
}

/* A header of three rungs with `extension_bytes` bytes of extensions at its end; its size in all. */
static size_t extend(unsigned char *bytes, const void *extensions, size_t extension_bytes) {
    struct scree_stream_header header = make_header(3);
    size_t size_bytes = stream_header_write(&header, bytes, HEADER_BYTES) + extension_bytes;
    memcpy(bytes + size_bytes - 4 - extension_bytes, extensions, extension_bytes);
    bytes[10] = (unsigned char)size_bytes;
    bytes[11] = (unsigned char)(size_bytes >> 8);
    bytes[18] = (unsigned char)extension_bytes;
    repair(bytes, size_bytes);
    return size_bytes;
}

static void unknown_extensions_are_skipped(void) {
    static const unsigned char two[] = {7, 0, 3, 0, 'a', 'b', 'c', 0xff, 0x7f, 0, 0};
    unsigned char bytes[HEADER_BYTES];
    struct scree_stream_header header = make_header(3), read;
    stream_header_write(&header, bytes, sizeof bytes);
    size_t size_bytes = extend(bytes, two, sizeof two);
    CU_ASSERT_EQUAL(read_exactly(bytes, size_bytes, &read, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(read.size_bytes, size_bytes);
    CU_ASSERT_EQUAL(read.rungs[0].offset_bytes, size_bytes); /* blocks follow the extensions */
    CU_ASSERT_EQUAL(read.rungs[2].checksum, header.rungs[2].checksum);
    for (size_t cut_bytes = 0; cut_bytes < size_bytes; cut_bytes++)
        CU_ASSERT_EQUAL(read_exactly(bytes, cut_bytes, &read, NULL), SCREE_MORE);
}

static void mandatory_and_broken_extensions_are_refused(void) {
    static const unsigned char mandatory[] = {7, 0, 0, 0, 7, 0x80, 0, 0};
    static const unsigned char cut_off[] = {7, 0, 2, 0, 'a'}, no_length[] = {7, 0, 0};
    unsigned char bytes[HEADER_BYTES];
    struct scree_stream_header read;
    struct scree_error error = {0};
    size_t size_bytes = extend(bytes, mandatory, sizeof mandatory);
    CU_ASSERT_EQUAL(read_exactly(bytes, size_bytes, &read, &error), SCREE_E_UNSUPPORTED);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "extension 7"));
    size_bytes = extend(bytes, cut_off, sizeof cut_off);
    CU_ASSERT_EQUAL(read_exactly(bytes, size_bytes, &read, NULL), SCREE_E_CORRUPT);
    size_bytes = extend(bytes, no_length, sizeof no_length);
    CU_ASSERT_EQUAL(read_exactly(bytes, size_bytes, &read, NULL), SCREE_E_CORRUPT);
}

static void the_first_kilobyte_holds_28_rungs(void) {
    CU_ASSERT_TRUE(stream_header_bound(28) <= 1024);
}

int suite_stream_header(void) {
    CU_pSuite suite = CU_add_suite("stream header", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, what_is_written_is_read);
    CU_ADD_TEST(suite, a_geodetic_tile_has_no_metres);
    CU_ADD_TEST(suite, a_flat_tile_may_add_nothing);
    CU_ADD_TEST(suite, what_does_not_fit_is_not_written);
    CU_ADD_TEST(suite, every_prefix_asks_for_more);
    CU_ADD_TEST(suite, every_changed_byte_is_refused);
    CU_ADD_TEST(suite, layouts_that_lie_are_refused);
    CU_ADD_TEST(suite, places_that_cannot_be_are_refused);
    CU_ADD_TEST(suite, rungs_that_cannot_be_are_refused);
    CU_ADD_TEST(suite, a_tile_has_no_more_vertices_than_posts);
    CU_ADD_TEST(suite, unknown_extensions_are_skipped);
    CU_ADD_TEST(suite, mandatory_and_broken_extensions_are_refused);
    CU_ADD_TEST(suite, the_first_kilobyte_holds_28_rungs);
    return 0;
}
