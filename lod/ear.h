/* Flips that take a vertex out of the way: every flip cuts a convex corner, an ear, off its star. Pure. */
#ifndef SCREE_LOD_EAR_H
#define SCREE_LOD_EAR_H

#include "lod/simplify.h"

/* Cuts off the ear that costs the least error, and measures what it leaves; `star` becomes the smaller star. False when
 * no ear can go. */
bool ear_cut(struct simplifier *simplifier, struct star *star);

/* Measures the triangles that the star's half-edges belong to, those still alive. */
void ear_measure(struct simplifier *simplifier, const struct star *star);

#endif
