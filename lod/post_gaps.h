/* Heights for posts that have none, so that filters need not know of them. Pure. */
#ifndef SCREE_LOD_POST_GAPS_H
#define SCREE_LOD_POST_GAPS_H

#include <stdbool.h>
#include <stdint.h>

/* Replaces heights where is_gap is not 0: on the straight line between the nearest two of the row, as the nearest where
 * one side has none, and as the nearest row (the southern one of two) where a row has none. Returns false, and does
 * nothing, where all posts are gaps. */
bool post_gaps_fill(float *heights_m, const uint8_t *is_gap, int32_t columns, int32_t rows);

#endif
