/* Heights of points against decoded tiles as clients draw them, as src/mesh_residual.h has them of posts: every point
 * of a TIN in the triangle that it lies in. Pure.
 *
 * A static tile may have more steps a side than codes. Then vertices stand at the points that their codes name, as they
 * do at posts; triangles with vertices that are no points, but at borders or the foot of a wall, count less what
 * half a code does to their heights: that is the format's doing, and on walls it is metres. */
#ifndef SCREE_SRC_POINT_RESIDUAL_H
#define SCREE_SRC_POINT_RESIDUAL_H

#include "lod/tin_lattice.h"
#include "src/mesh_residual.h"

/* Points sorted into square cells of a few each, and what was found at each of them under one mesh. */
struct residual_points {
    struct scree_memory *memory;
    const struct tin_post *points; /* not owned */
    uint32_t count;
    int64_t x, y;          /* of the points' (0, 0) on the lattice */
    int64_t cell;          /* steps of a cell's side */
    int32_t columns, rows; /* cells */
    uint32_t *first;       /* of each cell and one more, row by row: where it begins in `members` */
    uint32_t *members;     /* numbers of points */
    double *height_m;      /* point minus mesh, as in struct residuals */
    double *drawn_m;
    double *rank; /* what speaks for the triangle that it was measured in; -1: there is none yet */
};

/* Sorts points, which have to stay; their places are 0 or more. `points` is to be released in any case. */
enum scree_status residual_points_begin(struct scree_memory *memory, const struct tin_post *posts, uint32_t count,
                                        int64_t x, int64_t y, struct residual_points *points,
                                        struct scree_error *error);
void residual_points_release(struct residual_points *points);

/* Whether the closed window holds the place of a point, or may: one of its cells does. */
bool residual_points_touch(const struct residual_points *points, const struct lattice_window *window);

/* As residuals_add and residuals_add_posts, for all points that lie in the tile's closed window. */
enum scree_status residual_points_add(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                                      bool with_east, bool with_north, struct residual_points *points,
                                      struct residuals *residuals, struct scree_error *error);
void residual_points_add_mesh(const struct lattice *lattice, struct tile_id id, const struct post_mesh *mesh,
                              bool with_east, bool with_north, struct residual_points *points,
                              struct residuals *residuals);

#endif
