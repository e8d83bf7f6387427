// What scree-view was asked to do.
#ifndef SCREE_VIEWER_VIEW_ARGUMENTS_H
#define SCREE_VIEWER_VIEW_ARGUMENTS_H

#include "viewer/camera_place.h"
#include "viewer/terrain_settings.h"

#include <string>
#include <vector>

struct ViewArguments {
    bool help = false;
    std::string terrain;
    std::string quadtree; // a raster, shown instead of a terrain of streams
    bool has_threshold = false;
    double threshold = 1; // of its quadtree, at 64 posts from the observer
    TerrainOptions options;
    int width_px = 1280, height_px = 800;
    bool orthogonal = false, wireframe = false;
    bool has_background = false;
    unsigned background = 0; // 0xRRGGBB
    bool has_camera = false;
    CameraPlace camera;
    std::string screenshot;         // a PNG, then the program ends
    std::string fly, record;        // camera paths
    double play_s = 0;              // above 0: the manual scale from base to finest and back, in so many seconds
    bool benchmark = false;         // ends when the flight ends, and prints what it took
    unsigned frames = 0;            // above 0: the flight is spread evenly over so many
    std::string trace, tiles_trace; // CSV, a row a frame and a row a tile
    std::string pictures;           // a folder
    unsigned picture_every_frames = 10;

    bool is_off_screen() const { return benchmark || !screenshot.empty() || !pictures.empty(); }
};

// From the words behind the program's name. False, and one line in `error`: wrong usage.
bool parse_view_arguments(const std::vector<std::string> &words, ViewArguments *arguments, std::string *error);

// The options, for --help.
std::string view_options_help();

#endif
