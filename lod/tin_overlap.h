/* Are there triangles one above the other? Pure.
 *
 * How many triangles lie over a place changes from place to place only where an edge with one triangle is crossed: with
 * all triangles counter-clockwise and at most two at an edge, one on each side, every other edge has as many on its
 * left as on its right. Beyond all of them there is none. So where two lie one above the other, they do so along the
 * inner side of some such edge, and looking there is enough. */
#ifndef SCREE_LOD_TIN_OVERLAP_H
#define SCREE_LOD_TIN_OVERLAP_H

#include "lod/tin.h"

/* Refuses by SCREE_E_CORRUPT, with the place and the heights.
 *   edges      edge_count half-edges that have no other on their other side: 3 * triangle + k leads from corner k on
 *   tolerance  of positions: what reaches no farther over an edge than this only touches it
 * Takes 28 bytes an edge. Triangles whose corners[0] is TIN_NONE are gone. */
enum scree_status tin_find_overlap(const struct tin *tin, const uint32_t *edges, uint32_t edge_count, double tolerance,
                                   struct scree_error *error);

#define TIN_NONE UINT32_MAX

#endif
