/* The order in which a tile's triangles and vertices are written. Pure.
 *
 * Triangles follow each other in fans around neighbouring vertices, which suits a vertex cache (and gzip); vertices
 * are numbered as the triangles first use them, which keeps high-water-mark codes small. */
#ifndef SCREE_QUANTIZED_MESH_ORDER_H
#define SCREE_QUANTIZED_MESH_ORDER_H

#include "stream/memory.h"
#include <scree/error.h>

/* Reorders `triangle_count` counter-clockwise triangles over `vertex_count` vertices, every index below that count.
 * `ordered` receives 3 * triangle_count corners in the new numbering (triangles may come out rotated, never turned
 * over), `vertex_order` the old number of each new vertex. Returns how many vertices are in use through `used`;
 * vertices without a triangle are dropped. Takes time and memory linear in the mesh; the result depends on nothing
 * but the arguments. */
enum scree_status quantized_mesh_order(struct scree_memory *memory, const uint32_t *corners, uint32_t triangle_count,
                                       uint32_t vertex_count, uint32_t *ordered, uint32_t *vertex_order, uint32_t *used,
                                       struct scree_error *error);

#endif
