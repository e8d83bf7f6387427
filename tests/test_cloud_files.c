/* Tests of files of points as rasters: LAS, text and layers, good ones and bad ones. */
#include "tests/las_maker.h"
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void put_file(const char *path, const void *bytes, size_t size) {
    VSILFILE *file = VSIFOpenL(path, "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    CU_ASSERT_EQUAL(VSIFWriteL(bytes, 1, size, file), size);
    CU_ASSERT_EQUAL(VSIFCloseL(file), 0);
}

static void put_las(const char *path, const struct las_fixture *fixture) {
    size_t size;
    unsigned char *bytes = las_make(fixture, &size);
    put_file(path, bytes, size);
    free(bytes);
}

/* 41 x 31 points 2 apart on a plane; among them what filters are to find, high above. */
static struct las_point ground(uint32_t i) {
    struct las_point point = {.class_number = i % 2 == 0 ? 2 : 9, .return_number = 1, .return_count = 1};
    point.x = 300000 + 2 * (i % 41);
    point.y = 5000000 + 2 * (i / 41 % 31);
    point.z = 0.5 * (i % 41) + 10;
    switch (i / (41 * 31)) {
    case 0: break;
    case 1: point.class_number = 5, point.return_count = 2, point.z += 100; break;
    case 2: point.class_number = 7, point.z -= 100; break;
    default: point.is_withheld = true, point.z -= 100; break;
    }
    return point;
}

static const struct las_fixture field = {.version_minor = 2,
                                         .point_format = 1,
                                         .count = 41 * 31 * 4,
                                         .point = ground,
                                         .offset = {300000, 5000000, 0},
                                         .epsg = 32611};

static bool open_cloud(const char *path, const struct cloud_options *cloud, struct opened *r) {
    struct raster_options options = {.inputs = &path, .input_count = 1, .profile = PROFILE_LOCAL};
    if (cloud != NULL) options.cloud = *cloud;
    return open_raster(&options, -1, r);
}

static void check_field(const char *path, const struct cloud_options *cloud, double metres, double top_m) {
    struct opened r;
    bool is_open = open_cloud(path, cloud, &r);
    CU_ASSERT_TRUE(is_open);
    if (!is_open) {
        printf("\n    %s\n", r.error.text);
        return;
    }
    CU_ASSERT_EQUAL(r.summary->columns, 41);
    CU_ASSERT_EQUAL(r.summary->rows, 31);
    CU_ASSERT_EQUAL(r.summary->bounds[0], 300000);
    CU_ASSERT_EQUAL(r.summary->bounds[3], 5000060);
    for (int x = 0; x < 41; x += 5) CU_ASSERT_DOUBLE_EQUAL(post_m(&r, x, 7), (0.5 * x + 10 + top_m) * metres, 1e-4);
    close_raster(&r);
}

/* Noise and withheld points never count, classes and returns as asked; the CRS and units are the file's. */
static void test_las_files(void) {
    const char *path = "/vsimem/field.las";
    struct cloud_options grid = {.named = "--grid", .grid = 2}, wanted = grid;
    struct las_fixture fixture = field;
    wanted.has_classes = true;
    wanted.classes[2] = wanted.classes[9] = true;
    put_las(path, &fixture);
    check_field(path, &wanted, 1, 0);
    wanted = grid;
    wanted.has_classes = wanted.classes[5] = true;
    check_field(path, &wanted, 1, 100);
    wanted = grid;
    wanted.returns = CLOUD_LAST_RETURN;
    check_field(path, &wanted, 1, 0);
    check_field(path, &grid, 1, 0); /* the lowest of each place */
    fixture.epsg = 2992;            /* in feet, and so are heights */
    put_las(path, &fixture);
    check_field(path, &grid, 0.3048, 0);
    fixture.vertical_unit_epsg = 9001; /* but in metres when the file says so */
    put_las(path, &fixture);
    check_field(path, &grid, 1, 0);
    struct cloud_options crowd = grid;
    crowd.has_classes = crowd.classes[77] = true;
    struct opened r;
    CU_ASSERT_FALSE(open_cloud(path, &crowd, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "let through"));
}

/* WKT before the points and behind them, and none at all. */
static void test_las_wkt(void) {
    const char *path = "/vsimem/wkt.las";
    static const char wkt[] = "PROJCRS[\"by hand\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\","
                              "ELLIPSOID[\"WGS 84\",6378137,298.257223563]]],CONVERSION[\"by hand\","
                              "METHOD[\"Transverse Mercator\"],PARAMETER[\"Longitude of natural origin\",-117],"
                              "PARAMETER[\"False easting\",500000]],CS[Cartesian,2],AXIS[\"e\",east],"
                              "AXIS[\"n\",north],LENGTHUNIT[\"foot\",0.3048]]";
    struct las_fixture fixture = field;
    fixture.version_minor = 4;
    fixture.point_format = 6;
    fixture.epsg = 0;
    fixture.wkt = wkt;
    for (int turn = 0; turn < 2; turn++) {
        struct cloud_options grid = {.named = "--grid", .grid = 2};
        fixture.wkt_is_extended = turn == 1;
        put_las(path, &fixture);
        check_field(path, &grid, 0.3048, 0);
    }
    char *compound = NULL; /* metres, but heights in feet of the US */
    OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
    CU_ASSERT_EQUAL_FATAL(OSRSetFromUserInput(crs, "EPSG:32611+6360"), OGRERR_NONE);
    CU_ASSERT_EQUAL_FATAL(OSRExportToWkt(crs, &compound), OGRERR_NONE);
    struct cloud_options two = {.named = "--grid", .grid = 2};
    fixture.wkt = compound;
    put_las(path, &fixture);
    check_field(path, &two, 1200.0 / 3937, 0);
    CPLFree(compound);
    OSRDestroySpatialReference(crs);
    put_file("/vsimem/another.wkt", wkt, sizeof wkt - 1);
    static const char *const others[] = {"no CRS at all", "/vsimem/another.wkt"}; /* a file names no other files */
    struct opened r;
    for (int i = 0; i < 2; i++) {
        fixture.wkt = others[i];
        put_las(path, &fixture);
        CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--s_srs"));
    }
    VSIUnlink("/vsimem/another.wkt");
    struct raster_options options = {.inputs = &path, .input_count = 1, .source_srs = "EPSG:32611"};
    CU_ASSERT_TRUE_FATAL(open_raster(&options, -1, &r));
    close_raster(&r);
    fixture.wkt = NULL;
    put_las(path, &fixture);
    options.source_srs = NULL;
    CU_ASSERT_FALSE(open_raster(&options, -1, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "/vsimem/wkt.las: names no coordinate system"));
}

/* Depths become negative heights, in the CRS's unit: by code, by words, and when the command line says so. */
static void test_depths(void) {
    static const struct {
        const char *vertical;
        double metres;
    } cases[] = {{"ID[\"EPSG\",5715]", -1},
                 {"ID[\"EPSG\",6358]", -1200.0 / 3937},
                 {"AXIS[\"depth\",down],LENGTHUNIT[\"metre\",1]", -1},
                 {"AXIS[\"depth\",down],LENGTHUNIT[\"foot\",0.3048]", -0.3048},
                 {"AXIS[\"height\",up],LENGTHUNIT[\"foot\",0.3048]", 0.3048}};
    const char *path = "/vsimem/depths.las";
    struct cloud_options grid = {.named = "--grid", .grid = 2};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct las_fixture fixture = field;
        char *wkt = NULL, both[4096];
        int code = 0;
        const bool is_coded = sscanf(cases[i].vertical, "ID[\"EPSG\",%d]", &code) == 1;
        OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
        snprintf(both, sizeof both, is_coded ? "EPSG:32611+%d" : "EPSG:32611", code);
        CU_ASSERT_EQUAL_FATAL(OSRSetFromUserInput(crs, both), OGRERR_NONE);
        CU_ASSERT_EQUAL_FATAL(OSRExportToWktEx(crs, &wkt, (const char *const[]){"FORMAT=WKT2_2019", NULL}),
                              OGRERR_NONE);
        OSRDestroySpatialReference(crs);
        if (is_coded)
            snprintf(both, sizeof both, "%s", wkt);
        else
            snprintf(both, sizeof both,
                     "COMPOUNDCRS[\"both\",%s,VERTCRS[\"of a lake\",VDATUM[\"the lake\"],"
                     "CS[vertical,1],%s]]",
                     wkt, cases[i].vertical);
        CPLFree(wkt);
        put_las(path, &fixture);
        struct raster_options told = {.inputs = &path, .input_count = 1, .profile = PROFILE_LOCAL, .cloud = grid};
        struct opened r;
        told.source_srs = both;
        CU_ASSERT_TRUE_FATAL(open_raster(&told, -1, &r));
        CU_ASSERT_DOUBLE_EQUAL(post_m(&r, 20, 7), 20 * cases[i].metres, 1e-4);
        close_raster(&r);
        fixture.version_minor = 4;
        fixture.point_format = 6;
        fixture.epsg = 0;
        fixture.wkt = both;
        put_las(path, &fixture);
        check_field(path, &grid, cases[i].metres, 0);
    }
}

/* Files cut off anywhere, with a record of a length that lies, compressed: one line each that names the file. */
static void test_bad_files(void) {
    const char *path = "/vsimem/bad.las";
    struct las_fixture fixture = field;
    fixture.count = 9;
    size_t size;
    struct opened r;
    unsigned char *bytes = las_make(&fixture, &size);
    for (size_t cut = 4; cut < size; cut += 3) {
        put_file(path, bytes, cut);
        CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, path));
    }
    bytes[227 + 20] = 0xFF; /* the keys' record has more bytes than there are before the points */
    put_file(path, bytes, size);
    CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "record 1 of 1"));
    bytes[104] |= 0x80;
    put_file(path, bytes, size);
    CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "laszip -i"));
    free(bytes);
    fixture.scale = 1e300;
    put_las(path, &fixture);
    CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
    struct cloud_options little = {.named = "--memory", .memory_mb = 1};
    fixture = field;
    fixture.count = 41 * 31 * 30; /* more than a megabyte as points */
    fixture.version_minor = 4;
    put_las(path, &fixture);
    struct cloud_options all = {.named = "--class", .has_classes = true, .memory_mb = 1};
    memset(all.classes, 1, sizeof all.classes);
    CU_ASSERT_FALSE(open_cloud(path, &little, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--memory"));
    little.memory_mb = 64;
    little.grid = 0.001;
    CU_ASSERT_FALSE(open_cloud(path, &little, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--memory"));
}

/* Text and a layer of OGR's make what the LAS file makes; several clouds are one. */
static void test_other_files(void) {
    struct text_file {
        const char *path, *begin, *line, *end;
    } files[] = {{"/vsimem/field.xyz", "", "%.1f %.1f %.2f\n", ""},
                 {"/vsimem/field.csv", "x;y;z\n", "%.1f;%.1f;%.2f\n", ""},
                 {"/vsimem/field.json", "{\"type\": \"FeatureCollection\", \"features\": [\n",
                  "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": {\"type\": \"Point\", \"coordinates\": "
                  "[%.1f, %.1f, %.2f]}},\n",
                  "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": null}]}\n"}};
    struct cloud_options grid = {.named = "--grid", .grid = 2};
    for (int k = 0; k < 3; k++) {
        VSILFILE *file = VSIFOpenL(files[k].path, "wb");
        VSIFPrintfL(file, "%s", files[k].begin);
        for (uint32_t i = 0; i < 41 * 31; i++) {
            struct las_point p = ground(i);
            VSIFPrintfL(file, files[k].line, p.x, p.y, p.z);
        }
        VSIFPrintfL(file, "%s", files[k].end);
        VSIFCloseL(file);
        check_field(files[k].path, &grid, 1, 0);
    }
    struct cloud_options classes = {.named = "--class", .has_classes = true};
    struct opened r;
    CU_ASSERT_FALSE(open_cloud("/vsimem/field.xyz", &classes, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "only LAS"));
    put_las("/vsimem/field.las", &field);
    const char *both[] = {"/vsimem/field.las", "/vsimem/field.xyz"};
    struct raster_options options = {.inputs = both, .input_count = 2, .source_srs = "EPSG:32611", .cloud = grid};
    options.profile = PROFILE_LOCAL;
    CU_ASSERT_TRUE_FATAL(open_raster(&options, -1, &r));
    CU_ASSERT_EQUAL(r.summary->columns, 41);
    close_raster(&r);
    options.source_srs = NULL;
    CU_ASSERT_FALSE(open_raster(&options, -1, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "/vsimem/field.xyz: has another coordinate system"));
}

static double flat(double x, double y) {
    return 0 * (x + y);
}

static void test_bad_layers(void) {
    static const struct {
        const char *geometry, *word;
    } bad[] = {{"{\"type\": \"Point\", \"coordinates\": [1, 2]}", "without a height"},
               {"{\"type\": \"LineString\", \"coordinates\": [[1, 2, 3], [2, 3, 4]]}", "Line"},
               {"null", "holds no point"}};
    const char *path = "/vsimem/bad.json";
    struct opened r;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        VSILFILE *file = VSIFOpenL(path, "wb");
        VSIFPrintfL(file, "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": %s}\n", bad[i].geometry);
        VSIFCloseL(file);
        CU_ASSERT_FALSE(open_cloud(path, NULL, &r));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, path));
        CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, bad[i].word));
    }
    struct cloud_options grid = {.named = "--grid", .grid = 2};
    static const char binary[] = "1 2 3\n\0\1\2";
    put_file("/vsimem/bad.xyz", binary, sizeof binary - 1);
    CU_ASSERT_FALSE(open_cloud("/vsimem/bad.xyz", &grid, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "line 2 is no text"));
    struct raster_fixture fixture = {.path = "/vsimem/raster.tif",
                                     .columns = 9,
                                     .rows = 9,
                                     .west = 7,
                                     .north = 47,
                                     .pixel_x = 0.1,
                                     .pixel_y = 0.1,
                                     .srs = "EPSG:4326",
                                     .height = flat};
    make_raster(&fixture);
    CU_ASSERT_FALSE(open_cloud(fixture.path, &grid, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--grid is for point clouds"));
}

/* A flat lake beside a slope, of classes 9 and 2. */
static void test_real_cloud(void) {
    char path[512];
    const char *folder = getenv("SCREE_TEST_DATA");
    snprintf(path, sizeof path, "%s/quebec_topography_ground_water.las", folder != NULL ? folder : TEST_DATA_DEFAULT);
    if (access(path, R_OK) != 0) {
        printf("skipped: %s is not there (SCREE_TEST_DATA names the folder) ... ", path);
        return;
    }
    struct opened r;
    struct cloud_options lake = {.named = "--grid", .grid = 2, .has_classes = true};
    CU_ASSERT_TRUE_FATAL(open_cloud(path, NULL, &r));
    CU_ASSERT_EQUAL(r.summary->spacing_x, 2);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->height_min_m, 789, 0.5);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->height_max_m, 814.8, 0.5);
    CU_ASSERT_PTR_NOT_NULL(strstr(r.summary->crs_wkt, "MTM zone 7"));
    close_raster(&r);
    lake.classes[9] = true;
    CU_ASSERT_TRUE_FATAL(open_cloud(path, &lake, &r));
    CU_ASSERT_DOUBLE_EQUAL(r.summary->height_max_m, 806, 0.3); /* 90 of 100 points are at 805.8 */
    close_raster(&r);
}

int suite_cloud_files(void) {
    CU_pSuite suite = CU_add_suite("cloud files", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_las_files);
    CU_ADD_TEST(suite, test_las_wkt);
    CU_ADD_TEST(suite, test_depths);
    CU_ADD_TEST(suite, test_bad_files);
    CU_ADD_TEST(suite, test_other_files);
    CU_ADD_TEST(suite, test_bad_layers);
    CU_ADD_TEST(suite, test_real_cloud);
    return 0;
}
