#include "stream/cursor.h"

#include <string.h>

struct scree_reader scree_reader(const void *bytes, size_t size_bytes) {
    return (struct scree_reader){.bytes = bytes, .size_bytes = size_bytes};
}

size_t scree_reader_left(const struct scree_reader *reader) {
    return reader->ran_out ? 0 : reader->size_bytes - reader->at_bytes;
}

bool scree_reader_holds(const struct scree_reader *reader, uint64_t count, size_t size_bytes) {
    return count <= scree_reader_left(reader) / size_bytes;
}

const unsigned char *scree_read_bytes(struct scree_reader *reader, size_t size_bytes) {
    if (reader->ran_out || size_bytes > reader->size_bytes - reader->at_bytes) {
        reader->ran_out = true;
        return NULL;
    }
    const unsigned char *at = reader->bytes + reader->at_bytes;
    reader->at_bytes += size_bytes;
    return at;
}

/* The next `size_bytes` bytes (at most 8) as a number, least significant first. */
static uint64_t read_little_endian(struct scree_reader *reader, size_t size_bytes) {
    const unsigned char *at = scree_read_bytes(reader, size_bytes);
    uint64_t value = 0;
    if (at == NULL) return 0;
    for (size_t i = 0; i < size_bytes; i++) value |= (uint64_t)at[i] << (8 * i);
    return value;
}

uint8_t scree_read_u8(struct scree_reader *reader) {
    return (uint8_t)read_little_endian(reader, 1);
}

uint16_t scree_read_u16(struct scree_reader *reader) {
    return (uint16_t)read_little_endian(reader, 2);
}

uint32_t scree_read_u32(struct scree_reader *reader) {
    return (uint32_t)read_little_endian(reader, 4);
}

uint64_t scree_read_u64(struct scree_reader *reader) {
    return read_little_endian(reader, 8);
}

float scree_read_f32(struct scree_reader *reader) {
    uint32_t bits = scree_read_u32(reader);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double scree_read_f64(struct scree_reader *reader) {
    uint64_t bits = scree_read_u64(reader);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void scree_read_align(struct scree_reader *reader, size_t alignment_bytes) {
    size_t over_bytes = reader->at_bytes % alignment_bytes;
    if (over_bytes != 0) scree_read_bytes(reader, alignment_bytes - over_bytes);
}

struct scree_writer scree_writer(void *bytes, size_t capacity_bytes) {
    return (struct scree_writer){.bytes = bytes, .capacity_bytes = capacity_bytes};
}

/* Room for `size_bytes` more, or NULL. */
static unsigned char *claim(struct scree_writer *writer, size_t size_bytes) {
    if (writer->ran_out || size_bytes > writer->capacity_bytes - writer->at_bytes) {
        writer->ran_out = true;
        return NULL;
    }
    unsigned char *at = writer->bytes + writer->at_bytes;
    writer->at_bytes += size_bytes;
    return at;
}

static void write_little_endian(struct scree_writer *writer, uint64_t value, size_t size_bytes) {
    unsigned char *at = claim(writer, size_bytes);
    if (at == NULL) return;
    for (size_t i = 0; i < size_bytes; i++) at[i] = (unsigned char)(value >> (8 * i));
}

void scree_write_u8(struct scree_writer *writer, uint8_t value) {
    write_little_endian(writer, value, 1);
}

void scree_write_u16(struct scree_writer *writer, uint16_t value) {
    write_little_endian(writer, value, 2);
}

void scree_write_u32(struct scree_writer *writer, uint32_t value) {
    write_little_endian(writer, value, 4);
}

void scree_write_u64(struct scree_writer *writer, uint64_t value) {
    write_little_endian(writer, value, 8);
}

void scree_write_f32(struct scree_writer *writer, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    scree_write_u32(writer, bits);
}

void scree_write_f64(struct scree_writer *writer, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    scree_write_u64(writer, bits);
}

void scree_write_bytes(struct scree_writer *writer, const void *bytes, size_t size_bytes) {
    unsigned char *at = claim(writer, size_bytes);
    if (at != NULL && size_bytes != 0) memcpy(at, bytes, size_bytes);
}

void scree_write_align(struct scree_writer *writer, size_t alignment_bytes) {
    while (!writer->ran_out && writer->at_bytes % alignment_bytes != 0) scree_write_u8(writer, 0);
}
