/* Point clouds or meshes among the inputs become one GeoTIFF in memory, and are read like any raster from there on. */
#include "lod/cloud_grid.h"
#include "src/cloud_join_io.h"
#include "src/mesh_file_read.h"
#include "src/mesh_join_io.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EDGE_POSTS 100 /* as wide as rasters' voids are filled */

struct gridded {
    struct cloud_posts posts;
    float *heights; /* rows from the south */
};

/* What there is to be gridded: either the points of clouds, or triangles of meshes; `memory` pays for both. */
struct source {
    struct joined_cloud joined;
    struct tin tin;
    bool is_mesh;
};

static enum scree_status read_source(const struct raster_options *options, const char *source_srs, const bool *marked,
                                     struct source *source, struct scree_error *error) {
    int first = 0;
    while (!marked[first]) first++;
    source->is_mesh = mesh_file_is_mesh(options->inputs[first]);
    for (int i = 0; i < options->input_count; i++)
        if (marked[i] && mesh_file_is_mesh(options->inputs[i]) != source->is_mesh)
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "%s and %s: a mesh and a point cloud do not become posts together; build each alone",
                              options->inputs[first], options->inputs[i]);
    if (!source->is_mesh) return cloud_join(options, source_srs, marked, &source->joined, error);
    enum scree_status status = cloud_meaning_take(source_srs, NULL, "", &source->joined.meaning, error);
    return status == SCREE_OK ? mesh_join(options, marked, &source->tin, error) : status;
}

/* The cloud is released on the way. */
static enum scree_status grid(const struct raster_options *options, struct source *source, struct gridded *gridded,
                              struct scree_error *error) {
    const struct cloud_options *wanted = &options->cloud;
    struct cloud_posts *posts = &gridded->posts;
    struct cloud *cloud = &source->joined.cloud;
    const struct cloud corners = {
        .memory = source->tin.memory, .points = source->tin.points, .count = source->tin.point_count};
    if (source->is_mesh && corners.count == 0) return scree_fail(error, SCREE_E_CORRUPT, "has no points");
    enum scree_status status = cloud_posts_choose(source->is_mesh ? &corners : cloud, wanted->grid, posts, error);
    if (status != SCREE_OK) return status;
    size_t count = (size_t)posts->columns * (size_t)posts->rows;
    const struct scree_memory *memory = source->tin.memory;
    if (count > (memory->limit_bytes - memory->used_bytes) / (2 * sizeof *gridded->heights)) /* here, and as GeoTIFF */
        return scree_fail(error, SCREE_E_LIMIT, "%d x %d posts are too many", (int)posts->columns, (int)posts->rows);
    double longest = wanted->longest_edge > 0 ? wanted->longest_edge : EDGE_POSTS * posts->spacing;
    if (!source->is_mesh) {
        status = tin_from_cloud(cloud, longest, &source->tin, error);
        cloud_release(cloud);
    }
    if (status != SCREE_OK) return status;
    gridded->heights =
        scree_allocate(source->tin.memory, count, sizeof *gridded->heights, "the posts of a surface", error);
    if (gridded->heights == NULL) return error->status;
    if (tin_sample(&source->tin, posts, gridded->heights) > 0) return SCREE_OK;
    if (source->is_mesh) return scree_fail(error, SCREE_E_CORRUPT, "no post is within a triangle");
    return scree_fail(error, SCREE_E_CORRUPT,
                      "no post is within a triangle with edges of %g or less; name a longer --max-edge", longest);
}

static bool write_raster(const char *path, const struct gridded *gridded, double height_metres) {
    const struct cloud_posts *posts = &gridded->posts;
    char *creation[] = {"TILED=YES", "BIGTIFF=IF_SAFER", NULL};
    GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("GTiff"), path, posts->columns, posts->rows, 1, GDT_Float32, creation);
    if (dataset == NULL) return false;
    double half = posts->spacing / 2, north = posts->south + (posts->rows - 1) * posts->spacing + half;
    double geotransform[6] = {posts->west - half, posts->spacing, 0, north, 0, -posts->spacing};
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    CPLErr failed = GDALSetGeoTransform(dataset, geotransform);
    if (failed == CE_None && height_metres != 1) failed = GDALSetRasterScale(band, height_metres);
    size_t stride = (size_t)posts->columns;
    for (int row = 0; row < posts->rows && failed == CE_None; row++)
        failed = GDALRasterIO(band, GF_Write, 0, row, posts->columns, 1,
                              gridded->heights + (size_t)(posts->rows - 1 - row) * stride, posts->columns, 1,
                              GDT_Float32, 0, 0);
    GDALFlushCache(dataset);
    GDALClose(dataset);
    return failed == CE_None;
}

static char *crs_wkt_new(OGRSpatialReferenceH crs) {
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    char *wkt = NULL, *copy = NULL;
    if (crs == NULL) return strdup("");
    if (OSRExportToWktEx(crs, &wkt, wkt2) == OGRERR_NONE && wkt != NULL) copy = strdup(wkt);
    CPLFree(wkt);
    return copy;
}

enum scree_status raster_clouds_make(struct raster *raster, const struct raster_options *options, const bool *is_cloud,
                                     struct scree_error *error) {
    struct scree_memory memory = {.limit_bytes = cloud_memory_bytes(&options->cloud)};
    struct source source = {.joined.cloud.memory = &memory, .tin.memory = &memory};
    struct gridded gridded = {0};
    struct raster_trap trap;
    struct scree_error why = {0};
    char path[64];
    int first = 0;
    while (!is_cloud[first]) first++;
    const char *name = options->inputs[first];
    raster_trap_set(&trap);
    enum scree_status status = read_source(options, raster->source_srs, is_cloud, &source, error);
    if (status != SCREE_OK) goto cleanup;
    if ((status = grid(options, &source, &gridded, &why)) == SCREE_E_LIMIT)
        status = scree_fail(error, status,
                            "%s: %s; name more --memory than %zu MB, or have fewer points or posts (--thin, --grid)",
                            name, why.text, memory.limit_bytes >> 20);
    else if (status != SCREE_OK)
        status = scree_fail(error, status, "%s: %s", name, why.text);
    if (status != SCREE_OK) goto cleanup;
    snprintf(path, sizeof path, "/vsimem/scree-cloud-%p", (void *)raster);
    raster->cloud_path = strdup(path);
    raster->inputs[raster->input_count].crs_wkt = crs_wkt_new(source.joined.meaning.crs);
    if (raster->cloud_path == NULL || raster->inputs[raster->input_count].crs_wkt == NULL)
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for a name");
    else if (!write_raster(path, &gridded, source.joined.meaning.height_metres))
        status = raster_trap_fail(&trap, name, error);
cleanup:
    raster_trap_clear();
    scree_release(&memory, gridded.heights);
    tin_release(&source.tin);
    joined_cloud_release(&source.joined);
    return status;
}
