// What a terrain is asked for in words, as OpenSceneGraph hands options to its plugins: "tolerance=2 mode=error".
#ifndef SCREE_VIEWER_TERRAIN_WORDS_H
#define SCREE_VIEWER_TERRAIN_WORDS_H

#include "viewer/terrain_settings.h"

#include <string>
#include <vector>

struct TerrainWord {
    const char *form, *meaning;
};

// All that are known.
const std::vector<TerrainWord> &terrain_words();

// Sets one of them. False when `name` is none of them, or, with one line in `error`, its value makes no sense.
bool terrain_word_set(const std::string &name, const std::string &value, TerrainOptions *options, std::string *error);

// Reads words with spaces between them, NAME=VALUE each; others are another plugin's. False, and one line in `error`,
// when a value makes no sense.
bool terrain_words_read(const std::string &words, TerrainOptions *options, std::string *error);

#endif
