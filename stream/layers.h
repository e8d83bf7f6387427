/* What encoder and decoder agree on about blocks: layers of insertions, the first ones over two triangles. Pure. */
#ifndef SCREE_STREAM_LAYERS_H
#define SCREE_STREAM_LAYERS_H

#include "stream/increment.h"

#define LAYERS_MOST 128 /* of a block */

/* How a block of the base begins. */
struct base_start {
    uint32_t step_bits; /* all heights of the stream are multiples of 2^step_bits */
    uint32_t layers;
    bool rising;        /* the diagonal of the two triangles */
    int32_t heights[4]; /* of the corners */
};

/* An increment that more than doubles a mesh comes in layers too: this many vertices at most in the next one. */
uint32_t layer_bound(uint32_t vertices_there);

/* Codes how many layers a block has (1 .. LAYERS_MOST). */
uint32_t layer_count_code(struct range_coder *coder, uint32_t layers);

/* Codes the start of a base; what is in `start` counts only when writing. */
void base_start_code(struct range_coder *coder, struct base_start *start);

#endif
