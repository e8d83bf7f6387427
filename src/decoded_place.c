#include "src/decoded_place.h"

#include <math.h>

#define RADIANS_PER_DEGREE 0.017453292519943295

struct vec3 place_ecef_m(double lon_deg, double lat_deg, double height_m) {
    double lon_rad = lon_deg * RADIANS_PER_DEGREE, lat_rad = lat_deg * RADIANS_PER_DEGREE;
    double a2 = WGS84_EQUATOR_M * WGS84_EQUATOR_M, b2 = WGS84_POLE_M * WGS84_POLE_M;
    double cosine = cos(lat_rad), sine = sin(lat_rad);
    double length = sqrt(a2 * cosine * cosine + b2 * sine * sine);
    double equatorial_m = (a2 / length + height_m) * cosine;
    return (struct vec3){equatorial_m * cos(lon_rad), equatorial_m * sin(lon_rad), (b2 / length + height_m) * sine};
}

struct horizon_frame place_horizon(double lon_deg, double lat_deg) {
    double lon_rad = lon_deg * RADIANS_PER_DEGREE, lat_rad = lat_deg * RADIANS_PER_DEGREE;
    double sin_lon = sin(lon_rad), cos_lon = cos(lon_rad), sin_lat = sin(lat_rad), cos_lat = cos(lat_rad);
    return (struct horizon_frame){
        .origin_m = place_ecef_m(lon_deg, lat_deg, 0),
        .east = {-sin_lon, cos_lon, 0},
        .north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
        .up = {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat},
    };
}

struct vec3 place_in_horizon_m(const struct horizon_frame *frame, struct vec3 ecef_m) {
    struct vec3 offset = vec3_minus(ecef_m, frame->origin_m);
    return (struct vec3){vec3_dot(offset, frame->east), vec3_dot(offset, frame->north), vec3_dot(offset, frame->up)};
}

struct vec3 place_vertex(enum profile profile, const double bounds[4], const struct decoded_tile *tile,
                         uint32_t vertex) {
    double x = place_x(bounds, tile->u[vertex]), y = place_y(bounds, tile->v[vertex]);
    double height_m = decoded_height_m(tile, vertex);
    if (profile == PROFILE_GEODETIC) return place_ecef_m(x, y, height_m);
    return (struct vec3){x, y, height_m};
}
