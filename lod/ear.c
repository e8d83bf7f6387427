#include "lod/ear.h"

#include "lod/ahead.h"

#include <math.h>

static void measure_triangle(struct simplifier *simplifier, struct mesh_triangle *triangle) {
    const struct mesh_vertex *vertices = simplifier->mesh->vertices;
    struct triangle_error error =
        samples_triangle_error(&simplifier->samples, &vertices[triangle->vertex[0]].at,
                               &vertices[triangle->vertex[1]].at, &vertices[triangle->vertex[2]].at);
    triangle->max_m = error.max_m;
    triangle->sum_squares_m2 = error.sum_squares_m2;
}

void ear_measure(struct simplifier *simplifier, const struct star *star) {
    for (int32_t i = 0; i < star->degree; i++) {
        struct mesh_triangle *triangle = &simplifier->mesh->triangles[star->edge[i] >> 2];
        if (triangle->vertex[0] != MESH_NONE) measure_triangle(simplifier, triangle);
    }
}

bool ear_cut(struct simplifier *simplifier, struct star *star) {
    const struct sample *at = &simplifier->mesh->vertices[star->vertex].at;
    float least_m = INFINITY;
    int32_t ear = MESH_NONE;
    for (int32_t i = star->open ? 1 : 0; i < star->degree; i++) {
        const struct sample *a = &star->at[i > 0 ? i - 1 : star->degree - 1], *b = &star->at[i], *c = &star->at[i + 1];
        if (sample_area2(a, b, c) <= 0 || sample_area2(at, a, c) <= 0) continue;
        float error_m = samples_triangle_error(&simplifier->samples, a, b, c).max_m;
        if (error_m >= least_m || !ahead_admits(simplifier->options.ahead, a, b, c, error_m) ||
            !ahead_admits(simplifier->options.ahead, at, a, c, 0)) /* it goes with the vertex */
            continue;
        least_m = error_m;
        ear = i;
    }
    if (ear == MESH_NONE) return false;
    simplifier_star_changed(simplifier, star);
    int32_t edge = star->edge[ear], twin = mesh_twin(simplifier->mesh, edge);
    mesh_flip(simplifier->mesh, edge);
    measure_triangle(simplifier, &simplifier->mesh->triangles[edge >> 2]);
    measure_triangle(simplifier, &simplifier->mesh->triangles[twin >> 2]);
    return mesh_star(simplifier->mesh, star->vertex, star);
}
