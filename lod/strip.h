/* Strips a mesh of a rectangle down to two triangles, layer by layer, without regard to error. Pure. */
#ifndef SCREE_LOD_STRIP_H
#define SCREE_LOD_STRIP_H

#include "lod/simplify.h"

/* Removes one layer: vertices of which no two are neighbours, about a quarter of all; never a corner of the rectangle.
 * `taken`, one a vertex slot, is scratch. The observer's `remove`
 * is called before each removal. Holes are filled by ears of good shape. Returns how many were removed; 0 only when
 * nothing but the corners is left. */
int32_t strip_layer(struct mesh *mesh, unsigned char *taken, const struct simplify_observer *observer);

/* Removes the vertex of a star, which is no corner of the rectangle, and fills the hole by ears of good shape. The star
 * is used up. */
void strip_vertex(struct mesh *mesh, struct star *star);

#endif
