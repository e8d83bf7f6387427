/* verify: a good tile and a good product pass, and each promise that is broken on purpose is found. */
#include "src/mesh_residual.h"
#include "src/quantized_mesh_decode.h"
#include "src/terrain_set_io.h"
#include "src/verify_border.h"
#include "src/verify_report.h"
#include "src/verify_terrain_io.h"
#include "src/verify_tile.h"
#include "tests/terrain_maker.h"
#include "tests/tile_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELLS 4
#define SIDE  (CELLS + 1)

static const struct tile_id some_tile = {.zoom = 3, .x = 9, .y = 5}; /* 22.5 E, 22.5 N */

static struct tile_frame some_frame(void) {
    struct lattice lattice = lattice_geodetic(3);
    return tile_frame_of(&lattice, some_tile, true);
}

static struct tile_recipe some_recipe(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = tile_recipe_grid(CELLS, DECODED_TOP, DECODED_TOP);
    tile_recipe_relief(&recipe, frame.bounds);
    tile_recipe_header(&recipe, PROFILE_GEODETIC, frame.bounds);
    return recipe;
}

static void decode(struct scree_memory *memory, const struct tile_recipe *recipe, struct decoded_tile *tile) {
    size_t size_bytes;
    unsigned char *bytes = tile_recipe_encode(recipe, &size_bytes);
    CU_ASSERT_EQUAL_FATAL(decoded_tile_read(memory, bytes, size_bytes, tile, NULL), SCREE_OK);
    free(bytes);
}

/* Which promises the tile breaks, as bits. Frees the recipe. */
static unsigned broken_by(struct tile_recipe *recipe, const struct tile_frame *frame) {
    struct scree_memory memory = {0};
    struct decoded_tile tile;
    struct verify_report *report = calloc(1, sizeof *report);
    unsigned broken = 0;
    decode(&memory, recipe, &tile);
    CU_ASSERT_EQUAL(verify_tile(&memory, &tile, frame, report, NULL), SCREE_OK);
    for (int p = 0; p < PROMISE_COUNT; p++) {
        if (report->promises[p].broken == 0) continue;
        broken |= 1u << p;
        CU_ASSERT(report->promises[p].note_count > 0);
        CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[p].notes[0], "tile 3/9/5"));
    }
    decoded_tile_free(&memory, &tile);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(report);
    tile_recipe_free(recipe);
    return broken;
}

#define BROKEN(p) (1u << PROMISE_##p)

static void a_good_tile_passes(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    CU_ASSERT_EQUAL(frame.right, DECODED_TOP);
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), 0);
}

static void flipped_and_flat_triangles_are_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    uint32_t swap = recipe.corners[0];
    recipe.corners[0] = recipe.corners[1];
    recipe.corners[1] = swap;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(ORIENTATION) | BROKEN(COVER));
    recipe = some_recipe(); /* an inner vertex pushed across an edge folds its star */
    recipe.u[2 * SIDE + 2] = recipe.u[2 * SIDE + 4] - 1;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(ORIENTATION) | BROKEN(COVER));
    recipe = some_recipe(); /* onto the line between two neighbours */
    recipe.u[SIDE + 1] = (recipe.u[SIDE] + recipe.u[1]) / 2;
    recipe.v[SIDE + 1] = recipe.v[1] + 1;
    recipe.v[SIDE + 1] = (uint16_t)(recipe.v[SIDE] - (recipe.u[SIDE + 1] * recipe.v[SIDE]) / recipe.u[1]);
    uint32_t three[3] = {1, SIDE + 1, SIDE};
    memcpy(recipe.corners + 3 * (size_t)recipe.triangle_count++, three, sizeof three);
    CU_ASSERT((broken_by(&recipe, &frame) & BROKEN(ORIENTATION)) != 0);
}

static void holes_and_overlaps_are_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    recipe.triangle_count -= 1; /* the last triangle touches the northern border */
    CU_ASSERT((broken_by(&recipe, &frame) & BROKEN(COVER)) != 0);
    recipe = some_recipe(); /* a hole inside: replace a triangle of the middle by the last one */
    memcpy(recipe.corners + 3 * 12, recipe.corners + 3 * (recipe.triangle_count - 1), 3 * sizeof *recipe.corners);
    CU_ASSERT((broken_by(&recipe, &frame) & BROKEN(COVER)) != 0);
    recipe = some_recipe(); /* one triangle twice */
    memcpy(recipe.corners + 3 * recipe.triangle_count, recipe.corners + 3 * 12, 3 * sizeof *recipe.corners);
    recipe.triangle_count++;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(COVER));
    recipe = some_recipe(); /* a T: a vertex on an edge of the border that only one triangle knows */
    recipe.v[2 * SIDE] += 1;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), 0);
}

static void a_tile_that_is_too_small_is_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    for (uint32_t i = 0; i < recipe.vertex_count; i++) recipe.u[i] = recipe.u[i] == DECODED_TOP ? 32766 : recipe.u[i];
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(COVER) | BROKEN(EDGE_LISTS));
}

static void walls_are_found_and_twins_are_fine(void) {
    struct tile_frame frame = some_frame();
    for (int higher = 0; higher < 2; higher++) {
        struct tile_recipe recipe = some_recipe();
        uint32_t twin = recipe.vertex_count++, middle = 2 * SIDE + 2;
        recipe.u[twin] = recipe.u[middle];
        recipe.v[twin] = recipe.v[middle];
        recipe.h[twin] = (uint16_t)(recipe.h[middle] + higher);
        uint32_t c = 0;
        while (recipe.corners[c] != middle) c++;
        recipe.corners[c] = twin;
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), higher ? BROKEN(COVER) : 0u);
    }
}

static void wrong_edge_lists_are_found(void) {
    struct tile_frame frame = some_frame();
    for (int side = 0; side < 4; side++) {
        struct tile_recipe recipe = some_recipe();
        recipe.edge_count[side]--; /* a corner left out */
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(EDGE_LISTS));
        recipe = some_recipe();
        recipe.edges[side][recipe.edge_count[side]++] = SIDE + 1; /* an inner vertex */
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(EDGE_LISTS));
        recipe = some_recipe();
        recipe.edges[side][recipe.edge_count[side]] = recipe.edges[side][0]; /* one twice */
        recipe.edge_count[side]++;
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(EDGE_LISTS));
        recipe = some_recipe();
        recipe.edge_count[side] = 0;
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(EDGE_LISTS));
    }
}

static void wrong_headers_are_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    recipe.sphere_radius_m -= 0.02; /* the maker adds a centimetre */
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(HEADER));
    recipe = some_recipe();
    recipe.sphere_radius_m = NAN;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(HEADER));
    recipe = some_recipe();
    recipe.center_m[1] += 10;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(HEADER));
    recipe = some_recipe();
    recipe.height_min_m = NAN;
    CU_ASSERT((broken_by(&recipe, &frame) & BROKEN(HEADER)) != 0);
}

static void wrong_occlusion_points_are_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    for (int k = 0; k < 3; k++) recipe.occlusion[k] *= 0.9999; /* a few hundred metres too low */
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(OCCLUSION));
    recipe = some_recipe();
    for (int k = 0; k < 3; k++) recipe.occlusion[k] *= 0.5;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(OCCLUSION));
    recipe = some_recipe();
    for (int k = 0; k < 3; k++) recipe.occlusion[k] *= -1; /* over the antipodes */
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(OCCLUSION));
    recipe = some_recipe();
    recipe.occlusion[0] = INFINITY;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(OCCLUSION));
}

/* 256 x 256 vertices are one for which clients disagree; 65,025 and 66,049 are fine. */
static void the_refused_number_of_vertices_is_found(void) {
    struct tile_frame frame = some_frame();
    for (int cells = 254; cells <= 256; cells++) {
        struct tile_recipe recipe = tile_recipe_grid(cells, DECODED_TOP, DECODED_TOP);
        tile_recipe_header(&recipe, PROFILE_GEODETIC, frame.bounds);
        CU_ASSERT_EQUAL(broken_by(&recipe, &frame), cells == 255 ? BROKEN(VERTICES) : 0u);
    }
}

static void unused_vertices_are_found(void) {
    struct tile_frame frame = some_frame();
    struct tile_recipe recipe = some_recipe();
    uint32_t lone = recipe.vertex_count++;
    recipe.u[lone] = recipe.v[lone] = 77;
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(VERTICES));
}

/* Where the lattice ends within a tile, the tile ends there too. */
static void cut_tiles_of_the_local_profile_pass(void) {
    struct lattice lattice;
    CU_ASSERT_EQUAL_FATAL(lattice_local(300, 101, 5000, 6000, 10, 10, 1, &lattice, NULL), SCREE_OK);
    struct tile_id id = {.zoom = 1, .x = 1, .y = 0};
    struct tile_frame frame = tile_frame_of(&lattice, id, true);
    CU_ASSERT_EQUAL(frame.right, (uint16_t)lround(43 * 32767 / 256.0));
    CU_ASSERT_EQUAL(frame.top, (uint16_t)lround(100 * 32767 / 256.0));
    frame.id = some_tile; /* broken_by looks for its name */
    struct tile_recipe recipe = tile_recipe_grid(CELLS, frame.right, frame.top);
    tile_recipe_header(&recipe, PROFILE_LOCAL, frame.bounds);
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), 0);
    recipe = tile_recipe_grid(CELLS, DECODED_TOP, frame.top);
    tile_recipe_header(&recipe, PROFILE_LOCAL, frame.bounds);
    CU_ASSERT_EQUAL(broken_by(&recipe, &frame), BROKEN(COVER) | BROKEN(EDGE_LISTS));
}

static void borders_are_compared_as_lines(void) {
    struct border_vertex coarse[] = {{0, {1, 2}, 10}, {32767, {3, 4}, 20}};
    struct border_vertex fine[] = {{0, {1, 2}, 10}, {16384, {0, 0}, 18}, {32767, {3, 5}, 20}};
    struct tile_border one = {true, 2, coarse}, other = {true, 3, fine};
    struct border_difference difference = tile_border_compare(&one, &other), back = tile_border_compare(&other, &one);
    CU_ASSERT_EQUAL(difference.lone_vertices, 1);
    CU_ASSERT_EQUAL(difference.normals, 1);
    CU_ASSERT_EQUAL(difference.normal_at, 32767);
    CU_ASSERT_DOUBLE_EQUAL(difference.largest_m, 3, 0.001);
    CU_ASSERT_EQUAL(back.largest_m, difference.largest_m);
    difference = tile_border_compare(&other, &other);
    CU_ASSERT_EQUAL(difference.lone_vertices, 0);
    CU_ASSERT_EQUAL(difference.largest_m, 0);
}

/* ---- products ---- */

static struct verify_report *verify_folder(const char *folder) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct terrain_set *set = calloc(1, sizeof *set);
    struct verify_report *report = calloc(1, sizeof *report);
    enum scree_status status = terrain_set_open(&memory, folder, set, &error);
    if (status == SCREE_OK) status = verify_terrain(&memory, set, NULL, NULL, report, &error);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    terrain_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(set);
    return report;
}

/* Verifies and removes the product. Returns the broken promises as bits. */
static unsigned broken_in(struct made_terrain *terrain, struct verify_report *result) {
    struct verify_report *report = verify_folder(terrain->folder);
    unsigned broken = 0;
    for (int p = 0; p < PROMISE_COUNT; p++) broken |= (unsigned)(report->promises[p].broken != 0) << p;
    if (result != NULL) *result = *report;
    free(report);
    made_terrain_remove(terrain);
    return broken;
}

static void a_good_product_passes(void) {
    struct verify_report *report = calloc(1, sizeof *report);
    struct made_terrain terrain = made_terrain_globe(true);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), 0);
    CU_ASSERT_EQUAL(report->border_difference_m, 0);
    /* zoom 0: 2 tiles meet twice around the globe; zoom 1: 4 a row twice, and 4 between the rows */
    CU_ASSERT_EQUAL(report->borders, 2 + 8 + 4);
    CU_ASSERT_EQUAL(report->promises[PROMISE_NORMALS].checked, 14);
    CU_ASSERT_EQUAL(report->zooms[1].tiles, 8);
    free(report);
}

static void a_shifted_border_is_found(void) {
    struct verify_report *report = calloc(1, sizeof *report);
    struct made_terrain terrain = made_terrain_globe(false);
    struct tile_id id = {.zoom = 1, .x = 2, .y = 1};
    struct tile_recipe recipe = made_terrain_recipe(id, false);
    recipe.h[2 * MADE_SIDE] += 1; /* one code on its western border: 1/16 m */
    made_terrain_write(&terrain, id, &recipe);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(BORDERS));
    CU_ASSERT_EQUAL(report->border_difference_m, 1.0 / 16);
    CU_ASSERT_EQUAL(report->promises[PROMISE_BORDERS].broken, 1);
    terrain = made_terrain_globe(false);
    recipe = made_terrain_recipe(id, false);
    recipe.u[2] += 1; /* one code along its southern border */
    made_terrain_write(&terrain, id, &recipe);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(BORDERS));
    CU_ASSERT(report->border_difference_m < 0.2);
    id.x = 3; /* around the globe */
    terrain = made_terrain_globe(false);
    recipe = made_terrain_recipe(id, false);
    recipe.h[2 * MADE_SIDE + MADE_SIDE - 1] += 3;
    made_terrain_write(&terrain, id, &recipe);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(BORDERS));
    CU_ASSERT_EQUAL(report->border_difference_m, 3.0 / 16);
    free(report);
}

static void a_turned_normal_is_found(void) {
    struct made_terrain terrain = made_terrain_globe(true);
    struct tile_id id = {.zoom = 1, .x = 1, .y = 0};
    struct tile_recipe recipe = made_terrain_recipe(id, true);
    recipe.normals[0] ^= 1; /* of its south-western corner */
    made_terrain_write(&terrain, id, &recipe);
    CU_ASSERT_EQUAL(broken_in(&terrain, NULL), BROKEN(NORMALS));
}

static void missing_and_extra_tiles_are_found(void) {
    struct verify_report *report = calloc(1, sizeof *report);
    struct made_terrain terrain = made_terrain_globe(false);
    struct tile_id id = {.zoom = 1, .x = 3, .y = 1};
    made_terrain_delete(&terrain, id);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(AVAILABLE) | BROKEN(COUNTS));
    CU_ASSERT_EQUAL(report->promises[PROMISE_AVAILABLE].broken, 1);
    CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[PROMISE_AVAILABLE].notes[0], "1/3/1"));
    terrain = made_terrain_globe(false);
    made_terrain_manifest(&terrain, 6); /* layer.json written for 6 tiles of zoom 1: 2 are too many */
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(AVAILABLE) | BROKEN(COUNTS));
    CU_ASSERT_EQUAL(report->promises[PROMISE_AVAILABLE].broken, 2);
    terrain = made_terrain_globe(false);
    id = (struct tile_id){.zoom = 0, .x = 1};
    made_terrain_delete(&terrain, id);
    CU_ASSERT_EQUAL(broken_in(&terrain, report), BROKEN(AVAILABLE) | BROKEN(COUNTS) | BROKEN(ANCESTORS));
    CU_ASSERT_EQUAL(report->promises[PROMISE_ANCESTORS].broken, 1 + 4); /* a root, and four orphans */
    free(report);
}

static void a_damaged_file_is_told_and_the_rest_is_checked(void) {
    struct verify_report *report = calloc(1, sizeof *report);
    struct made_terrain terrain = made_terrain_globe(false);
    struct tile_id id = {.zoom = 1, .x = 0, .y = 0};
    made_terrain_truncate(&terrain, id, 300);
    unsigned broken = broken_in(&terrain, report);
    CU_ASSERT_EQUAL(broken, BROKEN(FORMAT) | BROKEN(COUNTS));
    CU_ASSERT_EQUAL(report->promises[PROMISE_FORMAT].checked, 10);
    CU_ASSERT_EQUAL(report->promises[PROMISE_FORMAT].broken, 1);
    CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[PROMISE_FORMAT].notes[0], "/1/0/0.terrain: "));
    free(report);
}

static void what_is_no_product_is_refused_in_one_line(void) {
    static const char *const layers[] = {
        "",
        "[]",
        "{",
        "{\"format\":\"heightmap-1.0\"}",
        "{\"scheme\":\"xyz\"}",
        "{\"projection\":\"EPSG:3857\"}",
        "{\"available\":[[{\"startX\":0,\"startY\":0,\"endX\":2,\"endY\":0}]]}",
        "{\"available\":[7]}",
        "{\"scree\":{\"profile\":\"geodetic\"}}",
        "{\"scree\":{\"profile\":\"local\",\"lattice\":{\"finest_zoom\":1,\"columns\":-5,\"rows\":3}}}",
        "{\"scree\":{\"profile\":\"geodetic\",\"lattice\":{\"finest_zoom\":99}}}",
        "{\"scree\":{\"profile\":\"geodetic\",\"lattice\":{\"finest_zoom\":1},\"zooms\":[{}]}}"};
    struct terrain_set *set = calloc(1, sizeof *set);
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct scree_memory memory = {0};
        struct scree_error error = {0};
        struct made_terrain terrain = made_terrain_globe(false);
        made_terrain_text(&terrain, "layer.json", layers[i]);
        CU_ASSERT(terrain_set_open(&memory, terrain.folder, set, &error) < 0);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "layer.json: "));
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
        made_terrain_remove(&terrain);
    }
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(terrain_set_open(&(struct scree_memory){0}, "no/such/folder", set, &error), SCREE_E_IO);
    free(set);
}

static void terrain_of_others_is_checked_as_far_as_it_goes(void) {
    struct verify_report *report = calloc(1, sizeof *report);
    struct made_terrain terrain = made_terrain_globe(false);
    made_terrain_text(&terrain, "layer.json",
                      "{\"tilejson\":\"2.1.0\",\"format\":\"quantized-mesh-1.0\",\"version\":\"1.0.0\","
                      "\"scheme\":\"tms\",\"projection\":\"EPSG:4326\",\"tiles\":[\"{z}/{x}/{y}.terrain\"],"
                      "\"minzoom\":0,\"maxzoom\":1,\"bounds\":[-180,-90,180,90],"
                      "\"available\":[[{\"startX\":0,\"startY\":0,\"endX\":1,\"endY\":0}],"
                      "[{\"startX\":0,\"startY\":0,\"endX\":3,\"endY\":1}]]}");
    CU_ASSERT_EQUAL(broken_in(&terrain, report), 0);
    CU_ASSERT_EQUAL(report->borders, 14);
    CU_ASSERT_EQUAL(report->promises[PROMISE_COUNTS].checked, 0);
    free(report);
}

/* ---- error against posts ---- */

/* Every post of a tile is met once, and what is added to one of them comes out as the largest error. */
static void residuals_meet_every_post_once(void) {
    struct lattice lattice = lattice_geodetic(3);
    struct tile_frame frame = some_frame();
    struct scree_memory memory = {0};
    struct decoded_tile tile;
    struct tile_recipe recipe = tile_recipe_grid(8, DECODED_TOP, DECODED_TOP);
    struct residuals *sums = calloc(1, sizeof *sums);
    float *heights = calloc(257 * 257, sizeof *heights);
    for (uint32_t i = 0; i < recipe.vertex_count; i++) recipe.h[i] = (uint16_t)(recipe.u[i] / 4 + recipe.v[i] / 2);
    decode(&memory, &recipe, &tile);
    double step_m = decoded_step_m(&tile);
    for (int y = 0; y <= 256; y++)
        for (int x = 0; x <= 256; x++)
            heights[y * 257 + x] = (float)(-100 + step_m * DECODED_TOP * (x / 4.0 + y / 2.0) / 256.0);
    heights[100 * 257 + 31] += 40;
    heights[256 * 257 + 256] += 50; /* of the north-eastern neighbour, unless the tile is the last one */
    struct lattice_window window = lattice_tile_window(&lattice, frame.id);
    struct post_block block = {window.x, window.y, 257, 257, heights};
    residuals_add(&lattice, frame.id, &tile, &block, false, false, sums);
    CU_ASSERT_EQUAL(sums->posts, 256 * 256);
    CU_ASSERT_DOUBLE_EQUAL(sums->height.max_m, 40, 2 * step_m);
    CU_ASSERT_EQUAL(sums->height.max_x, window.x + 31);
    CU_ASSERT_EQUAL(sums->height.max_y, window.y + 100);
    CU_ASSERT(residual_quantile_m(&sums->height, sums->posts, 0.99) < 2 * step_m);
    CU_ASSERT(residual_rms_m(&sums->height, sums->posts) < 40.0 / 256 + 2 * step_m);
    /* flat triangles 2.8 degrees wide sag by about s^2 / 8R beneath the globe */
    CU_ASSERT(sums->drawn.max_m > 2000 && sums->drawn.max_m < 10000);
    CU_ASSERT(residual_mean_m(&sums->drawn, sums->posts) > 1000);
    memset(sums, 0, sizeof *sums);
    residuals_add(&lattice, frame.id, &tile, &block, true, true, sums);
    CU_ASSERT_EQUAL(sums->posts, 257 * 257);
    CU_ASSERT_DOUBLE_EQUAL(sums->height.max_m, 50, 2 * step_m);
    /* and in blocks */
    memset(sums, 0, sizeof *sums);
    for (int y = 0; y < 257; y += 100)
        for (int x = 0; x < 257; x += 70) {
            int columns = x + 70 > 257 ? 257 - x : 70, rows = y + 100 > 257 ? 257 - y : 100;
            float *part = malloc(sizeof *part * (size_t)columns * (size_t)rows);
            for (int r = 0; r < rows; r++)
                memcpy(part + r * columns, heights + (y + r) * 257 + x, sizeof *part * (size_t)columns);
            struct post_block piece = {window.x + x, window.y + y, columns, rows, part};
            residuals_add(&lattice, frame.id, &tile, &piece, true, true, sums);
            free(part);
        }
    CU_ASSERT_EQUAL(sums->posts, 257 * 257);
    decoded_tile_free(&memory, &tile);
    tile_recipe_free(&recipe);
    free(heights);
    free(sums);
}

int suite_verify(void) {
    CU_TestInfo tests[] = {
        {"a good tile passes", a_good_tile_passes},
        {"flipped and flat triangles are found", flipped_and_flat_triangles_are_found},
        {"holes and overlaps are found", holes_and_overlaps_are_found},
        {"a tile that is too small is found", a_tile_that_is_too_small_is_found},
        {"walls are found and twins are fine", walls_are_found_and_twins_are_fine},
        {"wrong edge lists are found", wrong_edge_lists_are_found},
        {"wrong headers are found", wrong_headers_are_found},
        {"wrong occlusion points are found", wrong_occlusion_points_are_found},
        {"the refused number of vertices is found", the_refused_number_of_vertices_is_found},
        {"unused vertices are found", unused_vertices_are_found},
        {"cut tiles of the local profile pass", cut_tiles_of_the_local_profile_pass},
        {"borders are compared as lines", borders_are_compared_as_lines},
        {"a good product passes", a_good_product_passes},
        {"a shifted border is found", a_shifted_border_is_found},
        {"a turned normal is found", a_turned_normal_is_found},
        {"missing and extra tiles are found", missing_and_extra_tiles_are_found},
        {"a damaged file is told and the rest is checked", a_damaged_file_is_told_and_the_rest_is_checked},
        {"what is no product is refused in one line", what_is_no_product_is_refused_in_one_line},
        {"terrain of others is checked as far as it goes", terrain_of_others_is_checked_as_far_as_it_goes},
        {"residuals meet every post once", residuals_meet_every_post_once},
        CU_TEST_INFO_NULL,
    };
    CU_SuiteInfo suites[] = {{"verify", NULL, NULL, NULL, NULL, tests}, CU_SUITE_INFO_NULL};
    return CU_register_suites(suites) == CUE_SUCCESS ? 0 : 1;
}
