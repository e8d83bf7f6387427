#include "src/terrain_set_io.h"

#include "src/file_read_io.h"
#include "src/inflate.h"

#include <string.h>

#define TILE_LIMIT_BYTES (256u << 20) /* of a tile's file, and of what it inflates to */

enum scree_status terrain_set_open(struct scree_memory *memory, const char *path, struct terrain_set *set,
                                   struct scree_error *error) {
    char layer_path[PRODUCT_PATH_BYTES];
    memset(set, 0, sizeof *set);
    enum scree_status status = product_find(path, PRODUCT_TERRAIN, set->folder, error);
    if (status != SCREE_OK) return status;
    product_manifest_path(set->folder, PRODUCT_TERRAIN, layer_path);
    status = layer_read(memory, layer_path, &set->layer, error);
    if (status == SCREE_OK) status = product_list_tiles(memory, set->folder, PRODUCT_TERRAIN, set->tiles, error);
    if (status != SCREE_OK) terrain_set_free(memory, set);
    return status;
}

void terrain_set_free(struct scree_memory *memory, struct terrain_set *set) {
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) tile_list_free(memory, &set->tiles[zoom]);
    layer_info_free(memory, &set->layer);
}

enum scree_status terrain_file_read(struct scree_memory *memory, const char *path, struct decoded_tile *tile,
                                    uint64_t *file_bytes, struct scree_error *error) {
    unsigned char *bytes = NULL, *plain = NULL;
    size_t size_bytes = 0, plain_bytes = 0;
    struct scree_error why = {0};
    *tile = (struct decoded_tile){0};
    enum scree_status status = file_read_new(memory, path, TILE_LIMIT_BYTES, &bytes, &size_bytes, error);
    if (status != SCREE_OK) return status;
    if (file_bytes != NULL) *file_bytes = size_bytes;
    if (inflate_is_gzip(bytes, size_bytes)) {
        status = inflate_new(memory, bytes, size_bytes, TILE_LIMIT_BYTES, &plain, &plain_bytes, &why);
        if (status == SCREE_OK) status = decoded_tile_read(memory, plain, plain_bytes, tile, &why);
    } else {
        status = decoded_tile_read(memory, bytes, size_bytes, tile, &why);
    }
    scree_release(memory, plain);
    scree_release(memory, bytes);
    if (status != SCREE_OK) return scree_fail(error, status, "%s: %s", path, why.text);
    return SCREE_OK;
}

enum scree_status terrain_set_read(struct scree_memory *memory, const struct terrain_set *set, struct tile_id id,
                                   struct decoded_tile *tile, uint64_t *file_bytes, struct scree_error *error) {
    char path[PRODUCT_PATH_BYTES];
    product_tile_path(set->folder, PRODUCT_TERRAIN, id, path);
    return terrain_file_read(memory, path, tile, file_bytes, error);
}
