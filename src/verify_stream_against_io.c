#include "src/verify_stream_against_io.h"

#include "src/verify_source_io.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define BLOCK_POSTS 1024       /* side of a block of posts */
#define LOCAL_SLACK (1 + 1e-6) /* for rounding in the measure itself, and to floats in the header */
#define GLOBE_SLACK                                                                                        \
    (1 + 1e-4) /* and for the fall of the globe under a triangle, which a build takes from a table by row, \
                  and this measure from the triangle's own centre */

struct measure {
    struct scree_memory *memory;
    const struct stream_set *set;
    struct verify_source source;
    int finest;                    /* the zoom that is judged */
    float *heights_m;              /* of a block */
    struct residuals *scratch;     /* of one mesh over one block */
    double max_m[SCREE_MAX_RUNGS]; /* of the tile in hand, by rung */
    struct stream_against *against;
    struct verify_report *report;
    struct scree_error *error;
};

static int64_t larger(int64_t a, int64_t b) {
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* The tile at all of its rungs over one block of posts; NULL: over the points of a TIN. */
static void measure_block(struct measure *measure, struct tile_id id, struct scree_player *player,
                          const struct post_block *block) {
    const struct lattice *lattice = &measure->set->info.lattice;
    const struct scree_stream_header *header = scree_player_header(player);
    for (uint32_t i = 0; i < header->rung_count; i++) {
        struct scree_arrays arrays;
        scree_player_seek_rung(player, i);
        scree_player_look(player, &arrays);
        const struct post_mesh mesh = {arrays.vertices, arrays.indices, arrays.triangle_count,
                                       ldexp(1, header->height_exponent)};
        memset(measure->scratch, 0, sizeof *measure->scratch);
        if (block != NULL)
            residuals_add_posts(lattice, id, &mesh, block, true, true, measure->scratch);
        else
            residual_points_add_mesh(lattice, id, &mesh, true, true, &measure->source.points, measure->scratch);
        measure->max_m[i] = fmax(measure->max_m[i], measure->scratch->drawn.max_m);
    }
}

/* The posts of a tile that one of the source's windows covers, borders included, block by block. */
static enum scree_status measure_window(struct measure *measure, struct tile_id id, struct scree_player *player,
                                        const struct lattice_window *tile, const struct lattice_window *source) {
    int64_t x_first = larger(tile->x, source->x), y_first = larger(tile->y, source->y);
    int64_t x_end = smaller(tile->x + tile->columns, source->x + source->columns) + 1;
    int64_t y_end = smaller(tile->y + tile->rows, source->y + source->rows) + 1;
    for (int64_t y = y_first; y < y_end; y += BLOCK_POSTS)
        for (int64_t x = x_first; x < x_end; x += BLOCK_POSTS) {
            struct post_block block = {x, y, (int32_t)smaller(BLOCK_POSTS, x_end - x),
                                       (int32_t)smaller(BLOCK_POSTS, y_end - y), measure->heights_m};
            enum scree_status status = raster_read(measure->source.reader, x, y, block.columns, block.rows,
                                                   measure->heights_m, block.columns, measure->error);
            if (status != SCREE_OK) return status;
            measure_block(measure, id, player, &block);
        }
    return SCREE_OK;
}

static void book(struct measure *measure, struct tile_id id, const struct scree_stream_header *header) {
    struct stream_against_zoom *zoom = &measure->against->zooms[id.zoom];
    double slack = header->profile == SCREE_GEODETIC ? GLOBE_SLACK : LOCAL_SLACK;
    bool is_finest = id.zoom == measure->finest;
    for (uint32_t i = 0; i < header->rung_count; i++) {
        double stated_m = header->rungs[i].max_error_m, measured_m = measure->max_m[i];
        bool is_beyond = measured_m > stated_m * slack;
        zoom->meshes++;
        zoom->beyond += is_beyond;
        if (measured_m > 0) zoom->worst_share = fmax(zoom->worst_share, measured_m / stated_m);
        if (!is_finest) continue;
        if (is_beyond) {
            report_broken(measure->report, PROMISE_STREAM_ERROR,
                          "tile %d/%" PRIu32 "/%" PRIu32 ", rung %d: a post is %.6g m off, the stream says %.6g m",
                          id.zoom, id.x, id.y, header->rungs[i].rung, measured_m, stated_m);
        } else {
            report_held(measure->report, PROMISE_STREAM_ERROR);
        }
    }
    uint32_t last = header->rung_count - 1;
    zoom->coarsest.stated_m = fmax(zoom->coarsest.stated_m, header->rungs[0].max_error_m);
    zoom->coarsest.measured_m = fmax(zoom->coarsest.measured_m, measure->max_m[0]);
    zoom->finest.stated_m = fmax(zoom->finest.stated_m, header->rungs[last].max_error_m);
    zoom->finest.measured_m = fmax(zoom->finest.measured_m, measure->max_m[last]);
}

static bool touches(const struct lattice_window *a, const struct lattice_window *b) {
    return a->x <= b->x + b->columns && b->x <= a->x + a->columns && a->y <= b->y + b->rows && b->y <= a->y + a->rows;
}

/* Where the source is, of which a tile is measured; how many windows. A TIN has its points in cells. */
static int find_windows(const struct measure *measure, struct lattice_window windows[2]) {
    return measure->source.is_tin ? 0 : raster_windows(measure->source.raster, windows);
}

static bool is_covered(const struct measure *measure, const struct lattice_window *tile) {
    struct lattice_window windows[2];
    int window_count = find_windows(measure, windows);
    bool found = measure->source.is_tin && residual_points_touch(&measure->source.points, tile);
    for (int i = 0; i < window_count; i++) found = found || touches(tile, &windows[i]);
    return found && tile->columns > 0;
}

static enum scree_status measure_tile(struct measure *measure, struct tile_id id) {
    struct lattice_window windows[2], tile = lattice_tile_window(&measure->set->info.lattice, id);
    int window_count = find_windows(measure, windows);
    struct scree_error why = {0};
    struct scree_player *player;
    if (!is_covered(measure, &tile)) return SCREE_OK;
    enum scree_status status = stream_set_play(measure->memory, measure->set, id, &player, NULL, &why);
    if (status == SCREE_E_MEMORY) return scree_fail(measure->error, status, "%s", why.text);
    if (status != SCREE_OK) return SCREE_OK;
    const struct scree_stream_header *header = scree_player_header(player);
    bool is_placed = header->columns == tile.columns && header->rows == tile.rows;
    memset(measure->max_m, 0, sizeof measure->max_m);
    if (is_placed && measure->source.is_tin) measure_block(measure, id, player, NULL);
    for (int i = 0; i < window_count && is_placed && status == SCREE_OK; i++)
        if (touches(&tile, &windows[i])) status = measure_window(measure, id, player, &tile, &windows[i]);
    if (status == SCREE_OK && is_placed) book(measure, id, header);
    scree_player_free(player);
    return status;
}

static enum scree_status measure_zooms(struct measure *measure, verify_progress *progress, void *context) {
    const struct stream_set *set = measure->set;
    uint64_t total = 0, done = 0;
    for (int zoom = 0; zoom <= set->info.lattice.finest_zoom; zoom++) total += set->tiles[zoom].count;
    for (int zoom = 0; zoom <= set->info.lattice.finest_zoom; zoom++)
        for (uint32_t i = 0; i < set->tiles[zoom].count; i++) {
            enum scree_status status = measure_tile(measure, set->tiles[zoom].ids[i]);
            if (status != SCREE_OK) return status;
            if (progress != NULL) progress(context, (double)++done / (double)total);
        }
    return SCREE_OK;
}

enum scree_status verify_streams_against(struct scree_memory *memory, const struct stream_set *set,
                                         struct raster_options options, verify_progress *progress, void *context,
                                         struct stream_against *against, struct verify_report *report,
                                         struct scree_error *error) {
    struct measure *measure = scree_allocate(memory, 1, sizeof *measure, "a measure of errors", error);
    const struct verify_built built = {&set->info.lattice, set->info.max_zoom, set->info.bounds};
    enum scree_status status = SCREE_E_MEMORY;
    if (measure == NULL) return SCREE_E_MEMORY;
    *measure = (struct measure){.memory = memory, .set = set, .against = against, .report = report, .error = error};
    against->zooms = scree_allocate(memory, MAX_ZOOM + 1, sizeof *against->zooms, "sums of errors", error);
    measure->scratch = scree_allocate(memory, 1, sizeof *measure->scratch, "sums of errors", error);
    measure->heights_m =
        scree_allocate(memory, (size_t)BLOCK_POSTS * BLOCK_POSTS, sizeof *measure->heights_m, "posts", error);
    if (against->zooms == NULL || measure->scratch == NULL || measure->heights_m == NULL) goto cleanup;
    status = verify_source_open(memory, &options, &built, &measure->source, error);
    measure->finest = verify_source_finest(&measure->source, &built);
    if (status == SCREE_OK) status = measure_zooms(measure, progress, context);
cleanup:
    verify_source_close(&measure->source);
    scree_release(memory, measure->heights_m);
    scree_release(memory, measure->scratch);
    scree_release(memory, measure);
    if (status != SCREE_OK) stream_against_free(memory, against);
    return status;
}

void stream_against_free(struct scree_memory *memory, struct stream_against *against) {
    scree_release(memory, against->zooms);
    *against = (struct stream_against){0};
}
