#include "src/verify_listed.h"

#include <inttypes.h>

#define TILE       "%d/%" PRIu32 "/%" PRIu32
#define TILE_OF(i) (i).zoom, (i).x, (i).y

/* Books the tiles of a row of a range that are not there: between `from` and `to`, exclusive. */
static void book_missing(const struct verify_listing *listing, int zoom, uint32_t y, uint64_t from, uint64_t to,
                         struct verify_report *report) {
    struct promise_state *state = &report->promises[listing->promise];
    for (; from < to && state->note_count < REPORT_NOTES; from++)
        report_broken(report, listing->promise, "tile " TILE " is listed in %s and is not there", zoom, (uint32_t)from,
                      y, listing->manifest);
    state->checked += to - from;
    state->broken += to - from;
}

/* Marks the tiles of one range that are there, and books the others. Costs as much as there are rows or files. */
static void check_range(const struct verify_listing *listing, int zoom, const struct layer_range *range,
                        uint8_t *listed, struct verify_report *report) {
    const struct tile_list *list = &listing->tiles[zoom];
    struct promise_state *state = &report->promises[listing->promise];
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
            book_missing(listing, zoom, (uint32_t)y, next, list->ids[at].x, report);
            if (listed[at] != 0) {
                report_broken(report, listing->promise, "tile " TILE " is listed twice in %s", TILE_OF(list->ids[at]),
                              listing->manifest);
            } else {
                report_held(report, listing->promise);
            }
            listed[at] = 1;
            next = (uint64_t)list->ids[at].x + 1;
        }
        book_missing(listing, zoom, (uint32_t)y, next, (uint64_t)range->x_last + 1, report);
    }
}

static enum scree_status check_available(struct scree_memory *memory, const struct verify_listing *listing, int zoom,
                                         struct verify_report *report, struct scree_error *error) {
    const struct tile_list *list = &listing->tiles[zoom];
    uint8_t *listed = scree_allocate(memory, list->count, 1, "marks of listed tiles", error);
    if (listed == NULL) return SCREE_E_MEMORY;
    for (uint32_t i = 0; i < listing->available->counts[zoom]; i++)
        check_range(listing, zoom, &listing->available->ranges[zoom][i], listed, report);
    for (uint32_t i = 0; i < list->count; i++)
        if (listed[i] == 0)
            report_broken(report, listing->promise, "tile " TILE " is there and not listed in %s",
                          TILE_OF(list->ids[i]), listing->manifest);
    scree_release(memory, listed);
    return SCREE_OK;
}

enum scree_status verify_listed(struct scree_memory *memory, const struct verify_listing *listing,
                                struct verify_report *report, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (int zoom = 0; zoom <= MAX_ZOOM && status == SCREE_OK; zoom++)
        status = check_available(memory, listing, zoom, report, error);
    return status;
}

void verify_ancestors(const struct tile_list *tiles, enum profile profile, int coarsest, struct verify_report *report) {
    uint32_t roots = profile == PROFILE_GEODETIC ? 2 : 1;
    for (uint32_t x = 0; x < roots && coarsest == 0; x++) {
        struct tile_id root = {.x = x};
        if (tile_list_find(&tiles[0], root) == TILE_NOT_LISTED) {
            report_broken(report, PROMISE_ANCESTORS, "the root tile " TILE " is missing", TILE_OF(root));
        } else {
            report_held(report, PROMISE_ANCESTORS);
        }
    }
    for (int zoom = coarsest + 1; zoom <= MAX_ZOOM; zoom++)
        for (uint32_t i = 0; i < tiles[zoom].count; i++) {
            struct tile_id id = tiles[zoom].ids[i];
            struct tile_id parent = {.zoom = zoom - 1, .x = id.x / 2, .y = id.y / 2};
            if (tile_list_find(&tiles[zoom - 1], parent) == TILE_NOT_LISTED) {
                report_broken(report, PROMISE_ANCESTORS, "tile " TILE " has no parent " TILE, TILE_OF(id),
                              TILE_OF(parent));
            } else {
                report_held(report, PROMISE_ANCESTORS);
            }
        }
}
