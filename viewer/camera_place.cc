#include "viewer/camera_place.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <osg/Math>
#include <vector>

namespace {

osg::Vec3d row(const osg::Matrixd &matrix, int index) {
    return osg::Vec3d(matrix(index, 0), matrix(index, 1), matrix(index, 2));
}

// Camera axes in a frame of east, north and up.
osg::Matrixd turned(double heading_deg, double pitch_deg) {
    const double heading = osg::DegreesToRadians(heading_deg), pitch = osg::DegreesToRadians(pitch_deg);
    const double sh = sin(heading), ch = cos(heading), sp = sin(pitch), cp = cos(pitch);
    return osg::Matrixd(ch, -sh, 0, 0,              // to the right
                        -sh * sp, -ch * sp, cp, 0,  // up
                        -sh * cp, -ch * cp, -sp, 0, // backwards
                        0, 0, 0, 1);
}

// A place of the bounds' own coordinates: degrees, or units of the CRS, of which the world has metres.
osg::Vec3d place_in_bounds(const TerrainWorld &world, double x, double y, double height_m) {
    if (world.is_geodetic()) return world.place(x, y, height_m);
    const double *bounds = world.bounds();
    const double middle_x = (bounds[0] + bounds[2]) / 2, middle_y = (bounds[1] + bounds[3]) / 2;
    const osg::Vec3d middle = world.middle();
    const double unit_x = middle_x != 0 ? middle.x() / middle_x : 1, unit_y = middle_y != 0 ? middle.y() / middle_y : 1;
    return osg::Vec3d(x * (middle_x != 0 ? unit_x : unit_y), y * (middle_y != 0 ? unit_y : unit_x), height_m);
}

// A grid over the data, at their lowest and highest heights.
std::vector<osg::Vec3d> hull_of_data(const TerrainWorld &world) {
    const int steps = 16;
    const double *bounds = world.bounds();
    std::vector<osg::Vec3d> places;
    for (int j = 0; j <= steps; j++)
        for (int i = 0; i <= steps; i++)
            for (double height_m : {world.lowest_m(), world.highest_m()})
                places.push_back(place_in_bounds(world, bounds[0] + (bounds[2] - bounds[0]) * i / steps,
                                                 bounds[1] + (bounds[3] - bounds[1]) * j / steps, height_m));
    return places;
}

// Where along one axis of the picture a camera must be, and how far back, to see places whose offsets from it are
// between the two slopes times their depth.
struct Fit {
    double slope, low, high; // the largest of offset - slope * depth and of -offset - slope * depth
    explicit Fit(double slope)
        : slope(slope), low(-std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity()) {}
    void add(double offset, double depth) {
        high = std::max(high, offset - slope * depth);
        low = std::max(low, -offset - slope * depth);
    }
    double back() const { return (high + low) / (2 * slope); }
    double middle() const { return (high - low) / 2; }
};

} // namespace

osg::Vec3d middle_on_ground(const TerrainWorld &world) {
    const double *bounds = world.bounds();
    return place_in_bounds(world, (bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2,
                           (world.lowest_m() + world.highest_m()) / 2);
}

bool parse_camera_place(const std::string &text, CameraPlace *place) {
    double numbers[5];
    const char *at = text.c_str();
    for (int i = 0; i < 5; i++) {
        char *end;
        numbers[i] = strtod(at, &end);
        if (end == at || !std::isfinite(numbers[i]) || *end != (i < 4 ? ',' : '\0')) return false;
        at = end + 1;
    }
    if (fabs(numbers[4]) > 90) return false;
    *place = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
    return true;
}

osg::Matrixd camera_to_world(const TerrainWorld &world, const CameraPlace &place) {
    return turned(place.heading_deg, place.pitch_deg) *
           world.local_frame(world.place(place.lon_deg, place.lat_deg, place.height_m));
}

CameraPlace place_of_camera(const TerrainWorld &world, const osg::Matrixd &camera_to_world) {
    const osg::Vec3d eye = row(camera_to_world, 3);
    const osg::Vec3d lon_lat_height = world.lon_lat_height(eye);
    const osg::Matrixd frame = world.local_frame(eye);
    const osg::Vec3d east = row(frame, 0), north = row(frame, 1), up = row(frame, 2);
    const osg::Vec3d forward = -row(camera_to_world, 2);
    const double sine = std::max(-1.0, std::min(1.0, forward * up));
    // Straight up or down, the top of the picture tells the heading.
    const osg::Vec3d ahead = fabs(sine) < 0.9999 ? forward : row(camera_to_world, 1) * (sine < 0 ? 1.0 : -1.0);
    double heading_deg = osg::RadiansToDegrees(atan2(ahead * east, ahead * north));
    if (heading_deg < 0) heading_deg += 360;
    return {lon_lat_height.x(), lon_lat_height.y(), lon_lat_height.z(), heading_deg, osg::RadiansToDegrees(asin(sine))};
}

osg::Matrixd overview(const TerrainWorld &world, double field_of_view_deg, double width_by_height, bool orthogonal) {
    const double margin = 0.96, oblique_deg = -38;
    const double slope_y = margin * tan(osg::DegreesToRadians(field_of_view_deg) / 2);
    const double *bounds = world.bounds();
    const bool is_round = world.is_geodetic() && (bounds[2] - bounds[0] > 45 || bounds[3] - bounds[1] > 45);
    osg::Matrixd camera = turned(0, is_round ? -90 : oblique_deg) * world.local_frame(middle_on_ground(world));
    const osg::Matrixd to_camera = osg::Matrixd::inverse(camera);
    Fit across(slope_y * width_by_height), upwards(slope_y);
    for (const osg::Vec3d &place : hull_of_data(world)) {
        const osg::Vec3d seen = place * to_camera;
        const double depth = orthogonal ? 0 : -seen.z();
        across.add(seen.x(), depth);
        upwards.add(seen.y(), depth);
    }
    const double back = std::max(std::max(across.back(), upwards.back()), 1.0);
    return osg::Matrixd::translate(across.middle(), upwards.middle(), back) * camera;
}

double depth_of_view(const TerrainWorld &world, const osg::Matrixd &camera_to_world) {
    const osg::Vec3d eye = row(camera_to_world, 3), forward = -row(camera_to_world, 2);
    const double height_m = (world.lowest_m() + world.highest_m()) / 2;
    const double aside = std::max(fabs((middle_on_ground(world) - eye) * forward), 1.0);
    if (!world.is_geodetic()) {
        const double depth = (height_m - eye.z()) / forward.z();
        return depth > 1 && depth < 100 * aside ? depth : aside;
    }
    // The ellipsoid, raised to that height, as a ball: z is stretched.
    const osg::Vec3d equator = world.place(0, 0, height_m), pole = world.place(0, 90, height_m);
    const double stretch = equator.x() / pole.z();
    const osg::Vec3d from(eye.x(), eye.y(), eye.z() * stretch), along(forward.x(), forward.y(), forward.z() * stretch);
    const double a = along * along, b = from * along, c = from * from - equator.x() * equator.x();
    const double inside = b * b - a * c;
    const double depth = inside > 0 ? (-b - sqrt(inside)) / a : 0;
    return depth > 1 ? depth : aside;
}
