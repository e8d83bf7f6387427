/* The files of a product on disk: the folder that holds its manifest, and the tiles z/x/y.<extension> beneath it.
 * Reading only. */
#ifndef SCREE_PRODUCT_FILES_IO_H
#define SCREE_PRODUCT_FILES_IO_H

#include "src/tile_list.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>

#define PRODUCT_FOLDER_BYTES 3072

enum product_kind { PRODUCT_TERRAIN, PRODUCT_STREAM };

/* Finds the folder with the product's manifest (layer.json or scree.json), when `path` is that folder, the one above
 * it, or the manifest itself. SCREE_E_IO with a line when there is none. */
enum scree_status product_find(const char *path, enum product_kind kind, char folder[PRODUCT_FOLDER_BYTES],
                               struct scree_error *error);

/* Whether there is one. */
bool product_is_there(const char *path, enum product_kind kind);

/* The line for a path with neither product; returns SCREE_E_IO. */
enum scree_status product_fail_none(const char *path, struct scree_error *error);

/* The path of a folder's manifest, and of a tile. */
#define PRODUCT_PATH_BYTES (PRODUCT_FOLDER_BYTES + 64)
void product_manifest_path(const char *folder, enum product_kind kind, char path[PRODUCT_PATH_BYTES]);
void product_tile_path(const char *folder, enum product_kind kind, struct tile_id id, char path[PRODUCT_PATH_BYTES]);

/* Lists the tiles that are there, each zoom's sorted. On failure the lists hold what was found so far. */
enum scree_status product_list_tiles(struct scree_memory *memory, const char *folder, enum product_kind kind,
                                     struct tile_list tiles[MAX_ZOOM + 1], struct scree_error *error);

#endif
