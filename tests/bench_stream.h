/* The parts of bench_stream. */
#ifndef SCREE_TESTS_BENCH_STREAM_H
#define SCREE_TESTS_BENCH_STREAM_H

#include <stdbool.h>

/* Builds whole rasters with ./scree and prints the bytes of their streams beside those of their static tiles, both
 * ending at the same rungs. Works in `folder`; false when a build failed. */
bool bench_products(const char *folder, const char *data);

#endif
