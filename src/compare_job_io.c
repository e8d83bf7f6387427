/* The work of scree compare: see the header. */
#include "src/compare_job_io.h"

#include "lod/method_codes.h"
#include "src/compare_measure.h"
#include "src/compare_run_io.h"
#include "src/compare_walk.h"
#include "src/file_io.h"
#include "src/gzip.h"
#include "src/mesh_picture.h"
#include "src/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OTHER_HEIGHT_M 1234.5 /* how much higher the second raster lies outside of the data */

/* All entries of a zoom: by wanted count, then by method. */
struct level {
    uint32_t tile_count, room;
    struct compare_entry *entries;
    struct compare_zoom zoom;
};

struct compare_job {
    const struct compare_options *options;
    struct scree_memory memory;
    struct build build;
    struct raster *other; /* the same with another height outside of the data */
    struct tile_plan plan;
    struct level levels[MAX_ZOOM + 1];
    void (*progress)(void *context, uint32_t tiles_done, uint32_t tiles_in_all);
    void *progress_context;
    const char *names[COMPARE_MOST_METHODS], *main_options[COMPARE_MOST_METHODS];
    struct compare_zoom zooms[MAX_ZOOM + 1];
    struct compare_entry *entries; /* of the report */
    struct compare_report report;
};

/* ---- files ---- */

static enum scree_status write_file(const struct compare_job *job, const char *name, const void *bytes,
                                    size_t size_bytes, struct scree_error *error) {
    size_t room = strlen(job->options->build.out) + strlen(name) + 2;
    char *path = malloc(room);
    if (path == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    snprintf(path, room, "%s/%s", job->options->build.out, name);
    enum scree_status status = file_replace(path, bytes, size_bytes, error);
    free(path);
    return status;
}

static enum scree_status write_picture(struct compare_job *job, const struct space_mesh *mesh, const char *name,
                                       struct scree_error *error) {
    struct mesh_picture picture = {0};
    unsigned char *bytes = NULL;
    size_t size_bytes;
    enum scree_status status = mesh_picture_new(&job->memory, mesh, job->options->picture_px, &picture, error);
    if (status == SCREE_OK)
        status =
            png_encode_new(&job->memory, picture.rgb, picture.width_px, picture.height_px, &bytes, &size_bytes, error);
    if (status == SCREE_OK) status = write_file(job, name, bytes, size_bytes, error);
    scree_release(&job->memory, bytes);
    mesh_picture_release(&job->memory, &picture);
    return status;
}

/* ---- a tile ---- */

static uint32_t entry_count(const struct compare_options *options) {
    return (uint32_t)(options->method_count * (options->count_count > 0 ? options->count_count : 1));
}

static void tell_options(const struct compare_outcome *outcome, const struct compare_task *task, char *text,
                         size_t room) {
    const struct method *method = task->choice->method;
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < method->option_count && length < room; i++) {
        if (task->wanted_triangles != 0 && i == task->main_option) continue;
        if (outcome->values[i] != outcome->values[i]) continue; /* NAN: not given, the method decides */
        length += (size_t)snprintf(text + length, room - length, "%s%s=%.6g", length > 0 ? " " : "",
                                   method->options[i].name, outcome->values[i]);
    }
}

/* Makes the entries of a zoom when its first tile comes, and room for one more tile. */
static enum scree_status make_room(struct compare_job *job, struct level *level, int zoom, struct scree_error *error) {
    const struct compare_options *options = job->options;
    uint32_t count = entry_count(options), room = 2 * level->room + 4;
    if (level->tile_count < level->room) return SCREE_OK;
    if (level->entries == NULL) {
        level->entries = scree_allocate(&job->memory, count, sizeof *level->entries, "the report", error);
        if (level->entries == NULL) return SCREE_E_MEMORY;
        for (uint32_t i = 0; i < count; i++) {
            level->entries[i].zoom = zoom;
            level->entries[i].method = (int)i % options->method_count;
            level->entries[i].wanted_triangles =
                options->count_count > 0 ? options->counts[(int)i / options->method_count] : 0;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        struct compare_figures *more =
            scree_reallocate(&job->memory, level->entries[i].tiles, room, sizeof *more, "the report", error);
        if (more == NULL) return SCREE_E_MEMORY;
        level->entries[i].tiles = more;
    }
    level->room = room;
    return SCREE_OK;
}

static enum scree_status measure_bytes(const unsigned char *bytes, size_t size_bytes, uint64_t *stored_bytes,
                                       struct scree_error *error) {
    unsigned char *packed = NULL;
    size_t packed_bytes = 0;
    enum scree_status status = gzip_new(bytes, size_bytes, &packed, &packed_bytes, error);
    free(packed);
    *stored_bytes = packed_bytes;
    return status;
}

struct visit {
    struct compare_job *job;
    struct tile_id id;
    const struct post_tile *posts;
    struct method_view view;
    struct compare_subject subject;
};

/* The mesh of the first tile of a zoom. */
static enum scree_status draw(struct visit *visit, struct compare_entry *entry, const struct method_mesh *mesh,
                              struct scree_error *error) {
    struct compare_job *job = visit->job;
    char count[16] = "";
    struct vector3 *places = compare_places_new(&job->memory, job->plan.lattice, visit->id, mesh, error);
    if (places == NULL) return SCREE_E_MEMORY;
    if (entry->wanted_triangles != 0) snprintf(count, sizeof count, "-%u", (unsigned)entry->wanted_triangles);
    snprintf(entry->picture, sizeof entry->picture, "mesh-z%d-%.30s%s.png", entry->zoom, job->names[entry->method],
             count);
    entry->picture_triangles = mesh->triangle_count;
    const struct space_mesh space = {mesh->vertex_count, mesh->triangle_count, places, mesh->corners};
    enum scree_status status = write_picture(job, &space, entry->picture, error);
    scree_release(&job->memory, places);
    return status;
}

/* Measures what a method made as it is written: in position codes. */
static enum scree_status measure(struct visit *visit, struct compare_entry *entry,
                                 const struct compare_outcome *outcome, struct compare_figures *figures,
                                 struct scree_error *error) {
    struct compare_job *job = visit->job;
    struct scree_memory *memory = &job->memory;
    struct scree_mesh coded = {0};
    struct method_mesh drawn = {0};
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    bool is_first = job->levels[visit->id.zoom].tile_count == 0;
    enum scree_status status = method_build_encode(&job->plan, visit->id, visit->posts, &visit->view, &outcome->mesh,
                                                   &coded, &bytes, &size_bytes, error);
    if (status == SCREE_OK) status = measure_bytes(bytes, size_bytes, &figures->bytes, error);
    if (status == SCREE_OK)
        status = method_from_codes_new(memory, &visit->view.tile, &visit->view.frame, &coded, &drawn, error);
    if (status == SCREE_OK) status = compare_measure(memory, &visit->subject, &drawn, figures, error);
    if (status == SCREE_OK && is_first && job->options->picture_px > 0) status = draw(visit, entry, &drawn, error);
    method_mesh_release(memory, &drawn);
    scree_release(memory, bytes);
    scree_release(memory, coded.corners);
    scree_release(memory, coded.vertices);
    return status;
}

static enum scree_status run_entry(struct visit *visit, struct compare_entry *entry, struct scree_error *error) {
    struct compare_job *job = visit->job;
    struct scree_error why = {0};
    const struct compare_task task = {&job->options->methods[entry->method], visit->id.zoom,
                                      job->plan.ladder->tolerance_m[visit->id.zoom], entry->wanted_triangles,
                                      job->options->main_options[entry->method]};
    struct compare_outcome outcome;
    struct compare_figures figures = {0};
    enum scree_status status = compare_run(&job->memory, &task, &visit->view.tile, &outcome, &why);
    if (status == SCREE_OK) {
        figures.cpu_s = outcome.cpu_s;
        figures.main_value = outcome.values[task.main_option];
        tell_options(&outcome, &task, entry->options, sizeof entry->options);
        status = measure(visit, entry, &outcome, &figures, &why);
        method_mesh_release(&job->memory, &outcome.mesh);
    }
    entry->tiles[job->levels[visit->id.zoom].tile_count] = figures;
    if (status == SCREE_OK) return SCREE_OK;
    return scree_fail(error, status, "%s, tile %d/%u/%u: %s", job->names[entry->method], visit->id.zoom,
                      (unsigned)visit->id.x, (unsigned)visit->id.y, why.text);
}

static enum scree_status draw_posts(struct visit *visit, struct level *level, struct scree_error *error) {
    struct compare_job *job = visit->job;
    if (level->tile_count > 0 || job->options->picture_px == 0) return SCREE_OK;
    snprintf(level->zoom.picture, sizeof level->zoom.picture, "mesh-z%d-posts.png", visit->id.zoom);
    level->zoom.picture_tile = visit->id;
    return write_picture(job, &visit->subject.posts.index.mesh, level->zoom.picture, error);
}

static enum scree_status visit_tile(void *context, struct tile_id id, const struct post_tile *tile,
                                    struct scree_error *error) {
    struct compare_job *job = context;
    struct level *level = &job->levels[id.zoom];
    struct visit *visit = NULL;
    if (job->options->zooms_are_named && !job->options->zooms[id.zoom]) return SCREE_OK;
    enum scree_status status = make_room(job, level, id.zoom, error);
    if (status != SCREE_OK) return status;
    visit = scree_allocate(&job->memory, 1, sizeof *visit, "a tile", error);
    if (visit == NULL) return SCREE_E_MEMORY;
    *visit = (struct visit){.job = job, .id = id, .posts = tile};
    status = method_view_make(&job->plan, id, tile, &visit->view, error);
    if (status == SCREE_OK)
        status = compare_subject_make(&job->memory, job->plan.lattice, id, &visit->view.tile, job->options->seed,
                                      &visit->subject, error);
    if (status == SCREE_OK) status = draw_posts(visit, level, error);
    for (uint32_t i = 0; i < entry_count(job->options) && status == SCREE_OK; i++)
        status = run_entry(visit, &level->entries[i], error);
    level->tile_count++;
    compare_subject_release(&job->memory, &visit->subject);
    method_view_release(&job->memory, &visit->view);
    scree_release(&job->memory, visit);
    return status;
}

static void tell_progress(void *context, uint32_t tiles_done, uint32_t tiles_in_all) {
    const struct compare_job *job = context;
    if (job->progress != NULL) job->progress(job->progress_context, tiles_done, tiles_in_all);
}

/* ---- the walk ---- */

static enum scree_status prepare(struct compare_job *job, struct scree_error *error) {
    struct raster_options other = job->options->build.raster;
    enum scree_status status = build_prepare(&job->options->build, &job->build, error);
    if (status != SCREE_OK) return status;
    other.nodata_height_m += OTHER_HEIGHT_M;
    status = raster_open(&other, &job->other, error);
    if (status == SCREE_OK) status = raster_place(job->other, &job->build.lattice, error);
    if (status != SCREE_OK) return status;
    job->plan = (struct tile_plan){.lattice = &job->build.lattice,
                                   .ladder = &job->build.ladder,
                                   .nodata_height_m = job->options->build.raster.nodata_height_m};
    for (int i = 0; i < job->options->method_count; i++) {
        const struct method *method = job->options->methods[i].method;
        job->names[i] = job->options->names[i];
        job->main_options[i] = method->option_count > 0 ? method->options[job->options->main_options[i]].name : "";
    }
    return file_make_folder(job->options->build.out, error);
}

/* Options that are missing or out of range at a zoom are told before any work is done. */
static enum scree_status check_options(const struct compare_job *job, int min_zoom, int max_zoom,
                                       struct scree_error *error) {
    const struct compare_options *options = job->options;
    double values[METHOD_MAX_OPTIONS];
    enum scree_status status = SCREE_OK;
    for (int zoom = min_zoom; zoom <= max_zoom; zoom++)
        for (int i = 0; i < options->method_count && status == SCREE_OK; i++) {
            const struct compare_task task = {&options->methods[i], zoom, job->plan.ladder->tolerance_m[zoom],
                                              options->count_count > 0 ? options->counts[0] : 0,
                                              options->main_options[i]};
            if (!options->zooms_are_named || options->zooms[zoom]) status = compare_values_at(&task, values, error);
        }
    return status;
}

static enum scree_status walk(struct compare_job *job, uint32_t touched[MAX_ZOOM + 1], bool *is_cut,
                              struct scree_error *error) {
    struct compare_walk walk = {.plan = &job->plan,
                                .raster = job->build.raster,
                                .max_zoom = job->build.lattice.finest_zoom,
                                .visit = visit_tile,
                                .progress = tell_progress,
                                .context = job};
    const bool *zooms = job->options->zooms;
    while (job->options->zooms_are_named && walk.min_zoom < walk.max_zoom && !zooms[walk.min_zoom]) walk.min_zoom++;
    enum scree_status status = check_options(job, walk.min_zoom, walk.max_zoom, error);
    if (status == SCREE_OK) status = raster_reader_new(job->build.raster, &walk.reader, error);
    if (status == SCREE_OK) status = raster_reader_new(job->other, &walk.other_reader, error);
    if (status == SCREE_OK) status = compare_walk(&walk, &job->memory, touched, is_cut, error);
    raster_reader_free(walk.other_reader);
    raster_reader_free(walk.reader);
    return status;
}

/* ---- the report ---- */

static int by_place(const void *left, const void *right) {
    const struct compare_figures *a = left, *b = right;
    if (a->id.y != b->id.y) return a->id.y < b->id.y ? -1 : 1;
    return a->id.x < b->id.x ? -1 : a->id.x > b->id.x; /* a tile is there once */
}

static enum scree_status assemble(struct compare_job *job, const uint32_t touched[MAX_ZOOM + 1], bool is_cut,
                                  struct scree_error *error) {
    const struct compare_options *options = job->options;
    uint32_t count = entry_count(options), zoom_count = 0;
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        if (job->levels[zoom].tile_count > 0)
            zoom_count++;
        else if (options->zooms_are_named && options->zooms[zoom])
            return scree_fail(error, SCREE_E_ARGUMENT, "%s: zoom %d has no tile that is full of data",
                              options->build.raster.inputs[0], zoom);
    }
    if (zoom_count == 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: no zoom has a tile that is full of data%s",
                          options->build.raster.inputs[0],
                          options->build.raster.profile == PROFILE_LOCAL ? "" : "; try --profile local");
    job->entries = scree_allocate(&job->memory, (size_t)zoom_count * count, sizeof *job->entries, "the report", error);
    if (job->entries == NULL) return SCREE_E_MEMORY;
    struct compare_report *report = &job->report;
    *report = (struct compare_report){.dem = options->build.raster.inputs[0],
                                      .method_count = options->method_count,
                                      .methods = job->names,
                                      .main_options = job->main_options,
                                      .zooms = job->zooms,
                                      .entries = job->entries};
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        struct level *level = &job->levels[zoom];
        if (level->tile_count == 0) continue;
        for (uint32_t i = 0; i < count; i++) {
            qsort(level->entries[i].tiles, level->tile_count, sizeof *level->entries[i].tiles, by_place);
            job->entries[report->entry_count++] = level->entries[i];
        }
        level->zoom.zoom = zoom;
        level->zoom.tile_count = level->tile_count;
        level->zoom.tiles_in_all = touched[zoom];
        level->zoom.is_cut = is_cut;
        level->zoom.tolerance_m = job->build.ladder.tolerance_m[zoom];
        job->zooms[report->zoom_count++] = level->zoom;
    }
    return SCREE_OK;
}

static enum scree_status write_text(const struct compare_job *job, const char *name, struct text *text,
                                    struct scree_error *error) {
    size_t length_bytes = 0;
    char *bytes = text_take(text, &length_bytes);
    if (bytes == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for %s", name);
    enum scree_status status = write_file(job, name, bytes, length_bytes, error);
    free(bytes);
    return status;
}

static enum scree_status write_report(struct compare_job *job, struct scree_error *error) {
    struct text text = {0};
    enum scree_status status = compare_add_hausdorff_chart(&job->report, &job->memory, &text, error);
    if (status == SCREE_OK) status = write_text(job, "hausdorff.svg", &text, error);
    if (status == SCREE_OK) status = compare_add_error_chart(&job->report, &job->memory, &text, error);
    if (status == SCREE_OK) status = write_text(job, "error.svg", &text, error);
    compare_add_tiles_csv(&job->report, &text);
    if (status == SCREE_OK) status = write_text(job, "tiles.csv", &text, error);
    text_free(&text);
    compare_add_csv(&job->report, &text);
    if (status == SCREE_OK) status = write_text(job, "compare.csv", &text, error);
    text_free(&text);
    compare_add_markdown(&job->report, &text);
    if (status == SCREE_OK) status = write_text(job, "compare.md", &text, error);
    text_free(&text);
    return status;
}

enum scree_status compare_job_run(const struct compare_options *options,
                                  void (*progress)(void *context, uint32_t tiles_done, uint32_t tiles_in_all),
                                  void *context, struct compare_job **job, struct scree_error *error) {
    uint32_t touched[MAX_ZOOM + 1] = {0};
    bool is_cut = false;
    struct compare_job *made = calloc(1, sizeof *made);
    *job = made;
    if (made == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    made->options = options;
    made->progress = progress;
    made->progress_context = context;
    enum scree_status status = prepare(made, error);
    if (status == SCREE_OK) status = walk(made, touched, &is_cut, error);
    if (status == SCREE_OK) status = assemble(made, touched, is_cut, error);
    if (status == SCREE_OK) status = write_report(made, error);
    if (status == SCREE_OK) return SCREE_OK;
    compare_job_free(made);
    *job = NULL;
    return status;
}

const struct compare_report *compare_job_report(const struct compare_job *job) {
    return &job->report;
}

void compare_job_free(struct compare_job *job) {
    if (job == NULL) return;
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) {
        struct level *level = &job->levels[zoom];
        for (uint32_t i = 0; level->entries != NULL && i < entry_count(job->options); i++)
            scree_release(&job->memory, level->entries[i].tiles);
        scree_release(&job->memory, level->entries);
    }
    scree_release(&job->memory, job->entries);
    raster_free(job->other);
    build_release(&job->build);
    free(job);
}
