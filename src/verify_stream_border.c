#include "src/verify_stream_border.h"

enum scree_status stream_border_new(struct scree_memory *memory, struct scree_player *player, enum scree_side side,
                                    struct stream_border *border, struct scree_error *error) {
    const struct scree_stream_header *header = scree_player_header(player);
    bool is_upright = side == SCREE_WEST || side == SCREE_EAST;
    struct scree_border view;
    struct scree_arrays arrays;
    *border = (struct stream_border){0};
    scree_player_border(player, side, &view);
    scree_player_look(player, &arrays);
    border->vertices = scree_allocate(memory, view.vertex_count, sizeof *border->vertices, "a border", error);
    border->rungs = scree_allocate(memory, header->rung_count, sizeof *border->rungs, "a border's rungs", error);
    if (border->vertices == NULL || border->rungs == NULL) {
        stream_border_free(memory, border);
        return SCREE_E_MEMORY;
    }
    border->count = view.vertex_count;
    border->rung_count = header->rung_count;
    for (uint32_t i = 0; i < header->rung_count; i++) border->rungs[i] = header->rungs[i].rung;
    for (uint32_t i = 0; i < view.vertex_count; i++) {
        const struct scree_vertex *vertex = &arrays.vertices[view.vertices[i]];
        border->vertices[i] = (struct stream_border_vertex){.at = is_upright ? vertex->y : vertex->x,
                                                            .height = vertex->height,
                                                            .rung = border->rungs[arrays.increments[view.vertices[i]]]};
    }
    return SCREE_OK;
}

void stream_border_free(struct scree_memory *memory, struct stream_border *border) {
    scree_release(memory, border->rungs);
    scree_release(memory, border->vertices);
    *border = (struct stream_border){0};
}

/* Steps over the vertices that are not there yet at a rung. */
static uint32_t next_at(const struct stream_border *border, uint32_t at, int32_t rung) {
    while (at < border->count && border->vertices[at].rung > rung) at++;
    return at;
}

static uint32_t lone_at(const struct stream_border *one, const struct stream_border *other, int32_t rung) {
    uint32_t i = 0, j = 0, lone = 0;
    for (;;) {
        i = next_at(one, i, rung);
        j = next_at(other, j, rung);
        bool has_one = i < one->count, has_other = j < other->count;
        if (!has_one && !has_other) return lone;
        const struct stream_border_vertex *a = &one->vertices[i], *b = &other->vertices[j];
        if (has_one && has_other && a->at == b->at) {
            lone += a->height != b->height;
            i++;
            j++;
        } else {
            lone++;
            if (!has_other || (has_one && a->at < b->at)) {
                i++;
            } else {
                j++;
            }
        }
    }
}

struct stream_border_difference stream_border_compare(const struct stream_border *one,
                                                      const struct stream_border *other) {
    struct stream_border_difference difference = {0};
    for (uint32_t i = 0, j = 0; i < one->rung_count && j < other->rung_count;) {
        if (one->rungs[i] != other->rungs[j]) {
            if (one->rungs[i] < other->rungs[j]) {
                i++;
            } else {
                j++;
            }
            continue;
        }
        difference.rungs++;
        uint32_t lone = difference.lone_vertices == 0 ? lone_at(one, other, one->rungs[i]) : 0;
        if (lone != 0) {
            difference.lone_vertices = lone;
            difference.rung = one->rungs[i];
        }
        i++;
        j++;
    }
    return difference;
}
