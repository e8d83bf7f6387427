/* Byte cursors: the one way in which foreign bytes are read and formats are written. Little-endian, bounded, no casts.
 *
 * A cursor that is asked for more than it has remembers it: from then on every read gives 0 and every write is
 * dropped, so a parser may read a whole record and ask once, at its end, whether it was all there.
 *
 *     struct scree_reader reader = scree_reader(bytes, size_bytes);
 *     uint32_t count = scree_read_u32(&reader);
 *     if (!scree_reader_holds(&reader, count, 2)) return scree_fail(...);   before anything is allocated */
#ifndef SCREE_STREAM_CURSOR_H
#define SCREE_STREAM_CURSOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct scree_reader {
    const unsigned char *bytes;
    size_t size_bytes;
    size_t at_bytes; /* never beyond size_bytes */
    bool ran_out;    /* something was asked for that was not there */
};

/* A reader at the first of `size_bytes` bytes; `bytes` may be NULL when there are none. */
struct scree_reader scree_reader(const void *bytes, size_t size_bytes);

/* Bytes that are left; 0 once the reader has run out. */
size_t scree_reader_left(const struct scree_reader *reader);

/* Whether `count` items of `size_bytes` each (at least 1) are left. Cannot overflow, changes nothing. */
bool scree_reader_holds(const struct scree_reader *reader, uint64_t count, size_t size_bytes);

uint8_t scree_read_u8(struct scree_reader *reader);
uint16_t scree_read_u16(struct scree_reader *reader);
uint32_t scree_read_u32(struct scree_reader *reader);
uint64_t scree_read_u64(struct scree_reader *reader);
float scree_read_f32(struct scree_reader *reader);
double scree_read_f64(struct scree_reader *reader);

/* The next `size_bytes` bytes in place, or NULL when they are not all there. */
const unsigned char *scree_read_bytes(struct scree_reader *reader, size_t size_bytes);

/* Steps to the next multiple of `alignment_bytes` (at least 1), counted from the reader's first byte. */
void scree_read_align(struct scree_reader *reader, size_t alignment_bytes);

struct scree_writer {
    unsigned char *bytes;
    size_t capacity_bytes;
    size_t at_bytes; /* never beyond capacity_bytes */
    bool ran_out;    /* something did not fit and was dropped, with all that followed */
};

/* A writer at the first of `capacity_bytes` bytes that the caller owns. */
struct scree_writer scree_writer(void *bytes, size_t capacity_bytes);

void scree_write_u8(struct scree_writer *writer, uint8_t value);
void scree_write_u16(struct scree_writer *writer, uint16_t value);
void scree_write_u32(struct scree_writer *writer, uint32_t value);
void scree_write_u64(struct scree_writer *writer, uint64_t value);
void scree_write_f32(struct scree_writer *writer, float value);
void scree_write_f64(struct scree_writer *writer, double value);
void scree_write_bytes(struct scree_writer *writer, const void *bytes, size_t size_bytes);

/* Writes zeros up to the next multiple of `alignment_bytes` (at least 1), counted from the writer's first byte. */
void scree_write_align(struct scree_writer *writer, size_t alignment_bytes);

#ifdef __cplusplus
}
#endif
#endif
