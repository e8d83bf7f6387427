/* The mesh that an edge collapse of a method starts from: all posts inside of a tile, joined to the vertices of its
 * border lines. Pure.
 *
 * Positions are counted in units so fine that lines between posts and freely placed vertices are whole numbers too:
 * every test for a turned triangle is exact. Heights are less the drop of the ellipsoid below the plane that touches it
 * in the tile's middle, so that a flat triangle is what a globe draws. */
#ifndef SCREE_LOD_POST_GRID_H
#define SCREE_LOD_POST_GRID_H

#include "lod/mesh.h"
#include "lod/method.h"

#define POST_GRID_UNITS 4096 /* a cell, at least */

struct post_grid {
    const struct method_tile *tile;
    int32_t unit;               /* units a cell */
    double unit_steps;          /* lattice steps a unit: a power of two */
    int32_t inner_count;        /* vertices from here on are those of the ring, in its order */
    struct method_vertex *ring; /* see method_ring_new */
    uint32_t ring_count, corners[4];
    double *posts_m;  /* drawn heights of all posts: rows of columns + 1 */
    struct mesh mesh; /* positions in units, drawn heights */
};

/* A tile one cell wide has no posts inside: its mesh is a fan around a vertex in its middle. */
enum scree_status post_grid_make(struct scree_memory *memory, const struct method_tile *tile, struct post_grid *grid,
                                 struct scree_error *error);

/* Fine on a zeroed grid. */
void post_grid_release(struct scree_memory *memory, struct post_grid *grid);

/* The largest vertical distance of a post from the counter-clockwise triangle (a, b, c) among those that it covers, its
 * sides included; the look-out ends early once it is beyond `limit_m`. */
double post_grid_error_m(const struct post_grid *grid, const struct sample *a, const struct sample *b,
                         const struct sample *c, double limit_m);

/* The living part of the mesh, with true heights; border vertices are given back as the lines had them. */
enum scree_status post_grid_export(struct scree_memory *memory, const struct post_grid *grid, struct method_mesh *mesh,
                                   struct scree_error *error);

#endif
