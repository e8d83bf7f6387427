/* Tests of what becomes a TIN on a lattice: where clouds and meshes lie, how they are cut, and what is refused. */
#include "lod/counter_random.h"
#include "src/tin_place.h"
#include "src/tin_source_io.h"
#include "src/tin_step.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_vsi.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <proj.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double chance(uint64_t i) {
    return (double)(counter_random(11, i) >> 11) * 0x1p-53;
}

/* ---- fixtures ---- */

#define MOST_POINTS 20000

/* Points as they stand in the file, too. */
static struct scattered {
    struct cloud_point points[MOST_POINTS];
    uint32_t count;
} scattered;

static void begin_points(void) {
    scattered.count = 0;
}

static void add_point(double x, double y, double z) {
    CU_ASSERT_FATAL(scattered.count < MOST_POINTS);
    scattered.points[scattered.count++] = (struct cloud_point){x, y, z};
}

/* columns x rows points from (west, south), `distance` apart, on a slope of a tenth; heights in whole tenths. */
static void add_grid(int columns, int rows, double west, double south, double distance) {
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++)
            add_point(west + column * distance, south + row * distance, 100 + 0.1 * column);
}

static void put_text(const char *path, const char *text) {
    VSILFILE *file = VSIFOpenL(path, "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    CU_ASSERT_EQUAL(VSIFWriteL(text, 1, strlen(text), file), strlen(text));
    CU_ASSERT_EQUAL(VSIFCloseL(file), 0);
}

static void put_points(const char *path) {
    VSILFILE *file = VSIFOpenL(path, "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    for (uint32_t i = 0; i < scattered.count; i++) {
        const struct cloud_point *point = &scattered.points[i];
        VSIFPrintfL(file, "%.17g %.17g %.17g\n", point->x, point->y, point->z);
    }
    CU_ASSERT_EQUAL(VSIFCloseL(file), 0);
}

static const char *const cloud_path = "/vsimem/tin.xyz";

static struct raster_options local_options(void) {
    return (struct raster_options){
        .inputs = &cloud_path, .input_count = 1, .profile = PROFILE_LOCAL, .cloud.named = "--memory"};
}

/* Writes what was scattered, and opens it. */
static bool open_points(const struct raster_options *options, uint32_t block, struct tin_source *source) {
    struct scree_error error = {0};
    put_points(cloud_path);
    enum scree_status status = tin_source_open(options, block, false, source, &error);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    return status == SCREE_OK;
}

/* ---- what holds for all of them ---- */

static double point_x(const struct tin_source *source, uint32_t point) {
    return lattice_x(&source->lattice, (double)(source->x + source->placed.points[point].x));
}

static double point_y(const struct tin_source *source, uint32_t point) {
    return lattice_y(&source->lattice, (double)(source->y + source->placed.points[point].y));
}

static uint32_t fullest_tile(const struct tin_source *source, int32_t span, uint32_t *filled) {
    const struct tin_lattice *placed = &source->placed;
    size_t columns = (size_t)(placed->tiles_x * (int64_t)placed->tile_span / span) + 1;
    size_t rows = (size_t)(placed->tiles_y * (int64_t)placed->tile_span / span) + 1;
    uint32_t fullest = 0, *counts = calloc(columns * rows, sizeof *counts);
    CU_ASSERT_PTR_NOT_NULL_FATAL(counts);
    *filled = 0;
    for (uint32_t i = 0; i < placed->point_count; i++) {
        size_t x = (size_t)(placed->points[i].x / span), y = (size_t)(placed->points[i].y / span);
        uint32_t count = ++counts[y * columns + x];
        if (count > fullest) fullest = count;
        *filled += count == 1;
    }
    free(counts);
    return fullest;
}

/* The frame is whole tiles around the window, and the window holds the points with their margins. */
static void check_frame(const struct tin_source *source, const bool has_margin[4]) {
    const struct tin_lattice *placed = &source->placed;
    const struct lattice_window *window = &source->window;
    int64_t span = lattice_tile_span(&source->lattice, source->leaf_zoom), wall = placed->wall_steps;
    int64_t first_x = INT64_MAX, first_y = INT64_MAX, last_x = 0, last_y = 0;
    CU_ASSERT_EQUAL(placed->tile_span, span);
    CU_ASSERT_EQUAL(wall, span / source->cells / 4 > 1 ? span / source->cells / 4 : 1);
    CU_ASSERT_TRUE(source->x % span == 0 && source->y % span == 0);
    CU_ASSERT_TRUE(source->x <= window->x && source->y <= window->y);
    CU_ASSERT_TRUE(source->x + placed->tiles_x * span >= window->x + window->columns);
    CU_ASSERT_TRUE(source->y + placed->tiles_y * span >= window->y + window->rows);
    CU_ASSERT_TRUE(window->x >= 0 && window->x + window->columns < source->lattice.columns);
    CU_ASSERT_TRUE(window->y >= 0 && window->y + window->rows < source->lattice.rows);
    for (uint32_t i = 0; i < placed->point_count; i++) {
        int64_t x = source->x + placed->points[i].x, y = source->y + placed->points[i].y;
        first_x = x < first_x ? x : first_x, last_x = x > last_x ? x : last_x;
        first_y = y < first_y ? y : first_y, last_y = y > last_y ? y : last_y;
    }
    const int64_t margins[4] = {first_x - window->x, first_y - window->y, window->x + window->columns - last_x,
                                window->y + window->rows - last_y};
    for (int side = 0; side < 4; side++)
        CU_ASSERT_TRUE(has_margin[side] ? margins[side] >= 2 * wall && margins[side] <= 8 * wall : margins[side] == 0);
}

static const bool everywhere[4] = {true, true, true, true}, nowhere[4] = {false, false, false, false};

static double filled_root(const struct lattice *lattice) {
    int64_t longer = lattice->columns > lattice->rows ? lattice->columns : lattice->rows;
    return (double)(longer - 1) / (double)lattice_tile_span(lattice, 0);
}

/* ---- steps ---- */

static void test_steps(void) {
    static const struct {
        double numbers[3];
        double step;
    } cases[] = {
        {{0, 30, 7000}, 10},
        {{0, 1000, 7000}, 1000},
        {{0, 1, 7000}, 1},
        {{4412345.67, 2.5, -7.25}, 0.01},
        {{4412345.678901, 2, 3}, 1e-6},
        {{0.1F, 0.7F, 123.3F}, 0.1}, /* floats */
        {{1.0 / 3, 2, 3}, 0},
        {{5000000.5, 1, 2}, 0.1},     /* a float, but a tenth is no finer than what it says */
        {{50.1F, 49.9F, 1.0 / 7}, 0}, /* one that is none */
        {{1e-7, 0, 0}, 1000},         /* nothing but noise */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double found = tin_step_find(-6, 3, cases[i].numbers, 3, 1);
        CU_ASSERT_DOUBLE_EQUAL(found, cases[i].step, cases[i].step * 1e-12);
        CU_ASSERT_TRUE(found == 0 || tin_step_divides(found, cases[i].numbers, 3, 1));
        CU_ASSERT_FALSE(found > 0 && found < 1000 && tin_step_divides(10 * found, cases[i].numbers, 3, 1));
    }
    const double apart[] = {10, 0.5, 20, 0.25, 30, 0.125};
    CU_ASSERT_EQUAL(tin_step_find(-6, 3, apart, 3, 2), 10);
    CU_ASSERT_DOUBLE_EQUAL(tin_step_find(-6, 3, apart + 1, 3, 2), 1e-3, 1e-15);
}

/* A rectangle of points with decimals: all stay where they are, nothing is around them, and the root is filled. */
static void test_kept_places(void) {
    static const double sizes[] = {40, 51.2, 53.1, 64.1, 70, 77, 90, 102.3};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct tin_source source;
        struct raster_options options = local_options();
        begin_points();
        add_grid(11, 6, 412345.5, 5312345.3, sizes[i] / 10);
        if (!open_points(&options, 0, &source)) return;
        double parts = 0.1 / source.lattice.spacing_x; /* or 0.01, where sizes have two decimals */
        if (fabs(sizes[i] / 10 * 10 - nearbyint(sizes[i] / 10 * 10)) > 1e-9) parts /= 10;
        CU_ASSERT_TRUE(parts > 0.999 && parts < 8.001);
        CU_ASSERT_DOUBLE_EQUAL(parts, nearbyint(parts), 1e-9);
        CU_ASSERT_EQUAL(source.lattice.spacing_x, source.lattice.spacing_y);
        CU_ASSERT_TRUE(filled_root(&source.lattice) >= 0.8 && filled_root(&source.lattice) <= 1);
        CU_ASSERT_EQUAL(source.placed.point_count, 66);
        CU_ASSERT_EQUAL(source.placed.triangle_count, 100);
        check_frame(&source, nowhere);
        double largest = 0;
        for (uint32_t p = 0; p < source.placed.point_count; p++) {
            double column = (point_x(&source, p) - 412345.5) / sizes[i] * 10;
            double row = (point_y(&source, p) - 5312345.3) / sizes[i] * 10;
            largest = fmax(largest, fmax(fabs(column - nearbyint(column)), fabs(row - nearbyint(row))));
            CU_ASSERT_DOUBLE_EQUAL(source.placed.points[p].height_m, 100 + 0.1 * nearbyint(column), 1e-5);
            CU_ASSERT_DOUBLE_EQUAL(source.placed.points[p].slope.east, 1 / sizes[i], 1e-4);
        }
        CU_ASSERT_TRUE(largest < 1e-6);
        CU_ASSERT_DOUBLE_EQUAL(source.quantum_m, 0.1, 1e-15);
        CU_ASSERT_EQUAL(source.outside_m, 100);
        CU_ASSERT_EQUAL(source.leaf_zoom, 0);
        CU_ASSERT_EQUAL(source.summary.bounds[0], 412345.5);
        CU_ASSERT_DOUBLE_EQUAL(source.summary.bounds[2], 412345.5 + sizes[i], 1e-6);
        CU_ASSERT_DOUBLE_EQUAL(source.summary.spacing_x, sizes[i] * sqrt(0.5 / 66), 1e-6);
        tin_source_release(&source);
    }
}

/* What has no decimals is rounded to less than a hundredth of its distance. */
static void test_rounded_places(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    begin_points();
    for (uint64_t i = 0; i < 3000; i++) add_point(1e5 + 700 * chance(2 * i), 500 * chance(2 * i + 1), chance(i));
    if (!open_points(&options, 0, &source)) return;
    double step = source.lattice.spacing_x;
    CU_ASSERT_TRUE(step < source.summary.spacing_x / 100 && step > source.summary.spacing_x / 400);
    CU_ASSERT_TRUE(filled_root(&source.lattice) > 0.9 && filled_root(&source.lattice) <= 1);
    CU_ASSERT_DOUBLE_EQUAL(source.lattice.west / step, nearbyint(source.lattice.west / step), 1e-6);
    CU_ASSERT_EQUAL(source.quantum_m, 0);
    check_frame(&source, everywhere);
    uint32_t found = 0;
    for (uint32_t p = 0; p < 100; p++) /* in no order any more */
        for (uint32_t i = 0; i < scattered.count; i++)
            found += fabs(scattered.points[i].x - point_x(&source, p)) < 0.5001 * step &&
                     fabs(scattered.points[i].y - point_y(&source, p)) < 0.5001 * step &&
                     fabs(scattered.points[i].z - (double)source.placed.points[p].height_m) < 1e-6;
    CU_ASSERT_EQUAL(found, 100);
    tin_source_release(&source);
}

/* Half of a square: two sides are the lattice's own, beyond the third there is a wall. */
static void test_margins(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    begin_points();
    for (int row = 0; row <= 20; row++)
        for (int column = 0; column <= 20 - row; column++) add_point(column, row, row == 3 ? 7 : 5);
    if (!open_points(&options, 0, &source)) return;
    const bool right_angle[4] = {false, false, true, true};
    check_frame(&source, right_angle);
    CU_ASSERT_EQUAL(source.quantum_m, 1);
    CU_ASSERT_EQUAL(source.outside_m, 5);
    tin_source_release(&source);
    options.nodata_height_m = -3;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(tin_source_open(&options, 0, true, &source, &error), SCREE_OK);
    CU_ASSERT_EQUAL(source.outside_m, -3);
    tin_source_release(&source);
}

/* ---- sub-blocks ---- */

static void test_blocks(void) {
    static const uint32_t blocks[] = {8192, 2500, 700, 100};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        struct tin_source source;
        struct raster_options options = local_options();
        uint32_t filled;
        begin_points();
        for (uint64_t k = 0; k < 10000; k++)
            add_point(nearbyint(1e6 * chance(3 * k)) / 100, nearbyint(1e6 * chance(3 * k + 1)) / 100,
                      chance(3 * k + 2));
        if (!open_points(&options, blocks[i], &source)) return;
        int32_t span = source.placed.tile_span;
        CU_ASSERT_TRUE(fullest_tile(&source, span, &filled) <= blocks[i]);
        double mean = (double)source.placed.point_count / filled;
        CU_ASSERT_TRUE(source.cells >= 16 && source.cells <= 256 && (source.cells & (source.cells - 1)) == 0);
        CU_ASSERT_TRUE(source.cells == 16 || (source.cells <= 1.5 * sqrt(mean) && source.cells >= 0.7 * sqrt(mean)));
        CU_ASSERT_TRUE(source.leaf_zoom > 0);
        CU_ASSERT_TRUE(fullest_tile(&source, 2 * span, &filled) > blocks[i]);
        tin_source_release(&source);
    }
}

/* Two thousand points in a corner of a thousandth of the land make no million tiles, but the deepest zoom allowed. */
static void test_cluster(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    begin_points();
    for (uint64_t i = 0; i < 2000; i++)
        add_point(nearbyint(1000 * chance(2 * i)) / 1000, nearbyint(1000 * chance(2 * i + 1)) / 1000, 3);
    add_grid(11, 11, 0, 0, 1000);
    options.cloud.longest_edge = 2000;
    if (!open_points(&options, 100, &source)) return;
    uint32_t filled, most = 64 + 64 * source.placed.point_count / 100;
    uint64_t tiles = (uint64_t)source.placed.tiles_x * (uint64_t)source.placed.tiles_y;
    CU_ASSERT_TRUE(fullest_tile(&source, source.placed.tile_span, &filled) > 100);
    CU_ASSERT_TRUE(tiles <= most && 4 * tiles > most);
    tin_source_release(&source);
}

/* ---- the globe ---- */

/* Places as GDAL transforms them, heights in feet as those of the other coordinates. */
static void test_geodetic(void) {
    static const struct {
        const char *srs;
        double west, south, size, metres;
    } cases[] = {
        {"EPSG:32611", 400000, 3800000, 20, 1},
        {"EPSG:2992", 636000, 848900, 60, 0.3048},
        {"EPSG:4326", -110.5, 40.25, 1e-4, 1},
        {"EPSG:4326", 249.5, 40.25, 1e-4, 1}, /* the same, a turn on */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tin_source source;
        struct raster_options options = local_options();
        options.profile = PROFILE_GEODETIC;
        options.source_srs = cases[i].srs;
        begin_points();
        add_grid(21, 16, cases[i].west, cases[i].south, cases[i].size);
        if (!open_points(&options, 100, &source)) return;
        check_frame(&source, everywhere);
        CU_ASSERT_EQUAL(source.lattice.finest_zoom, MAX_ZOOM);
        CU_ASSERT_STRING_EQUAL(source.summary.crs_wkt, "EPSG:4326");
        CU_ASSERT_PTR_NOT_NULL(strstr(source.summary.datum, "no vertical datum"));
        CU_ASSERT_EQUAL(source.outside_m, 0);
        CU_ASSERT_DOUBLE_EQUAL(source.quantum_m, 0.1 * cases[i].metres, 1e-12);
        OGRSpatialReferenceH from = OSRNewSpatialReference(NULL), to = OSRNewSpatialReference(NULL);
        OSRSetFromUserInput(from, cases[i].srs);
        OSRImportFromEPSG(to, 4326);
        OSRSetAxisMappingStrategy(from, OAMS_TRADITIONAL_GIS_ORDER);
        OSRSetAxisMappingStrategy(to, OAMS_TRADITIONAL_GIS_ORDER);
        OGRCoordinateTransformationH transform = OCTNewCoordinateTransformation(from, to);
        uint32_t found = 0, filled;
        for (int row = 0; row < 16; row++)
            for (int column = 0; column < 21; column++) {
                double x = cases[i].west + column * cases[i].size, y = cases[i].south + row * cases[i].size;
                CU_ASSERT_TRUE(OCTTransform(transform, 1, &x, &y, NULL));
                x -= 360 * floor((x + 180) / 360);
                for (uint32_t p = 0; p < source.placed.point_count; p++)
                    found +=
                        fabs(point_x(&source, p) - x) < source.lattice.spacing_x * 0.51 &&
                        fabs(point_y(&source, p) - y) < source.lattice.spacing_y * 0.51 &&
                        fabs((double)source.placed.points[p].height_m - (100 + 0.1 * column) * cases[i].metres) < 1e-4;
            }
        CU_ASSERT_EQUAL(found, source.placed.point_count);
        CU_ASSERT_EQUAL(source.placed.point_count, 336);
        double width = source.summary.bounds[2] - source.summary.bounds[0];
        CU_ASSERT_TRUE(source.placed.tile_span * source.lattice.spacing_x <= width);
        CU_ASSERT_TRUE(fullest_tile(&source, source.placed.tile_span, &filled) <= 100);
        OCTDestroyCoordinateTransformation(transform);
        OSRDestroySpatialReference(to);
        OSRDestroySpatialReference(from);
        tin_source_release(&source);
    }
}

/* Heights above EGM96 become ellipsoidal as PROJ says, and are multiples of nothing then. */
static void test_egm96(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    struct scree_error error = {0};
    options.profile = PROFILE_GEODETIC;
    options.source_srs = "EPSG:4326+5773";
    begin_points();
    add_grid(11, 11, 7, 46, 0.01);
    put_points(cloud_path);
    enum scree_status status = tin_source_open(&options, 0, false, &source, &error);
    if (status == SCREE_E_IO && strstr(error.text, "grid") != NULL) {
        printf("skipped: PROJ has no EGM96 grid (Debian: proj-data) ... ");
        tin_source_release(&source);
        return;
    }
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    PJ_CONTEXT *context = proj_context_create();
    PJ *expected = proj_create_crs_to_crs(context, "EPSG:4326+5773", "EPSG:4979", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(expected);
    double largest_m = 0;
    for (uint32_t p = 0; p < source.placed.point_count; p++) {
        double column = nearbyint((point_x(&source, p) - 7) / 0.01), row = nearbyint((point_y(&source, p) - 46) / 0.01);
        PJ_COORD at = proj_coord(46 + 0.01 * row, 7 + 0.01 * column, 100 + 0.1 * column, HUGE_VAL);
        double height_m = proj_trans(expected, PJ_FWD, at).xyz.z;
        largest_m = fmax(largest_m, fabs(height_m - (double)source.placed.points[p].height_m));
        CU_ASSERT_TRUE(height_m > 140);
    }
    CU_ASSERT_TRUE(largest_m < 1e-3);
    CU_ASSERT_EQUAL(source.quantum_m, 0);
    CU_ASSERT_TRUE(source.summary.height_min_m > 140 && source.summary.height_max_m < 160);
    CU_ASSERT_PTR_NOT_NULL(strstr(source.summary.datum, "EGM96 height"));
    proj_destroy(expected);
    proj_context_destroy(context);
    tin_source_release(&source);
}

/* A continent's frame has coarser steps, so that positions keep 30 bits. */
static void test_continent(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    options.profile = PROFILE_GEODETIC;
    options.source_srs = "EPSG:4326";
    begin_points();
    add_grid(35, 17, -170, -80, 10);
    if (!open_points(&options, 0, &source)) return;
    check_frame(&source, everywhere);
    CU_ASSERT_TRUE(source.lattice.finest_zoom < MAX_ZOOM && source.lattice.finest_zoom >= MAX_ZOOM - 2);
    CU_ASSERT_TRUE((int64_t)source.placed.tiles_x * source.placed.tile_span <= TIN_LATTICE_MOST_STEPS);
    tin_source_release(&source);
}

/* ---- order, memory, and what is refused ---- */

static int compare_places(const void *first, const void *second) {
    const struct tin_post *a = first, *b = second;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return (a->x > b->x) - (a->x < b->x);
}

static void test_order(void) {
    struct tin_source sources[2];
    struct raster_options options = local_options();
    begin_points();
    for (uint64_t i = 0; i < 2000; i++) add_point(700 * chance(2 * i), 500 * chance(2 * i + 1), chance(i));
    for (int turn = 0; turn < 2; turn++) {
        if (!open_points(&options, 300, &sources[turn])) return;
        struct tin_lattice *placed = &sources[turn].placed;
        qsort(placed->points, placed->point_count, sizeof *placed->points, compare_places);
        for (uint32_t i = 0; i < scattered.count / 2; i++) {
            struct cloud_point kept = scattered.points[i];
            scattered.points[i] = scattered.points[scattered.count - 1 - i];
            scattered.points[scattered.count - 1 - i] = kept;
        }
    }
    CU_ASSERT_EQUAL(memcmp(&sources[0].lattice, &sources[1].lattice, sizeof sources[0].lattice), 0);
    CU_ASSERT_EQUAL(sources[0].leaf_zoom, sources[1].leaf_zoom);
    CU_ASSERT_EQUAL(sources[0].cells, sources[1].cells);
    CU_ASSERT_EQUAL_FATAL(sources[0].placed.point_count, sources[1].placed.point_count);
    CU_ASSERT_EQUAL(memcmp(sources[0].placed.points, sources[1].placed.points,
                           sources[0].placed.point_count * sizeof *sources[0].placed.points),
                    0);
    tin_source_release(&sources[0]);
    tin_source_release(&sources[1]);
}

static void test_memory(void) {
    struct tin_source source;
    struct raster_options options = local_options();
    struct scree_error error = {0};
    begin_points();
    add_grid(141, 141, 0, 0, 1);
    if (!open_points(&options, 0, &source)) return;
    CU_ASSERT_TRUE(source.memory.peak_bytes < 140 * (size_t)scattered.count + 65536);
    CU_ASSERT_TRUE(source.memory.used_bytes < 60 * (size_t)scattered.count);
    tin_source_release(&source);
    options.cloud.memory_mb = 1;
    CU_ASSERT_EQUAL(tin_source_open(&options, 0, false, &source, &error), SCREE_E_LIMIT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, cloud_path));
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "--memory than 1 MB"));
    tin_source_release(&source);
    struct cloud_point corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    uint32_t triangle[3] = {0, 1, 2};
    struct scree_memory memory = {.fail_request = 1};
    struct tin tin = {&memory, corners, triangle, 3, 1};
    struct tin_place_options wanted = {.profile = PROFILE_LOCAL, .metres_per_unit = 1, .block_points = 1};
    struct tin_place place;
    error = (struct scree_error){0};
    CU_ASSERT_EQUAL(tin_place_choose(&tin, &wanted, &place, &error), SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void check_refused(const struct raster_options *options, enum scree_status wanted, const char *words) {
    struct tin_source source;
    struct scree_error error = {0};
    enum scree_status status = tin_source_open(options, 0, false, &source, &error);
    CU_ASSERT_EQUAL(status, wanted);
    bool is_said = strstr(error.text, words) != NULL;
    CU_ASSERT_TRUE(is_said);
    if (!is_said || status != wanted) printf("\n    %d: %s\n", (int)status, error.text);
    tin_source_release(&source);
}

static void test_refused(void) {
    struct raster_options options = local_options(), other;
    const char *both[2] = {cloud_path, "/vsimem/tin.ply"};
    begin_points();
    add_grid(5, 5, 0, 0, 1);
    put_points(cloud_path);
    put_text(both[1], "ply\n");
    other = options, other.has_extent = true;
    check_refused(&other, SCREE_E_ARGUMENT, "no --te");
    other = options, other.resampling = "cubic";
    check_refused(&other, SCREE_E_ARGUMENT, "no -r");
    other = options, other.has_nodata = true;
    check_refused(&other, SCREE_E_ARGUMENT, "no -a_nodata");
    other = options, other.nodata_height_m = NAN;
    check_refused(&other, SCREE_E_ARGUMENT, "not a number");
    other = options, other.profile = PROFILE_GEODETIC;
    check_refused(&other, SCREE_E_ARGUMENT, "--s_srs, or use --profile local");
    other.source_srs = "EPSG:99999999";
    check_refused(&other, SCREE_E_ARGUMENT, "EPSG:99999999");
    other.source_srs = "EPSG:4978";
    check_refused(&other, SCREE_E_UNSUPPORTED, "geocentric");
    other = options, other.cloud.has_classes = true;
    check_refused(&other, SCREE_E_ARGUMENT, "only LAS files");
    other = options, other.inputs = both, other.input_count = 2;
    check_refused(&other, SCREE_E_ARGUMENT, "--grid");
    both[1] = "/vsimem/nothing.tif";
    check_refused(&other, SCREE_E_ARGUMENT, "nothing.tif");
    other.inputs = &both[1], other.input_count = 1;
    check_refused(&other, SCREE_E_ARGUMENT, "neither a mesh nor a point cloud");
}

static void test_bad_places(void) {
    struct raster_options options = local_options();
    begin_points();
    add_grid(5, 1, 0, 0, 1);
    put_points(cloud_path);
    check_refused(&options, SCREE_E_CORRUPT, cloud_path); /* a line */
    add_grid(5, 5, 0, 1, 1);
    add_point(2.5, 2.5, 21000);
    put_points(cloud_path);
    check_refused(&options, SCREE_E_CORRUPT, "--any-height");
    scattered.points[scattered.count - 1].z = 0;
    scattered.points[0] = (struct cloud_point){800, 600, 0};
    options.profile = PROFILE_GEODETIC;
    options.source_srs = "EPSG:4326";
    put_points(cloud_path);
    options.cloud.longest_edge = 2000;
    check_refused(&options, SCREE_E_CORRUPT, "nowhere on Earth");
    options.cloud.longest_edge = 0;
    begin_points();
    add_grid(5, 5, 178, 0, 1);
    put_points(cloud_path);
    check_refused(&options, SCREE_E_UNSUPPORTED, "antimeridian");
    options.source_srs = "EPSG:32601";
    begin_points();
    add_grid(5, 5, 150000, 1000000, 20000); /* from west of 180 degrees to east of it */
    put_points(cloud_path);
    check_refused(&options, SCREE_E_UNSUPPORTED, "antimeridian");
    options.source_srs = "EPSG:5041"; /* around the north pole */
    begin_points();
    add_grid(5, 5, 1900000, 1900000, 50000);
    put_points(cloud_path);
    check_refused(&options, SCREE_E_UNSUPPORTED, "a pole");
}

static void check_wanted(const struct raster_options *options, bool expected) {
    struct scree_error error = {0};
    bool is_wanted = !expected;
    CU_ASSERT_EQUAL(tin_source_is_wanted(options, &is_wanted, &error), SCREE_OK);
    CU_ASSERT_EQUAL(is_wanted, expected);
}

static void test_wanted(void) {
    struct raster_options options = local_options();
    begin_points();
    add_grid(5, 5, 0, 0, 1);
    put_points(cloud_path);
    check_wanted(&options, true);
    options.cloud.named = NULL; /* rows of points are a raster to GDAL, without an option for clouds */
    check_wanted(&options, false);
    options.cloud.named = "--grid";
    options.cloud.grid = 1;
    check_wanted(&options, false);
    options = local_options();
    options.filter.is_wanted = true;
    check_wanted(&options, false);
    options = local_options();
    const char *mesh = "a.PLY";
    options.inputs = &mesh; /* by its name alone */
    check_wanted(&options, true);
    mesh = "/vsimem/nothing.tif";
    check_wanted(&options, false);
}

/* ---- meshes ---- */

/* Two files of a square each, one turned over, share a side and become one surface of 4 triangles. */
static void test_meshes(void) {
    const char *files[2] = {"/vsimem/west.obj", "/vsimem/east.off"};
    struct raster_options options = {.inputs = files, .input_count = 2, .profile = PROFILE_LOCAL};
    struct tin_source source;
    struct scree_error error = {0};
    put_text(files[0], "v 0 0 1\nv 10 0 2\nv 10 10 2\nv 0 10 1\nf 1 2 3 4\n");
    put_text(files[1], "OFF\n4 2 0\n10 0 2\n20 0 4\n20 10 4\n10 10 2\n3 0 2 1\n3 0 3 2\n");
    enum scree_status status = tin_source_open(&options, 0, false, &source, &error);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    if (status != SCREE_OK) {
        printf("\n    %s\n", error.text);
        return;
    }
    CU_ASSERT_EQUAL(source.placed.point_count, 6);
    CU_ASSERT_EQUAL(source.placed.triangle_count, 4);
    CU_ASSERT_EQUAL(source.mended.welded, 2);
    CU_ASSERT_EQUAL(source.mended.turned, 2);
    check_frame(&source, nowhere);
    tin_source_release(&source);
    options.cloud.thin = 1;
    check_refused(&options, SCREE_E_ARGUMENT, "--thin");
    options.cloud.thin = 0;
    options.cloud.outliers = 1;
    check_refused(&options, SCREE_E_ARGUMENT, "--outliers");
    options.cloud.outliers = 0;
    files[1] = "/vsimem/gone.stl";
    check_refused(&options, SCREE_E_IO, files[1]);
    put_text(files[0], "v 0 0 1\nv 10 0 2\nv 0 0 5\nf 1 2 3\n");
    options.input_count = 1;
    check_refused(&options, SCREE_E_CORRUPT, files[0]); /* a wall */
}

int suite_tin_source(void) {
    CU_pSuite suite = CU_add_suite("TIN source", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_steps);
    CU_ADD_TEST(suite, test_kept_places);
    CU_ADD_TEST(suite, test_rounded_places);
    CU_ADD_TEST(suite, test_margins);
    CU_ADD_TEST(suite, test_blocks);
    CU_ADD_TEST(suite, test_cluster);
    CU_ADD_TEST(suite, test_geodetic);
    CU_ADD_TEST(suite, test_egm96);
    CU_ADD_TEST(suite, test_continent);
    CU_ADD_TEST(suite, test_order);
    CU_ADD_TEST(suite, test_memory);
    CU_ADD_TEST(suite, test_refused);
    CU_ADD_TEST(suite, test_bad_places);
    CU_ADD_TEST(suite, test_wanted);
    CU_ADD_TEST(suite, test_meshes);
    return 0;
}
