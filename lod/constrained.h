/* The constrained Delaunay triangulation of a rectangle: points, and edges between them that have to be there. Pure.
 *
 * Every edge that is no constraint is locally Delaunay, which makes the whole constrained Delaunay (Lawson's flips;
 * Chew, "Constrained Delaunay triangulations", 1989). Coordinates are whole numbers and both predicates are exact, so
 * no triangle is ever flat or turned over, and the same calls give the same triangulation everywhere. Of four points
 * on one circle either diagonal is right, and the order of the calls tells which one is there.
 *
 * Points come in one by one; points between two constraints of a line can leave again, by the rule of Dyken, Daehlen
 * and Sevaldrud, "Simultaneous curve simplification" (2009), under which no line ever crosses or touches another. */
#ifndef SCREE_LOD_CONSTRAINED_H
#define SCREE_LOD_CONSTRAINED_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

#define CONSTRAINED_NONE         UINT32_MAX
#define CONSTRAINED_LARGEST_SIDE (1 << 30) /* the in-circle test then stays below 2^124 */

struct constrained_point {
    int32_t x, y;
};

/* Edge k leads from corner k to corner k + 1, counter-clockwise. Half-edge 3 * t + k is edge k of triangle t. */
struct constrained_triangle {
    uint32_t corner[3]; /* corner[0] == CONSTRAINED_NONE: there is no such triangle (any more) */
    uint32_t twin[3];   /* the half-edge on the other side; CONSTRAINED_NONE on the border */
    uint8_t fixed;      /* bit k: edge k is a constraint */
    uint8_t pending;    /* bit k: half-edge k waits in `stack` */
};

struct constrained {
    struct scree_memory *memory;
    int32_t width, height;
    struct constrained_point *points; /* 0 to 3: the corners, counter-clockwise from the south-western one */
    uint32_t *leaving;                /* a half-edge that leaves the point; CONSTRAINED_NONE: the point has left */
    struct constrained_triangle *triangles;
    uint32_t *stack; /* half-edges that may not be Delaunay */
    uint32_t point_count, triangle_count, point_capacity, stack_count;
    uint32_t free_triangle; /* a chain through corner[1] */
    uint32_t hint;          /* a triangle to start the next search from */
};

/* A rectangle of two triangles; its border is a constraint. Sides from 1 to CONSTRAINED_LARGEST_SIDE. */
enum scree_status constrained_begin(struct scree_memory *memory, int32_t width, int32_t height,
                                    struct constrained *triangulation, struct scree_error *error);

/* Fine on a zeroed struct, and twice. */
void constrained_release(struct constrained *triangulation);

/* Adds a point of the closed rectangle, or finds the one that is there already; `*point` is its number. A constraint
 * that it lies on becomes two. */
enum scree_status constrained_insert(struct constrained *triangulation, int32_t x, int32_t y, uint32_t *point,
                                     struct scree_error *error);

/* Makes the segment between two different points a constraint; of points on the way it is made of pieces.
 * SCREE_E_ARGUMENT: it would cross another constraint; pieces up to that one stay. */
enum scree_status constrained_fix(struct constrained *triangulation, uint32_t from, uint32_t to,
                                  struct scree_error *error);

/* Takes a point p out and makes a-b a constraint in place of a-p and p-b. False, and nothing happens, unless p is off
 * the border, ends exactly two constraints, and the topology stays: no other point lies in or on the triangle a p b,
 * and a-b is no constraint yet. */
bool constrained_shortcut(struct constrained *triangulation, uint32_t point);

/* Whether a place inside of the rectangle is at least `clearance` away from the constraints around it: those of the
 * triangle that it is in, and of the triangles next to that one. */
bool constrained_is_clear(struct constrained *triangulation, int32_t x, int32_t y, double clearance);

/* Twice the area of a b c: exact, positive when counter-clockwise. */
static inline int64_t constrained_area2(struct constrained_point a, struct constrained_point b,
                                        struct constrained_point c) {
    return (int64_t)(b.x - a.x) * (c.y - a.y) - (int64_t)(b.y - a.y) * (c.x - a.x);
}

/* Whether d is strictly inside the circle through the counter-clockwise a, b, c: exact. */
bool constrained_in_circle(struct constrained_point a, struct constrained_point b, struct constrained_point c,
                           struct constrained_point d);

#endif
