/* One tile by a method of the literature: from posts, from nothing or from its children; to the bytes of a static tile.
 *
 * The method sees the posts of the zoom and the border lines of the ladder, which are those of all other builds, so
 * tiles meet whatever method made them and in any order of work. */
#ifndef SCREE_METHOD_BUILD_H
#define SCREE_METHOD_BUILD_H

#include "lod/post_tile.h"
#include "src/method_view.h"
#include "src/terrain_tile.h"
#include "src/tile_place.h"
#include "src/tile_store_io.h"

/* The three makers leave the tile's lines at the rung of its zoom. On failure nothing is left to release. */
enum scree_status method_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                      struct scree_memory *memory, struct post_tile *tile, struct scree_error *error);
enum scree_status method_build_level(const struct tile_plan *plan, struct tile_id id, struct scree_memory *memory,
                                     struct post_tile *tile, struct scree_error *error);
enum scree_status method_build_parent(const struct tile_plan *plan, struct tile_id id,
                                      const struct post_tile *const children[4], struct scree_memory *memory,
                                      struct post_tile *tile, struct scree_error *error);

/* A mesh of a tile as it is written: in position codes, and as the bytes of the static tile before compression. `coded`
 * and `bytes` belong to the tile's memory and are to be released in any case; `coded` must be empty. */
enum scree_status method_build_encode(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                      const struct method_view *view, const struct method_mesh *mesh,
                                      struct scree_mesh *coded, unsigned char **bytes, size_t *size_bytes,
                                      struct scree_error *error);

/* Runs the method, writes the static tile and tells its figures: errors are those of the tile as written, against all
 * posts of the zoom, but for the rounding of heights. */
enum scree_status method_build_write(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                     struct tile_store *store, struct terrain_tile_statistics *statistics,
                                     struct scree_error *error);

/* Takes the lines to the rung of the parent and hands the tile up; not for a root. */
enum scree_status method_build_hand_up(const struct tile_plan *plan, struct tile_id id, struct post_tile *tile,
                                       struct post_tile **coarse, struct scree_error *error);

#endif
