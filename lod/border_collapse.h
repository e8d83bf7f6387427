/* Takes out of a mesh the border vertices that its border lines no longer keep. Pure. */
#ifndef SCREE_LOD_BORDER_COLLAPSE_H
#define SCREE_LOD_BORDER_COLLAPSE_H

#include "lod/border.h"
#include "lod/simplify.h"

/* Removes the border vertices that their lines do not keep. Each goes by a half-edge collapse along the border where
 * one is within the tolerance, else by the retriangulation of its star with the least error: edges at the vertex are
 * flipped until a collapse gives it. Border sets are law: where even that passes the tolerance it is done all the
 * same, and the mesh's errors say so. On the full grid that never happens: between the border and the next row there
 * are no other posts. SCREE_E_LIMIT when a star is larger than MESH_MAX_DEGREE. */
enum scree_status border_collapse(struct simplifier *simplifier, const struct border_line lines[SIDE_COUNT],
                                  int32_t columns, int32_t rows, float tolerance_m, struct scree_error *error);

#endif
