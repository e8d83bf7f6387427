/* Lines simplified together, and the four methods that simplify point sets between them. */
#include "lod/constrained_flip.h"
#include "lod/covariance.h"
#include "lod/method_grid.h"
#include "lod/method_hierarchy.h"
#include "lod/method_place.h"
#include "lod/method_random.h"
#include "lod/method_wlop.h"
#include "lod/polyline.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines ---- */

enum { MOST_POINTS = 200 };

/* Lines in a square of 1000 units, a unit a metre. */
struct drawing {
    struct scree_memory memory;
    struct constrained triangulation;
    struct vector3 places_m[MOST_POINTS + 4];
    uint32_t starts[4], points[MOST_POINTS];
    struct polylines lines;
};

static struct drawing *drawing_new(void) {
    struct drawing *drawing = calloc(1, sizeof *drawing);
    CU_ASSERT_PTR_NOT_NULL_FATAL(drawing);
    CU_ASSERT_EQUAL_FATAL(constrained_begin(&drawing->memory, 1000, 1000, &drawing->triangulation, NULL), SCREE_OK);
    drawing->lines = (struct polylines){0, drawing->starts, drawing->points};
    return drawing;
}

static void drawing_free(struct drawing *drawing) {
    constrained_release(&drawing->triangulation);
    CU_ASSERT_EQUAL(drawing->memory.used_bytes, 0);
    free(drawing);
}

static void draw_line(struct drawing *drawing, const double (*at)[3], uint32_t count) {
    uint32_t first = drawing->starts[drawing->lines.line_count];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *point = &drawing->points[first + i];
        CU_ASSERT_EQUAL_FATAL(
            constrained_insert(&drawing->triangulation, (int32_t)at[i][0], (int32_t)at[i][1], point, NULL), SCREE_OK);
        drawing->places_m[*point] = (struct vector3){at[i][0], at[i][1], at[i][2]};
        if (i > 0) CU_ASSERT_EQUAL_FATAL(constrained_fix(&drawing->triangulation, point[-1], point[0], NULL), SCREE_OK);
    }
    drawing->starts[++drawing->lines.line_count] = first + count;
}

static void simplify(struct drawing *drawing, double tolerance_m) {
    CU_ASSERT_EQUAL_FATAL(polylines_simplify(&drawing->memory, drawing->places_m, tolerance_m, &drawing->triangulation,
                                             &drawing->lines, NULL),
                          SCREE_OK);
}

static uint32_t points_left(const struct drawing *drawing, uint32_t line) {
    uint32_t count = 0;
    for (uint32_t i = drawing->starts[line]; i < drawing->starts[line + 1]; i++)
        count += drawing->points[i] != CONSTRAINED_NONE;
    return count;
}

static void what_is_straight_in_space_goes(void) {
    const double straight[][3] = {{100, 100, 0}, {200, 200, 50}, {300, 300, 100}, {500, 500, 200}};
    const double humped[][3] = {{100, 700, 0}, {200, 700, 0}, {300, 700, 9}, {400, 700, 0}, {500, 700, 0}};
    const struct {
        double tolerance_m;
        uint32_t left; /* of the hump, which is straight from above, but not in space */
    } cases[] = {{0, 5}, {8.9, 3}, {9, 2}};
    for (int i = 0; i < 3; i++) {
        struct drawing *drawing = drawing_new();
        draw_line(drawing, straight, 4);
        draw_line(drawing, humped, 5);
        simplify(drawing, cases[i].tolerance_m);
        CU_ASSERT_EQUAL(points_left(drawing, 0), 2);
        CU_ASSERT_EQUAL(points_left(drawing, 1), cases[i].left);
        drawing_free(drawing);
    }
}

/* Each step costs little, all together do not: a quarter of a circle, and the tolerance holds at every point. */
static void the_error_counts_all_points_that_left(void) {
    enum { COUNT = 60 };
    const double tolerances_m[] = {1, 5, 40};
    double arc[COUNT][3];
    uint32_t before = COUNT;
    for (int i = 0; i < COUNT; i++) {
        double angle = 1.5707963 * i / (COUNT - 1);
        arc[i][0] = floor(100 + 800 * sin(angle));
        arc[i][1] = floor(100 + 800 * cos(angle));
        arc[i][2] = 0.5 * (i % 2);
    }
    for (int t = 0; t < 3; t++) {
        struct drawing *drawing = drawing_new();
        double worst_m = 0;
        draw_line(drawing, arc, COUNT);
        uint32_t all[COUNT];
        memcpy(all, drawing->points, sizeof all);
        simplify(drawing, tolerances_m[t]);
        uint32_t left = points_left(drawing, 0);
        CU_ASSERT_TRUE(left > 2 && left < before);
        before = left;
        for (int a = 0, c = 1; c < COUNT; c++) {
            if (drawing->points[c] == CONSTRAINED_NONE) continue;
            struct vector3 from = drawing->places_m[all[a]], to = drawing->places_m[all[c]];
            struct vector3 along = vector3_minus(to, from);
            for (int i = a + 1; i < c; i++) { /* the foot of the perpendicular is on the segment here */
                struct vector3 off = vector3_minus(drawing->places_m[all[i]], from);
                double share = vector3_dot(off, along) / vector3_dot(along, along);
                struct vector3 rest = vector3_plus_scaled(off, -share, along);
                worst_m = fmax(worst_m, sqrt(vector3_dot(rest, rest)));
            }
            a = c;
        }
        CU_ASSERT_TRUE(worst_m <= tolerances_m[t] + 1e-9);
        CU_ASSERT_TRUE(worst_m > tolerances_m[t] / 4);
        drawing_free(drawing);
    }
}

/* A line that goes round the end of another one keeps going round it, however large the tolerance. */
static void topology_beats_tolerance(void) {
    const double hook[][3] = {{100, 500, 0}, {400, 520, 0}, {600, 500, 0}, {400, 480, 0}, {110, 470, 0}};
    const double spike[][3] = {{500, 495, 0}, {300, 497, 0}, {200, 495, 0}};
    for (int with_spike = 0; with_spike < 2; with_spike++) {
        struct drawing *drawing = drawing_new();
        draw_line(drawing, hook, 5);
        if (with_spike) draw_line(drawing, spike, 3);
        simplify(drawing, 1e6);
        CU_ASSERT_EQUAL(points_left(drawing, 0), with_spike ? 3 : 2);
        if (with_spike) CU_ASSERT_TRUE(points_left(drawing, 1) < 3);
        drawing_free(drawing);
    }
}

static void a_ring_stays_a_ring(void) {
    const double ring[][3] = {{200, 200, 0}, {400, 200, 0}, {600, 200, 0}, {600, 600, 0}, {400, 610, 0}, {200, 200, 0}};
    const double chord[][3] = {{200, 200, 0}, {300, 400, 0}, {350, 420, 0}};
    struct drawing *drawing = drawing_new();
    draw_line(drawing, ring, 6);
    draw_line(drawing, chord, 3);
    simplify(drawing, 1e6);
    CU_ASSERT_TRUE(points_left(drawing, 0) >= 4); /* three corners, the first one counted twice */
    CU_ASSERT_EQUAL(points_left(drawing, 1), 2);
    drawing_free(drawing);
}

/* ---- methods ---- */

enum { METHODS = 4 };

/* All methods by number, with about the same share of the posts. */
static enum scree_status run(int method, struct scree_memory *memory, const struct method_tile *tile,
                             const struct point_set_options *points, struct method_mesh *mesh,
                             struct scree_error *error) {
    double cell_m = tile->cell_span * tile->east_m;
    if (method == 0) return method_random(memory, tile, &(struct method_random_options){90, *points}, mesh, error);
    if (method == 1)
        return method_grid(memory, tile, &(struct method_grid_options){3.2 * cell_m, *points}, mesh, error);
    if (method == 2)
        return method_hierarchy(memory, tile, &(struct method_hierarchy_options){14, 0.02, *points}, mesh, error);
    return method_wlop(memory, tile, &(struct method_wlop_options){10, 5 * cell_m, 5, *points}, mesh, error);
}

static struct method_mesh run_well(int method, struct scree_memory *memory, const struct method_tile *tile,
                                   const struct point_set_options *points) {
    struct method_mesh mesh = {0};
    struct scree_error error = {0};
    enum scree_status status = run(method, memory, tile, points, &mesh, &error);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    struct method_verdict verdict = method_judge(tile, &mesh);
    CU_ASSERT_TRUE(verdict.is_triangulation);
    if (!verdict.is_triangulation) CU_FAIL(verdict.fault);
    return mesh;
}

static void any_tile_is_triangulated(void) {
    const struct method_recipe recipes[] = {
        {.columns = 64, .rows = 64, .metres_a_step = 10},
        {.columns = 64, .rows = 40, .cell_span = 8, .border_tolerance_m = 20, .is_round = true},
        {.columns = 48, .rows = 64, .cell_span = 1 << 22, .border_tolerance_m = 200, .metres_a_step = 0.01},
        {.columns = 33, .rows = 33, .metres_a_step = 1, .border_tolerance_m = 5}, /* nearly all is a feature */
        {.columns = 1, .rows = 1},
        {.columns = 1, .rows = 40},
        {.columns = 40, .rows = 1, .cell_span = 4},
        {.columns = 2, .rows = 2, .metres_a_step = 1},
        {.columns = 3, .rows = 2, .cell_span = 64},
    };
    for (size_t i = 0; i < sizeof recipes / sizeof *recipes; i++) {
        struct made_method_tile *made = made_method_tile_new(&recipes[i]);
        for (int variant = 0; variant < 3 * METHODS; variant++) {
            struct scree_memory memory = {0};
            struct point_set_options points = {.features = {.least_edges = 2, .in_unit_cube = variant % 3 == 1},
                                               .without_features = variant % 3 == 2,
                                               .line_tolerance_m = 5,
                                               .seed = i};
            struct method_mesh mesh = run_well(variant / 3, &memory, &made->tile, &points);
            method_mesh_release(&memory, &mesh);
            CU_ASSERT_EQUAL(memory.used_bytes, 0);
        }
        made_method_tile_free(made);
    }
}

static void the_seed_decides(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 40, .rows = 40, .metres_a_step = 20});
    for (int method = 0; method < METHODS; method++) {
        struct scree_memory memory = {0};
        struct point_set_options points = {.seed = 5, .line_tolerance_m = 2};
        struct method_mesh one = run_well(method, &memory, &made->tile, &points);
        struct method_mesh again = run_well(method, &memory, &made->tile, &points);
        points.seed = 6;
        struct method_mesh other = run_well(method, &memory, &made->tile, &points);
        CU_ASSERT_TRUE(method_meshes_equal(&one, &again));
        CU_ASSERT_EQUAL(method_meshes_equal(&one, &other), method == 2); /* clusters leave nothing to chance */
        method_mesh_release(&memory, &one);
        method_mesh_release(&memory, &again);
        method_mesh_release(&memory, &other);
    }
    made_method_tile_free(made);
}

static uint32_t border_vertices(const struct method_tile *tile) {
    uint32_t count = 0;
    for (int side = 0; side < SIDE_COUNT; side++) count += (uint32_t)tile->lines[side]->vertex_count - 1;
    return count;
}

/* Vertices inside, without features. */
static uint32_t count_inside(int method, const struct method_tile *tile, double first, double second) {
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0};
    const struct point_set_options points = {.without_features = true};
    enum scree_status status = SCREE_E_ARGUMENT;
    if (method == 0) status = method_random(&memory, tile, &(struct method_random_options){first, points}, &mesh, NULL);
    if (method == 1) status = method_grid(&memory, tile, &(struct method_grid_options){first, points}, &mesh, NULL);
    if (method == 2)
        status = method_hierarchy(&memory, tile, &(struct method_hierarchy_options){(uint32_t)first, second, points},
                                  &mesh, NULL);
    if (method == 3)
        status = method_wlop(&memory, tile, &(struct method_wlop_options){first, second, 3, points}, &mesh, NULL);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    uint32_t inside = mesh.vertex_count - border_vertices(tile);
    method_mesh_release(&memory, &mesh);
    return inside;
}

static void as_many_points_as_asked_for(void) {
    struct made_method_tile *rough = made_method_tile_new(&(struct method_recipe){.columns = 61, .rows = 41});
    static const float zeros[62 * 42];
    struct made_method_tile *level =
        made_method_tile_new(&(struct method_recipe){.columns = 61, .rows = 41, .given_heights_m = zeros});
    CU_ASSERT_EQUAL(count_inside(0, &rough->tile, 0, 0), 2400);
    CU_ASSERT_EQUAL(count_inside(0, &rough->tile, 98.5, 0), 36);
    CU_ASSERT_EQUAL(count_inside(0, &rough->tile, 100, 0), 0);
    /* Posts inside reach 885 m to both sides of the middle, where four cells meet: 2 x 5 cells of 180 m; and 585 m. */
    CU_ASSERT_EQUAL(count_inside(1, &level->tile, 180, 0), 10 * 8);
    CU_ASSERT_TRUE(count_inside(1, &rough->tile, 180, 0) > 10 * 8); /* cells are cubes */
    CU_ASSERT_EQUAL(count_inside(1, &level->tile, 1, 0), 2400);
    CU_ASSERT_EQUAL(count_inside(1, &level->tile, 1e6, 0), 4);
    /* Level clusters are halved until they are small enough. */
    uint32_t clusters = count_inside(2, &level->tile, 50, 0);
    CU_ASSERT_TRUE(clusters >= 48 && clusters <= 96);
    CU_ASSERT_EQUAL(count_inside(2, &level->tile, 1, 0), 2400);
    CU_ASSERT_EQUAL(count_inside(2, &level->tile, 1e6, 0), 1);
    CU_ASSERT_TRUE(count_inside(2, &rough->tile, 50, 1e-4) > 2 * clusters);
    uint32_t kept = count_inside(3, &rough->tile, 10, 0);
    CU_ASSERT_TRUE(kept <= 240 && kept > 220);                  /* a few may end up beside the border */
    CU_ASSERT_EQUAL(count_inside(3, &rough->tile, 10, 1), 240); /* nothing within reach: they stay */
    CU_ASSERT_EQUAL(count_inside(3, &rough->tile, 0, 0), 0);
    made_method_tile_free(level);
    made_method_tile_free(rough);
}

/* Sharp ridges survive where every point between them goes. */
static void features_are_kept(void) {
    enum { SIDE = 32, ACROSS = SIDE + 1 };
    static float heights_m[ACROSS * ACROSS];
    for (int y = 0; y < ACROSS; y++)
        for (int x = 0; x < ACROSS; x++) heights_m[y * ACROSS + x] = -40.0f * (float)abs(x - 12 - y / 8);
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = SIDE, .rows = SIDE, .border_tolerance_m = 1, .given_heights_m = heights_m});
    double max_m[2];
    for (int with = 0; with < 2; with++) {
        struct scree_memory memory = {0};
        struct method_mesh mesh = {0};
        const struct method_random_options options = {100, {.without_features = !with, .line_tolerance_m = 1}};
        CU_ASSERT_EQUAL_FATAL(method_random(&memory, &made->tile, &options, &mesh, NULL), SCREE_OK);
        max_m[with] = method_judge(&made->tile, &mesh).max_m;
        method_mesh_release(&memory, &mesh);
    }
    CU_ASSERT_TRUE(max_m[1] < 0.5 * max_m[0]);
    made_method_tile_free(made);
}

/* A plane with noise: projected points are nearer to it, and farther from one another, than posts drawn at random. */
static void wlop_smooths_and_spreads(void) {
    enum { SIDE = 60, ACROSS = SIDE + 1 };
    static float heights_m[ACROSS * ACROSS];
    double rms_m[2], nearest_m[2] = {INFINITY, INFINITY};
    for (int i = 0; i < ACROSS * ACROSS; i++)
        heights_m[i] = (float)(3 * (i % ACROSS) + (i * 7919 % 101) * 0.2 - 10); /* noise of 5.8 m RMS */
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = SIDE, .rows = SIDE, .given_heights_m = heights_m});
    for (int wlop = 0; wlop < 2; wlop++) {
        struct scree_memory memory = {0};
        struct method_mesh mesh = {0};
        const struct point_set_options points = {.without_features = true};
        enum scree_status status =
            wlop ? method_wlop(&memory, &made->tile, &(struct method_wlop_options){4, 0, 0, points}, &mesh, NULL)
                 : method_random(&memory, &made->tile, &(struct method_random_options){96, points}, &mesh, NULL);
        CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
        double sum_m2 = 0;
        uint32_t first = border_vertices(&made->tile);
        for (uint32_t i = first; i < mesh.vertex_count; i++) {
            const struct method_vertex *at = &mesh.vertices[i];
            double off_m = at->height_m - 3 * at->x;
            sum_m2 += off_m * off_m;
            for (uint32_t k = first; k < i; k++)
                nearest_m[wlop] =
                    fmin(nearest_m[wlop], 30 * hypot(at->x - mesh.vertices[k].x, at->y - mesh.vertices[k].y));
        }
        rms_m[wlop] = sqrt(sum_m2 / (mesh.vertex_count - first));
        method_mesh_release(&memory, &mesh);
    }
    CU_ASSERT_TRUE(rms_m[1] < 0.5 * rms_m[0]);
    CU_ASSERT_TRUE(nearest_m[1] > 2 * nearest_m[0]);
    made_method_tile_free(made);
}

/* ---- axes ---- */

static void axes_of_known_points(void) {
    /* Variances 9, 4 and 1 along (2, 2, 1) / 3, (-2, 1, 2) / 3 and (1, -2, 2) / 3. */
    const double axes[3][3] = {{2, 2, 1}, {-2, 1, 2}, {1, -2, 2}}, variance[3] = {9, 4, 1};
    double m[3][3] = {{0}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) m[i][j] += variance[k] * axes[k][i] * axes[k][j] / 9;
    struct principal_axes found =
        covariance_axes(&(struct covariance){m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]});
    CU_ASSERT_DOUBLE_EQUAL(found.variance[0], 1, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(found.variance[1], 4, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(found.variance[2], 9, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(fabs(vector3_dot(found.longest, (struct vector3){2.0 / 3, 2.0 / 3, 1.0 / 3})), 1, 1e-12);
    found = covariance_axes(&(struct covariance){0});
    CU_ASSERT_EQUAL(found.variance[2], 0);
    found = covariance_axes(&(struct covariance){.xx = 2, .yy = 7, .zz = 5});
    CU_ASSERT_EQUAL(found.variance[0], 2);
    CU_ASSERT_EQUAL(fabs(found.longest.y), 1);
}

/* ---- failures ---- */

static void bad_options_are_refused(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 8, .rows = 8});
    const struct method_tile *tile = &made->tile;
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0};
    const double bad_percents[] = {-1, 101, NAN}, bad_cells_m[] = {0, -3, NAN, INFINITY};
    for (int i = 0; i < 3; i++) {
        const struct method_random_options random = {.removed_percent = bad_percents[i]};
        const struct method_wlop_options wlop = {.kept_percent = bad_percents[i]};
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(method_random(&memory, tile, &random, &mesh, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_NOT_EQUAL(error.text[0], '\0');
        CU_ASSERT_EQUAL(method_wlop(&memory, tile, &wlop, &mesh, NULL), SCREE_E_ARGUMENT);
    }
    for (int i = 0; i < 4; i++) {
        const struct method_grid_options grid = {.cell_m = bad_cells_m[i]};
        CU_ASSERT_EQUAL(method_grid(&memory, tile, &grid, &mesh, NULL), SCREE_E_ARGUMENT);
    }
    const struct method_hierarchy_options bad_clusters[] = {{.most_posts = 0},
                                                            {.most_posts = 5, .most_variation = -0.1},
                                                            {.most_posts = 5, .most_variation = 0.4},
                                                            {.most_posts = 5, .most_variation = NAN}};
    for (int i = 0; i < 4; i++)
        CU_ASSERT_EQUAL(method_hierarchy(&memory, tile, &bad_clusters[i], &mesh, NULL), SCREE_E_ARGUMENT);
    const struct method_wlop_options bad_projections[] = {{.radius_m = -1}, {.radius_m = NAN}, {.iterations = -1}};
    for (int i = 0; i < 3; i++)
        CU_ASSERT_EQUAL(method_wlop(&memory, tile, &bad_projections[i], &mesh, NULL), SCREE_E_ARGUMENT);
    for (int method = 0; method < METHODS; method++) {
        const struct point_set_options bad[] = {{.line_tolerance_m = -1}, {.features = {.angle_deg = 200}}};
        for (int i = 0; i < 2; i++) CU_ASSERT_EQUAL(run(method, &memory, tile, &bad[i], &mesh, NULL), SCREE_E_ARGUMENT);
    }
    CU_ASSERT_PTR_NULL(mesh.vertices);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void every_failed_request_is_survived(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 40, .rows = 40, .metres_a_step = 3});
    for (int method = 0; method < METHODS; method++) {
        enum scree_status status = SCREE_E_MEMORY;
        uint64_t request = 0;
        while (status != SCREE_OK && request < 200) {
            struct scree_memory memory = {.fail_request = ++request};
            struct method_mesh mesh = {0};
            status = run(method, &memory, &made->tile, &(struct point_set_options){.line_tolerance_m = 5}, &mesh, NULL);
            CU_ASSERT_TRUE(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
            method_mesh_release(&memory, &mesh);
            CU_ASSERT_EQUAL(memory.used_bytes, 0);
        }
        CU_ASSERT_EQUAL(status, SCREE_OK);
        CU_ASSERT_TRUE(request > 20);
    }
    made_method_tile_free(made);
}

int suite_points(void) {
    CU_pSuite suite = CU_add_suite("point sets between feature lines", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, what_is_straight_in_space_goes);
    CU_ADD_TEST(suite, the_error_counts_all_points_that_left);
    CU_ADD_TEST(suite, topology_beats_tolerance);
    CU_ADD_TEST(suite, a_ring_stays_a_ring);
    CU_ADD_TEST(suite, any_tile_is_triangulated);
    CU_ADD_TEST(suite, the_seed_decides);
    CU_ADD_TEST(suite, as_many_points_as_asked_for);
    CU_ADD_TEST(suite, features_are_kept);
    CU_ADD_TEST(suite, wlop_smooths_and_spreads);
    CU_ADD_TEST(suite, axes_of_known_points);
    CU_ADD_TEST(suite, bad_options_are_refused);
    CU_ADD_TEST(suite, every_failed_request_is_survived);
    return 0;
}
