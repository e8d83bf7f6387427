#include "lod/strip.h"

#include <string.h>

#define LAYER_DEGREE 8 /* larger stars wait until their neighbours are gone */

/* How equilateral a triangle is; not positive when it is turned over. */
static double shape(const struct sample *a, const struct sample *b, const struct sample *c) {
    double abx = b->x - a->x, aby = b->y - a->y, bcx = c->x - b->x, bcy = c->y - b->y, cax = a->x - c->x,
           cay = a->y - c->y;
    double squares = abx * abx + aby * aby + bcx * bcx + bcy * bcy + cax * cax + cay * cay;
    return (double)sample_area2(a, b, c) / squares;
}

/* Flips the edge to the best-shaped ear of the star; false when there is none. */
static bool cut_ear(struct mesh *mesh, struct star *star) {
    const struct sample *at = &mesh->vertices[star->vertex].at;
    double best = 0;
    int32_t ear = MESH_NONE;
    for (int32_t i = star->open ? 1 : 0; i < star->degree; i++) {
        const struct sample *a = &star->at[i > 0 ? i - 1 : star->degree - 1], *b = &star->at[i], *c = &star->at[i + 1];
        double here = shape(a, b, c);
        if (here <= best || sample_area2(at, a, c) <= 0) continue;
        best = here;
        ear = i;
    }
    if (ear == MESH_NONE) return false;
    mesh_flip(mesh, star->edge[ear]);
    return mesh_star(mesh, star->vertex, star);
}

static bool is_corner(const struct star *star, const struct sample *at) {
    const struct sample *after = &star->at[0], *before = &star->at[star->degree];
    return star->open && sample_area2(before, at, after) != 0;
}

/* Where a closed star without ears collapses to. Its vertex lies on both diagonals of a quadrilateral, or on the only
 * one that is inside. */
static int32_t last_target(const struct star *star) {
    bool first_inside = star->degree != 4 || (shape(&star->at[0], &star->at[1], &star->at[2]) > 0 &&
                                              shape(&star->at[0], &star->at[2], &star->at[3]) > 0);
    return star->open || first_inside ? 0 : 1;
}

void strip_vertex(struct mesh *mesh, struct star *star) {
    while (star->degree > (star->open ? 2 : 3) && cut_ear(mesh, star)) continue;
    mesh_collapse(mesh, star, last_target(star));
}

static void take_out(struct mesh *mesh, struct star *star, unsigned char *taken) {
    for (int32_t i = 0; i <= star->degree; i++) taken[star->ring[i]] = 1; /* as neighbours of one that is gone */
    strip_vertex(mesh, star);
}

int32_t strip_layer(struct mesh *mesh, unsigned char *taken, const struct simplify_observer *observer) {
    struct star star;
    int32_t removed = 0;
    memset(taken, 0, (size_t)mesh->vertex_count);
    for (int32_t most = LAYER_DEGREE; removed == 0 && most <= MESH_MAX_DEGREE; most *= 2)
        for (int32_t v = 0; v < mesh->vertex_count; v++) {
            if (mesh->vertices[v].edge == MESH_NONE || taken[v] || !mesh_star(mesh, v, &star)) continue;
            if (star.degree > most || is_corner(&star, &mesh->vertices[v].at)) continue;
            observer->remove(observer->context, &star);
            take_out(mesh, &star, taken);
            removed++;
        }
    return removed;
}
