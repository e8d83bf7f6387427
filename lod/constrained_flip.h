/* What the parts of the constrained triangulation share: half-edges, flips, and Lawson's way back to Delaunay. Pure.
 * Only lod/constrained*.c and their tests include this. */
#ifndef SCREE_LOD_CONSTRAINED_FLIP_H
#define SCREE_LOD_CONSTRAINED_FLIP_H

#include "lod/constrained.h"

static inline uint32_t constrained_next(uint32_t edge) {
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

static inline uint32_t constrained_previous(uint32_t edge) {
    return edge % 3 == 0 ? edge + 2 : edge - 1;
}

static inline uint32_t constrained_origin(const struct constrained *c, uint32_t edge) {
    return c->triangles[edge / 3].corner[edge % 3];
}

static inline uint32_t constrained_target(const struct constrained *c, uint32_t edge) {
    return constrained_origin(c, constrained_next(edge));
}

/* The corner that is not on the edge. */
static inline uint32_t constrained_apex(const struct constrained *c, uint32_t edge) {
    return constrained_origin(c, constrained_previous(edge));
}

static inline uint32_t constrained_twin(const struct constrained *c, uint32_t edge) {
    return c->triangles[edge / 3].twin[edge % 3];
}

static inline bool constrained_is_fixed(const struct constrained *c, uint32_t edge) {
    return (c->triangles[edge / 3].fixed & 1u << edge % 3) != 0;
}

/* The next half-edge that leaves the same point, counter-clockwise; CONSTRAINED_NONE beyond the border. */
static inline uint32_t constrained_turn(const struct constrained *c, uint32_t edge) {
    return constrained_twin(c, constrained_previous(edge));
}

/* A half-edge that leaves a point; the clockwise last one where the point is on the border, so that constrained_turn
 * comes to all triangles around it. */
uint32_t constrained_first_leaving(const struct constrained *c, uint32_t point);

/* One of the half-edges between two points that have an edge. */
uint32_t constrained_between(const struct constrained *c, uint32_t a, uint32_t b);

uint32_t constrained_new_triangle(struct constrained *c);
void constrained_free_triangle(struct constrained *c, uint32_t t);

/* Gives a triangle its corners; its edges are to be linked anew. */
void constrained_set(struct constrained *c, uint32_t t, uint32_t corner0, uint32_t corner1, uint32_t corner2);
void constrained_link(struct constrained *c, uint32_t edge, uint32_t twin, bool fixed);
void constrained_make_fixed(struct constrained *c, uint32_t edge);
void constrained_make_free(struct constrained *c, uint32_t edge);

/* Whether the triangles on both sides of an edge make a quadrilateral that is convex at all four corners. */
bool constrained_is_convex(const struct constrained *c, uint32_t edge);

/* Replaces the diagonal of such a quadrilateral; all edges around are doubted. */
void constrained_flip(struct constrained *c, uint32_t edge);

/* Remembers that an edge may not be Delaunay, and flips until none in doubt is left that is not. */
void constrained_doubt(struct constrained *c, uint32_t edge);
void constrained_settle(struct constrained *c);

#endif
