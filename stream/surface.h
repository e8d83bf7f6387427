/* The triangulation that encoder and decoder grow side by side: triangles over lattice posts, with neighbours. Pure.
 *
 * A half-edge is 4 * triangle + corner (corner 0 .. 2); it starts at that corner and runs counter-clockwise.
 *
 * A cavity is a set of triangles whose union a point sees whole. Inserting the point makes them give way to the fan of
 * the cavity's outer edges around it: this is how a vertex comes into a triangulation, and how any removal is undone.
 */
#ifndef SCREE_STREAM_SURFACE_H
#define SCREE_STREAM_SURFACE_H

#include "stream/memory.h"
#include "stream/progressive.h"
#include <stdbool.h>

#define SURFACE_NONE UINT32_MAX
#define CAVITY_MOST  1024 /* triangles */

struct surface_triangle {
    uint32_t vertex[3];
    uint32_t twin[3]; /* the half-edge on the other side; SURFACE_NONE on the border */
    uint16_t posts;   /* lattice posts of the triangle where a vertex can be inserted, as far as 65535 */
    uint32_t first;   /* of a list of points that lie in it, kept by whoever uses the surface; SURFACE_NONE */
};

#define SURFACE_DIVISORS 32 /* lengths whose common divisors are looked up */

struct surface {
    uint32_t vertex_count, triangle_count, vertex_capacity, triangle_capacity;
    struct scree_vertex *vertices;
    struct surface_triangle *triangles;
    unsigned char divisor[SURFACE_DIVISORS][SURFACE_DIVISORS]; /* greatest common ones; set by surface_rectangle */
};

struct cavity {
    uint32_t triangle_count, edge_count;
    bool open;                        /* the point lies on the border */
    uint32_t common_count, common[3]; /* corners that all triangles have in common: of a fan at least one */
    uint32_t triangles[CAVITY_MOST];
    uint32_t edges[CAVITY_MOST + 2]; /* outer half-edges of the triangles, counter-clockwise; an open cavity's begin
                                        at the border vertex that follows the point */
    /* of each outer edge: its ends, what is beyond it, the slot of the fan's triangle; filled by surface_insert */
    uint32_t from[CAVITY_MOST + 2], to[CAVITY_MOST + 2], twin[CAVITY_MOST + 2], slots[CAVITY_MOST + 2];
};

static inline uint32_t surface_next(uint32_t edge) {
    return (edge & 3) == 2 ? edge - 2 : edge + 1;
}
static inline uint32_t surface_previous(uint32_t edge) {
    return (edge & 3) == 0 ? edge + 2 : edge - 1;
}
static inline uint32_t surface_origin(const struct surface *surface, uint32_t edge) {
    return surface->triangles[edge >> 2].vertex[edge & 3];
}
static inline uint32_t surface_twin(const struct surface *surface, uint32_t edge) {
    return surface->triangles[edge >> 2].twin[edge & 3];
}

/* Twice the signed area of (a, b, c) in lattice steps: exact, positive when counter-clockwise. */
static inline int64_t surface_area2(const struct scree_vertex *a, const struct scree_vertex *b,
                                    const struct scree_vertex *c) {
    return (int64_t)(b->x - a->x) * (c->y - a->y) - (int64_t)(c->x - a->x) * (b->y - a->y);
}

/* Every post of the rectangle that is not a vertex belongs to exactly one triangle. Those on an edge belong to the side
 * on which the edge runs north, or east if it is level; those on the border to the only triangle there is. */

/* Whether the posts on an edge belong to the triangle that it is an edge of. */
static inline bool surface_owns(const struct scree_vertex *from, const struct scree_vertex *to, uint32_t twin) {
    bool north = to->y > from->y, level = to->y == from->y, east = to->x > from->x, border = twin == SURFACE_NONE;
    return north | (level & east) | border; /* no branches: none of these can be foreseen */
}

bool surface_has_post(const struct surface *surface, uint32_t triangle, int32_t x, int32_t y);

/* Room for so many; two triangles over a rectangle of columns x rows steps, whose corners are vertices 0 .. 3
 * (south-west, south-east, north-west, north-east; heights 0), divided from south-west to north-east if `rising`. */
enum scree_status surface_start(struct scree_memory *memory, uint32_t vertex_capacity, uint32_t triangle_capacity,
                                struct surface *surface, struct scree_error *error);
void surface_rectangle(struct surface *surface, int32_t columns, int32_t rows, bool rising);
void surface_release(struct scree_memory *memory, struct surface *surface);

/* Room for more, if it lacks; fine on a zeroed surface. False: no memory, with a line. */
bool surface_reserve(struct scree_memory *memory, uint32_t vertex_capacity, uint32_t triangle_capacity,
                     struct surface *surface, struct scree_error *error);

/* Puts vertex number vertex_count, which the caller has set, into the cavity. Fix-ups are appended to `splits` when it
 * is not NULL; it must have room for 3 * cavity->triangle_count of them, one split, and the new triangles. */
void surface_insert(struct surface *surface, struct cavity *cavity, struct progressive *splits);

#endif
