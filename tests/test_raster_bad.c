/* Tests of raster_io with bad input: each ends in one line that names the input and says what to do. */
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static double waves(double x, double y) {
    return 1000 + 300 * sin(x * 40) * cos(y * 55);
}

static double only_nodata(double x, double y) {
    (void)x, (void)y;
    return -9999;
}

static double one_spike(double x, double y) {
    return fabs(x - 7.0105) < 1e-6 && fabs(y - 46.9905) < 1e-6 ? -32767 : 100;
}

static const struct raster_fixture good = {.path = "/vsimem/good.tif",
                                           .columns = 60,
                                           .rows = 50,
                                           .west = 7,
                                           .north = 47,
                                           .pixel_x = 0.001,
                                           .pixel_y = 0.001,
                                           .srs = "EPSG:4326",
                                           .height = waves};

static void put_file(const char *path, const void *bytes, size_t size) {
    VSILFILE *file = VSIFOpenL(path, "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    CU_ASSERT_EQUAL(VSIFWriteL(bytes, 1, size, file), size);
    CU_ASSERT_EQUAL(VSIFCloseL(file), 0);
}

/* Opening fails with a line that holds both texts, and with nothing to free. */
static void refused(const struct raster_options *options, const char *first, const char *second) {
    struct opened r;
    bool is_open = open_raster(options, -1, &r);
    CU_ASSERT_FALSE(is_open);
    if (is_open) {
        printf("\n    should not open: %s\n", options->inputs[0]);
        close_raster(&r);
        return;
    }
    CU_ASSERT_TRUE(r.error.status < 0);
    CU_ASSERT_PTR_NULL(strchr(r.error.text, '\n'));
    bool has_both = strstr(r.error.text, first) != NULL && strstr(r.error.text, second) != NULL;
    CU_ASSERT_TRUE(has_both);
    if (!has_both) printf("\n    \"%s\" lacks \"%s\" or \"%s\"\n", r.error.text, first, second);
}

static void refused_file(const char *path, const char *what) {
    for (int profile = 0; profile < 2; profile++) {
        struct raster_options options = {.inputs = &path, .input_count = 1, .profile = (enum profile)profile};
        refused(&options, path, what);
    }
}

static void test_no_rasters(void) {
    static const char text[] = "this is no raster, whatever its name says\n";
    put_file("/vsimem/text.tif", text, sizeof text - 1);
    put_file("/vsimem/empty.tif", "", 0);
    refused_file("/vsimem/text.tif", "not recognized");
    refused_file("/vsimem/empty.tif", "not recognized");
    refused_file("/nowhere/at/all.tif", "No such file");
    refused_file("", "");
    struct raster_options none = {.input_count = 0};
    refused(&none, "no raster", "named");
}

/* A GeoTIFF cut at any length: it is refused, when it is opened or when its pixels are read. */
static void test_truncated(void) {
    struct raster_fixture fixture = good;
    fixture.path = "/vsimem/whole.tif";
    fixture.has_nodata = true;
    fixture.nodata = -9999;
    make_raster(&fixture);
    vsi_l_offset size = 0;
    unsigned char *bytes = VSIGetMemFileBuffer(fixture.path, &size, FALSE);
    CU_ASSERT_PTR_NOT_NULL_FATAL(bytes);
    CU_ASSERT_TRUE(size > 12000);
    for (size_t cut = 0; cut < size; cut += cut < 1000 ? 37 : 1013) {
        const char *path = "/vsimem/cut.tif";
        put_file(path, bytes, cut);
        struct raster_options options = {.inputs = &path, .input_count = 1};
        struct opened r;
        bool is_open = open_raster(&options, -1, &r);
        CU_ASSERT_FALSE(is_open);
        if (is_open) {
            printf("\n    opened although cut to %zu of %llu bytes\n", cut, (unsigned long long)size);
            close_raster(&r);
        } else {
            CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, path));
        }
    }
}

static void test_all_nodata(void) {
    struct raster_fixture fixture = good;
    fixture.path = "/vsimem/nodata.tif";
    fixture.height = only_nodata;
    fixture.has_nodata = true;
    fixture.nodata = -9999;
    make_raster(&fixture);
    refused_file(fixture.path, "nodata");
}

/* Undeclared nodata: the line names the value and the option; both options let it pass. */
static void test_heights_beyond_20_km(void) {
    struct raster_fixture fixture = good;
    fixture.path = "/vsimem/spike.tif";
    fixture.height = one_spike;
    static const GDALDataType types[] = {GDT_Int16, GDT_Int32, GDT_Float32, GDT_Float64};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        fixture.type = types[i];
        make_raster(&fixture);
        refused_file(fixture.path, "-a_nodata -32767");
        refused_file(fixture.path, "--any-height");
        struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .any_height = true};
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, -1, &r));
        CU_ASSERT_EQUAL(r.summary->height_min_m, -32767);
        close_raster(&r);
        options.any_height = false;
        options.has_nodata = true;
        options.nodata = -32767;
        CU_ASSERT_FATAL(open_raster(&options, -1, &r));
        CU_ASSERT_EQUAL(r.summary->height_min_m, 100);
        close_raster(&r);
    }
}

static void test_georeference(void) {
    struct raster_fixture fixture = good;
    fixture.path = "/vsimem/bare.tif";
    fixture.srs = NULL;
    make_raster(&fixture);
    struct raster_options options = {.inputs = &fixture.path, .input_count = 1};
    refused(&options, fixture.path, "--profile local");
    refused(&options, fixture.path, "--s_srs");
    struct opened r;
    options.source_srs = "EPSG:4326";
    CU_ASSERT_FATAL(open_raster(&options, -1, &r));
    close_raster(&r);
    options.source_srs = "EPSG:nonsense";
    refused(&options, "EPSG:nonsense", "--s_srs");

    fixture.pixel_x = fixture.pixel_y = 0; /* neither CRS nor geotransform */
    make_raster(&fixture);
    options.source_srs = NULL;
    refused(&options, fixture.path, "--profile local");
    options.profile = PROFILE_LOCAL;
    CU_ASSERT_FATAL(open_raster(&options, 0, &r));
    CU_ASSERT_EQUAL(r.lattice.columns, 60);
    CU_ASSERT_STRING_EQUAL(r.summary->crs_wkt, "");
    CU_ASSERT_EQUAL(post_m(&r, 7, 3), (float)waves(7, 46)); /* row 46 of the file is the third from the south */
    close_raster(&r);
}

static void put_vrt(const char *path, const char *size, const char *srs, const char *geotransform, const char *type,
                    const char *source) {
    char text[2000];
    int length = snprintf(text, sizeof text,
                          "<VRTDataset %s><SRS>%s</SRS><GeoTransform>%s</GeoTransform><VRTRasterBand dataType=\"%s\" "
                          "band=\"1\">%s</VRTRasterBand></VRTDataset>",
                          size, srs, geotransform, type, source);
    CU_ASSERT_TRUE_FATAL(length > 0 && (size_t)length < sizeof text);
    put_file(path, text, (size_t)length);
}

#define SMALL "rasterXSize=\"60\" rasterYSize=\"50\""
#define GOOD_SOURCE                                                                             \
    "<SimpleSource><SourceFilename>/vsimem/good.tif</SourceFilename><SourceBand>1</SourceBand>" \
    "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"60\" ySize=\"50\"/>"                                \
    "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"60\" ySize=\"50\"/></SimpleSource>"

static void test_absurd_geotransforms(void) {
    static const char *const absurd[] = {
        "nan, 0.001, 0, 47, 0, -0.001",  "7, inf, 0, 47, 0, -0.001",  "7, 0, 0, 47, 0, -0.001",
        "7, 0.001, 0, 47, 0, 0",         "7, 1, 1, 47, 1, 1",         "1e300, 0.001, 0, 47, 0, -0.001",
        "7, 0.001, 0, 4700, 0, -0.001",  "7, 0.001, 0, 47, 0, -1000", "7, 100, 0, 47, 0, -0.001",
        "70000, 0.001, 0, 47, 0, -0.001"};
    make_raster(&good);
    const char *path = "/vsimem/absurd.vrt";
    struct raster_options options = {.inputs = &path, .input_count = 1};
    for (size_t i = 0; i < sizeof absurd / sizeof *absurd; i++) {
        put_vrt(path, SMALL, "EPSG:4326", absurd[i], "Float32", GOOD_SOURCE);
        refused(&options, path, "");
    }
    put_vrt(path, SMALL, "EPSG:32632", "1e12, 30, 0, 1e12, 0, -30", "Float32", GOOD_SOURCE);
    refused(&options, path, "nowhere on Earth");
    put_vrt(path, SMALL, "EPSG:4326", "7, 0.001, 0, 47, 0, -0.001", "Float32", GOOD_SOURCE);
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, -1, &r));
    close_raster(&r);
    put_vrt(path, SMALL, "EPSG:4326", "7, 0.001, 0.0002, 47, 0.0002, -0.001", "Float32", GOOD_SOURCE);
    CU_ASSERT_FATAL(open_raster(&options, -1, &r)); /* sheared: fine where it is warped anyway */
    close_raster(&r);
    options.profile = PROFILE_LOCAL;
    refused(&options, path, "gdalwarp");
    put_vrt(path, SMALL, "EPSG:4326", "7, 0.001, 0, 47, 0, -0.001", "CFloat32", GOOD_SOURCE);
    refused(&options, path, "complex");
    put_vrt(path, "rasterXSize=\"0\" rasterYSize=\"0\"", "EPSG:4326", "7, 0.001, 0, 47, 0, -0.001", "Float32", "");
    refused_file(path, "");
    options.profile = PROFILE_GEODETIC;
    put_vrt(path, SMALL, "EPSG:4326", "7, 0.001, 0, 47, 0, -0.001", "Float32",
            "<Offset>nan</Offset><Scale>0</Scale>" GOOD_SOURCE);
    refused(&options, path, "scale");
    put_vrt(path, SMALL, "EPSG:4326", "7, 0.001, 0, 47, 0, -0.001", "Float32",
            "<SimpleSource><SourceFilename>/nowhere/missing.tif</SourceFilename><SourceBand>1</SourceBand>"
            "</SimpleSource>");
    refused(&options, path, "/nowhere/missing.tif");
}

static void test_bands(void) {
    make_raster(&good);
    struct raster_options options = {.inputs = &good.path, .input_count = 1, .band = 2};
    refused(&options, good.path, "band 2");
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), "/vsimem/three.tif", 4, 4, 3, GDT_Int16, NULL);
    for (int i = 1; i <= 3; i++) CU_ASSERT_EQUAL(GDALFillRaster(GDALGetRasterBand(dataset, i), i * 100, 0), CE_None);
    GDALClose(dataset);
    const char *three = "/vsimem/three.tif";
    options.inputs = &three;
    options.profile = PROFILE_LOCAL;
    for (int i = 0; i <= 3; i++) {
        options.band = i;
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, 0, &r));
        CU_ASSERT_EQUAL(post_m(&r, 1, 1), i == 0 ? 100 : i * 100);
        close_raster(&r);
    }
}

static void test_bad_options(void) {
    make_raster(&good);
    struct raster_options options = {.inputs = &good.path, .input_count = 1, .has_extent = true};
    const double extents[][4] = {{7, 47, 8, 46}, {7, NAN, 8, 47}, {7, 46, 7, 47}, {100, 46, 101, 47}};
    for (size_t i = 0; i < sizeof extents / sizeof *extents; i++) {
        memcpy(options.extent, extents[i], sizeof extents[i]);
        refused(&options, "--te", "");
    }
    options.has_extent = false;
    options.fill_distance = 1 << 20;
    refused(&options, "voids", "posts");
    options.fill_distance = 0;
    options.nodata_height_m = NAN;
    refused(&options, "height outside", "");
}

/* Local profile: inputs have to be on one grid. */
static void test_local_grids(void) {
    struct raster_fixture other = good;
    make_raster(&good);
    other.path = "/vsimem/off_grid.tif";
    const char *inputs[2] = {good.path, other.path};
    struct raster_options options = {.inputs = inputs, .input_count = 2, .profile = PROFILE_LOCAL};
    other.west = 7.06 + 0.0004;
    make_raster(&other);
    refused(&options, other.path, good.path);
    other.west = 7.06;
    other.pixel_x = 0.002;
    make_raster(&other);
    refused(&options, other.path, "gdalwarp");
    other.pixel_x = 0.001;
    other.srs = "EPSG:4269";
    make_raster(&other);
    refused(&options, other.path, "grid");
}

/* A header that says more than anyone can read is refused, or cropped, without memory for it. */
static void test_huge_header(void) {
    make_raster(&good);
    const char *path = "/vsimem/huge.vrt";
    put_vrt(path, "rasterXSize=\"1000000000\" rasterYSize=\"1000000000\"", "EPSG:3857",
            "0, 0.01, 0, 10000000, 0, -0.01", "Float32",
            "<ComplexSource><SourceFilename>/vsimem/good.tif</SourceFilename><SourceBand>1</SourceBand>"
            "<DstRect xOff=\"500000000\" yOff=\"500000000\" xSize=\"60\" ySize=\"50\"/></ComplexSource>");
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    refused_file(path, "--te");
    struct raster_options options = {.inputs = &path, .input_count = 1, .has_extent = true};
    const double at = 5000000 / 111319.490793;
    const double extent[4] = {at - 0.00001, 40.9, at + 0.00001, 41.0};
    memcpy(options.extent, extent, sizeof extent);
    options.extent[1] = 40.91;
    options.extent[3] = 40.91002;
    struct opened r;
    bool is_open = open_raster(&options, -1, &r); /* may or may not hold a pixel with data: but it ends */
    if (is_open) close_raster(&r);
    getrusage(RUSAGE_SELF, &after);
    CU_ASSERT_TRUE(after.ru_maxrss - before.ru_maxrss < 200 * 1024);
}

int suite_raster_bad(void) {
    CU_pSuite suite = CU_add_suite("raster bad input", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_no_rasters);
    CU_ADD_TEST(suite, test_truncated);
    CU_ADD_TEST(suite, test_all_nodata);
    CU_ADD_TEST(suite, test_heights_beyond_20_km);
    CU_ADD_TEST(suite, test_georeference);
    CU_ADD_TEST(suite, test_absurd_geotransforms);
    CU_ADD_TEST(suite, test_bands);
    CU_ADD_TEST(suite, test_bad_options);
    CU_ADD_TEST(suite, test_local_grids);
    CU_ADD_TEST(suite, test_huge_header);
    return 0;
}
