/* LAS point clouds, versions 1.0 to 1.4, point formats 0 to 10, without compression: headers, variable-length records
 * and points out of bytes that somebody else has read. Pure.
 *
 * After the ASPRS "LAS Specification" 1.0 to 1.4 (R15). Nothing that a header says is believed before it is held
 * against the size of the file. */
#ifndef SCREE_SRC_LAS_H
#define SCREE_SRC_LAS_H

#include <scree/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LAS_HEADER_BYTES   375 /* the longest header, of 1.4 */
#define LAS_RECORD_BYTES   54  /* in front of what a variable-length record holds */
#define LAS_EXTENDED_BYTES 60  /* the same of an extended one, which stands behind the points */

struct las_header {
    int version_minor; /* of version 1 */
    int point_format;
    uint16_t point_bytes; /* of a point record; what lies behind the format's own fields is not looked at */
    uint64_t points_at, point_count;
    uint64_t records_at, extended_at;
    uint32_t record_count, extended_count;
    bool has_wkt; /* the coordinate system is told in WKT rather than in GeoTIFF's keys */
    double scale[3], offset[3];
};

/* Whether the bytes begin as a LAS file does. */
bool las_is_las(const void *bytes, size_t size_bytes);

/* The header of the file `name`, of `file_bytes` bytes, from its first LAS_HEADER_BYTES (or as many as it has).
 * SCREE_E_UNSUPPORTED: compressed (LAZ), or of a version or format that nobody knows; SCREE_E_CORRUPT: the header is
 * cut off, or counts or offsets lie beyond the end of the file. All points of a header that is fine are in the file. */
enum scree_status las_header_read(const char *name, const void *bytes, size_t size_bytes, uint64_t file_bytes,
                                  struct las_header *header, struct scree_error *error);

struct las_record {
    bool is_projection; /* its user ID is LASF_Projection */
    uint16_t id;        /* 2112: WKT; 34735 to 34737: GeoTIFF's keys, numbers and texts */
    uint64_t size_bytes;
};

/* What stands in front of a record's content: LAS_RECORD_BYTES or LAS_EXTENDED_BYTES bytes. */
struct las_record las_record_read(const unsigned char *bytes, bool is_extended);

struct las_point {
    double x, y, z;
    uint8_t class_number;
    uint8_t return_number, return_count; /* from 1; 0 in files that do not tell */
    bool is_withheld;                    /* its producer says that it is not to be used */
};

/* A point record: `point_bytes` bytes. */
struct las_point las_point_read(const struct las_header *header, const unsigned char *bytes);

#endif
