/* What a path on the command line stands for: a whole terrain, or one tile's file. */
#ifndef SCREE_TERRAIN_PATH_IO_H
#define SCREE_TERRAIN_PATH_IO_H

#include "src/lattice.h"
#include <stdbool.h>
#include <stddef.h>

/* A tile's name "zoom/x/y" as three bounded integers, or false. */
bool tile_id_parse(const char *text, struct tile_id *id);

/* Does the path end in ".terrain"? */
bool terrain_path_is_tile(const char *path);

/* For a path that ends in z/x/y.terrain: the tile; false for any other. */
bool terrain_path_tile(const char *path, struct tile_id *id);

/* For such a path beneath a layer.json: the folder that holds it, in `folder`; false otherwise. */
bool terrain_path_folder(const char *path, char *folder, size_t size_bytes);

#endif
