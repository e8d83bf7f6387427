/* The tiles of a zoom as a sorted list. Pure. */
#ifndef SCREE_TILE_LIST_H
#define SCREE_TILE_LIST_H

#include "src/lattice.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define TILE_NOT_LISTED UINT32_MAX

struct tile_list { /* sorted by y, then x, once tile_list_sort was called */
    uint32_t count, room;
    struct tile_id *ids;
};

enum scree_status tile_list_add(struct scree_memory *memory, struct tile_list *list, struct tile_id id,
                                struct scree_error *error);
void tile_list_sort(struct tile_list *list);

/* Safe on a zeroed list and twice. */
void tile_list_free(struct scree_memory *memory, struct tile_list *list);

/* Position of a tile in a sorted list, or TILE_NOT_LISTED. */
uint32_t tile_list_find(const struct tile_list *list, struct tile_id id);

/* Position of the first tile that is not before (y, x). */
uint32_t tile_list_from(const struct tile_list *list, uint32_t y, uint32_t x);

#endif
