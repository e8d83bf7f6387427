// What a flight took, frame by frame, and the sum of it.
#ifndef SCREE_VIEWER_FRAME_SUMMARY_H
#define SCREE_VIEWER_FRAME_SUMMARY_H

#include "viewer/camera_place.h"
#include "viewer/terrain_settings.h"

#include <string>
#include <vector>

struct Frame {
    double time_s;   // of the flight
    double frame_ms; // from its beginning to when all of it was drawn
    double manual_svo_m;
    CameraPlace camera;
    TerrainFigures figures;
};

// CPU time outside of drawing.
double outside_ms(const TerrainFigures &figures);

// Lines of text about all frames. `memory_bytes`: the most that the process had; 0: not known.
std::string frame_summary(const std::vector<Frame> &frames, uint64_t memory_bytes);

#endif
