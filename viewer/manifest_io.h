// What a viewer has to know before it has read a tile: scree.json, or the header of a single tile.
#ifndef SCREE_VIEWER_MANIFEST_IO_H
#define SCREE_VIEWER_MANIFEST_IO_H

#include <scree/select.h>
#include <string>
#include <vector>

struct Manifest {
    scree_terrain terrain = {}; // its zooms are to be set: they are the vector below
    std::vector<scree_zoom_scale> zooms;
    std::vector<scree_tile_id> tiles; // those that scree.json says are there
    std::string crs_wkt;              // of the local profile; "" when it is not known
    double bounds[4] = {};            // west, south, east, north of the data: degrees or CRS units
    std::string folder;               // of the tiles, with its slash; "" when there is one file only:
    std::string single_file;

    std::string path_of(const scree_tile_id &id) const;
};

// OUT, OUT/stream, a scree.json or a .scree file, wherever GDAL's virtual file systems reach. False, and one line in
// `error`, when there is none.
bool manifest_read(const std::string &path, Manifest *manifest, std::string *error);

#endif
