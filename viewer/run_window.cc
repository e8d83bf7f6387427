// The window: the loop of frames, and what keys ask of it.
#include "viewer/session.h"

namespace {

const double NOTE_S = 2;            // how long a note stays
const double RECORD_EVERY_S = 0.25; // between two places of a recorded flight
const double FIGURES_EVERY_S = 0.5; // frames a second are counted for so long
const double PLAY_S = 20;           // base to finest and back, when only a key asks for it

class WindowLoop {
  public:
    explicit WindowLoop(Session *session)
        : session(session), recorded(session->stage.terrain->world().knows_longitudes()) {}
    bool run(std::string *error);

  private:
    void step();
    const osg::Matrixd *fly(osg::Matrixd *camera);
    void play();
    void record();
    void toggle_playing();
    bool keep_recording(std::string *error);
    void take_picture();
    void say(const std::string &note) {
        session->stage.keys->note = note;
        session->stage.keys->note_time_s = session->stage.time_of_events_s();
    }

    Session *session;
    CameraPath recorded;
    bool is_recording = false, is_flying = false, is_playing = false;
    double begin_s = 0, flight_begin_s = 0, play_begin_s = 0, record_begin_s = 0;
    double manual_before_m = 0; // the scale by hand before it played
    double counted_since_s = 0, frames_per_s = 0;
    unsigned counted = 0;
};

const osg::Matrixd *WindowLoop::fly(osg::Matrixd *camera) {
    const CameraPath &path = session->flight.path;
    const double time_s = now_s() - flight_begin_s + (path.is_empty() ? 0 : path.begin_s());
    if (is_flying && time_s > path.end_s()) is_flying = false;
    if (!is_flying) return nullptr;
    *camera = camera_to_world(session->stage.terrain->world(), path.at(time_s));
    return camera;
}

void WindowLoop::toggle_playing() {
    TerrainSettings &settings = session->stage.terrain->settings();
    is_playing = !is_playing;
    if (!is_playing) {
        settings.manual_svo_m = manual_before_m;
        return;
    }
    manual_before_m = settings.manual_svo_m;
    if (!(session->flight.play_s > 0)) session->flight.play_s = PLAY_S;
    play_begin_s = now_s();
}

void WindowLoop::play() {
    if (is_playing && now_s() - play_begin_s > session->flight.play_s) toggle_playing();
    if (is_playing)
        session->stage.terrain->settings().manual_svo_m = session->flight.manual_svo_m(now_s() - play_begin_s);
}

void WindowLoop::record() {
    if (recorded.is_empty()) record_begin_s = now_s();
    const double time_s = now_s() - record_begin_s;
    if (!is_recording || (!recorded.is_empty() && time_s < recorded.end_s() + RECORD_EVERY_S)) return;
    recorded.add(time_s, place_of_camera(session->stage.terrain->world(), session->stage.camera_to_world()));
}

// What was recorded goes into the file that was asked for, or into one that is not there yet.
bool WindowLoop::keep_recording(std::string *error) {
    if (!is_recording || recorded.is_empty()) return true;
    const std::string &asked = session->arguments.record;
    const std::string path = asked.empty() ? free_name("flight", ".txt") : asked;
    const bool is_written = write_camera_path(path, recorded, error);
    say(is_written ? "written: " + path : *error);
    recorded = CameraPath(session->stage.terrain->world().knows_longitudes());
    is_recording = false;
    return is_written;
}

void WindowLoop::take_picture() {
    osg::Image *picture = session->stage.frame_end->picture();
    const std::string path = free_name("view", ".png");
    std::string error;
    say(write_png(*picture, path, &error) ? "written: " + path : error);
}

void WindowLoop::step() {
    Stage &stage = session->stage;
    KeyRequests &requests = stage.keys->requests;
    osg::Matrixd camera;
    play();
    const bool is_pictured = requests.wants_screenshot;
    if (is_pictured) stage.frame_end->want_picture();
    requests.wants_screenshot = false;
    const bool is_noted = stage.time_of_events_s() < stage.keys->note_time_s + NOTE_S;
    session->draw(now_s() - begin_s, fly(&camera),
                  hud_figures(stage.terrain->figures(), stage.terrain->settings(), frames_per_s, is_recording),
                  is_noted ? stage.keys->note : "");
    if (is_pictured) take_picture();
    record();
    if (requests.toggles_playing) toggle_playing();
    requests.toggles_playing = false;
    counted++;
    if (now_s() < counted_since_s + FIGURES_EVERY_S) return;
    frames_per_s = counted / (now_s() - counted_since_s);
    counted_since_s = now_s();
    counted = 0;
}

bool WindowLoop::run(std::string *error) {
    KeyRequests &requests = session->stage.keys->requests;
    begin_s = flight_begin_s = counted_since_s = now_s();
    is_recording = !session->arguments.record.empty();
    is_flying = !session->flight.path.is_empty();
    if (session->flight.play_s > 0) toggle_playing();
    while (!session->stage.is_done()) {
        step();
        if (!requests.toggles_recording) continue;
        requests.toggles_recording = false;
        if (is_recording) {
            std::string reason; // is on the screen; the window stays
            keep_recording(&reason);
        } else {
            is_recording = true;
        }
    }
    return keep_recording(error);
}

} // namespace

bool run_window(Session *session, std::string *error) {
    return WindowLoop(session).run(error);
}
