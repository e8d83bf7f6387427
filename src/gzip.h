/* gzip in memory, the same bytes for the same input. Pure. */
#ifndef SCREE_GZIP_H
#define SCREE_GZIP_H

#include <scree/error.h>
#include <stddef.h>

/* `size_bytes` bytes as one gzip member without name or time, in a new malloc'd block that the caller frees. Fails with
 * SCREE_E_MEMORY, or with SCREE_E_LIMIT beyond 2 GiB. */
enum scree_status gzip_new(const void *bytes, size_t size_bytes, unsigned char **gzip, size_t *gzip_bytes,
                           struct scree_error *error);

#endif
