#include "lod/quadric.h"

#include <math.h>

struct vector {
    double x, y, z;
};

static struct vector metric(const struct sample *at, const struct sample *origin, struct drop drop, double east_m,
                            double north_m) {
    return (struct vector){(at->x - origin->x) * east_m, (at->y - origin->y) * north_m,
                           sample_drawn_m(at, origin, drop)};
}

/* The least quadric error over the edges of a star, with the vertex at the origin: every plane passes through it. */
static double least_error_m2(const struct star *star, const struct sample *at, struct drop drop, double east_m,
                             double north_m) {
    struct vector normals[MESH_MAX_DEGREE], ring[MESH_MAX_DEGREE + 1];
    for (int32_t i = 0; i <= star->degree; i++) ring[i] = metric(&star->at[i], at, drop, east_m, north_m);
    for (int32_t i = 0; i < star->degree; i++) {
        const struct vector *a = &ring[i], *b = &ring[i + 1];
        struct vector n = {a->y * b->z - a->z * b->y, a->z * b->x - a->x * b->z, a->x * b->y - a->y * b->x};
        double length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        double scale = length > 0 ? 1 / length : 0;
        normals[i] = (struct vector){n.x * scale, n.y * scale, n.z * scale};
    }
    double least_m2 = INFINITY;
    int32_t edges = star->open ? star->degree + 1 : star->degree;
    for (int32_t k = 0; k < edges; k++) {
        double error_m2 = 0;
        for (int32_t i = 0; i < star->degree; i++) {
            double distance_m = normals[i].x * ring[k].x + normals[i].y * ring[k].y + normals[i].z * ring[k].z;
            error_m2 += distance_m * distance_m;
        }
        if (error_m2 < least_m2) least_m2 = error_m2;
    }
    return least_m2;
}

double quadric_mmqe_m2(const struct mesh *mesh, const struct samples *samples, double east_m, double north_m) {
    struct star star;
    double sum_m2 = 0;
    int32_t count = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertices[v].edge == MESH_NONE || !mesh_star(mesh, v, &star)) continue;
        const struct sample *at = &mesh->vertices[v].at;
        sum_m2 += least_error_m2(&star, at, samples_drop(samples, at->y), east_m, north_m);
        count++;
    }
    return count > 0 ? sum_m2 / count : 0;
}
