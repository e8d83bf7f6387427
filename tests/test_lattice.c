/* Tests of src/lattice: tiles, posts and zooms of both profiles. */
#include "src/lattice.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>

static void test_geodetic_counts(void) {
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        struct lattice lattice = lattice_geodetic(zoom);
        CU_ASSERT_EQUAL(lattice.rows, ((int64_t)TILE_CELLS << zoom) + 1);
        CU_ASSERT_EQUAL(lattice.columns, ((int64_t)2 * TILE_CELLS << zoom) + 1);
        CU_ASSERT_EQUAL(lattice_tiles_x(&lattice, zoom), UINT32_C(2) << zoom);
        CU_ASSERT_EQUAL(lattice_tiles_y(&lattice, zoom), UINT32_C(1) << zoom);
        CU_ASSERT_EQUAL(lattice_tiles_x(&lattice, 0), 2);
        CU_ASSERT_EQUAL(lattice_tiles_y(&lattice, 0), 1);
        CU_ASSERT_EQUAL(lattice_tile_span(&lattice, zoom), TILE_CELLS);
        CU_ASSERT_TRUE(lattice_tile_span(&lattice, 0) <= INT32_MAX);
        CU_ASSERT_EQUAL(lattice_x(&lattice, (double)lattice.columns - 1), 180.0);
        CU_ASSERT_EQUAL(lattice_y(&lattice, (double)lattice.rows - 1), 90.0);
    }
}

/* A tile's bounds are bit for bit those of its neighbours and of its children. */
static void test_geodetic_bounds_shared(void) {
    struct lattice lattice = lattice_geodetic(MAX_ZOOM);
    double bounds[4], east[4], child[4];
    lattice_tile_bounds(&lattice, (struct tile_id){12, 2345, 1777}, bounds);
    lattice_tile_bounds(&lattice, (struct tile_id){12, 2346, 1777}, east);
    lattice_tile_bounds(&lattice, (struct tile_id){13, 2 * 2345 + 1, 2 * 1777 + 1}, child);
    CU_ASSERT_EQUAL(bounds[2], east[0]);
    CU_ASSERT_EQUAL(bounds[1], east[1]);
    CU_ASSERT_EQUAL(bounds[2], child[2]);
    CU_ASSERT_EQUAL(bounds[3], child[3]);
    CU_ASSERT_EQUAL((bounds[0] + bounds[2]) / 2, child[0]);
    lattice_tile_bounds(&lattice, (struct tile_id){0, 1, 0}, bounds);
    CU_ASSERT_EQUAL(bounds[0], 0.0);
    CU_ASSERT_EQUAL(bounds[1], -90.0);
    CU_ASSERT_EQUAL(bounds[2], 180.0);
    CU_ASSERT_EQUAL(bounds[3], 90.0);
}

static void test_geodetic_windows(void) {
    struct lattice lattice = lattice_geodetic(5);
    struct lattice_window window = lattice_tile_window(&lattice, (struct tile_id){3, 15, 7});
    CU_ASSERT_EQUAL(window.columns, TILE_CELLS * 4);
    CU_ASSERT_EQUAL(window.rows, TILE_CELLS * 4);
    CU_ASSERT_EQUAL(window.x + window.columns, lattice.columns - 1);
    CU_ASSERT_EQUAL(window.y + window.rows, lattice.rows - 1);
    window = lattice_tile_window(&lattice, (struct tile_id){3, 16, 7});
    CU_ASSERT_EQUAL(window.columns, 0);
    window = lattice_tile_window(&lattice, (struct tile_id){3, 0, UINT32_MAX});
    CU_ASSERT_EQUAL(window.columns, 0);
}

static void test_local_cuts(void) {
    struct lattice lattice;
    CU_ASSERT_EQUAL_FATAL(lattice_local(1197, 643, 10.0, 20.0, 30.0, 31.0, 0.5, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(lattice.finest_zoom, 3); /* 256 * 8 = 2048 >= 1196 > 1024 */
    CU_ASSERT_EQUAL(lattice_tiles_x(&lattice, 3), 5);
    CU_ASSERT_EQUAL(lattice_tiles_y(&lattice, 3), 3);
    CU_ASSERT_EQUAL(lattice_tiles_x(&lattice, 0), 1);
    CU_ASSERT_EQUAL(lattice_tiles_y(&lattice, 0), 1);
    struct lattice_window window = lattice_tile_window(&lattice, (struct tile_id){3, 4, 2});
    CU_ASSERT_EQUAL(window.columns, 1196 - 1024);
    CU_ASSERT_EQUAL(window.rows, 642 - 512);
    window = lattice_tile_window(&lattice, (struct tile_id){0, 0, 0});
    CU_ASSERT_EQUAL(window.columns, 1196);
    CU_ASSERT_EQUAL(window.rows, 642);
    CU_ASSERT_EQUAL(lattice_tile_window(&lattice, (struct tile_id){3, 5, 0}).columns, 0);
    CU_ASSERT_EQUAL(lattice_tile_window(&lattice, (struct tile_id){3, 0, 3}).columns, 0);
    CU_ASSERT_EQUAL(lattice_x(&lattice, 2.5), 85.0);
    CU_ASSERT_EQUAL(lattice_y(&lattice, 2), 82.0);
    double east_m, north_m;
    lattice_steps_m(&lattice, 7, &east_m, &north_m);
    CU_ASSERT_EQUAL(east_m, 15.0);
    CU_ASSERT_EQUAL(north_m, 15.5);
}

/* A raster whose last post lies on a tile border has no tile of one column. */
static void test_local_exact_fit(void) {
    struct lattice lattice;
    CU_ASSERT_EQUAL_FATAL(lattice_local(513, 257, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(lattice.finest_zoom, 1);
    CU_ASSERT_EQUAL(lattice_tiles_x(&lattice, 1), 2);
    CU_ASSERT_EQUAL(lattice_tiles_y(&lattice, 1), 1);
    CU_ASSERT_EQUAL_FATAL(lattice_local(2, 2, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(lattice.finest_zoom, 0);
}

static void test_local_refuses(void) {
    struct lattice lattice;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(lattice_local(1, 5, 0, 0, 1, 1, 1, &lattice, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(lattice_local(5, 5, NAN, 0, 1, 1, 1, &lattice, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(lattice_local(5, 5, 0, 0, 0, 1, 1, &lattice, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(lattice_local(5, 5, 0, 0, 1, -1, 1, &lattice, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(lattice_local(5, 5, 0, 0, 1, 1, INFINITY, &lattice, NULL), SCREE_E_ARGUMENT);
    int64_t most = ((int64_t)TILE_CELLS << MAX_ZOOM) + 1;
    CU_ASSERT_EQUAL(lattice_local(most, 5, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(lattice.finest_zoom, MAX_ZOOM);
    CU_ASSERT_EQUAL(lattice_local(5, most + 1, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_E_LIMIT);
}

/* Arcs of one degree on WGS84 (NIMA TR8350.2): 110574.3 m and 111319.5 m at the equator, 111693.9 m at the pole. */
static void test_steps_on_the_ellipsoid(void) {
    struct lattice lattice = lattice_geodetic(0);
    double per_degree = 256.0 / 180, east_m, north_m;
    lattice_steps_m(&lattice, 128, &east_m, &north_m);
    CU_ASSERT_DOUBLE_EQUAL(east_m * per_degree, 111319.49, 0.01);
    CU_ASSERT_DOUBLE_EQUAL(north_m * per_degree, 110574.28, 0.01);
    lattice_steps_m(&lattice, 256, &east_m, &north_m);
    CU_ASSERT_TRUE(east_m > 0 && east_m < 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(north_m * per_degree, 111693.98, 0.01);
    double beyond_m;
    lattice_steps_m(&lattice, 257, &beyond_m, &north_m);
    CU_ASSERT_EQUAL(beyond_m, east_m);
}

static void test_zoom_for_spacing(void) {
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(180.0 / 256), 0);
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(180.0 / 256 / 1.05), 0);
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(180.0 / 256 / 1.15), 1);
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(180.0 / 512), 1);
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(1.0 / 12), 3);    /* ETOPO5: 0.0879 at zoom 3 is within 1.1 x 0.0833 */
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(1.0 / 3600), 12); /* SRTM 1" */
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(1e-12), MAX_ZOOM);
    CU_ASSERT_EQUAL(lattice_zoom_for_spacing(1000), 0);
}

static void test_tiles_touching(void) {
    struct lattice lattice = lattice_geodetic(4);
    struct tile_range range =
        lattice_tiles_touching(&lattice, 4, (struct lattice_window){.x = 256, .y = 0, .columns = 256, .rows = 255});
    CU_ASSERT_EQUAL(range.x_first, 0);
    CU_ASSERT_EQUAL(range.x_last, 2);
    CU_ASSERT_EQUAL(range.y_first, 0);
    CU_ASSERT_EQUAL(range.y_last, 0);
    range = lattice_tiles_touching(&lattice, 4, (struct lattice_window){.x = 257, .y = 300, .columns = 254, .rows = 0});
    CU_ASSERT_EQUAL(range.x_first, 1);
    CU_ASSERT_EQUAL(range.x_last, 1);
    CU_ASSERT_EQUAL(range.y_first, 1);
    CU_ASSERT_EQUAL(range.y_last, 1);
    range = lattice_tiles_touching(&lattice, 4,
                                   (struct lattice_window){.x = 0, .y = 0, .columns = 512 * 16, .rows = 256 * 16});
    CU_ASSERT_EQUAL(range.x_first, 0);
    CU_ASSERT_EQUAL(range.x_last, 31);
    CU_ASSERT_EQUAL(range.y_last, 15);
}

int suite_lattice(void) {
    CU_pSuite suite = CU_add_suite("lattice", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_geodetic_counts);
    CU_ADD_TEST(suite, test_geodetic_bounds_shared);
    CU_ADD_TEST(suite, test_geodetic_windows);
    CU_ADD_TEST(suite, test_local_cuts);
    CU_ADD_TEST(suite, test_local_exact_fit);
    CU_ADD_TEST(suite, test_local_refuses);
    CU_ADD_TEST(suite, test_steps_on_the_ellipsoid);
    CU_ADD_TEST(suite, test_zoom_for_spacing);
    CU_ADD_TEST(suite, test_tiles_touching);
    return 0;
}
