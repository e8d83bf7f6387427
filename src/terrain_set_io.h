/* A terrain product on disk, as any producer leaves it: layer.json and z/x/y.terrain. Reading only. */
#ifndef SCREE_TERRAIN_SET_IO_H
#define SCREE_TERRAIN_SET_IO_H

#include "src/lattice.h"
#include "src/layer_read_io.h"
#include "src/product_files_io.h"
#include "src/quantized_mesh_decode.h"
#include "src/tile_list.h"
#include "stream/memory.h"
#include <scree/error.h>

struct terrain_set {
    char folder[PRODUCT_FOLDER_BYTES]; /* that holds layer.json */
    struct layer_info layer;
    struct tile_list tiles[MAX_ZOOM + 1]; /* the files that are there */
};

/* Opens OUT, OUT/terrain or the path of a layer.json, and lists the files. */
enum scree_status terrain_set_open(struct scree_memory *memory, const char *path, struct terrain_set *set,
                                   struct scree_error *error);

/* Safe on a zeroed set and twice. */
void terrain_set_free(struct scree_memory *memory, struct terrain_set *set);

/* Reads and decodes a tile; `file_bytes` (may be NULL) is its size on disk. Errors name the file. */
enum scree_status terrain_set_read(struct scree_memory *memory, const struct terrain_set *set, struct tile_id id,
                                   struct decoded_tile *tile, uint64_t *file_bytes, struct scree_error *error);

/* The same for any .terrain file, plain or gzip'd. */
enum scree_status terrain_file_read(struct scree_memory *memory, const char *path, struct decoded_tile *tile,
                                    uint64_t *file_bytes, struct scree_error *error);

#endif
