/* How far a triangulation is from the posts that it stands for: every post looked at, nothing sampled. Pure.
 *
 * This is the judge of all simplifiers, so it shares no code with any of them: barycentric weights in whole numbers,
 * one row of posts at a time. */
#ifndef SCREE_LOD_GRID_ERROR_H
#define SCREE_LOD_GRID_ERROR_H

#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>
#include <stdbool.h>

#define GRID_ERROR_MAX_POSTS 32768 /* a side */

struct grid_error {
    double max_m;              /* largest vertical distance between a post and the mesh */
    double rms_m, mean_m;      /* of the vertical distances, each covered post counted once */
    int32_t max_x, max_y;      /* the post of max_m (the first one, row by row within the triangles' order) */
    int64_t posts_covered;     /* posts that lie in a triangle of positive area, its border included */
    uint32_t flat_triangles;   /* zero area in the plane */
    uint32_t turned_triangles; /* negative area: clockwise */
    bool areas_add_up;         /* the triangles' signed areas sum to that of the rectangle */
    bool covers;               /* no flat or turned triangle, areas add up, every post covered */
};

/* Compares a mesh with the posts of a rectangle.
 *
 * heights_m: rows of `columns` heights, `stride` floats from row to row; 1 to GRID_ERROR_MAX_POSTS a side.
 * mesh: vertices at whole post positions within the rectangle; their `height` is not looked at.
 * vertex_heights_m: the height of every vertex; NULL: those of the posts where they stand.
 *
 * Where all heights are whole numbers below 2^22 each distance is rounded once, from its exact value. A mesh that
 * points outside of its arrays or of the rectangle is SCREE_E_ARGUMENT. */
enum scree_status grid_error_measure(const float *heights_m, int32_t columns, int32_t rows, int32_t stride,
                                     const struct scree_mesh *mesh, const double *vertex_heights_m,
                                     struct scree_memory *memory, struct grid_error *result, struct scree_error *error);

#endif
