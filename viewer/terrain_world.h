// Where a terrain lies: between longitude, latitude and height, and the coordinates that it is drawn in.
#ifndef SCREE_VIEWER_TERRAIN_WORLD_H
#define SCREE_VIEWER_TERRAIN_WORLD_H

#include <memory>
#include <osg/Matrixd>
#include <osg/Vec3d>
#include <scree/select.h>
#include <string>

class TerrainWorld {
  public:
    // crs_wkt: of the local profile; "" when it is not known: then longitude and latitude are coordinates of the CRS.
    // bounds: west, south, east, north of the data, degrees or CRS units.
    TerrainWorld(const scree_terrain &terrain, const std::string &crs_wkt, const double bounds[4]);
    ~TerrainWorld();

    bool is_geodetic() const;
    bool knows_longitudes() const; // false: a local CRS that is not known

    osg::Vec3d place(double lon_deg, double lat_deg, double height_m) const; // in the world
    osg::Vec3d lon_lat_height(const osg::Vec3d &place) const;                // degrees, degrees, metres

    // Axes to the east, north and up at a place, as the rows of a matrix whose last row is the place.
    osg::Matrixd local_frame(const osg::Vec3d &place) const;

    osg::Vec3d middle() const;                  // of the data, at half of their heights
    double radius_m() const;                    // of a ball about it that holds the data
    const double *bounds() const;               // of the data
    double lowest_m() const, highest_m() const; // of the data, as far as they are known
    void set_heights(double lowest_m, double highest_m);

  private:
    struct Inside;
    std::unique_ptr<Inside> inside;
};

#endif
