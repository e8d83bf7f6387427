#include "viewer/terrain_world.h"

#include <cmath>
#include <memory>
#include <ogr_spatialref.h>
#include <osg/CoordinateSystemNode>

namespace {

osg::Vec3d geocentric(double lon_deg, double lat_deg, double height_m) {
    osg::Vec3d place;
    osg::EllipsoidModel().convertLatLongHeightToXYZ(osg::DegreesToRadians(lat_deg), osg::DegreesToRadians(lon_deg),
                                                    height_m, place.x(), place.y(), place.z());
    return place;
}

osg::Vec3d geodetic(const osg::Vec3d &place) {
    double lon, lat, height_m;
    osg::EllipsoidModel().convertXYZToLatLongHeight(place.x(), place.y(), place.z(), lat, lon, height_m);
    return osg::Vec3d(osg::RadiansToDegrees(lon), osg::RadiansToDegrees(lat), height_m);
}

struct TransformDeleter {
    void operator()(OGRCoordinateTransformation *transform) const { OGRCoordinateTransformation::DestroyCT(transform); }
};
using Transform = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

} // namespace

struct TerrainWorld::Inside {
    bool is_geodetic;
    double metres_x = 1, metres_y = 1; // of a CRS unit
    double bounds[4];
    double lowest_m = 0, highest_m = 0;
    Transform to_crs, from_crs; // longitude first; null: there is no CRS that is known
};

TerrainWorld::TerrainWorld(const scree_terrain &terrain, const std::string &crs_wkt, const double bounds[4])
    : inside(new Inside) {
    inside->is_geodetic = terrain.profile == SCREE_GEODETIC;
    for (int i = 0; i < 4; i++) inside->bounds[i] = bounds[i];
    if (inside->is_geodetic) return;
    inside->metres_x = terrain.metres_x / terrain.spacing_x;
    inside->metres_y = terrain.metres_y / terrain.spacing_y;
    OGRSpatialReference crs, globe;
    if (crs_wkt.empty() || crs.SetFromUserInput(crs_wkt.c_str()) != OGRERR_NONE) return;
    globe.importFromEPSG(4326);
    crs.StripVertical();
    for (OGRSpatialReference *one : {&crs, &globe}) one->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    inside->to_crs.reset(OGRCreateCoordinateTransformation(&globe, &crs));
    inside->from_crs.reset(OGRCreateCoordinateTransformation(&crs, &globe));
    if (inside->to_crs == nullptr || inside->from_crs == nullptr) inside->to_crs.reset(), inside->from_crs.reset();
}

TerrainWorld::~TerrainWorld() = default;

bool TerrainWorld::is_geodetic() const {
    return inside->is_geodetic;
}

bool TerrainWorld::knows_longitudes() const {
    return inside->is_geodetic || inside->to_crs != nullptr;
}

osg::Vec3d TerrainWorld::place(double lon_deg, double lat_deg, double height_m) const {
    if (inside->is_geodetic) return geocentric(lon_deg, lat_deg, height_m);
    double x = lon_deg, y = lat_deg;
    if (inside->to_crs != nullptr) inside->to_crs->Transform(1, &x, &y);
    return osg::Vec3d(x * inside->metres_x, y * inside->metres_y, height_m);
}

osg::Vec3d TerrainWorld::lon_lat_height(const osg::Vec3d &place) const {
    if (inside->is_geodetic) return geodetic(place);
    double x = place.x() / inside->metres_x, y = place.y() / inside->metres_y;
    if (inside->from_crs != nullptr) inside->from_crs->Transform(1, &x, &y);
    return osg::Vec3d(x, y, place.z());
}

osg::Matrixd TerrainWorld::local_frame(const osg::Vec3d &place) const {
    osg::Vec3d east(1, 0, 0), north(0, 1, 0), up(0, 0, 1);
    if (inside->is_geodetic) {
        osg::Vec3d at = geodetic(place);
        double lon = osg::DegreesToRadians(at.x()), lat = osg::DegreesToRadians(at.y());
        east.set(-std::sin(lon), std::cos(lon), 0);
        north.set(-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat));
        up.set(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
    }
    return osg::Matrixd(east.x(), east.y(), east.z(), 0, north.x(), north.y(), north.z(), 0, up.x(), up.y(), up.z(), 0,
                        place.x(), place.y(), place.z(), 1);
}

static osg::Vec3d at_share(const TerrainWorld &world, double share_x, double share_y, double height_m, double mx,
                           double my) {
    const double *bounds = world.bounds();
    double x = bounds[0] + share_x * (bounds[2] - bounds[0]), y = bounds[1] + share_y * (bounds[3] - bounds[1]);
    return world.is_geodetic() ? geocentric(x, y, height_m) : osg::Vec3d(x * mx, y * my, height_m);
}

// Of a part of the globe its middle on the ground; of a whole one that of the ball.
osg::Vec3d TerrainWorld::middle() const {
    bool is_globe = inside->is_geodetic && inside->bounds[2] - inside->bounds[0] >= 180;
    if (is_globe) return osg::Vec3d(0, 0, 0);
    double height_m = 0.5 * (inside->lowest_m + inside->highest_m);
    return at_share(*this, 0.5, 0.5, height_m, inside->metres_x, inside->metres_y);
}

double TerrainWorld::radius_m() const {
    double radius_m = 0;
    osg::Vec3d centre = middle();
    for (int i = 0; i <= 4; i++)
        for (int k = 0; k <= 4; k++)
            for (double height_m : {inside->lowest_m, inside->highest_m}) {
                osg::Vec3d corner = at_share(*this, 0.25 * i, 0.25 * k, height_m, inside->metres_x, inside->metres_y);
                radius_m = std::fmax(radius_m, (corner - centre).length());
            }
    return radius_m;
}

const double *TerrainWorld::bounds() const {
    return inside->bounds;
}

double TerrainWorld::lowest_m() const {
    return inside->lowest_m;
}

double TerrainWorld::highest_m() const {
    return inside->highest_m;
}

void TerrainWorld::set_heights(double lowest_m, double highest_m) {
    inside->lowest_m = lowest_m;
    inside->highest_m = highest_m;
}
