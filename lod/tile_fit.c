#include "lod/tile_fit.h"

#include "lod/fit.h"
#include "lod/merge.h"
#include "lod/quadric.h"

#include <math.h>
#include <string.h>

static enum scree_status copy_new(struct scree_memory *memory, const struct mesh *mesh, struct mesh *copy,
                                  struct scree_error *error) {
    enum scree_status status = mesh_allocate(memory, mesh->vertex_count, mesh->triangle_count, copy, error);
    if (status != SCREE_OK) return status;
    memcpy(copy->vertices, mesh->vertices, (size_t)mesh->vertex_count * sizeof *mesh->vertices);
    memcpy(copy->heights, mesh->heights, (size_t)mesh->vertex_count * sizeof *mesh->heights);
    memcpy(copy->triangles, mesh->triangles, (size_t)mesh->triangle_count * sizeof *mesh->triangles);
    copy->vertex_count = mesh->vertex_count;
    copy->triangle_count = mesh->triangle_count;
    copy->live_vertices = mesh->live_vertices;
    copy->live_triangles = mesh->live_triangles;
    return SCREE_OK;
}

static enum scree_status export(const struct tile *tile, const struct mesh *mesh, double max_error_m,
                                struct fitted_tile *fitted, struct scree_error *error) {
    fitted->max_error_m = max_error_m;
    fitted->mmqe_m2 = quadric_mmqe_m2(mesh, &tile->samples, tile->geometry.east_m, tile->geometry.north_m);
    return mesh_export_new(tile->memory, mesh, &fitted->mesh, error);
}

enum scree_status tile_fit_new(const struct tile *tile, struct code_frame codes, double tolerance_m,
                               struct fitted_tile *fitted, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    const struct fit_options options = {.tolerance_m = tolerance_m,
                                        .height_unit_m = geometry->height_unit_m,
                                        .thins = true,
                                        .locked_step = geometry->locked_step,
                                        .codes = codes};
    struct mesh mesh;
    memset(fitted, 0, sizeof *fitted);
    enum scree_status status = copy_new(tile->memory, &tile->mesh, &mesh, error);
    if (status != SCREE_OK) return status;
    struct samples samples = tile_samples_written(tile, codes, tolerance_m);
    status = fit_mesh(tile->memory, &mesh, &samples, &options, error);
    if (status == SCREE_OK) status = export(tile, &mesh, mesh_max_error_m(&mesh, &samples), fitted, error);
    mesh_release(tile->memory, &mesh);
    return status;
}

enum scree_status tile_fit_join_new(const struct tile *tile, const struct coarse_tile *const children[4],
                                    struct fitted_tile *fitted, struct scree_error *error) {
    const struct scree_mesh *meshes[4];
    double max_error_m = 0;
    struct mesh mesh;
    memset(fitted, 0, sizeof *fitted);
    for (int i = 0; i < 4; i++) {
        meshes[i] = children[i] != NULL ? &children[i]->fitted.mesh : NULL;
        if (children[i] != NULL) max_error_m = fmax(max_error_m, children[i]->fitted.max_error_m);
    }
    enum scree_status status = mesh_merge(tile->memory, meshes, tile_child_span(children), &mesh, error);
    if (status != SCREE_OK) return status;
    for (int32_t v = 0; v < mesh.vertex_count; v++)
        mesh.vertices[v].at.height_m = (float)(mesh.heights[v] * tile->geometry.height_unit_m);
    status = export(tile, &mesh, max_error_m, fitted, error);
    mesh_release(tile->memory, &mesh);
    return status;
}

void fitted_tile_release(struct scree_memory *memory, struct fitted_tile *fitted) {
    scree_release(memory, fitted->mesh.corners);
    scree_release(memory, fitted->mesh.vertices);
    memset(fitted, 0, sizeof *fitted);
}
