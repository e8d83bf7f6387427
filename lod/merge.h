/* Four meshes become one: the children of a tile, welded along the cross between them. Pure. */
#ifndef SCREE_LOD_MERGE_H
#define SCREE_LOD_MERGE_H

#include "lod/mesh.h"

/* Children in the order south-west, south-east, north-west, north-east; NULL where the window ends before the child.
 * `child_span` is the side of a child in lattice steps. Vertices on common borders become one; they must be the same
 * on both sides (SCREE_E_CORRUPT). The mesh is connected; heights in metres and triangle errors are left to the caller.
 */
enum scree_status mesh_merge(struct scree_memory *memory, const struct scree_mesh *const children[4],
                             int32_t child_span, struct mesh *mesh, struct scree_error *error);

#endif
