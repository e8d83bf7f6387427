/* One tile: from posts, from nothing or from its children; and from its mesh to the bytes of a static tile. */
#ifndef SCREE_TILE_BUILD_H
#define SCREE_TILE_BUILD_H

#include "lod/tile.h"
#include "src/ladder.h"
#include "src/raster_io.h"
#include "src/terrain_tile.h"
#include "src/tile_store_io.h"

/* What is the same for all tiles of a build. */
struct tile_plan {
    const struct lattice *lattice;
    const struct ladder *ladder;
    double nodata_height_m;
    bool no_normals, plain;
};

/* A tile of the finest zoom, at its tolerance. */
enum scree_status tile_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    struct scree_memory *memory, struct tile *tile, struct scree_error *error);

/* A tile of any zoom that no data touch. */
enum scree_status tile_build_level(const struct tile_plan *plan, struct tile_id id, struct scree_memory *memory,
                                   struct tile *tile, struct scree_error *error);

/* The parent of up to four tiles, as their union: at its own tolerance, since they have been taken there. */
enum scree_status tile_build_parent(const struct tile_plan *plan, struct tile_id id,
                                    const struct coarse_tile *const children[4], struct scree_memory *memory,
                                    struct tile *tile, struct scree_error *error);

/* Writes the tile as it is and tells its figures but for the errors. */
enum scree_status tile_build_write(const struct tile_plan *plan, struct tile_id id, const struct tile *tile,
                                   struct tile_store *store, struct terrain_tile_statistics *statistics,
                                   struct scree_error *error);

/* Takes the tile down to the tolerance of the zoom above and hands it up; the tile is released. */
enum scree_status tile_build_hand_up(const struct tile_plan *plan, struct tile_id id, struct tile *tile,
                                     struct coarse_tile **coarse, struct scree_error *error);

#endif
