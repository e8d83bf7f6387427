#include "src/las.h"

#include "stream/cursor.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define SHORTEST_HEADER 227
#define LAST_MINOR      4
#define FLAG_WKT        0x10 /* of the global encoding */
#define COMPRESSED      0xC0 /* bits that LASzip sets in the point format */
#define FIRST_WIDE      6    /* formats from here on have four bits for a return's number, eight for the class */

static const uint16_t format_bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
enum { FORMATS = sizeof format_bytes / sizeof *format_bytes };

bool las_is_las(const void *bytes, size_t size_bytes) {
    return size_bytes >= 4 && memcmp(bytes, "LASF", 4) == 0;
}

/* What depends on the version, and what it says about points. */
static enum scree_status check_kind(const char *name, const struct las_header *header, uint16_t header_bytes,
                                    int format_byte, struct scree_error *error) {
    if (format_byte & COMPRESSED)
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: is compressed (LAZ), which is not read; convert it: laszip -i FILE.laz -o FILE.las, or "
                          "pdal translate FILE.laz FILE.las",
                          name);
    if (header->point_format >= FORMATS)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: has points of format %d; 0 to 10 are read", name,
                          header->point_format);
    if (header->point_format >= FIRST_WIDE && header->version_minor < LAST_MINOR)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: has points of format %d, which LAS 1.%d does not have", name,
                          header->point_format, header->version_minor);
    if (header->point_bytes < format_bytes[header->point_format])
        return scree_fail(error, SCREE_E_CORRUPT, "%s: points of format %d have %d bytes at least, not %d", name,
                          header->point_format, format_bytes[header->point_format], header->point_bytes);
    int least = header->version_minor == LAST_MINOR ? LAS_HEADER_BYTES : SHORTEST_HEADER;
    if (header_bytes < least)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: the header of LAS 1.%d has %d bytes at least, not %d", name,
                          header->version_minor, least, header_bytes);
    return SCREE_OK;
}

static enum scree_status check_sizes(const char *name, const struct las_header *header, uint64_t file_bytes,
                                     struct scree_error *error) {
    if (header->points_at < header->records_at || header->points_at > file_bytes)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: says that its points begin at byte %" PRIu64 ", with a header of %" PRIu64
                          " bytes and %" PRIu64 " bytes in all",
                          name, header->points_at, header->records_at, file_bytes);
    uint64_t room = (file_bytes - header->points_at) / header->point_bytes;
    if (header->point_count > room)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: says that it has %" PRIu64 " points, but there are bytes for %" PRIu64
                          "; it is cut off, or its header is wrong",
                          name, header->point_count, room);
    if (header->record_count > (header->points_at - header->records_at) / LAS_RECORD_BYTES)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: %" PRIu32 " records do not fit between its header and its points", name,
                          header->record_count);
    if (header->extended_count > 0 &&
        (header->extended_at < header->points_at || header->extended_at > file_bytes ||
         header->extended_count > (file_bytes - header->extended_at) / LAS_EXTENDED_BYTES))
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: %" PRIu32 " extended records at byte %" PRIu64 " do not fit into %" PRIu64 " bytes",
                          name, header->extended_count, header->extended_at, file_bytes);
    for (int i = 0; i < 3; i++)
        if (!isfinite(header->scale[i]) || header->scale[i] == 0 || !isfinite(header->offset[i]))
            return scree_fail(error, SCREE_E_CORRUPT, "%s: scale %g and offset %g make no coordinates", name,
                              header->scale[i], header->offset[i]);
    return SCREE_OK;
}

enum scree_status las_header_read(const char *name, const void *bytes, size_t size_bytes, uint64_t file_bytes,
                                  struct las_header *header, struct scree_error *error) {
    struct scree_reader reader = scree_reader(bytes, size_bytes);
    *header = (struct las_header){0};
    if (!las_is_las(bytes, size_bytes)) return scree_fail(error, SCREE_E_CORRUPT, "%s: is no LAS file", name);
    scree_read_bytes(&reader, 6);
    header->has_wkt = (scree_read_u16(&reader) & FLAG_WKT) != 0;
    scree_read_bytes(&reader, 16);
    int major = scree_read_u8(&reader);
    header->version_minor = scree_read_u8(&reader);
    scree_read_bytes(&reader, 68); /* who made it, and when */
    uint16_t header_bytes = scree_read_u16(&reader);
    header->records_at = header_bytes;
    header->points_at = scree_read_u32(&reader);
    header->record_count = scree_read_u32(&reader);
    int format_byte = scree_read_u8(&reader);
    header->point_format = format_byte & ~COMPRESSED;
    header->point_bytes = scree_read_u16(&reader);
    header->point_count = scree_read_u32(&reader);
    scree_read_bytes(&reader, 20); /* points by return */
    for (int i = 0; i < 3; i++) header->scale[i] = scree_read_f64(&reader);
    for (int i = 0; i < 3; i++) header->offset[i] = scree_read_f64(&reader);
    scree_read_bytes(&reader, 48); /* bounds, which the points tell themselves */
    if (reader.ran_out) return scree_fail(error, SCREE_E_CORRUPT, "%s: is cut off within its header", name);
    if (major != 1 || header->version_minor > LAST_MINOR)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: is LAS %d.%d; 1.0 to 1.4 are read", name, major,
                          header->version_minor);
    if (header->version_minor == LAST_MINOR) {
        scree_read_bytes(&reader, 8); /* where waveforms begin */
        header->extended_at = scree_read_u64(&reader);
        header->extended_count = scree_read_u32(&reader);
        uint64_t wide_count = scree_read_u64(&reader);
        if (wide_count != 0) header->point_count = wide_count;
        scree_read_bytes(&reader, 120); /* points by return */
        if (reader.ran_out) return scree_fail(error, SCREE_E_CORRUPT, "%s: is cut off within its header", name);
    }
    enum scree_status status = check_kind(name, header, header_bytes, format_byte, error);
    return status == SCREE_OK ? check_sizes(name, header, file_bytes, error) : status;
}

struct las_record las_record_read(const unsigned char *bytes, bool is_extended) {
    static const char projection[16] = "LASF_Projection";
    struct scree_reader reader = scree_reader(bytes, is_extended ? LAS_EXTENDED_BYTES : LAS_RECORD_BYTES);
    struct las_record record = {0};
    scree_read_u16(&reader);
    record.is_projection = memcmp(scree_read_bytes(&reader, sizeof projection), projection, sizeof projection) == 0;
    record.id = scree_read_u16(&reader);
    record.size_bytes = is_extended ? scree_read_u64(&reader) : scree_read_u16(&reader);
    return record;
}

struct las_point las_point_read(const struct las_header *header, const unsigned char *bytes) {
    struct scree_reader reader = scree_reader(bytes, header->point_bytes);
    struct las_point point = {0};
    point.x = (int32_t)scree_read_u32(&reader) * header->scale[0] + header->offset[0];
    point.y = (int32_t)scree_read_u32(&reader) * header->scale[1] + header->offset[1];
    point.z = (int32_t)scree_read_u32(&reader) * header->scale[2] + header->offset[2];
    scree_read_u16(&reader); /* intensity */
    uint8_t returns = scree_read_u8(&reader), flags = scree_read_u8(&reader);
    bool is_wide = header->point_format >= FIRST_WIDE;
    point.return_number = is_wide ? returns & 15 : returns & 7;
    point.return_count = is_wide ? returns >> 4 : (returns >> 3) & 7;
    point.is_withheld = is_wide ? (flags & 4) != 0 : (flags & 0x80) != 0;
    point.class_number = is_wide ? scree_read_u8(&reader) : flags & 31;
    return point;
}
