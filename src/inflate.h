/* gzip'd bytes made plain, within a bound: a small file may claim to be a huge one. Pure. */
#ifndef SCREE_INFLATE_H
#define SCREE_INFLATE_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stddef.h>

/* Whether the bytes begin as gzip does. */
bool inflate_is_gzip(const unsigned char *bytes, size_t size_bytes);

/* What one gzip member that fills `bytes` exactly holds, in a new block of `memory`. SCREE_E_CORRUPT when it is cut,
 * damaged or followed by more; SCREE_E_LIMIT when it holds more than `limit_bytes`. On failure nothing is left. */
enum scree_status inflate_new(struct scree_memory *memory, const unsigned char *bytes, size_t size_bytes,
                              size_t limit_bytes, unsigned char **plain, size_t *plain_bytes,
                              struct scree_error *error);

#endif
