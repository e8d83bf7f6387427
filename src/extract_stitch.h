/* Tiles of different scales in one mesh made to meet: where one side of a tile's border has vertices that the other
 * lacks, the triangle of the coarser side becomes a fan over them. Pure.
 *
 * Borders at a coarser rung are subsets of those at a finer one, so an edge of the coarser side faces a chain of edges
 * of the finer side between the same two vertices. */
#ifndef SCREE_EXTRACT_STITCH_H
#define SCREE_EXTRACT_STITCH_H

#include "src/extract_mesh.h"
#include "stream/memory.h"
#include <scree/error.h>

/* For a mesh of posts that is put together; `stitched` is the number of edges that became fans. Edges that are open
 * after it are the outer border of the mesh. */
enum scree_status extract_mesh_stitch(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t *stitched,
                                      struct scree_error *error);

#endif
