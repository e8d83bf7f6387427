/* Edge collapse with free placement: costs and places against geometry worked out by hand, and what the method promises
 * against the judge of all methods. */
#include "lod/method_lindstrom_turk.h"
#include "lod/post_grid.h"
#include "tests/fractal.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- costs and places ---- */

/* A fan of `count` triangles around the origin, whose rim is at radius 1 and height z(angle). */
static struct lindstrom_sums fan(int count, double (*z)(double angle)) {
    struct lindstrom_sums sums = {0};
    const double origin[3] = {0, 0, 0};
    for (int i = 0; i < count; i++) {
        double from = 2 * M_PI * i / count, to = 2 * M_PI * (i + 1) / count;
        double a[3] = {cos(from), sin(from), z(from)}, b[3] = {cos(to), sin(to), z(to)};
        lindstrom_add_triangle(&sums, origin, a, b);
        lindstrom_add_neighbour(&sums, a);
    }
    return sums;
}

static double sloping(double angle) {
    return 0.5 * cos(angle) - 0.25 * sin(angle);
}

static double saddle(double angle) {
    return 0.3 * cos(2 * angle);
}

static void a_plane_costs_nothing_and_keeps_its_vertices_on_it(void) {
    struct lindstrom_sums sums = fan(7, sloping);
    double place[3];
    CU_ASSERT_FATAL(lindstrom_place(&sums, place));
    CU_ASSERT_DOUBLE_EQUAL(place[2], 0.5 * place[0] - 0.25 * place[1], 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(place[0], 0, 1e-12); /* where the rim's points are nearest */
    CU_ASSERT_DOUBLE_EQUAL(place[1], 0, 1e-12);
    CU_ASSERT(lindstrom_cost(&sums, &(struct lindstrom_weights){0.5, 0.5, 0}, 1, place) < 1e-20);
}

static void the_volume_stays_the_same(void) {
    struct lindstrom_sums sums = fan(9, saddle);
    double place[3], moved[3] = {0.05, 0.02, 0.1};
    const struct lindstrom_weights weights = {1, 0, 0};
    lindstrom_add_triangle(&sums, (double[3]){1, 1, 0.3}, (double[3]){0.5, 0, 0.1}, (double[3]){0, 0.5, 0.2});
    CU_ASSERT_FATAL(lindstrom_place(&sums, place));
    double volume = sums.normal[0] * place[0] + sums.normal[1] * place[1] + sums.normal[2] * place[2];
    CU_ASSERT_DOUBLE_EQUAL(volume, sums.offset, 1e-12);
    for (int i = 0; i < 3; i++) moved[i] += place[i];
    CU_ASSERT(lindstrom_cost(&sums, &weights, 1, place) < lindstrom_cost(&sums, &weights, 1, moved));
}

static void costs_are_those_of_geometry(void) {
    struct lindstrom_sums sums = {0};
    const double place[3] = {0, 0, 2}, from[3] = {-1, 0, 0}, to[3] = {1, 0, 0};
    /* a triangle of area 1/2 with an apex 3 above it: a tetrahedron of volume 1/2 */
    lindstrom_add_triangle(&sums, (double[3]){0, 0, -1}, (double[3]){1, 0, 0}, (double[3]){0, 1, 0});
    lindstrom_add_border(&sums, from, to); /* the apex sees it under a triangle of area 2 */
    lindstrom_add_neighbour(&sums, (double[3]){1, 1, 0});
    CU_ASSERT_DOUBLE_EQUAL(lindstrom_cost(&sums, &(struct lindstrom_weights){1, 0, 0}, 9, place), 0.25, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(lindstrom_cost(&sums, &(struct lindstrom_weights){0, 1, 0}, 9, place), 4 * 9, 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(lindstrom_cost(&sums, &(struct lindstrom_weights){0, 0, 1}, 9, place), 6 * 81, 1e-12);
}

static void three_planes_that_do_not_meet_are_no_place(void) {
    struct lindstrom_sums sums = {0};
    double place[3];
    CU_ASSERT_FALSE(lindstrom_place(&sums, place));
}

/* ---- the method ---- */

struct result {
    enum scree_status status;
    struct scree_memory memory;
    struct method_mesh mesh;
    struct method_verdict verdict;
};

static struct result run(const struct method_tile *tile, const struct method_lindstrom_turk_options *options) {
    struct result result = {.status = SCREE_OK};
    result.status = method_lindstrom_turk(&result.memory, tile, options, &result.mesh, NULL);
    CU_ASSERT_EQUAL(result.status, SCREE_OK);
    result.verdict = method_judge(tile, &result.mesh);
    return result;
}

static void finish(struct result *result) {
    method_mesh_release(&result->memory, &result->mesh);
    CU_ASSERT_EQUAL(result->memory.used_bytes, 0);
}

static uint32_t edges_of(const struct method_mesh *mesh) {
    return mesh->vertex_count + mesh->triangle_count - 1;
}

static void it_stops_at_a_number_of_edges(void) {
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 96, .rows = 80, .border_tolerance_m = 10, .is_round = true});
    for (uint32_t edges = 600; edges <= 9600; edges *= 4) {
        struct result result = run(&made->tile, &(struct method_lindstrom_turk_options){.edges = edges});
        CU_ASSERT(result.verdict.is_triangulation);
        CU_ASSERT(edges_of(&result.mesh) <= edges && edges_of(&result.mesh) > edges - 3);
        finish(&result);
    }
    made_method_tile_free(made);
}

static void it_stops_at_an_error(void) {
    static const struct method_recipe recipes[] = {
        {.columns = 96, .rows = 80, .border_tolerance_m = 3},
        {.columns = 64, .rows = 64, .border_tolerance_m = 3, .is_round = true, .whole_metres = true},
        {.columns = 64, .rows = 48, .border_tolerance_m = 3, .cell_span = 8, .is_round = true},
        {.columns = 2, .rows = 40, .border_tolerance_m = 3},
        {.columns = 2, .rows = 2, .cell_span = 16384, .border_tolerance_m = 3}};
    for (size_t i = 0; i < sizeof recipes / sizeof *recipes; i++) {
        struct made_method_tile *made = made_method_tile_new(&recipes[i]);
        struct method_lindstrom_turk_options fine = {.is_bounded = true, .tolerance_m = 5},
                                             coarse = {.is_bounded = true, .tolerance_m = 20};
        struct result result = run(&made->tile, &fine), coarser = run(&made->tile, &coarse);
        CU_ASSERT(result.verdict.is_triangulation && coarser.verdict.is_triangulation);
        CU_ASSERT(result.verdict.max_m <= 5 + 1e-6);
        CU_ASSERT(coarser.verdict.max_m <= 20 + 1e-6);
        CU_ASSERT(coarser.mesh.triangle_count <= result.mesh.triangle_count);
        if (i == 0) CU_ASSERT(result.mesh.triangle_count < 2 * 96 * 80 / 3);
        finish(&coarser);
        finish(&result);
        made_method_tile_free(made);
    }
}

/* The scan along rows against every post by barycentric weights. */
static void errors_are_those_of_brute_force(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 24, .rows = 20});
    struct scree_memory memory = {0};
    struct post_grid grid;
    uint64_t random = 5;
    CU_ASSERT_EQUAL_FATAL(post_grid_make(&memory, &made->tile, &grid, NULL), SCREE_OK);
    for (int round = 0; round < 500; round++) {
        struct sample corner[3];
        for (int k = 0; k < 3; k++) {
            int32_t part[3];
            for (int i = 0; i < 3; i++) {
                random = random * 6364136223846793005U + 1442695040888963407U;
                part[i] = (int32_t)(random >> 40);
            }
            bool on_post = round % 2 == 0;
            corner[k] = (struct sample){part[0] % (24 * grid.unit + 1), part[1] % (20 * grid.unit + 1), 0};
            if (on_post) corner[k].x -= corner[k].x % grid.unit;
            if (on_post) corner[k].y -= corner[k].y % grid.unit;
            corner[k].height_m = (float)(part[2] % 4000);
        }
        int64_t area2 = sample_area2(&corner[0], &corner[1], &corner[2]);
        if (area2 <= 0) continue;
        double largest_m = 0;
        for (int32_t y = 0; y <= 20; y++)
            for (int32_t x = 0; x <= 24; x++) {
                struct sample post = {x * grid.unit, y * grid.unit, 0};
                double drawn_m = 0, least = 0;
                for (int k = 0; k < 3; k++) {
                    double share =
                        (double)sample_area2(&corner[(k + 1) % 3], &corner[(k + 2) % 3], &post) / (double)area2;
                    drawn_m += share * corner[k].height_m;
                    if (share < least) least = share;
                }
                double distance_m = fabs(drawn_m - (double)method_post_m(&made->tile, x, y));
                if (least >= 0 && distance_m > largest_m) largest_m = distance_m;
            }
        double measured_m = post_grid_error_m(&grid, &corner[0], &corner[1], &corner[2], INFINITY);
        CU_ASSERT_DOUBLE_EQUAL(measured_m, largest_m, 1e-6 * (1 + largest_m));
    }
    post_grid_release(&memory, &grid);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void level_ground_becomes_large_triangles(void) {
    static float level_m[33 * 33];
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 32, .rows = 32, .given_heights_m = level_m});
    struct result result =
        run(&made->tile, &(struct method_lindstrom_turk_options){.is_bounded = true, .tolerance_m = 1});
    CU_ASSERT(result.verdict.is_triangulation);
    CU_ASSERT_EQUAL(result.verdict.max_m, 0);
    CU_ASSERT(result.mesh.triangle_count <= 8);
    finish(&result);
    made_method_tile_free(made);
}

static void a_tile_without_posts_inside_is_a_fan(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 1, .rows = 40, .border_tolerance_m = 2});
    struct result result = run(&made->tile, &(struct method_lindstrom_turk_options){.edges = 1});
    CU_ASSERT(result.verdict.is_triangulation);
    finish(&result);
    made_method_tile_free(made);
}

/* An edge of a border line that is free goes too; corners and sides stay. */
static void free_borders_are_simplified_with_the_rest(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 64, .rows = 64});
    struct method_lindstrom_turk_options options = {.edges = 1500, .free_borders = true};
    struct scree_memory memory = {0};
    struct method_mesh mesh;
    double area2 = 0;
    int on_border = 0, corners = 0;
    CU_ASSERT_EQUAL_FATAL(method_lindstrom_turk(&memory, &made->tile, &options, &mesh, NULL), SCREE_OK);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        const struct method_vertex *a = &mesh.vertices[mesh.corners[3 * t]];
        const struct method_vertex *b = &mesh.vertices[mesh.corners[3 * t + 1]];
        const struct method_vertex *c = &mesh.vertices[mesh.corners[3 * t + 2]];
        double own2 = (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
        CU_ASSERT(own2 > 0);
        area2 += own2;
    }
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        bool column = mesh.vertices[v].x == 0 || mesh.vertices[v].x == 64;
        bool row = mesh.vertices[v].y == 0 || mesh.vertices[v].y == 64;
        on_border += column || row;
        corners += column && row;
    }
    CU_ASSERT_EQUAL(area2, 2 * 64.0 * 64.0);
    CU_ASSERT_EQUAL(corners, 4);
    CU_ASSERT(on_border > 8 && on_border < 4 * 64 / 2);
    CU_ASSERT_EQUAL(edges_of(&mesh), 3 * mesh.vertex_count - 3 - (uint32_t)on_border);
    method_mesh_release(&memory, &mesh);
    made_method_tile_free(made);
}

/* With a weight on lengths level ground keeps vertices too: that is how the globe stays round where it is smooth. */
static void the_shape_weight_keeps_vertices_on_level_ground(void) {
    static float heights_m[65 * 65];
    const struct fractal fractal = {.seed = 7};
    fractal_window(&fractal, 0, 0, 65, 65, heights_m, 65);
    for (int i = 0; i < 65 * 65; i++)
        if (i % 65 < 32) heights_m[i] = heights_m[i / 65 * 65 + 32];
    struct made_method_tile *made = made_method_tile_new(
        &(struct method_recipe){.columns = 64, .rows = 64, .border_tolerance_m = 20, .given_heights_m = heights_m});
    int on_level[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        const struct method_lindstrom_turk_options options = {.edges = 1500, .weights = {0.5, 0.5, i == 0 ? 0 : 0.01}};
        struct result result = run(&made->tile, &options);
        CU_ASSERT(result.verdict.is_triangulation);
        for (uint32_t v = 0; v < result.mesh.vertex_count; v++) on_level[i] += result.mesh.vertices[v].x < 30;
        finish(&result);
    }
    CU_ASSERT(on_level[1] > 3 * on_level[0] / 2);
    made_method_tile_free(made);
}

static void the_boundary_weight_spares_the_border(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 64, .rows = 64});
    uint32_t on_border[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        struct method_lindstrom_turk_options options = {
            .edges = 1500, .free_borders = true, .weights = {0.5, i == 0 ? 0.5 : 50, 0}};
        struct scree_memory memory = {0};
        struct method_mesh mesh;
        CU_ASSERT_EQUAL_FATAL(method_lindstrom_turk(&memory, &made->tile, &options, &mesh, NULL), SCREE_OK);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            on_border[i] += fmod(mesh.vertices[v].x, 64) == 0 || fmod(mesh.vertices[v].y, 64) == 0;
        method_mesh_release(&memory, &mesh);
    }
    CU_ASSERT(on_border[1] > on_border[0] + on_border[0] / 4);
    made_method_tile_free(made);
}

static void codes_stay_positive(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 64, .rows = 64, .border_tolerance_m = 5, .seed = 3});
    /* of a far larger frame, four codes a cell: rounding turns triangles over if nobody looks */
    const int64_t span = 64 * POSITION_TOP / 256;
    struct method_lindstrom_turk_options options = {.edges = 3000};
    int turned[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        options.codes.span = i == 0 ? 0 : span;
        struct result result = run(&made->tile, &options);
        for (uint32_t t = 0; t < result.mesh.triangle_count; t++) {
            struct sample code[3];
            for (int k = 0; k < 3; k++) {
                const struct method_vertex *v = &result.mesh.vertices[result.mesh.corners[3 * t + (uint32_t)k]];
                code[k] = (struct sample){(int32_t)floor(v->x * POSITION_TOP / (double)span + 0.5),
                                          (int32_t)floor(v->y * POSITION_TOP / (double)span + 0.5), 0};
            }
            turned[i] += sample_area2(&code[0], &code[1], &code[2]) <= 0;
        }
        finish(&result);
    }
    CU_ASSERT(turned[0] > 0);
    CU_ASSERT_EQUAL(turned[1], 0);
    made_method_tile_free(made);
}

static void the_same_tile_gives_the_same_mesh(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 48, .rows = 64, .border_tolerance_m = 5});
    struct method_lindstrom_turk_options options = {.is_bounded = true, .tolerance_m = 8};
    struct result one = run(&made->tile, &options), other = run(&made->tile, &options);
    CU_ASSERT(method_meshes_equal(&one.mesh, &other.mesh));
    finish(&other);
    finish(&one);
    made_method_tile_free(made);
}

static void what_makes_no_sense_is_refused(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 8, .rows = 8});
    static const struct method_lindstrom_turk_options bad[] = {
        {.edges = 0},
        {.tolerance_m = 5},
        {.is_bounded = true, .tolerance_m = -1, .edges = 10},
        {.is_bounded = true, .tolerance_m = NAN},
        {.edges = 10, .weights = {-1, 1, 1}},
        {.edges = 10, .weights = {NAN, 1, 1}},
        {.edges = 10, .weights = {1, 1, INFINITY}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct scree_memory memory = {0};
        struct method_mesh mesh;
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(method_lindstrom_turk(&memory, &made->tile, &bad[i], &mesh, &error), SCREE_E_ARGUMENT);
        CU_ASSERT(strlen(error.text) > 0 && mesh.vertices == NULL && memory.used_bytes == 0);
    }
    made_method_tile_free(made);
}

static void lack_of_memory_leaves_no_mesh(void) {
    struct made_method_tile *made =
        made_method_tile_new(&(struct method_recipe){.columns = 12, .rows = 12, .border_tolerance_m = 5});
    struct method_lindstrom_turk_options options = {.is_bounded = true, .tolerance_m = 8};
    enum scree_status status = SCREE_E_MEMORY;
    for (uint64_t n = 1; n < 100 && status != SCREE_OK; n++) {
        struct scree_memory memory = {.fail_request = n};
        struct method_mesh mesh;
        status = method_lindstrom_turk(&memory, &made->tile, &options, &mesh, NULL);
        CU_ASSERT(status == SCREE_OK || (status == SCREE_E_MEMORY && mesh.vertices == NULL));
        method_mesh_release(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    made_method_tile_free(made);
}

int suite_method_lindstrom_turk(void) {
    CU_pSuite suite = CU_add_suite("method_lindstrom_turk", NULL, NULL);
    CU_ADD_TEST(suite, a_plane_costs_nothing_and_keeps_its_vertices_on_it);
    CU_ADD_TEST(suite, the_volume_stays_the_same);
    CU_ADD_TEST(suite, costs_are_those_of_geometry);
    CU_ADD_TEST(suite, three_planes_that_do_not_meet_are_no_place);
    CU_ADD_TEST(suite, errors_are_those_of_brute_force);
    CU_ADD_TEST(suite, it_stops_at_a_number_of_edges);
    CU_ADD_TEST(suite, it_stops_at_an_error);
    CU_ADD_TEST(suite, level_ground_becomes_large_triangles);
    CU_ADD_TEST(suite, a_tile_without_posts_inside_is_a_fan);
    CU_ADD_TEST(suite, free_borders_are_simplified_with_the_rest);
    CU_ADD_TEST(suite, the_shape_weight_keeps_vertices_on_level_ground);
    CU_ADD_TEST(suite, the_boundary_weight_spares_the_border);
    CU_ADD_TEST(suite, codes_stay_positive);
    CU_ADD_TEST(suite, the_same_tile_gives_the_same_mesh);
    CU_ADD_TEST(suite, what_makes_no_sense_is_refused);
    CU_ADD_TEST(suite, lack_of_memory_leaves_no_mesh);
    return 0;
}
