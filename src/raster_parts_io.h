/* What the files behind src/raster_io.h share: the parts of a raster, and of what a reader builds from them.
 *
 *     input   one file as it was found; constant after raster_open
 *     group   neighbouring inputs on one pixel grid: mosaicked pixel by pixel, warped as a whole
 *     layer   where a group lies on the lattice
 *     field   one thread's open virtual rasters:
 *             input -> cleaned (metres, NaN for void) -> group's mosaic -> reduced -> warped -> shifted -> mosaic
 *     reader  a field and a cache of square blocks of posts
 *
 * Longitudes and columns of a group or layer are unwrapped: they may go beyond 180 degrees, or start below -180. */
#ifndef SCREE_RASTER_PARTS_IO_H
#define SCREE_RASTER_PARTS_IO_H

#include "src/raster_io.h"

#include <gdal.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <proj.h>

struct raster_input {
    char *name;
    char *dataset; /* what GDAL opens: the name, or a raster in memory that inputs became */
    int band;
    int columns, rows;
    bool has_geotransform;
    double geotransform[6]; /* pixel corner to CRS, as GDAL has it */
    char *crs_wkt;          /* "" when there is none; set before raster_input_open, it goes before the dataset's own */
    bool has_nodata, has_mask;
    bool is_wide; /* its values need more than a float */
    double nodata;
    double scale, offset; /* height in metres, upwards = value * scale + offset */
    char *unit;           /* a unit of heights that nobody knows, taken as metres; "" */
    int group;
    int group_column, group_row; /* where its first pixel lies in the group */
};

/* Heights of a group on a coarse grid, for voids that are too wide for GDALFillNodata but enclosed by data. */
struct raster_enclosed {
    int cell; /* pixels along the side of a cell */
    int columns, rows;
    double *sums_m; /* while inputs are scanned */
    uint64_t *counts;
    uint64_t valid;   /* pixels that hold a height */
    float *heights_m; /* afterwards; NaN outside of the data; NULL: the group has no voids */
};

struct raster_group {
    int first_input, input_count;
    int columns, rows;
    double geotransform[6];
    bool is_geographic;
    bool is_around;     /* its columns go once around the globe */
    char *to_lonlat;    /* PROJ pipeline from the CRS to WGS 84 longitude and latitude; NULL: it is that already */
    char *shift;        /* PROJ pipeline from longitude, latitude, height to ellipsoidal height; NULL: none */
    double shift_scale; /* from metres upwards to what `shift` takes */
    double west_deg, south_deg, east_deg, north_deg; /* of the pixels' outer edges, unwrapped */
    double spacing_deg;
    double shift_min_m, shift_max_m;
    struct raster_enclosed enclosed;
};

struct raster_layer {
    int64_t x, y;      /* first post; x unwrapped */
    int columns, rows; /* posts; 0: none of the lattice's posts fall on the group */
    int reduction;     /* the source is averaged over so many pixels before it is warped, so that windows stay small */
};

struct raster_placement {
    struct lattice lattice;
    int64_t x, y;                /* first post of the mosaic, 0 <= x */
    int columns, rows;           /* posts of the mosaic; 0: none */
    struct raster_layer *layers; /* one a group */
};

struct raster {
    struct raster_options options; /* its strings are copies owned by the raster */
    char *source_srs;
    GDALResampleAlg resampling;
    int fill_distance;
    char *cloud_path;  /* the raster in memory that clouds became; NULL: none */
    char *filter_path; /* the raster in memory that all inputs became, filtered; NULL: none */
    bool has_enclosed; /* some group has voids */
    int input_count, group_count;
    struct raster_input *inputs;
    struct raster_group *groups;
    struct raster_summary summary;
    struct lattice_window local_crop; /* local profile: first post of --te, and how many posts */
    bool is_placed;
    struct raster_placement placement;
    float pole_m[2]; /* the south and the north pole are one point each; NaN: no data */
};

/* GDAL's first failure while a trap is set, for this thread; nothing reaches standard error. Traps nest. */
struct raster_trap {
    char text[400];
};
void raster_trap_set(struct raster_trap *trap);
void raster_trap_clear(void);
/* Records what went wrong with `what`, in GDAL's words. */
enum scree_status raster_trap_fail(const struct raster_trap *trap, const char *what, struct scree_error *error);

/* GeoTIFF 1.0 files, and LAS files with their keys, name their vertical CRS only when asked: for this thread, until
 * raster_compound_leave, which takes what raster_compound_ask said. */
bool raster_compound_ask(void);
void raster_compound_leave(bool is_asked);

/* A PROJ context that prints nothing; NULL when out of memory. */
PJ_CONTEXT *raster_proj_new(void);

/* raster_sources_io.c: inputs */
enum scree_status raster_input_open(const struct raster *raster, const char *name, const char *dataset,
                                    struct raster_input *input, struct scree_error *error);
void raster_input_free(struct raster_input *input);
/* Reads a window as metres, NaN where there is no height, rows as they are in the file. */
CPLErr raster_input_read(const struct raster_input *input, GDALDatasetH dataset, int column, int row, int columns,
                         int rows, float *heights_m);
struct raster_range {
    double min_m, max_m;
    bool has_heights;
};
/* The range of the heights in a window of pixels, read block by block. */
enum scree_status raster_input_scan(struct raster *raster, const struct raster_input *input, const int window[4],
                                    struct raster_range *range, struct scree_error *error);

/* raster_clouds_io.c: grids those of `inputs` that `is_cloud` marks, and makes raster->cloud_path; the next of
 * raster->inputs is given the CRS, as GeoTIFF cannot tell every one. */
enum scree_status raster_clouds_make(struct raster *raster, const struct raster_options *options, const bool *is_cloud,
                                     struct scree_error *error);

/* raster_filter_io.c: filters all inputs together, makes raster->filter_path and summary.filtered, and opens that as
 * the raster's only input. What of the raster's options says how pixels are read is done with then, and taken out. */
enum scree_status raster_filter_open(struct raster *raster, const struct raster_options *options,
                                     struct scree_error *error);

/* raster_units_io.c: the factor from a unit's name to metres; false when nobody knows it. */
bool raster_unit_metres(PJ_CONTEXT *proj, const char *name, double *metres);

/* raster_groups_io.c: gathers inputs into groups, and finds where groups lie. */
enum scree_status raster_groups_make(struct raster *raster, PJ_CONTEXT *proj, struct scree_error *error);
void raster_group_free(struct raster_group *group);

/* raster_place_io.c: where layers lie on a lattice. */
enum scree_status raster_placement_make(const struct raster *raster, const struct lattice *lattice,
                                        struct raster_placement *placement, struct scree_error *error);

/* raster_transform_io.c: from lattice posts to pixels, as a GDAL transformer. */
struct raster_transform {
    GDALTransformerInfo info; /* GDAL looks at it to find out what it is not */
    double west, south;       /* of the corner of pixel (0, 0) of the destination */
    double spacing_x, spacing_y;
    double to_world[6], to_pixel[6];
    double columns, rows; /* of the source */
    bool is_geographic;
    PJ *to_lonlat; /* NULL: the source is in longitude and latitude of WGS 84 */
};
bool raster_transform_make(struct raster_transform *transform, const double geotransform[6], int columns, int rows,
                           bool is_geographic, PJ *to_lonlat);
/* A GDALTransformerFunc; `argument` is a struct raster_transform. */
int raster_transform_points(void *argument, int to_source, int count, double *x, double *y, double *z, int *success);

/* raster_datum_io.c: vertical CRS. */
enum scree_status raster_shift_find(PJ_CONTEXT *proj, const char *name, const char *crs_wkt, struct raster_group *group,
                                    char **line, struct scree_error *error);
/* The factor from the unit of the CRS's heights to metres, negative for depths; false: it names no vertical unit. */
bool raster_vertical_metres(PJ_CONTEXT *proj, const char *crs_wkt, double *metres);
/* Adds the shift to `count` heights of one row. */
bool raster_shift_row(PJ *shift, double shift_scale, double west_deg, double spacing_deg, double latitude_deg,
                      int count, float *heights_m);

/* raster_crs_io.c: horizontal CRS. The pipeline is NULL when nothing has to be done. */
enum scree_status raster_crs_to_lonlat(PJ_CONTEXT *proj, const char *name, const char *crs_wkt,
                                       const double area_deg[4], char **pipeline, bool *is_geographic,
                                       struct scree_error *error);
/* The best of PROJ's operations that can be carried out, as a pipeline between x, y, z in the order of maps. */
enum scree_status raster_operation_find(PJ_CONTEXT *proj, const PJ *source, const PJ *target, const double area_deg[4],
                                        bool allow_ballpark, char **pipeline, char **description, char **missing_grid);
/* The CRS of a WKT, without a bound transformation around it. */
PJ *raster_crs_new(PJ_CONTEXT *proj, const char *crs_wkt);
/* Metres of a horizontal unit; of degrees, at the equator. 1 where the CRS does not tell. */
double raster_horizontal_metres(PJ_CONTEXT *proj, const char *crs_wkt);

/* raster_enclosed_io.c: voids that are enclosed by data, on a coarse grid of the group's pixels. */
enum scree_status raster_enclosed_make(struct raster_group *group, struct scree_error *error);
void raster_enclosed_free(struct raster_enclosed *enclosed);
void raster_enclosed_add(struct raster_group *group, int column, int row, int columns, int rows,
                         const float *heights_m);
enum scree_status raster_enclosed_finish(struct raster_group *group, struct scree_error *error);
/* Heights of a window of the group's pixels, NaN outside of the data. */
void raster_enclosed_read(const struct raster_group *group, int column, int row, int columns, int rows,
                          float *heights_m);

/* raster_mosaic_io.c: one thread's virtual rasters: of the heights, or of what lies in enclosed voids. */
struct raster_field;
enum scree_status raster_field_new(const struct raster *raster, const struct raster_placement *placement,
                                   bool is_enclosed, struct raster_field **field, struct scree_error *error);
void raster_field_free(struct raster_field *field);
/* Heights of posts inside the lattice, rows from the south, contiguous; NaN where there are none. `x` is wrapped. */
enum scree_status raster_field_read(struct raster_field *field, int64_t x, int64_t y, int columns, int rows,
                                    float *heights_m, struct scree_error *error);

/* raster_voids_io.c: fills the voids inside of the data in a region's inner part: `margin` posts lie around it on each
 * side, distance + 1 at least. Other voids of the inner part stay NaN. */
enum scree_status raster_voids_fill(float *region_m, int columns, int rows, int margin, int distance,
                                    struct scree_error *error);
/* GDALFillNodata on an array: where `valid` is 0, heights are interpolated. */
bool raster_fill_nodata(float *heights_m, unsigned char *valid, int stride, int columns, int rows, int distance);

#endif
