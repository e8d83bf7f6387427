/* A LAS file's coordinate system: WKT as it is, and GeoTIFF's keys by GDAL, which reads them from a GeoTIFF that is
 * made around them. */
#include "src/cloud_parts_io.h"
#include "src/raster_parts_io.h"
#include "stream/cursor.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <inttypes.h>
#include <ogr_srs_api.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_BYTES 65536 /* what a record that is not extended can hold */
enum { WKT = 2112, KEYS = 34735, NUMBERS = 34736, TEXTS = 34737 };
enum { SHORT = 3, LONG = 4, DOUBLE = 12, ASCII = 2 }; /* TIFF's types */

struct content {
    unsigned char *bytes; /* one more than it has, which is 0; NULL: there is none */
    size_t size_bytes;
};

struct projection {
    struct content wkt, keys, numbers, texts;
};

static struct content *place_of(struct projection *projection, const struct las_record *record) {
    if (!record->is_projection) return NULL;
    switch (record->id) {
    case WKT: return &projection->wkt;
    case KEYS: return &projection->keys;
    case NUMBERS: return &projection->numbers;
    case TEXTS: return &projection->texts;
    default: return NULL;
    }
}

/* Walks over records from a position to `end`, and keeps those of the projection. */
static enum scree_status read_records(const struct cloud_file *file, uint64_t at, uint64_t end, uint32_t count,
                                      bool is_extended, struct projection *projection, struct scree_error *error) {
    unsigned char front[LAS_EXTENDED_BYTES];
    size_t front_bytes = is_extended ? LAS_EXTENDED_BYTES : LAS_RECORD_BYTES;
    enum scree_status status = SCREE_OK;
    for (uint32_t i = 0; i < count && status == SCREE_OK; i++) {
        struct las_record record = {0};
        bool fits = end - at >= front_bytes;
        if (fits && (status = cloud_file_read(file, at, front, front_bytes, error)) != SCREE_OK) return status;
        if (fits) record = las_record_read(front, is_extended);
        if (!fits || record.size_bytes > end - at - front_bytes)
            return scree_fail(error, SCREE_E_CORRUPT,
                              "%s: its record %" PRIu32 " of %" PRIu32 " reaches beyond byte %" PRIu64, file->name,
                              i + 1, count, end);
        struct content *content = place_of(projection, &record);
        if (content != NULL && content->bytes == NULL && record.size_bytes <= LONGEST_BYTES) {
            content->size_bytes = (size_t)record.size_bytes;
            content->bytes = calloc(content->size_bytes + 1, 1);
            if (content->bytes == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
            status = cloud_file_read(file, at + front_bytes, content->bytes, content->size_bytes, error);
        }
        at += front_bytes + record.size_bytes;
    }
    return status;
}

static void write_entry(struct scree_writer *writer, uint16_t tag, uint16_t type, size_t count, size_t value) {
    scree_write_u16(writer, tag);
    scree_write_u16(writer, type);
    scree_write_u32(writer, (uint32_t)count);
    scree_write_u32(writer, (uint32_t)value);
}

/* A TIFF of one pixel with the keys; it takes the bytes that are returned, 0: no memory. */
static size_t make_tiff(const struct projection *projection, unsigned char **bytes) {
    enum { ENTRIES = 12, DATA_AT = 8 + 2 + ENTRIES * 12 + 4 + 2 };
    const struct content *keys = &projection->keys, *numbers = &projection->numbers, *texts = &projection->texts;
    size_t numbers_at = DATA_AT + 8, keys_at = numbers_at + numbers->size_bytes / 8 * 8;
    size_t texts_at = keys_at + keys->size_bytes / 2 * 2 + 8, size = texts_at + texts->size_bytes + 8;
    *bytes = calloc(size, 1);
    if (*bytes == NULL) return 0;
    struct scree_writer writer = scree_writer(*bytes, size);
    scree_write_bytes(&writer, "II*\0\10\0\0\0", 8);
    scree_write_u16(&writer, ENTRIES);
    write_entry(&writer, 256, SHORT, 1, 1);      /* columns */
    write_entry(&writer, 257, SHORT, 1, 1);      /* rows */
    write_entry(&writer, 258, SHORT, 1, 8);      /* bits of a sample */
    write_entry(&writer, 259, SHORT, 1, 1);      /* no compression */
    write_entry(&writer, 262, SHORT, 1, 1);      /* black is zero */
    write_entry(&writer, 273, LONG, 1, DATA_AT); /* where the pixel is */
    write_entry(&writer, 277, SHORT, 1, 1);      /* samples of a pixel */
    write_entry(&writer, 278, SHORT, 1, 1);      /* rows of a strip */
    write_entry(&writer, 279, LONG, 1, 1);       /* bytes of it */
    write_entry(&writer, KEYS, SHORT, keys->size_bytes / 2, keys_at);
    write_entry(&writer, NUMBERS, DOUBLE, numbers->size_bytes / 8, numbers_at);
    write_entry(&writer, TEXTS, ASCII, texts->size_bytes + 1, texts_at);
    memcpy(*bytes + keys_at, keys->bytes, keys->size_bytes / 2 * 2);
    if (numbers->bytes != NULL) memcpy(*bytes + numbers_at, numbers->bytes, numbers->size_bytes / 8 * 8);
    if (texts->bytes != NULL) memcpy(*bytes + texts_at, texts->bytes, texts->size_bytes);
    return size;
}

/* The CRS of GeoTIFF's keys, to be destroyed; NULL: GDAL sees none. */
static enum scree_status read_keys(const struct projection *projection, struct cloud_crs *crs,
                                   OGRSpatialReferenceH *found, struct scree_error *error) {
    char path[64];
    unsigned char *bytes;
    size_t size = make_tiff(projection, &bytes);
    if (size == 0) return scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
    snprintf(path, sizeof path, "/vsimem/scree-keys-%p.tif", (void *)bytes);
    VSILFILE *stream = VSIFileFromMemBuffer(path, bytes, size, FALSE);
    if (stream != NULL) VSIFCloseL(stream);
    GDALDatasetH dataset = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    OGRSpatialReferenceH own = dataset == NULL ? NULL : GDALGetSpatialRef(dataset);
    if (own != NULL) {
        *found = OSRClone(own);
        const char *unit = GDALGetRasterUnitType(GDALGetRasterBand(dataset, 1));
        if (unit != NULL) snprintf(crs->unit, sizeof crs->unit, "%s", unit);
    }
    GDALClose(dataset);
    VSIUnlink(path);
    free(bytes);
    return SCREE_OK;
}

static enum scree_status find_crs(const char *name, const struct projection *projection, bool prefers_wkt,
                                  struct cloud_crs *crs, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    OGRSpatialReferenceH found = NULL;
    bool has_wkt = projection->wkt.size_bytes > 0, has_keys = projection->keys.size_bytes >= 8;
    if (has_keys && !(has_wkt && prefers_wkt)) status = read_keys(projection, crs, &found, error);
    if (status == SCREE_OK && found == NULL && has_wkt) {
        char *text = (char *)projection->wkt.bytes; /* as WKT only: not as the name of a file or of a page */
        found = OSRNewSpatialReference(NULL);
        if (OSRImportFromWkt(found, &text) != OGRERR_NONE) {
            OSRDestroySpatialReference(found);
            found = NULL;
        }
    }
    char *wkt = NULL;
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    if (found != NULL && OSRExportToWktEx(found, &wkt, wkt2) == OGRERR_NONE && wkt != NULL) {
        crs->wkt = strdup(wkt);
        if (crs->wkt == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
    } else if (status == SCREE_OK && (has_wkt || has_keys)) {
        status =
            scree_fail(error, SCREE_E_UNSUPPORTED,
                       "%s: GDAL does not understand the coordinate system that it tells; name one with --s_srs", name);
    }
    CPLFree(wkt);
    if (found != NULL) OSRDestroySpatialReference(found);
    return status;
}

enum scree_status cloud_las_crs(const struct cloud_file *file, const struct las_header *header, struct cloud_crs *crs,
                                struct scree_error *error) {
    struct projection projection = {0};
    enum scree_status status =
        read_records(file, header->records_at, header->points_at, header->record_count, false, &projection, error);
    if (status == SCREE_OK)
        status =
            read_records(file, header->extended_at, file->size_bytes, header->extended_count, true, &projection, error);
    if (status == SCREE_OK) status = find_crs(file->name, &projection, header->has_wkt, crs, error);
    free(projection.wkt.bytes);
    free(projection.keys.bytes);
    free(projection.numbers.bytes);
    free(projection.texts.bytes);
    return status;
}
