/* Heights of posts against a decoded tile as clients draw it: every post under the mesh, row by row. Pure.
 *
 *     height  post minus the mesh, the mesh's height being linear in longitude and latitude (or CRS x and y) in each
 *             triangle: what a client answers when it is asked for a height
 *     drawn   the same, but a triangle drawn on the globe is flat and sags below the curved surface: by q, where
 *             q = (E^2 + N^2) / 2R over the metres east and north of the triangle's centroid. Equal to `height` in the
 *             local profile
 *
 * Vertices stand at the posts that their codes name, as long as a tile spans no more steps than there are codes (the
 * format moves each by up to 1/65534 of a tile, which shows on cliffs only); beyond that, where the codes say. */
#ifndef SCREE_MESH_RESIDUAL_H
#define SCREE_MESH_RESIDUAL_H

#include "src/lattice.h"
#include "src/quantized_mesh_decode.h"
#include <scree/mesh.h>
#include <stdint.h>

#define RESIDUAL_BINS 3072

/* Sums over |residual|; add to a zeroed one. */
struct residual {
    double max_m;
    int64_t max_x, max_y; /* the post of max_m, in lattice steps */
    double sum_m, sum_squares_m2;
    uint64_t bins[RESIDUAL_BINS]; /* by size, 64 to an octave */
};

struct residuals {
    uint64_t posts;
    struct residual height, drawn;
};

/* A block of posts, row by row from the south; all of the lattice's finest posts. */
struct post_block {
    int64_t x, y; /* of the first post */
    int32_t columns, rows;
    const float *heights_m;
};

/* Adds the posts of the block that lie under the tile: those on its eastern and northern border only if
 * `with_east`, `with_north` (they belong to the neighbour otherwise). */
void residuals_add(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                   const struct post_block *block, bool with_east, bool with_north, struct residuals *residuals);

/* The same for a mesh of posts: positions are lattice steps from the tile's south-western corner. */
struct post_mesh {
    const struct scree_vertex *vertices;
    const uint32_t *corners; /* 3 a triangle */
    uint32_t triangle_count;
    double height_unit_m;
};
void residuals_add_posts(const struct lattice *lattice, struct tile_id id, const struct post_mesh *mesh,
                         const struct post_block *block, bool with_east, bool with_north, struct residuals *residuals);

/* ---- for measures at other places than posts ---- */

/* In lattice steps from the tile's south-western corner. */
struct residual_corner {
    double x, y, height_m;
};
/* Of all vertices: the posts that their codes name, or where the codes say. */
void residual_tile_places(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                          struct residual_corner *places);
void residual_mesh_corners(const struct post_mesh *mesh, uint32_t triangle, struct residual_corner corners[3]);

/* Books a difference at a place in lattice steps. */
void residual_add(struct residual *residual, double difference_m, int64_t x, int64_t y);

/* ---- figures ---- */

double residual_mean_m(const struct residual *residual, uint64_t posts);
double residual_rms_m(const struct residual *residual, uint64_t posts);

/* The size that `share` (0..1) of all residuals do not pass, rounded up by at most 1.6 %. */
double residual_quantile_m(const struct residual *residual, uint64_t posts, double share);

#endif
