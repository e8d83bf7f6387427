#include "stream/stream_header.h"

#include "stream/cursor.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <zlib.h>

/* A first byte that no text has, the name, and the line end that careless copies change. */
static const unsigned char magic[8] = {0x89, 'S', 'c', 'r', 'e', 'e', '\r', '\n'};

enum {
    VERSION_AT = 8, /* where fields lie that errors point at */
    SIZE_AT = 10,
    PROFILE_AT = 12,
    ZOOM_AT = 13,
    EXPONENT_AT = 14,
    RESERVED_AT = 15,
    RUNG_COUNT_AT = 16,
    COLUMNS_AT = 28,
    WEST_AT = 36,
    PLACE_BYTES = 84,
    RUNG_BYTES = 30,
    CHECKSUM_BYTES = 4,
    MAX_HEADER_BYTES = 65535,
    EXTENSION_HEAD_BYTES = 4,
    MANDATORY = 0x8000, /* of an extension's type: who does not know it cannot read the stream */
    MAX_STREAM_ZOOM = 30,
    MAX_HEIGHT_EXPONENT = 30
};

/* What keeps coordinates in the range of the floats that viewers draw with. */
#define ROUNDING_DEG   1e-6
#define MAX_COORDINATE 1e15
#define MAX_SIDE_M     1e9

/* What the first bytes say of the header's own layout. */
struct layout {
    uint32_t header_bytes, rung_count, extension_bytes;
};

size_t stream_header_bound(uint32_t rung_count) {
    return PLACE_BYTES + (size_t)RUNG_BYTES * rung_count + CHECKSUM_BYTES;
}

static void write_place(struct scree_writer *writer, const struct scree_stream_header *header) {
    scree_write_bytes(writer, magic, sizeof magic);
    scree_write_u16(writer, SCREE_STREAM_VERSION);
    scree_write_u16(writer, (uint16_t)stream_header_bound(header->rung_count));
    scree_write_u8(writer, (uint8_t)header->profile);
    scree_write_u8(writer, (uint8_t)(int8_t)header->zoom);
    scree_write_u8(writer, (uint8_t)(int8_t)header->height_exponent);
    scree_write_u8(writer, 0); /* reserved */
    scree_write_u16(writer, (uint16_t)header->rung_count);
    scree_write_u16(writer, 0); /* bytes of extensions */
    scree_write_u32(writer, header->tile_x);
    scree_write_u32(writer, header->tile_y);
    scree_write_u32(writer, (uint32_t)header->columns);
    scree_write_u32(writer, (uint32_t)header->rows);
    scree_write_f64(writer, header->west);
    scree_write_f64(writer, header->south);
    scree_write_f64(writer, header->spacing_x);
    scree_write_f64(writer, header->spacing_y);
    scree_write_f64(writer, header->metres_x);
    scree_write_f64(writer, header->metres_y);
}

static void write_rung(struct scree_writer *writer, const struct scree_rung *rung) {
    scree_write_u16(writer, (uint16_t)(int16_t)rung->rung);
    scree_write_u32(writer, rung->vertex_count);
    scree_write_u32(writer, rung->triangle_count);
    scree_write_f32(writer, rung->mmqe_m2);
    scree_write_f32(writer, rung->svo_m);
    scree_write_f32(writer, rung->max_error_m);
    scree_write_u32(writer, rung->size_bytes);
    scree_write_u32(writer, rung->checksum);
}

/* Whether the numbers that have fewer bits in the file than in memory keep their values. */
static bool fits_its_fields(const struct scree_stream_header *header) {
    if (header->rung_count < 1 || header->rung_count > SCREE_MAX_RUNGS) return false;
    if (header->zoom < INT8_MIN || header->zoom > INT8_MAX) return false;
    if (header->height_exponent < INT8_MIN || header->height_exponent > INT8_MAX) return false;
    for (uint32_t i = 0; i < header->rung_count; i++)
        if (header->rungs[i].rung < INT16_MIN || header->rungs[i].rung > INT16_MAX) return false;
    return true;
}

/* Blocks follow the header and one another. At most 256 x 2^32 bytes: no overflow. */
static void place_blocks(struct scree_stream_header *header) {
    uint64_t offset_bytes = header->size_bytes;
    for (uint32_t i = 0; i < header->rung_count; i++) {
        header->rungs[i].offset_bytes = offset_bytes;
        offset_bytes += header->rungs[i].size_bytes;
    }
}

size_t stream_header_write(struct scree_stream_header *header, void *bytes, size_t capacity_bytes) {
    if (!fits_its_fields(header)) return 0;
    struct scree_writer writer = scree_writer(bytes, capacity_bytes);
    write_place(&writer, header);
    for (uint32_t i = 0; i < header->rung_count; i++) write_rung(&writer, &header->rungs[i]);
    if (writer.ran_out) return 0;
    scree_write_u32(&writer, (uint32_t)crc32(0, bytes, (uInt)writer.at_bytes));
    if (writer.ran_out) return 0;
    header->version = SCREE_STREAM_VERSION;
    header->size_bytes = (uint32_t)writer.at_bytes;
    place_blocks(header);
    return writer.at_bytes;
}

/* Magic, version and layout, as far as they are there: what is wrong with them is told at once, before more is asked
 * for. The header's size is there twice, so a damaged one does not make anybody wait for bytes that never come. */
static enum scree_status read_layout(const unsigned char *bytes, size_t size_bytes, struct layout *layout,
                                     struct scree_error *error) {
    size_t magic_bytes = size_bytes < sizeof magic ? size_bytes : sizeof magic;
    if (magic_bytes > 0 && memcmp(bytes, magic, magic_bytes) != 0)
        return scree_fail_at(error, SCREE_E_CORRUPT, 0, "this is not a Scree stream: it does not begin as one");
    struct scree_reader reader = scree_reader(bytes, size_bytes);
    scree_read_bytes(&reader, VERSION_AT);
    unsigned version = scree_read_u16(&reader);
    if (reader.ran_out) return SCREE_MORE;
    if (version != SCREE_STREAM_VERSION)
        return scree_fail_at(error, SCREE_E_UNSUPPORTED, VERSION_AT,
                             "the stream is of version %u, this library reads version %d: take a newer one", version,
                             SCREE_STREAM_VERSION);
    layout->header_bytes = scree_read_u16(&reader);
    scree_read_u32(&reader);
    layout->rung_count = scree_read_u16(&reader);
    layout->extension_bytes = scree_read_u16(&reader);
    if (reader.ran_out) return SCREE_MORE;
    if (layout->rung_count < 1 || layout->rung_count > SCREE_MAX_RUNGS)
        return scree_fail_at(error, SCREE_E_CORRUPT, RUNG_COUNT_AT, "the stream's header claims %u rungs, not 1 to %d",
                             (unsigned)layout->rung_count, SCREE_MAX_RUNGS);
    size_t expected_bytes = stream_header_bound(layout->rung_count) + layout->extension_bytes;
    if (expected_bytes > MAX_HEADER_BYTES || layout->header_bytes != expected_bytes)
        return scree_fail_at(error, SCREE_E_CORRUPT, SIZE_AT,
                             "the stream's header says that it has %u bytes, its contents need %zu",
                             (unsigned)layout->header_bytes, expected_bytes);
    return SCREE_OK;
}

static void read_place(struct scree_reader *reader, struct scree_stream_header *header) {
    header->profile = scree_read_u8(reader);
    header->zoom = (int8_t)scree_read_u8(reader);
    header->height_exponent = (int8_t)scree_read_u8(reader);
    scree_read_u8(reader);  /* reserved */
    scree_read_u32(reader); /* counts, known from the layout */
    header->tile_x = scree_read_u32(reader);
    header->tile_y = scree_read_u32(reader);
    header->columns = (int32_t)scree_read_u32(reader);
    header->rows = (int32_t)scree_read_u32(reader);
    header->west = scree_read_f64(reader);
    header->south = scree_read_f64(reader);
    header->spacing_x = scree_read_f64(reader);
    header->spacing_y = scree_read_f64(reader);
    header->metres_x = scree_read_f64(reader);
    header->metres_y = scree_read_f64(reader);
}

static void read_rung(struct scree_reader *reader, struct scree_rung *rung) {
    rung->rung = (int16_t)scree_read_u16(reader);
    rung->vertex_count = scree_read_u32(reader);
    rung->triangle_count = scree_read_u32(reader);
    rung->mmqe_m2 = scree_read_f32(reader);
    rung->svo_m = scree_read_f32(reader);
    rung->max_error_m = scree_read_f32(reader);
    rung->size_bytes = scree_read_u32(reader);
    rung->checksum = scree_read_u32(reader);
}

/* Extension records: type, length, bytes. Unknown ones are stepped over, unless they are mandatory. */
static enum scree_status skip_extensions(const unsigned char *bytes, size_t size_bytes, struct scree_error *error) {
    struct scree_reader reader = scree_reader(bytes, size_bytes);
    while (scree_reader_left(&reader) > 0) {
        unsigned type = scree_read_u16(&reader);
        scree_read_bytes(&reader, scree_read_u16(&reader));
        if (reader.ran_out) return scree_fail(error, SCREE_E_CORRUPT, "an extension of the stream's header is cut off");
        if ((type & MANDATORY) != 0)
            return scree_fail(error, SCREE_E_UNSUPPORTED,
                              "the stream needs extension %u, which this library does not know: take a newer one",
                              type & (MANDATORY - 1u));
    }
    return SCREE_OK;
}

/* Where a tile ends, in degrees or units of the CRS. */
static double east_of(const struct scree_stream_header *header) {
    return header->west + header->columns * header->spacing_x;
}
static double north_of(const struct scree_stream_header *header) {
    return header->south + header->rows * header->spacing_y;
}

static bool lies_on_globe(const struct scree_stream_header *header) {
    return header->spacing_x > 0 && header->spacing_y > 0 && header->west >= -180 - ROUNDING_DEG &&
           east_of(header) <= 180 + ROUNDING_DEG && header->south >= -90 - ROUNDING_DEG &&
           north_of(header) <= 90 + ROUNDING_DEG && header->metres_x == 0 && header->metres_y == 0;
}

static bool lies_in_plane(const struct scree_stream_header *header) {
    return header->spacing_x > 0 && header->spacing_y > 0 && header->west >= -MAX_COORDINATE &&
           east_of(header) <= MAX_COORDINATE && header->south >= -MAX_COORDINATE &&
           north_of(header) <= MAX_COORDINATE && header->metres_x > 0 && header->metres_y > 0 &&
           header->columns * header->metres_x <= MAX_SIDE_M && header->rows * header->metres_y <= MAX_SIDE_M;
}

static enum scree_status check_place(const struct scree_stream_header *header, struct scree_error *error) {
    if (header->profile != SCREE_GEODETIC && header->profile != SCREE_LOCAL)
        return scree_fail_at(error, SCREE_E_UNSUPPORTED, PROFILE_AT,
                             "the stream's profile is number %d, this library knows 0 and 1: take a newer one",
                             (int)header->profile);
    uint64_t tiles_y = header->zoom < 0 || header->zoom > MAX_STREAM_ZOOM ? 0 : (uint64_t)1 << header->zoom;
    uint64_t tiles_x = header->profile == SCREE_GEODETIC ? 2 * tiles_y : tiles_y;
    if (header->tile_x >= tiles_x || header->tile_y >= tiles_y)
        return scree_fail_at(error, SCREE_E_CORRUPT, ZOOM_AT, "the stream's tile %d/%u/%u is none of its profile",
                             (int)header->zoom, (unsigned)header->tile_x, (unsigned)header->tile_y);
    if (header->columns < 1 || header->rows < 1 || header->columns > SCREE_MAX_TILE_STEPS ||
        header->rows > SCREE_MAX_TILE_STEPS)
        return scree_fail_at(error, SCREE_E_CORRUPT, COLUMNS_AT, "the stream's tile of %d x %d lattice steps cannot be",
                             (int)header->columns, (int)header->rows);
    if (header->height_exponent < -MAX_HEIGHT_EXPONENT || header->height_exponent > MAX_HEIGHT_EXPONENT)
        return scree_fail_at(error, SCREE_E_CORRUPT, EXPONENT_AT, "the stream's height step of 2^%d m cannot be",
                             (int)header->height_exponent);
    if (!(header->profile == SCREE_GEODETIC ? lies_on_globe(header) : lies_in_plane(header)))
        return scree_fail_at(error, SCREE_E_CORRUPT, WEST_AT,
                             "the stream's tile has no place: its coordinates or spacings are not finite, not positive "
                             "or too large");
    return SCREE_OK;
}

static enum scree_status check_counts(const struct scree_stream_header *header, uint32_t i, int64_t at_bytes,
                                      struct scree_error *error) {
    const struct scree_rung *rung = &header->rungs[i];
    uint64_t posts = ((uint64_t)header->columns + 1) * ((uint64_t)header->rows + 1);
    bool possible = rung->vertex_count <= SCREE_MAX_VERTICES && rung->vertex_count <= posts;
    /* Added to what is there without a block: for the base mesh the tile's corners, and two triangles. */
    uint32_t vertices_before = 4, triangles_before = 2;
    if (i > 0) {
        vertices_before = header->rungs[i - 1].vertex_count;
        triangles_before = header->rungs[i - 1].triangle_count;
    }
    possible = possible && rung->vertex_count >= vertices_before && rung->triangle_count >= triangles_before;
    uint32_t vertices = rung->vertex_count - vertices_before, triangles = rung->triangle_count - triangles_before;
    if (!possible || triangles < vertices || triangles - vertices > vertices)
        return scree_fail_at(error, SCREE_E_CORRUPT, at_bytes, "%u vertices and %u triangles at rung %d cannot be",
                             (unsigned)rung->vertex_count, (unsigned)rung->triangle_count, (int)rung->rung);
    if (vertices > (uint64_t)STREAM_VERTICES_PER_BYTE * rung->size_bytes)
        return scree_fail_at(error, SCREE_E_CORRUPT, at_bytes, "a block of %u bytes cannot add %u vertices at rung %d",
                             (unsigned)rung->size_bytes, (unsigned)vertices, (int)rung->rung);
    return SCREE_OK;
}

static enum scree_status check_rungs(const struct scree_stream_header *header, struct scree_error *error) {
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        int64_t at_bytes = PLACE_BYTES + (int64_t)RUNG_BYTES * i;
        if (i > 0 && rung->rung <= rung[-1].rung)
            return scree_fail_at(error, SCREE_E_CORRUPT, at_bytes, "the stream's rung %d follows rung %d",
                                 (int)rung->rung, (int)rung[-1].rung);
        bool measured = rung->mmqe_m2 >= 0 && isfinite(rung->mmqe_m2) && rung->svo_m >= 0 && isfinite(rung->svo_m) &&
                        rung->max_error_m >= 0 && isfinite(rung->max_error_m);
        if (!measured || (i > 0 && rung->svo_m > rung[-1].svo_m))
            return scree_fail_at(error, SCREE_E_CORRUPT, at_bytes,
                                 "the errors of the stream's rung %d are negative, not finite or out of order",
                                 (int)rung->rung);
        enum scree_status status = check_counts(header, i, at_bytes, error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}

enum scree_status stream_header_read(const void *bytes, size_t size_bytes, struct scree_stream_header *header,
                                     struct scree_error *error) {
    const unsigned char *at = bytes;
    struct layout layout = {0};
    enum scree_status status = read_layout(at, size_bytes, &layout, error);
    if (status != SCREE_OK) return status;
    if (size_bytes < layout.header_bytes) return SCREE_MORE;
    size_t end_bytes = layout.header_bytes - CHECKSUM_BYTES;
    struct scree_reader checksum = scree_reader(at + end_bytes, CHECKSUM_BYTES);
    if (scree_read_u32(&checksum) != crc32(0, at, (uInt)end_bytes))
        return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)end_bytes,
                             "the stream's header is damaged: its checksum is not the one that it states");
    if (at[RESERVED_AT] != 0)
        return scree_fail_at(error, SCREE_E_UNSUPPORTED, RESERVED_AT,
                             "the stream's header sets reserved bits, which this library does not know: take a newer "
                             "one");
    struct scree_reader reader = scree_reader(at, end_bytes);
    scree_read_bytes(&reader, PROFILE_AT);
    read_place(&reader, header);
    status = check_place(header, error);
    if (status != SCREE_OK) return status;
    header->version = SCREE_STREAM_VERSION;
    header->size_bytes = layout.header_bytes;
    header->rung_count = layout.rung_count;
    for (uint32_t i = 0; i < header->rung_count; i++) read_rung(&reader, &header->rungs[i]);
    status = check_rungs(header, error);
    if (status != SCREE_OK) return status;
    status = skip_extensions(at + reader.at_bytes, scree_reader_left(&reader), error);
    if (status == SCREE_OK) place_blocks(header);
    return status;
}
