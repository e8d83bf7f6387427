/* What encoder and decoder agree on about blocks: the base mesh as layers of insertions over two triangles. */
#ifndef SCREE_STREAM_LAYERS_H
#define SCREE_STREAM_LAYERS_H

#include "stream/increment.h"

#define LAYERS_MOST 128 /* of a base mesh */

/* How a block of the base begins. */
struct base_start {
    uint32_t step_bits; /* all heights of the stream are multiples of 2^step_bits */
    uint32_t layers;
    bool rising;        /* the diagonal of the two triangles */
    int32_t heights[4]; /* of the corners */
};

/* Codes it; what is in `start` counts only when writing. */
void base_start_code(struct range_coder *coder, struct base_start *start);

#endif
