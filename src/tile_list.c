#include "src/tile_list.h"

#include <stdlib.h>

enum scree_status tile_list_add(struct scree_memory *memory, struct tile_list *list, struct tile_id id,
                                struct scree_error *error) {
    if (list->count == list->room) {
        if (list->room > UINT32_MAX / 4) return scree_fail(error, SCREE_E_LIMIT, "there are too many tiles");
        uint32_t room = list->room == 0 ? 64 : 2 * list->room;
        struct tile_id *grown = scree_reallocate(memory, list->ids, room, sizeof *grown, "the list of tiles", error);
        if (grown == NULL) return SCREE_E_MEMORY;
        list->ids = grown;
        list->room = room;
    }
    list->ids[list->count++] = id;
    return SCREE_OK;
}

static int compare_tiles(const void *left, const void *right) {
    const struct tile_id *a = left, *b = right;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return (a->x > b->x) - (a->x < b->x);
}

void tile_list_sort(struct tile_list *list) {
    if (list->count != 0) qsort(list->ids, list->count, sizeof *list->ids, compare_tiles);
}

void tile_list_free(struct scree_memory *memory, struct tile_list *list) {
    scree_release(memory, list->ids);
    *list = (struct tile_list){0};
}

uint32_t tile_list_from(const struct tile_list *list, uint32_t y, uint32_t x) {
    uint32_t low = 0, high = list->count;
    struct tile_id wanted = {.x = x, .y = y};
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (compare_tiles(&list->ids[middle], &wanted) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

uint32_t tile_list_find(const struct tile_list *list, struct tile_id id) {
    uint32_t at = tile_list_from(list, id.y, id.x);
    if (at < list->count && list->ids[at].x == id.x && list->ids[at].y == id.y) return at;
    return TILE_NOT_LISTED;
}
