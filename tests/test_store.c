/* The folder of tiles: whole files or none, one writer, stale tiles, and what is said when the disk refuses. */
#include "src/file_io.h"
#include "src/gzip.h"
#include "src/tile_store_io.h"

#include <CUnit/CUnit.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#define PATH_ROOM 512

/* ---- a folder of its own for each test ---- */

static char *new_folder(void) {
    const char *parent = getenv("TMPDIR");
    char name[PATH_ROOM];
    snprintf(name, sizeof name, "%s/scree-store-XXXXXX", parent == NULL || *parent == '\0' ? P_tmpdir : parent);
    CU_ASSERT_PTR_NOT_NULL_FATAL(mkdtemp(name));
    return strdup(name);
}

static void path_in(char path[PATH_ROOM], const char *folder, const char *name) {
    int length = snprintf(path, PATH_ROOM, "%s/%s", folder, name);
    CU_ASSERT_FATAL(length < PATH_ROOM);
}

/* Everything below `folder`, depth first, and itself. */
static void remove_all(const char *folder) {
    DIR *listing = opendir(folder);
    if (listing == NULL) return;
    for (struct dirent *entry; (entry = readdir(listing)) != NULL;) {
        char path[PATH_ROOM];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        path_in(path, folder, entry->d_name);
        if (unlink(path) != 0) remove_all(path);
    }
    closedir(listing);
    rmdir(folder);
}

static void free_folder(char *folder) {
    remove_all(folder);
    free(folder);
}

static bool exists(const char *folder, const char *name) {
    char path[PATH_ROOM];
    struct stat status;
    path_in(path, folder, name);
    return lstat(path, &status) == 0;
}

static void make_folder(const char *folder, const char *name) {
    char path[PATH_ROOM];
    path_in(path, folder, name);
    CU_ASSERT_EQUAL(file_make_folder(path, NULL), SCREE_OK);
}

static void make_file(const char *folder, const char *name, const char *text) {
    char path[PATH_ROOM];
    path_in(path, folder, name);
    CU_ASSERT_EQUAL(file_replace(path, text, strlen(text), NULL), SCREE_OK);
}

static bool holds(const char *folder, const char *name, const void *bytes, size_t size_bytes) {
    char path[PATH_ROOM], *content = malloc(size_bytes + 1);
    path_in(path, folder, name);
    FILE *file = fopen(path, "rb");
    bool same = file != NULL && fread(content, 1, size_bytes + 1, file) == size_bytes &&
                memcmp(content, bytes, size_bytes) == 0;
    if (file != NULL) fclose(file);
    free(content);
    return same;
}

static int count_entries(const char *folder, const char *beginning) {
    DIR *listing = opendir(folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(listing)) != NULL;)
        count += strncmp(entry->d_name, beginning, strlen(beginning)) == 0;
    closedir(listing);
    return count;
}

static struct tile_store *open_store(const char *out) {
    struct tile_store *store;
    CU_ASSERT_EQUAL_FATAL(tile_store_open(out, "terrain", "terrain", &store, NULL), SCREE_OK);
    return store;
}

static void write_tile(struct tile_store *store, int zoom, uint32_t x, uint32_t y, const char *text) {
    struct tile_id tile = {zoom, x, y};
    CU_ASSERT_EQUAL(tile_store_write(store, tile, text, strlen(text), false, NULL, NULL), SCREE_OK);
}

/* ---- the good way ---- */

static void tiles_come_to_their_places(void) {
    char *out = new_folder(), deep[PATH_ROOM];
    path_in(deep, out, "not/yet/there");
    struct tile_store *store = open_store(deep);
    write_tile(store, 0, 0, 0, "root");
    write_tile(store, 22, 8388607, 4194303, "far");
    write_tile(store, 0, 0, 0, "root again");
    CU_ASSERT_FALSE(exists(deep, "terrain/layer.json"));
    CU_ASSERT_EQUAL(tile_store_finish(store, "layer.json", "{}\n", NULL), SCREE_OK);
    tile_store_free(store);
    CU_ASSERT(holds(deep, "terrain/0/0/0.terrain", "root again", 10));
    CU_ASSERT(holds(deep, "terrain/22/8388607/4194303.terrain", "far", 3));
    CU_ASSERT(holds(deep, "terrain/layer.json", "{}\n", 3));
    path_in(deep, out, "not/yet/there/terrain");
    CU_ASSERT_EQUAL(count_entries(deep, ""), 5); /* . .. 0 22 layer.json: no lock, no temporary file */
    free_folder(out);
}

static void gzip_is_the_same_every_time(void) {
    enum { SIZE = 50000 };
    unsigned char *plain = malloc(SIZE), *first, *second, *back = malloc(SIZE + 1);
    size_t first_bytes, second_bytes;
    for (int i = 0; i < SIZE; i++) plain[i] = (unsigned char)((unsigned)i * (unsigned)i >> 8);
    CU_ASSERT_EQUAL_FATAL(gzip_new(plain, SIZE, &first, &first_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(gzip_new(plain, SIZE, &second, &second_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(first_bytes, second_bytes);
    CU_ASSERT_EQUAL(memcmp(first, second, first_bytes), 0);
    CU_ASSERT_EQUAL(memcmp(first, "\x1f\x8b\x08\x00\x00\x00\x00\x00", 8), 0); /* no flags, no name, no time */
    CU_ASSERT_EQUAL(first[9], 255);                                           /* no operating system */
    z_stream stream = {.next_in = first, .avail_in = (uInt)first_bytes, .next_out = back, .avail_out = SIZE + 1};
    CU_ASSERT_EQUAL(inflateInit2(&stream, 31), Z_OK);
    CU_ASSERT_EQUAL(inflate(&stream, Z_FINISH), Z_STREAM_END);
    CU_ASSERT_EQUAL(stream.total_out, SIZE);
    CU_ASSERT_EQUAL(memcmp(back, plain, SIZE), 0);
    inflateEnd(&stream);
    free(back);
    free(second);
    free(first);
    free(plain);
}

static void compressed_tiles_say_their_size(void) {
    char *out = new_folder();
    struct tile_store *store = open_store(out);
    struct tile_id tile = {3, 2, 1};
    static const char zeroes[5000];
    unsigned char *gzipped;
    size_t gzip_bytes, written_bytes;
    CU_ASSERT_EQUAL_FATAL(gzip_new(zeroes, sizeof zeroes, &gzipped, &gzip_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(tile_store_write(store, tile, zeroes, sizeof zeroes, true, &written_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(written_bytes, gzip_bytes);
    CU_ASSERT(holds(out, "terrain/3/2/1.terrain", gzipped, gzip_bytes));
    CU_ASSERT_EQUAL(tile_store_write(store, tile, zeroes, sizeof zeroes, false, &written_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(written_bytes, sizeof zeroes);
    CU_ASSERT(holds(out, "terrain/3/2/1.terrain", zeroes, sizeof zeroes));
    tile_store_free(store);
    free(gzipped);
    free_folder(out);
}

struct share {
    struct tile_store *store;
    uint32_t first;
    int failures;
};

static void *write_share(void *argument) {
    struct share *share = argument;
    for (uint32_t i = share->first; i < 400; i += 4) {
        char text[32];
        struct tile_id tile = {9, i % 20, i / 20};
        snprintf(text, sizeof text, "tile %u", i);
        share->failures += tile_store_write(share->store, tile, text, strlen(text), i % 2, NULL, NULL) != SCREE_OK;
    }
    return NULL;
}

static void threads_may_write_at_once(void) {
    char *out = new_folder(), path[PATH_ROOM];
    struct tile_store *store = open_store(out);
    pthread_t threads[4];
    struct share shares[4];
    for (uint32_t t = 0; t < 4; t++) {
        shares[t] = (struct share){store, t, 0};
        CU_ASSERT_EQUAL_FATAL(pthread_create(&threads[t], NULL, write_share, &shares[t]), 0);
    }
    for (int t = 0; t < 4; t++) {
        pthread_join(threads[t], NULL);
        CU_ASSERT_EQUAL(shares[t].failures, 0);
    }
    CU_ASSERT_EQUAL(tile_store_finish(store, "layer.json", "{}", NULL), SCREE_OK);
    tile_store_free(store);
    for (uint32_t x = 0; x < 20; x++) {
        snprintf(path, sizeof path, "%s/terrain/9/%u", out, x);
        CU_ASSERT_EQUAL(count_entries(path, ""), 2 + 20);
    }
    free_folder(out);
}

/* ---- earlier builds ---- */

static void stale_tiles_go_and_nothing_else(void) {
    char *out = new_folder();
    static const char *const kept[] = {"terrain/readme.txt",
                                       "terrain/3/notes",
                                       "terrain/3/2/1.terrain.bak",
                                       "terrain/3/2/01.terrain",
                                       "terrain/3/2/1.png",
                                       "terrain/3/2/x.terrain",
                                       "terrain/3/02/1.terrain",
                                       "terrain/03/2/1.terrain",
                                       "terrain/99/2/1.terrain",
                                       "terrain/3/2/-1.terrain",
                                       "terrain/3/2/.terrain",
                                       "0/0/0.terrain",
                                       "terrain/3/2/5000000000.terrain",
                                       "terrain/3/2/ 1.terrain",
                                       "elsewhere/7.terrain"};
    static const char *const stale[] = {"terrain/3/2/1.terrain", "terrain/0/0/0.terrain", "terrain/5/4/3.terrain",
                                        "terrain/22/8388607/0.terrain"};
    static const char *const folders[] = {"terrain/3/2/7.terrain", "terrain/3/02", "terrain/03/2",
                                          "terrain/99/2",          "terrain/0/0",  "terrain/5/4",
                                          "terrain/22/8388607",    "0/0",          "elsewhere"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) make_folder(out, folders[i]);
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) make_file(out, kept[i], "mine");
    for (size_t i = 0; i < sizeof stale / sizeof *stale; i++) make_file(out, stale[i], "old");
    char link_path[PATH_ROOM], target[PATH_ROOM];
    path_in(link_path, out, "terrain/6");
    path_in(target, out, "elsewhere");
    CU_ASSERT_EQUAL(symlink(target, link_path), 0);
    make_file(out, "terrain/layer.json", "old");
    make_file(out, "terrain/.scree-tmp-1-0", "of a killed build");
    struct tile_store *store = open_store(out);
    CU_ASSERT_FALSE(exists(out, "terrain/layer.json"));
    CU_ASSERT_FALSE(exists(out, "terrain/.scree-tmp-1-0"));
    write_tile(store, 3, 2, 8, "new");
    write_tile(store, 4, 1, 1, "new");
    CU_ASSERT_EQUAL(tile_store_finish(store, "layer.json", "new", NULL), SCREE_OK);
    tile_store_free(store);
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) CU_ASSERT(holds(out, kept[i], "mine", 4));
    for (size_t i = 0; i < sizeof stale / sizeof *stale; i++) CU_ASSERT_FALSE(exists(out, stale[i]));
    CU_ASSERT(exists(out, "terrain/3/2/7.terrain")); /* a folder, though it is called like a tile */
    CU_ASSERT(exists(out, "terrain/6"));
    CU_ASSERT_FALSE(exists(out, "terrain/0"));
    CU_ASSERT_FALSE(exists(out, "terrain/5"));
    CU_ASSERT_FALSE(exists(out, "terrain/22"));
    CU_ASSERT(holds(out, "terrain/3/2/8.terrain", "new", 3));
    CU_ASSERT(holds(out, "terrain/4/1/1.terrain", "new", 3));
    free_folder(out);
}

static void without_finish_there_is_no_manifest(void) {
    char *out = new_folder();
    struct tile_store *store = open_store(out);
    write_tile(store, 0, 0, 0, "first");
    CU_ASSERT_EQUAL(tile_store_finish(store, "layer.json", "{}", NULL), SCREE_OK);
    tile_store_free(store);
    store = open_store(out);
    write_tile(store, 0, 1, 0, "second");
    tile_store_free(store);
    tile_store_free(NULL);
    CU_ASSERT_FALSE(exists(out, "terrain/layer.json"));
    CU_ASSERT(holds(out, "terrain/0/0/0.terrain", "first", 5));
    free_folder(out);
}

static void a_second_writer_is_refused(void) {
    char *out = new_folder();
    struct tile_store *store = open_store(out), *other;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(tile_store_open(out, "terrain", "terrain", &other, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NULL(other);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "another build is writing to"));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, out));
    CU_ASSERT_EQUAL(tile_store_open(out, "stream", "scree", &other, NULL), SCREE_OK); /* another product */
    tile_store_free(other);
    tile_store_free(store);
    tile_store_free(open_store(out));
    make_file(out, "terrain/.scree-lock", ""); /* left by a killed build: nobody holds it */
    tile_store_free(open_store(out));
    free_folder(out);
}

/* A process that is killed at any moment leaves whole tiles only. */
static void a_killed_writer_leaves_whole_tiles(void) {
    enum { SIZE = 300000 };
    char *out = new_folder(), *bytes = malloc(SIZE);
    memset(bytes, 'x', SIZE);
    for (int round = 0; round < 10; round++) {
        pid_t child = fork();
        if (child == 0) {
            struct tile_store *store;
            if (tile_store_open(out, "terrain", "terrain", &store, NULL) != SCREE_OK) _exit(1);
            for (uint32_t i = 0;; i = (i + 1) % 50) {
                struct tile_id tile = {6, i % 7, i};
                if (tile_store_write(store, tile, bytes, SIZE, false, NULL, NULL) != SCREE_OK) _exit(1);
            }
        }
        CU_ASSERT_FATAL(child > 0);
        int status;
        usleep(3000 + 2000 * (useconds_t)round);
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        CU_ASSERT(WIFSIGNALED(status));
        for (uint32_t i = 0; i < 50; i++) {
            char name[64];
            snprintf(name, sizeof name, "terrain/6/%u/%u.terrain", i % 7, i);
            CU_ASSERT(!exists(out, name) || holds(out, name, bytes, SIZE));
        }
    }
    tile_store_free(open_store(out));
    char path[PATH_ROOM];
    path_in(path, out, "terrain");
    CU_ASSERT_EQUAL(count_entries(path, ".scree"), 0);
    free(bytes);
    free_folder(out);
}

/* ---- when the disk refuses ---- */

static void check_open_fails(const char *out, const char *why) {
    struct scree_error error = {0};
    struct tile_store *store;
    CU_ASSERT_EQUAL(tile_store_open(out, "terrain", "terrain", &store, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NULL(store);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, out));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, why));
}

static void an_output_that_is_a_file_is_refused(void) {
    char *out = new_folder(), path[PATH_ROOM];
    struct tile_store *store;
    make_file(out, "file", "precious");
    path_in(path, out, "file");
    check_open_fails(path, "a file is where a folder should be");
    make_file(out, "terrain", "precious");
    check_open_fails(out, "a file is where a folder should be");
    CU_ASSERT(holds(out, "file", "precious", 8));
    CU_ASSERT(holds(out, "terrain", "precious", 8));
    CU_ASSERT_EQUAL(tile_store_open("", "terrain", "terrain", &store, NULL), SCREE_E_ARGUMENT);
    free_folder(out);
}

static void a_file_in_place_of_a_zoom_is_named(void) {
    char *out = new_folder();
    make_folder(out, "terrain");
    make_file(out, "terrain/4", "not a folder");
    struct tile_store *store = open_store(out);
    struct scree_error error = {0};
    struct tile_id tile = {4, 1, 2};
    CU_ASSERT_EQUAL(tile_store_write(store, tile, "tile", 4, false, NULL, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "/terrain/4/1/2.terrain"));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "a file is where a folder should be"));
    tile_store_free(store);
    free_folder(out);
}

/* As a user without rights: root may write everywhere, so a child gives its rights up first. */
static void an_unwritable_folder_is_refused(void) {
    char *out = new_folder();
    CU_ASSERT_EQUAL(chmod(out, 0555), 0);
    pid_t child = fork();
    if (child == 0) {
        struct tile_store *store;
        struct scree_error error = {0};
        if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(2);
        if (tile_store_open(out, "terrain", "terrain", &store, &error) != SCREE_E_IO) _exit(3);
        _exit(strstr(error.text, "choose a place that you may write to") != NULL && strstr(error.text, out) != NULL
                  ? 0
                  : 4);
    }
    int status;
    CU_ASSERT_EQUAL(waitpid(child, &status, 0), child);
    CU_ASSERT(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    CU_ASSERT_EQUAL(chmod(out, 0755), 0);
    free_folder(out);
}

/* A limit on file sizes stands in for a full disk: the write fails half-way. */
static void a_full_disk_leaves_nothing(void) {
    enum { SIZE = 100000 };
    char *out = new_folder(), *bytes = calloc(SIZE, 1), path[PATH_ROOM];
    struct tile_store *store = open_store(out);
    struct tile_id tile = {2, 1, 0};
    struct scree_error error = {0};
    struct rlimit before, tight;
    write_tile(store, 2, 1, 0, "whole");
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    CU_ASSERT_EQUAL(getrlimit(RLIMIT_FSIZE, &before), 0);
    tight = before;
    tight.rlim_cur = SIZE / 2;
    CU_ASSERT_EQUAL(setrlimit(RLIMIT_FSIZE, &tight), 0);
    enum scree_status status = tile_store_write(store, tile, bytes, SIZE, false, NULL, &error);
    CU_ASSERT_EQUAL(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, handler);
    CU_ASSERT_EQUAL(status, SCREE_E_IO);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "terrain/2/1/0.terrain"));
    CU_ASSERT(holds(out, "terrain/2/1/0.terrain", "whole", 5));
    path_in(path, out, "terrain");
    CU_ASSERT_EQUAL(count_entries(path, FILE_TEMPORARY_PREFIX), 0);
    tile_store_free(store);
    free(bytes);
    free_folder(out);
}

static void a_full_device_is_named(void) {
    struct scree_error error = {0};
    if (access("/dev/full", W_OK) != 0) {
        printf("skipped: there is no /dev/full ... ");
        return;
    }
    CU_ASSERT_EQUAL(file_replace("/dev/full", "text", 4, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "/dev/full"));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "free some space"));
    CU_ASSERT_EQUAL(file_replace("/dev/null", "text", 4, NULL), SCREE_OK);
    struct stat status;
    CU_ASSERT(stat("/dev/null", &status) == 0 && S_ISCHR(status.st_mode)); /* not replaced by a file */
}

static void files_are_replaced_whole(void) {
    char *out = new_folder(), path[PATH_ROOM];
    struct scree_error error = {0};
    make_file(out, "a", "one");
    make_file(out, "a", "three");
    CU_ASSERT(holds(out, "a", "three", 5));
    path_in(path, out, ".scree-tmp-");
    snprintf(path + strlen(path), sizeof path - strlen(path), "%ld-f0", (long)getpid()); /* of a killed namesake */
    int file = open(path, O_WRONLY | O_CREAT, 0600);
    CU_ASSERT_EQUAL(close(file), 0);
    make_file(out, "a", "");
    CU_ASSERT(holds(out, "a", "", 0));
    CU_ASSERT_EQUAL(unlink(path), 0);
    CU_ASSERT_EQUAL(count_entries(out, ""), 3);
    path_in(path, out, "no/such/folder");
    CU_ASSERT_EQUAL(file_replace(path, "x", 1, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, path));
    CU_ASSERT_EQUAL(file_replace(out, "x", 1, NULL), SCREE_E_IO); /* a folder */
    free_folder(out);
}

int suite_store(void) {
    CU_pSuite suite = CU_add_suite("store", NULL, NULL);
    if (suite == NULL) return 1;
    static const struct {
        const char *name;
        CU_TestFunc run;
    } tests[] = {
        {"tiles come to their places", tiles_come_to_their_places},
        {"gzip is the same every time", gzip_is_the_same_every_time},
        {"compressed tiles say their size", compressed_tiles_say_their_size},
        {"threads may write at once", threads_may_write_at_once},
        {"stale tiles go and nothing else", stale_tiles_go_and_nothing_else},
        {"without finish there is no manifest", without_finish_there_is_no_manifest},
        {"a second writer is refused", a_second_writer_is_refused},
        {"a killed writer leaves whole tiles", a_killed_writer_leaves_whole_tiles},
        {"an output that is a file is refused", an_output_that_is_a_file_is_refused},
        {"a file in place of a zoom is named", a_file_in_place_of_a_zoom_is_named},
        {"an unwritable folder is refused", an_unwritable_folder_is_refused},
        {"a full disk leaves nothing", a_full_disk_leaves_nothing},
        {"a full device is named", a_full_device_is_named},
        {"files are replaced whole", files_are_replaced_whole},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (CU_add_test(suite, tests[i].name, tests[i].run) == NULL) return 1;
    return 0;
}
