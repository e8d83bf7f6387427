// What a viewer asks of a terrain, and what the terrain tells of the frame before: plain structs.
#ifndef SCREE_VIEWER_TERRAIN_SETTINGS_H
#define SCREE_VIEWER_TERRAIN_SETTINGS_H

#include <cstdint>
#include <scree/select.h>
#include <string>

enum class TerrainColour {
    TINT,    // by height
    PLAIN,   // one colour
    TILE,    // one colour a tile
    RUNG,    // one colour a rung of the ladder
    TEXTURE, // the texture; tint where there is none
};

// May be changed between frames.
struct TerrainSettings {
    scree_measure measure = SCREE_BY_SVO;
    double tolerance_px = 1;
    double manual_svo_m = 0;      // above 0: every tile at the coarsest rung with at most this SVO, whatever the view
    bool is_frozen = false;       // the selection stays as it is
    double rungs_per_second = 24; // how fast scales may change; 0: at once
    bool morph = true;            // geomorphs; else rungs change at once
    bool stitch = true;           // tiles of different rungs meet without cracks
    bool contours = false;        // lines of equal height
    double contour_m = 0;         // from line to line; 0: chosen from the relief
    TerrainColour colour = TerrainColour::TINT;
    uint64_t triangle_budget = 0;              // 0: none
    uint64_t memory_bytes = (uint64_t)1 << 30; // of all tiles that are held, drawn or not
};

// When the terrain is opened.
struct TerrainOptions {
    TerrainSettings settings;
    unsigned loaders = 2; // threads that read and decode; 0: tiles are loaded in the frame that wants them
    int glsl = 120;       // or 330
    std::string texture;  // an image with georeference, any that GDAL reads; "": none
};

// Of the frame that was culled last.
struct TerrainFigures {
    uint32_t tiles_drawn = 0, tiles_held = 0, tiles_loading = 0;
    uint64_t triangles = 0, splits = 0;          // drawn; vertices that came or went since the frame before
    uint64_t bytes_loaded = 0;                   // of files, since the terrain was opened
    uint64_t bytes_held = 0;                     // memory of all tiles, those on the graphics card included
    uint64_t bytes_sent = 0;                     // to the graphics card for this frame
    int32_t coarsest_rung = 0, finest_rung = 0;  // drawn, of the ladder
    double coarsest_svo_m = 0, finest_svo_m = 0; // drawn
    double tolerance_px = 0;                     // what was asked for, or the larger one that a budget allows
    double select_ms = 0, seek_ms = 0, stitch_ms = 0, send_ms = 0; // CPU time of the frame outside of drawing
};

#endif
