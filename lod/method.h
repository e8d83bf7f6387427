/* The methods of the literature behind one narrow interface: posts and border sets in, a triangulation out. Pure.
 *
 * A method triangulates one tile at one scale and knows nothing of its neighbours: the vertices along the border are
 * given (lod/border.h), so tiles meet whatever method made them, in any order of work. Each method is a file of its own
 * with options of its own, in lod/method_<name>.h:
 *
 *     enum scree_status method_<name>(struct scree_memory *memory, const struct method_tile *tile,
 *                                     const struct method_<name>_options *options,
 *                                     struct method_mesh *mesh, struct scree_error *error);
 *
 * Rules for all of them: border vertices are exactly those of the lines, at their positions and heights, and no other
 * vertex lies on the border; the projection of the mesh onto the plane is a triangulation of the tile (every triangle
 * counter-clockwise and of positive area, no overlap, no gap); nothing is random but by a seed in the options; the
 * arrays belong to `memory` and are handed back with method_mesh_release; on failure the mesh is empty. */
#ifndef SCREE_LOD_METHOD_H
#define SCREE_LOD_METHOD_H

#include "lod/border.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

struct method_tile {
    int32_t columns, rows;  /* cells: (rows + 1) rows of (columns + 1) posts, from the south-western corner */
    int32_t cell_span;      /* lattice steps of a cell: 1 at the finest zoom, doubling with each coarser one */
    const float *heights_m; /* of post (0, 0); rows of `stride` floats */
    int32_t stride;
    const struct border_line *lines[SIDE_COUNT]; /* their vertices, corners included; positions in lattice steps */
    double east_m, north_m;                      /* metres of a lattice step, in the middle of the tile */
    double east_drop_m, north_drop_m; /* drop of the ellipsoid below the tangent plane over a lattice step, squared;
                                         0: the Earth is flat. A place in metres about the tile's middle is
                                         (x east_m, y north_m, height - x^2 east_drop_m - y^2 north_drop_m) */
};

struct method_vertex {
    double x, y; /* lattice steps from the tile's south-western corner; need not be a post's */
    double height_m;
};

struct method_mesh {
    uint32_t vertex_count, triangle_count;
    struct method_vertex *vertices;
    uint32_t *corners; /* 3 a triangle, counter-clockwise seen from above */
};

/* Fine on an empty mesh, and twice. */
void method_mesh_release(struct scree_memory *memory, struct method_mesh *mesh);

/* ---- what all methods need ---- */

static inline float method_post_m(const struct method_tile *tile, int32_t column, int32_t row) {
    return tile->heights_m[(int64_t)row * tile->stride + column];
}

/* Lattice steps that the tile covers. */
static inline int32_t method_width(const struct method_tile *tile) {
    return tile->columns * tile->cell_span;
}
static inline int32_t method_height(const struct method_tile *tile) {
    return tile->rows * tile->cell_span;
}

/* The drop of the ellipsoid at a place, below the tangent plane at the tile's middle. */
static inline double method_drop_m(const struct method_tile *tile, double x, double y) {
    double east = x - 0.5 * method_width(tile), north = y - 0.5 * method_height(tile);
    return east * east * tile->east_drop_m + north * north * tile->north_drop_m;
}

/* What every method may count on; SCREE_E_ARGUMENT tells what is wrong. At least one cell each way, spans up to 2^30
 * steps, finite heights, lines from corner to corner with growing positions that agree about the corners. */
enum scree_status method_tile_check(const struct method_tile *tile, struct scree_error *error);

/* The vertices of all four lines once, counter-clockwise from the south-western corner: `*ring` belongs to `memory`.
 * `corners`, if not NULL, gets the place in the ring of the south-western, south-eastern, north-eastern and
 * north-western one. */
enum scree_status method_ring_new(struct scree_memory *memory, const struct method_tile *tile,
                                  struct method_vertex **ring, uint32_t *count, uint32_t corners[4],
                                  struct scree_error *error);

#endif
