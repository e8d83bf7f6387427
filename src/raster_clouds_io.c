/* Point clouds among the inputs become one GeoTIFF in memory, and are read like any raster from there on. */
#include "lod/cloud_grid.h"
#include "src/cloud_read_io.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_MEMORY_MB 2048
#define EDGE_POSTS        100 /* as wide as rasters' voids are filled */

struct gridded {
    struct cloud_posts posts;
    float *heights; /* rows from the south */
    OGRSpatialReferenceH crs;
    double height_metres; /* of a unit of height */
};

/* A vertical CRS tells the unit of heights when the raster is read. Without one it is what the file says, or else the
 * unit of the other two coordinates, as is the habit of those who measure clouds. */
static double height_metres(OGRSpatialReferenceH crs, const char *unit) {
    double metres = 1;
    if (crs == NULL || OSRIsCompound(crs)) return 1;
    PJ_CONTEXT *proj = raster_proj_new();
    bool is_known = unit[0] != '\0' && proj != NULL && raster_unit_metres(proj, unit, &metres);
    if (proj != NULL) proj_context_destroy(proj);
    if (!is_known && OSRIsProjected(crs)) metres = OSRGetLinearUnits(crs, NULL);
    return metres > 0 ? metres : 1;
}

static enum scree_status take_crs(const struct raster *raster, const char *wkt, const char *unit,
                                  struct gridded *gridded, struct scree_error *error) {
    const char *text = raster->source_srs != NULL ? raster->source_srs : wkt;
    if (text != NULL) {
        gridded->crs = OSRNewSpatialReference(NULL);
        if (OSRSetFromUserInput(gridded->crs, text) != OGRERR_NONE)
            return scree_fail(error, SCREE_E_ARGUMENT, "--s_srs %s: not a coordinate system that PROJ knows", text);
        OSRSetAxisMappingStrategy(gridded->crs, OAMS_TRADITIONAL_GIS_ORDER);
    }
    gridded->height_metres = height_metres(gridded->crs, unit);
    return SCREE_OK;
}

/* All clouds as one, in the CRS of the first. */
static enum scree_status read_clouds(const struct raster *raster, const struct raster_options *options,
                                     const bool *is_cloud, struct cloud *cloud, struct gridded *gridded,
                                     struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct cloud_crs first = {0};
    const char *first_name = NULL;
    for (int i = 0; i < options->input_count && status == SCREE_OK; i++) {
        struct cloud_crs crs = {0};
        if (!is_cloud[i]) continue;
        status =
            cloud_read(options->inputs[i], &options->cloud, cloud, raster->source_srs != NULL ? NULL : &crs, error);
        if (first_name == NULL) {
            first_name = options->inputs[i];
            first = crs;
            continue;
        }
        bool is_same = strcmp(crs.unit, first.unit) == 0 &&
                       strcmp(crs.wkt == NULL ? "" : crs.wkt, first.wkt == NULL ? "" : first.wkt) == 0;
        if (status == SCREE_OK && !is_same)
            status = scree_fail(error, SCREE_E_ARGUMENT,
                                "%s: has another coordinate system than %s; clouds that are built together need the "
                                "same one (--s_srs names it for all)",
                                options->inputs[i], first_name);
        cloud_crs_free(&crs);
    }
    if (status == SCREE_OK) status = take_crs(raster, first.wkt, first.unit, gridded, error);
    cloud_crs_free(&first);
    return status;
}

/* The cloud is released on the way. */
static enum scree_status grid(const struct raster_options *options, struct cloud *cloud, struct gridded *gridded,
                              struct scree_error *error) {
    const struct cloud_options *wanted = &options->cloud;
    struct cloud_posts *posts = &gridded->posts;
    enum scree_status status = SCREE_OK;
    if (wanted->outliers > 0) status = cloud_drop_outliers(cloud, wanted->outliers, error);
    if (status == SCREE_OK && cloud->count == 0)
        status = scree_fail(error, SCREE_E_CORRUPT, "--outliers %g leaves no point", wanted->outliers);
    if (status == SCREE_OK && wanted->thin > 0) status = cloud_thin(cloud, wanted->thin, error);
    if (status == SCREE_OK) status = cloud_posts_choose(cloud, wanted->grid, posts, error);
    if (status != SCREE_OK) return status;
    size_t count = (size_t)posts->columns * (size_t)posts->rows;
    const struct scree_memory *memory = cloud->memory;
    if (count > (memory->limit_bytes - memory->used_bytes) / (2 * sizeof *gridded->heights)) /* here, and as GeoTIFF */
        return scree_fail(error, SCREE_E_LIMIT, "%d x %d posts are too many", (int)posts->columns, (int)posts->rows);
    double longest = wanted->longest_edge > 0 ? wanted->longest_edge : EDGE_POSTS * posts->spacing;
    struct tin tin = {.memory = cloud->memory};
    status = tin_from_cloud(cloud, longest, &tin, error);
    cloud_release(cloud);
    if (status == SCREE_OK) {
        gridded->heights = scree_allocate(tin.memory, count, sizeof *gridded->heights, "the posts of a cloud", error);
        if (gridded->heights == NULL) status = error->status;
    }
    if (status == SCREE_OK && tin_sample(&tin, posts, gridded->heights) == 0)
        status = scree_fail(error, SCREE_E_CORRUPT,
                            "no post is within a triangle with edges of %g or less; name a longer --max-edge", longest);
    tin_release(&tin);
    return status;
}

static bool write_raster(const char *path, const struct gridded *gridded) {
    const struct cloud_posts *posts = &gridded->posts;
    char *creation[] = {"TILED=YES", "BIGTIFF=IF_SAFER", NULL};
    GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("GTiff"), path, posts->columns, posts->rows, 1, GDT_Float32, creation);
    if (dataset == NULL) return false;
    double half = posts->spacing / 2, north = posts->south + (posts->rows - 1) * posts->spacing + half;
    double geotransform[6] = {posts->west - half, posts->spacing, 0, north, 0, -posts->spacing};
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    CPLErr failed = GDALSetGeoTransform(dataset, geotransform);
    if (failed == CE_None && gridded->crs != NULL) failed = GDALSetSpatialRef(dataset, gridded->crs);
    if (failed == CE_None && gridded->height_metres != 1) failed = GDALSetRasterScale(band, gridded->height_metres);
    size_t stride = (size_t)posts->columns;
    for (int row = 0; row < posts->rows && failed == CE_None; row++)
        failed = GDALRasterIO(band, GF_Write, 0, row, posts->columns, 1,
                              gridded->heights + (size_t)(posts->rows - 1 - row) * stride, posts->columns, 1,
                              GDT_Float32, 0, 0);
    GDALFlushCache(dataset);
    GDALClose(dataset);
    return failed == CE_None;
}

enum scree_status raster_clouds_make(struct raster *raster, const struct raster_options *options, const bool *is_cloud,
                                     struct scree_error *error) {
    int megabytes = options->cloud.memory_mb > 0 ? options->cloud.memory_mb : DEFAULT_MEMORY_MB, first = 0;
    struct scree_memory memory = {.limit_bytes = (size_t)megabytes << 20};
    struct cloud cloud = {.memory = &memory};
    struct gridded gridded = {0};
    struct raster_trap trap;
    struct scree_error why = {0};
    char path[64];
    while (!is_cloud[first]) first++;
    const char *name = options->inputs[first];
    raster_trap_set(&trap);
    enum scree_status status = read_clouds(raster, options, is_cloud, &cloud, &gridded, &why);
    if (status == SCREE_E_LIMIT || status == SCREE_E_MEMORY) {
        status = scree_fail(error, status, "%s: %s; name more --memory than %d MB, or take fewer points with --class",
                            name, why.text, megabytes);
    } else if (status != SCREE_OK) {
        status = scree_fail(error, status, "%s", why.text); /* which names the file */
    } else if ((status = grid(options, &cloud, &gridded, &why)) == SCREE_E_LIMIT) {
        status = scree_fail(error, status,
                            "%s: %s; name more --memory than %d MB, or have fewer points or posts (--thin, --grid)",
                            name, why.text, megabytes);
    } else if (status != SCREE_OK) {
        status = scree_fail(error, status, "%s: %s", name, why.text);
    }
    if (status != SCREE_OK) goto cleanup;
    snprintf(path, sizeof path, "/vsimem/scree-cloud-%p", (void *)raster);
    raster->cloud_path = strdup(path);
    if (raster->cloud_path == NULL)
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for a name");
    else if (!write_raster(path, &gridded))
        status = raster_trap_fail(&trap, name, error);
cleanup:
    raster_trap_clear();
    if (gridded.crs != NULL) OSRDestroySpatialReference(gridded.crs);
    scree_release(&memory, gridded.heights);
    cloud_release(&cloud);
    return status;
}
