/* Where a decoded vertex is: degrees or CRS units in the plane, and metres in space. Pure; apart from the writer's
 * own geometry, so that verify does not repeat its mistakes. */
#ifndef SCREE_DECODED_PLACE_H
#define SCREE_DECODED_PLACE_H

#include "src/lattice.h"
#include "src/quantized_mesh_decode.h"

#define WGS84_EQUATOR_M 6378137.0
#define WGS84_POLE_M    6356752.3142451793

struct vec3 {
    double x, y, z;
};

static inline struct vec3 vec3_minus(struct vec3 a, struct vec3 b) {
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double vec3_dot(struct vec3 a, struct vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Earth-centred, earth-fixed metres of a place on or above the WGS84 ellipsoid. */
struct vec3 place_ecef_m(double lon_deg, double lat_deg, double height_m);

/* The three directions of the horizon at a place: east, north, up, as unit vectors in ECEF. */
struct horizon_frame {
    struct vec3 origin_m, east, north, up;
};
struct horizon_frame place_horizon(double lon_deg, double lat_deg);
struct vec3 place_in_horizon_m(const struct horizon_frame *frame, struct vec3 ecef_m);

/* The plane coordinate at a code of a tile with these bounds (west, south, east, north). */
static inline double place_x(const double bounds[4], uint32_t u) {
    return u == DECODED_TOP ? bounds[2] : bounds[0] + (bounds[2] - bounds[0]) * (u / (double)DECODED_TOP);
}

static inline double place_y(const double bounds[4], uint32_t v) {
    return v == DECODED_TOP ? bounds[3] : bounds[1] + (bounds[3] - bounds[1]) * (v / (double)DECODED_TOP);
}

/* A vertex in the space of the header's points: ECEF (geodetic), or CRS x, y and height (local). */
struct vec3 place_vertex(enum profile profile, const double bounds[4], const struct decoded_tile *tile,
                         uint32_t vertex);

#endif
