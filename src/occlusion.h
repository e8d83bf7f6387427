/* What a client needs to skip a tile that cannot be seen: a sphere around it, and the point whose setting behind the
 * horizon hides the whole tile. Pure.
 *
 * Scaled space is ECEF with the axes divided by the ellipsoid's radii: the ellipsoid is the unit sphere there. */
#ifndef SCREE_OCCLUSION_H
#define SCREE_OCCLUSION_H

#include "stream/ellipsoid.h"
#include <stdint.h>

/* Where no finite point hides the tile (it reaches 90 degrees from its centre, or nearly), the point is this far out.
 */
#define OCCLUSION_FAR 1e6

struct sphere {
    struct vector3 centre;
    double radius_m;
};

/* A sphere that encloses all `count` points (at least 1): around the middle of their box along the axes of `frame`.
 * Its radius is checked against every point and then made a millimetre (and one part in 10^9) larger, for clients
 * that decode with other roundings. */
struct sphere bounding_sphere(const struct vector3 *points, uint32_t count, const struct east_north_up *frame);

/* ECEF to scaled space. */
struct vector3 occlusion_scaled(struct vector3 point);

/* The horizon occlusion point of `count` ECEF points, in scaled space, along the direction of `centre` (ECEF, the
 * tile's centre on the ellipsoid): where the ellipsoid hides it, the ellipsoid hides all the points. Points below the
 * ellipsoid count as if they lay on it. */
struct vector3 horizon_occlusion_point(const struct vector3 *points, uint32_t count, struct vector3 centre);

#endif
