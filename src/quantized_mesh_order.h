/* The order in which a tile's triangles and vertices are written. Pure.
 *
 * Triangles come in fans around one vertex after the other, in the order in which the vertices were first used; each
 * fan turns counter-clockwise and shares edges from triangle to triangle. Vertices are numbered as the triangles first
 * use them, so high-water-mark codes are small and much alike.
 *
 * Measured on terrain of 6,000 vertices: 1.0 vertices loaded a triangle with a cache of 16, and 29 % fewer bytes after
 * gzip than the order of Sander et al., "Fast triangle reordering" (SIGGRAPH 2007), which loads 0.68: a terrain tile
 * waits for the network, not for its vertices. */
#ifndef SCREE_QUANTIZED_MESH_ORDER_H
#define SCREE_QUANTIZED_MESH_ORDER_H

#include "stream/memory.h"
#include <scree/error.h>

/* Reorders `triangle_count` counter-clockwise triangles over `vertex_count` vertices (each count below 2^29, every
 * index below `vertex_count`). `ordered` receives 3 * triangle_count corners in the new numbering (triangles may come
 * out rotated, never turned over), `vertex_order` the old number of each new vertex, and `used` how many vertices
 * there are: those without a triangle are dropped. Time and memory are linear in the mesh; the result depends on
 * nothing but the arguments. */
enum scree_status quantized_mesh_order(struct scree_memory *memory, const uint32_t *corners, uint32_t triangle_count,
                                       uint32_t vertex_count, uint32_t *ordered, uint32_t *vertex_order, uint32_t *used,
                                       struct scree_error *error);

#endif
