#include "src/verify_layer.h"

#include <inttypes.h>

#define TILE       "%d/%" PRIu32 "/%" PRIu32
#define TILE_OF(i) (i).zoom, (i).x, (i).y

/* Books the tiles of a row of a range that are not there: between `from` and `to`, exclusive. */
static void book_missing(struct verify_report *report, int zoom, uint32_t y, uint64_t from, uint64_t to) {
    struct promise_state *state = &report->promises[PROMISE_AVAILABLE];
    for (; from < to && state->note_count < REPORT_NOTES; from++)
        report_broken(report, PROMISE_AVAILABLE, "tile " TILE " is listed in layer.json and is not there", zoom,
                      (uint32_t)from, y);
    state->checked += to - from;
    state->broken += to - from;
}

/* Marks the tiles of one range that are there, and books the others. Costs as much as there are rows or files. */
static void check_range(const struct tile_list *list, int zoom, const struct layer_range *range, uint8_t *listed,
                        struct verify_report *report) {
    struct promise_state *state = &report->promises[PROMISE_AVAILABLE];
    uint64_t width = (uint64_t)range->x_last - range->x_first + 1;
    for (uint64_t y = range->y_first; y <= range->y_last; y++) {
        uint32_t at = tile_list_from(list, (uint32_t)y, range->x_first);
        bool row_is_empty = at == list->count || list->ids[at].y != y;
        if (row_is_empty && state->note_count == REPORT_NOTES) { /* nothing to tell: skip to the next row with files */
            uint64_t next_y =
                at == list->count || list->ids[at].y > range->y_last ? (uint64_t)range->y_last + 1 : list->ids[at].y;
            state->checked += width * (next_y - y);
            state->broken += width * (next_y - y);
            y = next_y - 1;
            continue;
        }
        uint64_t next = range->x_first;
        for (; at < list->count && list->ids[at].y == y && list->ids[at].x <= range->x_last; at++) {
            book_missing(report, zoom, (uint32_t)y, next, list->ids[at].x);
            if (listed[at] != 0) {
                report_broken(report, PROMISE_AVAILABLE, "tile " TILE " is listed twice in layer.json",
                              TILE_OF(list->ids[at]));
            } else {
                report_held(report, PROMISE_AVAILABLE);
            }
            listed[at] = 1;
            next = (uint64_t)list->ids[at].x + 1;
        }
        book_missing(report, zoom, (uint32_t)y, next, (uint64_t)range->x_last + 1);
    }
}

static enum scree_status check_available(struct scree_memory *memory, const struct terrain_set *set, int zoom,
                                         struct verify_report *report, struct scree_error *error) {
    const struct tile_list *list = &set->tiles[zoom];
    const struct layer_info *layer = &set->layer;
    uint8_t *listed = scree_allocate(memory, list->count, 1, "marks of listed tiles", error);
    if (listed == NULL) return error->status;
    for (uint32_t i = 0; i < layer->available.counts[zoom]; i++)
        check_range(list, zoom, &layer->available.ranges[zoom][i], listed, report);
    for (uint32_t i = 0; i < list->count; i++)
        if (listed[i] == 0)
            report_broken(report, PROMISE_AVAILABLE, "tile " TILE " is there and not listed in layer.json",
                          TILE_OF(list->ids[i]));
    scree_release(memory, listed);
    return SCREE_OK;
}

/* From the coarsest zoom on that the build was asked for; other producers' terrain from the roots on. */
static void check_ancestors(const struct terrain_set *set, struct verify_report *report) {
    const struct layer_info *layer = &set->layer;
    uint32_t roots = layer->lattice.profile == PROFILE_GEODETIC ? 2 : 1;
    int coarsest = layer->is_ours ? layer->min_zoom : 0;
    for (uint32_t x = 0; x < roots && coarsest == 0; x++) {
        struct tile_id root = {.x = x};
        if (tile_list_find(&set->tiles[0], root) == TILE_NOT_LISTED) {
            report_broken(report, PROMISE_ANCESTORS, "the root tile " TILE " is missing", TILE_OF(root));
        } else {
            report_held(report, PROMISE_ANCESTORS);
        }
    }
    for (int zoom = coarsest + 1; zoom <= MAX_ZOOM; zoom++)
        for (uint32_t i = 0; i < set->tiles[zoom].count; i++) {
            struct tile_id id = set->tiles[zoom].ids[i];
            struct tile_id parent = {.zoom = zoom - 1, .x = id.x / 2, .y = id.y / 2};
            if (tile_list_find(&set->tiles[zoom - 1], parent) == TILE_NOT_LISTED) {
                report_broken(report, PROMISE_ANCESTORS, "tile " TILE " has no parent " TILE, TILE_OF(id),
                              TILE_OF(parent));
            } else {
                report_held(report, PROMISE_ANCESTORS);
            }
        }
}

static void check_zooms(const struct terrain_set *set, struct verify_report *report) {
    const struct layer_info *layer = &set->layer;
    int deepest = 0;
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++)
        if (set->tiles[zoom].count != 0) deepest = zoom;
    if (layer->complaint[0] != '\0') {
        report_broken(report, PROMISE_LAYER, "layer.json lacks: %s", layer->complaint);
    } else if (layer->max_zoom < deepest) {
        report_broken(report, PROMISE_LAYER, "maxzoom %d hides the tiles of zoom %d", layer->max_zoom, deepest);
    } else {
        report_held(report, PROMISE_LAYER);
    }
}

enum scree_status verify_layer_tiles(struct scree_memory *memory, const struct terrain_set *set,
                                     struct verify_report *report, struct scree_error *error) {
    check_zooms(set, report);
    check_ancestors(set, report);
    for (int zoom = 0; zoom <= MAX_ZOOM && set->layer.has_available; zoom++) {
        enum scree_status status = check_available(memory, set, zoom, report, error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}

static void check_count(struct verify_report *report, int zoom, const char *what, uint64_t told, uint64_t found) {
    if (told == found) {
        report_held(report, PROMISE_COUNTS);
    } else {
        report_broken(report, PROMISE_COUNTS, "zoom %d: layer.json counts %" PRIu64 " %s, the files have %" PRIu64,
                      zoom, told, what, found);
    }
}

static void check_step(struct verify_report *report, int zoom, const char *what, double coarse, double fine) {
    if (fine <= coarse) { /* false for what is no number */
        report_held(report, PROMISE_LADDER);
    } else {
        report_broken(report, PROMISE_LADDER, "zoom %d: %s is %g m, and %g m a zoom above", zoom, what, fine, coarse);
    }
}

void verify_layer_counts(const struct layer_info *layer, struct verify_report *report) {
    if (!layer->is_ours) return;
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom_info *told = &layer->zooms[zoom];
        const struct zoom_count *found = &report->zooms[zoom];
        if (!told->is_told) {
            report_broken(report, PROMISE_COUNTS, "zoom %d: layer.json says nothing of it", zoom);
            continue;
        }
        check_count(report, zoom, "tiles", told->tiles, found->tiles);
        check_count(report, zoom, "vertices", told->vertices, found->vertices);
        check_count(report, zoom, "triangles", told->triangles, found->triangles);
        check_count(report, zoom, "bytes", told->bytes, found->bytes);
        if (zoom == 0 || !layer->zooms[zoom - 1].is_told || found->tiles == 0 || report->zooms[zoom - 1].tiles == 0)
            continue;
        check_step(report, zoom, "the tolerance", layer->zooms[zoom - 1].tolerance_m, told->tolerance_m);
        check_step(report, zoom, "the SVO", layer->zooms[zoom - 1].svo_m, told->svo_m);
    }
}
