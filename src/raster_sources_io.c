/* Opens and checks one input, reads its pixels as heights in metres, and scans it once for their range. */
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <float.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_HEIGHT_M    20000.0
#define SCAN_PIXELS     262144 /* of one read: 2 MB as doubles */
#define MAX_SCAN_PIXELS 2e13   /* the whole globe at 6 m; more is a header that lies */

void raster_input_free(struct raster_input *input) {
    free(input->name);
    free(input->dataset);
    free(input->crs_wkt);
    free(input->unit);
    *input = (struct raster_input){0};
}

static enum scree_status find_crs(const struct raster *raster, GDALDatasetH dataset, struct raster_input *input,
                                  const struct raster_trap *trap, struct scree_error *error) {
    OGRSpatialReferenceH crs = NULL;
    if (input->crs_wkt != NULL) return SCREE_OK;
    if (raster->source_srs != NULL) {
        crs = OSRNewSpatialReference(NULL);
        if (OSRSetFromUserInput(crs, raster->source_srs) != OGRERR_NONE) {
            OSRDestroySpatialReference(crs);
            return scree_fail(error, SCREE_E_ARGUMENT, "--s_srs %s: not a coordinate system that PROJ knows%s%s",
                              raster->source_srs, trap->text[0] ? ": " : "", trap->text);
        }
    } else {
        OGRSpatialReferenceH own = GDALGetSpatialRef(dataset);
        if (own != NULL) crs = OSRClone(own);
    }
    /* netCDF files of old name their axes' units and leave the rest to common sense. */
    if (crs == NULL && input->has_geotransform) {
        char **metadata = GDALGetMetadata(dataset, NULL);
        bool has_longitudes = false, has_latitudes = false;
        for (int i = 0; i < CSLCount(metadata); i++) {
            has_longitudes = has_longitudes || strstr(metadata[i], "#units=degrees_east") != NULL;
            has_latitudes = has_latitudes || strstr(metadata[i], "#units=degrees_north") != NULL;
        }
        if (has_longitudes && has_latitudes) {
            crs = OSRNewSpatialReference(NULL);
            if (OSRImportFromEPSG(crs, 4326) != OGRERR_NONE) {
                OSRDestroySpatialReference(crs);
                return raster_trap_fail(trap, "EPSG:4326", error);
            }
        }
    }
    if (crs == NULL) {
        input->crs_wkt = strdup("");
        return input->crs_wkt != NULL ? SCREE_OK : scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
    }
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    char *wkt = NULL;
    OGRErr failed = OSRExportToWktEx(crs, &wkt, wkt2);
    OSRDestroySpatialReference(crs);
    if (failed == OGRERR_NONE && wkt != NULL) input->crs_wkt = strdup(wkt);
    CPLFree(wkt);
    if (input->crs_wkt == NULL)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: its coordinate system cannot be told; name one with --s_srs",
                          input->name);
    return SCREE_OK;
}

static enum scree_status find_geotransform(const struct raster *raster, GDALDatasetH dataset,
                                           struct raster_input *input, struct scree_error *error) {
    double *g = input->geotransform;
    input->has_geotransform = GDALGetGeoTransform(dataset, g) == CE_None;
    if (!input->has_geotransform) {
        if (raster->options.profile == PROFILE_GEODETIC)
            return scree_fail(error, SCREE_E_ARGUMENT,
                              GDALGetGCPCount(dataset) > 0
                                  ? "%s: has control points but no geotransform; gdalwarp it first"
                                  : "%s: has no georeference; for a terrain in its own pixels use --profile local",
                              input->name);
        double pixels[6] = {0, 1, 0, input->rows, 0, -1}; /* the first row is the northern one */
        memcpy(g, pixels, sizeof pixels);
    }
    double inverse[6];
    for (int i = 0; i < 6; i++)
        if (!isfinite(g[i]) || fabs(g[i]) > 1e15)
            return scree_fail(error, SCREE_E_CORRUPT, "%s: its geotransform holds %g, which is no position on Earth",
                              input->name, g[i]);
    if (!GDALInvGeoTransform(g, inverse))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: its pixels have no size (geotransform %g %g %g %g %g %g)",
                          input->name, g[0], g[1], g[2], g[3], g[4], g[5]);
    return SCREE_OK;
}

/* From what the file holds to metres: scale and offset, then the unit that the band names, or else the CRS. */
static enum scree_status find_units(GDALRasterBandH band, struct raster_input *input, struct scree_error *error) {
    int has_scale = FALSE, has_offset = FALSE;
    double scale = GDALGetRasterScale(band, &has_scale), offset = GDALGetRasterOffset(band, &has_offset);
    input->scale = has_scale ? scale : 1;
    input->offset = has_offset ? offset : 0;
    if (!isfinite(input->scale) || input->scale == 0 || !isfinite(input->offset))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: scale %g and offset %g make no heights", input->name,
                          input->scale, input->offset);
    PJ_CONTEXT *proj = raster_proj_new();
    if (proj == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for PROJ");
    double metres = 1, vertical_metres = 1;
    bool has_vertical = raster_vertical_metres(proj, input->crs_wkt, &vertical_metres);
    const char *unit = GDALGetRasterUnitType(band);
    if (unit == NULL) unit = "";
    if (unit[0] != '\0' && raster_unit_metres(proj, unit, &metres)) {
        if (has_vertical && vertical_metres < 0) metres = -metres;
    } else {
        metres = vertical_metres;
    }
    bool is_unknown = unit[0] != '\0' && !has_vertical && !raster_unit_metres(proj, unit, &vertical_metres);
    input->unit = strdup(is_unknown ? unit : "");
    proj_context_destroy(proj);
    if (input->unit == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for a unit");
    input->scale *= metres;
    input->offset *= metres;
    return SCREE_OK;
}

static enum scree_status check_band(const struct raster *raster, GDALDatasetH dataset, struct raster_input *input,
                                    struct scree_error *error) {
    input->columns = GDALGetRasterXSize(dataset);
    input->rows = GDALGetRasterYSize(dataset);
    int bands = GDALGetRasterCount(dataset);
    input->band = raster->options.band > 0 ? raster->options.band : 1;
    if (bands == 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: has no raster band; if it holds subdatasets, name one",
                          input->name);
    if (input->columns <= 0 || input->rows <= 0)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: has %d x %d pixels", input->name, input->columns, input->rows);
    if (input->band > bands)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: has no band %d, only %d", input->name, input->band, bands);
    GDALRasterBandH band = GDALGetRasterBand(dataset, input->band);
    GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsComplex(type))
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: band %d holds complex numbers, not heights", input->name,
                          input->band);
    input->is_wide = type != GDT_Float32 && GDALGetDataTypeSizeBits(type) > 16;
    int has_nodata = FALSE;
    double nodata = type == GDT_Int64    ? (double)GDALGetRasterNoDataValueAsInt64(band, &has_nodata)
                    : type == GDT_UInt64 ? (double)GDALGetRasterNoDataValueAsUInt64(band, &has_nodata)
                                         : GDALGetRasterNoDataValue(band, &has_nodata);
    input->has_nodata = raster->options.has_nodata || has_nodata;
    input->nodata = raster->options.has_nodata ? raster->options.nodata : nodata;
    if (!input->is_wide && isfinite(input->nodata)) /* what a float band holds is the nearest float */
        input->nodata = (float)fmin(fmax(input->nodata, -(double)FLT_MAX), (double)FLT_MAX);
    int mask = GDALGetMaskFlags(band);
    input->has_mask = (mask & (GMF_ALL_VALID | GMF_NODATA)) == 0;
    return SCREE_OK;
}

enum scree_status raster_input_open(const struct raster *raster, const char *name, const char *dataset_name,
                                    struct raster_input *input, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct raster_trap trap;
    raster_trap_set(&trap);
    GDALDatasetH dataset = NULL;
    input->name = strdup(name);
    input->dataset = strdup(dataset_name);
    if (input->name == NULL || input->dataset == NULL) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for the name of an input");
        goto cleanup;
    }
    dataset = GDALOpenEx(dataset_name, GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, NULL, NULL, NULL);
    if (dataset == NULL) {
        status = raster_trap_fail(&trap, name, error);
        goto cleanup;
    }
    status = check_band(raster, dataset, input, error);
    if (status == SCREE_OK) status = find_geotransform(raster, dataset, input, error);
    if (status == SCREE_OK) status = find_crs(raster, dataset, input, &trap, error);
    if (status == SCREE_OK) status = find_units(GDALGetRasterBand(dataset, input->band), input, error);
    if (status == SCREE_OK && raster->options.profile == PROFILE_GEODETIC && input->crs_wkt[0] == '\0')
        status = scree_fail(error, SCREE_E_ARGUMENT,
                            "%s: names no coordinate system; name it with --s_srs, or use --profile local", name);
cleanup:
    GDALClose(dataset);
    raster_trap_clear();
    return status;
}

static void clean_floats(const struct raster_input *input, float *heights_m, size_t count) {
    float nodata = (float)input->nodata;
    bool is_plain = input->scale == 1 && input->offset == 0;
    if (!input->has_nodata) nodata = NAN;
    if (is_plain) {
        for (size_t i = 0; i < count; i++)
            if (heights_m[i] == nodata || !isfinite(heights_m[i])) heights_m[i] = NAN;
        return;
    }
    for (size_t i = 0; i < count; i++)
        heights_m[i] = heights_m[i] == nodata || !isfinite(heights_m[i])
                           ? NAN
                           : (float)(heights_m[i] * input->scale + input->offset);
}

static void clean_doubles(const struct raster_input *input, const double *values, float *heights_m, size_t count) {
    double nodata = input->has_nodata ? input->nodata : NAN;
    for (size_t i = 0; i < count; i++) {
        double height_m = values[i] * input->scale + input->offset;
        bool is_void = values[i] == nodata || !isfinite(height_m);
        heights_m[i] = is_void ? NAN : (float)fmin(fmax(height_m, -(double)FLT_MAX), (double)FLT_MAX);
    }
}

static CPLErr apply_mask(GDALRasterBandH band, int column, int row, int columns, int rows, float *heights_m) {
    unsigned char *mask = VSI_MALLOC3_VERBOSE(1, (size_t)columns, (size_t)rows);
    if (mask == NULL) return CE_Failure;
    CPLErr failed =
        GDALRasterIO(GDALGetMaskBand(band), GF_Read, column, row, columns, rows, mask, columns, rows, GDT_Byte, 0, 0);
    if (failed == CE_None)
        for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++)
            if (mask[i] == 0) heights_m[i] = NAN;
    VSIFree(mask);
    return failed;
}

CPLErr raster_input_read(const struct raster_input *input, GDALDatasetH dataset, int column, int row, int columns,
                         int rows, float *heights_m) {
    GDALRasterBandH band = GDALGetRasterBand(dataset, input->band);
    if (band == NULL) {
        CPLError(CE_Failure, CPLE_AppDefined, "%s: changed while it was read", input->name);
        return CE_Failure;
    }
    size_t count = (size_t)columns * (size_t)rows;
    CPLErr failed;
    if (input->is_wide) {
        double *values = VSI_MALLOC3_VERBOSE(sizeof *values, (size_t)columns, (size_t)rows);
        if (values == NULL) return CE_Failure;
        failed = GDALRasterIO(band, GF_Read, column, row, columns, rows, values, columns, rows, GDT_Float64, 0, 0);
        if (failed == CE_None) clean_doubles(input, values, heights_m, count);
        VSIFree(values);
    } else {
        failed = GDALRasterIO(band, GF_Read, column, row, columns, rows, heights_m, columns, rows, GDT_Float32, 0, 0);
        if (failed == CE_None) clean_floats(input, heights_m, count);
    }
    if (failed == CE_None && input->has_mask) failed = apply_mask(band, column, row, columns, rows, heights_m);
    return failed;
}

static enum scree_status check_height(const struct raster *raster, const struct raster_input *input, double height_m,
                                      struct scree_error *error) {
    if (raster->options.any_height || fabs(height_m) <= MAX_HEIGHT_M) return SCREE_OK;
    double value = (height_m - input->offset) / input->scale;
    return scree_fail(
        error, SCREE_E_CORRUPT,
        "%s: a pixel holds %.9g, a height of %.9g m; if that means no data use -a_nodata %.9g, if it is a "
        "height use --any-height",
        input->name, value, height_m, value);
}

static enum scree_status scan_window(struct raster *raster, const struct raster_input *input, GDALDatasetH dataset,
                                     const int window[4], float *heights_m, struct raster_range *range,
                                     struct scree_error *error) {
    struct raster_trap trap;
    raster_trap_set(&trap);
    CPLErr failed = raster_input_read(input, dataset, window[0], window[1], window[2], window[3], heights_m);
    raster_trap_clear();
    if (failed != CE_None) return raster_trap_fail(&trap, input->name, error);
    float min_m = INFINITY, max_m = -INFINITY;
    size_t count = (size_t)window[2] * (size_t)window[3];
    for (size_t i = 0; i < count; i++) {
        float h = heights_m[i]; /* comparisons with NaN are false */
        min_m = h < min_m ? h : min_m;
        max_m = h > max_m ? h : max_m;
    }
    if (min_m > max_m) return SCREE_OK;
    raster_enclosed_add(&raster->groups[input->group], input->group_column + window[0], input->group_row + window[1],
                        window[2], window[3], heights_m);
    enum scree_status status = check_height(raster, input, min_m, error);
    if (status == SCREE_OK) status = check_height(raster, input, max_m, error);
    range->min_m = range->has_heights ? fmin(range->min_m, min_m) : min_m;
    range->max_m = range->has_heights ? fmax(range->max_m, max_m) : max_m;
    range->has_heights = true;
    return status;
}

/* Windows of whole blocks where they are small, and of pieces of blocks where they are not. */
static void scan_shape(GDALRasterBandH band, const int window[4], int *columns, int *rows) {
    int block_columns, block_rows;
    GDALGetBlockSize(band, &block_columns, &block_rows);
    if (block_columns < 1 || block_columns > window[2]) block_columns = window[2];
    *columns = block_columns;
    while (*columns <= window[2] / 2 && *columns < 4096) *columns *= 2;
    if (*columns > SCAN_PIXELS / 4) *columns = SCAN_PIXELS / 4;
    int fitting = SCAN_PIXELS / *columns;
    if (block_rows < 1) block_rows = 1;
    *rows = fitting > block_rows ? fitting / block_rows * block_rows : fitting;
}

/* GDAL knows of sparse files which windows are empty; a window half a raster wide may be skipped at once. */
static bool is_empty(GDALRasterBandH band, int column, int row, int columns, int rows) {
    int coverage = GDALGetDataCoverageStatus(band, column, row, columns, rows, 0, NULL);
    return coverage == GDAL_DATA_COVERAGE_STATUS_EMPTY;
}

enum scree_status raster_input_scan(struct raster *raster, const struct raster_input *input, const int window[4],
                                    struct raster_range *range, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    float *heights_m = NULL;
    struct raster_trap trap;
    raster_trap_set(&trap);
    GDALDatasetH dataset = GDALOpenEx(input->dataset, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (dataset == NULL) {
        status = raster_trap_fail(&trap, input->name, error);
        goto cleanup;
    }
    if ((double)window[2] * window[3] > MAX_SCAN_PIXELS) {
        status = scree_fail(error, SCREE_E_LIMIT, "%s: %d x %d pixels cannot be read in a lifetime; crop with --te",
                            input->name, window[2], window[3]);
        goto cleanup;
    }
    GDALRasterBandH band = GDALGetRasterBand(dataset, input->band);
    int columns, rows;
    scan_shape(band, window, &columns, &rows);
    heights_m = VSI_MALLOC3_VERBOSE(sizeof *heights_m, (size_t)columns, (size_t)rows);
    if (heights_m == NULL) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory to read %s", input->name);
        goto cleanup;
    }
    int right = window[0] + window[2], bottom = window[1] + window[3];
    for (int row = window[1]; row < bottom && status == SCREE_OK; row += rows) {
        int height = bottom - row < rows ? bottom - row : rows;
        trap.text[0] = '\0';
        if (is_empty(band, window[0], row, window[2], height)) {
            if (trap.text[0] == '\0') continue;
            status = raster_trap_fail(&trap, input->name, error);
            break;
        }
        for (int column = window[0]; column < right && status == SCREE_OK; column += columns) {
            int width = right - column < columns ? right - column : columns;
            int piece[4] = {column, row, width, height};
            status = scan_window(raster, input, dataset, piece, heights_m, range, error);
            if (column > right - columns) break; /* the next one could overflow */
        }
        if (row > bottom - rows) break;
    }
cleanup:
    VSIFree(heights_m);
    GDALClose(dataset);
    raster_trap_clear();
    return status;
}
