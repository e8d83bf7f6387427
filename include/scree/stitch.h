/* Stitching: what a tile draws along its borders so that it meets its neighbours, at whatever scales all of them are.
 *
 * Every edge (a, c) of a tile's border belongs to one of its triangles, (a, c, t). Where a neighbour has further
 * vertices b1 ... bn between a and c, the tile leaves that triangle out and draws the fan (a, b1, t), (b1, b2, t) ...
 * (bn, c, t) instead. Both sides do so: then both draw the vertices of both, and there is no crack, without skirts and
 * whatever the difference of rungs or zooms.
 *
 *     struct scree_stitch_tile tile, beside;      scree_stitch_look(player, &tile) ... once for each drawn tile
 *     neighbours[n] = (struct scree_stitch_neighbour){&beside, SCREE_EAST};   as scree_cut_neighbours finds them
 *     struct scree_stitch_size size = scree_stitch_bound(&tile, neighbours, count);
 *     ... have room for size, in `stitch` ...
 *     scree_stitch_borders(&tile, neighbours, count, first_vertex, &stitch, &error);
 *     draw the tile's triangles but those of stitch.replaced, and stitch.indices
 *
 * Morphing: a border vertex must be where it is for both of its tiles, whatever their levels. So a viewer that stitches
 * takes border vertices (those with x or y at 0 or at columns or rows) at full weight: it sends increment 0 for them.
 * What a border moves within a rung is a share of that rung's tolerance. */
#ifndef SCREE_STITCH_H
#define SCREE_STITCH_H

#include <scree/player.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A tile at its present scale: what the functions below read of it. All arrays are somebody else's. */
struct scree_stitch_tile {
    const struct scree_stream_header *header; /* place and size; its rungs are not looked at */
    const struct scree_vertex *vertices;
    const uint32_t *indices;
    struct scree_border borders[SCREE_SIDES];
};

/* The same from a player, until its next seek or push. SCREE_E_ARGUMENT: its base mesh has not arrived. */
SCREE_API enum scree_status scree_stitch_look(struct scree_player *player, struct scree_stitch_tile *tile,
                                              struct scree_error *error);

struct scree_stitch_neighbour {
    const struct scree_stitch_tile *tile;
    enum scree_side side; /* of the tile that is stitched */
};

struct scree_stitch_size {
    uint32_t replaced, vertices, triangles;
};

/* Where a further vertex comes from: for its normal, say. */
struct scree_stitch_source {
    uint32_t neighbour; /* index into the neighbours given */
    uint32_t vertex;    /* of that neighbour */
};

/* The caller's arrays, and how much of them is used. */
struct scree_stitch {
    struct scree_stitch_size capacity;   /* how much the arrays hold: at least scree_stitch_bound's */
    uint32_t *replaced;                  /* numbers of the tile's triangles that are not to be drawn */
    struct scree_vertex *vertices;       /* further ones, in the tile's own lattice frame, heights in its unit */
    struct scree_stitch_source *sources; /* one for each of them; NULL: not wanted */
    uint32_t *indices;                   /* 3 a triangle, counter-clockwise */
    struct scree_stitch_size count;
};

/* The most that scree_stitch_borders will need. */
SCREE_API struct scree_stitch_size scree_stitch_bound(const struct scree_stitch_tile *tile,
                                                      const struct scree_stitch_neighbour *neighbours, uint32_t count);

/* Stitches a tile to its neighbours. Those of one side are given from west to east or from south to north, the sides in
 * any order. An index below `first_vertex` is a vertex of the tile, others are `first_vertex` + the number of a further
 * one: let it be at least the tile's number of vertices. On failure the counts are 0.
 *
 * SCREE_E_ARGUMENT: a neighbour does not touch that side, its steps or its height unit are others, or neighbours are
 * not in order. SCREE_E_CORRUPT: both have a vertex at the same place, at different heights: the tiles are of different
 * builds. SCREE_E_LIMIT: the arrays are too small. */
SCREE_API enum scree_status scree_stitch_borders(const struct scree_stitch_tile *tile,
                                                 const struct scree_stitch_neighbour *neighbours, uint32_t count,
                                                 uint32_t first_vertex, struct scree_stitch *stitch,
                                                 struct scree_error *error);

#ifdef __cplusplus
}
#endif
#endif
