/* Tests of raster_io: several inputs on top of each other, and voids. */
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <gdal_alg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NODATA (-9999)

static double waves(double x, double y) {
    return 1000 + 300 * sin(x * 40) * cos(y * 55);
}

static double waves_without_middle(double x, double y) {
    return x > 7.1 && x < 7.2 && y > 46.88 && y < 46.92 ? NODATA : waves(x, y);
}

static double flat_500(double x, double y) {
    (void)x, (void)y;
    return 500;
}

static double flat_700(double x, double y) {
    (void)x, (void)y;
    return 700;
}

static double ramp_utm(double x, double y) {
    return (x - 400000) / 100 + (y - 5180000) / 200;
}

static const struct raster_fixture base = {.path = "/vsimem/base.tif",
                                           .columns = 300,
                                           .rows = 200,
                                           .west = 7,
                                           .north = 47,
                                           .pixel_x = 0.001,
                                           .pixel_y = 0.001,
                                           .srs = "EPSG:4326",
                                           .height = waves};

/* Largest difference of two rasters over the first one's windows, a margin included. */
static double difference_m(struct opened *a, struct opened *b) {
    struct lattice_window window[2];
    int count = raster_windows(a->raster, window);
    double largest_m = 0;
    for (int i = 0; i < count; i++)
        for (int64_t y = window[i].y - 3; y <= window[i].y + window[i].rows + 3; y++)
            for (int64_t x = window[i].x - 3; x <= window[i].x + window[i].columns + 3; x++)
                largest_m = fmax(largest_m, fabs(post_m(a, x, y) - post_m(b, x, y)));
    return largest_m;
}

/* Two halves that abut give the very posts of the whole: no seam of half a pixel between them. */
static void test_halves_are_the_whole(void) {
    make_raster(&base);
    struct raster_fixture west = base, east = base;
    west.path = "/vsimem/half_west.tif";
    west.columns = 130;
    east.path = "/vsimem/half_east.tif";
    east.west = 7 + 130 * 0.001;
    east.columns = 170;
    make_raster(&west);
    make_raster(&east);
    const char *halves[2][2] = {{west.path, east.path}, {east.path, west.path}};
    for (int order = 0; order < 2; order++)
        for (int profile = 0; profile < 2; profile++) {
            struct raster_options options = {.inputs = &base.path, .input_count = 1, .profile = (enum profile)profile};
            struct opened whole, parts;
            CU_ASSERT_FATAL(open_raster(&options, 11, &whole));
            options.inputs = halves[order];
            options.input_count = 2;
            CU_ASSERT_FATAL(open_raster(&options, 11, &parts));
            CU_ASSERT_DOUBLE_EQUAL(difference_m(&whole, &parts), 0, 1e-4); /* of a float's last bits */
            close_raster(&parts);
            close_raster(&whole);
        }
}

static void test_later_on_top(void) {
    struct raster_fixture low = base, high = base;
    low.path = "/vsimem/low.tif";
    low.height = flat_500;
    high.path = "/vsimem/high.tif"; /* another resolution, not on the grid of the first */
    high.height = flat_700;
    high.west = 7.10043;
    high.north = 46.95021;
    high.pixel_x = high.pixel_y = 0.00037;
    high.columns = high.rows = 100;
    make_raster(&low);
    make_raster(&high);
    const char *inputs[2] = {low.path, high.path};
    struct raster_options options = {.inputs = inputs, .input_count = 2};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 12, &r));
    CU_ASSERT_DOUBLE_EQUAL(r.summary->spacing_x, 0.00037, 1e-9);
    CU_ASSERT_EQUAL(r.summary->height_min_m, 500);
    CU_ASSERT_EQUAL(r.summary->height_max_m, 700);
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.12), row_of(&r, 46.93)), 700);
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.02), row_of(&r, 46.93)), 500);
    close_raster(&r);
    const char *turned[2] = {high.path, low.path};
    options.inputs = turned;
    CU_ASSERT_FATAL(open_raster(&options, 12, &r));
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.12), row_of(&r, 46.93)), 500);
    close_raster(&r);
}

/* A lower raster in another CRS shows through the void of a higher one. */
static void test_voids_show_what_lies_below(void) {
    struct raster_fixture below = {.path = "/vsimem/below.tif",
                                   .columns = 500,
                                   .rows = 500,
                                   .west = 340000,
                                   .north = 5210000,
                                   .pixel_x = 90,
                                   .pixel_y = 90,
                                   .srs = "EPSG:32632",
                                   .height = ramp_utm};
    struct raster_fixture above = base;
    above.path = "/vsimem/above.tif";
    above.height = waves_without_middle;
    above.has_nodata = true;
    above.nodata = NODATA;
    make_raster(&below);
    make_raster(&above);
    const char *inputs[2] = {below.path, above.path};
    struct raster_options options = {.inputs = inputs, .input_count = 2};
    struct opened both, alone;
    CU_ASSERT_FATAL(open_raster(&options, 11, &both));
    CU_ASSERT_FATAL(open_one(below.path, 11, &alone));
    int64_t x = column_of(&both, 7.15), y = row_of(&both, 46.90);
    CU_ASSERT_EQUAL(post_m(&both, x, y), post_m(&alone, x, y));
    CU_ASSERT_TRUE(post_m(&alone, x, y) < 300);
    x = column_of(&both, 7.05);
    CU_ASSERT_DOUBLE_EQUAL(post_m(&both, x, y), waves(lattice_x(&both.lattice, (double)x), 46.90), 5);
    close_raster(&alone);
    close_raster(&both);
}

/* GDAL's own filling of a whole file, row 0 first; to be freed. */
static float *filled_by_gdal(const char *path, int columns, int rows, int distance) {
    float *filled = malloc(sizeof *filled * (size_t)columns * (size_t)rows);
    CU_ASSERT_PTR_NOT_NULL_FATAL(filled);
    GDALDatasetH source = GDALOpen(path, GA_ReadOnly);
    GDALDatasetH copy = GDALCreateCopy(GDALGetDriverByName("MEM"), "", source, FALSE, NULL, NULL, NULL);
    GDALRasterBandH band = GDALGetRasterBand(copy, 1);
    CU_ASSERT_EQUAL(GDALFillNodata(band, NULL, distance, 0, 0, NULL, NULL, NULL), CE_None);
    CU_ASSERT_EQUAL(GDALRasterIO(band, GF_Read, 0, 0, columns, rows, filled, columns, rows, GDT_Float32, 0, 0),
                    CE_None);
    GDALClose(copy);
    GDALClose(source);
    return filled;
}

static double with_speckles(double x, double y) {
    double hash = fabs(sin(x * 12989.8 + y * 78233.1)) * 43758.5453;
    return hash - floor(hash) < 0.75 ? NODATA : waves(x, y);
}

/* Steps to the next height from a void pixel in one direction; 0: there is none. */
static int steps_to_height(const struct opened *r, height_function height, int64_t x, int64_t y, int step_x,
                           int step_y) {
    for (int steps = 1;; steps++) {
        x += step_x;
        y += step_y;
        if (x < 0 || y < 0 || x >= r->lattice.columns || y >= r->lattice.rows) return 0;
        if (height(lattice_x(&r->lattice, (double)x), lattice_y(&r->lattice, (double)y)) != NODATA) return steps;
    }
}

static bool is_within(int before, int after, int distance) {
    return before > 0 && after > 0 && before + after - 1 <= distance;
}

/* Voids that are not too wide: bit for bit what GDALFillNodata makes of the whole raster at once. But for its last
 * column, where GDALFillNodata counts the post's own column twice for want of one to the right; our regions have
 * margins. */
static void test_fill_is_gdals(void) {
    enum { COLUMNS = 300, ROWS = 280, DISTANCE = 12 };
    struct raster_fixture fixture = base;
    fixture.path = "/vsimem/speckles.tif";
    fixture.columns = COLUMNS;
    fixture.rows = ROWS;
    fixture.north = 47.02;
    fixture.pixel_y = -0.001; /* south-up: the file's rows are the lattice's */
    fixture.height = with_speckles;
    fixture.has_nodata = true;
    fixture.nodata = NODATA;
    make_raster(&fixture);
    float *filled = filled_by_gdal(fixture.path, COLUMNS, ROWS, DISTANCE);
    struct raster_options options = {
        .inputs = &fixture.path, .input_count = 1, .profile = PROFILE_LOCAL, .fill_distance = DISTANCE};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    int compared = 0, differences = 0;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS - 1; x++) {
            bool is_void = with_speckles(lattice_x(&r.lattice, x), lattice_y(&r.lattice, y)) == NODATA;
            if (is_void &&
                !is_within(steps_to_height(&r, with_speckles, x, y, -1, 0),
                           steps_to_height(&r, with_speckles, x, y, 1, 0), DISTANCE) &&
                !is_within(steps_to_height(&r, with_speckles, x, y, 0, -1),
                           steps_to_height(&r, with_speckles, x, y, 0, 1), DISTANCE))
                continue;
            compared += is_void;
            differences += post_m(&r, x, y) != filled[y * COLUMNS + x];
        }
    CU_ASSERT_TRUE(compared > COLUMNS * ROWS / 2);
    CU_ASSERT_EQUAL(differences, 0);
    close_raster(&r);
    free(filled);
}

static double with_lake_and_bay(double x, double y) {
    if (x > 7.1 && x < 7.2 && y > 46.88 && y < 46.92) return NODATA;  /* 100 x 40 pixels inside */
    return x > 7.26 && y > 46.82 && y < 46.86 ? NODATA : waves(x, y); /* 40 x 40 pixels at the border */
}

/* A void wider than the fill distance is interpolated all the same when data enclose it; one that is open to the
 * outside is not. */
static void test_enclosed_voids(void) {
    struct raster_fixture fixture = base;
    fixture.path = "/vsimem/lake.tif";
    fixture.height = with_lake_and_bay;
    fixture.has_nodata = true;
    fixture.nodata = NODATA;
    make_raster(&fixture);
    for (int profile = 0; profile < 2; profile++)
        for (int distance = -1; distance < 50; distance += distance < 0 ? 11 : 30) { /* none, 10 and 40 posts */
            struct raster_options options = {.inputs = &fixture.path,
                                             .input_count = 1,
                                             .profile = (enum profile)profile,
                                             .nodata_height_m = -3,
                                             .fill_distance = distance};
            struct opened r;
            CU_ASSERT_FATAL(open_raster(&options, 11, &r));
            int outside = 0, inside = 0, lake = 0, bay = 0, count = 0;
            for (int64_t y = row_of(&r, 46.883); y <= row_of(&r, 46.917); y++)
                for (int64_t x = column_of(&r, 7.103); x <= column_of(&r, 7.197); x++, count++) {
                    lake += post_m(&r, x, y) == -3;
                    inside += post_m(&r, x, y) > 600 && post_m(&r, x, y) < 1400;
                }
            CU_ASSERT_TRUE(count > 3000);
            CU_ASSERT_EQUAL(lake, distance < 0 ? count : 0);
            CU_ASSERT_EQUAL(inside, distance < 0 ? 0 : count);
            for (int64_t y = row_of(&r, 46.825); y <= row_of(&r, 46.855); y++, outside++)
                bay += post_m(&r, column_of(&r, 7.29), y) == -3;
            /* 40 pixels from south to north are 40 posts here, and 117 there. */
            CU_ASSERT_EQUAL(bay, profile == PROFILE_LOCAL && distance == 40 ? 0 : outside);
            close_raster(&r);
        }
}

static double odd_values(double x, double y) {
    int i = (int)lround((x - 7.0005) / 0.001), j = (int)lround((46.9995 - y) / 0.001);
    if (i == 10 && j == 10) return NAN;
    if (i == 20 && j == 10) return INFINITY;
    if (i == 30 && j == 10) return -INFINITY;
    if (i == 40 && j == 10) return NODATA;
    return 250;
}

/* NaN and infinity are voids whatever is declared; -a_nodata replaces the declared value. */
static void test_odd_values(void) {
    struct raster_fixture fixture = base;
    fixture.path = "/vsimem/odd.tif";
    fixture.height = odd_values;
    fixture.columns = 60;
    fixture.rows = 30;
    for (int pass = 0; pass < 4; pass++) {
        fixture.type = pass % 2 == 0 ? GDT_Float32 : GDT_Float64;
        fixture.has_nodata = pass < 2;
        fixture.nodata = pass < 2 ? NODATA : 0;
        make_raster(&fixture);
        struct raster_options options = {.inputs = &fixture.path,
                                         .input_count = 1,
                                         .profile = PROFILE_LOCAL,
                                         .has_nodata = pass >= 2,
                                         .nodata = NODATA};
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, 0, &r));
        CU_ASSERT_EQUAL(r.summary->height_min_m, 250);
        CU_ASSERT_EQUAL(r.summary->height_max_m, 250);
        for (int x = 10; x <= 40; x += 10) CU_ASSERT_EQUAL(post_m(&r, x, 29 - 10), 250);
        close_raster(&r);
        options.fill_distance = -1;
        options.nodata_height_m = -77;
        CU_ASSERT_FATAL(open_raster(&options, 0, &r));
        for (int x = 10; x <= 40; x += 10) CU_ASSERT_EQUAL(post_m(&r, x, 29 - 10), -77);
        CU_ASSERT_EQUAL(post_m(&r, 11, 29 - 10), 250);
        close_raster(&r);
    }
}

/* A mask band makes voids as well as a nodata value does. */
static void test_mask_band(void) {
    struct raster_fixture fixture = base;
    fixture.path = "/vsimem/masked.tif";
    fixture.height = flat_500;
    make_raster(&fixture);
    GDALDatasetH dataset = GDALOpen(fixture.path, GA_Update);
    CU_ASSERT_EQUAL_FATAL(GDALCreateDatasetMaskBand(dataset, GMF_PER_DATASET), CE_None);
    GDALRasterBandH mask = GDALGetMaskBand(GDALGetRasterBand(dataset, 1));
    CU_ASSERT_EQUAL(GDALFillRaster(mask, 255, 0), CE_None);
    unsigned char zero[100] = {0};
    CU_ASSERT_EQUAL(GDALRasterIO(mask, GF_Write, 0, 0, 10, 10, zero, 10, 10, GDT_Byte, 0, 0), CE_None);
    GDALClose(dataset);
    struct raster_options options = {
        .inputs = &fixture.path, .input_count = 1, .profile = PROFILE_LOCAL, .nodata_height_m = 1};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    CU_ASSERT_EQUAL(post_m(&r, 0, 199), 1);
    CU_ASSERT_EQUAL(post_m(&r, 9, 190), 1);
    CU_ASSERT_EQUAL(post_m(&r, 10, 190), 500);
    CU_ASSERT_EQUAL(post_m(&r, 9, 189), 500);
    close_raster(&r);
}

/* More files than a reader keeps open. */
static void test_many_inputs(void) {
    enum { COUNT = 60 };
    char paths[COUNT][40];
    const char *inputs[COUNT];
    for (int i = 0; i < COUNT; i++) {
        struct raster_fixture strip = base;
        snprintf(paths[i], sizeof paths[i], "/vsimem/strip%d.tif", i);
        strip.path = inputs[i] = paths[i];
        strip.columns = 5;
        strip.west = 7 + 0.005 * i;
        make_raster(&strip);
    }
    make_raster(&base);
    struct raster_options options = {.inputs = inputs, .input_count = COUNT, .profile = PROFILE_LOCAL};
    struct opened strips, whole;
    CU_ASSERT_FATAL(open_raster(&options, 0, &strips));
    options.inputs = &base.path;
    options.input_count = 1;
    CU_ASSERT_FATAL(open_raster(&options, 0, &whole));
    CU_ASSERT_EQUAL(strips.lattice.columns, 300);
    CU_ASSERT_DOUBLE_EQUAL(difference_m(&strips, &whole), 0, 1e-4);
    close_raster(&whole);
    close_raster(&strips);
}

int suite_raster_mosaic(void) {
    CU_pSuite suite = CU_add_suite("raster mosaic and voids", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_halves_are_the_whole);
    CU_ADD_TEST(suite, test_later_on_top);
    CU_ADD_TEST(suite, test_voids_show_what_lies_below);
    CU_ADD_TEST(suite, test_fill_is_gdals);
    CU_ADD_TEST(suite, test_enclosed_voids);
    CU_ADD_TEST(suite, test_odd_values);
    CU_ADD_TEST(suite, test_mask_band);
    CU_ADD_TEST(suite, test_many_inputs);
    return 0;
}
