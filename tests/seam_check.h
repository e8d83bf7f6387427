/* Whether the triangles of many tiles make one surface without cracks: exactly, in the lattice of all tiles. */
#ifndef SCREE_TESTS_SEAM_CHECK_H
#define SCREE_TESTS_SEAM_CHECK_H

#include <scree/stitch.h>
#include <stddef.h>

struct seam_point {
    int64_t x, y;
    int32_t height;
};

struct seam_edge {
    struct seam_point from, to;
    int64_t steps_east; /* tells two ways around the globe apart */
};

/* A tile's rectangle, not turned around the globe. */
struct seam_tile {
    int64_t x, y;
    int32_t columns, rows;
};

/* Zero it, but for `period`. */
struct seam_check {
    int64_t period; /* columns around the globe, where x begins anew; 0: it does not */
    size_t edge_count, edge_room, tile_count, tile_room;
    struct seam_edge *edges;
    struct seam_tile *tiles;
    int64_t doubled_area;    /* of all triangles less that of all tiles, in lattice steps */
    uint32_t turned;         /* triangles of zero or negative area */
    uint32_t corners_beyond; /* outside of their tile */
};

/* Adds what a tile draws: its triangles but the replaced ones, and those of the stitch (NULL: no stitch). Its south-
 * western corner is at (x, y) of the lattice. Stops the test program when memory lacks. */
void seam_add(struct seam_check *check, const struct scree_stitch_tile *tile, uint32_t triangle_count,
              const struct scree_stitch *stitch, uint32_t first_vertex, int64_t x, int64_t y);

/* Cancels each edge with the one in the other direction, and counts those left that do not lie on the outline of the
 * tiles: 0 for a surface that is open nowhere else. Once only. */
size_t seam_cracks(struct seam_check *check);

void seam_free(struct seam_check *check);

#endif
