#include "src/tin_read_io.h"

#include "src/cloud_read_io.h"
#include "src/mesh_file_read.h"
#include "src/mesh_join_io.h"
#include "src/raster_parts_io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EDGE_DISTANCES 100 /* of points: the longest edge of a triangle, as in gridded clouds */

/* ---- which inputs ---- */

enum scree_status tin_kind_find(const struct raster_options *options, enum tin_kind *kind, struct scree_error *error) {
    const char *mesh = NULL, *cloud = NULL, *other = NULL;
    struct raster_trap trap;
    *kind = TIN_OF_NOTHING;
    if (options->cloud.grid > 0 || options->filter.is_wanted) return SCREE_OK;
    raster_trap_set(&trap);
    GDALAllRegister();
    raster_trap_clear();
    for (int i = 0; i < options->input_count; i++) {
        const char *name = options->inputs[i];
        bool is_mesh = mesh_file_is_mesh(name);
        bool is_cloud = !is_mesh && cloud_is_cloud(name, options->cloud.named != NULL);
        const char **which = is_mesh ? &mesh : is_cloud ? &cloud : &other;
        if (*which == NULL) *which = name;
    }
    if (mesh != NULL && cloud != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s is a mesh and %s are points, which do not make one surface; build each alone, or make "
                          "posts of them with --grid",
                          mesh, cloud);
    if ((mesh != NULL || cloud != NULL) && other != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s is kept as triangles, which does not go with %s, a raster; build each alone, or make "
                          "posts of it with --grid",
                          mesh != NULL ? mesh : cloud, other);
    *kind = mesh != NULL ? TIN_OF_MESHES : cloud != NULL ? TIN_OF_CLOUDS : TIN_OF_NOTHING;
    return SCREE_OK;
}

/* An option that changes nothing is a mistake. */
static enum scree_status check_options(const struct raster_options *options, enum tin_kind kind,
                                       struct scree_error *error) {
    const struct cloud_options *cloud = &options->cloud;
    const char *for_posts = options->has_extent           ? "--te"
                            : options->resampling != NULL ? "-r"
                            : options->band > 0           ? "-b"
                            : options->has_nodata         ? "-a_nodata"
                            : options->fill_distance != 0 ? "--fill-distance"
                                                          : NULL;
    const char *for_clouds = kind == TIN_OF_CLOUDS                  ? NULL
                             : cloud->has_classes                   ? "--class"
                             : cloud->returns != CLOUD_EVERY_RETURN ? "--returns"
                             : cloud->thin > 0                      ? "--thin"
                             : cloud->outliers > 0                  ? "--outliers"
                             : cloud->longest_edge > 0              ? "--max-edge"
                                                                    : NULL;
    if (for_posts != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: is kept as triangles, for which there is no %s; --grid makes posts of it",
                          options->inputs[0], for_posts);
    if (for_clouds != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: %s is for points without triangles, and these have some",
                          options->inputs[0], for_clouds);
    return SCREE_OK;
}

/* ---- reading ---- */

/* Says of a failure in which file it was, and what to do when memory was not enough. */
static enum scree_status tell(const struct raster_options *options, const char *name, enum scree_status status,
                              const char *why, struct scree_error *error) {
    if (status != SCREE_E_LIMIT && status != SCREE_E_MEMORY) return scree_fail(error, status, "%s: %s", name, why);
    return scree_fail(error, status, "%s: %s; name more --memory than %zu MB", name, why,
                      cloud_memory_bytes(&options->cloud) >> 20);
}

static enum scree_status read_meshes(const struct raster_options *options, struct tin *tin, struct tin_mended *mended,
                                     struct cloud_meaning *meaning, struct scree_error *error) {
    struct scree_error why = {0};
    enum scree_status status = cloud_meaning_take(options->source_srs, NULL, "", meaning, error);
    if (status != SCREE_OK) return status;
    bool *is_mesh = calloc((size_t)options->input_count, sizeof *is_mesh);
    if (is_mesh == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for %d inputs", options->input_count);
    for (int i = 0; i < options->input_count; i++) is_mesh[i] = true;
    status = mesh_join(options, is_mesh, tin, error);
    free(is_mesh);
    if (status != SCREE_OK) return status;
    status = tin_mend(tin, mended, &why);
    return status == SCREE_OK ? status : tell(options, options->inputs[0], status, why.text, error);
}

/* The longest edge that a gridded cloud would have, of posts at the points' mean distance. */
static double longest_edge(const struct raster_options *options, const struct cloud *cloud) {
    double bounds[4];
    if (options->cloud.longest_edge > 0) return options->cloud.longest_edge;
    cloud_bounds(cloud, bounds);
    return EDGE_DISTANCES * sqrt((bounds[2] - bounds[0]) * (bounds[3] - bounds[1]) / cloud->count);
}

static enum scree_status read_clouds(const struct raster_options *options, struct tin *tin,
                                     struct cloud_meaning *meaning, struct scree_error *error) {
    struct joined_cloud joined = {.cloud.memory = tin->memory};
    struct scree_error why = {0};
    bool *is_cloud = calloc((size_t)options->input_count, sizeof *is_cloud);
    if (is_cloud == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for %d inputs", options->input_count);
    for (int i = 0; i < options->input_count; i++) is_cloud[i] = true;
    enum scree_status status = cloud_join(options, options->source_srs, is_cloud, &joined, error);
    free(is_cloud);
    if (status != SCREE_OK) goto cleanup;
    status = tin_from_cloud(&joined.cloud, longest_edge(options, &joined.cloud), tin, &why);
    if (status != SCREE_OK) tell(options, options->inputs[0], status, why.text, error);
    *meaning = joined.meaning;
    joined.meaning = (struct cloud_meaning){0};
cleanup:
    joined_cloud_release(&joined);
    return status;
}

enum scree_status tin_read(const struct raster_options *options, enum tin_kind kind, struct tin *tin,
                           struct tin_mended *mended, struct cloud_meaning *meaning, struct scree_error *error) {
    struct raster_trap trap;
    enum scree_status status = check_options(options, kind, error);
    if (status != SCREE_OK) return status;
    raster_trap_set(&trap);
    bool is_asked = raster_compound_ask();
    status = kind == TIN_OF_MESHES ? read_meshes(options, tin, mended, meaning, error)
                                   : read_clouds(options, tin, meaning, error);
    raster_compound_leave(is_asked);
    raster_trap_clear();
    return status;
}
