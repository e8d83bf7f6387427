/* Rasters made by code for the tests of raster_io: GeoTIFFs in GDAL's memory files, whose heights are a function of
 * the position of the pixel's centre. */
#ifndef SCREE_TESTS_RASTER_MAKER_H
#define SCREE_TESTS_RASTER_MAKER_H

#include "src/raster_io.h"

#include <gdal.h>

typedef double (*height_function)(double x, double y);

struct raster_fixture {
    const char *path; /* "/vsimem/..." */
    int columns, rows;
    double west, north;      /* outer corner of the first pixel */
    double pixel_x, pixel_y; /* positive; pixel_y < 0: the first row is the southern one, `north` the southern edge */
    const char *srs;         /* NULL: none */
    GDALDataType type;       /* 0: Float32 */
    height_function height;
    bool has_nodata;
    double nodata;
    const char *unit;     /* of the band; NULL: none */
    double scale, offset; /* of the band; 0: none */
    bool is_point;        /* PixelIsPoint: the file's tie point is a pixel's centre */
};

/* Makes the file; stops the test program when GDAL cannot. */
void make_raster(const struct raster_fixture *fixture);

/* A raster opened, placed and ready to be read. */
struct opened {
    struct raster *raster;
    struct raster_reader *reader;
    struct lattice lattice;
    const struct raster_summary *summary;
    struct scree_error error;
};

/* `zoom` < 0: as the source's resolution asks. Returns false and keeps the error when it fails. */
bool open_raster(const struct raster_options *options, int zoom, struct opened *opened);
/* The same for one input in the geodetic profile with all else at its default. */
bool open_one(const char *path, int zoom, struct opened *opened);
void close_raster(struct opened *opened);

/* The height of one post, NaN when it cannot be read. */
float post_m(struct opened *opened, int64_t x, int64_t y);
/* The lattice column and row nearest to a position. */
int64_t column_of(const struct opened *opened, double x);
int64_t row_of(const struct opened *opened, double y);

#endif
