/* Slopes of the terrain at grid nodes, for normals that are continuous over tile borders. Pure.
 *
 * At the finest zoom slopes are central differences of the posts. A coarser grid is the 1-2-1 mean of the finer one;
 * on the border of a tile the mean is taken along the border only, of values that both of its tiles know. */
#ifndef SCREE_LOD_SLOPES_H
#define SCREE_LOD_SLOPES_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

struct slope {
    float east, north; /* dh/deast, dh/dnorth: metres a metre */
};

struct slope_grid {
    int32_t columns, rows; /* nodes */
    int32_t node_span;     /* lattice steps from node to node */
    struct slope *nodes;   /* row by row from the south */
};

enum scree_status slope_grid_allocate(struct scree_memory *memory, int32_t columns, int32_t rows, int32_t node_span,
                                      struct slope_grid *grid, struct scree_error *error);
void slope_grid_release(struct scree_memory *memory, struct slope_grid *grid);

/* Central differences. heights_m: post (0, 0) of rows of `stride` with a margin of one post; east_m, north_m: metres of
 * a step, one a row. */
void slope_grid_from_posts(struct slope_grid *grid, const float *heights_m, int32_t stride, const double *east_m,
                           const double *north_m);

/* Fills the coarser grid, of every second node of the finer one. */
void slope_grid_reduce(const struct slope_grid *fine, struct slope_grid *coarse);

/* Copies a child's grid into its parent's, at the node (column, row). */
void slope_grid_place(const struct slope_grid *child, int32_t column, int32_t row, struct slope_grid *grid);

/* The slope at a lattice position, linear between the nodes; beyond the last node that of the last. */
struct slope slope_grid_at(const struct slope_grid *grid, int32_t x, int32_t y);

/* The same between lattice positions. */
struct slope slope_grid_between(const struct slope_grid *grid, double x, double y);

#endif
