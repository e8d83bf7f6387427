/* The borders of streams, and whether two neighbours have the same one at every rung that both have. Pure. */
#ifndef SCREE_VERIFY_STREAM_BORDER_H
#define SCREE_VERIFY_STREAM_BORDER_H

#include "stream/memory.h"
#include <scree/error.h>
#include <scree/player.h>

struct stream_border_vertex {
    int32_t at; /* lattice steps along the border */
    int32_t height;
    int32_t rung; /* with which it comes */
};

struct stream_border {
    uint32_t count, rung_count;
    struct stream_border_vertex *vertices; /* from west to east, or from south to north */
    int32_t *rungs;                        /* that the tile has, ascending */
};

/* The border of a side at all rungs; the stream has arrived as a whole and is at its finest rung. */
enum scree_status stream_border_new(struct scree_memory *memory, struct scree_player *player, enum scree_side side,
                                    struct stream_border *border, struct scree_error *error);

/* Safe on a zeroed border and twice. */
void stream_border_free(struct scree_memory *memory, struct stream_border *border);

struct stream_border_difference {
    uint32_t rungs;         /* that both have */
    uint32_t lone_vertices; /* of the first of them at which the two differ: on one side only, or at other heights */
    int32_t rung;           /* which that is, when lone_vertices is not 0 */
};

struct stream_border_difference stream_border_compare(const struct stream_border *one,
                                                      const struct stream_border *other);

#endif
