/* The mesh of a method in position codes, as tiles are written: vertices anywhere in a tile become codes of 1/128 of a
 * cell, and triangles that this turns over are mended. Pure. */
#ifndef SCREE_LOD_METHOD_CODES_H
#define SCREE_LOD_METHOD_CODES_H

#include "lod/method.h"
#include <scree/mesh.h>

/* How a method's tile lies in the tile that is written. A method sees whole cells only; where the lattice ends within a
 * cell, its tile is `width` x `height` steps stretched to whole cells, border lines too. */
struct method_frame {
    int64_t span;                                /* lattice steps of POSITION_TOP codes */
    int32_t width, height;                       /* lattice steps that are covered */
    const struct border_line *lines[SIDE_COUNT]; /* unstretched; vertex for vertex those of the method's tile */
    double height_unit_m;
};

/* `coded` has positions in codes and heights in units; vertices on the border keep the codes of their places, so that
 * neighbours agree. Turned triangles are mended by flips of edges. Where that is not enough the tile's vertices are
 * triangulated anew (Delaunay), those that fall together left out. Release both arrays with scree_release. */
enum scree_status method_to_codes_new(struct scree_memory *memory, const struct method_tile *tile,
                                      const struct method_frame *frame, const struct method_mesh *mesh,
                                      struct scree_mesh *coded, struct scree_error *error);

/* The mesh as written, back in the method's tile: to be measured. Release with method_mesh_release. */
enum scree_status method_from_codes_new(struct scree_memory *memory, const struct method_tile *tile,
                                        const struct method_frame *frame, const struct scree_mesh *coded,
                                        struct method_mesh *mesh, struct scree_error *error);

#endif
