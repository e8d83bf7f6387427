// Where a camera stands and where it looks, in the words that people use.
#ifndef SCREE_VIEWER_CAMERA_PLACE_H
#define SCREE_VIEWER_CAMERA_PLACE_H

#include "viewer/terrain_world.h"

#include <osg/Matrixd>

struct CameraPlace {
    double lon_deg = 0, lat_deg = 0; // of a local CRS that is not known: its coordinates
    double height_m = 0;             // above what the terrain's heights are above
    double heading_deg = 0;          // from north, clockwise
    double pitch_deg = 0;            // below the horizon negative
};

// "lon,lat,height,heading,pitch" as numbers; false when it is something else, or the pitch is not within -90 .. 90.
bool parse_camera_place(const std::string &text, CameraPlace *place);

// What turns coordinates of the camera (x to the right, y up, z backwards) into those of the world: the inverse of the
// view matrix.
osg::Matrixd camera_to_world(const TerrainWorld &world, const CameraPlace &place);

// The other way round. A roll is lost.
CameraPlace place_of_camera(const TerrainWorld &world, const osg::Matrixd &camera_to_world);

// The middle of the data, at half of their heights.
osg::Vec3d middle_on_ground(const TerrainWorld &world);

// The whole terrain from the south, obliquely, as large as it can be without being cut; more than an eighth of the
// globe is seen from above. The picture spans `field_of_view_deg` from top to bottom; orthogonal: an orthogonal camera
// will draw it, at the metres a pixel of the terrain's middle.
osg::Matrixd overview(const TerrainWorld &world, double field_of_view_deg, double width_by_height, bool orthogonal);

// How far before the camera the terrain is: along the line of sight to where it meets the middle of all heights, or
// abreast of the terrain's middle when it meets nothing. Always above 0.
double depth_of_view(const TerrainWorld &world, const osg::Matrixd &camera_to_world);

#endif
