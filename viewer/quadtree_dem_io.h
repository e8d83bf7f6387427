// A raster's own pixels as posts for a quadtree, read with GDAL.
#ifndef SCREE_VIEWER_QUADTREE_DEM_IO_H
#define SCREE_VIEWER_QUADTREE_DEM_IO_H

#include <string>
#include <vector>

struct QuadtreeDem {
    int columns = 0, rows = 0;
    std::vector<float> heights_m;        // row by row from the south, west to east
    double west = 0, south = 0;          // of the south-western post, in units of the CRS
    double spacing_x = 0, spacing_y = 0; // from post to post, in the same
    double metres_x = 0, metres_y = 0;   // and in metres; of angles, those at the raster's middle
    double lowest_m = 0, highest_m = 0;
    std::string crs_wkt; // "": not known
};

// Voids are interpolated over up to 100 posts; what is left of them lies as low as the lowest post. False, and one line
// in `error`, when it is no raster of heights with rows from west to east, or too large for a quadtree.
bool quadtree_dem_read(const std::string &path, QuadtreeDem *dem, std::string *error);

#endif
