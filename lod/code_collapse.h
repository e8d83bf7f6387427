/* Takes out of a mesh what position codes cannot tell apart, or turn over. Pure. */
#ifndef SCREE_LOD_CODE_COLLAPSE_H
#define SCREE_LOD_CODE_COLLAPSE_H

#include "lod/simplify.h"

/* Collapses vertices of triangles that have no positive area in the codes of the simplifier's options, whatever the
 * error. Returns how many such triangles are left (their corners are all on the border, or hold each other). */
int32_t code_collapse(struct simplifier *simplifier);

#endif
