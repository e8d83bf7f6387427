/* A small terrain product made by the tests themselves: the globe at zooms 0 and 1, of regular grids. */
#ifndef SCREE_TESTS_TERRAIN_MAKER_H
#define SCREE_TESTS_TERRAIN_MAKER_H

#include "tests/tile_maker.h"

#define MADE_CELLS  6
#define MADE_SIDE   (MADE_CELLS + 1)
#define MADE_FINEST 1

struct made_terrain {
    char folder[256]; /* a new one, that made_terrain_remove removes */
    bool has_normals;
    uint64_t bytes[MADE_FINEST + 1];
};

/* 2 + 8 tiles, every other one gzip'd, and a layer.json that is right. */
struct made_terrain made_terrain_globe(bool has_normals);

/* The recipe of one of its tiles, to be spoilt and written again. */
struct tile_recipe made_terrain_recipe(struct tile_id id, bool has_normals);

/* Writes (and frees) a recipe; layer.json is brought up to date. */
void made_terrain_write(struct made_terrain *terrain, struct tile_id id, struct tile_recipe *recipe);

/* layer.json, listing only the first `finest_tiles` of zoom 1. */
void made_terrain_manifest(const struct made_terrain *terrain, uint32_t finest_tiles);

void made_terrain_text(const struct made_terrain *terrain, const char *name, const char *text);
void made_terrain_delete(const struct made_terrain *terrain, struct tile_id id);
void made_terrain_truncate(const struct made_terrain *terrain, struct tile_id id, long size_bytes);
void made_terrain_remove(struct made_terrain *terrain);

#endif
