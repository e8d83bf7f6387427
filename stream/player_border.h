/* The border of a tile that is played: its vertices in order, and the triangles that end on it. Pure. */
#ifndef SCREE_STREAM_PLAYER_BORDER_H
#define SCREE_STREAM_PLAYER_BORDER_H

#include "stream/playback.h"

/* All vertices of a side that have been decoded, in order. */
struct player_side {
    uint32_t count;
    uint64_t *places;   /* place along the side << 32 | vertex, ascending */
    uint32_t *vertices; /* those of the present scale, and their edges' apexes: see struct scree_border */
    uint32_t *apexes;
    uint32_t present;
};

struct player_border {
    struct scree_memory *memory;
    const struct progressive *progressive;
    int32_t columns, rows;
    uint32_t vertices_known;
    unsigned char *on_sides; /* a vertex: bit 1 << side for each side that it is on */
    struct player_side sides[SCREE_SIDES];
    bool current; /* the sides' vertices and apexes are those of the present scale */
};

/* Takes in the vertices that the decoder has appended. False, with what lacked in `error`: what was known still is. */
bool player_border_extend(struct player_border *border, struct scree_error *error);

/* Brings the sides' vertices and apexes up to date. Does not allocate. */
void player_border_update(struct player_border *border, const struct playback *playback);

void player_border_release(struct player_border *border);

static inline uint32_t player_border_vertex(uint64_t place) {
    return (uint32_t)place;
}
static inline uint32_t player_border_place(uint64_t place) {
    return (uint32_t)(place >> 32);
}

#endif
