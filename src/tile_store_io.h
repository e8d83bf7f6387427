/* Where tiles go: OUT/<product>/z/x/y.<extension>, each written beside and renamed into place, so that a name is
 * either absent or whole, whatever stops the program.
 *
 * That holds for a killed program, not for a power cut: nothing is flushed to the disk tile by tile, which would cost
 * more than the simplification. After a power cut build again. */
#ifndef SCREE_TILE_STORE_IO_H
#define SCREE_TILE_STORE_IO_H

#include "src/lattice.h"
#include <scree/error.h>
#include <stddef.h>

struct tile_store; /* thread-safe: several workers may write different tiles at once */

/* Opens OUT/<product> for writing; makes the folders that lack. Refuses when OUT is a file, cannot be written, or
 * another build holds it (by a lock on the file .scree-lock, which is gone after tile_store_free). Left-over temporary
 * files of a killed build are removed. A build into a folder that holds an earlier build replaces it: the manifest
 * (layer.json or scree.json) is removed here, stale tiles last (tile_store_finish). */
enum scree_status tile_store_open(const char *out, const char *product, const char *extension,
                                  struct tile_store **store, struct scree_error *error);

/* Writes a tile, gzip'd when `compress` (deterministic: no time, no name in the gzip header). `written_bytes` is the
 * file's size; NULL when nobody asks. */
enum scree_status tile_store_write(struct tile_store *store, struct tile_id tile, const void *bytes, size_t size_bytes,
                                   bool compress, size_t *written_bytes, struct scree_error *error);

/* Removes the tiles that an earlier build left and this one did not write (regular files named z/x/y.<extension> and
 * folders that they leave empty, nothing else), then writes the manifest `name`
 * ("layer.json"), which makes the product visible. */
enum scree_status tile_store_finish(struct tile_store *store, const char *name, const char *text,
                                    struct scree_error *error);

/* Safe at any point; without tile_store_finish there is no manifest. */
void tile_store_free(struct tile_store *store);

#endif
