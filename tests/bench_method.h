/* The simplifiers that bench_simplify compares, all behind one form: posts and a bound in, triangulation out. */
#ifndef SCREE_TESTS_BENCH_METHOD_H
#define SCREE_TESTS_BENCH_METHOD_H

#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>
#include <stddef.h>

struct bench_task {
    const float *heights_m; /* rows of `columns` posts, row 0 in the south */
    int columns, rows;
    double tolerance_m;     /* largest vertical error allowed; not looked at where vertex_target is given */
    uint32_t vertex_target; /* stop at so many vertices instead; 0: by the tolerance */
};

struct bench_mesh {
    struct scree_mesh mesh;   /* positions are posts; `height` is not looked at */
    double *vertex_heights_m; /* one a vertex; NULL: the heights of the posts */
};

struct bench_method {
    const char *name;
    enum scree_status (*simplify)(const struct bench_task *task, struct scree_memory *memory, struct bench_mesh *made,
                                  struct scree_error *error);
};

/* The first one is the reference. */
extern const struct bench_method bench_methods[];
extern const size_t bench_method_count;

/* Gives the arrays back to `memory`; fine on an empty mesh. */
void bench_mesh_free(struct bench_mesh *made, struct scree_memory *memory);

#endif
