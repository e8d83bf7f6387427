/* A raster's own pixels in memory, and such posts as a GeoTIFF: what `scree filter` reads and writes. */
#ifndef SCREE_FILTER_RASTER_IO_H
#define SCREE_FILTER_RASTER_IO_H

#include "src/lattice.h"
#include "src/raster_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Give this as raster_options.nodata_height_m, and posts outside of the data have no height in the output either. */
#define FILTER_NO_HEIGHT_M (-1e30)

/* Memory that filtering takes, at most: both heights, land use and what the filter needs, and the file. */
#define FILTER_POST_BYTES 24

struct filter_raster {
    int32_t columns, rows; /* at least 2 */
    double west, south;    /* of the first post, in units of the CRS */
    double spacing_x, spacing_y;
    char *crs_wkt;       /* "": none */
    char *attribution;   /* "": none */
    float *heights_m;    /* row by row from the south; there is one everywhere */
    uint8_t *is_outside; /* of each post whether that height is made up; NULL: none is */
};

/* Reads all of it, voids filled as raster_read does. The profile of `options` is to be local. Fails as raster_open
 * does, and where the posts would not fit the budget. `raster` is to be freed with filter_raster_free in any case. */
enum scree_status filter_raster_read(struct scree_memory *memory, const struct raster_options *options,
                                     struct filter_raster *raster, struct scree_error *error);

void filter_raster_free(struct scree_memory *memory, struct filter_raster *raster);

/* Writes heights of the raster's posts, whole or not at all: Float32, in metres, compressed. A vertical CRS that
 * GeoTIFF has no words for is left out. */
enum scree_status filter_raster_write(const struct filter_raster *raster, const float *heights_m, const char *path,
                                      struct scree_error *error);

/* Keeps the same as a file of GDAL's in memory (`path` begins with /vsimem/), not compressed and without the CRS, whose
 * vertical axis tells up from down all the same; whoever asks for it removes it. `name` is for errors. */
enum scree_status filter_raster_keep(const struct filter_raster *raster, const float *heights_m, const char *path,
                                     const char *name, struct scree_error *error);

#endif
