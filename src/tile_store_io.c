/* The folder of a product and its tiles (src/tile_store_io.h). */
#include "src/tile_store_io.h"

#include "src/file_io.h"
#include "src/gzip.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define LOCK_NAME      ".scree-lock"
#define NAME_ROOM      64 /* "22/8388607/4194303.terrain" and temporary names */
#define EXTENSION_ROOM 16
#define LOCK_TRIES     100 /* how often another program may finish between our open and our lock */

static const char *const manifests[] = {"layer.json", "scree.json"};

struct tile_store {
    char *folder; /* OUT/<product>, for messages */
    char extension[EXTENSION_ROOM];
    int folder_file, lock_file; /* -1: not open */
    pthread_mutex_t mutex;      /* guards all that follows */
    uint64_t *written;          /* tile keys, in the order of writing */
    size_t written_count, written_room;
    unsigned long temporary_count;
};

static enum scree_status fail(const struct tile_store *store, const char *what, const char *name, int code,
                              struct scree_error *error) {
    char path[480];
    snprintf(path, sizeof path, "%s/%s", store->folder, name);
    return file_fail(error, what, path, code);
}

/* ---- opening ---- */

/* The lock file is removed by its holder, so what was locked may have lost its name meanwhile: then once more. */
static enum scree_status take_lock(struct tile_store *store, struct scree_error *error) {
    for (int i = 0; i < LOCK_TRIES; i++) {
        int file = openat(store->folder_file, LOCK_NAME, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (file < 0) return fail(store, "write", LOCK_NAME, errno, error);
        struct stat held, named;
        if (flock(file, LOCK_EX | LOCK_NB) != 0) {
            int code = errno;
            close(file);
            if (code != EWOULDBLOCK) return fail(store, "lock", LOCK_NAME, code, error);
            break;
        }
        if (fstat(file, &held) == 0 && fstatat(store->folder_file, LOCK_NAME, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
            held.st_ino == named.st_ino && held.st_dev == named.st_dev) {
            store->lock_file = file;
            return SCREE_OK;
        }
        close(file);
    }
    return scree_fail(error, SCREE_E_IO, "another build is writing to %s; wait for it or choose another folder",
                      store->folder);
}

static DIR *open_listing(int folder, const char *name) {
    int file = openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *listing = file < 0 ? NULL : fdopendir(file);
    if (listing == NULL && file >= 0) close(file);
    return listing;
}

static enum scree_status remove_leftovers(struct tile_store *store, struct scree_error *error) {
    for (size_t i = 0; i < sizeof manifests / sizeof *manifests; i++)
        if (unlinkat(store->folder_file, manifests[i], 0) != 0 && errno != ENOENT)
            return fail(store, "remove", manifests[i], errno, error);
    DIR *listing = open_listing(store->folder_file, ".");
    if (listing == NULL) return file_fail(error, "read the folder", store->folder, errno);
    enum scree_status status = SCREE_OK;
    for (struct dirent *entry; status == SCREE_OK && (entry = readdir(listing)) != NULL;) {
        if (strncmp(entry->d_name, FILE_TEMPORARY_PREFIX, strlen(FILE_TEMPORARY_PREFIX)) != 0) continue;
        if (unlinkat(store->folder_file, entry->d_name, 0) != 0)
            status = fail(store, "remove", entry->d_name, errno, error);
    }
    closedir(listing);
    return status;
}

static enum scree_status open_folder(struct tile_store *store, struct scree_error *error) {
    enum scree_status status = file_make_folder(store->folder, error);
    if (status != SCREE_OK) return status;
    store->folder_file = open(store->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (store->folder_file < 0) return file_fail(error, "open the folder", store->folder, errno);
    status = take_lock(store, error);
    return status == SCREE_OK ? remove_leftovers(store, error) : status;
}

enum scree_status tile_store_open(const char *out, const char *product, const char *extension,
                                  struct tile_store **store, struct scree_error *error) {
    *store = NULL;
    if (*out == '\0' || strlen(extension) >= EXTENSION_ROOM)
        return scree_fail(error, SCREE_E_ARGUMENT, "the output folder has no name");
    struct tile_store *new_store = calloc(1, sizeof *new_store);
    size_t folder_room = strlen(out) + strlen(product) + 2;
    char *folder = malloc(folder_room);
    if (new_store == NULL || folder == NULL) {
        free(folder);
        free(new_store);
        return scree_fail(error, SCREE_E_MEMORY, "no memory to open the folder %s", out);
    }
    snprintf(folder, folder_room, "%s/%s", out, product);
    snprintf(new_store->extension, sizeof new_store->extension, "%s", extension);
    new_store->folder = folder;
    new_store->folder_file = new_store->lock_file = -1;
    pthread_mutex_init(&new_store->mutex, NULL);
    enum scree_status status = open_folder(new_store, error);
    if (status != SCREE_OK) {
        tile_store_free(new_store);
        return status;
    }
    *store = new_store;
    return SCREE_OK;
}

void tile_store_free(struct tile_store *store) {
    if (store == NULL) return;
    if (store->lock_file >= 0) {
        unlinkat(store->folder_file, LOCK_NAME, 0);
        close(store->lock_file);
    }
    if (store->folder_file >= 0) close(store->folder_file);
    pthread_mutex_destroy(&store->mutex);
    free(store->written);
    free(store->folder);
    free(store);
}

/* ---- writing ---- */

static uint64_t tile_key(struct tile_id tile) {
    return (uint64_t)tile.zoom << 58 | (uint64_t)tile.x << 29 | tile.y; /* x and y stay below 2^23 */
}

static enum scree_status remember(struct tile_store *store, struct tile_id tile, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    pthread_mutex_lock(&store->mutex);
    if (store->written_count == store->written_room) {
        size_t room = store->written_room == 0 ? 1024 : 2 * store->written_room;
        uint64_t *larger = realloc(store->written, room * sizeof *larger);
        if (larger == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a list of %zu tiles", room);
        if (larger != NULL) store->written = larger, store->written_room = room;
    }
    if (status == SCREE_OK) store->written[store->written_count++] = tile_key(tile);
    pthread_mutex_unlock(&store->mutex);
    return status;
}

/* Temporary files lie in the product's own folder, where tile_store_open finds what a killed build left. */
static void temporary_name(struct tile_store *store, char name[NAME_ROOM]) {
    pthread_mutex_lock(&store->mutex);
    unsigned long number = store->temporary_count++;
    pthread_mutex_unlock(&store->mutex);
    snprintf(name, NAME_ROOM, FILE_TEMPORARY_PREFIX "%ld-%lu", (long)getpid(), number);
}

static int make_tile_folders(struct tile_store *store, struct tile_id tile) {
    char name[NAME_ROOM];
    snprintf(name, sizeof name, "%d", tile.zoom);
    if (mkdirat(store->folder_file, name, 0777) != 0 && errno != EEXIST) return errno;
    snprintf(name, sizeof name, "%d/%u", tile.zoom, tile.x);
    if (mkdirat(store->folder_file, name, 0777) != 0 && errno != EEXIST) return errno;
    return 0;
}

static enum scree_status write_named(struct tile_store *store, const char *name, struct tile_id tile, bool in_folders,
                                     const void *bytes, size_t size_bytes, struct scree_error *error) {
    char temporary[NAME_ROOM];
    temporary_name(store, temporary);
    int code = file_write_beside(store->folder_file, temporary, name, bytes, size_bytes);
    if (code == ENOENT && in_folders) { /* the first tile of its column: once more */
        code = make_tile_folders(store, tile);
        if (code == 0) code = file_write_beside(store->folder_file, temporary, name, bytes, size_bytes);
    }
    return code == 0 ? SCREE_OK : fail(store, "write", name, code, error);
}

enum scree_status tile_store_write(struct tile_store *store, struct tile_id tile, const void *bytes, size_t size_bytes,
                                   bool compress, size_t *written_bytes, struct scree_error *error) {
    unsigned char *gzipped = NULL;
    enum scree_status status = SCREE_OK;
    if (compress) {
        status = gzip_new(bytes, size_bytes, &gzipped, &size_bytes, error);
        bytes = gzipped;
    }
    if (status == SCREE_OK) status = remember(store, tile, error);
    char name[NAME_ROOM];
    snprintf(name, sizeof name, "%d/%u/%u.%s", tile.zoom, tile.x, tile.y, store->extension);
    if (status == SCREE_OK) status = write_named(store, name, tile, true, bytes, size_bytes, error);
    if (status == SCREE_OK && written_bytes != NULL) *written_bytes = size_bytes;
    free(gzipped);
    return status;
}

/* ---- finishing ---- */

static int compare_keys(const void *a, const void *b) {
    uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return left < right ? -1 : left > right; /* a tile written twice is in the list twice: no matter */
}

/* A whole number as this program writes it, followed by `end`; nothing else is one of our names. */
static bool parse_number(const char *text, const char *end, uint32_t *value) {
    uint64_t number = 0;
    size_t digits = 0;
    for (; text[digits] >= '0' && text[digits] <= '9'; digits++) {
        if (digits == 9) return false;
        number = number * 10 + (uint64_t)(text[digits] - '0');
    }
    if (digits == 0 || (digits > 1 && text[0] == '0') || strcmp(text + digits, end) != 0) return false;
    *value = (uint32_t)number;
    return true;
}

/* One folder z/x: removes the tiles that are not in the sorted list. */
static enum scree_status remove_stale_in(struct tile_store *store, DIR *listing, int zoom, uint32_t x,
                                         struct scree_error *error) {
    char end[EXTENSION_ROOM + 1], name[NAME_ROOM];
    snprintf(end, sizeof end, ".%s", store->extension);
    for (struct dirent *entry; (entry = readdir(listing)) != NULL;) {
        struct tile_id tile = {.zoom = zoom, .x = x};
        struct stat status;
        if (!parse_number(entry->d_name, end, &tile.y)) continue;
        uint64_t key = tile_key(tile);
        if (store->written_count > 0 &&
            bsearch(&key, store->written, store->written_count, sizeof key, compare_keys) != NULL)
            continue;
        if (fstatat(dirfd(listing), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(status.st_mode))
            continue;
        if (unlinkat(dirfd(listing), entry->d_name, 0) == 0) continue;
        int code = errno;
        snprintf(name, sizeof name, "%d/%u/%u.%s", zoom, x, tile.y, store->extension);
        return fail(store, "remove", name, code, error);
    }
    return SCREE_OK;
}

/* One folder z: its folders x, which go as well when they are empty. */
static enum scree_status remove_stale_zoom(struct tile_store *store, DIR *zoom_listing, int zoom,
                                           struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (struct dirent *entry; status == SCREE_OK && (entry = readdir(zoom_listing)) != NULL;) {
        uint32_t x;
        if (!parse_number(entry->d_name, "", &x)) continue;
        DIR *listing = open_listing(dirfd(zoom_listing), entry->d_name);
        if (listing == NULL) continue; /* a file, or a link to somewhere else */
        status = remove_stale_in(store, listing, zoom, x, error);
        closedir(listing);
        unlinkat(dirfd(zoom_listing), entry->d_name, AT_REMOVEDIR);
    }
    return status;
}

static enum scree_status remove_stale(struct tile_store *store, struct scree_error *error) {
    if (store->written_count > 0) qsort(store->written, store->written_count, sizeof *store->written, compare_keys);
    enum scree_status status = SCREE_OK;
    for (int zoom = 0; status == SCREE_OK && zoom <= MAX_ZOOM; zoom++) {
        char name[NAME_ROOM];
        snprintf(name, sizeof name, "%d", zoom);
        DIR *listing = open_listing(store->folder_file, name);
        if (listing == NULL) continue;
        status = remove_stale_zoom(store, listing, zoom, error);
        closedir(listing);
        unlinkat(store->folder_file, name, AT_REMOVEDIR);
    }
    return status;
}

enum scree_status tile_store_finish(struct tile_store *store, const char *name, const char *text,
                                    struct scree_error *error) {
    enum scree_status status = remove_stale(store, error);
    struct tile_id no_tile = {0};
    return status == SCREE_OK ? write_named(store, name, no_tile, false, text, strlen(text), error) : status;
}
