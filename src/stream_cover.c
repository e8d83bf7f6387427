#include "src/stream_cover.h"

struct tile_id stream_child(struct tile_id id, int child) {
    return (struct tile_id){id.zoom + 1, 2 * id.x + (uint32_t)(child % 2), 2 * id.y + (uint32_t)(child / 2)};
}

static enum scree_status add(struct scree_memory *memory, struct stream_cover *cover, struct stream_piece piece,
                             struct scree_error *error) {
    if (cover->count == cover->room) {
        uint32_t room = cover->room == 0 ? 64 : 2 * cover->room;
        struct stream_piece *grown =
            scree_reallocate(memory, cover->pieces, room, sizeof *grown, "the tiles to show", error);
        if (grown == NULL) return SCREE_E_MEMORY;
        cover->pieces = grown;
        cover->room = room;
    }
    cover->pieces[cover->count++] = piece;
    return SCREE_OK;
}

/* What of a tile has no finer file: all of it, or the quarters that have none. */
static enum scree_status add_rest(struct scree_memory *memory, const struct lattice *lattice,
                                  const struct tile_list *children, struct tile_id id, struct stream_cover *cover,
                                  struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct stream_piece quarters[4];
    int count = 0, listed = 0;
    for (int child = 0; child < 4; child++) {
        struct tile_id child_id = stream_child(id, child);
        struct stream_piece quarter = {id, true, lattice_tile_window(lattice, child_id)};
        bool is_listed = tile_list_find(children, child_id) != TILE_NOT_LISTED;
        listed += is_listed;
        if (quarter.window.columns > 0 && !is_listed) quarters[count++] = quarter;
    }
    if (listed == 0)
        return add(memory, cover, (struct stream_piece){id, true, lattice_tile_window(lattice, id)}, error);
    for (int i = 0; i < count && status == SCREE_OK; i++) status = add(memory, cover, quarters[i], error);
    return status;
}

enum scree_status stream_cover_new(struct scree_memory *memory, const struct lattice *lattice,
                                   const struct tile_list tiles[MAX_ZOOM + 1], int min_zoom, int zoom,
                                   struct stream_cover *cover, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    *cover = (struct stream_cover){0};
    for (uint32_t i = 0; i < tiles[zoom].count && status == SCREE_OK; i++) {
        struct tile_id id = tiles[zoom].ids[i];
        status = add(memory, cover, (struct stream_piece){id, false, lattice_tile_window(lattice, id)}, error);
    }
    for (int coarser = zoom - 1; coarser >= min_zoom && status == SCREE_OK; coarser--)
        for (uint32_t i = 0; i < tiles[coarser].count && status == SCREE_OK; i++)
            status = add_rest(memory, lattice, &tiles[coarser + 1], tiles[coarser].ids[i], cover, error);
    return status;
}

void stream_cover_free(struct scree_memory *memory, struct stream_cover *cover) {
    scree_release(memory, cover->pieces);
    *cover = (struct stream_cover){0};
}
