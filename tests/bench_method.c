/* The simplifiers of bench_simplify: see the header. */
#include "tests/bench_method.h"

#include "lod/greedy.h"
#include "lod/tile.h"

#include <math.h>
#include <string.h>

/* Our own heights are whole multiples of this. */
#define HEIGHT_UNIT_M (1.0 / 256)

static enum scree_status by_greedy_insertion(const struct bench_task *task, struct scree_memory *memory,
                                             struct bench_mesh *made, struct scree_error *error) {
    struct greedy_options options = {.tolerance_m = task->tolerance_m};
    if (task->vertex_target != 0) options = (struct greedy_options){.max_vertices = task->vertex_target};
    return greedy_triangulate(task->heights_m, task->columns, task->rows, task->columns, &options, memory, &made->mesh,
                              NULL, error);
}

static int clamped(int value, int count) {
    return value < 0 ? 0 : value < count ? value : count - 1;
}

/* The posts of the task with a margin of one post, repeated from the border, as tiles want them for their slopes. */
static float *with_margin_new(const struct bench_task *task, struct scree_memory *memory, struct scree_error *error) {
    int stride = task->columns + 2;
    float *heights_m = scree_allocate(memory, (size_t)stride * (size_t)(task->rows + 2), sizeof *heights_m,
                                      "posts with a margin", error);
    for (int y = -1; heights_m != NULL && y <= task->rows; y++)
        for (int x = -1; x <= task->columns; x++)
            heights_m[(y + 1) * stride + x + 1] =
                task->heights_m[clamped(y, task->rows) * task->columns + clamped(x, task->columns)];
    return heights_m;
}

/* One tile of a flat Earth, made of the task's posts and taken straight to the tolerance. */
static enum scree_status collapse_to(const struct bench_task *task, double tolerance_m, struct scree_memory *memory,
                                     struct scree_mesh *mesh, struct scree_error *error) {
    const struct tile_geometry geometry = {.columns = task->columns - 1,
                                           .rows = task->rows - 1,
                                           .cell_span = 1,
                                           .height_unit_m = HEIGHT_UNIT_M,
                                           .east_m = 1,
                                           .north_m = 1};
    const int stride = task->columns + 2;
    enum scree_status status = SCREE_E_MEMORY;
    struct tile *tile = scree_allocate(memory, 1, sizeof *tile, "a tile", error);
    float *heights_m = with_margin_new(task, memory, error);
    double *steps_m = scree_allocate(memory, (size_t)task->rows, sizeof *steps_m, "steps", error);
    if (tile == NULL || heights_m == NULL || steps_m == NULL) goto cleanup;
    for (int y = 0; y < task->rows; y++) steps_m[y] = 1;
    const struct tile_posts posts = {heights_m + stride + 1, stride, steps_m, steps_m};
    if ((status = tile_from_posts(memory, &geometry, &posts, tile, error)) != SCREE_OK) goto cleanup;
    if ((status = tile_advance(tile, tolerance_m, error)) != SCREE_OK) goto cleanup;
    status = mesh_export_new(memory, &tile->mesh, mesh, error);
cleanup:
    tile_release(tile);
    scree_release(memory, steps_m);
    scree_release(memory, heights_m);
    scree_release(memory, tile);
    return status;
}

/* The heights that the mesh has, not those of the posts: they are rounded to the unit. */
static enum scree_status tell_heights(struct scree_memory *memory, struct bench_mesh *made, struct scree_error *error) {
    const struct scree_mesh *mesh = &made->mesh;
    made->vertex_heights_m =
        scree_allocate(memory, mesh->vertex_count, sizeof *made->vertex_heights_m, "vertex heights", error);
    if (made->vertex_heights_m == NULL) return SCREE_E_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        made->vertex_heights_m[v] = mesh->vertices[v].height * HEIGHT_UNIT_M;
    return SCREE_OK;
}

static enum scree_status collapse(const struct bench_task *task, double tolerance_m, struct scree_memory *memory,
                                  struct bench_mesh *made, struct scree_error *error) {
    bench_mesh_free(made, memory);
    enum scree_status status = collapse_to(task, tolerance_m, memory, &made->mesh, error);
    return status == SCREE_OK ? tell_heights(memory, made, error) : status;
}

/* Where a number of vertices is asked for, the tolerance that takes the most of them without taking more is found by
 * bisection, so its time is that of many meshes and not to be compared. */
static enum scree_status by_collapse(const struct bench_task *task, struct scree_memory *memory,
                                     struct bench_mesh *made, struct scree_error *error) {
    if (task->vertex_target == 0) return collapse(task, task->tolerance_m, memory, made, error);
    double few_m = 1000, many_m = 0;
    for (int step = 0; step < 16; step++) {
        double middle_m = (few_m + many_m) / 2;
        enum scree_status status = collapse(task, middle_m, memory, made, error);
        if (status != SCREE_OK) return status;
        if (made->mesh.vertex_count > task->vertex_target)
            many_m = middle_m;
        else
            few_m = middle_m;
    }
    return collapse(task, few_m, memory, made, error);
}

const struct bench_method bench_methods[] = {
    {"greedy insertion", by_greedy_insertion},
    {"scree", by_collapse},
};
const size_t bench_method_count = sizeof bench_methods / sizeof *bench_methods;

void bench_mesh_free(struct bench_mesh *made, struct scree_memory *memory) {
    scree_release(memory, made->vertex_heights_m);
    scree_release(memory, made->mesh.corners);
    scree_release(memory, made->mesh.vertices);
    *made = (struct bench_mesh){0};
}
