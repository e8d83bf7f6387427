/* What a viewer draws besides triangles: positions in metres, where vertices morph from, normals. Pure. */
#ifndef SCREE_STREAM_PLAYER_ARRAYS_H
#define SCREE_STREAM_PLAYER_ARRAYS_H

#include "stream/player_border.h"

struct player_arrays {
    struct scree_memory *memory;
    const struct scree_stream_header *header;
    const struct progressive *progressive;
    bool with_positions, with_normals, with_origins;
    struct scree_frame frame;
    uint32_t vertices_known;
    uint16_t *increments;                 /* see struct scree_arrays */
    float *positions, *origins, *normals; /* NULL: not wanted */
    bool current;                         /* the normals are those of the present scale */
};

/* Takes in the vertices of increment `rung` (0: of the base mesh), which the decoder and then the border have taken in.
 * False, with what lacked in `error`: what was known still is. */
bool player_arrays_extend(struct player_arrays *arrays, const struct player_border *border, uint32_t rung,
                          struct scree_error *error);

/* Brings the normals up to date. Does not allocate. */
void player_arrays_update(struct player_arrays *arrays, const struct playback *playback);

void player_arrays_release(struct player_arrays *arrays);

#endif
