// scree-view: a terrain of streams on the screen, in pictures, and in figures. docs/osg.md tells how to use it.
#include "viewer/run_quadtree.h"
#include "viewer/session.h"

#include <cstdio>
#include <cstdlib>
#include <osg/Notify>

namespace {

enum { DONE, FAILED, USAGE };

const double TOUR_S = 60; // --benchmark without a flight of its own

void print_help() {
    printf("Usage: scree-view OUT|FILE [OPTION]...\n"
           "       scree-view --quadtree DEM [OPTION]...\n"
           "Shows a terrain that scree build wrote: OUT, OUT/stream, a scree.json or a single .scree file.\n\n%s\n"
           "Keys:\n%s\n"
           "Keys with --quadtree:\n%s\n"
           "A camera's longitude and latitude are in degrees (of a local CRS that is not known: its coordinates), its\n"
           "height is in metres above what the terrain's heights are above, its heading clockwise from north, its\n"
           "pitch negative below the horizon.\n\n"
           "Exit codes: 0 done, 1 failed (no terrain, no display, no OpenGL, output), 2 wrong usage.\n",
           view_options_help().c_str(), keys_help().c_str(), quadtree_keys_help().c_str());
}

bool plan_flight(Session *session, std::string *error) {
    const ViewArguments &arguments = session->arguments;
    const TerrainNode *terrain = session->stage.terrain.get();
    session->flight.path = CameraPath(terrain->world().knows_longitudes());
    session->flight.play_s = arguments.play_s;
    session->flight.range_m = terrain->svo_range_m();
    if (!arguments.fly.empty()) return read_camera_path(arguments.fly, &session->flight.path, error);
    if (arguments.benchmark && arguments.play_s == 0)
        session->flight.path = tour(terrain->world(), session->stage.home(), TOUR_S);
    return true;
}

bool run(const ViewArguments &arguments, std::string *error) {
    osg::ref_ptr<TerrainNode> terrain = TerrainNode::open(arguments.terrain, arguments.options, error);
    if (!terrain.valid()) return false;
    Session session(terrain, arguments);
    if (!plan_flight(&session, error) || !session.log.open(arguments.trace, arguments.tiles_trace, error) ||
        !session.stage.open(error))
        return false;
    const bool is_flight = arguments.is_off_screen() && arguments.screenshot.empty();
    const bool is_fine = is_flight                       ? run_flight(&session, error)
                         : !arguments.screenshot.empty() ? run_screenshot(&session, error)
                                                         : run_window(&session, error);
    if (!is_fine || !session.log.close(error)) return false;
    if (arguments.benchmark) fputs(frame_summary(session.frames, peak_memory_bytes()).c_str(), stdout);
    return true;
}

} // namespace

int main(int argc, char **argv) {
    ViewArguments arguments;
    std::string error;
    // Warnings of OpenSceneGraph are about its own affairs; who wants them sets its variable.
    if (getenv("OSG_NOTIFY_LEVEL") == nullptr) osg::setNotifyLevel(osg::FATAL);
    if (!parse_view_arguments(std::vector<std::string>(argv + 1, argv + argc), &arguments, &error)) {
        fprintf(stderr, "scree-view: %s; scree-view --help tells how\n", error.c_str());
        return USAGE;
    }
    int code = DONE;
    if (arguments.help) {
        print_help();
    } else if (!(arguments.quadtree.empty() ? run(arguments, &error) : run_quadtree(arguments, &error))) {
        fprintf(stderr, "scree-view: %s\n", error.c_str());
        code = FAILED;
    }
    if (fflush(stdout) != 0 && code == DONE) { // a full disk behind a redirection is a failure too
        perror("scree-view: writing to standard output");
        code = FAILED;
    }
    return code;
}
