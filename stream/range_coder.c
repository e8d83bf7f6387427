#include "stream/range_coder.h"

#include <math.h>
#include <string.h>

#define CODE_BYTES 4

static void put_byte(struct range_coder *coder, unsigned char byte) {
    if (coder->written_bytes == coder->capacity_bytes) {
        size_t capacity = 2 * coder->capacity_bytes + 256;
        unsigned char *larger = scree_reallocate(coder->memory, coder->written, capacity, 1, "a block", &coder->error);
        if (larger == NULL) return;
        coder->written = larger;
        coder->capacity_bytes = capacity;
    }
    coder->written[coder->written_bytes++] = byte;
}

/* Moves the top byte of `low` out, with the carry that may have come; none comes beyond the first byte. */
static void shift_low(struct range_coder *coder) {
    if (coder->waiting == 0 || coder->low < 0xFF000000U || coder->low > UINT32_MAX) {
        unsigned char carry = (unsigned char)(coder->low >> 32);
        for (; coder->waiting > 0; coder->waiting--) {
            put_byte(coder, (unsigned char)(coder->cache + carry));
            coder->cache = 0xFF;
        }
        coder->cache = (unsigned char)(coder->low >> 24);
    }
    coder->waiting++;
    coder->low = (coder->low & 0x00FFFFFFU) << 8;
}

void range_coder_write(struct scree_memory *memory, struct range_coder *coder) {
    memset(coder, 0, sizeof *coder);
    coder->writing = true;
    coder->memory = memory;
    coder->range = UINT32_MAX;
}

enum scree_status range_coder_finish(struct range_coder *coder, struct scree_error *error) {
    /* the shortest number within the interval: a reader takes what lies beyond the end as zeros */
    uint64_t top = coder->low + coder->range - 1;
    for (int zeros = 32; zeros > 0; zeros -= 8) {
        uint64_t rounded = zeros == 32 ? (top >> 32) << 32 : (top >> zeros) << zeros;
        if (rounded < coder->low) continue;
        coder->low = rounded;
        break;
    }
    for (int i = 0; i <= CODE_BYTES; i++) shift_low(coder);
    for (int i = 0; i < CODE_BYTES && coder->written_bytes > 1 && coder->written[coder->written_bytes - 1] == 0; i++)
        coder->written_bytes--;
    if (coder->error.status == SCREE_OK) return SCREE_OK;
    if (error != NULL && error->status == SCREE_OK) *error = coder->error;
    return coder->error.status;
}

void range_coder_read(const void *bytes, size_t size_bytes, struct range_coder *coder) {
    memset(coder, 0, sizeof *coder);
    coder->range = UINT32_MAX;
    coder->next = bytes;
    coder->end = coder->next + size_bytes;
    for (int i = 0; i < CODE_BYTES; i++) coder->code = coder->code << 8 | range_coder_next(coder);
}

bool range_coder_is_spent(const struct range_coder *coder) {
    return coder->next == coder->end && coder->beyond <= CODE_BYTES;
}

struct bit_model bit_model(int percent) {
    return (struct bit_model){(uint16_t)(percent * BIT_ONE / 100), 0};
}

static inline void normalize(struct range_coder *coder) {
    while (coder->range < RANGE_LEAST) {
        coder->range <<= 8;
        if (coder->writing)
            shift_low(coder);
        else
            coder->code = coder->code << 8 | range_coder_next(coder);
    }
}

const uint16_t bit_pace[BIT_MEMORY + 1] = {
#define P(n)  (uint16_t)(131072 / (2 * (n) + 5))
#define P8(n) P(n), P(n + 1), P(n + 2), P(n + 3), P(n + 4), P(n + 5), P(n + 6), P(n + 7)
    P8(0),  P8(8),  P8(16), P8(24), P8(32), P8(40),  P8(48),  P8(56),
    P8(64), P8(72), P8(80), P8(88), P8(96), P8(104), P8(112), P(120)};

void range_coder_put(struct range_coder *coder, const struct bit_model *model, bool bit) {
    uint32_t share = (coder->range >> 16) * model->one;
    if (coder->cost_bits != NULL)
        *coder->cost_bits -= log2((bit ? model->one : BIT_ONE - model->one) / (double)BIT_ONE);
    coder->low += bit ? 0 : share;
    coder->range = bit ? share : coder->range - share;
    normalize(coder);
}

uint32_t code_ask(const struct range_coder *coder, uint32_t total) {
    uint32_t value = coder->code / (coder->range / total);
    return value < total ? value : total - 1; /* the remainder of the division; no writer uses it */
}

void code_take(struct range_coder *coder, uint32_t total, uint32_t start, uint32_t width) {
    uint32_t share = coder->range / total;
    if (coder->writing)
        coder->low += (uint64_t)start * share;
    else
        coder->code -= start * share;
    coder->range = width * share;
    if (coder->cost_bits != NULL) *coder->cost_bits += log2((double)total / width);
    normalize(coder);
}

uint32_t code_uniform(struct range_coder *coder, uint32_t count, uint32_t value) {
    if (!coder->writing) value = code_ask(coder, count);
    code_take(coder, count, value, 1);
    return value;
}

#define DIGIT_BITS 16

uint64_t code_large_uniform(struct range_coder *coder, uint64_t count, uint64_t value) {
    uint64_t top = count - 1, read = 0;
    bool at_top = true; /* all digits so far are those of the largest value */
    int shift = 0;
    while (top >> shift >> DIGIT_BITS > 0) shift += DIGIT_BITS;
    for (; shift >= 0; shift -= DIGIT_BITS) {
        uint32_t most = (uint32_t)(top >> shift) & (UNIFORM_MOST - 1);
        uint32_t digit = (uint32_t)(value >> shift) & (UNIFORM_MOST - 1);
        digit = code_uniform(coder, at_top ? most + 1 : UNIFORM_MOST, digit);
        at_top = at_top && digit == most;
        read = read << DIGIT_BITS | digit;
    }
    return read;
}
