// Pictures and flights that nobody watches.
#include "viewer/session.h"

#include <algorithm>
#include <cstdio>

static const double PATIENCE_S = 120; // for a terrain that is still on its way
static const double QUIET_S = 1;      // nothing has come or changed for so long: a budget allows no more

Frame Session::draw(double time_s, const osg::Matrixd *camera, const std::string &figures, const std::string &note) {
    const TerrainNode *terrain = stage.terrain.get();
    Frame frame = {};
    const double begin_s = now_s();
    stage.draw(camera, figures, note);
    frame.frame_ms = 1e3 * (now_s() - begin_s);
    frame.time_s = time_s;
    frame.manual_svo_m = stage.terrain->settings().manual_svo_m;
    frame.camera = place_of_camera(terrain->world(), stage.camera_to_world());
    frame.figures = terrain->figures();
    log.add(frame_count++, frame, log.wants_tiles() ? terrain->tile_figures() : std::vector<TerrainTileFigures>());
    return frame;
}

// Draws until all that the view wants is there, or no more of it comes.
static bool settle(Session *session, const osg::Matrixd &camera, std::string *error) {
    const double begin_s = now_s();
    double changed_s = begin_s;
    uint64_t bytes_loaded = 0;
    for (int settled = 0; settled < 3 && now_s() < changed_s + QUIET_S;) {
        session->stage.draw(&camera, "", "");
        const TerrainFigures figures = session->stage.terrain->figures();
        settled = session->stage.terrain->is_settled() ? settled + 1 : 0;
        if (figures.tiles_loading > 0 || figures.splits > 0 || figures.bytes_loaded != bytes_loaded)
            changed_s = now_s();
        bytes_loaded = figures.bytes_loaded;
        if (now_s() < begin_s + PATIENCE_S) continue;
        *error = "the terrain did not arrive within " + std::to_string((int)PATIENCE_S) + " s";
        return false;
    }
    return true;
}

bool run_screenshot(Session *session, std::string *error) {
    const osg::Matrixd camera = session->stage.home();
    if (!settle(session, camera, error)) return false;
    session->stage.frame_end->want_picture();
    session->draw(0, &camera);
    return write_png(*session->stage.frame_end->picture(), session->arguments.screenshot, error);
}

// Where the flight is, its scale by hand set.
static osg::Matrixd fly_to(Session *session, double time_s) {
    const Flight &flight = session->flight;
    TerrainNode *terrain = session->stage.terrain.get();
    if (flight.play_s > 0) terrain->settings().manual_svo_m = flight.manual_svo_m(time_s);
    return flight.path.is_empty() ? session->stage.home() : camera_to_world(terrain->world(), flight.path.at(time_s));
}

bool run_flight(Session *session, std::string *error) {
    const ViewArguments &arguments = session->arguments;
    const Flight &flight = session->flight;
    const double duration_s = flight.end_s() - flight.begin_s();
    if (!arguments.pictures.empty() && !make_folder(arguments.pictures, error)) return false;
    if (!settle(session, fly_to(session, flight.begin_s()), error)) return false;
    const double begin_s = now_s();
    for (unsigned i = 0; arguments.frames == 0 || i < arguments.frames; i++) {
        const double passed_s =
            arguments.frames == 0 ? now_s() - begin_s : duration_s * i / std::max(arguments.frames - 1, 1u);
        if (passed_s > duration_s) break;
        const bool is_pictured = !arguments.pictures.empty() && i % arguments.picture_every_frames == 0;
        if (is_pictured) session->stage.frame_end->want_picture();
        const osg::Matrixd camera = fly_to(session, flight.begin_s() + passed_s);
        session->frames.push_back(session->draw(flight.begin_s() + passed_s, &camera));
        char name[32];
        snprintf(name, sizeof name, "/frame-%06u.png", i);
        if (is_pictured && !write_png(*session->stage.frame_end->picture(), arguments.pictures + name, error))
            return false;
    }
    return true;
}
