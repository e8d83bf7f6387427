/* The main job from opened raster to manifests: chooses lattice and tolerances, builds the pyramid, writes layer.json
 * and scree.json. */
#ifndef SCREE_BUILD_H
#define SCREE_BUILD_H

#include "src/ladder.h"
#include "src/layer_json.h"
#include "src/pyramid.h"
#include "src/raster_io.h"

#define ZOOM_FROM_SOURCE (-1)

struct method_choice;

struct build_options {
    struct raster_options raster;
    const char *out;
    int min_zoom, max_zoom; /* max_zoom: ZOOM_FROM_SOURCE or a zoom */
    struct ladder_options ladder;
    bool no_terrain, no_stream;         /* products that are not written; what is there of them already is left alone */
    bool no_normals, plain;             /* of terrain */
    bool fits;                          /* static tiles are fitted to the posts (lod/fit.h) */
    uint32_t rungs_per_increment;       /* of streams; 0: 1 */
    const struct method_choice *method; /* of the literature, for terrain alone; NULL: Scree's own way */
    int threads;
};

/* A build while it goes on, and what it left. Zero it first; build_release in any case. */
struct build {
    struct raster *raster;
    struct lattice lattice;
    struct ladder ladder;
    struct pyramid pyramid;
    struct layer_zoom zooms[MAX_ZOOM + 1];    /* what was written, by zoom */
    struct stream_zoom streams[MAX_ZOOM + 1]; /* the same */
    int max_zoom;
};

/* Opens the rasters and settles where the posts lie and how exact each zoom is. */
enum scree_status build_prepare(const struct build_options *options, struct build *build, struct scree_error *error);

/* Builds and writes. `pyramid` names only what watches: stop, progress. */
enum scree_status build_run(const struct build_options *options, const struct pyramid_options *watch,
                            struct build *build, struct scree_error *error);

void build_release(struct build *build);

#endif
