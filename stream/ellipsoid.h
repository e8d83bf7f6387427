/* The WGS84 ellipsoid: from longitude and latitude to earth-centred, earth-fixed coordinates (ECEF). Pure.
 *
 * Sines and cosines are our own, made of additions, multiplications and square roots only, so that a tile has the same
 * bytes whatever C library it was built with. Angles are degrees: quarter turns are exact. */
#ifndef SCREE_STREAM_ELLIPSOID_H
#define SCREE_STREAM_ELLIPSOID_H

#define WGS84_MAJOR_M 6378137.0
#define WGS84_MINOR_M 6356752.314245179 /* (1 - 1 / 298.257223563) of it */

struct vector3 {
    double x, y, z;
};

/* The directions east, north and up (the ellipsoid's normal) at a place: unit vectors in ECEF. */
struct east_north_up {
    struct vector3 east, north, up;
};

/* Sine and cosine of an angle of at most a million degrees either way, to about one part in 10^16. */
void sine_cosine_deg(double angle_deg, double *sine, double *cosine);

struct east_north_up ellipsoid_frame(double lon_deg, double lat_deg);

/* The same from sines and cosines that are known already. */
struct east_north_up ellipsoid_frame_of(double sin_lon, double cos_lon, double sin_lat, double cos_lat);

/* The point `height_m` above the ellipsoid (along its normal) at the place whose frame points up as `up`. */
struct vector3 ellipsoid_point(struct vector3 up, double height_m);

/* Unit normal in ECEF of a surface that rises by these slopes, metres a metre, to the east and to the north. */
struct vector3 ellipsoid_normal(const struct east_north_up *frame, double slope_east, double slope_north);

static inline double vector3_dot(struct vector3 a, struct vector3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector3 vector3_minus(struct vector3 a, struct vector3 b) {
    return (struct vector3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* a + factor * b */
static inline struct vector3 vector3_plus_scaled(struct vector3 a, double factor, struct vector3 b) {
    return (struct vector3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

#endif
