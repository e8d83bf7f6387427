/* Tests of raster_io: units of height, vertical systems, and what is said about them. */
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_conv.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <proj.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double flat_500(double x, double y) {
    (void)x, (void)y;
    return 500;
}

static const struct raster_fixture alps = {.path = "/vsimem/alps.tif",
                                           .columns = 300,
                                           .rows = 200,
                                           .west = 7,
                                           .north = 47,
                                           .pixel_x = 0.001,
                                           .pixel_y = 0.001,
                                           .srs = "EPSG:4326",
                                           .height = flat_500};

static bool has_grid(const char *srs) {
    PJ_CONTEXT *context = proj_context_create();
    PJ *source = proj_create(context, srs), *target = proj_create(context, "EPSG:4979");
    PJ_OPERATION_FACTORY_CONTEXT *factory = proj_create_operation_factory_context(context, NULL);
    proj_operation_factory_context_set_allow_ballpark_transformations(context, factory, 0);
    proj_operation_factory_context_set_grid_availability_use(context, factory,
                                                             PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
    PJ_OBJ_LIST *list = proj_create_operations(context, source, target, factory);
    bool found = list != NULL && proj_list_get_count(list) > 0;
    proj_list_destroy(list);
    proj_operation_factory_context_destroy(factory);
    proj_destroy(target);
    proj_destroy(source);
    proj_context_destroy(context);
    return found;
}

static void test_units(void) {
    static const struct {
        const char *unit;
        double metres;
        bool is_known;
    } units[] = {
        {"m", 1, true},
        {"metre", 1, true},
        {"METERS", 1, true},
        {"ft", 0.3048, true},
        {"feet", 0.3048, true},
        {"foot", 0.3048, true},
        {"US survey foot", 1200.0 / 3937, true},
        {"us-ft", 1200.0 / 3937, true},
        {"fathom", 1.8288, true},
        {"centimetre", 0.01, true},
        {"cm", 0.01, true},
        {"km", 1000, true},
        {"Indian yard", 0.914398530744440774, true},
        {"parrots", 1, false},
    };
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        for (int profile = 0; profile < 2; profile++) {
            struct raster_fixture fixture = alps;
            fixture.unit = units[i].unit;
            fixture.scale = 0.5;
            fixture.offset = 3;
            make_raster(&fixture);
            struct raster_options options = {
                .inputs = &fixture.path, .input_count = 1, .profile = (enum profile)profile, .any_height = true};
            struct opened r;
            CU_ASSERT_FATAL(open_raster(&options, 11, &r));
            double expected_m = 253 * units[i].metres;
            CU_ASSERT_DOUBLE_EQUAL(r.summary->height_min_m, expected_m, expected_m * 1e-6);
            int64_t x = profile == PROFILE_LOCAL ? 5 : column_of(&r, 7.1);
            int64_t y = profile == PROFILE_LOCAL ? 5 : row_of(&r, 46.9);
            CU_ASSERT_DOUBLE_EQUAL(post_m(&r, x, y), expected_m, expected_m * 1e-6);
            CU_ASSERT_EQUAL(strstr(r.summary->datum, "\"parrots\" is unknown") != NULL, !units[i].is_known);
            close_raster(&r);
        }
}

/* EGM96: heights become ellipsoidal, post by post as PROJ's own transformation says. */
static void test_egm96(void) {
    if (!has_grid("EPSG:4326+5773")) {
        printf("skipped: PROJ has no EGM96 grid (Debian: proj-data) ... ");
        return;
    }
    make_raster(&alps);
    struct raster_options options = {.inputs = &alps.path, .input_count = 1, .source_srs = "EPSG:4326+5773"};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 11, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.summary->datum, "EGM96 height"));
    PJ_CONTEXT *context = proj_context_create();
    PJ *expected = proj_create_crs_to_crs(context, "EPSG:4326+5773", "EPSG:4979", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(expected);
    double largest_m = 0, lowest_m = INFINITY, highest_m = -INFINITY;
    for (int64_t y = row_of(&r, 46.802); y < row_of(&r, 46.998); y += 7)
        for (int64_t x = column_of(&r, 7.002); x < column_of(&r, 7.298); x += 7) {
            PJ_COORD at = proj_coord(lattice_y(&r.lattice, (double)y), lattice_x(&r.lattice, (double)x), 500, HUGE_VAL);
            double height_m = proj_trans(expected, PJ_FWD, at).xyz.z;
            largest_m = fmax(largest_m, fabs(post_m(&r, x, y) - height_m));
            lowest_m = fmin(lowest_m, height_m);
            highest_m = fmax(highest_m, height_m);
        }
    CU_ASSERT_TRUE(largest_m < 1e-3);
    CU_ASSERT_TRUE(lowest_m > 545 && highest_m < 555); /* the geoid is some 50 m above the ellipsoid here */
    CU_ASSERT_TRUE(r.summary->height_min_m > 540 && r.summary->height_max_m < 560);
    CU_ASSERT_TRUE(r.summary->height_min_m - r.summary->relief_margin_m <= lowest_m);
    CU_ASSERT_TRUE(r.summary->height_max_m + r.summary->relief_margin_m >= highest_m);
    proj_destroy(expected);
    proj_context_destroy(context);
    close_raster(&r);
}

/* A vertical system of its own unit and direction, and one in a file rather than in an option. */
static void test_vertical_axis(void) {
    if (!has_grid("EPSG:4326+5773")) {
        printf("skipped: PROJ has no EGM96 grid (Debian: proj-data) ... ");
        return;
    }
    static const char compound[] =
        "COMPOUNDCRS[\"x\",GEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS 84\",6378137,"
        "298.257223563]],CS[ellipsoidal,2],AXIS[\"latitude\",north],AXIS[\"longitude\",east],UNIT[\"degree\","
        "0.0174532925199433],ID[\"EPSG\",4326]],VERTCRS[\"EGM96 height (ft)\",VDATUM[\"EGM96 geoid\","
        "ID[\"EPSG\",5171]],CS[vertical,1],AXIS[\"up\",up],LENGTHUNIT[\"foot\",0.3048]]]";
    struct raster_fixture fixture = alps;
    make_raster(&fixture);
    struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .source_srs = compound};
    struct opened feet, metres;
    bool is_open = open_raster(&options, 11, &feet);
    CU_ASSERT_TRUE_FATAL(is_open);
    options.source_srs = "EPSG:4326+5773";
    CU_ASSERT_FATAL(open_raster(&options, 11, &metres));
    int64_t x = column_of(&feet, 7.1), y = row_of(&feet, 46.9);
    double shift_m = post_m(&metres, x, y) - 500;
    CU_ASSERT_DOUBLE_EQUAL(post_m(&feet, x, y), 500 * 0.3048 + shift_m, 1e-3);
    close_raster(&metres);
    close_raster(&feet);

    fixture.srs = "EPSG:4326+5773";
    fixture.path = "/vsimem/compound.tif";
    make_raster(&fixture);
    options.inputs = &fixture.path;
    options.source_srs = NULL;
    CU_ASSERT_FATAL(open_raster(&options, 11, &metres));
    CU_ASSERT_DOUBLE_EQUAL(post_m(&metres, x, y), 500 + shift_m, 1e-3);
    close_raster(&metres);

    options.source_srs = "EPSG:4326"; /* the user says that heights are to be taken as they are */
    CU_ASSERT_FATAL(open_raster(&options, 11, &metres));
    CU_ASSERT_EQUAL(post_m(&metres, x, y), 500);
    CU_ASSERT_PTR_NOT_NULL(strstr(metres.summary->datum, "no vertical datum is named"));
    close_raster(&metres);
}

/* Inputs of different vertical systems are shifted each by its own operation before they meet. */
static void test_mixed_datums(void) {
    if (!has_grid("EPSG:4326+5773")) {
        printf("skipped: PROJ has no EGM96 grid (Debian: proj-data) ... ");
        return;
    }
    struct raster_fixture west = alps, east = alps;
    west.path = "/vsimem/datum_west.tif";
    west.srs = "EPSG:4326+5773";
    west.columns = 150;
    east.path = "/vsimem/datum_east.tif";
    east.west = 7.15;
    east.columns = 150;
    east.srs = "EPSG:4979";
    make_raster(&west);
    make_raster(&east);
    const char *inputs[2] = {west.path, east.path};
    struct raster_options options = {.inputs = inputs, .input_count = 2};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 11, &r));
    CU_ASSERT_TRUE(post_m(&r, column_of(&r, 7.1), row_of(&r, 46.9)) > 540);
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.2), row_of(&r, 46.9)), 500);
    CU_ASSERT_TRUE(r.summary->height_min_m <= 500 && r.summary->height_max_m > 540);
    close_raster(&r);
}

/* A grid that PROJ cannot find is an error that names it. */
static void test_missing_grids(void) {
    static const struct {
        const char *srs, *grid;
        double west, north;
    } cases[] = {{"EPSG:4326+3855", "egm08", 7, 47}, {"EPSG:4269+5703", "geoid", -122, 37}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (has_grid(cases[i].srs)) {
            printf("skipped: PROJ has a grid for %s ... ", cases[i].srs);
            continue;
        }
        struct raster_fixture fixture = alps;
        fixture.west = cases[i].west;
        fixture.north = cases[i].north;
        make_raster(&fixture);
        struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .source_srs = cases[i].srs};
        struct opened r;
        CU_ASSERT_FALSE(open_raster(&options, 11, &r));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, fixture.path));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, cases[i].grid));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--s_srs"));
    }
    /* A system to which PROJ knows no way at all. */
    struct raster_options options = {.inputs = &alps.path, .input_count = 1, .source_srs = "EPSG:4258+5783"};
    make_raster(&alps);
    struct opened r;
    CU_ASSERT_FALSE(open_raster(&options, 11, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "DHHN92"));
}

/* The local profile keeps its own datum but not its feet. */
static void test_local_keeps_its_datum(void) {
    struct raster_fixture fixture = alps;
    fixture.path = "/vsimem/local_feet.tif";
    fixture.srs = "EPSG:26910+6360"; /* NAVD88 in US survey feet */
    fixture.west = 500000;
    fixture.north = 5000000;
    fixture.pixel_x = fixture.pixel_y = 10;
    make_raster(&fixture);
    struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .profile = PROFILE_LOCAL};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    CU_ASSERT_DOUBLE_EQUAL(post_m(&r, 3, 3), 500 * 1200.0 / 3937, 1e-4);
    CU_ASSERT_PTR_NOT_NULL(strstr(r.summary->crs_wkt, "NAVD88"));
    close_raster(&r);

    fixture.srs = "EPSG:2225"; /* California zone 1 in US survey feet */
    make_raster(&fixture);
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    CU_ASSERT_DOUBLE_EQUAL(r.summary->metres_per_unit, 1200.0 / 3937, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(r.lattice.metres_x, 12000.0 / 3937, 1e-9);
    CU_ASSERT_EQUAL(post_m(&r, 3, 3), 500); /* no unit of height is named: metres */
    close_raster(&r);
}

/* NAD27 to WGS 84 in Europe's, North America's ... best operation moves posts by some tens of metres. */
static void test_horizontal_datum(void) {
    struct raster_fixture fixture = alps;
    fixture.path = "/vsimem/ed50.tif";
    fixture.srs = "EPSG:23032"; /* ED50 / UTM 32N: some 100 m from WGS 84 */
    fixture.west = 400000;
    fixture.north = 5200000;
    fixture.pixel_x = fixture.pixel_y = 50;
    make_raster(&fixture);
    struct opened r;
    CU_ASSERT_FATAL(open_one(fixture.path, -1, &r));
    double west = r.summary->bounds[0], north = r.summary->bounds[3];
    close_raster(&r);
    fixture.srs = "EPSG:32632";
    make_raster(&fixture);
    CU_ASSERT_FATAL(open_one(fixture.path, -1, &r));
    double moved_east_m = (r.summary->bounds[0] - west) * 111320 * cos(47 * 0.0174533);
    double moved_north_m = (r.summary->bounds[3] - north) * 111180;
    CU_ASSERT_TRUE(moved_east_m > 60 && moved_east_m < 110);
    CU_ASSERT_TRUE(moved_north_m > 170 && moved_north_m < 230);
    close_raster(&r);
}

int suite_raster_datum(void) {
    CU_pSuite suite = CU_add_suite("raster datum", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_units);
    CU_ADD_TEST(suite, test_egm96);
    CU_ADD_TEST(suite, test_vertical_axis);
    CU_ADD_TEST(suite, test_mixed_datums);
    CU_ADD_TEST(suite, test_missing_grids);
    CU_ADD_TEST(suite, test_local_keeps_its_datum);
    CU_ADD_TEST(suite, test_horizontal_datum);
    return 0;
}
