#include "tests/raster_maker.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void need(bool is_good, const char *what) {
    if (is_good) return;
    fprintf(stderr, "fixture: %s failed: %s\n", what, CPLGetLastErrorMsg());
    exit(99);
}

void make_raster(const struct raster_fixture *f) {
    GDALAllRegister();
    GDALDataType type = f->type == GDT_Unknown ? GDT_Float32 : f->type;
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), f->path, f->columns, f->rows, 1, type, NULL);
    need(dataset != NULL, f->path);
    double geotransform[6] = {f->west, f->pixel_x, 0, f->north, 0, -f->pixel_y};
    if (f->srs != NULL) {
        OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL);
        need(OSRSetFromUserInput(srs, f->srs) == OGRERR_NONE, f->srs);
        need(GDALSetSpatialRef(dataset, srs) == CE_None, "GDALSetSpatialRef");
        OSRDestroySpatialReference(srs);
    }
    if (f->pixel_x != 0) need(GDALSetGeoTransform(dataset, geotransform) == CE_None, "GDALSetGeoTransform");
    if (f->is_point) need(GDALSetMetadataItem(dataset, "AREA_OR_POINT", "Point", NULL) == CE_None, "AREA_OR_POINT");
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (f->has_nodata) {
        CPLErr failed = type == GDT_Int64    ? GDALSetRasterNoDataValueAsInt64(band, (int64_t)f->nodata)
                        : type == GDT_UInt64 ? GDALSetRasterNoDataValueAsUInt64(band, (uint64_t)f->nodata)
                                             : GDALSetRasterNoDataValue(band, f->nodata);
        need(failed == CE_None, "nodata");
    }
    if (f->unit != NULL) need(GDALSetRasterUnitType(band, f->unit) == CE_None, "unit");
    if (f->scale != 0) need(GDALSetRasterScale(band, f->scale) == CE_None, "scale");
    if (f->offset != 0) need(GDALSetRasterOffset(band, f->offset) == CE_None, "offset");
    double *row = malloc((size_t)f->columns * sizeof *row);
    need(row != NULL, "malloc");
    for (int j = 0; j < f->rows; j++) {
        for (int i = 0; i < f->columns; i++) {
            double x = geotransform[0] + (i + 0.5) * geotransform[1], y = geotransform[3] + (j + 0.5) * geotransform[5];
            row[i] = f->height(f->pixel_x != 0 ? x : i, f->pixel_x != 0 ? y : j);
        }
        need(GDALRasterIO(band, GF_Write, 0, j, f->columns, 1, row, f->columns, 1, GDT_Float64, 0, 0) == CE_None,
             "GDALRasterIO");
    }
    free(row);
    GDALClose(dataset);
}

bool open_raster(const struct raster_options *options, int zoom, struct opened *opened) {
    *opened = (struct opened){0};
    struct scree_error *error = &opened->error;
    if (raster_open(options, &opened->raster, error) != SCREE_OK) return false;
    const struct raster_summary *summary = opened->summary = raster_summary(opened->raster);
    enum scree_status status = SCREE_OK;
    if (options->profile == PROFILE_LOCAL)
        status =
            lattice_local(summary->columns, summary->rows, summary->bounds[0], summary->bounds[1], summary->spacing_x,
                          summary->spacing_y, summary->metres_per_unit, &opened->lattice, error);
    else
        opened->lattice = lattice_geodetic(zoom >= 0 ? zoom : lattice_zoom_for_spacing(summary->spacing_x));
    if (status == SCREE_OK) status = raster_place(opened->raster, &opened->lattice, error);
    if (status == SCREE_OK) status = raster_reader_new(opened->raster, &opened->reader, error);
    if (status != SCREE_OK) {
        raster_free(opened->raster);
        opened->raster = NULL;
    }
    return status == SCREE_OK;
}

bool open_one(const char *path, int zoom, struct opened *opened) {
    struct raster_options options = {.inputs = &path, .input_count = 1};
    return open_raster(&options, zoom, opened);
}

void close_raster(struct opened *opened) {
    raster_reader_free(opened->reader);
    raster_free(opened->raster);
    *opened = (struct opened){0};
}

float post_m(struct opened *opened, int64_t x, int64_t y) {
    float height_m = NAN;
    if (raster_read(opened->reader, x, y, 1, 1, &height_m, 1, &opened->error) != SCREE_OK) return NAN;
    return height_m;
}

int64_t column_of(const struct opened *opened, double x) {
    return llround((x - opened->lattice.west) / opened->lattice.spacing_x);
}

int64_t row_of(const struct opened *opened, double y) {
    return llround((y - opened->lattice.south) / opened->lattice.spacing_y);
}
