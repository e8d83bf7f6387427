/* A Delaunay triangulation of a rectangle that grows by one point at a time: Lawson's insertion with edge flips, on
 * whole coordinates with exact predicates. Pure.
 *
 * Half-edge 3 * t + k is edge k of triangle t and leads from its corner k to its corner k + 1. Points on the border of
 * the rectangle split it; all others lie inside. Of four points on a circle either diagonal is Delaunay: which one
 * stays follows from the order of insertion alone. */
#ifndef SCREE_LOD_DELAUNAY_H
#define SCREE_LOD_DELAUNAY_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

#define DELAUNAY_NONE        UINT32_MAX
#define DELAUNAY_NARROW_SIDE 8192      /* up to here 64 bits are enough: differences below 2^13, in-circle below 2^56 */
#define DELAUNAY_WIDEST_SIDE (1 << 30) /* up to here 128 bits are: below 2^124 */

struct delaunay_point {
    int32_t x, y;
};

struct delaunay_triangle {
    uint32_t corner[3]; /* counter-clockwise */
    uint32_t twin[3];   /* the half-edge on the other side; DELAUNAY_NONE on the border */
    uint32_t mark[2];   /* the caller's own; 0 in a new triangle */
};

struct delaunay {
    struct scree_memory *memory;
    struct delaunay_point *points;
    struct delaunay_triangle *triangles;
    uint32_t point_count, triangle_count, capacity; /* capacity: of points; triangles have room for twice as many */
    bool is_wide;
};

/* The rectangle from (0, 0) to (width, height), as two triangles; points 0..3 are its south-western, south-eastern,
 * north-western and north-eastern corner. 1 to DELAUNAY_WIDEST_SIDE a side. To be released in any case. */
enum scree_status delaunay_start(struct scree_memory *memory, int32_t width, int32_t height, struct delaunay *mesh,
                                 struct scree_error *error);
void delaunay_release(struct delaunay *mesh);

/* Room for so many points in all. */
enum scree_status delaunay_reserve(struct delaunay *mesh, uint32_t point_count, struct scree_error *error);

/* A triangle that a point of the rectangle lies in or on, walking from triangle `start`. */
uint32_t delaunay_find(const struct delaunay *mesh, uint32_t start, struct delaunay_point point);

/* Whether a point is a corner of the triangle. */
bool delaunay_is_corner(const struct delaunay *mesh, uint32_t triangle, struct delaunay_point point);

/* Inserts a point, for which there must be room, that lies in or on `triangle` and is none of its corners. The new
 * point is the last one. Returns a triangle at it: every triangle that is new or has changed has it as corner 2, and
 * delaunay_around leads from one to the next; where the point is on the border this is the first of them. */
uint32_t delaunay_insert(struct delaunay *mesh, uint32_t triangle, struct delaunay_point point);

/* The next triangle around corner 2, counter-clockwise; DELAUNAY_NONE behind the last one, which is before `first`. */
static inline uint32_t delaunay_around(const struct delaunay *mesh, uint32_t triangle, uint32_t first) {
    uint32_t twin = mesh->triangles[triangle].twin[1];
    return twin == DELAUNAY_NONE || twin / 3 == first ? DELAUNAY_NONE : twin / 3;
}

/* Twice the area of (a, b, p): positive when p is on the left of a -> b. Exact. */
static inline int64_t delaunay_area2(struct delaunay_point a, struct delaunay_point b, struct delaunay_point p) {
    return (int64_t)(b.x - a.x) * (p.y - a.y) - (int64_t)(b.y - a.y) * (p.x - a.x);
}

#endif
