/* Quadric errors in metric coordinates (Garland and Heckbert 1997), and the mean that tells a mesh's scale. Pure. */
#ifndef SCREE_LOD_QUADRIC_H
#define SCREE_LOD_QUADRIC_H

#include "lod/mesh.h"
#include "lod/samples.h"

/* MMQE: the mean over the vertices of the least quadric error over their edges (Ai et al. 2019, section 2.1). The
 * quadric of a vertex is the sum, over the triangles around it in the mesh as it is, of the squared distance to their
 * planes (their eq. 3); the error of an edge is that of its other end. So it measures, in square metres, how much the
 * next collapses would change: the smallest things that the mesh still shows. A step is east_m x north_m metres;
 * the samples tell the drop of the ellipsoid. */
double quadric_mmqe_m2(const struct mesh *mesh, const struct samples *samples, double east_m, double north_m);

#endif
