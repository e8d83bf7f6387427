/* The reader of quantized-mesh tiles: good tiles of ours and of other producers, and every kind of damage. */
#include "src/inflate.h"
#include "src/quantized_mesh_decode.h"
#include "tests/tile_maker.h"

#include <CUnit/CUnit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BUDGET_BYTES (64 << 20)

/* Decodes from an exact-size copy, so that a sanitizer sees one byte too many being read; checks that all indices are
 * in range and that the budget is whole again. */
static enum scree_status decode_and_check(const unsigned char *bytes, size_t size_bytes) {
    struct scree_memory memory = {.limit_bytes = BUDGET_BYTES};
    struct scree_error error = {0};
    struct decoded_tile tile;
    unsigned char *copy = malloc(size_bytes + (size_bytes == 0));
    memcpy(copy, bytes, size_bytes);
    enum scree_status status = decoded_tile_read(&memory, copy, size_bytes, &tile, &error);
    CU_ASSERT_EQUAL(status, error.status);
    if (status != SCREE_OK) CU_ASSERT_PTR_NULL(tile.u);
    uint32_t wrong = 0;
    for (size_t i = 0; i < 3 * (size_t)tile.triangle_count; i++) wrong += tile.corners[i] >= tile.vertex_count;
    for (int s = 0; s < EDGE_COUNT; s++)
        for (uint32_t i = 0; i < tile.edge_count[s]; i++) wrong += tile.edges[s][i] >= tile.vertex_count;
    for (uint32_t i = 0; i < tile.vertex_count; i++)
        wrong += tile.u[i] > DECODED_TOP || tile.v[i] > DECODED_TOP || tile.h[i] > DECODED_TOP;
    CU_ASSERT_EQUAL(wrong, 0);
    decoded_tile_free(&memory, &tile);
    decoded_tile_free(&memory, &tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(copy);
    return status;
}

static unsigned char *sample_tile(bool with_normals, size_t *size_bytes) {
    const double bounds[4] = {10, 40, 12, 42};
    struct tile_recipe recipe = tile_recipe_grid(5, DECODED_TOP, DECODED_TOP);
    tile_recipe_relief(&recipe, bounds);
    tile_recipe_header(&recipe, PROFILE_GEODETIC, bounds);
    if (with_normals) recipe.normals = calloc(recipe.vertex_count, 2);
    unsigned char *bytes = tile_recipe_encode(&recipe, size_bytes);
    tile_recipe_free(&recipe);
    return bytes;
}

static void what_was_encoded_is_decoded(void) {
    struct scree_memory memory = {0};
    struct decoded_tile tile;
    struct tile_recipe recipe = tile_recipe_grid(1, DECODED_TOP, DECODED_TOP);
    size_t size_bytes;
    recipe.h[2] =
        DECODED_TOP; /* the south-western, south-eastern and north-eastern corner come first: no renumbering */
    recipe.height_min_m = -16;
    recipe.height_max_m = -16 + DECODED_TOP * 0.125f;
    recipe.h[3] = 77;
    unsigned char *bytes = tile_recipe_encode(&recipe, &size_bytes);
    CU_ASSERT_EQUAL_FATAL(decoded_tile_read(&memory, bytes, size_bytes, &tile, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(tile.vertex_count, 4);
    CU_ASSERT_EQUAL(tile.triangle_count, 2);
    CU_ASSERT_EQUAL(tile.used_vertex_count, 4);
    CU_ASSERT_EQUAL(tile.edge_count[EDGE_WEST], 2);
    CU_ASSERT_PTR_NULL(tile.normals);
    /* first use: corners 0, 1, 3 of the grid, then 2 */
    CU_ASSERT_EQUAL(tile.u[2], DECODED_TOP);
    CU_ASSERT_EQUAL(tile.v[2], DECODED_TOP);
    CU_ASSERT_EQUAL(decoded_height_m(&tile, 0), -16.0);
    CU_ASSERT_EQUAL(decoded_height_m(&tile, 2), -16 + 77 * 0.125);
    CU_ASSERT_EQUAL(decoded_height_m(&tile, 3), -16 + DECODED_TOP * 0.125);
    decoded_tile_free(&memory, &tile);
    free(bytes);
    tile_recipe_free(&recipe);
}

static void wide_indices_are_decoded(void) {
    struct tile_recipe recipe = tile_recipe_grid(256, DECODED_TOP, DECODED_TOP); /* 66,049 vertices */
    size_t size_bytes;
    unsigned char *bytes = tile_recipe_encode(&recipe, &size_bytes);
    CU_ASSERT_EQUAL(decode_and_check(bytes, size_bytes), SCREE_OK);
    CU_ASSERT_EQUAL(decode_and_check(bytes, size_bytes - 1), SCREE_E_CORRUPT);
    free(bytes);
    tile_recipe_free(&recipe);
}

static void every_truncation_is_an_error(void) {
    size_t size_bytes;
    unsigned char *bytes = sample_tile(true, &size_bytes);
    CU_ASSERT_EQUAL(decode_and_check(bytes, size_bytes), SCREE_OK);
    size_t without_normals = size_bytes - 2 * 36 - 5; /* a tile of its own right */
    for (size_t i = 0; i < size_bytes; i++)
        CU_ASSERT_EQUAL(decode_and_check(bytes, i), i == without_normals ? SCREE_OK : SCREE_E_CORRUPT);
    free(bytes);
}

static uint32_t next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void random_damage_never_crashes(void) {
    size_t size_bytes;
    unsigned char *bytes = sample_tile(true, &size_bytes);
    uint32_t state = 1, refused = 0;
    for (int round = 0; round < 20000; round++) {
        unsigned char kept[8];
        size_t at[8];
        int changes = 1 + (int)(next_random(&state) % 8);
        for (int k = 0; k < changes; k++) {
            at[k] = next_random(&state) % size_bytes;
            kept[k] = bytes[at[k]];
            bytes[at[k]] = (unsigned char)next_random(&state);
        }
        refused += decode_and_check(bytes, size_bytes) != SCREE_OK;
        for (int k = changes - 1; k >= 0; k--) bytes[at[k]] = kept[k];
    }
    CU_ASSERT(refused > 1000);
    CU_ASSERT_EQUAL(decode_and_check(bytes, size_bytes), SCREE_OK);
    free(bytes);
}

static void huge_counts_cost_nothing(void) {
    unsigned char bytes[100];
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct decoded_tile tile;
    memset(bytes, 0, sizeof bytes);
    memset(bytes + 88, 0xff, 4); /* 4,294,967,295 vertices */
    CU_ASSERT_EQUAL(decoded_tile_read(&memory, bytes, sizeof bytes, &tile, &error), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(error.offset_bytes, 92);
    CU_ASSERT_EQUAL(memory.peak_bytes, 0);
    memset(bytes + 88, 0, 4);
    memset(bytes + 92, 0xff, 4); /* as many triangles, of no vertices */
    CU_ASSERT_EQUAL(decoded_tile_read(&memory, bytes, sizeof bytes, &tile, NULL), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void unknown_extensions_are_skipped(void) {
    size_t size_bytes;
    unsigned char *bytes = sample_tile(false, &size_bytes);
    unsigned char *longer = malloc(size_bytes + 12);
    struct scree_memory memory = {0};
    struct decoded_tile tile;
    memcpy(longer, bytes, size_bytes);
    memcpy(longer + size_bytes, "\x63\x02\0\0\0ab\x2a\0\0\0\0", 12);
    CU_ASSERT_EQUAL_FATAL(decoded_tile_read(&memory, longer, size_bytes + 12, &tile, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(tile.unknown_extensions, 2);
    decoded_tile_free(&memory, &tile);
    longer[size_bytes + 1] = 200; /* longer than the tile */
    CU_ASSERT_EQUAL(decode_and_check(longer, size_bytes + 12), SCREE_E_CORRUPT);
    free(longer);
    free(bytes);
}

static void every_allocation_may_fail(void) {
    size_t size_bytes;
    unsigned char *bytes = sample_tile(true, &size_bytes);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct decoded_tile tile;
        status = decoded_tile_read(&memory, bytes, size_bytes, &tile, NULL);
        CU_ASSERT(status == SCREE_OK || status == SCREE_E_MEMORY);
        decoded_tile_free(&memory, &tile);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(request, 3 + 1 + 4 + 1 + 1);
    struct scree_memory tight = {.limit_bytes = 100};
    struct decoded_tile tile;
    CU_ASSERT_EQUAL(decoded_tile_read(&tight, bytes, size_bytes, &tile, NULL), SCREE_E_LIMIT);
    CU_ASSERT_EQUAL(tight.used_bytes, 0);
    free(bytes);
}

static void gzip_is_inflated_within_its_bound(void) {
    size_t size_bytes, gzip_bytes, plain_bytes;
    unsigned char *bytes = sample_tile(true, &size_bytes);
    unsigned char *packed = tile_gzip(bytes, size_bytes, &gzip_bytes), *plain;
    struct scree_memory memory = {0};
    CU_ASSERT_TRUE(inflate_is_gzip(packed, gzip_bytes));
    CU_ASSERT_FALSE(inflate_is_gzip(bytes, size_bytes));
    CU_ASSERT_EQUAL_FATAL(inflate_new(&memory, packed, gzip_bytes, 1 << 20, &plain, &plain_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(plain_bytes, size_bytes);
    CU_ASSERT_EQUAL(memcmp(plain, bytes, size_bytes), 0);
    scree_release(&memory, plain);
    CU_ASSERT_EQUAL_FATAL(inflate_new(&memory, packed, gzip_bytes, size_bytes, &plain, &plain_bytes, NULL), SCREE_OK);
    scree_release(&memory, plain);
    CU_ASSERT_EQUAL(inflate_new(&memory, packed, gzip_bytes, size_bytes - 1, &plain, &plain_bytes, NULL),
                    SCREE_E_LIMIT);
    for (size_t i = 0; i < gzip_bytes; i++) {
        unsigned char *cut = malloc(i + (i == 0));
        memcpy(cut, packed, i);
        CU_ASSERT_EQUAL(inflate_new(&memory, cut, i, 1 << 20, &plain, &plain_bytes, NULL), SCREE_E_CORRUPT);
        free(cut);
    }
    unsigned char *longer = calloc(gzip_bytes + 1, 1);
    memcpy(longer, packed, gzip_bytes);
    CU_ASSERT_EQUAL(inflate_new(&memory, longer, gzip_bytes + 1, 1 << 20, &plain, &plain_bytes, NULL), SCREE_E_CORRUPT);
    packed[gzip_bytes - 6] ^= 1; /* the checksum */
    CU_ASSERT_EQUAL(inflate_new(&memory, packed, gzip_bytes, 1 << 20, &plain, &plain_bytes, NULL), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(longer);
    free(packed);
    free(bytes);
}

static void a_gzip_bomb_meets_the_limit(void) {
    size_t gzip_bytes, plain_bytes, zeros = 50 << 20;
    unsigned char *zero = calloc(zeros, 1), *plain;
    unsigned char *packed = tile_gzip(zero, zeros, &gzip_bytes);
    struct scree_memory memory = {.limit_bytes = 4 << 20};
    CU_ASSERT_EQUAL(inflate_new(&memory, packed, gzip_bytes, 1 << 20, &plain, &plain_bytes, NULL), SCREE_E_LIMIT);
    CU_ASSERT(memory.peak_bytes < 3 << 20);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(packed);
    free(zero);
}

static unsigned char *read_file(const char *folder, const char *name, size_t *size_bytes) {
    char path[1024];
    snprintf(path, sizeof path, "%s/qmesh/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (file == NULL) return NULL;
    unsigned char *bytes = malloc(4 << 20);
    *size_bytes = fread(bytes, 1, 4 << 20, file);
    fclose(file);
    return bytes;
}

static void tiles_of_other_producers_are_read(void) {
    static const struct {
        const char *name;
        uint32_t vertices, triangles;
        bool normals, water_mask, metadata;
        uint32_t unknown_extensions;
    } tiles[] = {
        {"cesium_9_759_335_9_759_335.terrain", 2460, 4755, true, true, true, 0},
        {"cesium_tile.32bitIndices.terrain", 65612, 131103, false, false, false, 0},
        {"cesium_tile.metadataavailability.terrain", 208, 380, false, false, true, 1},
        {"cesium_tile.octvertexnormals.terrain", 214, 392, true, false, false, 0},
        {"cesium_tile.octvertexnormals.unknownext.terrain", 214, 392, true, false, false, 1},
        {"cesium_tile.octvertexnormals.watermask.terrain", 218, 400, true, true, false, 0},
        {"cesium_tile.terrain", 219, 402, false, false, false, 0},
        {"cesium_tile.unknownext.terrain", 214, 392, false, false, false, 1},
        {"cesium_tile.watermask.terrain", 218, 400, false, true, false, 0},
        {"maptiler_10_1070_778.terrain", 709, 2078, true, false, false, 0},
        {"tile-with-extensions.terrain", 627, 1175, true, true, false, 0},
    };
    const char *folder = tile_test_data("tiles of other producers");
    if (folder == NULL) return;
    for (size_t t = 0; t < sizeof tiles / sizeof *tiles; t++) {
        struct scree_memory memory = {.limit_bytes = BUDGET_BYTES};
        struct scree_error error = {0};
        struct decoded_tile tile;
        size_t size_bytes = 0;
        unsigned char *bytes = read_file(folder, tiles[t].name, &size_bytes), *plain = NULL;
        CU_ASSERT_PTR_NOT_NULL_FATAL(bytes);
        if (inflate_is_gzip(bytes, size_bytes)) {
            size_t plain_bytes;
            CU_ASSERT_EQUAL_FATAL(inflate_new(&memory, bytes, size_bytes, BUDGET_BYTES, &plain, &plain_bytes, &error),
                                  SCREE_OK);
            memcpy(bytes, plain, plain_bytes);
            size_bytes = plain_bytes;
            scree_release(&memory, plain);
        }
        CU_ASSERT_EQUAL(decoded_tile_read(&memory, bytes, size_bytes, &tile, &error), SCREE_OK);
        CU_ASSERT_EQUAL(tile.vertex_count, tiles[t].vertices);
        CU_ASSERT_EQUAL(tile.triangle_count, tiles[t].triangles);
        CU_ASSERT_EQUAL(tile.normals != NULL, tiles[t].normals);
        CU_ASSERT_EQUAL(tile.has_water_mask, tiles[t].water_mask);
        CU_ASSERT_EQUAL(tile.has_metadata, tiles[t].metadata);
        CU_ASSERT_EQUAL(tile.unknown_extensions, tiles[t].unknown_extensions);
        CU_ASSERT(tile.height_min_m > -12000 && tile.height_max_m < 9000);
        decoded_tile_free(&memory, &tile);
        for (size_t i = 0; i < size_bytes; i += 1 + size_bytes / 300) decode_and_check(bytes, i);
        free(bytes);
    }
}

int suite_decode(void) {
    CU_TestInfo tests[] = {
        {"what was encoded is decoded", what_was_encoded_is_decoded},
        {"wide indices are decoded", wide_indices_are_decoded},
        {"every truncation is an error", every_truncation_is_an_error},
        {"random damage never crashes", random_damage_never_crashes},
        {"huge counts cost nothing", huge_counts_cost_nothing},
        {"unknown extensions are skipped", unknown_extensions_are_skipped},
        {"every allocation may fail", every_allocation_may_fail},
        {"gzip is inflated within its bound", gzip_is_inflated_within_its_bound},
        {"a gzip bomb meets the limit", a_gzip_bomb_meets_the_limit},
        {"tiles of other producers are read", tiles_of_other_producers_are_read},
        CU_TEST_INFO_NULL,
    };
    CU_SuiteInfo suites[] = {{"decode", NULL, NULL, NULL, NULL, tests}, CU_SUITE_INFO_NULL};
    return CU_register_suites(suites) == CUE_SUCCESS ? 0 : 1;
}
