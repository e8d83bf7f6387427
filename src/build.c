#include "src/build.h"

#include "src/methods.h"
#include "src/stream_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum scree_status choose_lattice(const struct build_options *options, const struct raster_summary *summary,
                                        struct build *build, struct scree_error *error) {
    bool from_source = options->max_zoom == ZOOM_FROM_SOURCE;
    if (options->raster.profile == PROFILE_GEODETIC) {
        double spacing_deg = fmin(summary->spacing_x, summary->spacing_y);
        build->max_zoom = from_source ? lattice_zoom_for_spacing(spacing_deg) : options->max_zoom;
        build->lattice = lattice_geodetic(build->max_zoom);
    } else {
        enum scree_status status =
            lattice_local(summary->columns, summary->rows, summary->bounds[0], summary->bounds[1], summary->spacing_x,
                          summary->spacing_y, summary->metres_per_unit, &build->lattice, error);
        if (status != SCREE_OK) return status;
        build->max_zoom = build->lattice.finest_zoom;
        if (!from_source && options->max_zoom > build->max_zoom)
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "--max-zoom %d: in the local profile the raster's pixels are the finest posts, which is "
                              "zoom %d here",
                              options->max_zoom, build->max_zoom);
        if (!from_source) build->max_zoom = options->max_zoom;
    }
    if (options->min_zoom > build->max_zoom)
        return scree_fail(error, SCREE_E_ARGUMENT, "--min-zoom %d is finer than the finest zoom, %d", options->min_zoom,
                          build->max_zoom);
    return SCREE_OK;
}

/* Whether the method's options are fine at every zoom is known before the first tile. */
static enum scree_status check_method(const struct build_options *options, const struct build *build,
                                      struct scree_error *error) {
    double values[METHOD_MAX_OPTIONS];
    enum scree_status status = SCREE_OK;
    if (options->method == NULL) return SCREE_OK;
    if (!options->no_stream)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "--method %s makes static tiles only, streams come from Scree's own way down; ask for "
                          "--products terrain",
                          options->method->method->name);
    for (int zoom = options->min_zoom; zoom <= build->max_zoom && status == SCREE_OK; zoom++)
        status = method_values_at(options->method, zoom, build->ladder.tolerance_m[zoom], values, error);
    return status;
}

const struct raster_summary *build_summary(const struct build *build) {
    return build->is_tin ? &build->tin.summary : raster_summary(build->raster);
}

/* What is said about rasters only. */
static enum scree_status check_tin(const struct build_options *options, struct scree_error *error) {
    const char *what = options->method != NULL                 ? "--method wants"
                       : options->fits                         ? "--fit wants"
                       : options->max_zoom != ZOOM_FROM_SOURCE ? "--max-zoom is for"
                                                               : NULL;
    if (what == NULL) return SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT, "%s: is kept as triangles, and %s posts; --grid M makes posts of it",
                      options->raster.inputs[0], what);
}

static enum scree_status open_tin(const struct build_options *options, struct build *build, struct scree_error *error) {
    enum scree_status status = check_tin(options, error);
    if (status == SCREE_OK)
        status = tin_source_open(&options->raster, options->block_points, options->raster.has_nodata_height,
                                 &build->tin, error);
    if (status != SCREE_OK) return status;
    build->lattice = build->tin.lattice;
    build->max_zoom = build->tin.leaf_zoom;
    if (options->min_zoom <= build->max_zoom) return SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT, "--min-zoom %d is finer than the finest zoom, %d", options->min_zoom,
                      build->max_zoom);
}

static enum scree_status open_raster(const struct build_options *options, struct build *build,
                                     struct scree_error *error) {
    if (options->tin_option != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: becomes posts; %s is for mesh files and point clouds that are kept as triangles",
                          options->raster.inputs[0], options->tin_option);
    enum scree_status status = raster_open(&options->raster, &build->raster, error);
    return status == SCREE_OK ? choose_lattice(options, raster_summary(build->raster), build, error) : status;
}

/* A TIN's streams begin with all of it. */
static struct ladder_options ladder_options_of(const struct build_options *options, const struct build *build) {
    const struct raster_summary *summary = build_summary(build);
    struct ladder_options ladder = options->ladder;
    double lowest_m = fmin(summary->height_min_m - summary->relief_margin_m, build->outside_m);
    double highest_m = fmax(summary->height_max_m + summary->relief_margin_m, build->outside_m);
    bool has_wall = build->is_tin || options->raster.profile == PROFILE_GEODETIC;
    ladder.relief_m = highest_m - lowest_m;
    if (has_wall) ladder.wall_m = fmax(highest_m - build->outside_m, build->outside_m - lowest_m);
    ladder.largest_height_m = fmax(fabs(lowest_m), fabs(highest_m));
    if (build->is_tin) {
        ladder.zooms_above = build->lattice.finest_zoom - build->max_zoom;
        ladder.lossless = true;
        ladder.coarse_octaves = MAX_COARSE_OCTAVES; /* as far as the base wants it */
        ladder.quantum_m = build->tin.quantum_m;
    }
    if (ladder.finest_octaves == FINEST_OCTAVES_UNSAID)
        ladder.finest_octaves =
            build->is_tin ? ladder_octaves_of_tin(&build->lattice, &ladder) : DEFAULT_FINEST_OCTAVES;
    return ladder;
}

enum scree_status build_prepare(const struct build_options *options, struct build *build, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (!options->needs_posts) status = tin_source_is_wanted(&options->raster, &build->is_tin, error);
    if (status == SCREE_OK)
        status = build->is_tin ? open_tin(options, build, error) : open_raster(options, build, error);
    if (status != SCREE_OK) return status;
    build->outside_m = build->is_tin ? build->tin.outside_m : options->raster.nodata_height_m;
    struct ladder_options ladder = ladder_options_of(options, build);
    if ((status = ladder_make(&build->lattice, &ladder, &build->ladder, error)) != SCREE_OK) return status;
    if ((status = check_method(options, build, error)) != SCREE_OK) return status;
    return build->is_tin ? SCREE_OK : raster_place(build->raster, &build->lattice, error);
}

/* Adds up the tiles of each zoom, in their order; SVO grows towards the root. */
static void sum_up(struct build *build, int min_zoom, bool by_method) {
    double finer_svo_m = 0, finer_tolerance_m = 0;
    for (int zoom = build->max_zoom; zoom >= min_zoom; zoom--) {
        const struct pyramid_zoom *level = &build->pyramid.zooms[zoom];
        struct layer_zoom *sum = &build->zooms[zoom];
        double weighted_m2 = 0;
        *sum = (struct layer_zoom){.tolerance_m = build->ladder.tolerance_m[zoom],
                                   .height_step_m = build->ladder.border_step[zoom] * build->ladder.height_unit_m,
                                   .tile_count = level->tiles.count,
                                   .tiles = level->tiles.ids};
        for (uint32_t i = 0; i < level->tiles.count; i++) {
            const struct terrain_tile_statistics *tile = &level->statistics[i];
            sum->vertices += tile->vertices;
            sum->triangles += tile->triangles;
            sum->bytes += tile->bytes;
            sum->max_error_m = fmax(sum->max_error_m, tile->max_error_m);
            weighted_m2 += tile->mmqe_m2 * tile->vertices;
        }
        sum->svo_m = fmax(finer_svo_m, sqrt(weighted_m2 / (double)(sum->vertices > 0 ? sum->vertices : 1)));
        finer_svo_m = sum->svo_m;
        if (!by_method) continue;
        /* what the method kept to, with the rounding of heights, whatever it was asked for */
        sum->tolerance_m = fmax(finer_tolerance_m, sum->max_error_m + 0.5 * sum->height_step_m);
        finer_tolerance_m = sum->tolerance_m;
    }
}

static enum scree_status finish_terrain(const struct build_options *options, struct build *build,
                                        struct tile_store *store, struct scree_error *error) {
    sum_up(build, options->min_zoom, options->method != NULL);
    const struct raster_summary *summary = build_summary(build);
    struct layer layer = {.lattice = &build->lattice,
                          .min_zoom = options->min_zoom,
                          .max_zoom = build->max_zoom,
                          .crs_wkt = summary->crs_wkt,
                          .datum = summary->datum,
                          .attribution = summary->attribution,
                          .has_normals = !options->no_normals,
                          .is_gzipped = !options->plain,
                          .nodata_height_m = build->outside_m,
                          .method = options->method != NULL ? options->method->method->name : NULL,
                          .zooms = build->zooms};
    memcpy(layer.bounds, summary->bounds, sizeof layer.bounds);
    char *text = layer_json_new(&layer, error);
    if (text == NULL) return SCREE_E_MEMORY;
    enum scree_status status = tile_store_finish(store, "layer.json", text, error);
    free(text);
    return status;
}

#define MOST_RUNGS (RUNGS_A_ZOOM * (MAX_ZOOM + 1 + MAX_FINEST_OCTAVES + MAX_COARSE_OCTAVES) + 2)

/* The rungs of all tiles written, coarse to fine. */
static uint32_t rungs_of(const struct build *build, int32_t *first, double tolerance_m[MOST_RUNGS]) {
    bool has_finest = build->max_zoom == build->ladder.finest_zoom;
    int last = has_finest ? build->ladder.finest_rung : RUNGS_A_ZOOM * build->max_zoom;
    uint32_t count = 0;
    *first = RUNGS_A_ZOOM * (build->stream_min_zoom - 1);
    if (build->has_base && (build->base_rung > *first || build->stream_min_zoom == 0)) *first = build->base_rung;
    for (int rung = *first; rung <= last; rung++) tolerance_m[count++] = ladder_rung_tolerance_m(&build->ladder, rung);
    return count;
}

static enum scree_status finish_streams(const struct build_options *options, struct build *build,
                                        struct tile_store *store, struct scree_error *error) {
    const struct raster_summary *summary = build_summary(build);
    bool has_finest = build->max_zoom == build->ladder.finest_zoom;
    double tolerance_m[MOST_RUNGS];
    for (int zoom = build->stream_min_zoom; zoom <= build->max_zoom; zoom++) {
        const struct pyramid_zoom *level = &build->pyramid.zooms[zoom];
        build->streams[zoom] = (struct stream_zoom){.tiles = level->stream_tiles.ids};
        for (uint32_t i = 0; i < level->stream_tiles.count; i++)
            stream_zoom_add(&build->streams[zoom], &level->streams[i]);
    }
    struct stream_manifest manifest = {.lattice = &build->lattice,
                                       .min_zoom = build->stream_min_zoom,
                                       .max_zoom = build->max_zoom,
                                       .crs_wkt = summary->crs_wkt,
                                       .datum = summary->datum,
                                       .attribution = summary->attribution,
                                       .nodata_height_m = build->outside_m,
                                       .height_exponent = stream_height_exponent(&build->ladder),
                                       .finest_octaves = has_finest ? ladder_finest_octaves(&build->ladder) : 0,
                                       .is_lossless = has_finest && build->ladder.lossless,
                                       .rungs_per_increment =
                                           options->rungs_per_increment > 0 ? options->rungs_per_increment : 1,
                                       .tolerance_m = tolerance_m,
                                       .zooms = build->streams};
    manifest.rung_count = rungs_of(build, &manifest.first_rung, tolerance_m);
    memcpy(manifest.bounds, summary->bounds, sizeof manifest.bounds);
    char *text = scree_json_new(&manifest, error);
    if (text == NULL) return SCREE_E_MEMORY;
    enum scree_status status = tile_store_finish(store, "scree.json", text, error);
    free(text);
    return status;
}

/* A build in two passes, as whoever watches it sees it. */
struct passes {
    const struct pyramid_options *watch;
    uint32_t done; /* passes */
};

static void tell_pass(void *context, uint32_t tiles_done, uint32_t tiles_in_all) {
    const struct passes *passes = context;
    uint32_t both = (passes->done * tiles_in_all + tiles_done) / 2;
    if (passes->watch->progress != NULL) passes->watch->progress(passes->watch->progress_context, both, tiles_in_all);
}

/* What a TIN's streams end with is known when all of their meshes have been made once. */
static enum scree_status find_base(const struct build_options *options, const struct pyramid_options *pyramid,
                                   struct build *build, struct scree_error *error) {
    struct pyramid counted = {0};
    struct pyramid_options counting = *pyramid;
    counting.terrain = counting.stream = NULL;
    counting.census = base_census(&options->base);
    enum scree_status status = pyramid_build(&counting, &counted, error);
    if (status == SCREE_OK) {
        build->has_base = true;
        build->base_rung = base_rung(&options->base, &build->ladder, &counted);
        int zoom = base_zoom(&build->ladder, build->base_rung);
        if (zoom > build->stream_min_zoom) build->stream_min_zoom = zoom;
    }
    pyramid_free(&counted);
    return status;
}

enum scree_status build_run(const struct build_options *options, const struct pyramid_options *watch,
                            struct build *build, struct scree_error *error) {
    struct tile_store *terrain = NULL, *stream = NULL;
    enum scree_status status = SCREE_OK;
    if (!options->no_terrain) status = tile_store_open(options->out, "terrain", "terrain", &terrain, error);
    if (status == SCREE_OK && !options->no_stream)
        status = tile_store_open(options->out, "stream", "scree", &stream, error);
    if (status != SCREE_OK) goto cleanup;
    struct pyramid_options pyramid = *watch;
    pyramid.lattice = &build->lattice;
    pyramid.ladder = &build->ladder;
    pyramid.raster = build->raster;
    pyramid.tin = build->is_tin ? &build->tin : NULL;
    pyramid.nodata_height_m = build->outside_m;
    pyramid.min_zoom = options->min_zoom;
    pyramid.max_zoom = build->max_zoom;
    pyramid.no_normals = options->no_normals;
    pyramid.plain = options->plain;
    pyramid.fits = options->fits;
    pyramid.rungs_per_increment = options->rungs_per_increment;
    pyramid.method = options->method;
    pyramid.threads = options->threads;
    pyramid.terrain = terrain;
    pyramid.stream = stream;
    build->stream_min_zoom = options->min_zoom;
    struct passes passes = {watch, 0};
    if (build->is_tin && stream != NULL) {
        pyramid.progress = tell_pass;
        pyramid.progress_context = &passes;
        status = find_base(options, &pyramid, build, error);
        passes.done = 1;
    }
    if (status != SCREE_OK) goto cleanup;
    pyramid.has_base = build->has_base;
    pyramid.base_rung = build->base_rung;
    status = pyramid_build(&pyramid, &build->pyramid, error);
    if (status == SCREE_OK && terrain != NULL) status = finish_terrain(options, build, terrain, error);
    if (status == SCREE_OK && stream != NULL) status = finish_streams(options, build, stream, error);
cleanup:
    tile_store_free(stream);
    tile_store_free(terrain);
    return status;
}

void build_release(struct build *build) {
    pyramid_free(&build->pyramid);
    raster_free(build->raster);
    tin_source_release(&build->tin);
    memset(build, 0, sizeof *build);
}
