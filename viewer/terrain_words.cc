#include "viewer/terrain_words.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace {

// A number within limits.
bool is_number(const std::string &text, double low, double high, double *number) {
    char *end;
    *number = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0' && *number >= low && *number <= high;
}

// One of the words, as its place among them.
bool is_one_of(const std::string &text, const std::vector<std::string> &words, int *place) {
    for (size_t i = 0; i < words.size(); i++)
        if (words[i] == text) {
            *place = (int)i;
            return true;
        }
    return false;
}

bool is_switch(const std::string &text, bool *is_on) {
    int place;
    if (!is_one_of(text, {"off", "on"}, &place)) return false;
    *is_on = place == 1;
    return true;
}

} // namespace

const std::vector<TerrainWord> &terrain_words() {
    static const std::vector<TerrainWord> words = {
        {"tolerance=PX", "how many pixels the scale may be off, 0.01 to 1000; default 1"},
        {"mode=svo|error", "what that is measured by: the smallest visible object (default) or the largest error"},
        {"colour=tint|plain|tile|rung|texture", "how the terrain is coloured"},
        {"texture=IMAGE", "an image with georeference to drape over it, any that GDAL reads"},
        {"contours=M|on|off", "lines of equal height, every so many metres"},
        {"morph=on|off", "whether scales change smoothly"},
        {"stitch=on|off", "whether tiles of different scales are joined"},
        {"memory=MB", "for all tiles that are held, 16 to 1000000; default 1024"},
        {"triangles=N", "draw at most so many, 1000 to 1000000000"},
        {"glsl=120|330", "version of the shaders; default 120"},
    };
    return words;
}

bool terrain_word_set(const std::string &name, const std::string &value, TerrainOptions *options, std::string *error) {
    TerrainSettings &settings = options->settings;
    double number = 0;
    int place = 0;
    bool is_right;
    if (name == "tolerance") {
        if ((is_right = is_number(value, 0.01, 1000, &number))) settings.tolerance_px = number;
    } else if (name == "mode") {
        if ((is_right = is_one_of(value, {"svo", "error"}, &place)))
            settings.measure = place == 0 ? SCREE_BY_SVO : SCREE_BY_MAX_ERROR;
    } else if (name == "colour") {
        if ((is_right = is_one_of(value, {"tint", "plain", "tile", "rung", "texture"}, &place)))
            settings.colour = (TerrainColour)place;
    } else if (name == "texture") {
        if ((is_right = !value.empty())) options->texture = value, settings.colour = TerrainColour::TEXTURE;
    } else if (name == "contours") {
        is_right = is_switch(value, &settings.contours);
        if (!is_right && (is_right = is_number(value, 0.001, 1e6, &number)))
            settings.contours = true, settings.contour_m = number;
    } else if (name == "morph") {
        is_right = is_switch(value, &settings.morph);
    } else if (name == "stitch") {
        is_right = is_switch(value, &settings.stitch);
    } else if (name == "memory") {
        if ((is_right = is_number(value, 16, 1e6, &number))) settings.memory_bytes = (uint64_t)(number * (1 << 20));
    } else if (name == "triangles") {
        if ((is_right = is_number(value, 1000, 1e9, &number))) settings.triangle_budget = (uint64_t)number;
    } else if (name == "glsl") {
        if ((is_right = is_one_of(value, {"120", "330"}, &place))) options->glsl = place == 0 ? 120 : 330;
    } else {
        return false;
    }
    for (const TerrainWord &word : terrain_words())
        if (!is_right && std::string(word.form).compare(0, name.size() + 1, name + "=") == 0)
            *error = name + "=" + value + " makes no sense: " + word.form + ", " + word.meaning;
    return is_right;
}

bool terrain_words_read(const std::string &words, TerrainOptions *options, std::string *error) {
    std::istringstream stream(words);
    for (std::string word; stream >> word;) {
        size_t equals = word.find('=');
        if (equals == std::string::npos) continue;
        error->clear();
        if (!terrain_word_set(word.substr(0, equals), word.substr(equals + 1), options, error) && !error->empty())
            return false;
    }
    return true;
}
