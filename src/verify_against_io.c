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

static enum scree_status measure_posts(struct measure *measure, const struct verify_source *source,
                                       verify_progress *progress, void *context) {
    struct lattice_window windows[2];
    int window_count = raster_windows(source->raster, windows);
    float *heights_m =
        scree_allocate(measure->memory, (size_t)BLOCK_POSTS * BLOCK_POSTS, sizeof *heights_m, "posts", measure->error);
    enum scree_status status = heights_m == NULL ? measure->error->status : SCREE_OK;
    for (int i = 0; i < window_count && status == SCREE_OK; i++)
        status = measure_window(measure, source->reader, windows[i], heights_m, (double)i / window_count,
                                (i + 1.0) / window_count, progress, context);
    scree_release(measure->memory, heights_m);
    return status;
}

static enum scree_status measure_points(struct measure *measure, struct verify_source *source,
                                        verify_progress *progress, void *context) {
    const struct lattice *lattice = &measure->set->layer.lattice;
    uint64_t total = 0, done = 0;
    for (int zoom = 0; zoom <= lattice->finest_zoom; zoom++) total += measure->set->tiles[zoom].count;
    for (int zoom = 0; zoom <= lattice->finest_zoom; zoom++)
        for (uint32_t i = 0; i < measure->set->tiles[zoom].count; i++) {
            struct tile_id id = measure->set->tiles[zoom].ids[i];
            struct lattice_window window = lattice_tile_window(lattice, id);
            if (progress != NULL) progress(context, (double)++done / (double)total);
            if (window.columns == 0 || !residual_points_touch(&source->points, &window)) continue;
            enum scree_status status = hold(measure, id);
            if (status != SCREE_OK) return status;
            status = residual_points_add(lattice, id, &measure->held[zoom], id.x + 1 == lattice_tiles_x(lattice, zoom),
                                         id.y + 1 == lattice_tiles_y(lattice, zoom), &source->points,
                                         &measure->against->zooms[zoom], measure->error);
            if (status != SCREE_OK) return status;
        }
    return SCREE_OK;
}

enum scree_status verify_against(struct scree_memory *memory, const struct terrain_set *set,
                                 struct raster_options options, verify_progress *progress, void *context,
                                 struct against *against, struct scree_error *error) {
    struct measure measure = {.memory = memory, .set = set, .against = against, .error = error};
    const struct verify_built built = {&set->layer.lattice, set->layer.max_zoom, set->layer.bounds};
    struct verify_source source = {0};
    enum scree_status status = SCREE_E_MEMORY;
    against->zooms = scree_allocate(memory, MAX_ZOOM + 1, sizeof *against->zooms, "sums of errors", error);
    if (against->zooms == NULL) goto cleanup;
    status = verify_source_open(memory, &options, &built, &source, error);
    if (status != SCREE_OK) goto cleanup;
    against->is_of_points = source.is_tin;
    against->finest = verify_source_finest(&source, &built);
    status = source.is_tin ? measure_points(&measure, &source, progress, context)
                           : measure_posts(&measure, &source, progress, context);
cleanup:
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) decoded_tile_free(memory, &measure.held[zoom]);
    verify_source_close(&source);
    if (status != SCREE_OK) against_free(memory, against);
    return status;
}

void verify_against_judge(const struct terrain_set *set, const struct against *against, struct verify_report *report) {
    const struct layer_info *layer = &set->layer;
    int finest = against->finest;
    const struct residuals *sums = &against->zooms[finest];
    const struct layer_zoom_info *told = &layer->zooms[finest];
    if (!layer->is_ours || set->tiles[finest].count == 0) return; /* built with a maximum zoom: no exact bound */
    if (sums->posts == 0) {
        report_broken(report, PROMISE_ERROR, "nothing of the source lies under a tile of zoom %d", finest);
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
