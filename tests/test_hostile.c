/* Hostile streams: cut anywhere, damaged anywhere, in the wrong order, with counts and checksums that lie. They are
 * refused with a line, at a cost in memory and time that the file pays for. */
#include "stream/decode.h"
#include "stream/player.h"
#include "stream/stream_header.h"
#include "tests/stream_forge.h"
#include "tests/stream_maker.h"
#include <scree/player.h>

#include <CUnit/CUnit.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* What docs/stream.md promises: a player's memory against the bytes that it was given. */
#define BYTES_PER_BYTE 80000
#define BYTES_FREE     (1 << 20)

struct bytes {
    unsigned char *bytes;
    size_t size_bytes;
};

static struct bytes make(uint64_t seed, int32_t steps, double finest_m, uint32_t rungs, uint32_t rungs_per_increment) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct bytes made = {0};
    const struct encode_options options = {.rungs_per_increment = rungs_per_increment};
    const struct stream_wish wish = {
        .seed = seed, .columns = steps, .rows = steps, .profile = SCREE_LOCAL, .finest_m = finest_m, .rungs = rungs};
    unsigned char *bytes = NULL;
    CU_ASSERT_EQUAL_FATAL(stream_make(&memory, &wish, &options, &bytes, &made.size_bytes, &error), SCREE_OK);
    made.bytes = malloc(made.size_bytes);
    CU_ASSERT_PTR_NOT_NULL_FATAL(made.bytes);
    memcpy(made.bytes, bytes, made.size_bytes);
    scree_release(&memory, bytes);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return made;
}

/* Pushes an exact-size copy, looks at all of the mesh at every scale, and returns the status of the push. */
static enum scree_status push(const unsigned char *bytes, size_t size_bytes, struct scree_error *error,
                              size_t *peak_bytes) {
    struct scree_player *player;
    struct scree_memory memory = {0};
    CU_ASSERT_EQUAL_FATAL(player_new_in(&memory, NULL, &player, NULL), SCREE_OK);
    unsigned char *copy = malloc(size_bytes + (size_bytes == 0));
    if (size_bytes > 0) memcpy(copy, bytes, size_bytes);
    enum scree_status status = scree_player_push(player, copy, size_bytes, error);
    free(copy);
    for (uint32_t rung = 0; rung < scree_player_rungs_ready(player); rung++) {
        struct scree_arrays arrays;
        scree_player_seek_rung(player, rung);
        scree_player_look(player, &arrays);
        unsigned outside = 0;
        for (size_t i = 0; i < 3 * (size_t)arrays.triangle_count; i++)
            outside += arrays.indices[i] >= arrays.vertex_count;
        CU_ASSERT_EQUAL(outside, 0);
    }
    if (peak_bytes != NULL) *peak_bytes = player_memory(player)->peak_bytes;
    scree_player_free(player);
    return status;
}

static void every_cut_asks_for_more(void) {
    struct bytes stream = make(7, 24, 4, 12, 1);
    for (size_t cut_bytes = 0; cut_bytes < stream.size_bytes; cut_bytes++) {
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(push(stream.bytes, cut_bytes, &error, NULL), SCREE_MORE);
        CU_ASSERT_EQUAL(error.status, SCREE_OK);
    }
    CU_ASSERT_EQUAL(push(stream.bytes, stream.size_bytes, NULL, NULL), SCREE_OK);
    free(stream.bytes);
}

static void every_flipped_bit_is_refused(void) {
    struct bytes stream = make(7, 24, 4, 12, 1);
    unsigned accepted = 0, untold = 0;
    for (size_t bit = 0; bit < 8 * stream.size_bytes; bit++) {
        struct scree_error error = {0};
        stream.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
        accepted += push(stream.bytes, stream.size_bytes, &error, NULL) >= SCREE_OK;
        untold += error.text[0] == '\0';
        stream.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    CU_ASSERT_EQUAL(accepted, 0);
    CU_ASSERT_EQUAL(untold, 0);
    free(stream.bytes);
}

/* Bursts of up to 32 bits are what the checksum sees in any case. */
static void every_burst_is_refused(void) {
    struct bytes stream = make(7, 24, 4, 12, 1);
    unsigned accepted = 0;
    uint32_t chance = 1;
    for (size_t at = 0; at + 4 <= stream.size_bytes; at++) {
        unsigned char kept[4];
        memcpy(kept, stream.bytes + at, 4);
        for (int i = 0; i < 4; i++) {
            chance = chance * 1664525u + 1013904223u;
            stream.bytes[at + (size_t)i] ^= (unsigned char)(chance >> 24 | 1);
        }
        accepted += push(stream.bytes, stream.size_bytes, NULL, NULL) >= SCREE_OK;
        memcpy(stream.bytes + at, kept, 4);
    }
    CU_ASSERT_EQUAL(accepted, 0);
    free(stream.bytes);
}

/* With its checksum made true, a damaged block is refused or gives some valid mesh. */
static void lying_checksums_give_no_nonsense(void) {
    struct bytes stream = make(8, 20, 3, 10, 1);
    unsigned char *copy = malloc(stream.size_bytes);
    size_t first = forge_block(stream.bytes, 0);
    unsigned refused = 0, tried = 0;
    for (size_t at = first; at < stream.size_bytes; at++)
        for (unsigned bit = 0; bit < 8; bit++) {
            memcpy(copy, stream.bytes, stream.size_bytes);
            copy[at] ^= (unsigned char)(1u << bit);
            forge_checksums(copy, stream.size_bytes);
            tried++;
            refused += push(copy, stream.size_bytes, NULL, NULL) < SCREE_OK;
        }
    CU_ASSERT(refused > tried / 2);
    free(copy);
    free(stream.bytes);
}

/* ---- cost ---- */

/* A header that promises much, with nothing or little behind it. */
static void promises_cost_nothing(void) {
    struct scree_stream_header header = {.profile = SCREE_LOCAL,
                                         .columns = 1 << 20,
                                         .rows = 1 << 20,
                                         .spacing_x = 1,
                                         .spacing_y = 1,
                                         .metres_x = 1,
                                         .metres_y = 1,
                                         .rung_count = 2};
    unsigned char bytes[256] = {0};
    size_t peak_bytes;
    for (int32_t i = 0; i < 2; i++)
        header.rungs[i] = (struct scree_rung){.rung = i,
                                              .vertex_count = i == 0 ? 4 : SCREE_MAX_VERTICES,
                                              .triangle_count = i == 0 ? 2 : 2 * SCREE_MAX_VERTICES - 100000,
                                              .size_bytes = i == 0 ? 60 : UINT32_MAX};
    size_t size_bytes = stream_header_write(&header, bytes, sizeof bytes);
    CU_ASSERT_EQUAL(push(bytes, size_bytes, NULL, &peak_bytes), SCREE_MORE);
    CU_ASSERT(peak_bytes < BYTES_FREE);
    CU_ASSERT_EQUAL(push(bytes, size_bytes + 59, NULL, &peak_bytes), SCREE_MORE);
    CU_ASSERT(peak_bytes < BYTES_FREE);
    CU_ASSERT_EQUAL(push(bytes, size_bytes + 60, NULL, &peak_bytes), SCREE_E_CORRUPT);
    CU_ASSERT(peak_bytes < BYTES_FREE);
}

/* Blocks of one kind of byte or of chance, with the most vertices that their size allows. */
static void the_worst_blocks_are_bounded(void) {
    enum { BLOCK_BYTES = 2000, VERTICES = STREAM_VERTICES_PER_BYTE * BLOCK_BYTES, KINDS = 40 };
    static unsigned char bytes[BLOCK_BYTES + 256];
    struct scree_stream_header header = {.profile = SCREE_LOCAL,
                                         .columns = 4096,
                                         .rows = 4096,
                                         .spacing_x = 1,
                                         .spacing_y = 1,
                                         .metres_x = 1,
                                         .metres_y = 1,
                                         .rung_count = 1};
    header.rungs[0] =
        (struct scree_rung){.vertex_count = VERTICES, .triangle_count = 2 * VERTICES - 1000, .size_bytes = BLOCK_BYTES};
    size_t header_bytes = stream_header_write(&header, bytes, sizeof bytes), size_bytes = header_bytes + BLOCK_BYTES;
    uint32_t chance = 1;
    for (int kind = 0; kind < KINDS; kind++) {
        size_t peak_bytes;
        for (size_t i = header_bytes; i < size_bytes; i++) {
            chance = chance * 1664525u + 1013904223u;
            bytes[i] = kind < 4 ? (unsigned char)(85 * kind) : (unsigned char)(chance >> 24);
            if (kind >= 4 && i - header_bytes > 20 && kind % 3 != 0) bytes[i] = kind % 3 == 1 ? 0 : 0xff;
        }
        forge_checksums(bytes, size_bytes);
        clock_t start = clock();
        push(bytes, size_bytes, NULL, &peak_bytes);
        CU_ASSERT(clock() - start < 10 * CLOCKS_PER_SEC);
        CU_ASSERT(peak_bytes <= BYTES_FREE + (size_t)BYTES_PER_BYTE * size_bytes);
    }
}

/* What a real one takes is far from the bound. */
static void real_streams_are_cheap(void) {
    struct bytes stream = make(3, 128, 1, 40, 1);
    size_t peak_bytes = 0;
    CU_ASSERT_EQUAL(push(stream.bytes, stream.size_bytes, NULL, &peak_bytes), SCREE_OK);
    CU_ASSERT(peak_bytes < BYTES_FREE + 300 * stream.size_bytes);
    free(stream.bytes);
}

/* A limit is kept, and told; what has been decoded before can still be played. */
static void a_limit_is_kept(void) {
    struct bytes stream = make(3, 64, 1, 30, 1);
    struct scree_player *player;
    struct scree_error error = {0};
    const struct scree_player_options options = {.memory_limit_bytes = 300000};
    CU_ASSERT_EQUAL_FATAL(scree_player_new(&options, &player, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(scree_player_push(player, stream.bytes, stream.size_bytes, &error), SCREE_E_LIMIT);
    CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
    CU_ASSERT(player_memory(player)->peak_bytes <= options.memory_limit_bytes);
    uint32_t ready = scree_player_rungs_ready(player);
    CU_ASSERT(ready > 0);
    CU_ASSERT_EQUAL(scree_player_seek_rung(player, ready - 1), SCREE_OK);
    CU_ASSERT_EQUAL(scree_player_seek_rung(player, 0), SCREE_OK);
    scree_player_free(player);
    free(stream.bytes);
}

/* ---- the corpus ---- */

static enum scree_status expected(const char *name) {
    if (strncmp(name, "good-", 5) == 0) return SCREE_OK;
    return strncmp(name, "bad-", 4) == 0 ? SCREE_E_CORRUPT : SCREE_E_UNSUPPORTED;
}

static size_t read_corpus_file(const char *name, unsigned char *bytes, size_t capacity_bytes) {
    char path[1024];
    const char *top = getenv("TOP_SRCDIR");
    snprintf(path, sizeof path, "%s/tests/corpus/stream/%s", top != NULL ? top : TOP_SRCDIR_DEFAULT, name);
    FILE *file = fopen(path, "rb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    size_t size_bytes = fread(bytes, 1, capacity_bytes, file);
    fclose(file);
    return size_bytes;
}

static void push_file(const char *name) {
    static unsigned char bytes[1 << 16];
    struct scree_error error = {0};
    size_t size_bytes = read_corpus_file(name, bytes, sizeof bytes);
    CU_ASSERT(size_bytes > 0 && size_bytes <= 4096);
    enum scree_status status = push(bytes, size_bytes, &error, NULL);
    if (status != expected(name)) printf("\n    %s: status %d, %s\n", name, (int)status, error.text);
    CU_ASSERT_EQUAL(status, expected(name));
    CU_ASSERT_EQUAL(error.text[0] == '\0', status == SCREE_OK);
    for (size_t cut_bytes = 0; cut_bytes < size_bytes && status == SCREE_OK; cut_bytes++)
        CU_ASSERT_EQUAL(push(bytes, cut_bytes, NULL, NULL), SCREE_MORE);
}

/* The mesh at the end of docs/stream.md. */
static void the_example_is_as_documented(void) {
    static const struct scree_vertex vertices[] = {{0, 0, 2351}, {3, 0, 2341}, {0, 2, 2363}, {3, 2, 2355},
                                                   {0, 1, 2363}, {3, 1, 2353}, {2, 0, 2349}};
    static const uint32_t base[] = {0, 1, 4, 3, 2, 4, 1, 3, 4};
    static const uint32_t finest[] = {0, 6, 4, 3, 2, 5, 1, 5, 6, 2, 4, 5, 5, 4, 6};
    unsigned char bytes[1024];
    size_t size_bytes = read_corpus_file("good-example.scree", bytes, sizeof bytes);
    struct scree_player *player;
    struct scree_arrays arrays;
    CU_ASSERT_EQUAL_FATAL(scree_player_new(NULL, &player, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(scree_player_push(player, bytes, size_bytes, NULL), SCREE_OK);
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL_FATAL(arrays.triangle_count, 3);
    CU_ASSERT_EQUAL(memcmp(arrays.indices, base, sizeof base), 0);
    scree_player_seek_rung(player, 2);
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL_FATAL(arrays.vertex_count, 7);
    CU_ASSERT_EQUAL_FATAL(arrays.triangle_count, 5);
    CU_ASSERT_EQUAL(memcmp(arrays.vertices, vertices, sizeof vertices), 0);
    CU_ASSERT_EQUAL(memcmp(arrays.indices, finest, sizeof finest), 0);
    scree_player_free(player);
}

/* good-* are read, also those that were made long ago; bad-* and unsupported-* are told apart. */
static void the_corpus_is_as_it_says(void) {
    char folder[512];
    const char *top = getenv("TOP_SRCDIR");
    unsigned files = 0;
    snprintf(folder, sizeof folder, "%s/tests/corpus/stream", top != NULL ? top : TOP_SRCDIR_DEFAULT);
    DIR *listing = opendir(folder);
    CU_ASSERT_PTR_NOT_NULL_FATAL(listing);
    for (struct dirent *entry; (entry = readdir(listing)) != NULL;) {
        const char *ending = strrchr(entry->d_name, '.');
        if (ending == NULL || strcmp(ending, ".scree") != 0 || strncmp(entry->d_name, "finding-", 8) == 0) continue;
        push_file(entry->d_name);
        files++;
    }
    closedir(listing);
    CU_ASSERT(files >= 60);
}

int suite_hostile(void) {
    CU_pSuite suite = CU_add_suite("hostile", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, every_cut_asks_for_more);
    CU_ADD_TEST(suite, every_flipped_bit_is_refused);
    CU_ADD_TEST(suite, every_burst_is_refused);
    CU_ADD_TEST(suite, lying_checksums_give_no_nonsense);
    CU_ADD_TEST(suite, promises_cost_nothing);
    CU_ADD_TEST(suite, the_worst_blocks_are_bounded);
    CU_ADD_TEST(suite, real_streams_are_cheap);
    CU_ADD_TEST(suite, a_limit_is_kept);
    CU_ADD_TEST(suite, the_corpus_is_as_it_says);
    CU_ADD_TEST(suite, the_example_is_as_documented);
    return 0;
}
