#include "stream/layers.h"

#define STEP_BITS_MOST 31

#define LAYER_LEAST 256

uint32_t layer_bound(uint32_t vertices_there) {
    return vertices_there > LAYER_LEAST ? vertices_there : LAYER_LEAST;
}

uint32_t layer_count_code(struct range_coder *coder, uint32_t layers) {
    return code_uniform(coder, LAYERS_MOST, layers - 1) + 1;
}

void base_start_code(struct range_coder *coder, struct base_start *start) {
    start->step_bits = code_uniform(coder, STEP_BITS_MOST, start->step_bits);
    start->layers = code_uniform(coder, LAYERS_MOST, start->layers);
    start->rising = code_uniform(coder, 2, start->rising) != 0;
    int32_t step = 1 << start->step_bits;
    for (int i = 0; i < 4; i++) {
        int64_t steps = (INT64_C(1) << 31) / step; /* heights are from -2^30 to 2^30 */
        uint64_t code =
            code_large_uniform(coder, (uint64_t)steps + 1, (uint64_t)(start->heights[i] / step + steps / 2));
        start->heights[i] = (int32_t)(((int64_t)code - steps / 2) * step);
    }
}
