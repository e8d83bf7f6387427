/* The main job from opened raster to manifests: chooses lattice and tolerances, builds the pyramid, writes layer.json
 * and scree.json. */
#ifndef SCREE_BUILD_H
#define SCREE_BUILD_H

#include "src/base.h"
#include "src/ladder.h"
#include "src/layer_json.h"
#include "src/pyramid.h"
#include "src/raster_io.h"
#include "src/tin_source_io.h"

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
    struct base_choice base;            /* of a TIN's streams */
    uint32_t block_points;              /* of a TIN's sub-blocks, at most; 0: the default */
    bool needs_posts;                   /* point clouds are gridded, whatever was said */
    const char *tin_option;             /* one that only TINs have, as it was written; NULL: none was */
    int threads;
};

/* A build while it goes on, and what it left. Zero it first; build_release in any case. */
struct build {
    bool is_tin;
    struct raster *raster; /* or */
    struct tin_source tin;
    struct lattice lattice;
    struct ladder ladder;
    struct pyramid pyramid;
    struct layer_zoom zooms[MAX_ZOOM + 1];    /* what was written, by zoom */
    struct stream_zoom streams[MAX_ZOOM + 1]; /* the same */
    int max_zoom;
    double outside_m;    /* height outside of the data */
    int stream_min_zoom; /* streams may end before options->min_zoom is reached */
    bool has_base;       /* streams end at base_rung */
    int base_rung;
};

/* Opens the rasters, or the TIN, and settles where the posts lie and how exact each zoom is. */
enum scree_status build_prepare(const struct build_options *options, struct build *build, struct scree_error *error);

/* Builds and writes. `pyramid` names only what watches: stop, progress. */
enum scree_status build_run(const struct build_options *options, const struct pyramid_options *watch,
                            struct build *build, struct scree_error *error);

const struct raster_summary *build_summary(const struct build *build);

void build_release(struct build *build);

#endif
