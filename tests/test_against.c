/* verify --against: the error of a terrain is measured against rasters, at every post, and the place is told. */
#include "src/verify_against_io.h"
#include "tests/raster_maker.h"
#include "tests/terrain_maker.h"
#include "tests/tile_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WEST   350005.0 /* of the first pixel's centre */
#define SOUTH  3800005.0
#define PIXEL  10.0
#define STEP_M (1.0 / 16) /* of the tile maker's heights */
#define BUMP_M 7.0

static double plane_m(double x, double y) {
    double u = (x - WEST) / PIXEL / 256 * 32767, v = (y - SOUTH) / PIXEL / 256 * 32767;
    return -100 + STEP_M * (u / 4 + v / 2);
}

static double bumpy_m(double x, double y) {
    bool is_there = fabs(x - WEST - 37 * PIXEL) < 1 && fabs(y - SOUTH - 93 * PIXEL) < 1;
    return plane_m(x, y) + (is_there ? BUMP_M : 0);
}

/* A product of the local profile: one tile over 201 x 151 posts, a plane within one step of height. */
static struct made_terrain plane_terrain(void) {
    struct made_terrain terrain = made_terrain_globe(false);
    struct lattice lattice;
    double bounds[4];
    char text[2000];
    lattice_local(201, 151, WEST, SOUTH, PIXEL, PIXEL, 1, &lattice, NULL);
    lattice_tile_bounds(&lattice, (struct tile_id){0}, bounds);
    struct tile_recipe recipe =
        tile_recipe_grid(5, (uint16_t)lround(200 * 32767 / 256.0), (uint16_t)lround(150 * 32767 / 256.0));
    for (uint32_t i = 0; i < recipe.vertex_count; i++) recipe.h[i] = (uint16_t)(recipe.u[i] / 4 + recipe.v[i] / 2);
    tile_recipe_header(&recipe, PROFILE_LOCAL, bounds);
    for (int zoom = 1; zoom >= 0; zoom--)
        for (uint32_t x = 0; x < 4; x++)
            for (uint32_t y = 0; y < 2; y++) made_terrain_delete(&terrain, (struct tile_id){zoom, x, y});
    made_terrain_write(&terrain, (struct tile_id){0}, &recipe);
    snprintf(
        text, sizeof text,
        "{\"format\":\"quantized-mesh-1.0\",\"scheme\":\"tms\",\"minzoom\":0,\"maxzoom\":0,"
        "\"scree\":{\"profile\":\"local\",\"lattice\":{\"finest_zoom\":0,\"columns\":201,\"rows\":151,\"west\":%.1f,"
        "\"south\":%.1f,\"spacing_x\":10,\"spacing_y\":10,\"metres_x\":10,\"metres_y\":10},"
        "\"zooms\":[{\"zoom\":0,\"tolerance_m\":1}]}}",
        WEST, SOUTH);
    made_terrain_text(&terrain, "layer.json", text);
    return terrain;
}

/* Measures the product against /vsimem/against.tif. Removes nothing. */
static enum scree_status measure(const struct made_terrain *terrain, struct residuals *zoom_0,
                                 struct verify_report *report, struct scree_error *error) {
    static const char *const inputs[] = {"/vsimem/against.tif"};
    struct scree_memory memory = {0};
    struct against against = {0};
    struct raster_options options = {.inputs = inputs, .input_count = 1};
    struct terrain_set *set = calloc(1, sizeof *set);
    enum scree_status status = terrain_set_open(&memory, terrain->folder, set, error);
    if (status == SCREE_OK) status = verify_against(&memory, set, options, NULL, NULL, &against, error);
    if (status == SCREE_OK) {
        verify_against_judge(set, &against, report);
        *zoom_0 = against.zooms[0];
    }
    against_free(&memory, &against);
    terrain_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(set);
    return status;
}

static struct raster_fixture plane_raster(height_function height) {
    return (struct raster_fixture){.path = "/vsimem/against.tif",
                                   .columns = 201,
                                   .rows = 151,
                                   .west = WEST - PIXEL / 2,
                                   .north = SOUTH + 150.5 * PIXEL,
                                   .pixel_x = PIXEL,
                                   .pixel_y = PIXEL,
                                   .srs = "EPSG:32611",
                                   .height = height};
}

static void a_mesh_that_fits_is_within_its_tolerance(void) {
    struct residuals *sums = calloc(1, sizeof *sums);
    struct verify_report *report = calloc(1, sizeof *report);
    struct scree_error error = {0};
    struct raster_fixture fixture = plane_raster(plane_m);
    struct made_terrain terrain = plane_terrain();
    make_raster(&fixture);
    CU_ASSERT_EQUAL(measure(&terrain, sums, report, &error), SCREE_OK);
    if (error.status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL(sums->posts, 201 * 151);
    CU_ASSERT(sums->height.max_m < 2 * STEP_M); /* codes are whole numbers */
    CU_ASSERT_EQUAL(sums->drawn.max_m, sums->height.max_m);
    CU_ASSERT_EQUAL(report->promises[PROMISE_ERROR].checked, 1);
    CU_ASSERT_EQUAL(report->promises[PROMISE_ERROR].broken, 0);
    made_terrain_remove(&terrain);
    free(report);
    free(sums);
}

static void a_bump_that_the_mesh_lacks_is_found(void) {
    struct residuals *sums = calloc(1, sizeof *sums);
    struct verify_report *report = calloc(1, sizeof *report);
    struct raster_fixture fixture = plane_raster(bumpy_m);
    struct made_terrain terrain = plane_terrain();
    make_raster(&fixture);
    CU_ASSERT_EQUAL(measure(&terrain, sums, report, NULL), SCREE_OK);
    CU_ASSERT_DOUBLE_EQUAL(sums->height.max_m, BUMP_M, 2 * STEP_M);
    CU_ASSERT_EQUAL(sums->height.max_x, 37);
    CU_ASSERT_EQUAL(sums->height.max_y, 93);
    CU_ASSERT(residual_quantile_m(&sums->height, sums->posts, 0.99) < 2.1 * STEP_M);
    CU_ASSERT_EQUAL(report->promises[PROMISE_ERROR].broken, 1);
    CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[PROMISE_ERROR].notes[0], " at 350375.0000000, 3800935.0000000"));
    made_terrain_remove(&terrain);
    free(report);
    free(sums);
}

static void another_raster_is_refused(void) {
    struct residuals *sums = calloc(1, sizeof *sums);
    struct verify_report *report = calloc(1, sizeof *report);
    struct scree_error error = {0};
    struct raster_fixture fixture = plane_raster(plane_m);
    struct made_terrain terrain = plane_terrain();
    fixture.columns = 200;
    make_raster(&fixture);
    CU_ASSERT_EQUAL(measure(&terrain, sums, report, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "200 x 151"));
    made_terrain_remove(&terrain);
    free(report);
    free(sums);
}

static double flat_m(double x, double y) {
    (void)x;
    (void)y;
    return -100;
}

/* The whole globe, flat: heights as clients read them are exact, and flat triangles 15 degrees wide sag. */
static void the_globe_is_measured_to_its_seams(void) {
    struct residuals *sums = calloc(1, sizeof *sums);
    struct verify_report *report = calloc(1, sizeof *report);
    struct scree_error error = {0};
    struct raster_fixture fixture = {.path = "/vsimem/against.tif",
                                     .columns = 360,
                                     .rows = 180,
                                     .west = -180,
                                     .north = 90,
                                     .pixel_x = 1,
                                     .pixel_y = 1,
                                     .srs = "EPSG:4326",
                                     .height = flat_m};
    struct made_terrain terrain = made_terrain_globe(false);
    for (int zoom = 0; zoom <= 1; zoom++)
        for (uint32_t x = 0; x < 2u << zoom; x++)
            for (uint32_t y = 0; y < 1u << zoom; y++) {
                struct tile_recipe recipe = tile_recipe_grid(MADE_CELLS, 32767, 32767);
                made_terrain_write(&terrain, (struct tile_id){zoom, x, y}, &recipe);
            }
    make_raster(&fixture);
    CU_ASSERT_EQUAL(measure(&terrain, sums, report, &error), SCREE_OK);
    if (error.status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL(sums->posts, 1025 * 513);
    CU_ASSERT_EQUAL(sums->height.max_m, 0);
    CU_ASSERT(sums->drawn.max_m > 50000); /* 30 degrees a cell at zoom 0 */
    CU_ASSERT_EQUAL(report->promises[PROMISE_ERROR].broken, 1);
    made_terrain_remove(&terrain);
    free(report);
    free(sums);
}

int suite_against(void) {
    CU_TestInfo tests[] = {
        {"a mesh that fits is within its tolerance", a_mesh_that_fits_is_within_its_tolerance},
        {"a bump that the mesh lacks is found", a_bump_that_the_mesh_lacks_is_found},
        {"another raster is refused", another_raster_is_refused},
        {"the globe is measured to its seams", the_globe_is_measured_to_its_seams},
        CU_TEST_INFO_NULL,
    };
    CU_SuiteInfo suites[] = {{"against", NULL, NULL, NULL, NULL, tests}, CU_SUITE_INFO_NULL};
    return CU_register_suites(suites) == CUE_SUCCESS ? 0 : 1;
}
