#include "viewer/flight.h"

#include <algorithm>
#include <cmath>
#include <osg/Math>

double Flight::end_s() const {
    return std::max(path.is_empty() ? 0 : path.end_s(), play_s);
}

double Flight::manual_svo_m(double time_s) const {
    const double part = std::max(0.0, std::min(1.0, time_s / play_s)), refined = 1 - fabs(2 * part - 1);
    return range_m.second * pow(range_m.first / range_m.second, refined);
}

CameraPath tour(const TerrainWorld &world, const osg::Matrixd &overview, double duration_s) {
    const int steps = 24;
    const osg::Vec3d eye = overview.getTrans(), middle = middle_on_ground(world);
    const osg::Matrixd frame = world.local_frame(middle);
    const double far_m = (eye - middle).length(), lowest_m = world.highest_m() + world.radius_m() / 50;
    CameraPath path(world.knows_longitudes());
    for (int i = 0; i <= steps; i++) {
        const double part = (double)i / steps, nearness = (1 - cos(2 * osg::PI * part)) / 2;
        const double heading = 2 * osg::PI * part, pitch = osg::DegreesToRadians(-40 + 20 * nearness);
        const double away_m = far_m * pow(0.1, nearness);
        const osg::Vec3d back(-sin(heading) * cos(pitch), -cos(heading) * cos(pitch), -sin(pitch));
        const osg::Vec3d place = world.lon_lat_height(back * away_m * frame);
        path.add(duration_s * part, {place.x(), place.y(), std::max(place.z(), lowest_m),
                                     osg::RadiansToDegrees(heading), osg::RadiansToDegrees(pitch)});
    }
    return path;
}
