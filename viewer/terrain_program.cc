#include "viewer/terrain_program.h"

#include <algorithm>
#include <cmath>
#include <osg/Program>
#include <osg/Texture2D>

namespace {

// The same text for both versions of the language, below one of these.
const char *const VERTEX_120 = "#version 120\n"
                               "#define IN attribute\n"
                               "#define OUT varying\n";
const char *const VERTEX_330 = "#version 330\n"
                               "#define IN in\n"
                               "#define OUT out\n";
const char *const FRAGMENT_120 = "#version 120\n"
                                 "#define IN varying\n"
                                 "#define texture texture2D\n"
                                 "#define fragment gl_FragColor\n";
const char *const FRAGMENT_330 = "#version 330\n"
                                 "#define IN in\n"
                                 "out vec4 fragment;\n";

const char *const VERTEX = R"(
IN vec3 scree_high, scree_low, scree_delta;
IN vec2 scree_heights, scree_map;
IN vec4 scree_normal, scree_origin_normal;
uniform vec3 scree_eye_high, scree_eye_low;
uniform mat4 scree_view, scree_projection;
uniform float scree_levels[64]; // SLOT_COUNT
uniform float scree_octave; // increments
uniform bool scree_is_globe;
uniform vec3 scree_sun; // to the east, north and up
OUT float height, light;
OUT vec2 map;
void main() {
    // how far the vertex has come out of its origin: scree_morph_weight
    float level = scree_levels[int(scree_origin_normal.w)];
    float weight = clamp(level + 1.0 - scree_normal.w, 0.0, 1.0);
    vec3 place = (scree_high - scree_eye_high) + (scree_low - scree_eye_low) + (1.0 - weight) * scree_delta;
    gl_Position = scree_projection * (scree_view * vec4(place, 1.0));
    height = mix(scree_heights.y, scree_heights.x, weight);
    map = 2.0 * scree_map - 0.5; // MAP_SPAN
    // it turns until the end of its octave: TileMesh::normal_at
    float from = max(scree_normal.w - 1.0, 0.0);
    float to = ceil(max(scree_normal.w, 1.0) / scree_octave - 1e-4) * scree_octave;
    float turned = clamp((level - from) / (to - from), 0.0, 1.0);
    vec3 normal = normalize(mix(scree_origin_normal.xyz, scree_normal.xyz, turned));
    vec3 up = vec3(0.0, 0.0, 1.0), east = vec3(1.0, 0.0, 0.0);
    if (scree_is_globe) {
        up = normalize(scree_high);
        east = abs(up.z) > 0.99999 ? east : normalize(vec3(-up.y, up.x, 0.0));
    }
    vec3 sun = scree_sun.x * east + scree_sun.y * cross(up, east) + scree_sun.z * up;
    light = 0.42 + 0.78 * max(dot(normal, sun), 0.0);
}
)";

const char *const FRAGMENT = R"(
IN float height, light;
IN vec2 map;
uniform vec4 scree_colour; // of the tile; w 0: none
uniform bool scree_is_tinted, scree_is_textured;
uniform sampler2D scree_texture;
uniform vec2 scree_range; // of the heights that are land
uniform bool scree_has_sea; // below 0
uniform float scree_contour; // metres from line to line; 0: none
vec3 tint(float at) {
    if (scree_has_sea && at < 0.0)
        return mix(vec3(0.62, 0.78, 0.86), vec3(0.10, 0.24, 0.45), clamp(-at / 4000.0, 0.0, 1.0));
    float part = clamp((at - scree_range.x) / (scree_range.y - scree_range.x), 0.0, 1.0) * 4.0;
    vec3 low = vec3(0.47, 0.62, 0.42), plain = vec3(0.71, 0.77, 0.52), hill = vec3(0.86, 0.79, 0.58);
    vec3 rock = vec3(0.72, 0.58, 0.46), top = vec3(0.95, 0.94, 0.92);
    if (part < 1.0) return mix(low, plain, part);
    if (part < 2.0) return mix(plain, hill, part - 1.0);
    if (part < 3.0) return mix(hill, rock, part - 2.0);
    return mix(rock, top, part - 3.0);
}
void main() {
    vec3 colour = vec3(0.78, 0.76, 0.72);
    // beyond the data's bounds there is ground at a stated height, and nothing to tell of it
    bool is_data = all(greaterThan(map, vec2(1e-5))) && all(lessThan(map, vec2(1.0 - 1e-5)));
    if (scree_is_tinted) colour = is_data ? tint(height) : vec3(0.52, 0.57, 0.60);
    if (scree_is_textured && is_data) {
        vec4 image = texture(scree_texture, map);
        colour = mix(colour, image.rgb, image.a);
    }
    if (scree_colour.w > 0.0) colour = scree_colour.rgb;
    colour *= light;
    float line = scree_contour > 0.0 ? height / scree_contour : 0.0, width = fwidth(line);
    if (is_data && width > 1e-5) { // level ground has no line
        float away = abs(fract(line - 0.5) - 0.5) / width; // pixels
        float crowd = clamp(0.5 - width, 0.0, 0.5) * 2.0;  // none where lines would run together
        colour *= 1.0 - 0.45 * crowd * (1.0 - smoothstep(0.4, 1.2, away));
    }
    fragment = vec4(colour, 1.0);
}
)";

constexpr int TEXTURE_UNIT = 0;
constexpr double SEA_M = -100; // lower depths than any dry land's are a sea's

osg::Program *program_new(int glsl) {
    osg::Program *program = new osg::Program;
    program->setName("scree terrain");
    bool is_330 = glsl >= 330;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, std::string(is_330 ? VERTEX_330 : VERTEX_120) + VERTEX));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT, std::string(is_330 ? FRAGMENT_330 : FRAGMENT_120) + FRAGMENT));
    program->addBindAttribLocation("scree_high", TILE_HIGH);
    program->addBindAttribLocation("scree_low", TILE_LOW);
    program->addBindAttribLocation("scree_delta", TILE_DELTA);
    program->addBindAttribLocation("scree_heights", TILE_HEIGHTS);
    program->addBindAttribLocation("scree_map", TILE_MAP);
    program->addBindAttribLocation("scree_normal", TILE_NORMAL);
    program->addBindAttribLocation("scree_origin_normal", TILE_ORIGIN_NORMAL);
    return program;
}

// A round number of metres, some thirty lines over the relief.
double contour_for(double relief_m) {
    double step_m = std::pow(10, std::floor(std::log10(std::max(relief_m / 30, 1e-3))));
    for (double factor : {1.0, 2.0, 5.0})
        if (factor * step_m >= relief_m / 30) return factor * step_m;
    return 10 * step_m;
}

} // namespace

osg::ref_ptr<osg::StateSet> terrain_state(int glsl, const TerrainWorld &world, osg::Image *texture) {
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setDataVariance(osg::Object::DYNAMIC); // it follows the settings
    state->setAttributeAndModes(program_new(glsl));
    state->addUniform(new osg::Uniform("scree_is_globe", world.is_geodetic()));
    osg::Vec3 sun(-0.55f, 0.55f, 0.63f); // from the north-west, as on maps
    sun.normalize();
    state->addUniform(new osg::Uniform("scree_sun", sun));
    state->addUniform(new osg::Uniform("scree_texture", TEXTURE_UNIT));
    bool has_sea = world.lowest_m() < SEA_M;
    double lowest_m = has_sea ? 0 : world.lowest_m();
    state->addUniform(new osg::Uniform("scree_has_sea", has_sea));
    state->addUniform(
        new osg::Uniform("scree_range", osg::Vec2((float)lowest_m, (float)std::max(world.highest_m(), lowest_m + 1))));
    if (texture != nullptr) {
        osg::ref_ptr<osg::Texture2D> image = new osg::Texture2D(texture);
        image->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        image->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        image->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
        image->setMaxAnisotropy(8);
        image->setResizeNonPowerOfTwoHint(false);
        state->setTextureAttribute(TEXTURE_UNIT, image);
    }
    return state;
}

void terrain_state_follow(osg::StateSet *state, const TerrainSettings &settings, const TerrainWorld &world) {
    bool has_texture = state->getTextureAttribute(TEXTURE_UNIT, osg::StateAttribute::TEXTURE) != nullptr;
    bool is_textured = settings.colour == TerrainColour::TEXTURE && has_texture;
    bool is_tinted = settings.colour == TerrainColour::TINT || settings.colour == TerrainColour::TEXTURE;
    double contour_m = settings.contour_m > 0 ? settings.contour_m : contour_for(world.highest_m() - world.lowest_m());
    state->getOrCreateUniform("scree_is_textured", osg::Uniform::BOOL)->set(is_textured);
    state->getOrCreateUniform("scree_is_tinted", osg::Uniform::BOOL)->set(is_tinted);
    state->getOrCreateUniform("scree_contour", osg::Uniform::FLOAT)->set(settings.contours ? (float)contour_m : 0.f);
}
