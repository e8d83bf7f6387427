#include "lod/constrained_flip.h"

#define NONE CONSTRAINED_NONE

uint32_t constrained_first_leaving(const struct constrained *c, uint32_t point) {
    uint32_t edge = c->leaving[point];
    for (;;) {
        uint32_t twin = constrained_twin(c, edge);
        if (twin == NONE) return edge;
        edge = constrained_next(twin);
        if (edge == c->leaving[point]) return edge;
    }
}

uint32_t constrained_between(const struct constrained *c, uint32_t a, uint32_t b) {
    uint32_t edge = constrained_first_leaving(c, a);
    for (;;) {
        if (constrained_target(c, edge) == b) return edge;
        if (constrained_apex(c, edge) == b) return constrained_previous(edge);
        edge = constrained_turn(c, edge);
    }
}

uint32_t constrained_new_triangle(struct constrained *c) {
    uint32_t t = c->free_triangle;
    if (t == NONE) return c->triangle_count++;
    c->free_triangle = c->triangles[t].corner[1];
    return t;
}

void constrained_free_triangle(struct constrained *c, uint32_t t) {
    c->triangles[t].corner[0] = NONE;
    c->triangles[t].corner[1] = c->free_triangle;
    c->free_triangle = t;
}

void constrained_set(struct constrained *c, uint32_t t, uint32_t corner0, uint32_t corner1, uint32_t corner2) {
    const uint32_t corner[3] = {corner0, corner1, corner2};
    for (uint32_t k = 0; k < 3; k++) {
        c->triangles[t].corner[k] = corner[k];
        c->leaving[corner[k]] = 3 * t + k;
    }
}

static void set_fixed(struct constrained *c, uint32_t edge, bool fixed) {
    uint8_t bit = (uint8_t)(1u << edge % 3), *bits = &c->triangles[edge / 3].fixed;
    *bits = (uint8_t)(fixed ? *bits | bit : *bits & ~bit);
}

void constrained_link(struct constrained *c, uint32_t edge, uint32_t twin, bool fixed) {
    c->triangles[edge / 3].twin[edge % 3] = twin;
    set_fixed(c, edge, fixed);
    if (twin == NONE) return;
    c->triangles[twin / 3].twin[twin % 3] = edge;
    set_fixed(c, twin, fixed);
}

void constrained_make_fixed(struct constrained *c, uint32_t edge) {
    constrained_link(c, edge, constrained_twin(c, edge), true);
}

void constrained_make_free(struct constrained *c, uint32_t edge) {
    constrained_link(c, edge, constrained_twin(c, edge), false);
}

bool constrained_is_convex(const struct constrained *c, uint32_t edge) {
    const struct constrained_point *at = c->points;
    struct constrained_point a = at[constrained_origin(c, edge)], b = at[constrained_target(c, edge)];
    struct constrained_point left = at[constrained_apex(c, edge)];
    struct constrained_point right = at[constrained_apex(c, constrained_twin(c, edge))];
    return constrained_area2(right, b, left) > 0 && constrained_area2(left, a, right) > 0;
}

void constrained_flip(struct constrained *c, uint32_t edge) {
    /* t = (a, b, left) and u = (b, a, right) become t = (a, right, left) and u = (right, b, left). */
    uint32_t across = constrained_twin(c, edge), t = edge / 3, u = across / 3;
    uint32_t a = constrained_origin(c, edge), b = constrained_target(c, edge);
    uint32_t left = constrained_apex(c, edge), right = constrained_apex(c, across);
    const uint32_t old[4] = {constrained_next(across), constrained_previous(across), constrained_next(edge),
                             constrained_previous(edge)}; /* a to right, right to b, b to left, left to a */
    uint32_t twin[4];
    bool fixed[4];
    for (int i = 0; i < 4; i++) {
        twin[i] = constrained_twin(c, old[i]);
        fixed[i] = constrained_is_fixed(c, old[i]);
    }
    constrained_set(c, t, a, right, left);
    constrained_set(c, u, right, b, left);
    constrained_link(c, 3 * t, twin[0], fixed[0]);
    constrained_link(c, 3 * u, twin[1], fixed[1]);
    constrained_link(c, 3 * u + 1, twin[2], fixed[2]);
    constrained_link(c, 3 * t + 2, twin[3], fixed[3]);
    constrained_link(c, 3 * t + 1, 3 * u + 2, false);
    constrained_doubt(c, 3 * t);
    constrained_doubt(c, 3 * t + 1);
    constrained_doubt(c, 3 * t + 2);
    constrained_doubt(c, 3 * u);
    constrained_doubt(c, 3 * u + 1);
}

void constrained_doubt(struct constrained *c, uint32_t edge) {
    uint8_t bit = (uint8_t)(1u << edge % 3), *bits = &c->triangles[edge / 3].pending;
    if ((*bits & bit) != 0) return;
    *bits |= bit;
    c->stack[c->stack_count++] = edge;
}

void constrained_settle(struct constrained *c) {
    while (c->stack_count > 0) {
        uint32_t edge = c->stack[--c->stack_count];
        struct constrained_triangle *triangle = &c->triangles[edge / 3];
        triangle->pending &= (uint8_t) ~(1u << edge % 3);
        if (triangle->corner[0] == NONE || constrained_is_fixed(c, edge)) continue;
        uint32_t across = constrained_twin(c, edge);
        if (constrained_in_circle(c->points[triangle->corner[0]], c->points[triangle->corner[1]],
                                  c->points[triangle->corner[2]], c->points[constrained_apex(c, across)]))
            constrained_flip(c, edge);
    }
}
