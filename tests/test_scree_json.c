/* scree.json: what is written is read again, and what is no such file is refused in one line. */
#include "src/scree_json.h"
#include "src/scree_read_io.h"
#include "tests/terrain_maker.h"

#include <CUnit/CUnit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RUNGS 13

/* A manifest with all that it points to. */
struct world {
    struct lattice lattice;
    struct tile_id roots[2], finer[3];
    double tolerance_m[RUNGS];
    struct stream_zoom zooms[3];
    struct stream_manifest manifest;
};

static struct scree_rung rung_of(int32_t rung, uint32_t vertices, float svo_m, float max_error_m) {
    return (struct scree_rung){.rung = rung,
                               .vertex_count = vertices,
                               .triangle_count = 2 * vertices - 6,
                               .svo_m = svo_m,
                               .max_error_m = max_error_m};
}

static void add_tile(struct stream_zoom *zoom, struct scree_rung coarsest, struct scree_rung finest, uint64_t bytes) {
    const struct stream_tile_figures tile = {coarsest, finest, bytes};
    stream_zoom_add(zoom, &tile);
}

static struct world *world_new(void) {
    struct world *world = calloc(1, sizeof *world);
    world->lattice = lattice_geodetic(2);
    world->roots[1].x = 1;
    world->finer[0] = (struct tile_id){1, 2, 0};
    world->finer[1] = (struct tile_id){1, 3, 0};
    world->finer[2] = (struct tile_id){1, 3, 1};
    for (int i = 0; i < RUNGS; i++) world->tolerance_m[i] = 1000.0 / (i + 1);
    add_tile(&world->zooms[0], rung_of(-4, 4, 9.5F, 700), rung_of(0, 30, 3, 400), 300);
    add_tile(&world->zooms[0], rung_of(-3, 10, 8.5F, 900), rung_of(-1, 20, 4, 100), 200);
    for (int i = 0; i < 3; i++) add_tile(&world->zooms[1], rung_of(0, 12, 3, 400), rung_of(4, 99, 1.1F, 30), 1000);
    world->zooms[0].tiles = world->roots;
    world->zooms[1].tiles = world->finer;
    world->manifest = (struct stream_manifest){.lattice = &world->lattice,
                                               .max_zoom = 2,
                                               .bounds = {100, -10, 190, 5},
                                               .crs_wkt = "GEOGCRS[\"WGS 84\"]",
                                               .datum = "assumed \"ellipsoidal\"",
                                               .attribution = "somebody \xc3\xa9",
                                               .nodata_height_m = -7.5,
                                               .height_exponent = -3,
                                               .finest_octaves = 2,
                                               .is_lossless = true,
                                               .rungs_per_increment = 2,
                                               .first_rung = -4,
                                               .rung_count = RUNGS,
                                               .tolerance_m = world->tolerance_m,
                                               .zooms = world->zooms};
    return world;
}

static char *text_of(const struct world *world) {
    char *text = scree_json_new(&world->manifest, NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(text);
    return text;
}

static void sums_are_of_all_tiles(void) {
    struct world *world = world_new();
    const struct stream_zoom *zoom = &world->zooms[0];
    CU_ASSERT_EQUAL(zoom->tile_count, 2);
    CU_ASSERT_EQUAL(zoom->bytes, 500);
    CU_ASSERT_EQUAL(zoom->coarsest.rung, -4);
    CU_ASSERT_EQUAL(zoom->finest.rung, 0);
    CU_ASSERT_EQUAL(zoom->coarsest.vertices, 14);
    CU_ASSERT_EQUAL(zoom->finest.triangles, 54 + 34);
    CU_ASSERT_EQUAL(zoom->coarsest.svo_min_m, 8.5);
    CU_ASSERT_EQUAL(zoom->coarsest.svo_max_m, 9.5);
    CU_ASSERT_EQUAL(zoom->finest.error_min_m, 100);
    CU_ASSERT_EQUAL(zoom->finest.error_max_m, 400);
    free(world);
}

/* ---- there and back ---- */

/* Writes the text as a file and reads it. */
static enum scree_status read_text(struct scree_memory *memory, const char *text, struct scree_info *info,
                                   struct scree_error *error) {
    char path[300];
    struct made_terrain terrain = made_terrain_globe(false); /* for its folder */
    made_terrain_text(&terrain, "scree.json", text);
    snprintf(path, sizeof path, "%s/scree.json", terrain.folder);
    enum scree_status status = scree_read(memory, path, info, error);
    made_terrain_remove(&terrain);
    return status;
}

static void check_scale(const struct stream_scale *got, const struct stream_scale *wanted) {
    CU_ASSERT_EQUAL(got->rung, wanted->rung);
    CU_ASSERT_EQUAL(got->vertices, wanted->vertices);
    CU_ASSERT_EQUAL(got->triangles, wanted->triangles);
    CU_ASSERT_EQUAL(got->svo_min_m, wanted->svo_min_m);
    CU_ASSERT_EQUAL(got->svo_max_m, wanted->svo_max_m);
    CU_ASSERT_EQUAL(got->error_min_m, wanted->error_min_m);
    CU_ASSERT_EQUAL(got->error_max_m, wanted->error_max_m);
}

static void what_is_written_is_read(void) {
    struct world *world = world_new();
    struct scree_memory memory = {0};
    struct scree_info info;
    const struct stream_manifest *manifest = &world->manifest;
    char *text = text_of(world);
    CU_ASSERT_EQUAL_FATAL(read_text(&memory, text, &info, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(memcmp(&info.lattice, &world->lattice, sizeof info.lattice), 0);
    CU_ASSERT_EQUAL(memcmp(info.bounds, manifest->bounds, sizeof info.bounds), 0);
    CU_ASSERT_EQUAL(info.min_zoom, 0);
    CU_ASSERT_EQUAL(info.max_zoom, 2);
    CU_ASSERT_STRING_EQUAL(info.crs_wkt, manifest->crs_wkt);
    CU_ASSERT_STRING_EQUAL(info.datum, manifest->datum);
    CU_ASSERT_STRING_EQUAL(info.attribution, manifest->attribution);
    CU_ASSERT_EQUAL(info.nodata_height_m, -7.5);
    CU_ASSERT_EQUAL(info.height_exponent, -3);
    CU_ASSERT_EQUAL(info.finest_octaves, 2);
    CU_ASSERT_TRUE(info.is_lossless);
    CU_ASSERT_EQUAL(info.rungs_per_increment, 2);
    CU_ASSERT_EQUAL(info.first_rung, -4);
    CU_ASSERT_EQUAL_FATAL(info.rung_count, RUNGS);
    CU_ASSERT_EQUAL(memcmp(info.tolerance_m, world->tolerance_m, sizeof world->tolerance_m), 0);
    for (int zoom = 0; zoom <= 2; zoom++) {
        CU_ASSERT_TRUE(info.zooms[zoom].is_told);
        CU_ASSERT_EQUAL(info.zooms[zoom].tiles, world->zooms[zoom].tile_count);
        CU_ASSERT_EQUAL(info.zooms[zoom].bytes, world->zooms[zoom].bytes);
        check_scale(&info.zooms[zoom].coarsest, &world->zooms[zoom].coarsest);
        check_scale(&info.zooms[zoom].finest, &world->zooms[zoom].finest);
    }
    CU_ASSERT_EQUAL(info.available.counts[0], 1);
    CU_ASSERT_EQUAL(info.available.counts[1], 2);
    CU_ASSERT_EQUAL(info.available.ranges[1][0].x_first, 2);
    CU_ASSERT_EQUAL(info.available.ranges[1][0].x_last, 3);
    CU_ASSERT_EQUAL(info.available.ranges[1][1].y_last, 1);
    scree_info_free(&memory, &info);
    scree_info_free(&memory, &info);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(text);
    free(world);
}

static void a_local_lattice_is_read(void) {
    struct world *world = world_new();
    struct scree_memory memory = {0};
    struct scree_info info;
    CU_ASSERT_EQUAL_FATAL(lattice_local(1025, 700, 377015.25, 3789000.125, 28.5, 30, 0.3048, &world->lattice, NULL),
                          SCREE_OK);
    world->zooms[0].tile_count = world->zooms[1].tile_count = 1;
    world->finer[0].x = 1;
    char *text = text_of(world);
    CU_ASSERT_PTR_NOT_NULL(strstr(text, "\"projection\": \"GEOGCRS["));
    CU_ASSERT_EQUAL_FATAL(read_text(&memory, text, &info, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(memcmp(&info.lattice, &world->lattice, sizeof info.lattice), 0);
    scree_info_free(&memory, &info);
    free(text);
    free(world);
}

static void versions_follow_the_tiles(void) {
    struct world *world = world_new();
    char *text = text_of(world), *same = text_of(world);
    CU_ASSERT_STRING_EQUAL(text, same);
    world->zooms[1].bytes++;
    char *other = text_of(world);
    CU_ASSERT_NOT_EQUAL(strncmp(strstr(text, "1.0.0-"), strstr(other, "1.0.0-"), strlen("1.0.0-12345678")), 0);
    free(other);
    free(same);
    free(text);
    free(world);
}

/* ---- what is no manifest ---- */

/* The good text with its first `what` replaced by `with`. */
static char *replaced(const char *text, const char *what, const char *with) {
    const char *at = strstr(text, what);
    CU_ASSERT_PTR_NOT_NULL_FATAL(at);
    size_t size_bytes = strlen(text) - strlen(what) + strlen(with) + 1;
    char *copy = malloc(size_bytes);
    snprintf(copy, size_bytes, "%.*s%s%s", (int)(at - text), text, with, at + strlen(what));
    return copy;
}

static const struct {
    const char *what, *with;
    enum scree_status status;
    const char *line; /* a part of it */
} defects[] = {
    {"\"format\"", "\"form\"", SCREE_E_CORRUPT, "no format"},
    {"scree-stream", "scree-strange", SCREE_E_UNSUPPORTED, "scree-strange"},
    {"\"format_version\": 1", "\"format_version\": 2", SCREE_E_UNSUPPORTED, "up to 1"},
    {"\"format_version\": 1", "\"format_version\": 0", SCREE_E_CORRUPT, "no version"},
    {"\"format_version\": 1", "\"format_version\": 1e300", SCREE_E_CORRUPT, "no version"},
    {"\"tms\"", "\"xyz\"", SCREE_E_UNSUPPORTED, "xyz"},
    {"\"geodetic\"", "\"mercator\"", SCREE_E_CORRUPT, "profile"},
    {"\"lattice\"", "\"lettuce\"", SCREE_E_CORRUPT, "lattice"},
    {"\"finest_zoom\": 2", "\"finest_zoom\": 99", SCREE_E_CORRUPT, "finest_zoom"},
    {"\"max_zoom\": 2", "\"max_zoom\": 3", SCREE_E_CORRUPT, "max_zoom"},
    {"\"min_zoom\": 0", "\"min_zoom\": -1", SCREE_E_CORRUPT, "min_zoom"},
    {"\"height_exponent\": -3", "\"height_exponent\": 4000", SCREE_E_CORRUPT, "height_exponent"},
    {"\"data_bounds\": [100, ", "\"data_bounds\": [", SCREE_E_CORRUPT, "data_bounds"},
    {"\"ladder\": {", "\"ladder\": 7, \"rest\": {", SCREE_E_CORRUPT, "ladder"},
    {"\"first_rung\": -4", "\"first_rung\": 0.5", SCREE_E_CORRUPT, "first_rung"},
    {"\"finest_octaves\": 2", "\"finest_octaves\": 1e18", SCREE_E_CORRUPT, "finest_octaves"},
    {"\"rungs_per_increment\": 2", "\"rungs_per_increment\": 0", SCREE_E_CORRUPT, "rungs_per_increment"},
    {"[1000, 500,", "[1000, \"500\",", SCREE_E_CORRUPT, "item 1 of its ladder.tolerance_m"},
    {"[1000, 500,", "[1000, 1001,", SCREE_E_CORRUPT, "item 1 of its ladder.tolerance_m"},
    {"[1000, 500,", "[1000, -5,", SCREE_E_CORRUPT, "item 1 of its ladder.tolerance_m"},
    {"\"tolerance_m\": [", "\"tolerance_m\": 3, \"rest\": [", SCREE_E_CORRUPT, "ladder.tolerance_m"},
    {"\"zooms\": [", "\"zooms\": 0, \"rest\": [", SCREE_E_CORRUPT, "zooms"},
    {"\"zoom\": 1", "\"zoom\": 0", SCREE_E_CORRUPT, "item 1 of its zooms"},
    {"\"zoom\": 2", "\"zoom\": 3", SCREE_E_CORRUPT, "item 2 of its zooms"},
    {"\"tiles\": 3", "\"tiles\": -3", SCREE_E_CORRUPT, "zoom 1"},
    {"\"svo_m\": [8.5, 9.5]", "\"svo_m\": [9.5, 8.5]", SCREE_E_CORRUPT, "zoom 0"},
    {"\"svo_m\": [8.5, 9.5]", "\"svo_m\": [8.5]", SCREE_E_CORRUPT, "zoom 0"},
    {"\"available\": [", "\"unavailable\": [", SCREE_E_CORRUPT, "available"},
    {"\"startX\": 2", "\"startX\": 4294967298", SCREE_E_CORRUPT, "range 0 of zoom 1"},
    {"\"endX\": 3", "\"endX\": 1", SCREE_E_CORRUPT, "range 0 of zoom 1"},
};

static void defects_are_told_in_one_line(void) {
    struct world *world = world_new();
    char *text = text_of(world);
    for (size_t i = 0; i < sizeof defects / sizeof *defects; i++) {
        struct scree_memory memory = {0};
        struct scree_error error = {0};
        struct scree_info info;
        char *spoilt = replaced(text, defects[i].what, defects[i].with);
        CU_ASSERT_EQUAL(read_text(&memory, spoilt, &info, &error), defects[i].status);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "scree.json: "));
        if (strstr(error.text, defects[i].line) == NULL) {
            CU_FAIL("another line was wanted");
            printf("\n    %s -> %s\n", defects[i].with, error.text);
        }
        CU_ASSERT_PTR_NULL(strchr(error.text, '\n'));
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
        free(spoilt);
    }
    free(text);
    free(world);
}

/* Cut off anywhere it is no JSON, and nothing of it stays. */
static void what_is_cut_off_is_refused(void) {
    struct world *world = world_new();
    char *text = text_of(world);
    size_t size_bytes = strlen(text);
    for (size_t cut = 0; cut + 2 < size_bytes; cut += 1 + size_bytes / 40) {
        struct scree_memory memory = {0};
        struct scree_info info;
        char kept = text[cut];
        text[cut] = '\0';
        CU_ASSERT_EQUAL(read_text(&memory, text, &info, NULL), SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
        text[cut] = kept;
    }
    free(text);
    free(world);
}

static void want_of_memory_is_told(void) {
    struct world *world = world_new();
    char *text = text_of(world);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 1;
    for (; status != SCREE_OK && request < 100; request++) {
        struct scree_memory memory = {.fail_request = request};
        struct scree_info info;
        status = read_text(&memory, text, &info, NULL);
        if (status == SCREE_OK) scree_info_free(&memory, &info);
        CU_ASSERT(status == SCREE_OK || status == SCREE_E_MEMORY);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT(request > 5 && request < 100);
    free(text);
    free(world);
}

int suite_scree_json(void) {
    CU_pSuite suite = CU_add_suite("scree_json", NULL, NULL);
    if (suite == NULL) return 1;
    static const struct {
        const char *name;
        CU_TestFunc run;
    } tests[] = {
        {"sums are of all tiles", sums_are_of_all_tiles},
        {"what is written is read", what_is_written_is_read},
        {"a local lattice is read", a_local_lattice_is_read},
        {"versions follow the tiles", versions_follow_the_tiles},
        {"defects are told in one line", defects_are_told_in_one_line},
        {"what is cut off is refused", what_is_cut_off_is_refused},
        {"want of memory is told", want_of_memory_is_told},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (CU_add_test(suite, tests[i].name, tests[i].run) == NULL) return 1;
    return 0;
}
