#include "lod/code_collapse.h"

#include "lod/ear.h"

#include <math.h>

#define HIGHEST_M 1e5f /* no step on Earth is higher */

static bool positive_in_codes(const struct simplifier *simplifier, const struct mesh_triangle *triangle) {
    const struct mesh_vertex *vertices = simplifier->mesh->vertices;
    return codes_positive(&simplifier->options.codes, &vertices[triangle->vertex[0]].at,
                          &vertices[triangle->vertex[1]].at, &vertices[triangle->vertex[2]].at);
}

/* Collapses one corner of the triangle. With `cut_ears` its star first loses ears until three triangles are left, which
 * can always become one. */
static bool collapse_corner(struct simplifier *simplifier, const struct mesh_triangle *triangle, bool cut_ears) {
    struct star star;
    for (int i = 0; i < 3; i++) {
        int32_t vertex = triangle->vertex[i];
        if (!simplifier_may_collapse(simplifier, vertex) || !mesh_star(simplifier->mesh, vertex, &star)) continue;
        if (cut_ears) simplify_tell(simplifier, &star);
        while (cut_ears && star.degree > 3 && ear_cut(simplifier, &star)) continue;
        if (simplify_vertex(simplifier, &star)) return true;
    }
    return false;
}

/* Beside a wall the first collapse that can be done may take its foot away, and the next one a vertex that nobody
 * misses: bounds grow from the rung's own on until there is one. */
static bool collapse_gently(struct simplifier *simplifier, const struct mesh_triangle *triangle, float tolerance_m) {
    bool done = false;
    for (float bound_m = tolerance_m; bound_m > 0 && bound_m < HIGHEST_M && !done; bound_m *= 2) {
        simplifier->tolerance_m = bound_m;
        done = collapse_corner(simplifier, triangle, false);
    }
    simplifier->tolerance_m = INFINITY;
    return done || collapse_corner(simplifier, triangle, false);
}

/* Any collapse, without a look at the codes of the triangles that it makes: they come next. */
static bool collapse_corner_anyhow(struct simplifier *simplifier, const struct mesh_triangle *triangle) {
    int64_t span = simplifier->options.codes.span;
    simplifier->options.codes.span = 0;
    bool done = collapse_corner(simplifier, triangle, true);
    simplifier->options.codes.span = span;
    return done;
}

int32_t code_collapse(struct simplifier *simplifier) {
    if (simplifier->options.codes.span == 0) return 0;
    float tolerance_m = simplifier->tolerance_m;
    int32_t bad = 1, stuck;
    simplifier->tolerance_m = INFINITY;
    queue_reset(&simplifier->queue, 1);
    for (bool anyhow = false; bad > 0; anyhow = stuck == bad) {
        bad = stuck = 0;
        for (int32_t t = 0; t < simplifier->mesh->triangle_count; t++) {
            const struct mesh_triangle *triangle = &simplifier->mesh->triangles[t];
            if (triangle->vertex[0] == MESH_NONE || positive_in_codes(simplifier, triangle)) continue;
            bad++;
            if (collapse_gently(simplifier, triangle, tolerance_m)) continue;
            if (!anyhow || !collapse_corner_anyhow(simplifier, triangle)) stuck++;
        }
        if (anyhow && stuck == bad) break;
    }
    simplifier->tolerance_m = tolerance_m;
    return bad;
}
