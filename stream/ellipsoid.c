/* The WGS84 ellipsoid (stream/ellipsoid.h). */
#include "stream/ellipsoid.h"

#include <math.h>

#define RADIANS_PER_DEGREE 0.017453292519943295
#define WGS84_E2           6.6943799901413165e-3 /* f (2 - f), f = 1 / 298.257223563 */

/* Taylor's series, which on -45..45 degrees is exact to double precision after eight terms. */
static double sine_near_zero(double x) {
    double y = x * x;
    double sum = -1.0 / 1307674368000.0; /* 15! */
    sum = sum * y + 1.0 / 6227020800.0;  /* 13! */
    sum = sum * y - 1.0 / 39916800.0;    /* 11! */
    sum = sum * y + 1.0 / 362880.0;      /* 9! */
    sum = sum * y - 1.0 / 5040.0;        /* 7! */
    sum = sum * y + 1.0 / 120.0;         /* 5! */
    sum = sum * y - 1.0 / 6.0;           /* 3! */
    return x + x * y * sum;
}

static double cosine_near_zero(double x) {
    double y = x * x;
    double sum = 1.0 / 20922789888000.0; /* 16! */
    sum = sum * y - 1.0 / 87178291200.0; /* 14! */
    sum = sum * y + 1.0 / 479001600.0;   /* 12! */
    sum = sum * y - 1.0 / 3628800.0;     /* 10! */
    sum = sum * y + 1.0 / 40320.0;       /* 8! */
    sum = sum * y - 1.0 / 720.0;         /* 6! */
    sum = sum * y + 1.0 / 24.0;          /* 4! */
    return 1 - 0.5 * y + y * y * sum;
}

void sine_cosine_deg(double angle_deg, double *sine, double *cosine) {
    double quarters = angle_deg * (1.0 / 90);
    long quarter = (long)(quarters < 0 ? quarters - 0.5 : quarters + 0.5);
    double rest_rad = (angle_deg - 90.0 * (double)quarter) * RADIANS_PER_DEGREE;
    double s = sine_near_zero(rest_rad), c = cosine_near_zero(rest_rad);
    switch (quarter & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
}

struct east_north_up ellipsoid_frame_of(double sin_lon, double cos_lon, double sin_lat, double cos_lat) {
    return (struct east_north_up){
        .east = {-sin_lon, cos_lon, 0},
        .north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
        .up = {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat},
    };
}

struct east_north_up ellipsoid_frame(double lon_deg, double lat_deg) {
    double sin_lon, cos_lon, sin_lat, cos_lat;
    sine_cosine_deg(lon_deg, &sin_lon, &cos_lon);
    sine_cosine_deg(lat_deg, &sin_lat, &cos_lat);
    return ellipsoid_frame_of(sin_lon, cos_lon, sin_lat, cos_lat);
}

struct vector3 ellipsoid_point(struct vector3 up, double height_m) {
    double prime_vertical_m = WGS84_MAJOR_M / sqrt(1 - WGS84_E2 * up.z * up.z);
    double across_m = prime_vertical_m + height_m;
    return (struct vector3){across_m * up.x, across_m * up.y, (prime_vertical_m * (1 - WGS84_E2) + height_m) * up.z};
}

struct vector3 ellipsoid_normal(const struct east_north_up *frame, double slope_east, double slope_north) {
    struct vector3 normal = vector3_plus_scaled(frame->up, -slope_east, frame->east);
    normal = vector3_plus_scaled(normal, -slope_north, frame->north);
    double shrink = 1 / sqrt(1 + slope_east * slope_east + slope_north * slope_north);
    return (struct vector3){shrink * normal.x, shrink * normal.y, shrink * normal.z};
}
