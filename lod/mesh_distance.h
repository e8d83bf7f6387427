/* A triangle mesh in space, and how far a point is from it. Pure.
 *
 * Distances are exact to rounding: to the nearest point of any triangle, its edges and corners included. The triangles
 * are filed in a uniform grid over x and y, and a search goes outwards from the point's cell until nothing farther out
 * can be nearer. That is right for every mesh, and fast for those that are spread over the x-y plane, as terrain is. */
#ifndef SCREE_LOD_MESH_DISTANCE_H
#define SCREE_LOD_MESH_DISTANCE_H

#include "stream/ellipsoid.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

struct space_mesh {
    uint32_t vertex_count, triangle_count;
    const struct vector3 *vertices_m;
    const uint32_t *corners; /* 3 a triangle */
};

/* SCREE_E_ARGUMENT: no triangle, a corner that names no vertex, or a coordinate that is not finite. */
enum scree_status space_mesh_check(const struct space_mesh *mesh, struct scree_error *error);

struct distance_index {
    struct space_mesh mesh; /* its arrays are the caller's */
    double x_m, y_m;        /* of the grid's first corner */
    double cell_x_m, cell_y_m;
    uint32_t columns, rows;
    uint32_t *starts;    /* columns * rows + 1: where the triangles of a cell begin in `triangles` */
    uint32_t *triangles; /* those that reach into the cell, by number */
    uint32_t *asked;     /* a triangle: the last question that looked at it */
    uint32_t question;
};

/* Files the triangles of a surface, which must outlive the index. SCREE_E_ARGUMENT as space_mesh_check. On failure
 * nothing is left to release. */
enum scree_status distance_index_make(struct scree_memory *memory, const struct space_mesh *mesh,
                                      struct distance_index *index, struct scree_error *error);
void distance_index_release(struct scree_memory *memory, struct distance_index *index);

/* The distance in metres of a point, of finite coordinates, from the nearest triangle. */
double mesh_distance_m(struct distance_index *index, struct vector3 point);

/* The distance of a point from a single triangle, which may be a line or a point. */
double triangle_distance_m(struct vector3 point, struct vector3 a, struct vector3 b, struct vector3 c);

#endif
