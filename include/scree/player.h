/* Playing a stream: bytes in as they arrive, plain arrays out, at any scale, up and down.
 *
 *     struct scree_player *player;
 *     scree_player_new(NULL, &player, &error);
 *     while (bytes arrive)
 *         if (scree_player_push(player, bytes, size_bytes, &error) < 0) ... error.text says why
 *     scree_player_seek_svo(player, 2.5);                        as soon as there is something to see
 *     scree_player_look(player, &arrays);                        draw arrays.indices
 *     while (scree_player_dirty_slots(player, &range)) ...       send what has changed to the graphics card
 *     scree_player_free(player);
 *
 * A tile at any scale is a prefix of its vertices and a prefix of its triangles. Vertices stay as they are once they
 * have arrived; triangles change corners when the scale changes. So a viewer sends every vertex once, and then the
 * indices that change.
 *
 * A player belongs to one thread at a time; different players have nothing in common. It holds no file, thread, clock
 * or graphics. Seeking does not allocate; pushing may, and may move the arrays: look again after a push. */
#ifndef SCREE_PLAYER_H
#define SCREE_PLAYER_H

#include <scree/stream.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SCREE_PLAYER_MEMORY_BYTES ((size_t)256 << 20)

/* Zeros are the defaults. */
struct scree_player_options {
    size_t memory_limit_bytes; /* of all that the player holds; 0: SCREE_PLAYER_MEMORY_BYTES */
    bool without_positions;    /* no positions in metres: 12 bytes a vertex less */
    bool without_normals;      /* another 12; implied by without_positions */
    bool without_origins;      /* another 12; implied by without_positions */
};

struct scree_player;

/* `options` may be NULL. SCREE_E_MEMORY, SCREE_E_LIMIT. */
SCREE_API enum scree_status scree_player_new(const struct scree_player_options *options, struct scree_player **player,
                                             struct scree_error *error);
SCREE_API void scree_player_free(struct scree_player *player); /* NULL is fine */

/* Takes the next bytes of the stream, as many as there happen to be; how they are cut makes no difference. What they
 * complete is decoded at once and can be sought; the scale shown does not change, but that the first mesh is shown when
 * it is there. SCREE_OK: the stream is complete. SCREE_MORE: it goes on. Else it failed (SCREE_E_CORRUPT,
 * SCREE_E_UNSUPPORTED, SCREE_E_LIMIT, SCREE_E_MEMORY), with the byte of the stream in `error` where it is known: the
 * player takes no more bytes and says so again, but goes on playing what it had. Bytes beyond the end are corrupt. */
SCREE_API enum scree_status scree_player_push(struct scree_player *player, const void *bytes, size_t size_bytes,
                                              struct scree_error *error);

/* NULL until the header has arrived; the player's. */
SCREE_API const struct scree_stream_header *scree_player_header(const struct scree_player *player);

/* How many of the header's rungs can be sought by now. */
SCREE_API uint32_t scree_player_rungs_ready(const struct scree_player *player);

/* Changes the scale. All of these go as fine as what has arrived allows and answer SCREE_MORE when more was wanted;
 * beyond the finest there is the finest, with SCREE_OK. No index slot is written more than once, however far it goes.
 *
 * `rung` is an index into the header's rungs. A level between two of them shows the finer one's triangles with the
 * increment's vertices on their way: see the arrays' level. Splits are vertices added to the base mesh, one by one
 * from coarse to fine, in an order in which each is worth seeing. SVO and max error are those of the header: the
 * coarsest rung that is good enough. SCREE_E_ARGUMENT: not a number. */
SCREE_API enum scree_status scree_player_seek_rung(struct scree_player *player, uint32_t rung);
SCREE_API enum scree_status scree_player_seek_level(struct scree_player *player, double level);
SCREE_API enum scree_status scree_player_seek_splits(struct scree_player *player, uint32_t splits);
SCREE_API enum scree_status scree_player_seek_svo(struct scree_player *player, double svo_m);
SCREE_API enum scree_status scree_player_seek_error(struct scree_player *player, double max_error_m);

/* The mesh at the present scale. Arrays are the player's; they have their contents until the next seek (indices,
 * normals) and their place until the next push. */
struct scree_arrays {
    uint32_t vertex_count, triangle_count;
    uint32_t splits;                     /* how many of the stream's vertices beyond the base mesh are there */
    const uint32_t *indices;             /* 3 a triangle, counter-clockwise seen from above */
    const struct scree_vertex *vertices; /* on the lattice, heights in units of 2^height_exponent m */
    const uint16_t *increments;          /* a vertex: index of the header's rung that it came with; the base's: 0 */
    const float *positions;              /* 3 a vertex: metres in the tile's frame (scree_stream_frame); or NULL */
    const float *normals;                /* 3 a vertex: unit vectors of the mesh at this scale, unmorphed; or NULL */
    const float *origins;                /* 3 a vertex: where it morphs from, on the mesh of the rung before; or NULL */
    double level;                        /* where vertices are between origin and position: scree_morph_weight */
};

SCREE_API void scree_player_look(struct scree_player *player, struct scree_arrays *arrays);

/* A vertex is drawn at origin + weight (position - origin). The weight is a function of one number for the whole tile
 * and of one for each vertex, so a vertex shader computes it: clamp(level + 1 - increment, 0, 1).
 *
 * A vertex inside the tile comes out of the vertex that it was split from; one on the border out of the straight edge
 * that the rung before has at its place, so that two tiles at the same level meet whatever their parents. */
static inline double scree_morph_weight(double level, uint16_t increment) {
    double weight = level + 1 - increment;
    return weight < 0 ? 0 : weight > 1 ? 1 : weight;
}

/* What has changed since it was last asked for. Everything outside of the ranges, up to the present counts, is as it
 * was. Normals change with the indices. */
struct scree_range {
    uint32_t first, end; /* from the first to before the end */
};

/* Vertices (all of their arrays but normals) that were not there before: those shown for the first time. */
SCREE_API struct scree_range scree_player_dirty_vertices(struct scree_player *player);

/* The next range of index slots, ascending; false when there is none left. A seek starts the ranges anew. */
SCREE_API bool scree_player_dirty_slots(struct scree_player *player, struct scree_range *slots);

/* Calls everything dirty: a viewer has lost its buffers. */
SCREE_API void scree_player_dirty_all(struct scree_player *player);

/* The border of the tile at the present scale: what a neighbour has to meet (scree/stitch.h). */
enum scree_side { SCREE_SOUTH, SCREE_EAST, SCREE_NORTH, SCREE_WEST };
#define SCREE_SIDES 4

struct scree_border {
    uint32_t vertex_count;    /* at least 2 */
    const uint32_t *vertices; /* corners of the tile included: from west to east, or from south to north */
    const uint32_t *apexes;   /* vertex_count - 1: edge i joins vertices i and i + 1; indices[apexes[i]] is the third
                                 corner of the one triangle that it belongs to, number apexes[i] / 3 */
};

/* The player's arrays, until the next seek or push; made when first asked for at a scale, without allocating.
 * vertex_count 0: nothing has arrived. */
SCREE_API void scree_player_border(struct scree_player *player, enum scree_side side, struct scree_border *border);

#ifdef __cplusplus
}
#endif
#endif
