/* The simplifiers of bench_simplify: see the header. */
#include "tests/bench_method.h"

#include "lod/greedy.h"

static enum scree_status by_greedy_insertion(const struct bench_task *task, struct scree_memory *memory,
                                             struct bench_mesh *made, struct scree_error *error) {
    struct greedy_options options = {.tolerance_m = task->tolerance_m};
    if (task->vertex_target != 0) options = (struct greedy_options){.max_vertices = task->vertex_target};
    return greedy_triangulate(task->heights_m, task->columns, task->rows, task->columns, &options, memory, &made->mesh,
                              NULL, error);
}

const struct bench_method bench_methods[] = {
    {"greedy insertion", by_greedy_insertion},
};
const size_t bench_method_count = sizeof bench_methods / sizeof *bench_methods;

void bench_mesh_free(struct bench_mesh *made, struct scree_memory *memory) {
    scree_release(memory, made->vertex_heights_m);
    scree_release(memory, made->mesh.corners);
    scree_release(memory, made->mesh.vertices);
    *made = (struct bench_mesh){0};
}
