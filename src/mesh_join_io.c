#include "src/mesh_join_io.h"

#include "src/cloud_join_io.h"
#include "src/mesh_file_read.h"

#include <string.h>

/* Puts the points and triangles of `more` behind those of `tin`. */
static enum scree_status append(struct tin *tin, const struct tin *more, struct scree_error *error) {
    uint64_t points = (uint64_t)tin->point_count + more->point_count;
    uint64_t triangles = (uint64_t)tin->triangle_count + more->triangle_count;
    if (points > CLOUD_MOST_POINTS || triangles > CLOUD_MOST_POINTS)
        return scree_fail(error, SCREE_E_LIMIT, "more than %d points or triangles", CLOUD_MOST_POINTS);
    struct cloud_point *grown =
        scree_reallocate(tin->memory, tin->points, (size_t)points, sizeof *grown, "the points of meshes", error);
    if (grown == NULL) return error->status;
    tin->points = grown;
    uint32_t *corners = scree_reallocate(tin->memory, tin->corners, 3 * (size_t)triangles, sizeof *corners,
                                         "the triangles of meshes", error);
    if (corners == NULL) return error->status;
    tin->corners = corners;
    memcpy(grown + tin->point_count, more->points, more->point_count * sizeof *grown);
    for (size_t i = 0; i < 3 * (size_t)more->triangle_count; i++)
        corners[3 * (size_t)tin->triangle_count + i] = tin->point_count + more->corners[i];
    tin->point_count = (uint32_t)points;
    tin->triangle_count = (uint32_t)triangles;
    return SCREE_OK;
}

enum scree_status mesh_join(const struct raster_options *options, const bool *is_mesh, struct tin *tin,
                            struct scree_error *error) {
    for (int i = 0; i < options->input_count; i++) {
        struct tin one = {.memory = tin->memory};
        struct scree_error why = {0};
        if (!is_mesh[i]) continue;
        enum scree_status status = mesh_file_read(options->inputs[i], &one, error);
        if (status != SCREE_OK) return status;
        if (tin->points == NULL) {
            *tin = one;
            continue;
        }
        status = append(tin, &one, &why);
        tin_release(&one);
        if (status != SCREE_OK)
            return scree_fail(error, status, "%s: %s; name more --memory than %zu MB", options->inputs[i], why.text,
                              cloud_memory_bytes(&options->cloud) >> 20);
    }
    return SCREE_OK;
}
