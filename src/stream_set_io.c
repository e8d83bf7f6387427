#include "src/stream_set_io.h"

#include "src/file_read_io.h"
#include "stream/stream_header.h"

#include <inttypes.h>
#include <string.h>

#define STREAM_LIMIT_BYTES ((size_t)256 << 20) /* of a tile's file */
#define HEADER_LIMIT_BYTES 65536               /* no header is longer */
#define PLAYER_LIMIT_BYTES ((size_t)4 << 30)

enum scree_status stream_set_open(struct scree_memory *memory, const char *path, struct stream_set *set,
                                  struct scree_error *error) {
    char manifest_path[PRODUCT_PATH_BYTES];
    memset(set, 0, sizeof *set);
    enum scree_status status = product_find(path, PRODUCT_STREAM, set->folder, error);
    if (status != SCREE_OK) return status;
    product_manifest_path(set->folder, PRODUCT_STREAM, manifest_path);
    status = scree_read(memory, manifest_path, &set->info, error);
    if (status == SCREE_OK) status = product_list_tiles(memory, set->folder, PRODUCT_STREAM, set->tiles, error);
    if (status != SCREE_OK) stream_set_free(memory, set);
    return status;
}

void stream_set_free(struct scree_memory *memory, struct stream_set *set) {
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) tile_list_free(memory, &set->tiles[zoom]);
    scree_info_free(memory, &set->info);
}

bool stream_path_is_tile(const char *path) {
    size_t length = strlen(path), ending = strlen(".scree");
    return length > ending && strcmp(path + length - ending, ".scree") == 0;
}

enum scree_status stream_file_header(struct scree_memory *memory, const char *path, struct scree_stream_header *header,
                                     uint64_t *file_bytes, struct scree_error *error) {
    size_t size_bytes = 0;
    struct scree_error why = {0};
    unsigned char *bytes = scree_allocate(memory, HEADER_LIMIT_BYTES, 1, "a stream's header", error);
    if (bytes == NULL) return SCREE_E_MEMORY;
    enum scree_status status = file_read_begin(path, bytes, HEADER_LIMIT_BYTES, &size_bytes, file_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    status = stream_header_read(bytes, size_bytes, header, &why);
    if (status == SCREE_MORE) {
        status = scree_fail(error, SCREE_E_CORRUPT, "%s: ends within its header, after %" PRIu64 " bytes", path,
                            *file_bytes);
    } else if (status != SCREE_OK) {
        scree_fail(error, status, "%s: %s", path, why.text);
    }
cleanup:
    scree_release(memory, bytes);
    return status;
}

static uint64_t whole_bytes(const struct scree_stream_header *header) {
    const struct scree_rung *last = &header->rungs[header->rung_count - 1];
    return last->offset_bytes + last->size_bytes;
}

static enum scree_status play(const char *path, const unsigned char *bytes, size_t size_bytes,
                              struct scree_player *player, struct scree_error *error) {
    struct scree_error why = {0};
    enum scree_status status = scree_player_push(player, bytes, size_bytes, &why);
    const struct scree_stream_header *header = scree_player_header(player);
    if (status == SCREE_MORE && header == NULL)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: ends within its header, after %zu bytes", path, size_bytes);
    if (status == SCREE_MORE)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: ends after %zu of %" PRIu64 " bytes, %" PRIu32 " of %" PRIu32 " rungs are whole", path,
                          size_bytes, whole_bytes(header), scree_player_rungs_ready(player), header->rung_count);
    if (status != SCREE_OK) return scree_fail(error, status, "%s: %s", path, why.text);
    return scree_player_seek_rung(player, header->rung_count - 1);
}

enum scree_status stream_file_play(struct scree_memory *memory, const char *path, struct scree_player **player,
                                   uint64_t *file_bytes, struct scree_error *error) {
    const struct scree_player_options options = {.memory_limit_bytes = PLAYER_LIMIT_BYTES, .without_positions = true};
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    *player = NULL;
    enum scree_status status = file_read_new(memory, path, STREAM_LIMIT_BYTES, &bytes, &size_bytes, error);
    if (status != SCREE_OK) return status;
    if (file_bytes != NULL) *file_bytes = size_bytes;
    status = scree_player_new(&options, player, error);
    if (status == SCREE_OK) status = play(path, bytes, size_bytes, *player, error);
    if (status != SCREE_OK) {
        scree_player_free(*player);
        *player = NULL;
    }
    scree_release(memory, bytes);
    return status;
}

enum scree_status stream_set_play_base(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                       struct scree_player **player, struct scree_error *error) {
    char path[PRODUCT_PATH_BYTES];
    const struct scree_player_options options = {.memory_limit_bytes = PLAYER_LIMIT_BYTES, .without_positions = true};
    struct scree_error why = {0};
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    uint64_t file_bytes;
    *player = NULL;
    product_tile_path(set->folder, PRODUCT_STREAM, id, path);
    struct scree_stream_header *header = scree_allocate(memory, 1, sizeof *header, "a stream's header", error);
    if (header == NULL) return SCREE_E_MEMORY;
    enum scree_status status = stream_file_header(memory, path, header, &file_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    uint64_t wanted_bytes = header->rungs[0].offset_bytes + header->rungs[0].size_bytes;
    if (wanted_bytes > STREAM_LIMIT_BYTES || wanted_bytes > file_bytes) {
        status = scree_fail(error, SCREE_E_CORRUPT, "%s: ends within its base mesh, after %" PRIu64 " bytes", path,
                            file_bytes);
        goto cleanup;
    }
    bytes = scree_allocate(memory, (size_t)wanted_bytes, 1, "a stream's base mesh", error);
    status = bytes == NULL ? SCREE_E_MEMORY : scree_player_new(&options, player, error);
    if (status == SCREE_OK)
        status = file_read_begin(path, bytes, (size_t)wanted_bytes, &size_bytes, &file_bytes, error);
    if (status != SCREE_OK) goto cleanup;
    status = scree_player_push(*player, bytes, size_bytes, &why);
    if (status == SCREE_MORE && scree_player_rungs_ready(*player) == 1) status = SCREE_OK;
    if (status != SCREE_OK) status = scree_fail(error, SCREE_E_CORRUPT, "%s: %s", path, why.text);
cleanup:
    if (status != SCREE_OK) {
        scree_player_free(*player);
        *player = NULL;
    }
    scree_release(memory, bytes);
    scree_release(memory, header);
    return status;
}

enum scree_status stream_set_header(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                    struct scree_stream_header *header, uint64_t *file_bytes,
                                    struct scree_error *error) {
    char path[PRODUCT_PATH_BYTES];
    product_tile_path(set->folder, PRODUCT_STREAM, id, path);
    return stream_file_header(memory, path, header, file_bytes, error);
}

enum scree_status stream_set_play(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                  struct scree_player **player, uint64_t *file_bytes, struct scree_error *error) {
    char path[PRODUCT_PATH_BYTES];
    product_tile_path(set->folder, PRODUCT_STREAM, id, path);
    return stream_file_play(memory, path, player, file_bytes, error);
}
