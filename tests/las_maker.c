#include "tests/las_maker.h"

#include "stream/cursor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROOM_BYTES 8192 /* for all but the points */

static void write_zeros(struct scree_writer *writer, size_t count) {
    for (size_t i = 0; i < count; i++) scree_write_u8(writer, 0);
}

static void write_record(struct scree_writer *writer, bool is_extended, uint16_t id, const void *bytes, size_t size) {
    scree_write_u16(writer, 0);
    scree_write_bytes(writer, "LASF_Projection\0", 16);
    scree_write_u16(writer, id);
    if (is_extended)
        scree_write_u64(writer, size);
    else
        scree_write_u16(writer, (uint16_t)size);
    write_zeros(writer, 32);
    scree_write_bytes(writer, bytes, size);
}

/* Bytes of each format: its fields as the tables of the specification list them. */
static int bytes_of(int format) {
    enum { TIME = 8, COLOUR = 6, INFRARED = 2, WAVE = 29 };
    int old = 20, wide = 30;
    switch (format) {
    case 0: return old;
    case 1: return old + TIME;
    case 2: return old + COLOUR;
    case 3: return old + TIME + COLOUR;
    case 4: return old + TIME + WAVE;
    case 5: return old + TIME + COLOUR + WAVE;
    case 6: return wide;
    case 7: return wide + COLOUR;
    case 8: return wide + COLOUR + INFRARED;
    case 9: return wide + WAVE;
    default: return wide + COLOUR + INFRARED + WAVE;
    }
}

static void write_point(struct scree_writer *writer, const struct las_fixture *f, double scale, struct las_point p) {
    size_t end = writer->at_bytes + (size_t)(bytes_of(f->point_format) + f->extra_bytes);
    scree_write_u32(writer, (uint32_t)(int32_t)lrint((p.x - f->offset[0]) / scale));
    scree_write_u32(writer, (uint32_t)(int32_t)lrint((p.y - f->offset[1]) / scale));
    scree_write_u32(writer, (uint32_t)(int32_t)lrint((p.z - f->offset[2]) / scale));
    scree_write_u16(writer, 1000);
    if (f->point_format < 6) {
        scree_write_u8(writer, (uint8_t)(p.return_number | p.return_count << 3 | 0xC0));
        scree_write_u8(writer, (uint8_t)(p.class_number | (p.is_withheld ? 0x80 : 0) | 0x40));
    } else {
        scree_write_u8(writer, (uint8_t)(p.return_number | p.return_count << 4));
        scree_write_u8(writer, (uint8_t)((p.is_withheld ? 4 : 0) | 0xC3));
        scree_write_u8(writer, p.class_number);
    }
    while (writer->at_bytes < end) scree_write_u8(writer, 0xA5);
}

static void write_header(struct scree_writer *writer, const struct las_fixture *f, double scale, uint32_t points_at,
                         uint64_t extended_at, uint32_t records) {
    bool is_new = f->version_minor >= 4, is_wide = f->point_format >= 6;
    scree_write_bytes(writer, "LASF", 4);
    scree_write_u16(writer, 0);
    scree_write_u16(writer, f->wkt != NULL ? 0x10 : 0);
    write_zeros(writer, 16);
    scree_write_u8(writer, 1);
    scree_write_u8(writer, (uint8_t)f->version_minor);
    write_zeros(writer, 68);
    scree_write_u16(writer, is_new ? 375 : f->version_minor == 3 ? 235 : 227);
    scree_write_u32(writer, points_at);
    scree_write_u32(writer, records);
    scree_write_u8(writer, (uint8_t)f->point_format);
    scree_write_u16(writer, (uint16_t)(bytes_of(f->point_format) + f->extra_bytes));
    scree_write_u32(writer, is_wide ? 0 : f->count);
    write_zeros(writer, 20);
    for (int i = 0; i < 3; i++) scree_write_f64(writer, scale);
    for (int i = 0; i < 3; i++) scree_write_f64(writer, f->offset[i]);
    write_zeros(writer, 48);
    if (f->version_minor >= 3) scree_write_u64(writer, 0);
    if (!is_new) return;
    scree_write_u64(writer, extended_at);
    scree_write_u32(writer, extended_at != 0 ? 1 : 0);
    scree_write_u64(writer, f->count);
    write_zeros(writer, 120);
}

/* Model, raster space, CRS; with a unit of heights a fourth key. */
static size_t write_keys(const struct las_fixture *f, unsigned char keys[40]) {
    struct scree_writer writer = scree_writer(keys, 40);
    bool is_geographic = f->epsg >= 4000 && f->epsg < 5000, has_unit = f->vertical_unit_epsg != 0;
    const uint16_t values[] = {1,
                               1,
                               0,
                               has_unit ? 4 : 3,
                               1024,
                               0,
                               1,
                               is_geographic ? 2 : 1,
                               1025,
                               0,
                               1,
                               1,
                               is_geographic ? 2048 : 3072,
                               0,
                               1,
                               (uint16_t)f->epsg,
                               4099,
                               0,
                               1,
                               (uint16_t)f->vertical_unit_epsg};
    for (int i = 0; i < (has_unit ? 20 : 16); i++) scree_write_u16(&writer, values[i]);
    return writer.at_bytes;
}

unsigned char *las_make(const struct las_fixture *f, size_t *size_bytes) {
    double scale = f->scale != 0 ? f->scale : 0.25;
    size_t point_bytes = (size_t)(bytes_of(f->point_format) + f->extra_bytes);
    size_t room = ROOM_BYTES + f->count * point_bytes, wkt_bytes = f->wkt != NULL ? strlen(f->wkt) + 1 : 0;
    unsigned char *bytes = malloc(room), keys[40];
    if (bytes == NULL || wkt_bytes > ROOM_BYTES / 2) {
        fprintf(stderr, "fixture: no memory for a LAS file\n");
        exit(99);
    }
    size_t header_bytes = f->version_minor >= 4 ? 375 : f->version_minor == 3 ? 235 : 227;
    struct scree_writer writer = scree_writer(bytes, room);
    bool is_behind = f->wkt != NULL && f->wkt_is_extended;
    uint32_t records = (f->epsg != 0) + (f->wkt != NULL && !is_behind);
    size_t points_at = header_bytes;
    if (f->epsg != 0) points_at += 54 + write_keys(f, keys);
    if (f->wkt != NULL && !is_behind) points_at += 54 + wkt_bytes;
    uint64_t extended_at = is_behind ? points_at + f->count * point_bytes : 0;
    write_header(&writer, f, scale, (uint32_t)points_at, extended_at, records);
    if (f->epsg != 0) write_record(&writer, false, 34735, keys, write_keys(f, keys));
    if (f->wkt != NULL && !is_behind) write_record(&writer, false, 2112, f->wkt, wkt_bytes);
    for (uint32_t i = 0; i < f->count; i++) write_point(&writer, f, scale, f->point(i));
    if (is_behind) write_record(&writer, true, 2112, f->wkt, wkt_bytes);
    *size_bytes = writer.at_bytes;
    return bytes;
}
