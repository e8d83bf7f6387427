/* An adaptive binary range coder: symbols of less than a bit where the model is sure. Pure.
 *
 * One coder both writes and reads, so that the model is one piece of code: it is asked with the symbol at hand when
 * writing and gives the symbol back when reading.
 *
 *     bit = code_bit(&coder, &model, bit);
 *
 * Interval arithmetic with carries after Martin 1979, in the byte-wise form of Subbotin and Pavlov (LZMA). */
#ifndef SCREE_STREAM_RANGE_CODER_H
#define SCREE_STREAM_RANGE_CODER_H

#include "stream/memory.h"
#include <stdbool.h>
#include <stdint.h>

#define BIT_ONE      65536 /* certainty */
#define BIT_LEAST    32    /* no bit is surer than this share of BIT_ONE */
#define BIT_MEMORY   120   /* a model averages over so many bits at the most */
#define UNIFORM_MOST 65536 /* the largest range of a uniform symbol */
#define RANGE_LEAST  (1U << 24)

struct bit_model {
    uint16_t one;  /* probability of a 1, in 1 / BIT_ONE */
    uint16_t seen; /* bits so far, up to BIT_MEMORY */
};

struct range_coder {
    bool writing;
    uint32_t range;
    /* writing */
    struct scree_memory *memory;
    unsigned char *written;
    size_t written_bytes, capacity_bytes;
    uint64_t low;
    uint64_t waiting; /* bytes of 0xFF that a carry may still turn, and the byte before them */
    unsigned char cache;
    struct scree_error error; /* no memory: what follows is dropped */
    double *cost_bits;        /* gets the cost of each symbol; NULL: nobody asks */
    /* reading */
    uint32_t code;
    const unsigned char *next, *end;
    uint32_t beyond; /* bytes read beyond the end, as zeros */
};

void range_coder_write(struct scree_memory *memory, struct range_coder *coder);

/* Ends the block; its bytes are `written`, which the caller releases. */
enum scree_status range_coder_finish(struct range_coder *coder, struct scree_error *error);

void range_coder_read(const void *bytes, size_t size_bytes, struct range_coder *coder);

/* Whether all bytes, and none that are not there, have been used. */
bool range_coder_is_spent(const struct range_coder *coder);

static inline uint32_t range_coder_next(struct range_coder *coder) {
    if (coder->next < coder->end) return *coder->next++;
    coder->beyond++;
    return 0;
}

/* A model that starts with this probability of a 1, in percent. */
struct bit_model bit_model(int percent);

/* 65536 / (n + 2.5): how much the bit after n others counts. */
extern const uint16_t bit_pace[BIT_MEMORY + 1];

/* Takes the part of the interval that has been chosen, when writing. */
void range_coder_put(struct range_coder *coder, const struct bit_model *model, bool bit);

static inline void bit_learn(struct bit_model *model, bool bit) {
    int32_t error = (bit ? BIT_ONE - BIT_LEAST : BIT_LEAST) - (int32_t)model->one;
    model->one = (uint16_t)(model->one + error * (int32_t)bit_pace[model->seen] / 65536);
    if (model->seen < BIT_MEMORY) model->seen++;
}

/* Lets what comes overrule what has been learned: it counts as `memory` bits at the most. */
static inline void bit_hurry(struct bit_model *model, uint16_t memory) {
    if (model->seen > memory) model->seen = memory;
}

/* One bit; `bit` is looked at only when writing. */
static inline bool code_bit(struct range_coder *coder, struct bit_model *model, bool bit) {
    if (coder->writing) {
        range_coder_put(coder, model, bit);
    } else {
        uint32_t share = (coder->range >> 16) * model->one;
        bit = coder->code < share;
        coder->code -= bit ? 0 : share;
        coder->range = bit ? share : coder->range - share;
        while (coder->range < RANGE_LEAST) {
            coder->range <<= 8;
            coder->code = coder->code << 8 | range_coder_next(coder);
        }
    }
    bit_learn(model, bit);
    return bit;
}

/* A number from 0 to below `count` (1 .. UNIFORM_MOST), all alike. */
uint32_t code_uniform(struct range_coder *coder, uint32_t count, uint32_t value);

/* The same for any count up to 2^62, in digits of 16 bits: of those, the first is a little dearer than it has to be. */
uint64_t code_large_uniform(struct range_coder *coder, uint64_t count, uint64_t value);

/* A symbol that has `width` of `total` (at most UNIFORM_MOST) parts, from `start` on. A reader first asks which part it
 * is, finds the symbol, and takes it. */
uint32_t code_ask(const struct range_coder *coder, uint32_t total);
void code_take(struct range_coder *coder, uint32_t total, uint32_t start, uint32_t width);

#endif
