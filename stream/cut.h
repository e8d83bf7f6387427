/* Places on the Z curve, on which the tiles of a quadtree lie in the order of its leaves. Pure. */
#ifndef SCREE_STREAM_CUT_H
#define SCREE_STREAM_CUT_H

#include <scree/cut.h>

/* The bits of x and y by turns, those of x below. */
static inline uint64_t cut_interleave(uint32_t x, uint32_t y) {
    uint64_t spread[2] = {x, y};
    for (int i = 0; i < 2; i++) {
        spread[i] = (spread[i] | spread[i] << 16) & 0x0000ffff0000ffffu;
        spread[i] = (spread[i] | spread[i] << 8) & 0x00ff00ff00ff00ffu;
        spread[i] = (spread[i] | spread[i] << 4) & 0x0f0f0f0f0f0f0f0fu;
        spread[i] = (spread[i] | spread[i] << 2) & 0x3333333333333333u;
        spread[i] = (spread[i] | spread[i] << 1) & 0x5555555555555555u;
    }
    return spread[0] | spread[1] << 1;
}

/* The place of a tile among those of its zoom. */
static inline uint64_t cut_place(const struct scree_tile_id *tile) {
    return cut_interleave(tile->x, tile->y);
}

/* Where its cells of SCREE_MAX_ZOOM begin. */
static inline uint64_t cut_first_cell(const struct scree_tile_id *tile) {
    return cut_place(tile) << 2 * (SCREE_MAX_ZOOM - tile->zoom);
}

static inline uint64_t cut_last_cell(const struct scree_tile_id *tile) {
    return cut_first_cell(tile) + (((uint64_t)1 << 2 * (SCREE_MAX_ZOOM - tile->zoom)) - 1);
}

#endif
