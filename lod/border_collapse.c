#include "lod/border_collapse.h"

#include "lod/ahead.h"
#include "lod/ear.h"

#include <math.h>

/* Errors of the fan from ring[target] (0 or degree) that a collapse along the border leaves; INFINITY when a triangle
 * would lose its area, or a rung to come get out of reach. */
static float fan_error_m(const struct simplifier *simplifier, const struct star *star, int32_t target) {
    float largest_m = 0;
    int32_t first = target == 0 ? 1 : 0;
    for (int32_t i = first; i < first + star->degree - 1; i++) {
        const struct sample *a = &star->at[target], *b = &star->at[i], *c = &star->at[i + 1];
        if (sample_area2(a, b, c) <= 0) return INFINITY;
        float error_m = samples_triangle_error(&simplifier->samples, a, b, c).max_m;
        if (!ahead_admits(simplifier->options.ahead, a, b, c, error_m)) return INFINITY;
        largest_m = fmaxf(largest_m, error_m);
    }
    return largest_m;
}

/* Triangulations of the polygon ring[0] ... ring[degree] by least error: apex[i][j] is the third corner of the
 * triangle on the chord from ring[i] to ring[j]. Larger stars lose ears first. */
#define POLYGON_MAX 40
struct polygon {
    float error_m[POLYGON_MAX][POLYGON_MAX];
    unsigned char apex[POLYGON_MAX][POLYGON_MAX];
};

static void triangulate(const struct simplifier *simplifier, const struct star *star, struct polygon *polygon) {
    for (int32_t i = 0; i < star->degree; i++) polygon->error_m[i][i + 1] = 0;
    for (int32_t width = 2; width <= star->degree; width++)
        for (int32_t i = 0; i + width <= star->degree; i++) {
            int32_t j = i + width;
            polygon->error_m[i][j] = INFINITY;
            polygon->apex[i][j] = (unsigned char)(i + 1);
            for (int32_t k = i + 1; k < j; k++) {
                float both_m = fmaxf(polygon->error_m[i][k], polygon->error_m[k][j]);
                if (both_m >= polygon->error_m[i][j] || sample_area2(&star->at[i], &star->at[k], &star->at[j]) <= 0)
                    continue;
                float here_m =
                    samples_triangle_error(&simplifier->samples, &star->at[i], &star->at[k], &star->at[j]).max_m;
                if (fmaxf(both_m, here_m) >= polygon->error_m[i][j]) continue;
                if (!ahead_admits(simplifier->options.ahead, &star->at[i], &star->at[k], &star->at[j], here_m))
                    continue;
                polygon->error_m[i][j] = fmaxf(both_m, here_m);
                polygon->apex[i][j] = (unsigned char)k;
            }
        }
}

/* The outgoing half-edge of a vertex that ends at `to`. */
static int32_t edge_to(const struct mesh *mesh, int32_t vertex, int32_t to) {
    int32_t edge = mesh->vertices[vertex].edge;
    while (mesh_origin(mesh, mesh_next(edge)) != to) edge = mesh_twin(mesh, mesh_previous(edge));
    return edge;
}

/* Flips the vertex's edges to all of ring[i + 1] ... ring[j - 1], so that the polygon's triangles between i and j
 * stand and the vertex is joined to ring[i] and ring[j] only. */
static void flip_between(struct simplifier *simplifier, const struct star *star, const struct polygon *polygon,
                         int32_t i, int32_t j) {
    if (j - i < 2) return;
    int32_t k = polygon->apex[i][j];
    flip_between(simplifier, star, polygon, i, k);
    flip_between(simplifier, star, polygon, k, j);
    mesh_flip(simplifier->mesh, edge_to(simplifier->mesh, star->vertex, star->ring[k]));
}

/* Takes the vertex out after flips that leave the polygon's best triangulation. */
static void retriangulate(struct simplifier *simplifier, const struct star *star, const struct polygon *polygon) {
    struct star narrow;
    int32_t apex = polygon->apex[0][star->degree];
    flip_between(simplifier, star, polygon, 0, apex);
    flip_between(simplifier, star, polygon, apex, star->degree);
    mesh_star(simplifier->mesh, star->vertex, &narrow);
    mesh_collapse(simplifier->mesh, &narrow, 0);
}

/* Takes the star's vertex out in the way of the least error that leaves the rungs to come within reach; false, maybe
 * after some flips, when there is none. */
static bool take_out(struct simplifier *simplifier, struct star *star, float tolerance_m) {
    struct polygon polygon;
    float first_m = fan_error_m(simplifier, star, 0), last_m = fan_error_m(simplifier, star, star->degree);
    float least_m = fminf(first_m, last_m);
    bool turned = false;
    if (least_m > tolerance_m) {
        while (star->degree >= POLYGON_MAX && ear_cut(simplifier, star)) continue;
        if (star->degree >= 3 && star->degree < POLYGON_MAX) {
            triangulate(simplifier, star, &polygon);
            turned = polygon.error_m[0][star->degree] < least_m;
        }
    }
    if (turned)
        retriangulate(simplifier, star, &polygon);
    else if (least_m < INFINITY)
        mesh_collapse(simplifier->mesh, star, first_m <= last_m ? 0 : star->degree);
    return turned || least_m < INFINITY;
}

static enum scree_status remove_vertex(struct simplifier *simplifier, int32_t vertex, float tolerance_m,
                                       struct scree_error *error) {
    struct star star;
    if (!mesh_star(simplifier->mesh, vertex, &star))
        return scree_fail(error, SCREE_E_LIMIT, "a border vertex has more than %d triangles", MESH_MAX_DEGREE);
    simplify_tell(simplifier, &star);
    bool is_out = take_out(simplifier, &star, tolerance_m);
    if (!is_out) { /* beside a TIN's border a rung may be out of reach from the beginning */
        const struct ahead *ahead = simplifier->options.ahead;
        simplifier->options.ahead = NULL;
        is_out = take_out(simplifier, &star, tolerance_m);
        simplifier->options.ahead = ahead;
    }
    if (!is_out)
        return scree_fail(error, SCREE_E_LIMIT, "a border vertex with %d triangles cannot be taken out",
                          (int)star.degree);
    ear_measure(simplifier, &star);
    simplifier_star_changed(simplifier, &star);
    return SCREE_OK;
}

/* Any vertex on the border; meshes of tiles have one border. */
static int32_t some_border_vertex(const struct mesh *mesh) {
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->vertices[v].edge != MESH_NONE && mesh_twin(mesh, mesh->vertices[v].edge) == MESH_NONE) return v;
    return MESH_NONE;
}

enum scree_status border_collapse(struct simplifier *simplifier, const struct border_line lines[SIDE_COUNT],
                                  int32_t columns, int32_t rows, float tolerance_m, struct scree_error *error) {
    struct mesh *mesh = simplifier->mesh;
    int32_t corner = some_border_vertex(mesh), position;
    while (border_side(columns, rows, &mesh->vertices[corner].at, &position) != SIDE_COUNT)
        corner = mesh_origin(mesh, mesh_next(mesh->vertices[corner].edge));
    for (int32_t before = corner;;) {
        int32_t vertex = mesh_origin(mesh, mesh_next(mesh->vertices[before].edge));
        if (vertex == corner) return SCREE_OK;
        enum tile_side side = border_side(columns, rows, &mesh->vertices[vertex].at, &position);
        if (side == SIDE_COUNT || border_keeps(&lines[side], position)) {
            before = vertex;
            continue;
        }
        enum scree_status status = remove_vertex(simplifier, vertex, tolerance_m, error);
        if (status != SCREE_OK) return status;
    }
}
