/* A surface of triangles between points with heights: what a TIN file holds, or a triangulated cloud. Pure.
 *
 * Positions and heights are in the units of the points' own coordinate system, as with clouds (lod/cloud.h). */
#ifndef SCREE_LOD_TIN_H
#define SCREE_LOD_TIN_H

#include "lod/cloud.h"

struct tin {
    struct scree_memory *memory; /* that pays for everything; set it, zero the rest */
    struct cloud_point *points;
    uint32_t *corners; /* three a triangle: numbers of points, counter-clockwise as seen from above */
    uint32_t point_count, triangle_count;
};

/* Fine on a zeroed struct. */
void tin_release(struct tin *tin);

/* Takes out the points that no triangle has as a corner; the others keep their order. `dropped` may be NULL. */
enum scree_status tin_drop_unused(struct tin *tin, uint32_t *dropped, struct scree_error *error);

/* What tin_mend found and put right. */
struct tin_mended {
    uint32_t welded;  /* points in the place of another one */
    uint32_t dropped; /* triangles without area, that were there twice, or that rounding has turned over */
    uint32_t turned;  /* triangles that had their corners clockwise */
    uint32_t unused;  /* points that no triangle has as a corner */
};

/* Makes one surface of triangles as they come from a file: points in one place become one, triangles without any area
 * and copies go, all are turned counter-clockwise, unused points go. What then is no surface over the plane is refused
 * by SCREE_E_CORRUPT, with a text that says what is wrong, at which coordinates, and what to do (--grid takes the
 * highest surface): an edge with more than two triangles, a vertical face, an overhang (triangles one above the other),
 * coordinates that are no numbers, corners that are no points; what is left then is only to be released. Holes are
 * fine, and parts that do not touch, or only touch.
 *
 * Positions are taken to be rounded as they look, to decimals, floats or doubles, and what rounding does to a surface
 * is no reason to refuse it: slivers that it has turned over, or made flat, go. Two million triangles take 1.5 s and,
 * at the peak, 100 bytes a triangle when each has points of its own. */
enum scree_status tin_mend(struct tin *tin, struct tin_mended *mended, struct scree_error *error);

/* The Delaunay triangulation of a cloud, into an empty TIN, which may share the cloud's memory; triangles with an edge
 * longer than `longest_edge` are left out, and slivers along the hull, at most half a per cent as high as they are
 * long. Of points in one place the lowest stays; points without triangles go. No triangle at all is refused by
 * SCREE_E_CORRUPT.
 *
 * The triangulation is exact, on positions rounded to 2^-24 of the longer side or finer; what has no area where the
 * points really are is left out. The result depends on the points alone: they are inserted along a Hilbert curve. Takes
 * about 130 bytes a point at its peak, those of the cloud included; the TIN keeps 48. */
enum scree_status tin_from_cloud(const struct cloud *cloud, double longest_edge, struct tin *tin,
                                 struct scree_error *error);

#endif
