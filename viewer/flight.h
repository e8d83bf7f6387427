// What changes by itself while the viewer runs: the camera along a path, and the scale by hand.
#ifndef SCREE_VIEWER_FLIGHT_H
#define SCREE_VIEWER_FLIGHT_H

#include "viewer/camera_path.h"

#include <utility>

struct Flight {
    CameraPath path;                   // may be empty: the camera stays
    double play_s = 0;                 // above 0: the scale by hand plays for so long
    std::pair<double, double> range_m; // of the scale: the finest and the coarsest SVO

    double begin_s() const { return path.is_empty() || play_s > 0 ? 0 : path.begin_s(); }
    double end_s() const;

    // From the coarsest to the finest and back, by the same factor every second.
    double manual_svo_m(double time_s) const;
};

// Once around the middle of the terrain, from the overview down to a tenth of its distance and back, in `duration_s`.
CameraPath tour(const TerrainWorld &world, const osg::Matrixd &overview, double duration_s);

#endif
