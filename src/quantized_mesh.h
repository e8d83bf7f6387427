/* quantized-mesh-1.0: encoding. Pure: bytes in memory, no files.
 *
 * Facts kept (a client's point of view): never exactly 65,536 vertices; counter-clockwise triangles; high-water-mark
 * indices, triangles in an order that suits a vertex cache; edge lists with the corners; a bounding sphere around
 * every vertex; the horizon occlusion point along the direction of the tile's centre; heights as min + code * step
 * with step a power of two, so that neighbours decode a border to the very same heights; extensions: 1
 * (octvertexnormals) only.
 *
 * In the local profile the header's points are in the raster's CRS (metres for z) and the occlusion point is 0. */
#ifndef SCREE_QUANTIZED_MESH_H
#define SCREE_QUANTIZED_MESH_H

#include "src/terrain_tile.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stddef.h>

#define QUANTIZED_MESH_TOP 32767 /* the largest height code; positions: lod/position_code.h */

/* The bytes of a tile, uncompressed, in a new block of `memory`. SCREE_E_LIMIT when the relief does not fit 32767
 * border steps or when there are 65,536 vertices or more in a way that clients refuse. */
enum scree_status quantized_mesh_encode_new(struct scree_memory *memory, const struct terrain_tile *tile,
                                            unsigned char **bytes, size_t *size_bytes, struct scree_error *error);

#endif
