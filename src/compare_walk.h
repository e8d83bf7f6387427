/* The tiles that methods are compared on: those that are full of data, from the finest zoom up. Pure.
 *
 * A tile is full when it has all of its cells and every finest post in it is the source's: read twice, with another
 * height outside of the data each time, it must come out the same. What lies above a tile that is not full is not full
 * either, so nothing is handed up from it. */
#ifndef SCREE_COMPARE_WALK_H
#define SCREE_COMPARE_WALK_H

#include "src/method_build.h"

struct compare_walk {
    const struct tile_plan *plan;
    const struct raster *raster;
    struct raster_reader *reader, *other_reader; /* the second one of a raster with another height outside */
    int min_zoom, max_zoom;                      /* what is visited */
    /* called for every full tile of these zooms, children before parents */
    enum scree_status (*visit)(void *context, struct tile_id id, const struct post_tile *tile,
                               struct scree_error *error);
    /* may be NULL: how many of the finest tiles that the data touch are done */
    void (*progress)(void *context, uint32_t tiles_done, uint32_t tiles_in_all);
    void *context;
};

/* Visits. `touched[zoom]` is set to the number of tiles that the data touch, for the zooms visited. A raster that is
 * smaller than a tile (local profile) has no full one: its first tile is visited instead, and `*is_cut` is set. */
enum scree_status compare_walk(const struct compare_walk *walk, struct scree_memory *memory,
                               uint32_t touched[MAX_ZOOM + 1], bool *is_cut, struct scree_error *error);

#endif
