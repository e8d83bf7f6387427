/* Land use on posts: what rules say, which posts polygons cover, roads that meet bridges, waters that are told apart.
 */
#include "lod/context_filter.h"
#include "src/landuse_io.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <stdio.h>
#include <string.h>

enum { COLUMNS = 40, ROWS = 30, POSTS = COLUMNS * ROWS };

static uint8_t is_outside[POSTS];

/* Posts at whole numbers. */
static struct filter_raster raster(void) {
    static char no_crs[] = "";
    return (struct filter_raster){
        .columns = COLUMNS, .rows = ROWS, .spacing_x = 1, .spacing_y = 1, .crs_wkt = no_crs, .is_outside = is_outside};
}

/* Of rectangles, west, south, east and north a use each. */
struct rectangle {
    const char *use;
    double west, south, east, north;
};

static const char *write_rectangles(const struct rectangle *rectangles, size_t count) {
    static const char path[] = "/vsimem/landuse.json";
    VSILFILE *file = VSIFOpenL(path, "wb");
    VSIFPrintfL(file, "{\"type\":\"FeatureCollection\",\"features\":[");
    for (size_t i = 0; i < count; i++) {
        const struct rectangle *r = &rectangles[i];
        VSIFPrintfL(file,
                    "%s{\"type\":\"Feature\",\"properties\":{\"class\":\"%s\"},\"geometry\":{\"type\":\"Polygon\","
                    "\"coordinates\":[[[%g,%g],[%g,%g],[%g,%g],[%g,%g],[%g,%g]]]}}",
                    i > 0 ? "," : "", r->use, r->west, r->south, r->east, r->south, r->east, r->north, r->west,
                    r->north, r->west, r->south);
    }
    VSIFPrintfL(file, "]}");
    VSIFCloseL(file);
    return path;
}

static void posts_have_the_uses_around_them(void) {
    static const struct rectangle rectangles[] = {
        {"water", -5, -5, 9.5, 9.5},       {"water", 20.5, 3.5, 24.5, 9.5}, {"bridge", 8.5, 8.5, 12.5, 20.5},
        {"road", 12, 15, 30.5, 17.5},      {"road", 13, 22, 30, 24},        {"forest", 0.5, 0.5, 3.5, 1.5},
        {"railway", 37.5, 24.5, 60, 27.2}, {"water", 50, 5, 60, 9},         {"meadow", 0, 0, 40, 30}};
    struct scree_memory memory = {0};
    struct landuse_posts posts;
    struct filter_raster on = raster();
    GDALAllRegister();
    memset(is_outside, 0, sizeof is_outside);
    is_outside[5] = 1;
    const char *path = write_rectangles(rectangles, sizeof rectangles / sizeof *rectangles);
    CU_ASSERT_EQUAL_FATAL(landuse_read(&memory, path, NULL, &on, &posts, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(posts.features[LANDUSE_WATER], 2);
    CU_ASSERT_EQUAL(posts.features[LANDUSE_ROAD], 2);
    CU_ASSERT_EQUAL(posts.ramps, 1);
    CU_ASSERT_EQUAL(posts.outside, 1);
    CU_ASSERT_EQUAL(posts.repaired + posts.empty, 0);
    CU_ASSERT_EQUAL(posts.water_count, 2);
    for (int32_t y = 0; y < ROWS; y++)
        for (int32_t x = 0; x < COLUMNS; x++) {
            uint8_t wanted = 0;
            uint32_t water = 0;
            for (size_t i = 0; i < 7; i++) {
                static const uint8_t bits[] = {GROUND_WATER,  GROUND_WATER,  GROUND_BRIDGE, GROUND_RAMP, 0,
                                               GROUND_FOREST, GROUND_RAILWAY};
                const struct rectangle *r = &rectangles[i];
                if (x <= r->west || x >= r->east || y <= r->south || y >= r->north) continue;
                wanted |= bits[i];
                if (i < 2) water = (uint32_t)i + 1;
            }
            const int32_t post = y * COLUMNS + x;
            if (wanted & GROUND_BRIDGE) water = 0;
            const bool is_edge = (x == 12 && y > 14 && y < 21) || y == 15;
            if (!is_edge) CU_ASSERT_EQUAL(posts.uses[post], wanted);
            CU_ASSERT_EQUAL(posts.waters[post], is_outside[post] ? 0 : water);
        }
    landuse_free(&memory, &posts);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    VSIUnlink(path);
}

static void little_memory_is_survived(void) {
    static const struct rectangle rectangles[] = {{"water", 2, 2, 9, 9}, {"bridge", 1, 1, 5, 5}, {"road", 1, 1, 5, 5}};
    const char *path = write_rectangles(rectangles, sizeof rectangles / sizeof *rectangles);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t n = 1;
    struct filter_raster on = raster();
    for (; status != SCREE_OK && n < 100; n++) {
        struct scree_memory memory = {.fail_request = n};
        struct scree_error error = {0};
        struct landuse_posts posts;
        status = landuse_read(&memory, path, NULL, &on, &posts, &error);
        CU_ASSERT_EQUAL(error.status, status);
        landuse_free(&memory, &posts);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT(n > 8 && n < 100);
    VSIUnlink(path);
}

static void rules_are_lines(void) {
    static const char text[] = "  # nothing\n\nwater\tnatural = water  # a lake\r\nroad highway=*\nforest name=a=b c";
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct landuse_rules rules;
    CU_ASSERT_EQUAL_FATAL(landuse_rules_parse(&memory, "rules", text, strlen(text), &rules, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(rules.count, 3);
    CU_ASSERT_EQUAL(rules.rules[0].use, LANDUSE_WATER);
    CU_ASSERT_STRING_EQUAL(rules.rules[0].attribute, "natural");
    CU_ASSERT_STRING_EQUAL(rules.rules[0].value, "water");
    CU_ASSERT_EQUAL(rules.rules[1].use, LANDUSE_ROAD);
    CU_ASSERT_PTR_NULL(rules.rules[1].value);
    CU_ASSERT_STRING_EQUAL(rules.rules[2].value, "a=b c");
    landuse_rules_free(&memory, &rules);
    CU_ASSERT_EQUAL_FATAL(landuse_rules_parse(&memory, "rules", NULL, 0, &rules, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(rules.count, LANDUSE_COUNT);
    landuse_rules_free(&memory, &rules);
    static const char zeros[] = "water a=b\n\0\0water c=d\nriver e=f\n";
    CU_ASSERT_EQUAL(landuse_rules_parse(&memory, "rules", zeros, sizeof zeros - 1, &rules, &error), SCREE_E_CORRUPT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "rules, line 3"));
    landuse_rules_free(&memory, &rules);
    CU_ASSERT_EQUAL(landuse_rules_parse(&memory, "rules", "", 0, &rules, NULL), SCREE_E_CORRUPT);
    landuse_rules_free(&memory, &rules);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_landuse(void) {
    CU_pSuite suite = CU_add_suite("land use", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, posts_have_the_uses_around_them);
    CU_ADD_TEST(suite, little_memory_is_survived);
    CU_ADD_TEST(suite, rules_are_lines);
    return 0;
}
