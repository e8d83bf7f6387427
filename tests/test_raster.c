/* Tests of raster_io: what is read from a raster, and that windows, threads and types do not change it. */
#include "tests/raster_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <proj.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define NODATA (-9999)

static double plane(double x, double y) {
    return 100 + 10 * x + 20 * y;
}

static double waves(double x, double y) {
    return 1000 + 300 * sin(x * 40) * cos(y * 55);
}

static double waves_utm(double x, double y) {
    return 1000 + 300 * sin(x / 1500) * cos(y / 1100);
}

static double integers(double x, double y) {
    double hash = floor(fmod(fabs(x * 7919 + y * 104729), 200));
    return fmod(hash, 17) == 3 ? 255 : hash;
}

static const struct raster_fixture near_bern = {.path = "/vsimem/plane.tif",
                                                .columns = 300,
                                                .rows = 200,
                                                .west = 7,
                                                .north = 47,
                                                .pixel_x = 0.001,
                                                .pixel_y = 0.001,
                                                .srs = "EPSG:4326",
                                                .height = plane};

/* Bilinear samples of a plane are the plane, up to the outermost pixels' centres. */
static void test_plane(void) {
    make_raster(&near_bern);
    struct opened r;
    CU_ASSERT_FATAL(open_one(near_bern.path, 11, &r));
    CU_ASSERT_STRING_EQUAL(r.summary->crs_wkt, "EPSG:4326");
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[0], 7.0, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[1], 46.8, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[2], 7.3, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[3], 47.0, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->spacing_x, 0.001, 1e-9);
    double largest_m = 0;
    int count = 0;
    for (int64_t y = row_of(&r, 46.801); y <= row_of(&r, 46.999); y++)
        for (int64_t x = column_of(&r, 7.001); x <= column_of(&r, 7.299); x++, count++) {
            double expected_m = plane(lattice_x(&r.lattice, (double)x), lattice_y(&r.lattice, (double)y));
            largest_m = fmax(largest_m, fabs(post_m(&r, x, y) - expected_m));
        }
    CU_ASSERT_TRUE(count > 100000);
    CU_ASSERT_TRUE(largest_m < 1e-3);
    close_raster(&r);
}

/* RMS of posts against the function they were sampled from, moved by a share of a pixel. */
static double rms_m(struct opened *r, const double area[4], double shift_x, double shift_y, height_function height) {
    double sum = 0;
    int count = 0;
    int64_t west = column_of(r, area[0]), east = column_of(r, area[2]);
    int64_t south = row_of(r, area[1]), north = row_of(r, area[3]);
    int32_t columns = (int32_t)(east - west + 1), rows = (int32_t)(north - south + 1);
    float *heights_m = malloc(sizeof *heights_m * (size_t)columns * (size_t)rows);
    CU_ASSERT_PTR_NOT_NULL_FATAL(heights_m);
    CU_ASSERT_EQUAL(raster_read(r->reader, west, south, columns, rows, heights_m, columns, &r->error), SCREE_OK);
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++, count++) {
            double expected = height(lattice_x(&r->lattice, (double)(west + i)) + shift_x,
                                     lattice_y(&r->lattice, (double)(south + j)) + shift_y);
            double error = heights_m[(size_t)j * (size_t)columns + (size_t)i] - expected;
            sum += error * error;
        }
    free(heights_m);
    return sqrt(sum / count);
}

/* The error is least at zero shift: neither PixelIsArea nor PixelIsPoint files are read half a pixel off. */
static void test_registration(void) {
    struct raster_fixture fixture = near_bern;
    fixture.height = waves;
    const double area[4] = {7.01, 46.81, 7.29, 46.99};
    for (int is_point = 0; is_point < 2; is_point++) {
        fixture.path = is_point ? "/vsimem/point.tif" : "/vsimem/area.tif";
        fixture.is_point = is_point;
        make_raster(&fixture);
        struct opened r;
        CU_ASSERT_FATAL(open_one(fixture.path, 11, &r));
        double at_zero_m = rms_m(&r, area, 0, 0, waves);
        CU_ASSERT_TRUE(at_zero_m < 0.2);
        for (int j = -4; j <= 4; j++)
            for (int i = -4; i <= 4; i++)
                if (i != 0 || j != 0)
                    CU_ASSERT_TRUE(rms_m(&r, area, i * 0.000125, j * 0.000125, waves) > 2 * at_zero_m);
        close_raster(&r);
    }
}

/* The same in a projected system: expected heights come from PROJ's own coordinates of a post. */
static void test_registration_projected(void) {
    struct raster_fixture fixture = {.path = "/vsimem/utm.tif",
                                     .columns = 400,
                                     .rows = 400,
                                     .west = 400000,
                                     .north = 5200000,
                                     .pixel_x = 50,
                                     .pixel_y = 50,
                                     .srs = "EPSG:32632",
                                     .height = waves_utm};
    make_raster(&fixture);
    struct opened r;
    CU_ASSERT_FATAL(open_one(fixture.path, -1, &r));
    CU_ASSERT_EQUAL(r.lattice.finest_zoom, lattice_zoom_for_spacing(50 / 111180.0));
    PJ_CONTEXT *context = proj_context_create();
    PJ *utm = proj_create(context, "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
                                   "+step +proj=utm +zone=32 +ellps=WGS84");
    CU_ASSERT_PTR_NOT_NULL_FATAL(utm);
    double best = INFINITY, at_zero = 0;
    int best_i = 9, best_j = 9;
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++) {
            double sum = 0;
            for (int64_t y = row_of(&r, 46.80); y < row_of(&r, 46.90); y += 3)
                for (int64_t x = column_of(&r, 7.75); x < column_of(&r, 7.88); x += 3) {
                    PJ_COORD at = proj_coord(lattice_x(&r.lattice, (double)x), lattice_y(&r.lattice, (double)y), 0, 0);
                    PJ_COORD metres = proj_trans(utm, PJ_FWD, at);
                    double expected = waves_utm(metres.xy.x + i * 12.5, metres.xy.y + j * 12.5);
                    sum += pow(post_m(&r, x, y) - expected, 2);
                }
            if (i == 0 && j == 0) at_zero = sum;
            if (sum < best) {
                best = sum;
                best_i = i;
                best_j = j;
            }
        }
    CU_ASSERT_EQUAL(best_i, 0);
    CU_ASSERT_EQUAL(best_j, 0);
    CU_ASSERT_TRUE(at_zero > 0);
    proj_destroy(utm);
    proj_context_destroy(context);
    close_raster(&r);
}

/* Every type of band gives the same heights, scale and offset included. */
static void test_types(void) {
    static const GDALDataType types[] = {GDT_Byte,    GDT_Int16,   GDT_UInt16, GDT_Int32, GDT_UInt32,
                                         GDT_Float32, GDT_Float64, GDT_Int64,  GDT_UInt64};
    struct raster_fixture fixture = near_bern;
    fixture.path = "/vsimem/type.tif";
    fixture.columns = 40;
    fixture.rows = 30;
    fixture.height = integers;
    fixture.scale = 0.25;
    fixture.offset = -7;
    fixture.has_nodata = true;
    fixture.nodata = 255;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        fixture.type = types[i];
        make_raster(&fixture);
        struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .profile = PROFILE_LOCAL};
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, 0, &r));
        for (int y = 0; y < fixture.rows; y++)
            for (int x = 0; x < fixture.columns; x++) {
                double at_x = 7 + (x + 0.5) * 0.001, at_y = 47 + (fixture.rows - 1 - y + 0.5) * -0.001;
                double value = integers(at_x, at_y);
                float height_m = post_m(&r, x, y);
                bool is_right = value == 255 ? height_m < 43 : height_m == (float)(value * 0.25 - 7);
                CU_ASSERT_TRUE(is_right);
            }
        CU_ASSERT_TRUE(r.summary->height_min_m >= -7);
        CU_ASSERT_TRUE(r.summary->height_max_m <= 200 * 0.25 - 7);
        close_raster(&r);
    }
}

static double scattered(double x, double y) {
    double hash = fabs(sin(x * 12989.8 + y * 78233.1)) * 43758.5453;
    if (hash - floor(hash) < 0.03) return NODATA;
    if (x > 7.1 && x < 7.15 && y > 46.85 && y < 46.9) return NODATA;
    return x + y > 54.25 ? NODATA : waves(x, y);
}

/* A post's bits do not depend on the window, on what was read before, or on the reader. */
static void test_windows_agree(void) {
    struct raster_fixture fixture = near_bern;
    fixture.path = "/vsimem/windows.tif";
    fixture.height = scattered;
    fixture.has_nodata = true;
    fixture.nodata = NODATA;
    make_raster(&fixture);
    struct raster_options options = {
        .inputs = &fixture.path, .input_count = 1, .nodata_height_m = -5, .fill_distance = 30};
    struct opened r, other;
    CU_ASSERT_FATAL(open_raster(&options, 11, &r));
    CU_ASSERT_FATAL(open_raster(&options, 11, &other));
    struct lattice_window window[2];
    CU_ASSERT_EQUAL(raster_windows(r.raster, window), 1);
    int32_t columns = (int32_t)window[0].columns + 21, rows = (int32_t)window[0].rows + 21;
    int64_t west = window[0].x - 10, south = window[0].y - 10;
    float *whole = malloc(sizeof *whole * (size_t)columns * (size_t)rows);
    CU_ASSERT_PTR_NOT_NULL_FATAL(whole);
    CU_ASSERT_EQUAL(raster_read(r.reader, west, south, columns, rows, whole, columns, NULL), SCREE_OK);
    float part[97 * 61];
    int differences = 0, windows = 0;
    for (int32_t y = rows - 61; y >= 0; y -= 37)
        for (int32_t x = columns - 90; x >= 0; x -= 53, windows++) {
            CU_ASSERT_EQUAL(raster_read(other.reader, west + x, south + y, 90, 61, part, 97, NULL), SCREE_OK);
            for (int j = 0; j < 61; j++)
                differences += memcmp(part + j * 97, whole + (size_t)(y + j) * (size_t)columns + x, 90 * 4) != 0;
        }
    CU_ASSERT_TRUE(windows > 50);
    CU_ASSERT_EQUAL(differences, 0);
    int outside = 0, voids = 0;
    for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++) {
        outside += whole[i] == -5;
        voids += isnan(whole[i]) || whole[i] < -5;
    }
    CU_ASSERT_TRUE(outside > 1000);
    CU_ASSERT_EQUAL(voids, 0);
    free(whole);
    close_raster(&other);
    close_raster(&r);
}

struct job {
    struct raster *raster;
    int64_t x, y;
    bool is_backward;
    float *heights_m;
    enum scree_status status;
};

static void *read_in_thread(void *argument) {
    struct job *job = argument;
    struct raster_reader *reader = NULL;
    job->status = raster_reader_new(job->raster, &reader, NULL);
    for (int i = 0; i < 36 && job->status == SCREE_OK; i++) {
        int k = job->is_backward ? 35 - i : i;
        job->status = raster_read(reader, job->x + k % 6 * 64, job->y + k / 6 * 64, 67, 67,
                                  job->heights_m + k * 67 * 67, 67, NULL);
    }
    raster_reader_free(reader);
    return NULL;
}

static void test_threads_agree(void) {
    make_raster(&near_bern);
    struct opened r;
    CU_ASSERT_FATAL(open_one(near_bern.path, 11, &r));
    int64_t x = column_of(&r, 7.0), y = row_of(&r, 46.8);
    struct job jobs[2];
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) {
        jobs[i] = (struct job){r.raster, x, y, i == 1, malloc(sizeof(float) * 36 * 67 * 67), SCREE_OK};
        CU_ASSERT_PTR_NOT_NULL_FATAL(jobs[i].heights_m);
        CU_ASSERT_EQUAL_FATAL(pthread_create(&threads[i], NULL, read_in_thread, &jobs[i]), 0);
    }
    for (int i = 0; i < 2; i++) pthread_join(threads[i], NULL);
    CU_ASSERT_EQUAL(jobs[0].status, SCREE_OK);
    CU_ASSERT_EQUAL(jobs[1].status, SCREE_OK);
    CU_ASSERT_EQUAL(memcmp(jobs[0].heights_m, jobs[1].heights_m, sizeof(float) * 36 * 67 * 67), 0);
    free(jobs[0].heights_m);
    free(jobs[1].heights_m);
    close_raster(&r);
}

/* The raster's pixels are the posts, counted from the south-west, whichever way its rows run. */
static void test_local_pixels(void) {
    for (int is_south_up = 0; is_south_up < 2; is_south_up++) {
        struct raster_fixture fixture = {.path = "/vsimem/local.tif",
                                         .columns = 300,
                                         .rows = 150,
                                         .west = 400000,
                                         .north = is_south_up ? 5000000 : 5004500,
                                         .pixel_x = 20,
                                         .pixel_y = is_south_up ? -30 : 30,
                                         .srs = "EPSG:32632",
                                         .height = waves_utm};
        make_raster(&fixture);
        struct raster_options options = {.inputs = &fixture.path, .input_count = 1, .profile = PROFILE_LOCAL};
        for (int is_cropped = 0; is_cropped < 2; is_cropped++) {
            const double extent[4] = {400100, 5000200, 405000, 5003000};
            options.has_extent = is_cropped;
            memcpy(options.extent, extent, sizeof extent);
            struct opened r;
            CU_ASSERT_FATAL(open_raster(&options, 0, &r));
            CU_ASSERT_EQUAL(r.summary->columns, is_cropped ? 245 : 300);
            CU_ASSERT_EQUAL(r.summary->rows, is_cropped ? 93 : 150);
            CU_ASSERT_EQUAL(r.summary->metres_per_unit, 1);
            int differences = 0;
            for (int64_t y = 0; y < r.lattice.rows; y++)
                for (int64_t x = 0; x < r.lattice.columns; x++) {
                    double expected = waves_utm(lattice_x(&r.lattice, (double)x), lattice_y(&r.lattice, (double)y));
                    differences += post_m(&r, x, y) != (float)expected;
                }
            CU_ASSERT_EQUAL(differences, 0);
            /* Beyond the border it is repeated. */
            float window[5 * 5];
            CU_ASSERT_EQUAL(raster_read(r.reader, -2, r.lattice.rows - 3, 5, 5, window, 5, NULL), SCREE_OK);
            CU_ASSERT_EQUAL(window[0], window[2]);
            CU_ASSERT_EQUAL(window[2], post_m(&r, 0, r.lattice.rows - 3));
            CU_ASSERT_EQUAL(window[4 * 5], post_m(&r, 0, r.lattice.rows - 1));
            CU_ASSERT_EQUAL(window[3 * 5 + 3], post_m(&r, 1, r.lattice.rows - 1));
            CU_ASSERT_EQUAL(raster_read(r.reader, r.lattice.columns + 5, -9, 2, 2, window, 5, NULL), SCREE_OK);
            CU_ASSERT_EQUAL(window[6], post_m(&r, r.lattice.columns - 1, 0));
            close_raster(&r);
        }
    }
}

/* A lattice far coarser than the source averages it, in windows that stay small. */
static void test_coarse_lattice(void) {
    make_raster(&near_bern);
    struct opened r;
    CU_ASSERT_FATAL(open_one(near_bern.path, 5, &r)); /* 22 pixels from post to post */
    int64_t x = column_of(&r, 7.15), y = row_of(&r, 46.9);
    double expected_m = plane(lattice_x(&r.lattice, (double)x), lattice_y(&r.lattice, (double)y));
    CU_ASSERT_DOUBLE_EQUAL(post_m(&r, x, y), expected_m, 0.02);
    close_raster(&r);
}

static void test_resamplings(void) {
    static const char *const names[] = {"near", "bilinear", "cubic", "cubicspline", "lanczos", "average", "rms",
                                        "mode", "max",      "min",   "med",         "q1",      "q3"};
    make_raster(&near_bern);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct raster_options options = {.inputs = &near_bern.path, .input_count = 1, .resampling = names[i]};
        struct opened r;
        CU_ASSERT_FATAL(open_raster(&options, 10, &r));
        int64_t x = column_of(&r, 7.15), y = row_of(&r, 46.9);
        double expected_m = plane(lattice_x(&r.lattice, (double)x), lattice_y(&r.lattice, (double)y));
        CU_ASSERT_DOUBLE_EQUAL(post_m(&r, x, y), expected_m, 0.05);
        close_raster(&r);
    }
    struct raster_options options = {.inputs = &near_bern.path, .input_count = 1, .resampling = "nearby"};
    struct opened r;
    CU_ASSERT_FALSE(open_raster(&options, 10, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "nearby"));
    CU_ASSERT_EQUAL(r.error.status, SCREE_E_ARGUMENT);
}

static void test_crop_geodetic(void) {
    make_raster(&near_bern);
    struct raster_options options = {.inputs = &near_bern.path,
                                     .input_count = 1,
                                     .nodata_height_m = 7,
                                     .has_extent = true,
                                     .extent = {7.1, 46.85, 7.2, 46.95}};
    struct opened r;
    CU_ASSERT_FATAL(open_raster(&options, 11, &r));
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[0], 7.1, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->bounds[3], 46.95, 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->height_min_m, plane(7.1, 46.85), 0.5);
    CU_ASSERT_DOUBLE_EQUAL(r.summary->height_max_m, plane(7.2, 46.95), 0.5);
    int64_t y = row_of(&r, 46.9);
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.099), y), 7);
    CU_ASSERT_EQUAL(post_m(&r, column_of(&r, 7.201), y), 7);
    CU_ASSERT_TRUE(post_m(&r, column_of(&r, 7.101), y) > 1000);
    struct lattice_window window[2];
    CU_ASSERT_EQUAL(raster_windows(r.raster, window), 1);
    CU_ASSERT_TRUE(lattice_x(&r.lattice, (double)window[0].x) >= 7.1);
    CU_ASSERT_TRUE(lattice_x(&r.lattice, (double)(window[0].x + window[0].columns)) <= 7.2);
    close_raster(&r);
    options.extent[0] = 17;
    options.extent[2] = 18;
    CU_ASSERT_FALSE(open_raster(&options, 11, &r));
    CU_ASSERT_PTR_NOT_NULL(strstr(r.error.text, "--te"));
}

int suite_raster(void) {
    CU_pSuite suite = CU_add_suite("raster", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_plane);
    CU_ADD_TEST(suite, test_registration);
    CU_ADD_TEST(suite, test_registration_projected);
    CU_ADD_TEST(suite, test_types);
    CU_ADD_TEST(suite, test_windows_agree);
    CU_ADD_TEST(suite, test_threads_agree);
    CU_ADD_TEST(suite, test_local_pixels);
    CU_ADD_TEST(suite, test_coarse_lattice);
    CU_ADD_TEST(suite, test_resamplings);
    CU_ADD_TEST(suite, test_crop_geodetic);
    return 0;
}
