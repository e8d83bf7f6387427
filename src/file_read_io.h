/* Reading files that have to be small: whole ones, or what they begin with. */
#ifndef SCREE_FILE_READ_IO_H
#define SCREE_FILE_READ_IO_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stddef.h>
#include <stdint.h>

/* The file's bytes in a new block of `memory`, followed by a 0 that is not counted. SCREE_E_IO when it cannot be read,
 * SCREE_E_LIMIT when it is larger than `limit_bytes`; the line names the file. */
enum scree_status file_read_new(struct scree_memory *memory, const char *path, size_t limit_bytes,
                                unsigned char **bytes, size_t *size_bytes, struct scree_error *error);

/* Reads the first bytes of a file, as many as there are up to `capacity_bytes`, and says how large it is. */
enum scree_status file_read_begin(const char *path, void *bytes, size_t capacity_bytes, size_t *size_bytes,
                                  uint64_t *file_bytes, struct scree_error *error);

#endif
