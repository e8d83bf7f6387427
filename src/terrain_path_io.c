#include "src/terrain_path_io.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* A number without sign or leading zeros and at most `highest`; *text is stepped over it. */
static bool take_number(const char **text, uint32_t highest, uint32_t *number) {
    uint64_t value = 0;
    const char *at = *text;
    for (; *at >= '0' && *at <= '9' && at - *text < 10; at++) value = 10 * value + (uint64_t)(*at - '0');
    if (at == *text || (**text == '0' && at - *text > 1) || value > highest) return false;
    *number = (uint32_t)value;
    *text = at;
    return true;
}

/* Returns what follows, or NULL. */
static const char *take_tile(const char *text, struct tile_id *id) {
    uint32_t zoom;
    if (!take_number(&text, MAX_ZOOM, &zoom) || *text++ != '/') return NULL;
    if (!take_number(&text, UINT32_MAX, &id->x) || *text++ != '/') return NULL;
    if (!take_number(&text, UINT32_MAX, &id->y)) return NULL;
    id->zoom = (int)zoom;
    return text;
}

bool tile_id_parse(const char *text, struct tile_id *id) {
    const char *rest = take_tile(text, id);
    return rest != NULL && *rest == '\0';
}

bool terrain_path_is_tile(const char *path) {
    size_t length = strlen(path), ending = strlen(".terrain");
    return length > ending && strcmp(path + length - ending, ".terrain") == 0;
}

/* Where z/x/y.terrain begins, or NULL. */
static const char *find_tile(const char *path) {
    const char *at = path + strlen(path);
    for (int slashes = 0; at > path; at--) {
        if (at[-1] == '/' && ++slashes == 3) break;
    }
    return at;
}

bool terrain_path_tile(const char *path, struct tile_id *id) {
    const char *rest = take_tile(find_tile(path), id);
    return rest != NULL && strcmp(rest, ".terrain") == 0;
}

bool terrain_path_folder(const char *path, char *folder, size_t size_bytes) {
    char layer[4096];
    struct stat about;
    struct tile_id id;
    size_t length = (size_t)(find_tile(path) - path);
    if (!terrain_path_tile(path, &id) || length + 16 > sizeof layer || length + 2 > size_bytes) return false;
    snprintf(layer, sizeof layer, "%.*slayer.json", (int)length, path);
    if (stat(layer, &about) != 0 || !S_ISREG(about.st_mode)) return false;
    snprintf(folder, size_bytes, "%.*s.", (int)length, path);
    return true;
}
