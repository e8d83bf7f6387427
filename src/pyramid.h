/* The pyramid: every tile of every zoom, depth first over the quadtree, on any number of threads.
 *
 * A tile is a pure function of its posts or of its four children, so results do not depend on who works when. Each
 * worker goes down a subtree of its own with one tile a zoom in memory; whoever finishes the last child of a tile
 * above the subtrees goes on with that tile. */
#ifndef SCREE_PYRAMID_H
#define SCREE_PYRAMID_H

#include "src/ladder.h"
#include "src/raster_io.h"
#include "src/scree_json.h"
#include "src/tile_build.h"
#include "src/tile_list.h"
#include "src/tile_store_io.h"
#include <scree/error.h>
#include <signal.h>

struct method_choice;
struct tin_source;

/* The tiles of a zoom that the data touch (and, at zoom 0, every root). Streams also have the tiles beside these that
 * share a parent with them: a viewer that replaces a tile by its children shall find all of them. */
struct pyramid_zoom {
    struct tile_list tiles, stream_tiles;
    struct terrain_tile_statistics *statistics; /* one a tile, filled by the build */
    struct stream_tile_figures *streams;        /* one a stream, filled by the build */
    struct rung_count *counts; /* of a census: TILE_MOST_RUNGS for each of `tiles`, fine to coarse; those behind the
                                  last have no vertices */
};

struct pyramid_options {
    const struct lattice *lattice;
    const struct ladder *ladder;
    const struct raster *raster;  /* that the finest tiles are made of ... */
    const struct tin_source *tin; /* ... or a TIN; the other is NULL */
    enum census census;           /* counts in place of products */
    bool has_base;                /* streams end with the rung base_rung; else with the coarsest */
    int base_rung;
    double nodata_height_m;
    int min_zoom, max_zoom; /* tiles of other zooms are made but not written */
    bool no_normals, plain; /* without octvertexnormals; without gzip */
    bool fits;              /* static tiles are fitted to the posts (lod/fit.h) */
    int threads;            /* at least 1 */
    uint32_t rungs_per_increment;
    const struct method_choice *method;  /* of the literature, that makes the static tiles; NULL: Scree's own way */
    struct tile_store *terrain, *stream; /* the products that are wanted; the others are NULL */
    const volatile sig_atomic_t *stop;   /* set from outside: give up; may be NULL */
    /* called under a lock, with the number of tiles of the finest zoom that are done */
    void (*progress)(void *context, uint32_t tiles_done, uint32_t tiles_in_all);
    void *progress_context;
};

struct pyramid {
    struct scree_memory memory; /* of the lists */
    struct pyramid_zoom zooms[MAX_ZOOM + 1];
};

/* Builds and writes all tiles. On failure the first error is told and no more tiles are begun. `pyramid` is to be freed
 * in any case. */
enum scree_status pyramid_build(const struct pyramid_options *options, struct pyramid *pyramid,
                                struct scree_error *error);
void pyramid_free(struct pyramid *pyramid);

#endif
