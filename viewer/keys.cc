#include "viewer/keys.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <osg/PolygonMode>

namespace {

const char *on_off(bool is_on) {
    return is_on ? "on" : "off";
}

std::string number(const char *format, double value) {
    char text[64];
    snprintf(text, sizeof text, format, value);
    return text;
}

const char *colour_name(TerrainColour colour) {
    switch (colour) {
    case TerrainColour::TINT: return "by height";
    case TerrainColour::PLAIN: return "plain";
    case TerrainColour::TILE: return "by tile";
    case TerrainColour::RUNG: return "by rung";
    case TerrainColour::TEXTURE: return "texture";
    }
    return "";
}

} // namespace

// `press` returns what is to be read on the screen.
struct Keys::Key {
    int key;
    const char *name, *help;
    std::string (*press)(Keys *, TerrainSettings *);
};

const Keys::Key Keys::table[] = {
    {'h', "h", "this help",
     [](Keys *keys, TerrainSettings *) {
         keys->hud->show_help(!keys->hud->shows_help());
         return std::string();
     }},
    {'i', "i", "figures in the corner",
     [](Keys *keys, TerrainSettings *) {
         keys->hud->show_figures(!keys->hud->shows_figures());
         return std::string();
     }},
    {'w', "w", "wireframe",
     [](Keys *keys, TerrainSettings *) {
         keys->is_wireframe = !keys->is_wireframe;
         keys->switch_wireframe();
         return std::string("wireframe ") + on_off(keys->is_wireframe);
     }},
    {'c', "c", "the next colouring: height, plain, tile, rung, texture",
     [](Keys *keys, TerrainSettings *settings) {
         keys->colour_by((TerrainColour)(((int)settings->colour + 1) % 5));
         return std::string("colour: ") + colour_name(settings->colour);
     }},
    {'t', "t", "a colour a tile, and back",
     [](Keys *keys, TerrainSettings *settings) {
         keys->colour_by(TerrainColour::TILE);
         return std::string("colour: ") + colour_name(settings->colour);
     }},
    {'r', "r", "a colour a rung, and back",
     [](Keys *keys, TerrainSettings *settings) {
         keys->colour_by(TerrainColour::RUNG);
         return std::string("colour: ") + colour_name(settings->colour);
     }},
    {'l', "l", "contour lines",
     [](Keys *, TerrainSettings *settings) {
         settings->contours = !settings->contours;
         return std::string("contour lines ") + on_off(settings->contours);
     }},
    {'f', "f", "freeze the selection, to look at it from elsewhere",
     [](Keys *, TerrainSettings *settings) {
         settings->is_frozen = !settings->is_frozen;
         return std::string("frozen ") + on_off(settings->is_frozen);
     }},
    {'+', "+", "a larger tolerance: coarser",
     [](Keys *, TerrainSettings *settings) {
         settings->tolerance_px = std::min(settings->tolerance_px * sqrt(2), 1e4);
         return number("tolerance %.2f px", settings->tolerance_px);
     }},
    {'-', "-", "a smaller tolerance: finer",
     [](Keys *, TerrainSettings *settings) {
         settings->tolerance_px = std::max(settings->tolerance_px / sqrt(2), 1e-2);
         return number("tolerance %.2f px", settings->tolerance_px);
     }},
    {'e', "e", "the tolerance is of the SVO, or of the max error",
     [](Keys *, TerrainSettings *settings) {
         settings->measure = settings->measure == SCREE_BY_SVO ? SCREE_BY_MAX_ERROR : SCREE_BY_SVO;
         return std::string(settings->measure == SCREE_BY_SVO ? "by SVO" : "by max error");
     }},
    {'m', "m", "the scale by hand, and back to that of the view",
     [](Keys *keys, TerrainSettings *settings) {
         if (settings->manual_svo_m > 0) settings->manual_svo_m = 0;
         else
             keys->scale_by(1);
         return settings->manual_svo_m > 0 ? number("scale by hand: SVO %.3g m", settings->manual_svo_m)
                                           : std::string("scale by the view");
     }},
    {']', "]", "by hand: finer",
     [](Keys *keys, TerrainSettings *settings) {
         keys->scale_by(exp2(-1.0 / 16));
         return number("scale by hand: SVO %.3g m", settings->manual_svo_m);
     }},
    {'[', "[", "by hand: coarser",
     [](Keys *keys, TerrainSettings *settings) {
         keys->scale_by(exp2(1.0 / 16));
         return number("scale by hand: SVO %.3g m", settings->manual_svo_m);
     }},
    {'b', "b", "by hand: play from the base to the finest and back",
     [](Keys *keys, TerrainSettings *) {
         keys->requests.toggles_playing = true;
         return std::string();
     }},
    {'g', "g", "geomorphing",
     [](Keys *, TerrainSettings *settings) {
         settings->morph = !settings->morph;
         return std::string("geomorphing ") + on_off(settings->morph);
     }},
    {'s', "s", "stitching of tiles of different rungs",
     [](Keys *, TerrainSettings *settings) {
         settings->stitch = !settings->stitch;
         return std::string("stitching ") + on_off(settings->stitch);
     }},
    {'p', "p", "a picture into the current folder",
     [](Keys *keys, TerrainSettings *) {
         keys->requests.wants_screenshot = true;
         return std::string();
     }},
    {'o', "o", "record the flight, and write it",
     [](Keys *keys, TerrainSettings *) {
         keys->requests.toggles_recording = true;
         return std::string();
     }},
};

Keys::Keys(TerrainNode *terrain, osg::Group *scene, Hud *hud, bool is_wireframe)
    : terrain(terrain), scene(scene), hud(hud), is_wireframe(is_wireframe) {
    switch_wireframe();
}

void Keys::switch_wireframe() {
    const osg::PolygonMode::Mode mode = is_wireframe ? osg::PolygonMode::LINE : osg::PolygonMode::FILL;
    scene->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, mode));
}

void Keys::colour_by(TerrainColour colour) {
    TerrainSettings &settings = terrain->settings();
    const TerrainColour before = settings.colour;
    settings.colour = before == colour ? colour_before : colour;
    if (before != colour) colour_before = before;
}

// Of the scale that is shown now.
void Keys::scale_by(double factor) {
    TerrainSettings &settings = terrain->settings();
    const auto range_m = terrain->svo_range_m();
    const double shown_m = settings.manual_svo_m > 0 ? settings.manual_svo_m : terrain->figures().finest_svo_m;
    settings.manual_svo_m = std::max(range_m.first, std::min(range_m.second, shown_m * factor));
}

bool Keys::handle(const osgGA::GUIEventAdapter &event, osgGA::GUIActionAdapter &) {
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
    int pressed = event.getKey();
    if (pressed == osgGA::GUIEventAdapter::KEY_KP_Add || pressed == '=') pressed = '+';
    if (pressed == osgGA::GUIEventAdapter::KEY_KP_Subtract) pressed = '-';
    for (const Key &key : table) {
        if (key.key != pressed) continue;
        const std::string said = key.press(this, &terrain->settings());
        if (!said.empty()) {
            note = said;
            note_time_s = event.getTime();
        }
        return true;
    }
    return false;
}

std::string keys_help() {
    std::string help;
    for (const Keys::Key &key : Keys::table) help += std::string("  ") + key.name + "       " + key.help + "\n";
    return help + "  1       drag the terrain (middle button: along, wheel: nearer)\n"
                  "  2       the same as a trackball\n"
                  "  space   the overview\n"
                  "  Esc     end\n";
}
