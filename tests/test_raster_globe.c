/* Tests of raster_io: the antimeridian, the poles, and rasters that go around the globe. */
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define RADIANS 0.017453292519943295

/* Smooth over the whole globe, seams and poles included: a polynomial of the direction from the Earth's centre. */
static double on_sphere(double longitude, double latitude) {
    double x = cos(latitude * RADIANS) * cos(longitude * RADIANS);
    double y = cos(latitude * RADIANS) * sin(longitude * RADIANS), z = sin(latitude * RADIANS);
    return 3000 + 900 * x + 700 * y + 500 * z + 400 * x * y - 300 * y * z;
}

static double on_sphere_uneven_poles(double longitude, double latitude) {
    double away = 90 - fabs(latitude);
    return on_sphere(longitude, latitude) + (away < 2 ? 50 * sin(longitude * RADIANS * 3) : 0);
}

/* Polar stereographic (EPSG:3995, true at 71 degrees north) needs an inverse: a cone around the pole will do. */
static double cone(double x, double y) {
    return 4000 - hypot(x, y) / 1000;
}

static double error_m(struct opened *r, double west, double east, double south, double north) {
    double largest_m = 0;
    int count = 0;
    int64_t x1 = column_of(r, east), y1 = row_of(r, north);
    for (int64_t y = row_of(r, south); y <= y1; y++)
        for (int64_t x = column_of(r, west); x <= x1; x++, count++) {
            double expected_m = on_sphere(lattice_x(&r->lattice, (double)x), lattice_y(&r->lattice, (double)y));
            largest_m = fmax(largest_m, fabs(post_m(r, x, y) - expected_m));
        }
    CU_ASSERT_TRUE(count > 0);
    return largest_m;
}

/* Whole globes: pixels as areas or as points on the poles, counted from -180 or from 0, one column repeated, or of a
 * spacing that is a little off. No seam anywhere. */
static void test_globes(void) {
    static const struct {
        double west, north, pixel_x, pixel_y;
        int columns, rows;
        const char *srs;
    } globes[] = {
        {-180, 90, 1, 1, 360, 180, "EPSG:4326"},     {0, 90, 1, 1, 360, 180, "EPSG:4326"},
        {-180.5, 90.5, 1, 1, 360, 181, "EPSG:4326"}, {-0.5, 90.5, 1, 1, 360, 181, "EPSG:4326"},
        {-0.5, 90.5, 1, 1, 361, 181, "EPSG:4326"},   {-0.5, 90.5, 1.0002, 1, 360, 181, "EPSG:4326"},
        {-180.5, 90.5, 1, 1, 361, 181, "EPSG:4326"}, {0, 90, 1, 1, 360, 180, "EPSG:4269"},
        {-180.5, 90.5, 1, 1, 360, 181, "EPSG:4258"}, {20, 90, 1, 1, 360, 180, "EPSG:4326"},
        {180, 90, -1, 1, 360, 180, "EPSG:4326"},     {-180.5, -90.5, 1, -1, 360, 181, "EPSG:4326"},
    };
    for (size_t i = 0; i < sizeof globes / sizeof *globes; i++) {
        struct raster_fixture fixture = {.path = "/vsimem/globe.tif",
                                         .columns = globes[i].columns,
                                         .rows = globes[i].rows,
                                         .west = globes[i].west,
                                         .north = globes[i].north,
                                         .pixel_x = globes[i].pixel_x,
                                         .pixel_y = globes[i].pixel_y,
                                         .srs = globes[i].srs,
                                         .height = on_sphere};
        make_raster(&fixture);
        struct opened r;
        CU_ASSERT_FATAL(open_one(fixture.path, 0, &r));
        CU_ASSERT_EQUAL(r.summary->bounds[0], -180);
        CU_ASSERT_EQUAL(r.summary->bounds[1], -90);
        CU_ASSERT_EQUAL(r.summary->bounds[2], 180);
        CU_ASSERT_EQUAL(r.summary->bounds[3], 90);
        struct lattice_window window[2];
        CU_ASSERT_EQUAL(raster_windows(r.raster, window), 1);
        CU_ASSERT_EQUAL(window[0].x, 0);
        CU_ASSERT_EQUAL(window[0].columns, 512);
        CU_ASSERT_EQUAL(window[0].rows, 256);
        CU_ASSERT_TRUE(error_m(&r, -180, 180, -89.5, 89.5) < 6); /* 180 to 181 spacings: the curvature of a degree */
        CU_ASSERT_TRUE(error_m(&r, -180, 180, -90, 90) < 12);    /* half a pixel beyond the last row's centre */
        for (int64_t y = -1; y <= 257; y++) {                    /* columns go around, beyond the lattice as well */
            CU_ASSERT_EQUAL(post_m(&r, 0, y), post_m(&r, 512, y));
            CU_ASSERT_EQUAL(post_m(&r, -3, y), post_m(&r, 509, y));
            CU_ASSERT_EQUAL(post_m(&r, 515, y), post_m(&r, 3, y));
        }
        for (int64_t x = 1; x < 512; x++) { /* a pole is one point */
            CU_ASSERT_EQUAL(post_m(&r, x, 0), post_m(&r, 0, 0));
            CU_ASSERT_EQUAL(post_m(&r, x, 256), post_m(&r, 0, 256));
        }
        close_raster(&r);
    }
}

/* Rows at the poles that say something else at each longitude: the pole gets their mean. */
static void test_uneven_poles(void) {
    struct raster_fixture fixture = {.path = "/vsimem/poles.tif",
                                     .columns = 360,
                                     .rows = 181,
                                     .west = -180.5,
                                     .north = 90.5,
                                     .pixel_x = 1,
                                     .pixel_y = 1,
                                     .srs = "EPSG:4326",
                                     .height = on_sphere_uneven_poles};
    make_raster(&fixture);
    for (int zoom = 0; zoom < 4; zoom++) {
        struct opened r;
        CU_ASSERT_FATAL(open_one(fixture.path, zoom, &r));
        float north_m = post_m(&r, 17, r.lattice.rows - 1), south_m = post_m(&r, 99, 0);
        CU_ASSERT_DOUBLE_EQUAL(north_m, on_sphere(0, 90), 2);
        CU_ASSERT_DOUBLE_EQUAL(south_m, on_sphere(0, -90), 2);
        int differences = 0;
        for (int64_t x = 0; x < r.lattice.columns; x++)
            differences += post_m(&r, x, r.lattice.rows - 1) != north_m || post_m(&r, x, 0) != south_m;
        CU_ASSERT_EQUAL(differences, 0);
        close_raster(&r);
    }
}

/* Data across 180 degrees, in whatever way they are written: two windows, no seam between them. */
static void test_across_the_antimeridian(void) {
    struct raster_fixture east = {.path = "/vsimem/across.tif",
                                  .columns = 200,
                                  .rows = 100,
                                  .west = 170,
                                  .north = -10,
                                  .pixel_x = 0.1,
                                  .pixel_y = 0.1,
                                  .srs = "EPSG:4326",
                                  .height = on_sphere};
    struct raster_fixture west = east;
    for (int form = 0; form < 4; form++) {
        const char *inputs[2] = {east.path, "/vsimem/across_2.tif"};
        struct raster_options options = {.inputs = inputs, .input_count = 1, .nodata_height_m = -1};
        west.path = inputs[1];
        east.columns = west.columns = form < 2 ? 200 : 100;
        east.west = form == 1 ? -190 : 170;
        make_raster(&east);
        if (form >= 2) { /* two files that meet at 180 degrees, in either order */
            west.west = -180;
            make_raster(&west);
            options.input_count = 2;
            if (form == 3) {
                inputs[0] = west.path;
                inputs[1] = east.path;
            }
        }
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, 3, &r));
        CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[0], 170, 1e-6);
        CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[2], 190, 1e-6);
        struct lattice_window window[2];
        CU_ASSERT_EQUAL_FATAL(raster_windows(r.raster, window), 2);
        CU_ASSERT_EQUAL(window[0].x + window[0].columns, r.lattice.columns - 1);
        CU_ASSERT_EQUAL(window[1].x, 0);
        CU_ASSERT_DOUBLE_EQUAL(lattice_x(&r.lattice, (double)window[0].x), 170, 0.1);
        CU_ASSERT_DOUBLE_EQUAL(lattice_x(&r.lattice, (double)window[1].columns), -170, 0.1);
        CU_ASSERT_TRUE(error_m(&r, 170.2, 180, -19.8, -10.2) < 0.5);
        CU_ASSERT_TRUE(error_m(&r, -180, -170.2, -19.8, -10.2) < 0.5);
        CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 169.5), row_of(&r, -15)), -1);
        CU_ASSERT_EQUAL(post_m(&r, column_of(&r, -169.5), row_of(&r, -15)), -1);
        close_raster(&r);

        options.has_extent = true; /* and a crop that crosses it too */
        const double extent[4] = {175, -18, -178, -12};
        memcpy(options.extent, extent, sizeof extent);
        CU_ASSERT_FATAL(open_raster(&options, 3, &r));
        CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[0], 175, 1e-6);
        CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[2], 182, 1e-6);
        CU_ASSERT_TRUE(error_m(&r, 175.2, 180, -17.8, -12.2) < 0.5);
        CU_ASSERT_TRUE(error_m(&r, -180, -178.2, -17.8, -12.2) < 0.5);
        CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 174.5), row_of(&r, -15)), -1);
        CU_ASSERT_EQUAL(post_m(&r, column_of(&r, -177.5), row_of(&r, -15)), -1);
        close_raster(&r);
    }
}

/* A projected raster with the pole in its middle reaches all longitudes. */
static void test_polar_projection(void) {
    struct raster_fixture fixture = {.path = "/vsimem/arctic.tif",
                                     .columns = 300,
                                     .rows = 300,
                                     .west = -3000000,
                                     .north = 3000000,
                                     .pixel_x = 20000,
                                     .pixel_y = 20000,
                                     .srs = "EPSG:3995",
                                     .height = cone};
    make_raster(&fixture);
    struct opened r;
    CU_ASSERT_FATAL(open_one(fixture.path, 2, &r));
    CU_ASSERT_EQUAL(r.summary->bounds[0], -180);
    CU_ASSERT_EQUAL(r.summary->bounds[2], 180);
    CU_ASSERT_EQUAL(r.summary->bounds[3], 90);
    struct lattice_window window[2];
    CU_ASSERT_EQUAL(raster_windows(r.raster, window), 1);
    CU_ASSERT_EQUAL(window[0].columns, r.lattice.columns - 1);
    int64_t north = r.lattice.rows - 1;
    CU_ASSERT_DOUBLE_EQUAL(post_m(&r, 5, north), 4000 - 10, 10);
    int uneven = 0;
    for (int64_t x = 0; x < r.lattice.columns; x++) {
        uneven += post_m(&r, x, north) != post_m(&r, 0, north);
        /* 80 degrees north lies 1,084 km from the pole on this map. */
        uneven += fabs(post_m(&r, x, row_of(&r, 80)) - (4000 - 1084)) > 15;
    }
    CU_ASSERT_EQUAL(uneven, 0);
    close_raster(&r);
}

/* A world map in a cylindrical projection ends at 180 degrees on both sides; posts there are on it. */
static void test_world_map(void) {
    struct raster_fixture fixture = {.path = "/vsimem/world.tif",
                                     .columns = 400,
                                     .rows = 200,
                                     .west = -20037508.342789244,
                                     .north = 10018754.171394622,
                                     .pixel_x = 100187.54171394622,
                                     .pixel_y = 100187.54171394622,
                                     .srs = "EPSG:4087",
                                     .height = cone};
    make_raster(&fixture);
    struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .nodata_height_m = -30000};
    options.any_height = true;
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    int voids = 0;
    for (int64_t y = 0; y < r.lattice.rows; y++)
        for (int64_t x = 0; x < r.lattice.columns; x++) voids += post_m(&r, x, y) == -30000;
    CU_ASSERT_EQUAL(voids, 0);
    close_raster(&r);
}

static bool find_data(const char *name, char *path, size_t size) {
    const char *folder = getenv("SCREE_TEST_DATA");
    snprintf(path, size, "%s/%s", folder != NULL ? folder : TEST_DATA_DEFAULT, name);
    if (access(path, R_OK) == 0) return true;
    printf("skipped: %s is not there (SCREE_TEST_DATA names the folder) ... ", path);
    return false;
}

/* The real globe: no nodata anywhere, and the netCDF from 0 to 360 degrees is the GeoTIFF from -180 to 180. */
static void test_etopo5(void) {
    char path[512];
    if (!find_data("large/etopo5_global_4320x2161.tif", path, sizeof path)) return;
    const char *paths[2] = {path, "/usr/share/ferret-vis/data/etopo5.cdf"};
    int count = access(paths[1], R_OK) == 0 ? 2 : 1;
    if (count == 1) printf("skipped: %s is not installed ... ", paths[1]);
    struct opened r[2];
    for (int i = 0; i < count; i++) {
        struct raster_options options = {.inputs = &paths[i], .input_count = 1, .nodata_height_m = -32000};
        CU_ASSERT_FATAL(open_raster(&options, -1, &r[i]));
        CU_ASSERT_EQUAL(r[i].lattice.finest_zoom, 3);
        CU_ASSERT_EQUAL(r[i].summary->height_min_m, -10376);
        CU_ASSERT_EQUAL(r[i].summary->height_max_m, 7833);
        CU_ASSERT_EQUAL(r[i].summary->bounds[0], -180);
        CU_ASSERT_EQUAL(r[i].summary->bounds[2], 180);
    }
    int32_t columns = (int32_t)r[0].lattice.columns;
    float *rows[2];
    int voids = 0;
    double largest_m = 0;
    for (int i = 0; i < count; i++) rows[i] = malloc(sizeof(float) * (size_t)columns);
    for (int64_t y = 0; y < r[0].lattice.rows; y++) {
        for (int i = 0; i < count; i++)
            CU_ASSERT_EQUAL(raster_read(r[i].reader, 0, y, columns, 1, rows[i], columns, NULL), SCREE_OK);
        for (int32_t x = 0; x < columns; x++) {
            for (int i = 0; i < count; i++) voids += rows[i][x] < -11000;
            if (count == 2) largest_m = fmax(largest_m, fabs(rows[0][x] - rows[1][x]));
        }
        CU_ASSERT_EQUAL(rows[0][0], rows[0][columns - 1]);
    }
    CU_ASSERT_EQUAL(voids, 0);
    CU_ASSERT_TRUE(largest_m < 15); /* the netCDF's longitudes are floats, up to 1e-5 degrees off */
    for (int i = 0; i < count; i++) {
        free(rows[i]);
        close_raster(&r[i]);
    }
}

int suite_raster_globe(void) {
    CU_pSuite suite = CU_add_suite("raster globe", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_globes);
    CU_ADD_TEST(suite, test_uneven_poles);
    CU_ADD_TEST(suite, test_across_the_antimeridian);
    CU_ADD_TEST(suite, test_polar_projection);
    CU_ADD_TEST(suite, test_world_map);
    CU_ADD_TEST(suite, test_etopo5);
    return 0;
}
