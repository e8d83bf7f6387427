/* Closes the gaps that collapsed vertices and triangles have left, so that what lives lies together. Pure. */
#ifndef SCREE_LOD_COMPACT_H
#define SCREE_LOD_COMPACT_H

#include "lod/simplify.h"

/* Numbers change, the order does not: what is simplified afterwards is the same. Not while the mesh is observed.
 * SCREE_E_MEMORY: nothing has changed. */
enum scree_status simplifier_compact(struct simplifier *simplifier, struct scree_error *error);

#endif
