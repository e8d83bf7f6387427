/* Greedy insertion into a rectangle whose borders are free: the engine is lod/insertion.h. */
#include "lod/greedy.h"

#include "lod/insertion.h"

#include <string.h>

static enum scree_status check_arguments(const float *heights_m, int columns, int rows, int stride,
                                         const struct greedy_options *options, struct scree_error *error) {
    if (heights_m == NULL || columns < 2 || rows < 2 || columns > GREEDY_MAX_POSTS || rows > GREEDY_MAX_POSTS ||
        stride < columns)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "greedy insertion: %d x %d posts with a stride of %d; it takes 2 to %d a side", columns, rows,
                          stride, GREEDY_MAX_POSTS);
    if (!(options->tolerance_m >= 0))
        return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: the tolerance of %g m is not 0 or more",
                          options->tolerance_m);
    if (options->max_vertices != 0 && options->max_vertices < 4)
        return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: a rectangle takes at least 4 vertices, not %u",
                          (unsigned)options->max_vertices);
    return SCREE_OK;
}

/* Copies points and triangles into a mesh of their exact size. */
static enum scree_status hand_out(const struct delaunay *made, struct scree_mesh *mesh, struct scree_error *error) {
    struct scree_mesh out = {.vertex_count = made->point_count, .triangle_count = made->triangle_count};
    out.vertices =
        scree_allocate(made->memory, out.vertex_count, sizeof *out.vertices, "the vertices of a triangulation", error);
    out.corners = scree_allocate(made->memory, 3 * (size_t)out.triangle_count, sizeof *out.corners,
                                 "the corners of a triangulation", error);
    if (out.vertices == NULL || out.corners == NULL) {
        greedy_free(&out, made->memory);
        return error->status;
    }
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        out.vertices[i].x = made->points[i].x;
        out.vertices[i].y = made->points[i].y;
    }
    for (uint32_t t = 0; t < out.triangle_count; t++)
        memcpy(out.corners + 3 * (size_t)t, made->triangles[t].corner, sizeof made->triangles[t].corner);
    *mesh = out;
    return SCREE_OK;
}

enum scree_status greedy_triangulate(const float *heights_m, int columns, int rows, int stride,
                                     const struct greedy_options *options, struct scree_memory *memory,
                                     struct scree_mesh *mesh, double *max_error_m, struct scree_error *error) {
    struct scree_error own_error = {0};
    if (error == NULL) error = &own_error;
    enum scree_status status = check_arguments(heights_m, columns, rows, stride, options, error);
    if (status != SCREE_OK) return status;
    const struct insertion_posts posts = {heights_m, columns, rows, stride, 1, 0};
    struct insertion insertion;
    status = insertion_start(memory, &posts, 0, true, &insertion, error);
    uint32_t most = options->max_vertices != 0 ? options->max_vertices : UINT32_MAX;
    if (status == SCREE_OK) status = insertion_run(&insertion, options->tolerance_m, most, error);
    if (status == SCREE_OK) status = hand_out(&insertion.mesh, mesh, error);
    if (status == SCREE_OK && max_error_m != NULL) *max_error_m = insertion_error_m(&insertion);
    insertion_release(&insertion);
    return status;
}

void greedy_free(struct scree_mesh *mesh, struct scree_memory *memory) {
    scree_release(memory, mesh->corners);
    scree_release(memory, mesh->vertices);
    *mesh = (struct scree_mesh){0};
}
