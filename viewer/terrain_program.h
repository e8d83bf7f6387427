// How tiles are drawn: the shaders, in GLSL 1.20 and 3.30, and the uniforms that are the same for all tiles.
#ifndef SCREE_VIEWER_TERRAIN_PROGRAM_H
#define SCREE_VIEWER_TERRAIN_PROGRAM_H

#include "viewer/terrain_settings.h"
#include "viewer/terrain_world.h"

#include <osg/Image>
#include <osg/StateSet>

// Attribute numbers of what a TileVertex holds.
enum TileAttribute { TILE_HIGH, TILE_LOW, TILE_DELTA, TILE_HEIGHTS, TILE_MAP, TILE_NORMAL, TILE_ORIGIN_NORMAL };

// Uniforms that each tile sets as it is drawn: the eye in two parts, view and projection, the levels, the
// increments of an octave, a colour.
#define UNIFORM_EYE_HIGH   "scree_eye_high"
#define UNIFORM_EYE_LOW    "scree_eye_low"
#define UNIFORM_VIEW       "scree_view"
#define UNIFORM_PROJECTION "scree_projection"
#define UNIFORM_LEVELS     "scree_levels"
#define UNIFORM_OCTAVE     "scree_octave"
#define UNIFORM_COLOUR     "scree_colour"

// For a whole terrain; `glsl` is 120 or 330; the texture, stretched over the data's bounds, may be null.
osg::ref_ptr<osg::StateSet> terrain_state(int glsl, const TerrainWorld &world, osg::Image *texture);

// Sets what the settings say.
void terrain_state_follow(osg::StateSet *state, const TerrainSettings &settings, const TerrainWorld &world);

#endif
