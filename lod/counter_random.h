/* Numbers that look random and follow from a seed and a counter alone, whatever was asked for before. Pure.
 *
 * SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014) read at any place of its
 * sequence. */
#ifndef SCREE_LOD_COUNTER_RANDOM_H
#define SCREE_LOD_COUNTER_RANDOM_H

#include <stdint.h>

/* 64 bits. */
static inline uint64_t counter_random(uint64_t seed, uint64_t counter) {
    uint64_t bits = seed + (counter + 1) * UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
    return bits ^ bits >> 31;
}

/* A whole number from 0 to limit - 1, each as likely but for one part in 2^32; `limit` at least 1. */
static inline uint32_t counter_random_below(uint64_t seed, uint64_t counter, uint32_t limit) {
    return (uint32_t)((counter_random(seed, counter) >> 32) * limit >> 32);
}

#endif
