/* The bytes of one small stream: for tests that include the decoder of static tiles, whose names for sides are others
 * than those of lod/, which tests/stream_maker.h includes. */
#ifndef SCREE_TESTS_SMALL_STREAM_H
#define SCREE_TESTS_SMALL_STREAM_H

#include "stream/memory.h"

#define SMALL_STREAM_STEPS 128

/* The root tile of a local profile, of fractal terrain, with heights in whole metres: its rungs end with 0, at 1 m.
 * Stops the test program when it cannot be made; to be released with scree_release. */
unsigned char *small_stream_new(struct scree_memory *memory, size_t *size_bytes);

#endif
