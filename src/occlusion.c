/* Bounding sphere and horizon occlusion point (src/occlusion.h). */
#include "src/occlusion.h"

#include <math.h>

static void widen(double value, double *low, double *high) {
    if (value < *low) *low = value;
    if (value > *high) *high = value;
}

struct sphere bounding_sphere(const struct vector3 *points, uint32_t count, const struct east_north_up *frame) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        struct vector3 offset = vector3_minus(points[i], points[0]);
        widen(vector3_dot(offset, frame->east), &low[0], &high[0]);
        widen(vector3_dot(offset, frame->north), &low[1], &high[1]);
        widen(vector3_dot(offset, frame->up), &low[2], &high[2]);
    }
    struct sphere sphere = {.centre = points[0]};
    sphere.centre = vector3_plus_scaled(sphere.centre, (low[0] + high[0]) / 2, frame->east);
    sphere.centre = vector3_plus_scaled(sphere.centre, (low[1] + high[1]) / 2, frame->north);
    sphere.centre = vector3_plus_scaled(sphere.centre, (low[2] + high[2]) / 2, frame->up);
    double squared_m2 = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct vector3 offset = vector3_minus(points[i], sphere.centre);
        double distance_m2 = vector3_dot(offset, offset);
        if (distance_m2 > squared_m2) squared_m2 = distance_m2;
    }
    sphere.radius_m = sqrt(squared_m2) * (1 + 1e-9) + 1e-3;
    return sphere;
}

struct vector3 occlusion_scaled(struct vector3 point) {
    return (struct vector3){point.x * (1 / WGS84_MAJOR_M), point.y * (1 / WGS84_MAJOR_M),
                            point.z * (1 / WGS84_MINOR_M)};
}

/* How far out along the unit vector `direction` the plane that hides `point` behind the unit sphere reaches.
 *
 * With alpha the angle between the two, and beta that between the point and its horizon (cos beta = 1 / magnitude),
 * it is 1 / cos(alpha + beta); K. Ring, "Computing the horizon occlusion point" (cesium.com, 2013). */
static double occlusion_magnitude(struct vector3 point, struct vector3 direction) {
    double along = vector3_dot(point, direction);
    struct vector3 cross = {point.y * direction.z - point.z * direction.y,
                            point.z * direction.x - point.x * direction.z,
                            point.x * direction.y - point.y * direction.x};
    double across = sqrt(vector3_dot(cross, cross));
    double squared = vector3_dot(point, point);
    double scale = squared > 1 ? squared : sqrt(squared); /* below the ellipsoid the point is moved up to it */
    double horizon = squared > 1 ? sqrt(squared - 1) : 0;
    double divisor = along - across * horizon;
    return divisor * OCCLUSION_FAR > scale ? scale / divisor : OCCLUSION_FAR;
}

struct vector3 horizon_occlusion_point(const struct vector3 *points, uint32_t count, struct vector3 centre) {
    struct vector3 direction = occlusion_scaled(centre);
    double length = sqrt(vector3_dot(direction, direction));
    direction = (struct vector3){direction.x / length, direction.y / length, direction.z / length};
    double magnitude = 1;
    for (uint32_t i = 0; i < count; i++) {
        double reach = occlusion_magnitude(occlusion_scaled(points[i]), direction);
        if (reach > magnitude) magnitude = reach;
    }
    return (struct vector3){magnitude * direction.x, magnitude * direction.y, magnitude * direction.z};
}
