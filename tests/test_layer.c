/* layer.json and the JSON writer below it. */
#include "src/json_text.h"
#include "src/layer_json.h"

#include <CUnit/CUnit.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- JSON ---- */

static void check_text(struct json_text *json, const char *wanted) {
    char *text = json_text_take(json);
    CU_ASSERT_PTR_NOT_NULL_FATAL(text);
    CU_ASSERT_STRING_EQUAL(text, wanted);
    free(text);
}

static void values_are_laid_out(void) {
    struct json_text json = {0};
    json_open(&json, '{');
    json_key(&json, "empty");
    json_open(&json, '[');
    json_close(&json, ']');
    json_key(&json, "line");
    json_open_line(&json, '[');
    json_integer(&json, INT64_MIN);
    json_open(&json, '{');
    json_key(&json, "k");
    json_boolean(&json, true);
    json_close(&json, '}');
    json_boolean(&json, false);
    json_close(&json, ']');
    json_key(&json, "deep");
    json_open(&json, '[');
    json_string(&json, NULL);
    json_string(&json, "s");
    json_close(&json, ']');
    json_close(&json, '}');
    check_text(&json, "{\n  \"empty\": [],\n  \"line\": [-9223372036854775808, {\"k\": true}, false],\n"
                      "  \"deep\": [\n    null,\n    \"s\"\n  ]\n}\n");
}

static void check_string(const char *string, const char *wanted) {
    struct json_text json = {0};
    json_string(&json, string);
    check_text(&json, wanted);
}

static void strings_are_escaped(void) {
    check_string("a \"b\" \\ /", "\"a \\\"b\\\" \\\\ /\"\n");
    check_string("\n\t\x01\x7f", "\"\\u000a\\u0009\\u0001\\u007f\"\n");
    check_string("\xc3\xa9\xe2\x82\xac\xf0\x9f\x8f\x94", "\"\xc3\xa9\xe2\x82\xac\xf0\x9f\x8f\x94\"\n");
    check_string("\xff", "\"\xef\xbf\xbd\"\n");
    check_string("\xc3", "\"\xef\xbf\xbd\"\n");                                   /* cut off */
    check_string("\xc0\xaf", "\"\xef\xbf\xbd\xef\xbf\xbd\"\n");                   /* an overlong slash */
    check_string("\xed\xa0\x80x", "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbdx\"\n"); /* a surrogate */
    check_string("\xf4\x90\x80\x80", "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\"\n");
}

static void check_number(double number, const char *wanted) {
    struct json_text json = {0};
    json_number(&json, number);
    check_text(&json, wanted);
}

static void numbers_are_short_and_exact(void) {
    check_number(0.1, "0.1\n");
    check_number(-118.25, "-118.25\n");
    check_number(1.0 / 3, "0.3333333333333333\n");
    check_number(0.1 + 0.2, "0.30000000000000004\n");
    check_number(1e300, "1e+300\n");
    check_number(-0.0, "-0\n");
    check_number(NAN, "null\n");
    check_number(INFINITY, "null\n");
}

/* Where a locale with a decimal comma is installed, numbers still have points. */
static void numbers_ignore_the_locale(void) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE", "ps_AF.UTF-8"};
    locale_t comma = (locale_t)0;
    for (size_t i = 0; i < sizeof names / sizeof *names && comma == (locale_t)0; i++)
        comma = newlocale(LC_NUMERIC_MASK, names[i], (locale_t)0);
    if (comma == (locale_t)0) {
        printf("skipped: no locale with a decimal comma is installed ... ");
        return;
    }
    locale_t before = uselocale(comma);
    check_number(1234.5, "1234.5\n");
    check_number(1.0 / 3, "0.3333333333333333\n");
    uselocale(before);
    freelocale(comma);
}

/* ---- layer.json ---- */

static int compare_tiles(const void *a, const void *b) {
    const struct tile_id *left = a, *right = b;
    if (left->y != right->y) return left->y < right->y ? -1 : 1;
    return left->x < right->x ? -1 : left->x > right->x;
}

struct world {
    struct lattice lattice;
    struct layer_zoom zooms[3];
    struct layer layer;
};

static struct world *world_new(void) {
    struct world *world = calloc(1, sizeof *world);
    static const struct tile_id roots[] = {{0, 0, 0}, {0, 1, 0}}, one[] = {{1, 3, 0}};
    world->lattice = lattice_geodetic(2);
    world->zooms[0] = (struct layer_zoom){.tolerance_m = 1000, .tile_count = 2, .tiles = roots, .bytes = 1u << 31};
    world->zooms[1] = (struct layer_zoom){.tolerance_m = 500, .tile_count = 1, .tiles = one};
    world->zooms[2] = (struct layer_zoom){.tolerance_m = 250, .svo_m = 0.5, .max_error_m = 249.5};
    world->layer = (struct layer){.lattice = &world->lattice,
                                  .max_zoom = 2,
                                  .bounds = {100, -91, 190, 5},
                                  .crs_wkt = "GEOGCS[\"WGS 84\"]",
                                  .datum = "assumed \"ellipsoidal\"",
                                  .has_normals = true,
                                  .zooms = world->zooms};
    return world;
}

static char *text_of(const struct layer *layer) {
    struct scree_error error = {0};
    char *text = layer_json_new(layer, &error);
    CU_ASSERT_PTR_NOT_NULL_FATAL(text);
    return text;
}

static void check_says(const struct layer *layer, const char *wanted) {
    char *text = text_of(layer);
    CU_ASSERT_PTR_NOT_NULL(strstr(text, wanted));
    free(text);
}

static void what_clients_need_is_there(void) {
    struct world *world = world_new();
    static const char *const wanted[] = {
        "\"tilejson\": \"2.1.0\"",
        "\"format\": \"quantized-mesh-1.0\"",
        "\"version\": \"1.0.0-",
        "\"scheme\": \"tms\"",
        "\"projection\": \"EPSG:4326\"",
        "\"tiles\": [\"{z}/{x}/{y}.terrain?v={version}\"]",
        "\"minzoom\": 0",
        "\"maxzoom\": 2",
        "\"bounds\": [-180, -90, 180, 5]",
        "\"extensions\": [\"octvertexnormals\"]",
        "\"attribution\": \"\"",
        "\"data_bounds\": [100, -91, 190, 5]",
        "\"datum\": \"assumed \\\"ellipsoidal\\\"\"",
        "\"profile\": \"geodetic\"",
        "\"gzip\": false",
        "\"spacing_x\": 0.17578125",
        "\"columns\": 2049",
        "{\"zoom\": 2, \"tolerance_m\": 250, \"height_step_m\": 0, \"max_error_m\": 249.5, \"svo_m\": 0.5, \"tiles\": "
        "0,",
        "\"bytes\": 2147483648}",
        "\"available\": [\n    [\n      {\"startX\": 0, \"startY\": 0, \"endX\": 1, \"endY\": 0}\n    ],\n    [\n"
        "      {\"startX\": 3, \"startY\": 0, \"endX\": 3, \"endY\": 0}\n    ],\n    []\n  ]"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) check_says(&world->layer, wanted[i]);
    world->layer.has_normals = false;
    world->layer.is_gzipped = true;
    check_says(&world->layer, "\"extensions\": []");
    check_says(&world->layer, "\"gzip\": true");
    free(world);
}

/* The eight digits of the version, as a number. */
static unsigned long version_of(const struct layer *layer) {
    char *text = text_of(layer);
    unsigned long version = strtoul(strstr(text, "\"1.0.0-") + 7, NULL, 16);
    free(text);
    return version;
}

static void versions_follow_the_tiles(void) {
    struct world *world = world_new(), *same = world_new();
    unsigned long version = version_of(&world->layer);
    CU_ASSERT_EQUAL(version, version_of(&same->layer));
    same->layer.attribution = "somebody";
    CU_ASSERT_EQUAL(version, version_of(&same->layer));
    same->zooms[2].bytes++;
    CU_ASSERT_NOT_EQUAL(version, version_of(&same->layer));
    free(same);
    free(world);
}

static void check_projection(struct world *world, const char *wkt, const char *wanted) {
    world->layer.crs_wkt = wkt;
    check_says(&world->layer, wanted);
}

static void local_layers_name_their_crs(void) {
    struct world *world = world_new();
    CU_ASSERT_EQUAL(lattice_local(1025, 700, 1e6, 2e6, 10, 10, 1, &world->lattice, NULL), SCREE_OK);
    check_projection(world,
                     "PROJCS[\"UTM, [zone] 11\",GEOGCS[\"WGS 84\",AUTHORITY[\"EPSG\",\"4326\"]],UNIT[\"m\",1],"
                     "AUTHORITY[\"EPSG\",\"32611\"]]",
                     "\"projection\": \"EPSG:32611\"");
    check_projection(world,
                     "PROJCRS[\"x\",\n    BASEGEOGCRS[\"y\",\n        ID[\"EPSG\",4269]],\n    ID[\"ESRI\",102003]]",
                     "\"projection\": \"ESRI:102003\"");
    check_projection(world, "LOCAL_CS[\"mine\",UNIT[\"m\",1]]",
                     "\"projection\": \"LOCAL_CS[\\\"mine\\\",UNIT[\\\"m\\\",1]]\"");
    check_projection(world, "", "\"projection\": \"none\"");
    check_projection(world, NULL, "\"projection\": \"none\"");
    check_projection(world, "PROJCS[\"cut\",AUTHORITY[", "\"projection\": \"PROJCS[");
    check_says(&world->layer, "\"bounds\": [100, -91, 190, 5]"); /* not degrees: not clamped */
    check_says(&world->layer, "\"profile\": \"local\"");
    free(world);
}

/* Any set of tiles: the rectangles hold each tile once, and no other. */
static void available_is_exact(void) {
    enum { SIDE = 16 };
    uint64_t state = 88172645463325252u;
    for (int round = 0; round < 60; round++) {
        struct world *world = world_new();
        struct tile_id tiles[SIDE * SIDE];
        int counts[SIDE][SIDE] = {{0}};
        uint32_t count = 0;
        for (uint32_t x = 0; x < SIDE; x++)
            for (uint32_t y = 0; y < SIDE; y++) {
                state ^= state << 13, state ^= state >> 7, state ^= state << 17;
                bool blocks = (x / 5 + y / 7 + (uint32_t)round) % 2 == 0 || round == 3;
                if (blocks ? round != 4 : state % 100 < (uint64_t)round) tiles[count++] = (struct tile_id){2, x, y};
            }
        qsort(tiles, count, sizeof *tiles, compare_tiles);
        world->zooms[2].tiles = tiles;
        world->zooms[2].tile_count = count;
        char *text = text_of(&world->layer), *at = strstr(text, "\"available\"");
        uint32_t a, b, c, d, rectangles = 0, covered = 0;
        for (int skipped = 0; skipped < 2; skipped++) at = strstr(at + 1, "{\"startX\""); /* of zooms 0 and 1 */
        while ((at = strstr(at + 1, "{\"startX\"")) != NULL) {
            CU_ASSERT_EQUAL_FATAL(sscanf(at,
                                         "{\"startX\": %" SCNu32 ", \"startY\": %" SCNu32 ", \"endX\": %" SCNu32
                                         ", \"endY\": %" SCNu32 "}",
                                         &a, &b, &c, &d),
                                  4);
            CU_ASSERT_FATAL(a <= c && b <= d && c < SIDE && d < SIDE);
            rectangles++;
            for (uint32_t x = a; x <= c; x++)
                for (uint32_t y = b; y <= d; y++) counts[x][y]++, covered++;
        }
        CU_ASSERT_EQUAL(covered, count);
        for (uint32_t i = 0; i < count; i++) CU_ASSERT_EQUAL(counts[tiles[i].x][tiles[i].y], 1);
        if (round == 3) CU_ASSERT_EQUAL(rectangles, 1);
        free(text);
        free(world);
    }
}

int suite_layer(void) {
    CU_pSuite suite = CU_add_suite("layer", NULL, NULL);
    if (suite == NULL) return 1;
    static const struct {
        const char *name;
        CU_TestFunc run;
    } tests[] = {
        {"values are laid out", values_are_laid_out},
        {"strings are escaped", strings_are_escaped},
        {"numbers are short and exact", numbers_are_short_and_exact},
        {"numbers ignore the locale", numbers_ignore_the_locale},
        {"what clients need is there", what_clients_need_is_there},
        {"versions follow the tiles", versions_follow_the_tiles},
        {"local layers name their CRS", local_layers_name_their_crs},
        {"available is exact", available_is_exact},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (CU_add_test(suite, tests[i].name, tests[i].run) == NULL) return 1;
    return 0;
}
