/* bench_quadtree: what the restricted quadtree of Cifuentes, Venere and Clausse saves, as the observer sees it, and how
 * quickly. Their claim is that rendering costs fall to 5 %: here the share of the full grid's triangles at which no
 * post is drawn farther from its place than a pixel, what 5 and 10 % look like, and the same meshes without an
 * observer.
 *
 * An error in pixels is the vertical distance of a post from the mesh over its distance from the observer, on a screen
 * of 1080 rows that shows 60 degrees; every post counts, in all directions, hidden or not. Observers stand over 9
 * places of each raster. Real ones are found by SCREE_TEST_DATA; those that are absent are left out. */
#include "src/remesh.h"
#include "src/remesh_read_io.h"
#include "tests/fractal.h"

#include <cpl_error.h>
#include <gdal.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { PLACES = 9, STEPS = 8, SPEED_SIDE = 2049, SPEED_RUNS = 15 };

#define PIXELS_A_RADIAN  (1080 / 2 / tan(acos(-1.0) / 6))
#define LOWEST_LOG       (-4.0) /* thresholds from 2 to this power */
#define HIGHEST_LOG      8.0
#define REACH_POSTS      64
#define DATA_PATH_LENGTH 1024

static const struct {
    const char *name, *file;
} rasters[] = {
    {"Big Tujunga Canyon 30 m", "bigtujunga_srtm30m_utm11.tif"},
    {"Monterey Canyon 3\" x 6\"", "monterey_topobathy_nad83.tif"},
    {"Mount St Helens 10 m", "sthelens_2000_10m_utm10.tif"},
    {"Pyrenees to the plain 3\"", "large/catalonia_srtm3_1201x2401.tif"},
};

static const double eyes_m[] = {2, 1000}; /* above the ground */

static double cpu_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

struct bench {
    struct scree_memory memory;
    struct quadtree tree;
    struct quadtree_view view;
    struct quadtree_mesh mesh;
    double full; /* triangles */
};

struct sight {
    double share, max_px, rms_px; /* of the full grid's triangles, and what the observer sees */
};

static void stop(const struct scree_error *error) {
    fprintf(stderr, "bench_quadtree: %s\n", error->text);
    exit(1);
}

static double share_at(struct bench *bench, double threshold) {
    struct scree_error error = {0};
    bench->view.threshold = threshold;
    if (quadtree_extract(&bench->memory, &bench->tree, &bench->view, &bench->mesh, &error) != SCREE_OK) stop(&error);
    return bench->mesh.mesh.triangle_count / bench->full;
}

/* The mesh as it is now, seen by an observer. */
static struct sight look(struct bench *bench, const struct quadtree_view *observer) {
    struct scree_error error = {0};
    struct remesh_error measured;
    if (remesh_measure(&bench->memory, &bench->tree.posts, &bench->mesh.mesh, observer, &measured, &error) != SCREE_OK)
        stop(&error);
    return (struct sight){bench->mesh.mesh.triangle_count / bench->full, measured.max_rad * PIXELS_A_RADIAN,
                          measured.rms_rad * PIXELS_A_RADIAN};
}

/* The largest threshold that keeps to so many pixels, found by halving; its mesh is left in `bench`. */
static struct sight keep_to_px(struct bench *bench, double largest_px) {
    double low = LOWEST_LOG, high = HIGHEST_LOG;
    for (int step = 0; step < STEPS; step++) {
        double middle = (low + high) / 2;
        share_at(bench, exp2(middle));
        *(look(bench, &bench->view).max_px <= largest_px ? &low : &high) = middle;
    }
    share_at(bench, exp2(low));
    return look(bench, &bench->view);
}

/* The same for a share of the full grid, which is not passed, seen by `observer`. */
static struct sight keep_to_share(struct bench *bench, double largest, const struct quadtree_view *observer) {
    double low = LOWEST_LOG, high = HIGHEST_LOG;
    for (int step = 0; step < STEPS + 4; step++) {
        double middle = (low + high) / 2;
        *(share_at(bench, exp2(middle)) > largest ? &low : &high) = middle;
    }
    share_at(bench, exp2(high));
    return look(bench, observer);
}

static void add(struct sight *sum, struct sight part) {
    sum->share += part.share / PLACES;
    sum->max_px += part.max_px / PLACES;
    sum->rms_px += part.rms_px / PLACES;
}

/* Means over the places, from one height. */
static void run_height(struct bench *bench, double eye_m) {
    const struct curvature_posts *posts = &bench->tree.posts;
    struct sight one = {0, 0, 0}, five = {0, 0, 0}, ten = {0, 0, 0}, even = {0, 0, 0};
    for (int place = 0; place < PLACES; place++) {
        int32_t x = posts->columns * (1 + 2 * (place % 3)) / 6, y = posts->rows * (1 + 2 * (place / 3)) / 6;
        bench->view = (struct quadtree_view){.has_observer = true, .x = x, .y = y};
        bench->view.height_m = (double)posts->heights_m[(int64_t)y * posts->stride + x] + eye_m;
        bench->view.reach_m = REACH_POSTS * sqrt(posts->east_m * posts->north_m);
        const struct quadtree_view observer = bench->view;
        add(&one, keep_to_px(bench, 1));
        add(&five, keep_to_share(bench, 0.05, &observer));
        add(&ten, keep_to_share(bench, 0.10, &observer));
        bench->view.has_observer = false;
        add(&even, keep_to_share(bench, 0.05, &observer));
    }
    printf("%8g m  %7.2f %%  %8.2f %6.3f  %8.2f %6.3f  %8.2f %6.3f\n", eye_m, 100 * one.share, ten.max_px, ten.rms_px,
           five.max_px, five.rms_px, even.max_px, even.rms_px);
}

static void make(struct bench *bench, const struct curvature_posts *posts) {
    struct scree_error error = {0};
    if (quadtree_make(&bench->memory, posts, &bench->tree, &error) != SCREE_OK) stop(&error);
    bench->full = 2.0 * (posts->columns - 1) * (posts->rows - 1);
}

static void release(struct bench *bench) {
    quadtree_mesh_release(&bench->memory, &bench->mesh);
    quadtree_release(&bench->memory, &bench->tree);
}

static void run_raster(const char *name, const char *folder, const char *file) {
    char path[DATA_PATH_LENGTH];
    struct bench bench = {.full = 0};
    struct remesh_raster raster;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    const char *const inputs[] = {path};
    const struct raster_options options = {.inputs = inputs, .input_count = 1, .profile = PROFILE_LOCAL};
    if (remesh_read(&bench.memory, &options, &raster, NULL) != SCREE_OK) {
        printf("%s: left out, %s is not there (SCREE_TEST_DATA names the folder)\n", name, path);
        remesh_raster_free(&bench.memory, &raster);
        return;
    }
    make(&bench, &raster.posts);
    printf("\n%s, %d x %d posts, %.3g x %.3g m\n", name, (int)raster.posts.columns, (int)raster.posts.rows,
           raster.posts.east_m, raster.posts.north_m);
    printf("eye above   share for 10 %% with       5 %% with        5 %% without observer\n");
    printf("the ground  max 1 px    max px RMS px    max px RMS px    max px RMS px\n");
    for (size_t i = 0; i < sizeof eyes_m / sizeof *eyes_m; i++) run_height(&bench, eyes_m[i]);
    fflush(stdout);
    release(&bench);
    remesh_raster_free(&bench.memory, &raster);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Milliseconds of an extraction, on a walk over a fractal. */
static void run_speed(void) {
    const struct fractal fractal = {.seed = 3, .whole_metres = true};
    struct bench bench = {.full = 0};
    float *heights_m = malloc(sizeof *heights_m * SPEED_SIDE * SPEED_SIDE);
    if (heights_m == NULL) return;
    fractal_window(&fractal, 0, 0, SPEED_SIDE, SPEED_SIDE, heights_m, SPEED_SIDE);
    const struct curvature_posts posts = {.heights_m = heights_m,
                                          .columns = SPEED_SIDE,
                                          .rows = SPEED_SIDE,
                                          .stride = SPEED_SIDE,
                                          .east_m = 30,
                                          .north_m = 30};
    double start_ms = cpu_ms();
    make(&bench, &posts);
    printf("\nfractal, %d x %d posts of 30 m: the hierarchy in %.0f ms, %.2f bytes a post; then a mesh:\n", SPEED_SIDE,
           SPEED_SIDE, cpu_ms() - start_ms, (double)bench.memory.used_bytes / SPEED_SIDE / SPEED_SIDE);
    printf("threshold  triangles   share      ms, median of %d places\n", SPEED_RUNS);
    for (double threshold = 0.5; threshold < 20; threshold *= 2) {
        double ms[SPEED_RUNS], triangles = 0;
        for (int run = 0; run < SPEED_RUNS; run++) {
            const double at = SPEED_SIDE * (run + 1.0) / (SPEED_RUNS + 1);
            bench.view = (struct quadtree_view){
                .has_observer = true, .x = at, .y = SPEED_SIDE / 2, .height_m = 2000, .reach_m = 30 * REACH_POSTS};
            start_ms = cpu_ms();
            triangles += share_at(&bench, threshold) * bench.full / SPEED_RUNS;
            ms[run] = cpu_ms() - start_ms;
        }
        qsort(ms, SPEED_RUNS, sizeof *ms, compare_doubles);
        printf("%9g  %9.0f  %5.2f %%  %6.2f\n", threshold, triangles, 100 * triangles / bench.full, ms[SPEED_RUNS / 2]);
    }
    release(&bench);
    free(heights_m);
}

int main(void) {
    const char *folder = getenv("SCREE_TEST_DATA");
    if (folder == NULL) folder = TEST_DATA_DEFAULT;
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    printf("Restricted quadtree: shares are of the full grid's triangles, means over %d observers.\n", PLACES);
    for (size_t i = 0; i < sizeof rasters / sizeof *rasters; i++) run_raster(rasters[i].name, folder, rasters[i].file);
    run_speed();
    return 0;
}
