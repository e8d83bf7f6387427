/* Unit vectors in two bytes: the octahedral projection (Cigolle et al., "A survey of efficient representations for
 * independent unit vectors", 2014), as the extension octvertexnormals of quantized-mesh-1.0 wants it. Pure. */
#ifndef SCREE_OCTAHEDRAL_H
#define SCREE_OCTAHEDRAL_H

#include "stream/ellipsoid.h"

/* `unit` must have a length of about 1. */
void octahedral_encode(struct vector3 unit, unsigned char code[2]);

#endif
