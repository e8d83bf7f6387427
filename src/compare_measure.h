/* A tile that methods are compared on, and the measuring of what they made of it. Pure.
 *
 * Distances are taken in space: earth-centred coordinates, seen from the tile's middle (x east, y north, z up); in the
 * local profile metres of the raster's own plane with heights above it. The posts are a surface too: every cell is two
 * triangles, as in the papers, and border vertices that lie between posts, which every method is given, belong to it.
 */
#ifndef SCREE_COMPARE_MEASURE_H
#define SCREE_COMPARE_MEASURE_H

#include "lod/method.h"
#include "src/compare_report.h"

struct compare_subject {
    const struct lattice *lattice;
    struct tile_id id;
    const struct method_tile *tile;
    struct method_mesh grid; /* the posts, row by row, then border vertices between them */
    struct vector3 *grid_m;  /* where its vertices are */
    struct hausdorff_options sampling;
    struct hausdorff_surface posts;
};

/* Prepares the posts of a tile, which is not copied. `seed`: of the scattered sample points. On failure nothing is left
 * to release. */
enum scree_status compare_subject_make(struct scree_memory *memory, const struct lattice *lattice, struct tile_id id,
                                       const struct method_tile *tile, uint64_t seed, struct compare_subject *subject,
                                       struct scree_error *error);

/* Fine on a zeroed one, and twice. */
void compare_subject_release(struct scree_memory *memory, struct compare_subject *subject);

/* Where the vertices of a mesh of this tile are in space; belongs to `memory`. NULL: no memory. */
struct vector3 *compare_places_new(struct scree_memory *memory, const struct lattice *lattice, struct tile_id id,
                                   const struct method_mesh *mesh, struct scree_error *error);

/* Everything about a mesh but its run time, its main option and its bytes, which stay as they are. SCREE_E_CORRUPT when
 * it is no triangulation of the tile: a fault of the method. */
enum scree_status compare_measure(struct scree_memory *memory, struct compare_subject *subject,
                                  const struct method_mesh *mesh, struct compare_figures *figures,
                                  struct scree_error *error);

#endif
