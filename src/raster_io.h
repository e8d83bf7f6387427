/* Elevation from GDAL: any number of rasters as one endless field of posts.
 *
 * raster_open looks at the inputs; raster_place binds them to a lattice (mosaic and warp are GDAL's virtual rasters);
 * each worker then reads posts through a reader of its own. Nothing ever holds more than a window of the raster.
 * Inputs that are point clouds become one raster in memory first: they are one cloud together, which lies where the
 * first of them stands among the inputs. With --filter all inputs become one raster in memory, filtered; all else, the
 * crop too, is done to that. */
#ifndef SCREE_RASTER_IO_H
#define SCREE_RASTER_IO_H

#include "src/cloud_options.h"
#include "src/filter_options.h"
#include "src/lattice.h"
#include <scree/error.h>

struct raster_options {
    const char *const *inputs; /* GDAL dataset names, or point clouds; later ones lie on top */
    int input_count;
    enum profile profile;
    int band;               /* from 1; 0: the first */
    const char *source_srs; /* overrides the inputs' CRS (any form that OGR takes, compound too); NULL: theirs */
    const char *resampling; /* as gdalwarp -r; NULL: bilinear */
    bool has_nodata;        /* `nodata` replaces what the inputs declare */
    double nodata;
    double nodata_height_m; /* height outside the data's footprint */
    bool has_nodata_height; /* somebody has named it */
    bool any_height;        /* let heights beyond 20 km pass */
    bool has_extent;
    double extent[4];  /* west, south, east, north in degrees or CRS units: crop */
    int fill_distance; /* how far voids are interpolated from their borders, in posts; 0: the default of 100; negative:
                        * no void is filled */
    struct cloud_options cloud;   /* how inputs that are point clouds become posts */
    struct filter_options filter; /* how all of it is filtered before anything else is done with it */
};

struct raster_summary {
    double bounds[4]; /* west, south, east, north. Geodetic: of the pixels' outer edges, in degrees; east exceeds 180
                       * where the data cross the antimeridian. Local: of the posts, in CRS units. Cropped to --te. */
    int64_t columns, rows;             /* local profile: the raster's pixels */
    double spacing_x, spacing_y;       /* finest resolution of any input, degrees or CRS units */
    double metres_per_unit;            /* local profile: horizontal unit */
    double height_min_m, height_max_m; /* over all valid posts, after scale, offset, units and vertical datum */
    double relief_margin_m;            /* how much resampling and datum shifts may add to either end */
    char *crs_wkt;                     /* of the lattice: EPSG:4326, or the raster's own; "" when there is none */
    char *datum;                       /* one line on heights: what was assumed or how they are transformed */
    char *filtered;                    /* lines on what --filter did; NULL: it was not asked for */
    char *attribution;                 /* from the inputs' metadata; "" when they have none */
};

/* Its strings; fine on a zeroed one. */
void raster_summary_free(struct raster_summary *summary);

struct raster;
struct raster_reader;

/* Opens and checks every input, and reads each once for the range of its heights. Exit-code-1 failures: missing,
 * empty, truncated, not a raster, no georeference (geodetic), all nodata, absurd geotransform, heights beyond 20 km,
 * a vertical grid that PROJ cannot find. `raster` is to be freed with raster_free. */
enum scree_status raster_open(const struct raster_options *options, struct raster **raster, struct scree_error *error);
const struct raster_summary *raster_summary(const struct raster *raster);
void raster_free(struct raster *raster);

/* Binds the raster to the posts of a lattice of its profile. Once, before the first reader. */
enum scree_status raster_place(struct raster *raster, const struct lattice *lattice, struct scree_error *error);

/* The window of lattice posts that the data may touch (closed; the crop of --te taken into account). In the geodetic
 * profile, data that cross the antimeridian give two windows. Returns how many (1 or 2). Valid after raster_place. */
int raster_windows(const struct raster *raster, struct lattice_window windows[2]);

/* A reader for one thread; several may be open at once. */
enum scree_status raster_reader_new(const struct raster *raster, struct raster_reader **reader,
                                    struct scree_error *error);
void raster_reader_free(struct raster_reader *reader);

/* Heights in metres of `columns` x `rows` posts from post (x, y), row by row from the south, west to east; `stride`
 * floats from row to row. Any window is allowed: it may leave the lattice (columns wrap around the globe in the
 * geodetic profile, rows and local columns beyond the border repeat the border), because slopes need a margin. The
 * result for a post does not depend on the window that it was asked in, nor on the reader. A pole's row has one height
 * where data go around it.
 *
 * Voids whose row or column has heights on both sides, no farther apart than fill_distance, are interpolated by
 * GDALFillNodata; wider ones that the data enclose take a height interpolated on a coarse grid (about 256 cells along
 * the longer side of a group of inputs). All else lies outside of the footprint: nodata_height_m. */
enum scree_status raster_read(struct raster_reader *reader, int64_t x, int64_t y, int32_t columns, int32_t rows,
                              float *heights_m, int32_t stride, struct scree_error *error);

#endif
