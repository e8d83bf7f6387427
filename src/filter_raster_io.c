/* Rasters in and out for `scree filter`: see the header. */
#include "src/filter_raster_io.h"

#include "lod/post_gaps.h"
#include "src/file_io.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_AT_ONCE    256
#define MOST_SIDE       (1 << 30)
#define BYTES_A_MB      1000000
#define NODATA          (-32768.0)
#define MEMORY_FILE     "/vsimem/scree-filtered.tif"
#define CRS_FILE        "/vsimem/scree-crs.tif"
#define LOWEST_HEIGHT_M (-1e29) /* what is lower is FILTER_NO_HEIGHT_M */

static char *copied(struct scree_memory *memory, const char *text, struct scree_error *error) {
    const size_t length = strlen(text) + 1;
    char *copy = scree_allocate(memory, length, 1, "words of a raster", error);
    if (copy != NULL) memcpy(copy, text, length);
    return copy;
}

static enum scree_status lay_out(struct scree_memory *memory, const char *name, const struct raster_summary *summary,
                                 struct filter_raster *raster, struct lattice *lattice, struct scree_error *error) {
    const double bytes = (double)FILTER_POST_BYTES * (double)summary->columns * (double)summary->rows;
    if (summary->columns > MOST_SIDE || summary->rows > MOST_SIDE ||
        (memory->limit_bytes > 0 && bytes > (double)memory->limit_bytes))
        return scree_fail(
            error, SCREE_E_LIMIT,
            "%s: to filter %lld x %lld posts takes %.0f MB of memory; allow that with --filter-memory, or crop "
            "with --te of scree filter",
            name, (long long)summary->columns, (long long)summary->rows, bytes / BYTES_A_MB + 1);
    enum scree_status status =
        lattice_local(summary->columns, summary->rows, summary->bounds[0], summary->bounds[1], summary->spacing_x,
                      summary->spacing_y, summary->metres_per_unit, lattice, error);
    if (status != SCREE_OK) return status;
    raster->columns = (int32_t)summary->columns;
    raster->rows = (int32_t)summary->rows;
    raster->west = lattice->west;
    raster->south = lattice->south;
    raster->spacing_x = lattice->spacing_x;
    raster->spacing_y = lattice->spacing_y;
    raster->crs_wkt = copied(memory, summary->crs_wkt, error);
    raster->attribution = copied(memory, summary->attribution, error);
    return raster->crs_wkt != NULL && raster->attribution != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

static enum scree_status read_heights(struct scree_memory *memory, const struct raster *from,
                                      struct filter_raster *raster, struct scree_error *error) {
    struct raster_reader *reader = NULL;
    enum scree_status status = raster_reader_new(from, &reader, error);
    if (status != SCREE_OK) return status;
    const int32_t columns = raster->columns, rows = raster->rows;
    raster->heights_m = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *raster->heights_m,
                                       "the raster's heights", error);
    if (raster->heights_m == NULL) status = SCREE_E_MEMORY;
    for (int32_t y = 0; y < rows && status == SCREE_OK; y += ROWS_AT_ONCE) {
        const int32_t here = rows - y < ROWS_AT_ONCE ? rows - y : ROWS_AT_ONCE;
        status = raster_read(reader, 0, y, columns, here, raster->heights_m + (int64_t)y * columns, columns, error);
    }
    raster_reader_free(reader);
    return status;
}

static enum scree_status find_outside(struct scree_memory *memory, const char *name, struct filter_raster *raster,
                                      struct scree_error *error) {
    const size_t count = (size_t)raster->columns * (size_t)raster->rows;
    size_t post = 0;
    while (post < count && raster->heights_m[post] > LOWEST_HEIGHT_M) post++;
    if (post == count) return SCREE_OK;
    raster->is_outside = scree_allocate(memory, count, 1, "posts without data", error);
    if (raster->is_outside == NULL) return SCREE_E_MEMORY;
    for (; post < count; post++) raster->is_outside[post] = raster->heights_m[post] <= LOWEST_HEIGHT_M;
    return post_gaps_fill(raster->heights_m, raster->is_outside, raster->columns, raster->rows)
               ? SCREE_OK
               : scree_fail(error, SCREE_E_CORRUPT, "%s: holds no height, all of its pixels are nodata", name);
}

enum scree_status filter_raster_read(struct scree_memory *memory, const struct raster_options *options,
                                     struct filter_raster *raster, struct scree_error *error) {
    struct raster *from = NULL;
    struct lattice lattice;
    *raster = (struct filter_raster){.heights_m = NULL};
    enum scree_status status = raster_open(options, &from, error);
    const char *name = options->inputs[0];
    if (status == SCREE_OK) status = lay_out(memory, name, raster_summary(from), raster, &lattice, error);
    if (status == SCREE_OK) status = raster_place(from, &lattice, error);
    if (status == SCREE_OK) status = read_heights(memory, from, raster, error);
    if (status == SCREE_OK) status = find_outside(memory, name, raster, error);
    raster_free(from);
    return status;
}

void filter_raster_free(struct scree_memory *memory, struct filter_raster *raster) {
    scree_release(memory, raster->is_outside);
    scree_release(memory, raster->heights_m);
    scree_release(memory, raster->attribution);
    scree_release(memory, raster->crs_wkt);
    *raster = (struct filter_raster){.heights_m = NULL};
}

/* ---- writing ---- */

/* A CRS as GeoTIFF tells it: a vertical part without a code is lost, or turned upwards. NULL: none at all. */
static OGRSpatialReferenceH told_new(const char *crs_wkt) {
    const bool is_set = CPLGetConfigOption("GTIFF_REPORT_COMPD_CS", NULL) != NULL;
    OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL), told = NULL;
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), CRS_FILE, 1, 1, 1, GDT_Byte, NULL);
    if (dataset != NULL && OSRSetFromUserInput(srs, crs_wkt) == OGRERR_NONE) GDALSetSpatialRef(dataset, srs);
    OSRDestroySpatialReference(srs);
    GDALClose(dataset);
    if (!is_set) CPLSetThreadLocalConfigOption("GTIFF_REPORT_COMPD_CS", "YES");
    dataset = GDALOpenEx(CRS_FILE, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!is_set) CPLSetThreadLocalConfigOption("GTIFF_REPORT_COMPD_CS", NULL);
    srs = dataset != NULL ? GDALGetSpatialRef(dataset) : NULL;
    if (srs != NULL) told = OSRClone(srs);
    if (told != NULL) OSRSetAxisMappingStrategy(told, OAMS_TRADITIONAL_GIS_ORDER);
    GDALClose(dataset);
    VSIUnlink(CRS_FILE);
    return told;
}

/* 1, or -1 where the CRS counts depths: readers turn heights of such a raster. */
static float sign_of_heights(const char *crs_wkt) {
    PJ_CONTEXT *proj = raster_proj_new();
    double metres = 1;
    if (proj != NULL) raster_vertical_metres(proj, crs_wkt, &metres);
    proj_context_destroy(proj);
    return metres < 0 ? -1 : 1;
}

static float sign_of_told(OGRSpatialReferenceH told) {
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    char *wkt = NULL;
    const float sign = OSRExportToWktEx(told, &wkt, wkt2) == OGRERR_NONE ? sign_of_heights(wkt) : 1;
    CPLFree(wkt);
    return sign;
}

static bool describe(const struct filter_raster *raster, GDALDatasetH dataset) {
    const double north = raster->south + (raster->rows - 1) * raster->spacing_y;
    double transform[6] = {raster->west - raster->spacing_x / 2,
                           raster->spacing_x,
                           0,
                           north + raster->spacing_y / 2,
                           0,
                           -raster->spacing_y};
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    bool fine = GDALSetGeoTransform(dataset, transform) == CE_None && GDALSetRasterUnitType(band, "metre") == CE_None;
    if (raster->attribution[0] != '\0')
        fine = fine && GDALSetMetadataItem(dataset, "TIFFTAG_COPYRIGHT", raster->attribution, NULL) == CE_None;
    if (raster->is_outside != NULL) fine = fine && GDALSetRasterNoDataValue(band, NODATA) == CE_None;
    return fine;
}

static bool fill_dataset(const struct filter_raster *raster, const float *heights_m, float sign, GDALDatasetH dataset) {
    const int32_t columns = raster->columns;
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    float *row_m = malloc((size_t)columns * sizeof *row_m);
    bool fine = row_m != NULL;
    for (int32_t row = 0; row < raster->rows && fine; row++) {
        const size_t first = (size_t)(raster->rows - 1 - row) * (size_t)columns;
        for (int32_t x = 0; x < columns; x++) {
            const bool is_outside = raster->is_outside != NULL && raster->is_outside[first + (size_t)x];
            row_m[x] = is_outside ? (float)NODATA : sign * heights_m[first + (size_t)x];
        }
        fine = GDALRasterIO(band, GF_Write, 0, row, columns, 1, row_m, columns, 1, GDT_Float32, 0, 0) == CE_None;
    }
    free(row_m);
    return fine;
}

/* The file in memory, whole; the caller has set the trap. `told` may be NULL: no CRS. */
static bool make(const struct filter_raster *raster, const float *heights_m, float sign, OGRSpatialReferenceH told,
                 const char *path, const char *const *options) {
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), path, raster->columns, raster->rows, 1, GDT_Float32,
                                      (CSLConstList)options);
    bool fine = dataset != NULL && describe(raster, dataset);
    if (told != NULL) fine = fine && GDALSetSpatialRef(dataset, told) == CE_None;
    fine = fine && fill_dataset(raster, heights_m, sign, dataset);
    GDALClose(dataset);
    return fine;
}

enum scree_status filter_raster_write(const struct filter_raster *raster, const float *heights_m, const char *path,
                                      struct scree_error *error) {
    static const char *const options[] = {"TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3", "BIGTIFF=IF_SAFER", NULL};
    struct raster_trap trap;
    raster_trap_set(&trap);
    OGRSpatialReferenceH told = raster->crs_wkt[0] != '\0' ? told_new(raster->crs_wkt) : NULL;
    const float sign = told != NULL ? sign_of_told(told) : 1;
    trap.text[0] = '\0'; /* what GeoTIFF cannot tell is left out */
    const bool fine = make(raster, heights_m, sign, told, MEMORY_FILE, options) && trap.text[0] == '\0';
    vsi_l_offset size_bytes = 0;
    const unsigned char *bytes = VSIGetMemFileBuffer(MEMORY_FILE, &size_bytes, FALSE);
    enum scree_status status = SCREE_OK;
    if (fine && bytes != NULL)
        status = file_replace(path, bytes, (size_t)size_bytes, error);
    else
        status = raster_trap_fail(&trap, path, error);
    VSIUnlink(MEMORY_FILE);
    if (told != NULL) OSRDestroySpatialReference(told);
    raster_trap_clear();
    return status;
}

enum scree_status filter_raster_keep(const struct filter_raster *raster, const float *heights_m, const char *path,
                                     const char *name, struct scree_error *error) {
    static const char *const options[] = {"TILED=YES", "BIGTIFF=IF_SAFER", NULL};
    struct raster_trap trap;
    raster_trap_set(&trap);
    enum scree_status status = SCREE_OK;
    const bool fine = make(raster, heights_m, sign_of_heights(raster->crs_wkt), NULL, path, options);
    if (!fine || trap.text[0] != '\0') status = raster_trap_fail(&trap, name, error);
    raster_trap_clear();
    return status;
}
