#include "src/verify_against_io.h"

#include <math.h>

#define BLOCK_POSTS     1024       /* side of a block of posts: 4 x 4 tiles of the finest zoom, 4 MB */
#define TOLERANCE_SLACK (1 + 1e-6) /* for rounding in the measure itself */

struct measure {
    struct scree_memory *memory;
    const struct terrain_set *set;
    struct against *against;
    struct scree_error *error;
    struct decoded_tile held[MAX_ZOOM + 1]; /* the last tile of each zoom */
    struct tile_id held_id[MAX_ZOOM + 1];
    bool is_held[MAX_ZOOM + 1];
};

static enum scree_status hold(struct measure *measure, struct tile_id id) {
    int zoom = id.zoom;
    struct scree_error why = {0};
    if (measure->is_held[zoom] && measure->held_id[zoom].x == id.x && measure->held_id[zoom].y == id.y) return SCREE_OK;
    decoded_tile_free(measure->memory, &measure->held[zoom]);
    measure->is_held[zoom] = true;
    measure->held_id[zoom] = id;
    enum scree_status status = terrain_set_read(measure->memory, measure->set, id, &measure->held[zoom], NULL, &why);
    if (status == SCREE_E_MEMORY) return scree_fail(measure->error, status, "%s", why.text);
    if (status == SCREE_OK && !isfinite(decoded_step_m(&measure->held[zoom])))
        decoded_tile_free(measure->memory, &measure->held[zoom]); /* leaves a tile without triangles */
    return SCREE_OK;
}

/* One zoom's tiles under a block of posts. */
static enum scree_status measure_zoom(struct measure *measure, int zoom, const struct post_block *block) {
    const struct lattice *lattice = &measure->set->layer.lattice;
    const struct tile_list *list = &measure->set->tiles[zoom];
    int64_t span = lattice_tile_span(lattice, zoom);
    uint32_t tiles_x = lattice_tiles_x(lattice, zoom), tiles_y = lattice_tiles_y(lattice, zoom);
    int64_t x_first = block->x / span, x_last = (block->x + block->columns - 1) / span;
    int64_t y_first = block->y / span, y_last = (block->y + block->rows - 1) / span;
    if (x_first > tiles_x - 1) x_first = tiles_x - 1; /* the lattice's last column is a border of its last tile */
    if (y_first > tiles_y - 1) y_first = tiles_y - 1;
    for (int64_t y = y_first; y <= y_last && y < tiles_y; y++)
        for (uint32_t at = tile_list_from(list, (uint32_t)y, (uint32_t)x_first);
             at < list->count && list->ids[at].y == y && list->ids[at].x <= x_last; at++) {
            struct tile_id id = list->ids[at];
            enum scree_status status = hold(measure, id);
            if (status != SCREE_OK) return status;
            residuals_add(lattice, id, &measure->held[zoom], block, id.x + 1 == tiles_x, y + 1 == tiles_y,
                          &measure->against->zooms[zoom]);
        }
    return SCREE_OK;
}

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* Blocks from the corner of the window's first post, cut so that each lies on one side of every multiple of their
 * size; a post belongs to one block. */
static enum scree_status measure_window(struct measure *measure, struct raster_reader *reader,
                                        struct lattice_window window, float *heights_m, double from, double to,
                                        verify_progress *progress, void *context) {
    int64_t x_end = window.x + window.columns + 1, y_end = window.y + window.rows + 1;
    for (int64_t y = window.y; y < y_end;) {
        int64_t y_next = smaller(y_end, (y / BLOCK_POSTS + 1) * BLOCK_POSTS);
        for (int64_t x = window.x; x < x_end;) {
            int64_t x_next = smaller(x_end, (x / BLOCK_POSTS + 1) * BLOCK_POSTS);
            struct post_block block = {x, y, (int32_t)(x_next - x), (int32_t)(y_next - y), heights_m};
            enum scree_status status =
                raster_read(reader, x, y, block.columns, block.rows, heights_m, block.columns, measure->error);
            for (int zoom = 0; zoom <= measure->set->layer.lattice.finest_zoom && status == SCREE_OK; zoom++)
                status = measure_zoom(measure, zoom, &block);
            if (status != SCREE_OK) return status;
            x = x_next;
        }
        y = y_next;
        if (progress != NULL)
            progress(context, from + (to - from) * (double)(y - window.y) / (double)(y_end - window.y));
    }
    return SCREE_OK;
}

enum scree_status verify_open_source(const struct raster_options *options, const struct lattice *lattice,
                                     struct raster **raster, struct scree_error *error) {
    enum scree_status status = raster_open(options, raster, error);
    if (status != SCREE_OK) return status;
    const struct raster_summary *summary = raster_summary(*raster);
    if (lattice->profile == PROFILE_LOCAL && (summary->columns != lattice->columns || summary->rows != lattice->rows))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: has %lld x %lld pixels, but the terrain was built from %lld x %lld; use the same "
                          "inputs and options as for the build",
                          options->inputs[0], (long long)summary->columns, (long long)summary->rows,
                          (long long)lattice->columns, (long long)lattice->rows);
    return raster_place(*raster, lattice, error);
}

enum scree_status verify_against(struct scree_memory *memory, const struct terrain_set *set,
                                 struct raster_options options, verify_progress *progress, void *context,
                                 struct against *against, struct scree_error *error) {
    struct measure measure = {.memory = memory, .set = set, .against = against, .error = error};
    const struct lattice *lattice = &set->layer.lattice;
    struct raster *raster = NULL;
    struct raster_reader *reader = NULL;
    struct lattice_window windows[2];
    float *heights_m = NULL;
    enum scree_status status = SCREE_E_MEMORY;
    options.profile = lattice->profile;
    against->zooms = scree_allocate(memory, MAX_ZOOM + 1, sizeof *against->zooms, "sums of errors", error);
    if (against->zooms == NULL) goto cleanup;
    heights_m = scree_allocate(memory, (size_t)BLOCK_POSTS * BLOCK_POSTS, sizeof *heights_m, "posts", error);
    if (heights_m == NULL) goto cleanup;
    status = verify_open_source(&options, lattice, &raster, error);
    if (status == SCREE_OK) status = raster_reader_new(raster, &reader, error);
    if (status != SCREE_OK) goto cleanup;
    int window_count = raster_windows(raster, windows);
    for (int i = 0; i < window_count && status == SCREE_OK; i++)
        status = measure_window(&measure, reader, windows[i], heights_m, (double)i / window_count,
                                (i + 1.0) / window_count, progress, context);
cleanup:
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) decoded_tile_free(memory, &measure.held[zoom]);
    raster_reader_free(reader);
    raster_free(raster);
    scree_release(memory, heights_m);
    if (status != SCREE_OK) against_free(memory, against);
    return status;
}

void verify_against_judge(const struct terrain_set *set, const struct against *against, struct verify_report *report) {
    const struct layer_info *layer = &set->layer;
    int finest = layer->lattice.finest_zoom;
    const struct residuals *sums = &against->zooms[finest];
    const struct layer_zoom_info *told = &layer->zooms[finest];
    if (!layer->is_ours || set->tiles[finest].count == 0) return; /* built with a maximum zoom: no exact bound */
    if (sums->posts == 0) {
        report_broken(report, PROMISE_ERROR, "no post of the source lies under a tile of zoom %d", finest);
    } else if (sums->drawn.max_m <= told->tolerance_m * TOLERANCE_SLACK) {
        report_held(report, PROMISE_ERROR);
    } else {
        report_broken(report, PROMISE_ERROR, "zoom %d: %.6g m at %.7f, %.7f; the tolerance is %.6g m", finest,
                      sums->drawn.max_m, lattice_x(&layer->lattice, (double)sums->drawn.max_x),
                      lattice_y(&layer->lattice, (double)sums->drawn.max_y), told->tolerance_m);
    }
}

void against_free(struct scree_memory *memory, struct against *against) {
    scree_release(memory, against->zooms);
    against->zooms = NULL;
}
