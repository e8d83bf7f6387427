#include "src/product_files_io.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const struct {
    const char *folder, *manifest, *ending;
} names[] = {
    [PRODUCT_TERRAIN] = {"terrain", "layer.json", ".terrain"},
    [PRODUCT_STREAM] = {"stream", "scree.json", ".scree"},
};

static bool is_file(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

/* Is the last part of the path this name? */
static bool ends_in(const char *path, const char *name) {
    const char *slash = strrchr(path, '/');
    return strcmp(slash == NULL ? path : slash + 1, name) == 0;
}

/* The manifest's path, or false when the path is no place for one. */
static bool find_manifest(const char *path, enum product_kind kind, char candidate[PRODUCT_FOLDER_BYTES]) {
    const char *manifest = names[kind].manifest;
    if (strlen(path) + 32 > PRODUCT_FOLDER_BYTES) return false;
    snprintf(candidate, PRODUCT_FOLDER_BYTES, "%s/%s", path, manifest);
    if (is_file(candidate)) return true;
    snprintf(candidate, PRODUCT_FOLDER_BYTES, "%s/%s/%s", path, names[kind].folder, manifest);
    if (is_file(candidate)) return true;
    snprintf(candidate, PRODUCT_FOLDER_BYTES, "%s", path);
    return ends_in(path, manifest) && is_file(path);
}

bool product_is_there(const char *path, enum product_kind kind) {
    char candidate[PRODUCT_FOLDER_BYTES];
    return find_manifest(path, kind, candidate);
}

enum scree_status product_find(const char *path, enum product_kind kind, char folder[PRODUCT_FOLDER_BYTES],
                               struct scree_error *error) {
    struct stat about;
    if (!find_manifest(path, kind, folder)) {
        if (stat(path, &about) != 0) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
        return scree_fail(error, SCREE_E_IO, "%s: there is no %s in it nor in its folder %s", path,
                          names[kind].manifest, names[kind].folder);
    }
    char *slash = strrchr(folder, '/');
    if (slash == NULL) {
        memcpy(folder, ".", 2);
    } else {
        slash[slash == folder] = '\0'; /* of the file system's root the slash stays */
    }
    return SCREE_OK;
}

enum scree_status product_fail_none(const char *path, struct scree_error *error) {
    struct stat about;
    if (stat(path, &about) != 0) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    return scree_fail(error, SCREE_E_IO,
                      "%s: there are neither static tiles (layer.json) nor streams (scree.json) in it; name the folder "
                      "that scree build wrote to",
                      path);
}

void product_manifest_path(const char *folder, enum product_kind kind, char path[PRODUCT_PATH_BYTES]) {
    snprintf(path, PRODUCT_PATH_BYTES, "%s/%s", folder, names[kind].manifest);
}

void product_tile_path(const char *folder, enum product_kind kind, struct tile_id id, char path[PRODUCT_PATH_BYTES]) {
    snprintf(path, PRODUCT_PATH_BYTES, "%s/%d/%" PRIu32 "/%" PRIu32 "%s", folder, id.zoom, id.x, id.y,
             names[kind].ending);
}

/* ---- which tiles there are ---- */

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

static enum scree_status list_column(struct scree_memory *memory, const char *path, const char *ending,
                                     struct tile_id id, struct tile_list *list, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    DIR *folder = opendir(path);
    if (folder == NULL) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    struct dirent *entry;
    while (status == SCREE_OK && (entry = readdir(folder)) != NULL) {
        int64_t y = number_in_name(entry->d_name, ending);
        if (y < 0) continue;
        id.y = (uint32_t)y;
        status = tile_list_add(memory, list, id, error);
    }
    closedir(folder);
    return status;
}

static enum scree_status list_zoom(struct scree_memory *memory, const char *folder_path, const char *ending, int zoom,
                                   struct tile_list *list, struct scree_error *error) {
    char path[PRODUCT_PATH_BYTES];
    enum scree_status status = SCREE_OK;
    snprintf(path, sizeof path, "%s/%d", folder_path, zoom);
    DIR *folder = opendir(path);
    if (folder == NULL && errno == ENOENT) return SCREE_OK;
    if (folder == NULL) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    struct dirent *entry;
    while (status == SCREE_OK && (entry = readdir(folder)) != NULL) {
        int64_t x = number_in_name(entry->d_name, "");
        if (x < 0) continue;
        snprintf(path, sizeof path, "%s/%d/%" PRId64, folder_path, zoom, x);
        struct tile_id id = {.zoom = zoom, .x = (uint32_t)x};
        status = list_column(memory, path, ending, id, list, error);
    }
    closedir(folder);
    tile_list_sort(list);
    return status;
}

enum scree_status product_list_tiles(struct scree_memory *memory, const char *folder, enum product_kind kind,
                                     struct tile_list tiles[MAX_ZOOM + 1], struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (int zoom = 0; zoom <= MAX_ZOOM && status == SCREE_OK; zoom++)
        status = list_zoom(memory, folder, names[kind].ending, zoom, &tiles[zoom], error);
    return status;
}
