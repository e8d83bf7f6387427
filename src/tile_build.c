#include "src/tile_build.h"

#include "lod/compact.h"
#include "lod/tile_fit.h"
#include "src/quantized_mesh.h"
#include "src/stream_place.h"
#include "src/tin_source_io.h"
#include "stream/encode.h"
#include "stream/stream_header.h"

#include <math.h>
#include <string.h>

/* ---- from rung to rung ---- */

static enum scree_status mark(struct tile_walk *walk, double max_error_m, struct scree_error *error) {
    const struct recording_rung rung = {
        .rung = walk->rung, .mmqe_m2 = (float)tile_mmqe_m2(&walk->tile), .max_error_m = (float)max_error_m};
    return recorder_mark(&walk->recorder, &rung, error);
}

/* The stream ends here, and the tile goes on: the recorder gets a mesh of its own to finish with. */
static enum scree_status stop_recording(struct tile_walk *walk, struct scree_error *error) {
    enum scree_status status = mesh_copy(walk->tile.memory, &walk->tile.mesh, &walk->base, error);
    walk->tile.simplifier.options.observer = NULL;
    walk->recorder.mesh = &walk->base;
    return status;
}

/* What has come to a rung is told, as far as somebody wants to know. */
static enum scree_status arrive(const struct tile_plan *plan, struct tile_walk *walk, double max_error_m,
                                struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (plan->census != CENSUS_NONE) {
        struct rung_count *count = &walk->counts[walk->count_count++];
        *count = (struct rung_count){.rung = walk->rung,
                                     .vertices = (uint32_t)walk->tile.mesh.live_vertices,
                                     .triangles = (uint32_t)walk->tile.mesh.live_triangles};
        if (plan->census == CENSUS_OF_SVO) count->mmqe_m2 = tile_mmqe_m2(&walk->tile);
    }
    if (!walk->is_recorded || walk->recorder.mesh == &walk->base) return SCREE_OK;
    status = mark(walk, max_error_m, error);
    bool is_base = plan->has_base && walk->rung == plan->base_rung;
    return status == SCREE_OK && is_base ? stop_recording(walk, error) : status;
}

/* From here on the tile's way is part of its stream. */
static enum scree_status start_recording(const struct tile_plan *plan, struct tile_walk *walk, bool record,
                                         double max_error_m, struct scree_error *error) {
    if (!record) return arrive(plan, walk, max_error_m, error);
    enum scree_status status = recorder_start(walk->tile.memory, &walk->tile.mesh, &walk->recorder, error);
    if (status != SCREE_OK) return status;
    walk->is_recorded = true;
    walk->tile.simplifier.options.observer = &walk->recorder.observer;
    return arrive(plan, walk, max_error_m, error);
}

static enum scree_status take_to(const struct tile_plan *plan, struct tile_walk *walk, int rung,
                                 struct scree_error *error) {
    int zoom = tile_zoom_ahead(walk->id, rung);
    double tolerance_m = ladder_rung_tolerance_m(plan->ladder, rung);
    walk->rung = rung;
    if (zoom >= 0) tile_set_codes(&walk->tile, tile_place_frame(plan, walk->id, zoom));
    return rung_is_static(rung, zoom) ? tile_advance(&walk->tile, tolerance_m, error)
                                      : tile_advance_between(&walk->tile, tolerance_m, error);
}

static enum scree_status walk_to(const struct tile_plan *plan, struct tile_walk *walk, int last_rung,
                                 struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    while (walk->rung > last_rung && status == SCREE_OK) {
        status = take_to(plan, walk, walk->rung - 1, error);
        if (status == SCREE_OK)
            status = arrive(plan, walk, walk->is_recorded ? tile_max_error_m(&walk->tile) : 0, error);
    }
    return status;
}

/* All rungs from `first` to the coarsest one of which static tiles are made. */
static enum scree_status look_ahead(const struct tile_plan *plan, struct tile_walk *walk, int first,
                                    struct scree_error *error) {
    struct tile_rung rungs[TILE_MOST_RUNGS];
    int count = 0, last = walk->id.zoom > 0 ? tile_coarsest_rung(plan, walk->id) : 0;
    for (int rung = first; rung >= last; rung--) {
        int zoom = tile_zoom_ahead(walk->id, rung);
        rungs[count] = (struct tile_rung){.tolerance_m = ladder_rung_tolerance_m(plan->ladder, rung)};
        if (rung_is_static(rung, zoom)) rungs[count].codes = tile_place_frame(plan, walk->id, zoom);
        count++;
    }
    return tile_look_ahead(&walk->tile, rungs, count, error);
}

/* From the full grid to the rung of the finest zoom. */
static enum scree_status take_grid_down(const struct tile_plan *plan, struct tile_walk *walk, bool record,
                                        struct scree_error *error) {
    const struct ladder *ladder = plan->ladder;
    enum scree_status status = look_ahead(plan, walk, ladder->finest_rung - (ladder->lossless ? 1 : 0), error);
    walk->rung = ladder->finest_rung;
    if (status == SCREE_OK && !ladder->lossless) status = take_to(plan, walk, ladder->finest_rung, error);
    if (status == SCREE_OK && !ladder->lossless) status = simplifier_compact(&walk->tile.simplifier, error);
    if (status == SCREE_OK) status = start_recording(plan, walk, record, tile_max_error_m(&walk->tile), error);
    if (status == SCREE_OK) status = walk_to(plan, walk, RUNGS_A_ZOOM * walk->id.zoom, error);
    if (status == SCREE_OK) walk->max_error_m = tile_max_error_m(&walk->tile);
    return status;
}

static void begin(struct tile_walk *walk, struct tile_id id) {
    memset(walk, 0, sizeof *walk);
    walk->id = id;
    walk->rung = RUNGS_A_ZOOM * id.zoom;
}

/* Fits the mesh as it is for a static tile of `zoom`, if that is wanted. */
static enum scree_status fit(const struct tile_plan *plan, const struct tile_walk *walk, int zoom,
                             struct fitted_tile *fitted, struct scree_error *error) {
    if (!plan->fits) return SCREE_OK;
    return tile_fit_new(&walk->tile, tile_place_frame(plan, walk->id, zoom), plan->ladder->tolerance_m[zoom], fitted,
                        error);
}

/* ---- the three makers ---- */

static enum scree_status read_posts(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    struct scree_memory *memory, struct tile *tile, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    struct placed_posts placed;
    enum scree_status status = placed_posts_read(plan, id, reader, memory, &placed, error);
    if (status == SCREE_OK) status = tile_from_posts(memory, &geometry, &placed.posts, tile, error);
    placed_posts_release(memory, &placed);
    return status;
}

/* The tile's piece of the TIN. */
static enum scree_status cut_tin(const struct tile_plan *plan, struct tile_id id, struct scree_memory *memory,
                                 struct tile *tile, struct scree_error *error) {
    const struct tin_source *tin = plan->tin;
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    struct lattice_window window = lattice_tile_window(plan->lattice, id);
    const struct tin_tile place = {.column = (int32_t)((window.x - tin->x) / tin->placed.tile_span),
                                   .row = (int32_t)((window.y - tin->y) / tin->placed.tile_span),
                                   .columns = window.columns,
                                   .rows = window.rows,
                                   .level_step = tile_place_level_step(plan, id, &geometry),
                                   .wall_steps = tin->placed.wall_steps,
                                   .outside_m = (float)plan->nodata_height_m};
    struct tin_piece piece;
    enum scree_status status = tin_piece_make(memory, &tin->placed, &place, &piece, error);
    if (status == SCREE_OK) status = tile_from_tin(memory, &geometry, &piece, tile, error);
    tin_piece_release(memory, &piece);
    return status;
}

enum scree_status tile_build_finest(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    bool record, struct scree_memory *memory, struct tile_walk *walk,
                                    struct scree_error *error) {
    begin(walk, id);
    enum scree_status status = plan->tin != NULL ? cut_tin(plan, id, memory, &walk->tile, error)
                                                 : read_posts(plan, id, reader, memory, &walk->tile, error);
    if (status == SCREE_OK) status = take_grid_down(plan, walk, record, error);
    if (status == SCREE_OK) status = fit(plan, walk, id.zoom, &walk->fitted, error);
    if (status != SCREE_OK) tile_walk_release(walk);
    return status;
}

enum scree_status tile_build_level(const struct tile_plan *plan, struct tile_id id, bool record,
                                   struct scree_memory *memory, struct tile_walk *walk, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    int32_t step = tile_place_level_step(plan, id, &geometry);
    int64_t locked_step = geometry.locked_step, half = lattice_tile_span(plan->lattice, id.zoom) / 2;
    bool has_children = id.zoom < plan->ladder->finest_zoom;
    begin(walk, id);
    /* a base that is finer than such tiles are otherwise, is where its stream begins and ends */
    if (record && plan->has_base && plan->base_rung > walk->rung) walk->rung = plan->base_rung;
    /* like its neighbours it is, at its finest rung, what four children would be: their corners are there */
    if (has_children && (locked_step == 0 || half < locked_step)) geometry.locked_step = half;
    enum scree_status status = tile_from_level(memory, &geometry, step, plan->nodata_height_m, &walk->tile, error);
    bool is_whole = plan->ladder->lossless && walk->rung == plan->ladder->finest_rung;
    if (status == SCREE_OK && !is_whole) status = take_to(plan, walk, walk->rung, error);
    if (status == SCREE_OK) status = tile_lock(&walk->tile, locked_step, error);
    if (status == SCREE_OK) status = start_recording(plan, walk, record, tile_max_error_m(&walk->tile), error);
    if (status == SCREE_OK) status = walk_to(plan, walk, RUNGS_A_ZOOM * id.zoom, error);
    if (status == SCREE_OK) walk->max_error_m = tile_max_error_m(&walk->tile);
    if (status == SCREE_OK) status = fit(plan, walk, id.zoom, &walk->fitted, error);
    if (status != SCREE_OK) tile_walk_release(walk);
    return status;
}

enum scree_status tile_build_parent(const struct tile_plan *plan, struct tile_id id,
                                    const struct coarse_tile *const children[4], bool record,
                                    struct scree_memory *memory, struct tile_walk *walk, struct scree_error *error) {
    struct tile_drops drops;
    struct tile_geometry geometry = tile_place_geometry(plan, id, &drops);
    begin(walk, id);
    for (int i = 0; i < 4; i++)
        if (children[i] != NULL) walk->max_error_m = fmax(walk->max_error_m, children[i]->max_error_m);
    enum scree_status status = tile_from_children(memory, &geometry, children, &walk->tile, error);
    if (status == SCREE_OK && plan->fits) status = tile_fit_join_new(&walk->tile, children, &walk->fitted, error);
    if (status == SCREE_OK) status = start_recording(plan, walk, record, walk->max_error_m, error);
    if (status != SCREE_OK) tile_walk_release(walk);
    return status;
}

/* ---- what becomes of it ---- */

static float *vertex_slopes_new(const struct tile *tile, const struct scree_mesh *mesh, struct scree_error *error) {
    float *slopes = scree_allocate(tile->memory, 2 * (size_t)mesh->vertex_count, sizeof *slopes, "normals", error);
    for (uint32_t v = 0; slopes != NULL && v < mesh->vertex_count; v++) {
        struct slope slope = slope_grid_at(&tile->slopes, mesh->vertices[v].x, mesh->vertices[v].y);
        slopes[2 * v] = slope.east;
        slopes[2 * v + 1] = slope.north;
    }
    return slopes;
}

enum scree_status tile_build_write(const struct tile_plan *plan, const struct tile_walk *walk, struct tile_store *store,
                                   struct terrain_tile_statistics *statistics, struct scree_error *error) {
    const struct tile *tile = &walk->tile;
    struct tile_id id = walk->id;
    struct scree_memory *memory = tile->memory;
    struct scree_mesh own = {0};
    const struct scree_mesh *mesh = plan->fits ? &walk->fitted.mesh : &own;
    unsigned char *bytes = NULL;
    float *slopes = NULL;
    size_t size_bytes, written_bytes;
    enum scree_status status = SCREE_OK;
    if (!plan->fits && (status = mesh_export_new(memory, &tile->mesh, &own, error)) != SCREE_OK) goto cleanup;
    if (!plan->no_normals && (slopes = vertex_slopes_new(tile, mesh, error)) == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    struct terrain_tile terrain = {.lattice = plan->lattice,
                                   .id = id,
                                   .mesh = mesh,
                                   .slopes = slopes,
                                   .height_unit_m = plan->ladder->height_unit_m,
                                   .border_step = plan->ladder->border_step[id.zoom]};
    status = quantized_mesh_encode_new(memory, &terrain, &bytes, &size_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    status = tile_store_write(store, id, bytes, size_bytes, !plan->plain, &written_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    statistics->vertices = mesh->vertex_count;
    statistics->triangles = mesh->triangle_count;
    statistics->bytes = written_bytes;
    statistics->tolerance_m = plan->ladder->tolerance_m[id.zoom];
    statistics->max_error_m = plan->fits ? walk->fitted.max_error_m : walk->max_error_m;
    statistics->mmqe_m2 = plan->fits ? walk->fitted.mmqe_m2 : tile_mmqe_m2(tile);
cleanup:
    scree_release(memory, bytes);
    scree_release(memory, slopes);
    scree_release(memory, own.corners);
    scree_release(memory, own.vertices);
    return status;
}

enum scree_status tile_build_hand_up(const struct tile_plan *plan, struct tile_walk *walk, struct coarse_tile **coarse,
                                     struct scree_error *error) {
    bool is_root = walk->id.zoom == 0;
    enum scree_status status = SCREE_OK;
    *coarse = NULL;
    if (!is_root || walk->is_recorded || plan->census != CENSUS_NONE)
        status = walk_to(plan, walk, tile_coarsest_rung(plan, walk->id), error);
    if (status == SCREE_OK && !is_root) status = fit(plan, walk, walk->id.zoom - 1, &walk->tile.rest->fitted, error);
    return status == SCREE_OK && !is_root ? tile_hand_up_new(&walk->tile, coarse, error) : status;
}

enum scree_status tile_build_write_stream(const struct tile_plan *plan, struct tile_walk *walk,
                                          struct tile_store *store, struct stream_tile_figures *figures,
                                          struct scree_error *error) {
    struct scree_memory *memory = walk->tile.memory;
    const struct encode_options options = {.rungs_per_increment = plan->rungs_per_increment};
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    enum scree_status status = SCREE_E_MEMORY;
    struct scree_stream_header *header = scree_allocate(memory, 1, sizeof *header, "a stream's header", error);
    if (header == NULL) goto cleanup;
    if ((status = recorder_finish(&walk->recorder, error)) != SCREE_OK) goto cleanup;
    stream_place(plan->lattice, plan->ladder, walk->id, header);
    status = stream_encode_new(memory, header, &walk->recorder.recording, &options, &bytes, &size_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    if ((status = stream_header_read(bytes, size_bytes, header, error)) != SCREE_OK) goto cleanup;
    if ((status = tile_store_write(store, walk->id, bytes, size_bytes, false, NULL, error)) != SCREE_OK) goto cleanup;
    *figures = stream_tile_figures_of(header, size_bytes);
cleanup:
    scree_release(memory, bytes);
    scree_release(memory, header);
    return status;
}

void tile_walk_release(struct tile_walk *walk) {
    if (walk->is_recorded) recorder_release(&walk->recorder);
    if (walk->tile.memory != NULL) mesh_release(walk->tile.memory, &walk->base);
    if (walk->tile.memory != NULL) fitted_tile_release(walk->tile.memory, &walk->fitted);
    tile_release(&walk->tile);
    walk->is_recorded = false;
}
