#include "src/terrain_set_io.h"

#include "src/file_read_io.h"
#include "src/inflate.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define TILE_LIMIT_BYTES (256u << 20) /* of a tile's file, and of what it inflates to */

static enum scree_status find_folder(const char *path, struct terrain_set *set, struct scree_error *error) {
    static const char *const endings[] = {"/layer.json", "/terrain/layer.json", ""};
    char candidate[sizeof set->folder];
    struct stat about;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        int length = snprintf(candidate, sizeof candidate, "%s%s", path, endings[i]);
        if (length < 0 || (size_t)length >= sizeof candidate)
            return scree_fail(error, SCREE_E_ARGUMENT, "%s: the path is too long", path);
        if (stat(candidate, &about) != 0 || !S_ISREG(about.st_mode)) continue;
        char *slash = strrchr(candidate, '/');
        if (slash == NULL) {
            memcpy(set->folder, ".", 2);
        } else {
            *slash = '\0';
            memcpy(set->folder, candidate, strlen(candidate) + 1);
        }
        return SCREE_OK;
    }
    if (stat(path, &about) != 0) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    return scree_fail(error, SCREE_E_IO, "%s: there is no layer.json in it nor in its folder terrain", path);
}

/* A name that is a number without sign or leading zeros, followed by `ending`; -1 for any other. */
static int64_t number_in_name(const char *name, const char *ending) {
    int64_t number = 0;
    const char *at = name;
    for (; *at >= '0' && *at <= '9'; at++) {
        number = 10 * number + (*at - '0');
        if (number > UINT32_MAX || at - name > 10) return -1;
    }
    if (at == name || (name[0] == '0' && at - name > 1) || strcmp(at, ending) != 0) return -1;
    return number;
}

static enum scree_status list_column(struct scree_memory *memory, const char *path, struct tile_id id,
                                     struct tile_list *list, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    DIR *folder = opendir(path);
    if (folder == NULL) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    struct dirent *entry;
    while (status == SCREE_OK && (entry = readdir(folder)) != NULL) {
        int64_t y = number_in_name(entry->d_name, ".terrain");
        if (y < 0) continue;
        id.y = (uint32_t)y;
        status = tile_list_add(memory, list, id, error);
    }
    closedir(folder);
    return status;
}

static enum scree_status list_zoom(struct scree_memory *memory, struct terrain_set *set, int zoom,
                                   struct scree_error *error) {
    char path[sizeof set->folder + 64];
    struct tile_list *list = &set->tiles[zoom];
    enum scree_status status = SCREE_OK;
    snprintf(path, sizeof path, "%s/%d", set->folder, zoom);
    DIR *folder = opendir(path);
    if (folder == NULL && errno == ENOENT) return SCREE_OK;
    if (folder == NULL) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    struct dirent *entry;
    while (status == SCREE_OK && (entry = readdir(folder)) != NULL) {
        int64_t x = number_in_name(entry->d_name, "");
        if (x < 0) continue;
        snprintf(path, sizeof path, "%s/%d/%" PRId64, set->folder, zoom, x);
        struct tile_id id = {.zoom = zoom, .x = (uint32_t)x};
        status = list_column(memory, path, id, list, error);
    }
    closedir(folder);
    tile_list_sort(list);
    return status;
}

enum scree_status terrain_set_open(struct scree_memory *memory, const char *path, struct terrain_set *set,
                                   struct scree_error *error) {
    char layer_path[sizeof set->folder + 16];
    memset(set, 0, sizeof *set);
    enum scree_status status = find_folder(path, set, error);
    if (status != SCREE_OK) return status;
    snprintf(layer_path, sizeof layer_path, "%s/layer.json", set->folder);
    status = layer_read(memory, layer_path, &set->layer, error);
    for (int zoom = 0; zoom <= MAX_ZOOM && status == SCREE_OK; zoom++) status = list_zoom(memory, set, zoom, error);
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
    char path[sizeof set->folder + 64];
    snprintf(path, sizeof path, "%s/%d/%" PRIu32 "/%" PRIu32 ".terrain", set->folder, id.zoom, id.x, id.y);
    return terrain_file_read(memory, path, tile, file_bytes, error);
}
