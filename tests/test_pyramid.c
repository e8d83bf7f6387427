/* The main job end to end, on rasters made by code: what is built keeps the promises that verify looks at, at the edges
 * of the data, of the globe and of the raster; on any number of threads; and when it is stopped. */
#include "src/build.h"
#include "src/verify_against_io.h"
#include "src/verify_terrain_io.h"
#include "tests/fractal.h"
#include "tests/raster_maker.h"

#include <CUnit/CUnit.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- the ladder ---- */

static bool is_power_of_two(double value) {
    int exponent;
    return frexp(value, &exponent) == 0.5;
}

static void tolerances_halve_with_each_zoom(void) {
    struct lattice lattice = lattice_geodetic(9);
    struct ladder_options options = {.relief_m = 3000, .largest_height_m = 3000};
    struct ladder ladder;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT_DOUBLE_EQUAL(ladder.tolerance_m[0], CESIUM_LEVEL_ERROR_M * DEFAULT_TOLERANCE_SHARE, 1e-9);
    for (int zoom = 1; zoom <= 9; zoom++) CU_ASSERT_EQUAL(ladder.tolerance_m[zoom], ladder.tolerance_m[zoom - 1] / 2);
    options.root_error_m = 100;
    options.error_at_m[3] = 20;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(ladder.tolerance_m[0], 100);
    CU_ASSERT_EQUAL(ladder.tolerance_m[2], 25);
    CU_ASSERT_EQUAL(ladder.tolerance_m[3], 20);
    CU_ASSERT_EQUAL(ladder.tolerance_m[4], 6.25);
}

static void tolerances_that_grow_are_refused(void) {
    struct lattice lattice = lattice_geodetic(5);
    struct ladder_options options = {.root_error_m = 100, .relief_m = 1000, .largest_height_m = 1000};
    struct scree_error error = {0};
    struct ladder ladder;
    options.error_at_m[3] = 51; /* zoom 2 has 25 */
    CU_ASSERT_EQUAL(ladder_make(&lattice, &options, &ladder, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "zoom 3"));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "--error-at"));
    options.error_at_m[3] = 25; /* equal is fine */
    CU_ASSERT_EQUAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    options.error_at_m[3] = 3; /* zoom 4 has 6.25 */
    CU_ASSERT_EQUAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_E_ARGUMENT);
}

static void height_steps_are_powers_of_two_that_fit(void) {
    static const double reliefs_m[] = {0, 1, 300, 9000, 20000};
    for (int finest = 0; finest <= MAX_ZOOM; finest += 2)
        for (size_t i = 0; i < sizeof reliefs_m / sizeof *reliefs_m; i++) {
            struct lattice lattice = lattice_geodetic(finest);
            struct ladder_options options = {.relief_m = reliefs_m[i], .largest_height_m = reliefs_m[i]};
            struct ladder ladder;
            CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
            CU_ASSERT_TRUE(is_power_of_two(ladder.height_unit_m));
            CU_ASSERT(reliefs_m[i] / ladder.height_unit_m < INT32_MAX / 2);
            for (int zoom = 0; zoom <= finest; zoom++) {
                int32_t step = ladder.border_step[zoom];
                double east_m, north_m, step_m = step * ladder.height_unit_m;
                lattice_steps_m(&lattice, (double)(lattice.rows - 1) / 2, &east_m, &north_m);
                double steep_m = 4 * (double)lattice_tile_span(&lattice, zoom) * east_m;
                CU_ASSERT(step >= 1 && (step & (step - 1)) == 0);
                CU_ASSERT(zoom == finest || step >= ladder.border_step[zoom + 1]);
                CU_ASSERT(fmin(reliefs_m[i], steep_m) / step_m <= 32767);
                /* fine against the tolerance, unless so much relief leaves no choice */
                CU_ASSERT(step_m <= fmax(ladder.tolerance_m[zoom] / 16, 2 * reliefs_m[i] / 32767));
            }
        }
}

/* ---- products on disk ---- */

struct product {
    char folder[256];
};

static struct product new_product(void) {
    struct product product;
    const char *place = getenv("TMPDIR");
    snprintf(product.folder, sizeof product.folder, "%s/scree-pyramid-XXXXXX", place == NULL ? P_tmpdir : place);
    CU_ASSERT_PTR_NOT_NULL_FATAL(mkdtemp(product.folder));
    return product;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static void remove_product(const struct product *product) {
    nftw(product->folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

/* nftw hands no context on: what a walk is about, and what it counts. */
static struct {
    const char *from, *to;
    int files, differing, tiles, broken_tiles, streams, others;
} walk_state;

static bool same_files(const char *path, const char *other_path) {
    FILE *file = fopen(path, "rb"), *other = fopen(other_path, "rb");
    bool same = file != NULL && other != NULL;
    while (same) {
        char bytes[4096], other_bytes[4096];
        size_t count = fread(bytes, 1, sizeof bytes, file), other_count = fread(other_bytes, 1, sizeof bytes, other);
        same = count == other_count && memcmp(bytes, other_bytes, count) == 0;
        if (count < sizeof bytes) break;
    }
    if (file != NULL) fclose(file);
    if (other != NULL) fclose(other);
    return same;
}

static int compare_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    char other_path[1024];
    (void)status, (void)walk;
    if (kind != FTW_F) return 0;
    walk_state.files++;
    if (walk_state.to == NULL) return 0;
    snprintf(other_path, sizeof other_path, "%s%s", walk_state.to, path + strlen(walk_state.from));
    if (!same_files(path, other_path)) walk_state.differing++;
    return 0;
}

static int count_files(const struct product *product) {
    memset(&walk_state, 0, sizeof walk_state);
    nftw(product->folder, compare_entry, 16, FTW_PHYS);
    return walk_state.files;
}

static bool same_products(const struct product *product, const struct product *other) {
    int files = count_files(other);
    memset(&walk_state, 0, sizeof walk_state);
    walk_state.from = product->folder;
    walk_state.to = other->folder;
    nftw(product->folder, compare_entry, 16, FTW_PHYS);
    return walk_state.files == files && files > 0 && walk_state.differing == 0;
}

static int judge_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    struct scree_memory memory = {0};
    struct decoded_tile tile = {0};
    const char *dot = strrchr(path, '.');
    (void)status, (void)walk;
    if (kind != FTW_F) return 0;
    if (dot != NULL && strcmp(dot, ".scree") == 0) { /* tests/test_rungs.c looks into them */
        walk_state.streams++;
        return 0;
    }
    if (dot == NULL || strcmp(dot, ".terrain") != 0) {
        walk_state.others++;
        return 0;
    }
    walk_state.tiles++;
    if (terrain_file_read(&memory, path, &tile, NULL, NULL) != SCREE_OK) walk_state.broken_tiles++;
    decoded_tile_free(&memory, &tile);
    return 0;
}

/* Counts tiles, those that do not decode, and files that are no tiles. */
static void judge_files(const struct product *product) {
    memset(&walk_state, 0, sizeof walk_state);
    nftw(product->folder, judge_entry, 16, FTW_PHYS);
}

/* ---- sources ---- */

#define PIXEL_DEG 0.02

static double mountains_m(double x, double y) {
    const struct fractal fractal = {4, false};
    float height_m;
    fractal_window(&fractal, llround(x / PIXEL_DEG * 2), llround(y / PIXEL_DEG * 2), 1, 1, &height_m, 1);
    return height_m;
}

static double local_mountains_m(double x, double y) {
    const struct fractal fractal = {5, true};
    float height_m;
    fractal_window(&fractal, llround(x / 30), llround(y / 30), 1, 1, &height_m, 1);
    return height_m;
}

static const char *const inputs[] = {"/vsimem/pyramid.tif"};

static struct raster_fixture globe_fixture(int columns, int rows, double west, double north, double pixel_deg) {
    return (struct raster_fixture){.path = inputs[0],
                                   .columns = columns,
                                   .rows = rows,
                                   .west = west,
                                   .north = north,
                                   .pixel_x = pixel_deg,
                                   .pixel_y = pixel_deg,
                                   .srs = "EPSG:4326",
                                   .height = mountains_m};
}

static struct raster_fixture local_fixture(int columns, int rows) {
    return (struct raster_fixture){.path = inputs[0],
                                   .columns = columns,
                                   .rows = rows,
                                   .west = 400000,
                                   .north = 3800000,
                                   .pixel_x = 30,
                                   .pixel_y = 30,
                                   .srs = "EPSG:32611",
                                   .height = local_mountains_m};
}

static enum scree_status build_in(const char *out, enum profile profile, double root_error_m, int threads,
                                  const struct pyramid_options *watch, struct scree_error *error) {
    const struct pyramid_options nobody = {0};
    struct build build = {0};
    const struct build_options options = {
        .raster = {.inputs = inputs, .input_count = 1, .profile = profile},
        .out = out,
        .max_zoom = ZOOM_FROM_SOURCE,
        .ladder = {.root_error_m = root_error_m, .finest_octaves = DEFAULT_FINEST_OCTAVES},
        .threads = threads};
    enum scree_status status = build_prepare(&options, &build, error);
    if (status == SCREE_OK) status = build_run(&options, watch != NULL ? watch : &nobody, &build, error);
    for (int zoom = 0; zoom <= build.max_zoom && status == SCREE_OK; zoom++) {
        CU_ASSERT(build.zooms[zoom].tile_count > 0);
        CU_ASSERT(build.zooms[zoom].triangles > 0);
        CU_ASSERT(zoom < build.max_zoom || build.zooms[zoom].max_error_m <= build.zooms[zoom].tolerance_m);
    }
    build_release(&build);
    return status;
}

/* Asks all that `scree verify --against` asks; prints what is broken. */
static int broken_promises(const char *out) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct against against = {0};
    struct raster_options options = {.inputs = inputs, .input_count = 1};
    struct terrain_set *set = calloc(1, sizeof *set);
    struct verify_report *report = calloc(1, sizeof *report);
    CU_ASSERT_FATAL(set != NULL && report != NULL);
    enum scree_status status = terrain_set_open(&memory, out, set, &error);
    if (status == SCREE_OK) status = verify_terrain(&memory, set, NULL, NULL, report, &error);
    if (status == SCREE_OK) status = verify_against(&memory, set, options, NULL, NULL, &against, &error);
    if (status == SCREE_OK) verify_against_judge(set, &against, report);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    int broken = status == SCREE_OK ? report_broken_promises(report) : -1;
    for (int i = 0; i < PROMISE_COUNT; i++)
        for (int k = 0; k < report->promises[i].note_count; k++)
            printf("\n    %s: %s", promise_name((enum promise)i), report->promises[i].notes[k]);
    CU_ASSERT(report->borders > 0);
    CU_ASSERT_EQUAL(report->border_difference_m, 0);
    CU_ASSERT(report->promises[PROMISE_ERROR].checked > 0);
    against_free(&memory, &against);
    terrain_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(report);
    free(set);
    return broken;
}

/* Builds on one thread and on `fewest` up to 3: the same bytes, and no promise broken. */
static void check_build(const struct raster_fixture *fixture, enum profile profile, double root_error_m, int fewest) {
    struct product first = new_product();
    struct scree_error error = {0};
    make_raster(fixture);
    CU_ASSERT_EQUAL(build_in(first.folder, profile, root_error_m, 1, NULL, &error), SCREE_OK);
    if (error.status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL(broken_promises(first.folder), 0);
    for (int threads = fewest; threads <= 3; threads++) {
        struct product other = new_product();
        CU_ASSERT_EQUAL(build_in(other.folder, profile, root_error_m, threads, NULL, NULL), SCREE_OK);
        CU_ASSERT_TRUE(same_products(&first, &other));
        remove_product(&other);
    }
    remove_product(&first);
}

static void data_in_a_corner_of_a_tile(void) {
    struct raster_fixture fixture = globe_fixture(60, 50, 11.5, 47.5, 0.05);
    check_build(&fixture, PROFILE_GEODETIC, 0, 2);
}

static void data_across_the_antimeridian(void) {
    struct raster_fixture fixture = globe_fixture(50, 40, 177.9, -16, 0.1);
    check_build(&fixture, PROFILE_GEODETIC, 0, 3);
}

static void data_at_the_poles(void) {
    struct raster_fixture north = globe_fixture(80, 20, -10, 90, 0.2);
    struct raster_fixture south = globe_fixture(60, 20, 100, -86, 0.2);
    check_build(&north, PROFILE_GEODETIC, 0, 3);
    check_build(&south, PROFILE_GEODETIC, 0, 3);
}

static void the_whole_globe(void) {
    struct raster_fixture fixture = globe_fixture(180, 90, -180, 90, 2);
    check_build(&fixture, PROFILE_GEODETIC, 0, 3);
}

static void local_tiles_that_are_cut(void) {
    struct raster_fixture wide = local_fixture(300, 271), line = local_fixture(2, 530),
                          square = local_fixture(513, 257);
    check_build(&wide, PROFILE_LOCAL, 40, 2);
    check_build(&line, PROFILE_LOCAL, 0, 3);
    check_build(&square, PROFILE_LOCAL, 15, 3);
}

/* ---- being stopped ---- */

struct stopper {
    volatile sig_atomic_t stop;
    uint32_t after, told;
};

static void stop_after(void *context, uint32_t tiles_done, uint32_t tiles_in_all) {
    struct stopper *stopper = context;
    CU_ASSERT(tiles_done > stopper->told && tiles_done <= tiles_in_all);
    stopper->told = tiles_done;
    if (tiles_done == stopper->after) stopper->stop = 1;
}

/* 3 x 2 tiles. Nothing is left half-written, and a build into the same folder gives what a fresh one gives. */
static void a_stopped_build_leaves_whole_tiles_only(void) {
    struct raster_fixture fixture = local_fixture(600, 400);
    struct product fresh = new_product();
    char manifest[300];
    make_raster(&fixture);
    CU_ASSERT_EQUAL(build_in(fresh.folder, PROFILE_LOCAL, 40, 2, NULL, NULL), SCREE_OK);
    for (int threads = 1; threads <= 2; threads++) {
        struct product product = new_product();
        struct scree_error error = {0};
        struct stopper stopper = {.after = 3};
        const struct pyramid_options watch = {
            .stop = &stopper.stop, .progress = stop_after, .progress_context = &stopper};
        CU_ASSERT_EQUAL(build_in(product.folder, PROFILE_LOCAL, 40, threads, &watch, &error), SCREE_E_INTERRUPTED);
        CU_ASSERT_EQUAL(error.status, SCREE_E_INTERRUPTED);
        CU_ASSERT(stopper.told >= 3 && stopper.told < 6);
        snprintf(manifest, sizeof manifest, "%s/terrain/layer.json", product.folder);
        CU_ASSERT_NOT_EQUAL(access(manifest, F_OK), 0);
        judge_files(&product);
        CU_ASSERT(walk_state.tiles >= 3 && walk_state.tiles < 10);
        CU_ASSERT(walk_state.streams >= 3 && walk_state.streams < 10);
        CU_ASSERT_EQUAL(walk_state.broken_tiles, 0);
        CU_ASSERT_EQUAL(walk_state.others, 0); /* neither temporary files nor a lock */
        snprintf(manifest, sizeof manifest, "%s/stream/scree.json", product.folder);
        CU_ASSERT_NOT_EQUAL(access(manifest, F_OK), 0);
        CU_ASSERT_EQUAL(build_in(product.folder, PROFILE_LOCAL, 40, 2, NULL, NULL), SCREE_OK);
        CU_ASSERT_TRUE(same_products(&fresh, &product));
        remove_product(&product);
    }
    remove_product(&fresh);
}

static void progress_is_told_to_the_end(void) {
    struct raster_fixture fixture = local_fixture(600, 400);
    struct product product = new_product();
    struct stopper stopper = {.after = UINT32_MAX};
    const struct pyramid_options watch = {.progress = stop_after, .progress_context = &stopper};
    make_raster(&fixture);
    CU_ASSERT_EQUAL(build_in(product.folder, PROFILE_LOCAL, 0, 2, &watch, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stopper.told, 6);
    remove_product(&product);
}

/* ---- places that cannot be written to ---- */

static void an_output_that_cannot_be_is_an_error(void) {
    struct raster_fixture fixture = local_fixture(20, 20);
    struct product product = new_product();
    struct scree_error error = {0};
    char path[300], below[320];
    snprintf(path, sizeof path, "%s/file", product.folder);
    snprintf(below, sizeof below, "%s/deeper", path);
    FILE *file = fopen(path, "w");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    fclose(file);
    make_raster(&fixture);
    CU_ASSERT(build_in(path, PROFILE_LOCAL, 0, 2, NULL, &error) < SCREE_OK);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, path));
    memset(&error, 0, sizeof error);
    CU_ASSERT(build_in(below, PROFILE_LOCAL, 0, 1, NULL, &error) < SCREE_OK);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, path));
    CU_ASSERT_EQUAL(count_files(&product), 1);
    remove_product(&product);
}

/* A folder stands where a tile is to go: the first error is told, no manifest is written. */
static void a_tile_that_cannot_be_written_stops_the_build(void) {
    struct raster_fixture fixture = local_fixture(600, 400);
    for (int threads = 1; threads <= 2; threads++) {
        struct product product = new_product();
        struct scree_error error = {0};
        char path[400];
        static const char *const parts[] = {"/terrain", "/terrain/1", "/terrain/1/0", "/terrain/1/0/0.terrain",
                                            "/terrain/1/0/0.terrain/in-the-way"};
        for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
            snprintf(path, sizeof path, "%s%s", product.folder, parts[i]);
            CU_ASSERT_EQUAL(mkdir(path, 0777), 0);
        }
        make_raster(&fixture);
        CU_ASSERT_EQUAL(build_in(product.folder, PROFILE_LOCAL, 40, threads, NULL, &error), SCREE_E_IO);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "1/0/0.terrain"));
        judge_files(&product);
        CU_ASSERT_EQUAL(walk_state.broken_tiles, 0);
        CU_ASSERT_EQUAL(walk_state.others, 0);
        remove_product(&product);
    }
}

int suite_pyramid(void) {
    CU_pSuite suite = CU_add_suite("pyramid", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, tolerances_halve_with_each_zoom);
    CU_ADD_TEST(suite, tolerances_that_grow_are_refused);
    CU_ADD_TEST(suite, height_steps_are_powers_of_two_that_fit);
    CU_ADD_TEST(suite, data_in_a_corner_of_a_tile);
    CU_ADD_TEST(suite, data_across_the_antimeridian);
    CU_ADD_TEST(suite, data_at_the_poles);
    CU_ADD_TEST(suite, the_whole_globe);
    CU_ADD_TEST(suite, local_tiles_that_are_cut);
    CU_ADD_TEST(suite, a_stopped_build_leaves_whole_tiles_only);
    CU_ADD_TEST(suite, progress_is_told_to_the_end);
    CU_ADD_TEST(suite, an_output_that_cannot_be_is_an_error);
    CU_ADD_TEST(suite, a_tile_that_cannot_be_written_stops_the_build);
    return 0;
}
