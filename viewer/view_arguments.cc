#include "viewer/view_arguments.h"

#include "viewer/terrain_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

bool parse_number(const std::string &text, double least, double most, double *number) {
    char *end;
    *number = strtod(text.c_str(), &end);
    return end != text.c_str() && *end == '\0' && *number >= least && *number <= most;
}

bool parse_whole(const std::string &text, double most, unsigned *whole) {
    double number;
    if (!parse_number(text, 1, most, &number) || number != floor(number)) return false;
    *whole = (unsigned)number;
    return true;
}

bool parse_size(const std::string &text, int *width_px, int *height_px) {
    const size_t cross = text.find('x');
    unsigned width, height;
    if (cross == std::string::npos || !parse_whole(text.substr(0, cross), 16384, &width) ||
        !parse_whole(text.substr(cross + 1), 16384, &height))
        return false;
    *width_px = (int)width;
    *height_px = (int)height;
    return true;
}

bool parse_colour(const std::string &text, unsigned *colour) {
    if (text.size() != 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) return false;
    *colour = (unsigned)strtoul(text.c_str(), nullptr, 16);
    return true;
}

bool parse_path(const std::string &text, std::string *path) {
    *path = text;
    return !text.empty();
}

// `value`: what it is called in the help; "": the option stands alone; "[...]": it may, and takes its value behind '='.
// `take` null: one of the terrain's own words (terrain_words.h), on when it stands alone.
struct Option {
    const char *name, *value, *help;
    bool (*take)(ViewArguments *, const std::string &);
};

using Text = const std::string &;

bool take_quadtree(ViewArguments *all, Text text) {
    return parse_path(text, &all->quadtree);
}
bool take_threshold(ViewArguments *all, Text text) {
    all->has_threshold = true;
    return parse_number(text, 0, 1e6, &all->threshold);
}
bool take_svo(ViewArguments *all, Text text) {
    return parse_number(text, 1e-9, 1e9, &all->options.settings.manual_svo_m);
}
bool take_no_morph(ViewArguments *all, Text) {
    all->options.settings.morph = false;
    return true;
}
bool take_no_stitch(ViewArguments *all, Text) {
    all->options.settings.stitch = false;
    return true;
}
bool take_wireframe(ViewArguments *all, Text) {
    return all->wireframe = true;
}
bool take_size(ViewArguments *all, Text text) {
    return parse_size(text, &all->width_px, &all->height_px);
}
bool take_background(ViewArguments *all, Text text) {
    all->has_background = true;
    return parse_colour(text, &all->background);
}
bool take_camera(ViewArguments *all, Text text) {
    all->has_camera = true;
    return parse_camera_place(text, &all->camera);
}
bool take_orthogonal(ViewArguments *all, Text) {
    return all->orthogonal = true;
}
bool take_screenshot(ViewArguments *all, Text text) {
    return parse_path(text, &all->screenshot);
}
bool take_fly(ViewArguments *all, Text text) {
    return parse_path(text, &all->fly);
}
bool take_record(ViewArguments *all, Text text) {
    return parse_path(text, &all->record);
}
bool take_play(ViewArguments *all, Text text) {
    return parse_number(text, 0.1, 1e6, &all->play_s);
}
bool take_benchmark(ViewArguments *all, Text) {
    return all->benchmark = true;
}
bool take_frames(ViewArguments *all, Text text) {
    return parse_whole(text, 1e9, &all->frames);
}
bool take_trace(ViewArguments *all, Text text) {
    return parse_path(text, &all->trace);
}
bool take_tiles_trace(ViewArguments *all, Text text) {
    return parse_path(text, &all->tiles_trace);
}
bool take_pictures(ViewArguments *all, Text text) {
    return parse_path(text, &all->pictures);
}
bool take_every(ViewArguments *all, Text text) {
    return parse_whole(text, 1e9, &all->picture_every_frames);
}
bool take_help(ViewArguments *all, Text) {
    return all->help = true;
}

const Option options[] = {
    {"--tolerance", "PX", "how long the smallest visible object may be on the screen, in pixels (1)", nullptr},
    {"--mode", "svo|error", "what the tolerance is of: the smallest visible object (svo) or the max error", nullptr},
    {"--svo", "M", "every tile at the coarsest rung with at most this SVO, in metres, whatever the view", take_svo},
    {"--triangles", "N", "draw no more, 1000 at least: the tolerance is raised instead", nullptr},
    {"--memory", "MB", "of all tiles that are held, 16 at least (1024)", nullptr},
    {"--colour", "NAME", "tint (by height), plain, tile, rung or texture", nullptr},
    {"--texture", "IMAGE", "a georeferenced image, any that GDAL reads, draped over the terrain", nullptr},
    {"--contours", "[M]", "lines of equal height; M from line to line: --contours=20", nullptr},
    {"--wireframe", "", "the sides of triangles only", take_wireframe},
    {"--no-morph", "", "change rungs at once instead of moving vertices", take_no_morph},
    {"--no-stitch", "", "leave the cracks between tiles of different rungs open", take_no_stitch},
    {"--glsl", "120|330", "the shaders' language (120)", nullptr},
    {"--size", "WxH", "of the window or the picture, in pixels (1280x800)", take_size},
    {"--background", "RRGGBB", "the sky's colour, in hexadecimal", take_background},
    {"--camera", "PLACE", "lon,lat,height,heading,pitch in degrees and metres (--camera=-84,36,900,0,-20)",
     take_camera},
    {"--orthogonal", "", "an orthogonal camera, at the same metres a pixel", take_orthogonal},
    {"--screenshot", "OUT.png", "draw the finished picture off screen, write it and end", take_screenshot},
    {"--fly", "FILE", "follow a camera path (docs/osg.md tells its format)", take_fly},
    {"--record", "FILE", "write the camera's path while you fly", take_record},
    {"--play", "SECONDS", "the scale of all tiles from the coarsest to the finest and back", take_play},
    {"--benchmark", "",
     "fly off screen as fast as it goes, around the terrain when nothing else is asked for, and tell what it took",
     take_benchmark},
    {"--frames", "N", "spread the flight evenly over N frames instead of following the clock", take_frames},
    {"--trace", "FILE.csv", "write a row for every frame", take_trace},
    {"--trace-tiles", "FILE.csv", "write a row for every tile of every frame", take_tiles_trace},
    {"--pictures", "DIR", "fly off screen, and write pictures of the flight into this folder", take_pictures},
    {"--every", "N", "a picture every so many frames (10)", take_every},
    {"--quadtree", "DEM", "instead of a terrain: any raster, as a mesh that follows the observer", take_quadtree},
    {"--threshold", "T", "of --quadtree: the curvature, as of scree remesh, that a square may have (1)",
     take_threshold},
    {"--help", "", "this text", take_help},
};

const Option *find_option(const std::string &name) {
    const auto found =
        std::find_if(std::begin(options), std::end(options), [&](const Option &option) { return name == option.name; });
    return found == std::end(options) ? nullptr : found;
}

// The option at `at`, its value with it, which may be the next word.
bool take_option(const std::vector<std::string> &words, size_t *at, ViewArguments *arguments, std::string *error) {
    const std::string &word = words[*at];
    const size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Option *option = find_option(name == "-h" ? "--help" : name);
    if (option == nullptr) {
        *error = "there is no option '" + name + "'";
        return false;
    }
    const bool wants_value = option->value[0] != '\0' && option->value[0] != '[';
    std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    if (equals == std::string::npos && wants_value) {
        if (*at + 1 == words.size()) {
            *error = name + " wants a value: " + option->value;
            return false;
        }
        value = words[++*at];
    }
    if (equals != std::string::npos && option->value[0] == '\0') {
        *error = name + " takes no value";
        return false;
    }
    std::string reason; // the one below says it in this program's words
    const std::string word_value = value.empty() && equals == std::string::npos && !wants_value ? "on" : value;
    if (option->take != nullptr ? option->take(arguments, value)
                                : terrain_word_set(name.substr(2), word_value, &arguments->options, &reason))
        return true;
    *error = name + " wants " + option->value + ", not '" + value + "'";
    return false;
}

// What makes no sense together.
const char *contradiction(const ViewArguments &arguments) {
    const bool is_flight = !arguments.fly.empty() || arguments.play_s > 0 || arguments.benchmark;
    if (!arguments.quadtree.empty() && !arguments.terrain.empty()) return "--quadtree shows a raster, and no terrain";
    if (arguments.quadtree.empty() && arguments.terrain.empty())
        return "which terrain? Give what scree build wrote, or a .scree file";
    if (arguments.quadtree.empty() && arguments.has_threshold) return "--threshold goes with --quadtree";
    if (!arguments.screenshot.empty() && (is_flight || !arguments.pictures.empty()))
        return "--screenshot takes one picture and does not fly; --pictures does";
    if (!arguments.pictures.empty() && !is_flight) return "--pictures wants --fly, --play or --benchmark";
    if (arguments.frames > 0 && !is_flight) return "--frames wants --fly, --play or --benchmark";
    if (!arguments.record.empty() && arguments.is_off_screen()) return "--record wants a window to fly in";
    if (arguments.options.settings.colour == TerrainColour::TEXTURE && arguments.options.texture.empty())
        return "--colour texture wants --texture IMAGE";
    return nullptr;
}

// The options that --quadtree has no use for; "": none of the words.
std::string useless_for_quadtree(const std::vector<std::string> &words) {
    static const char *const useful[] = {"--quadtree",   "--threshold", "--wireframe",  "--size",
                                         "--background", "--camera",    "--screenshot", "--fly",
                                         "--benchmark",  "--frames",    "--pictures",   "--every"};
    for (const std::string &word : words) {
        const std::string name = word.substr(0, word.find('='));
        const bool is_useful = std::find(std::begin(useful), std::end(useful), name) != std::end(useful);
        if (find_option(name) != nullptr && !is_useful) return name;
    }
    return "";
}

} // namespace

bool parse_view_arguments(const std::vector<std::string> &words, ViewArguments *arguments, std::string *error) {
    *arguments = ViewArguments();
    for (size_t i = 0; i < words.size(); i++) {
        if (words[i].size() > 1 && words[i][0] == '-') {
            if (!take_option(words, &i, arguments, error)) return false;
            if (arguments->help) return true;
        } else if (!arguments->terrain.empty()) {
            *error = "one terrain at a time, not '" + arguments->terrain + "' and '" + words[i] + "'";
            return false;
        } else {
            arguments->terrain = words[i];
        }
    }
    const char *wrong = contradiction(*arguments);
    if (wrong != nullptr) *error = wrong;
    const std::string useless = arguments->quadtree.empty() ? "" : useless_for_quadtree(words);
    if (wrong == nullptr && !useless.empty()) *error = useless + " does not go with --quadtree";
    return wrong == nullptr && useless.empty();
}

std::string view_options_help() {
    std::string help;
    for (const Option &option : options) {
        std::string left = option.name;
        if (option.value[0] == '[')
            left += std::string("[=") + (option.value + 1);
        else if (option.value[0] != '\0')
            left += std::string(" ") + option.value;
        left.resize(std::max<size_t>(left.size() + 1, 24), ' ');
        help += "  " + left + option.help + "\n";
    }
    return help;
}
