/* What scree compare measures, looks for, writes and draws, piece by piece. */
#include "lod/method_error.h"
#include "src/compare_measure.h"
#include "src/compare_report.h"
#include "src/compare_run_io.h"
#include "src/mesh_picture.h"
#include "src/png.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- looking for a number of triangles ---- */

/* Stands in for a method: no mesh but a number of triangles, which follows from the option. */
static enum scree_status count_triangles(struct scree_memory *memory, double triangles, struct method_mesh *mesh) {
    mesh->vertices = scree_allocate(memory, 1, 1, "a mesh", NULL); /* something to lose */
    mesh->triangle_count = (uint32_t)triangles;
    return mesh->vertices != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

static enum scree_status run_falling(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                     struct method_mesh *mesh, struct scree_error *error) {
    (void)tile, (void)error;
    return count_triangles(memory, fmin(131072, 2 + 30000 / (values[0] + 0.01)), mesh);
}

static enum scree_status run_rising(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                    struct method_mesh *mesh, struct scree_error *error) {
    (void)tile, (void)error;
    return count_triangles(memory, fmin(2 * values[0] / 3, 100000), mesh);
}

static enum scree_status run_in_steps(struct scree_memory *memory, const struct method_tile *tile,
                                      const double values[], struct method_mesh *mesh, struct scree_error *error) {
    (void)tile, (void)error;
    return count_triangles(memory, values[0] < 3 ? 10 : 10 * pow(4, floor(values[0] / 10)), mesh);
}

static enum scree_status run_alike(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                   struct method_mesh *mesh, struct scree_error *error) {
    (void)tile, (void)values, (void)error;
    return count_triangles(memory, 77, mesh);
}

static enum scree_status run_percent(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                     struct method_mesh *mesh, struct scree_error *error) {
    (void)tile, (void)error;
    return count_triangles(memory, 131072 * (1 - values[0] / 100) + 20, mesh);
}

struct found {
    double value;
    uint32_t triangles;
};

static struct found find(struct method_option option, uint32_t wanted,
                         enum scree_status (*run)(struct scree_memory *, const struct method_tile *, const double[],
                                                  struct method_mesh *, struct scree_error *)) {
    const struct method method = {"stand-in", "", 1, &option, NULL, run};
    const struct method_choice choice = {.method = &method};
    const struct compare_task task = {&choice, 5, 100, wanted, 0};
    const struct method_recipe recipe = {.columns = 2, .rows = 2};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    struct compare_outcome outcome;
    struct scree_memory memory = {0};
    CU_ASSERT_EQUAL_FATAL(compare_run(&memory, &task, &made->tile, &outcome, NULL), SCREE_OK);
    struct found found = {outcome.values[0], outcome.mesh.triangle_count};
    method_mesh_release(&memory, &outcome.mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
    return found;
}

static bool is_close(uint32_t triangles, double wanted) {
    return fabs(triangles - wanted) <= 0.02 * wanted;
}

static void the_option_that_gives_so_many_triangles_is_found(void) {
    struct method_option tolerance = {"e", "", 0, 1e7, NAN, 1, false};
    struct method_option whole = {"n", "", 3, 1e6, NAN, 0, true}, from_zero = {"e", "", 0, 1e7, 0, 0, false};
    CU_ASSERT_EQUAL(find(tolerance, 0, run_falling).value, 100);
    CU_ASSERT_TRUE(is_close(find(tolerance, 500, run_falling).triangles, 500));
    CU_ASSERT_TRUE(is_close(find(tolerance, 50000, run_falling).triangles, 50000));
    CU_ASSERT_TRUE(is_close(find(from_zero, 2000, run_falling).triangles, 2000));
    CU_ASSERT_TRUE(is_close(find(whole, 2000, run_rising).triangles, 2000));
    CU_ASSERT_TRUE(is_close(find(whole, 90000, run_rising).triangles, 90000));
    struct method_option percent = {"r", "", 0, 100, 75, 0, false};
    CU_ASSERT_TRUE(is_close(find(percent, 1500, run_percent).triangles, 1500));
    CU_ASSERT_TRUE(is_close(find(percent, 130000, run_percent).triangles, 130000));
}

static void the_nearest_counts_where_nothing_fits(void) {
    struct method_option tolerance = {"e", "", 0.5, 1e7, NAN, 1, false}, whole = {"n", "", 1, 100, 15, 0, true};
    CU_ASSERT_EQUAL(find(tolerance, 131072, run_falling).value, 0.5); /* the bound */
    CU_ASSERT_EQUAL(find(whole, 100, run_in_steps).triangles, 160);   /* of 10, 40, 160, 640, ... */
    CU_ASSERT_EQUAL(find(whole, 600, run_in_steps).triangles, 640);
    CU_ASSERT_EQUAL(find(whole, 1000, run_alike).triangles, 77);
}

/* ---- measuring ---- */

static void a_lifted_copy_of_the_posts_is_as_far_off_as_it_was_lifted(void) {
    const struct method_recipe recipe = {.columns = 20, .rows = 10, .border_tolerance_m = -1};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    struct scree_memory memory = {0};
    struct lattice lattice;
    struct compare_subject subject;
    struct compare_figures figures = {0};
    CU_ASSERT_EQUAL_FATAL(lattice_local(21, 11, 0, 0, 30, 30, 1, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(compare_subject_make(&memory, &lattice, (struct tile_id){0}, &made->tile, 1, &subject, NULL),
                          SCREE_OK);
    CU_ASSERT_EQUAL(compare_measure(&memory, &subject, &subject.grid, &figures, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(figures.vertices, 21 * 11);
    CU_ASSERT_EQUAL(figures.triangles, 400);
    CU_ASSERT_EQUAL(figures.posts, 21 * 11);
    CU_ASSERT_EQUAL(figures.max_error_m, 0);
    CU_ASSERT_TRUE(figures.distance.max_m < 1e-9);

    struct method_vertex lifted[21 * 11];
    struct method_mesh copy = subject.grid;
    copy.vertices = lifted;
    for (uint32_t i = 0; i < copy.vertex_count; i++) {
        lifted[i] = subject.grid.vertices[i];
        lifted[i].height_m += 4;
    }
    CU_ASSERT_EQUAL(compare_measure(&memory, &subject, &copy, &figures, NULL), SCREE_OK);
    CU_ASSERT_DOUBLE_EQUAL(figures.max_error_m, 4, 1e-3);
    CU_ASSERT_DOUBLE_EQUAL(figures.sum_squares_m2, 16 * 21 * 11, 0.1);
    CU_ASSERT_TRUE(figures.distance.max_m <= 4 + 1e-9 && figures.distance.max_m > 3);

    copy.triangle_count -= 1;
    CU_ASSERT_EQUAL(compare_measure(&memory, &subject, &copy, &figures, NULL), SCREE_E_CORRUPT);
    compare_subject_release(&memory, &subject);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

/* Border vertices between the posts, which all methods are given, count as terrain. */
static void the_posts_go_along_with_the_border(void) {
    const struct method_recipe recipe = {.columns = 12, .rows = 9, .cell_span = 8, .border_tolerance_m = 1};
    struct made_method_tile *made = made_method_tile_new(&recipe);
    struct scree_memory memory = {0};
    struct lattice lattice;
    struct compare_subject subject;
    struct method_error error;
    uint32_t between = 0;
    CU_ASSERT_EQUAL_FATAL(lattice_local(200, 200, 0, 0, 30, 30, 1, &lattice, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(compare_subject_make(&memory, &lattice, (struct tile_id){0}, &made->tile, 1, &subject, NULL),
                          SCREE_OK);
    for (int side = 0; side < SIDE_COUNT; side++)
        for (int32_t i = 0; i < made->lines[side].vertex_count; i++) {
            const struct border_sample *vertex = &made->lines[side].vertices[i];
            struct vector3 at = {30.0 * vertex->position, 30.0 * vertex->position, (double)vertex->height_m};
            if (side == SIDE_SOUTH) at.y = 0;
            if (side == SIDE_EAST) at.x = 30.0 * method_width(&made->tile);
            if (side == SIDE_NORTH) at.y = 30.0 * method_height(&made->tile);
            if (side == SIDE_WEST) at.x = 0;
            CU_ASSERT_TRUE(mesh_distance_m(&subject.posts.index, at) < 1e-9);
            between += vertex->position % 8 != 0;
        }
    CU_ASSERT_TRUE(between > 10);
    CU_ASSERT_EQUAL(subject.grid.vertex_count, 13 * 10 + between);
    CU_ASSERT_EQUAL(subject.grid.triangle_count, 2 * 12 * 9 + between);
    CU_ASSERT_EQUAL(method_error_measure(&memory, &made->tile, &subject.grid, &error, NULL), SCREE_OK);
    CU_ASSERT_TRUE(error.covers);
    CU_ASSERT_DOUBLE_EQUAL(error.max_m, 0, 1e-9);
    compare_subject_release(&memory, &subject);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

/* A level tile of the globe as two triangles: the middle of the ellipsoid rises above them by its sagitta. */
static void the_globe_is_round(void) {
    enum { CELLS = 64 };
    static float level_m[(CELLS + 1) * (CELLS + 1)];
    struct lattice lattice = lattice_geodetic(4);
    struct tile_id id = {4, 16, 8}; /* on the equator, 11.25 degrees wide */
    struct method_tile tile = {
        .columns = CELLS, .rows = CELLS, .cell_span = 256 / CELLS, .heights_m = level_m, .stride = CELLS + 1};
    static struct border_line line = {.vertex_count = 2, .vertices = {{0, 0}, {256, 0}}};
    for (int side = 0; side < SIDE_COUNT; side++) tile.lines[side] = &line;
    struct method_vertex vertices[] = {{0, 0, 0}, {256, 0, 0}, {256, 256, 0}, {0, 256, 0}};
    uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    struct method_mesh mesh = {4, 2, vertices, corners};
    struct scree_memory memory = {0};
    struct compare_subject subject;
    struct compare_figures figures = {0};
    double pi = acos(-1), half = 11.25 / 2 * pi / 180;
    CU_ASSERT_EQUAL_FATAL(compare_subject_make(&memory, &lattice, id, &tile, 1, &subject, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(compare_measure(&memory, &subject, &mesh, &figures, NULL), SCREE_OK);
    /* half of the diagonal is half of the angle times the root of 2, less what meridians draw together: within 3 % */
    double sagitta_m = 6378137 * (1 - cos(half * sqrt(2)));
    CU_ASSERT_DOUBLE_EQUAL(figures.distance.max_m, sagitta_m, 0.03 * sagitta_m);
    CU_ASSERT_EQUAL(figures.max_error_m, 0); /* this tile says that it is flat */
    compare_subject_release(&memory, &subject);
}

/* ---- reporting ---- */

static struct compare_figures figures_of(uint32_t x, uint32_t triangles, double hausdorff_m, double rms_m) {
    return (struct compare_figures){.id = {9, x, 3},
                                    .main_value = 2.5,
                                    .cpu_s = 0.25,
                                    .vertices = triangles / 2,
                                    .triangles = triangles,
                                    .bytes = 1000 + x,
                                    .distance = {.max_m = hausdorff_m, .mean_m = 1, .sample_count = 5},
                                    .max_error_m = 2 * hausdorff_m,
                                    .sum_squares_m2 = 100 * rms_m * rms_m,
                                    .posts = 100};
}

struct made_report {
    struct compare_figures figures[4];
    struct compare_zoom zoom;
    struct compare_entry entries[2];
    const char *methods[2], *main_options[2];
    struct compare_report report;
};

static void make_report(struct made_report *made, uint32_t wanted) {
    *made = (struct made_report){
        .figures = {figures_of(0, 1000, 4, 3), figures_of(1, 1030, 8, 4), figures_of(0, 500, 1, 1),
                    figures_of(1, 700, 3, 1)},
        .zoom = {.zoom = 9, .tile_count = 2, .tiles_in_all = 5, .tolerance_m = 20, .picture = "posts.png"},
        .methods = {"first", "second, \"b\""},
        .main_options = {"e", ""}};
    made->entries[0] = (struct compare_entry){9, 0, wanted, "e=2.5", made->figures, "first.png", 1000};
    if (wanted != 0) snprintf(made->entries[0].options, sizeof made->entries[0].options, "f=1");
    if (wanted != 0) made->figures[1].main_value = 3;
    made->entries[1] = (struct compare_entry){9, 1, wanted, "", made->figures + 2, "", 0};
    made->report =
        (struct compare_report){"dem.tif", 2, made->methods, made->main_options, 1, 2, &made->zoom, made->entries};
}

static void means_are_over_tiles_and_posts(void) {
    struct made_report made;
    make_report(&made, 1000);
    struct compare_means means = compare_means_of(&made.entries[0], 2);
    CU_ASSERT_EQUAL(means.triangles, 1015);
    CU_ASSERT_EQUAL(means.hausdorff_m, 6);
    CU_ASSERT_EQUAL(means.hausdorff_max_m, 8);
    CU_ASSERT_EQUAL(means.max_error_m, 16);
    CU_ASSERT_DOUBLE_EQUAL(means.rms_error_m, sqrt((9 + 16) / 2.0), 1e-12);
    CU_ASSERT_FALSE(means.has_wanted_triangles); /* 1030 is 3 % more */
    made.figures[1].triangles = 1020;
    CU_ASSERT_TRUE(compare_means_of(&made.entries[0], 2).has_wanted_triangles);
}

static bool says(const struct text *text, const char *words) {
    return text->bytes != NULL && strstr(text->bytes, words) != NULL;
}

static void the_report_says_the_same_in_all_forms(void) {
    struct made_report made;
    struct text csv = {0}, tiles = {0}, page = {0}, table = {0};
    make_report(&made, 0);
    compare_add_csv(&made.report, &csv);
    CU_ASSERT_TRUE(says(&csv, "\n9,first,e=2.5,,2,0.25,507.5,1015,6,8,1,16,3.53553,1000.5\n"));
    CU_ASSERT_TRUE(says(&csv, "\n9,\"second, \"\"b\"\"\",,,2,"));
    compare_add_tiles_csv(&made.report, &tiles);
    CU_ASSERT_TRUE(says(&tiles, "\n9,1,3,first,,2.5,0.25,515,1030,8,0,0,1,16,4,1001\n"));
    compare_add_markdown(&made.report, &page);
    CU_ASSERT_TRUE(says(&page, "## Zoom 9, 2 full tiles of 5\n"));
    CU_ASSERT_TRUE(says(&page, "| first | e=2.5 | 0.2500 | 507.5 | 1015.0 | 6.00 | 8.00 | 16.00 | 3.536 | 1000 |"));
    CU_ASSERT_TRUE(says(&page, "first, 1000 triangles:\n\n![](first.png)"));
    CU_ASSERT_TRUE(says(&page, "![](posts.png)"));
    CU_ASSERT_FALSE(says(&page, "(!)"));
    compare_add_table(&made.report, &table);
    CU_ASSERT_TRUE(says(&table, "first              0.2500     507.5    1015.0        6.00       16.00     3.536"));
    char *json = compare_json_new(&made.report);
    CU_ASSERT_PTR_NOT_NULL_FATAL(json);
    CU_ASSERT_PTR_NOT_NULL(strstr(json, "\"hausdorff_m\": 6,"));
    CU_ASSERT_PTR_NULL(strstr(json, "wanted_triangles"));
    free(json);
    text_free(&csv);
    text_free(&tiles);
    text_free(&page);
    text_free(&table);

    make_report(&made, 1000);
    made.zoom.is_cut = true;
    compare_add_markdown(&made.report, &page);
    CU_ASSERT_TRUE(says(&page, "one tile, which the raster's border cuts, 1000 triangles"));
    CU_ASSERT_TRUE(says(&page, "| first | e=2.5..3 f=1 | "));
    CU_ASSERT_TRUE(says(&page, "1015.0 (!) |"));
    CU_ASSERT_TRUE(says(&page, "\n(!) "));
    text_free(&page);
}

static void charts_show_every_method(void) {
    struct made_report made;
    struct scree_memory memory = {0};
    struct text chart = {0};
    make_report(&made, 0);
    CU_ASSERT_EQUAL(compare_add_hausdorff_chart(&made.report, &memory, &chart, NULL), SCREE_OK);
    CU_ASSERT_TRUE(says(&chart, "second, &quot;b&quot;</text>"));
    CU_ASSERT_TRUE(says(&chart, ">zoom 9</text>"));
    CU_ASSERT_TRUE(says(&chart, "</svg>"));
    CU_ASSERT_FALSE(says(&chart, "nan"));
    text_free(&chart);
    CU_ASSERT_EQUAL(compare_add_error_chart(&made.report, &memory, &chart, NULL), SCREE_OK);
    CU_ASSERT_TRUE(says(&chart, ">triangles a tile</text>"));
    CU_ASSERT_FALSE(says(&chart, "nan"));
    CU_ASSERT_FALSE(says(&chart, "inf"));
    text_free(&chart);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- pictures ---- */

static uint32_t u32_at(const unsigned char *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void a_png_holds_the_pixels(void) {
    uint8_t rgb[5 * 7 * 3];
    struct scree_memory memory = {0};
    unsigned char *file, rows[7 * 16];
    size_t size_bytes;
    uLongf rows_bytes = sizeof rows;
    for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (uint8_t)(i * i * 31);
    CU_ASSERT_EQUAL_FATAL(png_encode_new(&memory, rgb, 5, 7, &file, &size_bytes, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(memcmp(file, "\x89PNG\r\n\x1a\n", 8), 0);
    CU_ASSERT_EQUAL(u32_at(file + 16), 5);
    CU_ASSERT_EQUAL(u32_at(file + 20), 7);
    uint32_t data_bytes = u32_at(file + 33);
    CU_ASSERT_EQUAL(memcmp(file + 37, "IDAT", 4), 0);
    CU_ASSERT_EQUAL(u32_at(file + 41 + data_bytes), crc32(0, file + 37, 4 + data_bytes));
    CU_ASSERT_EQUAL(size_bytes, 33 + 12 + data_bytes + 12);
    CU_ASSERT_EQUAL_FATAL(uncompress(rows, &rows_bytes, file + 41, data_bytes), Z_OK);
    CU_ASSERT_EQUAL_FATAL(rows_bytes, 7 * 16);
    for (size_t y = 0; y < 7; y++)
        for (size_t i = 0; i < 15; i++) {
            unsigned char *row = rows + 16 * y + 1;
            if (i >= 3) row[i] = (unsigned char)(row[i] + row[i - 3]); /* undo the filter */
            CU_ASSERT_EQUAL(row[i], rgb[15 * y + i]);
        }
    scree_release(&memory, file);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    CU_ASSERT_EQUAL(png_encode_new(&memory, rgb, 0, 7, &file, &size_bytes, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(png_encode_new(&memory, rgb, 5, PNG_MOST_PX + 1, &file, &size_bytes, NULL), SCREE_E_ARGUMENT);
}

static const uint8_t *pixel(const struct mesh_picture *picture, uint32_t x, uint32_t y) {
    return picture->rgb + 3 * ((size_t)y * picture->width_px + x);
}

/* A roof whose western side faces the light, with a wall of nothing around it. */
static void a_picture_has_light_and_edges(void) {
    struct vector3 vertices_m[] = {{0, 0, 0}, {50, 0, 40}, {100, 0, 0}, {0, 100, 0}, {50, 100, 40}, {100, 100, 0}};
    uint32_t corners[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, none[] = {0, 1, 6};
    struct space_mesh mesh = {6, 4, vertices_m, corners};
    struct scree_memory memory = {0};
    struct mesh_picture picture;
    CU_ASSERT_EQUAL_FATAL(mesh_picture_new(&memory, &mesh, 100, &picture, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(picture.width_px, 200);
    CU_ASSERT_EQUAL(picture.height_px, 100);
    CU_ASSERT_EQUAL(*pixel(&picture, 0, 0), 255);
    CU_ASSERT_EQUAL(*pixel(&picture, 199, 0), 255);
    int west = *pixel(&picture, 20, 30), east = *pixel(&picture, 80, 50), ridge = *pixel(&picture, 50, 50);
    CU_ASSERT_TRUE(west > east + 50);
    CU_ASSERT_TRUE(ridge < west - 50);
    CU_ASSERT_NOT_EQUAL(*pixel(&picture, 150, 50), 255); /* the other view */
    mesh_picture_release(&memory, &picture);
    mesh.corners = none;
    mesh.triangle_count = 1;
    CU_ASSERT_EQUAL(mesh_picture_new(&memory, &mesh, 100, &picture, NULL), SCREE_E_ARGUMENT);
    mesh.corners = corners;
    CU_ASSERT_EQUAL(mesh_picture_new(&memory, &mesh, 8, &picture, NULL), SCREE_E_ARGUMENT);
    for (uint64_t n = 1; n <= 5; n++) {
        memory.fail_request = memory.requests + n;
        CU_ASSERT_EQUAL(mesh_picture_new(&memory, &mesh, 100, &picture, NULL), SCREE_E_MEMORY);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_compare(void) {
    CU_pSuite suite = CU_add_suite("comparing methods", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, the_option_that_gives_so_many_triangles_is_found);
    CU_ADD_TEST(suite, the_nearest_counts_where_nothing_fits);
    CU_ADD_TEST(suite, a_lifted_copy_of_the_posts_is_as_far_off_as_it_was_lifted);
    CU_ADD_TEST(suite, the_posts_go_along_with_the_border);
    CU_ADD_TEST(suite, the_globe_is_round);
    CU_ADD_TEST(suite, means_are_over_tiles_and_posts);
    CU_ADD_TEST(suite, the_report_says_the_same_in_all_forms);
    CU_ADD_TEST(suite, charts_show_every_method);
    CU_ADD_TEST(suite, a_png_holds_the_pixels);
    CU_ADD_TEST(suite, a_picture_has_light_and_edges);
    return 0;
}
