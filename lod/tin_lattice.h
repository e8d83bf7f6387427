/* A TIN on a lattice: positions are whole steps, triangles are sorted into the tiles that they touch. Pure. */
#ifndef SCREE_LOD_TIN_LATTICE_H
#define SCREE_LOD_TIN_LATTICE_H

#include "lod/slopes.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define TIN_LATTICE_MOST_STEPS (1 << 30) /* of a side */

struct tin_post {
    int32_t x, y; /* lattice steps from the frame's south-western corner */
    float height_m;
    struct slope slope; /* of the triangles around, weighted by their areas */
};

/* The frame is made of whole tiles, and holds all points with the wall around them. */
struct tin_lattice {
    struct scree_memory *memory; /* that pays for everything */
    struct tin_post *points;
    uint32_t *corners; /* three a triangle, counter-clockwise but for those that rounding has turned or flattened */
    uint32_t point_count, triangle_count;
    int32_t tile_span; /* steps of a tile's side */
    int32_t tiles_x, tiles_y;
    int32_t wall_steps;  /* outside of the surface, the ground falls to the height there over so many steps */
    uint32_t *first;     /* of each tile, row by row from the south, and one more: where its triangles begin in ... */
    uint32_t *triangles; /* ... the numbers of those whose bounding boxes, two walls wider, touch it; ascending */
};

/* Fine on a zeroed struct. */
void tin_lattice_release(struct tin_lattice *lattice);

/* Gives all points their slopes and sorts the triangles into tiles; points' places and heights, corners, counts, and
 * the tiles' numbers are set. East and north: metres of a step at each point's place, by a function of its row. */
enum scree_status tin_lattice_finish(struct tin_lattice *lattice,
                                     void (*steps_m)(const void *context, int32_t y, double *east_m, double *north_m),
                                     const void *context, struct scree_error *error);

#endif
