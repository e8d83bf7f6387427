#include "stream/tile_box.h"

#include <math.h>

#define ROOT_DEG   180.0 /* side of a geodetic root tile */
#define TILE_CELLS 256   /* lattice steps of a tile of the finest zoom */
#define MARGIN_M   1e-3  /* for rounding, which is a millionth of it */
#define NEAREST_M  0.1   /* an eye is never closer to what it sees */

static struct tile_box local_box(const struct scree_terrain *terrain, const struct scree_tile_id *tile, double lowest_m,
                                 double highest_m) {
    double span = ldexp(TILE_CELLS, terrain->finest_zoom - tile->zoom);
    double west = tile->x * span, east = fmin(west + span, (double)terrain->columns);
    double south = tile->y * span, north = fmin(south + span, (double)terrain->rows);
    double origin_x_m = terrain->west * (terrain->metres_x / terrain->spacing_x);
    double origin_y_m = terrain->south * (terrain->metres_y / terrain->spacing_y);
    return (struct tile_box){
        .centre = {origin_x_m + (west + east) / 2 * terrain->metres_x,
                   origin_y_m + (south + north) / 2 * terrain->metres_y, (lowest_m + highest_m) / 2},
        .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        .half_m = {fabs((east - west) / 2 * terrain->metres_x), fabs((north - south) / 2 * terrain->metres_y),
                   (highest_m - lowest_m) / 2},
    };
}

/* Bounds of a number. */
struct span {
    double low, high;
};

static void widen(struct span *span, double value) {
    span->low = fmin(span->low, value);
    span->high = fmax(span->high, value);
}

/* Seen along its middle meridian, a place of the tile lies at (r k, z): r and z are those of its latitude and height, k
 * from cos(half its width) to 1 is the cosine of its longitude from the middle. North grows with the latitude and is
 * linear in height and k; up is greatest at the middle (where the normal is up) and least at an end. A tile lies in one
 * hemisphere, or is a root with its middle on the equator. */
static struct tile_box geodetic_box(const struct scree_tile_id *tile, double lowest_m, double highest_m) {
    double side_deg = ldexp(ROOT_DEG, -tile->zoom);
    double west_deg = -ROOT_DEG + tile->x * side_deg, south_deg = -ROOT_DEG / 2 + tile->y * side_deg;
    double sin_lon, cos_lon, sin_lat, cos_lat, sin_half, cos_half;
    sine_cosine_deg(west_deg + side_deg / 2, &sin_lon, &cos_lon);
    sine_cosine_deg(south_deg + side_deg / 2, &sin_lat, &cos_lat);
    sine_cosine_deg(side_deg / 2, &sin_half, &cos_half);
    struct east_north_up frame = ellipsoid_frame_of(sin_lon, cos_lon, sin_lat, cos_lat);
    struct vector3 top = ellipsoid_point((struct vector3){cos_lat, 0, sin_lat}, highest_m);
    struct span up, north = {INFINITY, -INFINITY};
    double widest_m = tile->zoom == 0 ? WGS84_MAJOR_M + highest_m : 0;
    up.low = up.high = cos_lat * top.x + sin_lat * top.z;
    for (int end = 0; end < 2; end++) {
        struct vector3 normal = {0, 0, 0};
        sine_cosine_deg(south_deg + end * side_deg, &normal.z, &normal.x);
        for (int i = 0; i < 4; i++) {
            struct vector3 place = ellipsoid_point(normal, i % 2 == 0 ? lowest_m : highest_m);
            double across_m = i < 2 ? place.x * cos_half : place.x;
            widen(&up, cos_lat * across_m + sin_lat * place.z);
            widen(&north, cos_lat * place.z - sin_lat * across_m);
            widest_m = fmax(widest_m, place.x);
        }
    }
    struct vector3 centre = {0, 0, 0};
    centre = vector3_plus_scaled(centre, (up.low + up.high) / 2, frame.up);
    centre = vector3_plus_scaled(centre, (north.low + north.high) / 2, frame.north);
    return (struct tile_box){
        .centre = centre,
        .axes = {frame.east, frame.north, frame.up},
        .half_m = {widest_m * sin_half, (north.high - north.low) / 2, (up.high - up.low) / 2},
    };
}

struct tile_box tile_box_of(const struct scree_terrain *terrain, const struct scree_tile_id *tile, double lowest_m,
                            double highest_m) {
    struct tile_box box = terrain->profile == SCREE_GEODETIC ? geodetic_box(tile, lowest_m, highest_m)
                                                             : local_box(terrain, tile, lowest_m, highest_m);
    for (int i = 0; i < 3; i++) box.half_m[i] += MARGIN_M;
    return box;
}

/* The least and the greatest value of x p[0] + y p[1] + z p[2] + p[3] over a box. */
static struct span range_over(const struct tile_box *box, const double plane[4]) {
    struct vector3 normal = {plane[0], plane[1], plane[2]};
    double middle = vector3_dot(normal, box->centre) + plane[3], reach = 0;
    for (int i = 0; i < 3; i++) reach += box->half_m[i] * fabs(vector3_dot(normal, box->axes[i]));
    return (struct span){middle - reach, middle + reach};
}

/* Whether the globe, lowered to the lowest of all heights, hides all corners of a box. What it hides from an eye is a
 * cone beyond a plane, and convex: it hides all of the box then. Along its axes the world is scaled so that the globe
 * is a ball. */
static bool is_below_horizon(const struct scree_terrain *terrain, const struct scree_view *view,
                             const struct tile_box *box) {
    const struct vector3 scale = {1 / WGS84_MAJOR_M, 1 / WGS84_MAJOR_M, 1 / WGS84_MINOR_M};
    struct vector3 eye = {view->eye[0] * scale.x, view->eye[1] * scale.y, view->eye[2] * scale.z};
    double radius = 1 + fmin(terrain->lowest_m, 0) / WGS84_MINOR_M;
    double beyond = vector3_dot(eye, eye) - radius * radius; /* square of the distance to the horizon */
    if (!(radius > 0) || !(beyond > 0)) return false;
    for (int corner = 0; corner < 8; corner++) {
        struct vector3 place = box->centre;
        for (int i = 0; i < 3; i++)
            place = vector3_plus_scaled(place, (corner >> i & 1) != 0 ? box->half_m[i] : -box->half_m[i], box->axes[i]);
        struct vector3 ray = {place.x * scale.x - eye.x, place.y * scale.y - eye.y, place.z * scale.z - eye.z};
        double down = -vector3_dot(ray, eye);
        if (down <= beyond || down * down <= beyond * vector3_dot(ray, ray)) return false;
    }
    return true;
}

static double distance_to(const struct tile_box *box, const double eye[3]) {
    struct vector3 from = vector3_minus((struct vector3){eye[0], eye[1], eye[2]}, box->centre);
    double square = 0;
    for (int i = 0; i < 3; i++) {
        double outside = fabs(vector3_dot(from, box->axes[i])) - box->half_m[i];
        if (outside > 0) square += outside * outside;
    }
    return sqrt(square);
}

/* The least cosine of the angle between the view's direction and a place of the box that is on the screen. */
static double least_cosine(const struct scree_view *view, const struct tile_box *box) {
    struct vector3 to = vector3_minus(box->centre, (struct vector3){view->eye[0], view->eye[1], view->eye[2]});
    struct vector3 direction = {view->direction[0], view->direction[1], view->direction[2]};
    double reach_m =
        sqrt(box->half_m[0] * box->half_m[0] + box->half_m[1] * box->half_m[1] + box->half_m[2] * box->half_m[2]);
    double far_m = sqrt(vector3_dot(to, to));
    if (far_m <= reach_m) return view->corner_cosine;
    double cosine = vector3_dot(to, direction) / far_m, sine = sqrt(fmax(1 - cosine * cosine, 0));
    double spread_sine = reach_m / far_m, spread_cosine = sqrt(1 - spread_sine * spread_sine);
    if (cosine <= -spread_cosine) return view->corner_cosine; /* all around the back */
    return fmax(cosine * spread_cosine - sine * spread_sine, view->corner_cosine);
}

/* From the axis of an orthogonal view. */
static double distance_from_axis(const struct scree_view *view, const struct tile_box *box) {
    double square = 0;
    for (int i = 0; i < 2; i++) {
        struct span side = range_over(box, view->axis[i]);
        double nearest = side.low > 0 ? side.low : side.high < 0 ? side.high : 0;
        square += nearest * nearest;
    }
    return sqrt(square);
}

struct tile_sight tile_sight_of(const struct scree_terrain *terrain, const struct scree_view *view,
                                const struct tile_box *box) {
    struct tile_sight sight = {.seen = true};
    bool all_around = view->plane_count == 0;
    double least_depth = range_over(box, view->depth).low, cosine = 1;
    for (uint32_t i = 0; i < view->plane_count && sight.seen; i++)
        if (range_over(box, view->planes[i]).high < 0) sight.seen = false;
    if (view->slope == 0) {
        sight.distance_m = distance_from_axis(view, box);
    } else {
        if (sight.seen && !all_around && terrain->profile == SCREE_GEODETIC)
            sight.seen = !is_below_horizon(terrain, view, box);
        if (!all_around) cosine = least_cosine(view, box);
        sight.distance_m = distance_to(box, view->eye);
        least_depth = fmax(least_depth, view->slope * fmax(sight.distance_m, NEAREST_M) * cosine);
    }
    sight.pixel_m = least_depth / view->pixels;
    sight.pixel_any_way_m = sight.pixel_m * cosine;
    return sight;
}
