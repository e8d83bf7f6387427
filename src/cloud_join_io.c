#include "src/cloud_join_io.h"

#include "src/cloud_read_io.h"
#include "src/raster_parts_io.h"

#include <stdlib.h>
#include <string.h>

#define DEFAULT_MEMORY_MB 2048

size_t cloud_memory_bytes(const struct cloud_options *options) {
    return (size_t)(options->memory_mb > 0 ? options->memory_mb : DEFAULT_MEMORY_MB) << 20;
}

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

enum scree_status cloud_meaning_take(const char *source_srs, const char *wkt, const char *unit,
                                     struct cloud_meaning *meaning, struct scree_error *error) {
    const char *text = source_srs != NULL ? source_srs : wkt;
    if (text != NULL) {
        meaning->crs = OSRNewSpatialReference(NULL);
        if (OSRSetFromUserInput(meaning->crs, text) != OGRERR_NONE)
            return scree_fail(error, SCREE_E_ARGUMENT, "--s_srs %s: not a coordinate system that PROJ knows", text);
        OSRSetAxisMappingStrategy(meaning->crs, OAMS_TRADITIONAL_GIS_ORDER);
    }
    meaning->height_metres = height_metres(meaning->crs, unit);
    return SCREE_OK;
}

void cloud_meaning_free(struct cloud_meaning *meaning) {
    if (meaning->crs != NULL) OSRDestroySpatialReference(meaning->crs);
    *meaning = (struct cloud_meaning){0};
}

/* All clouds as one, in the CRS of the first. */
static enum scree_status read_clouds(const struct raster_options *options, const char *source_srs, const bool *is_cloud,
                                     struct joined_cloud *joined, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct cloud_crs first = {0};
    const char *first_name = NULL;
    for (int i = 0; i < options->input_count && status == SCREE_OK; i++) {
        struct cloud_crs crs = {0};
        if (!is_cloud[i]) continue;
        status =
            cloud_read(options->inputs[i], &options->cloud, &joined->cloud, source_srs != NULL ? NULL : &crs, error);
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
    if (status == SCREE_OK) status = cloud_meaning_take(source_srs, first.wkt, first.unit, &joined->meaning, error);
    cloud_crs_free(&first);
    return status;
}

/* The failure names no file. */
static enum scree_status clean(const struct cloud_options *wanted, struct cloud *cloud, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (wanted->outliers > 0) status = cloud_drop_outliers(cloud, wanted->outliers, error);
    if (status == SCREE_OK && cloud->count == 0)
        status = scree_fail(error, SCREE_E_CORRUPT, "--outliers %g leaves no point", wanted->outliers);
    if (status == SCREE_OK && wanted->thin > 0) status = cloud_thin(cloud, wanted->thin, error);
    return status;
}

enum scree_status cloud_join(const struct raster_options *options, const char *source_srs, const bool *is_cloud,
                             struct joined_cloud *joined, struct scree_error *error) {
    struct scree_error why = {0};
    int first = 0;
    while (!is_cloud[first]) first++;
    const char *name = options->inputs[first];
    enum scree_status status = read_clouds(options, source_srs, is_cloud, joined, &why);
    bool names_file = status != SCREE_OK && status != SCREE_E_LIMIT && status != SCREE_E_MEMORY;
    if (status == SCREE_OK) status = clean(&options->cloud, &joined->cloud, &why);
    if (status == SCREE_OK) return SCREE_OK;
    if (names_file) return scree_fail(error, status, "%s", why.text);
    if (status != SCREE_E_LIMIT && status != SCREE_E_MEMORY) return scree_fail(error, status, "%s: %s", name, why.text);
    return scree_fail(error, status, "%s: %s; name more --memory than %zu MB, or take fewer points with --class", name,
                      why.text, cloud_memory_bytes(&options->cloud) >> 20);
}

void joined_cloud_release(struct joined_cloud *joined) {
    cloud_release(&joined->cloud);
    cloud_meaning_free(&joined->meaning);
}
