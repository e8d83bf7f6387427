/* fractal_dem: writes the fractal terrain of tests/fractal.h as a tiled GeoTIFF, block by block, so that a raster of
 * any size takes the memory of one block. `fractal_dem --help` lists the options. */
#include "tests/fractal.h"

#include <gdal.h>
#include <ogr_srs_api.h>

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 512 };

struct request {
    const char *path, *compress;
    int columns, rows;
    GDALDataType type;
    uint64_t seed;
    int epsg;
    double west, south, spacing; /* of the south-western pixel's centre, in degrees or metres */
};

static const char help[] = "Usage: fractal_dem -o FILE.tif [options]\n"
                           "Writes seeded fractal terrain as a tiled GeoTIFF.\n"
                           "  --size N            pixels a side (2048)\n"
                           "  --rows N            rows, where they are not as many as columns\n"
                           "  --type TYPE         Int16 (default) or Float32\n"
                           "  --seed N            another terrain (1)\n"
                           "  --compress NAME     DEFLATE (default) or NONE\n"
                           "  --west --south DEG  centre of the south-western pixel in EPSG:4326 (6, 44)\n"
                           "  --spacing-deg D     pixel spacing in degrees (1/3600)\n"
                           "  --epsg N            a projected CRS in metres instead (origin at 400000, 3800000)\n"
                           "  --spacing-m M       pixel spacing in metres (30)\n";

static bool read_number(const char *text, double least, double most, double *number) {
    char *end;
    errno = 0;
    *number = strtod(text, &end);
    return end != text && *end == '\0' && errno == 0 && *number >= least && *number <= most;
}

static bool read_whole(const char *text, double least, double most, int *whole) {
    double number;
    if (!read_number(text, least, most, &number) || number != floor(number)) return false;
    *whole = (int)number;
    return true;
}

/* One option and its value; false: unknown, or a value out of range. */
static bool take_option(struct request *request, const char *name, const char *value) {
    int seed;
    if (strcmp(name, "-o") == 0) {
        request->path = value;
        return true;
    }
    if (strcmp(name, "--size") == 0) {
        bool fine = read_whole(value, 2, 1 << 30, &request->columns);
        request->rows = request->columns;
        return fine;
    }
    if (strcmp(name, "--rows") == 0) return read_whole(value, 2, 1 << 30, &request->rows);
    if (strcmp(name, "--seed") == 0) {
        bool fine = read_whole(value, 0, 1 << 30, &seed);
        if (fine) request->seed = (uint64_t)seed;
        return fine;
    }
    if (strcmp(name, "--type") == 0) {
        request->type = GDALGetDataTypeByName(value);
        return request->type == GDT_Int16 || request->type == GDT_Float32;
    }
    if (strcmp(name, "--compress") == 0) {
        request->compress = value;
        return strcmp(value, "DEFLATE") == 0 || strcmp(value, "NONE") == 0;
    }
    if (strcmp(name, "--west") == 0) return read_number(value, -180, 180, &request->west);
    if (strcmp(name, "--south") == 0) return read_number(value, -90, 90, &request->south);
    if (strcmp(name, "--spacing-deg") == 0) return read_number(value, 1e-7, 10, &request->spacing);
    if (strcmp(name, "--epsg") == 0) {
        request->west = 400000;
        request->south = 3800000;
        request->spacing = 30;
        return read_whole(value, 1024, 32767, &request->epsg);
    }
    if (strcmp(name, "--spacing-m") == 0) return read_number(value, 1e-3, 1e5, &request->spacing);
    return false;
}

static GDALDatasetH create_raster(const struct request *request) {
    char compress[32];
    snprintf(compress, sizeof compress, "COMPRESS=%s", request->compress);
    const char *predictor = request->type == GDT_Int16 ? "PREDICTOR=2" : "PREDICTOR=3";
    bool packed = strcmp(request->compress, "NONE") != 0;
    const char *options[] = {"TILED=YES", "BLOCKXSIZE=512",          "BLOCKYSIZE=512", "BIGTIFF=IF_SAFER",

                             compress,    packed ? predictor : NULL, "ZLEVEL=1",       NULL};
    GDALDatasetH raster = GDALCreate(GDALGetDriverByName("GTiff"), request->path, request->columns, request->rows, 1,
                                     request->type, (CSLConstList)options);
    if (raster == NULL) return NULL;
    /* GDAL counts from the north-western corner of the north-western pixel. */
    double step = request->spacing, half = step / 2;
    double transform[6] = {request->west - half, step, 0, request->south + (request->rows - 1) * step + half, 0, -step};
    OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL);
    bool fine = OSRImportFromEPSG(srs, request->epsg) == OGRERR_NONE && GDALSetSpatialRef(raster, srs) == CE_None &&
                GDALSetGeoTransform(raster, transform) == CE_None;
    OSRDestroySpatialReference(srs);
    if (fine) return raster;
    GDALClose(raster);
    return NULL;
}

/* Raster rows run from the north, the fractal's from the south: the block is read back to front. */
static bool write_block(const struct request *request, GDALRasterBandH band, int column, int row, float *heights_m) {
    int columns = request->columns - column < BLOCK ? request->columns - column : BLOCK;
    int rows = request->rows - row < BLOCK ? request->rows - row : BLOCK;
    struct fractal fractal = {.seed = request->seed, .whole_metres = request->type == GDT_Int16};
    fractal_window(&fractal, column, request->rows - row - rows, columns, rows, heights_m, columns);
    float *northern = heights_m + (size_t)columns * (size_t)(rows - 1);
    return GDALRasterIO(band, GF_Write, column, row, columns, rows, northern, columns, rows, GDT_Float32, 0,
                        -columns * (int)sizeof *heights_m) == CE_None;
}

static bool write_raster(const struct request *request) {
    static float heights_m[BLOCK * BLOCK];
    GDALDatasetH raster = create_raster(request);
    if (raster == NULL) return false;
    GDALRasterBandH band = GDALGetRasterBand(raster, 1);
    bool fine = true;
    for (int row = 0; row < request->rows && fine; row += BLOCK)
        for (int column = 0; column < request->columns && fine; column += BLOCK)
            fine = write_block(request, band, column, row, heights_m);
    GDALFlushCache(raster);
    GDALClose(raster);
    return fine && CPLGetLastErrorType() < CE_Failure;
}

int main(int argc, char **argv) {
    struct request request = {.compress = "DEFLATE", .columns = 2048, .rows = 2048, .type = GDT_Int16};
    request.seed = 1;
    request.epsg = 4326;
    request.west = 6;
    request.south = 44;
    request.spacing = 1.0 / 3600;
    for (int i = 1; i < argc; i += 2) {
        if (strcmp(argv[i], "--help") == 0) {
            fputs(help, stdout);
            return 0;
        }
        if (i + 1 == argc || !take_option(&request, argv[i], argv[i + 1])) {
            fprintf(stderr, "fractal_dem: %s %s: no such option or value; see --help\n", argv[i],
                    i + 1 < argc ? argv[i + 1] : "");
            return 2;
        }
    }
    if (request.path == NULL) {
        fputs("fractal_dem: -o FILE.tif is missing; see --help\n", stderr);
        return 2;
    }
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    GDALSetCacheMax64(64 << 20);
    if (write_raster(&request)) return 0;
    fprintf(stderr, "fractal_dem: %s: %s\n", request.path, CPLGetLastErrorMsg());
    return 1;
}
