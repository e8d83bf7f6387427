/* One tile: from posts, from nothing or from its children; from its mesh to the bytes of a static tile, and from all of
 * its way down the ladder to the bytes of a stream.
 *
 * A walk begins with one of the three makers, which leave the tile at the rung of its zoom; then tile_build_write,
 * tile_build_hand_up and tile_build_write_stream, as far as they are wanted, in this order. */
#ifndef SCREE_TILE_BUILD_H
#define SCREE_TILE_BUILD_H

#include "lod/recorder.h"
#include "lod/tile.h"
#include "src/scree_json.h"
#include "src/terrain_tile.h"
#include "src/tile_place.h"
#include "src/tile_store_io.h"

#define TILE_MOST_RUNGS (RUNGS_A_ZOOM * (MAX_FINEST_OCTAVES + 1 + MAX_COARSE_OCTAVES) + 2)

/* A tile on its way down its rungs. It must not move while it is recorded. */
struct tile_walk {
    struct tile_id id;
    int rung;
    double max_error_m; /* of the mesh at the rung of its zoom */
    struct tile tile;
    struct fitted_tile fitted; /* for the static tile; empty where nothing is fitted */
    bool is_recorded;
    struct recorder recorder;
    struct mesh base; /* of a stream that ends before the tile does */
    int count_count;
    struct rung_count counts[TILE_MOST_RUNGS]; /* of a census, fine to coarse */
};

/* A tile of the finest zoom. `record`: a stream will be asked for; recording begins at the finest rung. On failure
 * nothing is left to release, with this and the next two. */
enum scree_status tile_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    bool record, struct scree_memory *memory, struct tile_walk *walk,
                                    struct scree_error *error);

/* A tile of any zoom that no data touch. */
enum scree_status tile_build_level(const struct tile_plan *plan, struct tile_id id, bool record,
                                   struct scree_memory *memory, struct tile_walk *walk, struct scree_error *error);

/* The parent of up to four tiles, as their union: at the rung of its zoom, since they have been taken there. */
enum scree_status tile_build_parent(const struct tile_plan *plan, struct tile_id id,
                                    const struct coarse_tile *const children[4], bool record,
                                    struct scree_memory *memory, struct tile_walk *walk, struct scree_error *error);

/* Writes the static tile and tells its figures. */
enum scree_status tile_build_write(const struct tile_plan *plan, const struct tile_walk *walk, struct tile_store *store,
                                   struct terrain_tile_statistics *statistics, struct scree_error *error);

/* Takes the tile down to its coarsest rung and hands it up; `coarse` is NULL for a root, which nobody takes. */
enum scree_status tile_build_hand_up(const struct tile_plan *plan, struct tile_walk *walk, struct coarse_tile **coarse,
                                     struct scree_error *error);

/* Writes the stream of a recorded tile that is at its coarsest rung, and tells its figures. Nothing is left of the
 * mesh. */
enum scree_status tile_build_write_stream(const struct tile_plan *plan, struct tile_walk *walk,
                                          struct tile_store *store, struct stream_tile_figures *figures,
                                          struct scree_error *error);

/* Fine on a zeroed walk. */
void tile_walk_release(struct tile_walk *walk);

#endif
