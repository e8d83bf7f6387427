// A run of scree-view: what it shows, and what it tells of its frames.
#ifndef SCREE_VIEWER_SESSION_H
#define SCREE_VIEWER_SESSION_H

#include "viewer/flight.h"
#include "viewer/frame_log_io.h"
#include "viewer/frame_summary.h"
#include "viewer/stage.h"

#include <string>
#include <vector>

struct Session {
    const ViewArguments &arguments;
    Stage stage;
    Flight flight;
    FrameLog log;
    std::vector<Frame> frames; // of a flight off screen
    size_t frame_count = 0;

    Session(osg::ref_ptr<TerrainNode> terrain, const ViewArguments &arguments)
        : arguments(arguments), stage(terrain, arguments) {}

    // Draws one and logs it. `camera` null: where the manipulator has it.
    Frame draw(double time_s, const osg::Matrixd *camera, const std::string &figures = "",
               const std::string &note = "");
};

// Each ends when it is done; false, and one line in `error`, when it failed.
bool run_screenshot(Session *session, std::string *error);
bool run_flight(Session *session, std::string *error);
bool run_window(Session *session, std::string *error);

#endif
