/* Fitting: sums against brute force, and what is promised of a fitted mesh: the root mean square never grows, the bound
 * holds at every post, borders stay as the neighbours know them. */
#include "lod/fit.h"
#include "lod/fit_sums.h"
#include "lod/grid_error.h"
#include "lod/tile_fit.h"
#include "tests/fractal.h"
#include "tests/mesh_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNIT_M     0.0625
#define CELLS      64
#define ACROSS     (CELLS + 1)
#define CODES      ((struct code_frame){CELLS, 0, 0})
#define MAX_ACROSS (2 * CELLS + 1)

/* ---- tiles of a fractal field ---- */

struct field {
    struct scree_memory own, *memory;
    struct tile tile;
    float heights_m[MAX_ACROSS * MAX_ACROSS]; /* rows of `across` */
    int32_t across;
};

static struct tile_geometry geometry_of(int32_t cells, int32_t cell_span) {
    return (struct tile_geometry){
        .columns = cells, .rows = cells, .cell_span = cell_span, .height_unit_m = UNIT_M, .east_m = 30, .north_m = 25};
}

/* The tile of CELLS x CELLS cells whose south-western post is (x, y), at its full grid. `memory`: NULL for its own. */
static void make_field(struct scree_memory *memory, int64_t x, int64_t y, struct field *field) {
    static float wide_m[(ACROSS + 2) * (ACROSS + 2)];
    static double east_m[ACROSS], north_m[ACROSS];
    const struct fractal fractal = {.seed = 33};
    const struct tile_geometry geometry = geometry_of(CELLS, 1);
    memset(field, 0, sizeof *field);
    field->memory = memory != NULL ? memory : &field->own;
    field->across = ACROSS;
    fractal_window(&fractal, x - 1, y - 1, ACROSS + 2, ACROSS + 2, wide_m, ACROSS + 2);
    fractal_window(&fractal, x, y, ACROSS, ACROSS, field->heights_m, ACROSS);
    for (int i = 0; i < ACROSS; i++) {
        east_m[i] = 30;
        north_m[i] = 25;
    }
    const struct tile_posts posts = {wide_m + ACROSS + 2 + 1, ACROSS + 2, east_m, north_m};
    CU_ASSERT_EQUAL_FATAL(tile_from_posts(field->memory, &geometry, &posts, &field->tile, NULL), SCREE_OK);
}

static void advance(struct field *field, double tolerance_m) {
    tile_set_codes(&field->tile, CODES);
    CU_ASSERT_EQUAL_FATAL(tile_advance(&field->tile, tolerance_m, NULL), SCREE_OK);
}

static void finish(struct field *field) {
    tile_release(&field->tile);
    CU_ASSERT_EQUAL(field->memory->used_bytes, 0);
}

/* By the judge that shares no code with any simplifier. */
static struct grid_error judge(const struct field *field, const struct scree_mesh *mesh) {
    static double heights_m[MAX_ACROSS * MAX_ACROSS];
    struct scree_memory memory = {0};
    struct grid_error result = {0};
    for (uint32_t v = 0; v < mesh->vertex_count; v++) heights_m[v] = mesh->vertices[v].height * UNIT_M;
    CU_ASSERT_EQUAL_FATAL(grid_error_measure(field->heights_m, field->across, field->across, field->across, mesh,
                                             heights_m, &memory, &result, NULL),
                          SCREE_OK);
    return result;
}

static struct grid_error judge_working(const struct field *field, const struct mesh *mesh) {
    struct scree_memory memory = {0};
    struct scree_mesh copy;
    CU_ASSERT_EQUAL_FATAL(mesh_export_new(&memory, mesh, &copy, NULL), SCREE_OK);
    struct grid_error result = judge(field, &copy);
    scree_release(&memory, copy.corners);
    scree_release(&memory, copy.vertices);
    return result;
}

/* ---- sums ---- */

/* The sum over a mesh against one over all posts but those of the last row and column, each counted once. */
static void every_post_counts_once(void) {
    static struct field field;
    make_field(NULL, 0, 0, &field);
    struct mesh *mesh = &field.tile.mesh;
    advance(&field, 12);
    for (int32_t v = 0; v < mesh->vertex_count; v++) { /* away from their posts, which are on many triangles */
        mesh->heights[v] += v % 7;
        mesh->vertices[v].at.height_m = (float)(mesh->heights[v] * UNIT_M);
    }
    double sum_m2 = 0;
    for (int32_t y = 0; y < CELLS; y++)
        for (int32_t x = 0; x < CELLS; x++) {
            struct sample post = {x, y, field.heights_m[y * ACROSS + x]};
            for (int32_t t = 0; t < mesh->triangle_count; t++) {
                const int32_t *corner = mesh->triangles[t].vertex;
                if (corner[0] == MESH_NONE) continue;
                double share[3], drawn_m = 0, whole = 0, least = 0;
                for (int k = 0; k < 3; k++) {
                    share[k] = (double)sample_area2(&mesh->vertices[corner[(k + 1) % 3]].at,
                                                    &mesh->vertices[corner[(k + 2) % 3]].at, &post);
                    drawn_m += share[k] * mesh->vertices[corner[k]].at.height_m;
                    whole += share[k];
                    if (share[k] < least) least = share[k];
                }
                if (least < 0) continue;
                sum_m2 += (drawn_m / whole - post.height_m) * (drawn_m / whole - post.height_m);
                break;
            }
        }
    CU_ASSERT_DOUBLE_EQUAL(fit_sum_squares_m2(mesh, &field.tile.samples), sum_m2, 1e-6 * sum_m2);
    finish(&field);
}

/* Samples of cells, in and on the sides of them: raised and lowered by a metre all together, the second difference of
 * their sum of squares is twice their number. */
static void every_extreme_counts_once(void) {
    enum { SPAN = 4, SIDE = CELLS / SPAN, COUNT = 2 * SIDE * SIDE };
    static struct field field;
    static struct sample extremes[COUNT];
    const struct samples samples = {.columns = SIDE, .rows = SIDE, .cell_span = SPAN, .extremes = extremes};
    double sums_m2[3];
    make_field(NULL, 0, 0, &field);
    advance(&field, 12);
    for (int32_t i = 0; i < COUNT; i++) {
        int32_t cell = i / 2, x = cell % SIDE * SPAN + i % (SPAN + 1), y = cell / SIDE * SPAN + (i + cell) % (SPAN + 1);
        if (x == CELLS) x--; /* the eastern and the northern border belong to nobody */
        if (y == CELLS) y--;
        extremes[i] = (struct sample){x, y, field.heights_m[y * ACROSS + x] - 1};
    }
    for (int step = 0; step < 3; step++) {
        sums_m2[step] = fit_sum_squares_m2(&field.tile.mesh, &samples);
        for (int32_t i = 0; i < COUNT; i++) extremes[i].height_m += 1;
    }
    CU_ASSERT_DOUBLE_EQUAL(sums_m2[0] + sums_m2[2] - 2 * sums_m2[1], 2.0 * COUNT, 0.05);
    finish(&field);
}

static void sums_lead_to_the_best_height(void) {
    static float posts_m[9 * 9];
    struct samples samples = {.columns = 8, .rows = 8, .cell_span = 1, .posts = posts_m, .stride = 9};
    struct sample corner = {1, 2, 5}, b = {8, 1, 2}, c = {4, 7, -3};
    uint64_t random = 3;
    for (int i = 0; i < 81; i++) posts_m[i] = (float)any_number(&random, 1000) / 50;
    struct fit_sums sums = {0}, at_best = {0}, above = {0}, below = {0};
    fit_add_triangle(&samples, &corner, &b, &c, &sums);
    corner.height_m += (float)(sums.wr / sums.ww);
    fit_add_triangle(&samples, &corner, &b, &c, &at_best);
    CU_ASSERT_DOUBLE_EQUAL(at_best.wr, 0, 1e-4);
    CU_ASSERT_DOUBLE_EQUAL(at_best.rr_m2, sums.rr_m2 - sums.wr * sums.wr / sums.ww, 1e-4);
    double low_m = -INFINITY, high_m = INFINITY, limit_m = at_best.max_m + 0.5;
    fit_narrow(&samples, &corner, &b, &c, limit_m, &low_m, &high_m);
    CU_ASSERT_FATAL(low_m < 0 && high_m > 0);
    corner.height_m += (float)high_m;
    fit_add_triangle(&samples, &corner, &b, &c, &above);
    corner.height_m += (float)(low_m - high_m);
    fit_add_triangle(&samples, &corner, &b, &c, &below);
    CU_ASSERT_DOUBLE_EQUAL(above.max_m, limit_m, 1e-4);
    CU_ASSERT_DOUBLE_EQUAL(below.max_m, limit_m, 1e-4);
}

/* ---- fitted meshes ---- */

static void one_vertex_takes_the_height_of_least_squares(void) {
    static struct field field;
    struct scree_memory memory = {0};
    struct mesh mesh;
    memset(&field, 0, sizeof field);
    field.across = 9;
    double ww = 0, wz = 0;
    for (int32_t y = 0; y < 9; y++)
        for (int32_t x = 0; x < 9; x++) {
            double weight = 1 - fmax(abs(x - 4), abs(y - 4)) / 4.0;
            field.heights_m[y * 9 + x] = (float)(10 * weight * weight);
        }
    make_grid_mesh(&memory, 2, 2, 4, NULL, 0, &mesh);
    struct samples samples = {.columns = 8, .rows = 8, .cell_span = 1, .posts = field.heights_m, .stride = 9};
    for (int32_t v = 0; v < mesh.vertex_count; v++) mesh.vertices[v].at.height_m = 0;
    int32_t middle = 4;
    CU_ASSERT_FATAL(mesh.vertices[middle].at.x == 4 && mesh.vertices[middle].at.y == 4);
    for (int32_t t = 0; t < mesh.triangle_count; t++) { /* the weights as the triangles have them */
        const int32_t *corner = mesh.triangles[t].vertex;
        for (int k = 0; k < 3; k++)
            if (corner[k] == middle) {
                struct fit_sums sums = {0};
                fit_add_triangle(&samples, &mesh.vertices[middle].at, &mesh.vertices[corner[(k + 1) % 3]].at,
                                 &mesh.vertices[corner[(k + 2) % 3]].at, &sums);
                ww += sums.ww;
                wz += sums.wr;
            }
    }
    const struct fit_options options = {.tolerance_m = 100, .in_place = true, .keep_edges = true};
    CU_ASSERT_EQUAL(fit_mesh(&memory, &mesh, &samples, &options, NULL), SCREE_OK);
    CU_ASSERT_DOUBLE_EQUAL(mesh.vertices[middle].at.height_m, wz / ww, 1e-5);
    CU_ASSERT(mesh.vertices[middle].at.height_m > 1 && mesh.vertices[middle].at.height_m < 10);
    mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

struct case_of_fit {
    double tolerance_m;
    struct fit_options options;
    double share; /* of the unfitted root mean square: what is left at the most */
};

static void the_mean_falls_and_the_bound_holds(void) {
    static struct field field;
    static const struct case_of_fit cases[] = {
        {2, {.in_place = true, .keep_edges = true}, 0.96},
        {8, {.in_place = true, .keep_edges = true}, 0.92},
        {8, {.in_place = true}, 0.90},
        {8, {.thins = false}, 0.82},
        {8, {.thins = true}, 0.90},
        {30, {.thins = true}, 0.90},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        make_field(NULL, 0, 0, &field);
        advance(&field, cases[i].tolerance_m);
        struct mesh *mesh = &field.tile.mesh;
        struct grid_error before = judge_working(&field, mesh);
        int32_t triangles = mesh->live_triangles;
        struct fit_options options = cases[i].options;
        options.tolerance_m = cases[i].tolerance_m;
        options.height_unit_m = UNIT_M;
        options.codes = CODES;
        struct samples samples = tile_samples_written(&field.tile, CODES, options.tolerance_m);
        CU_ASSERT_EQUAL(fit_mesh(field.memory, mesh, &samples, &options, NULL), SCREE_OK);
        CU_ASSERT_PTR_NULL(mesh_fault(mesh, CELLS, CELLS));
        struct grid_error after = judge_working(&field, mesh);
        CU_ASSERT(before.covers && after.covers);
        CU_ASSERT(after.rms_m <= cases[i].share * before.rms_m);
        CU_ASSERT(after.max_m <= cases[i].tolerance_m + 1e-6);
        CU_ASSERT(options.thins ? mesh->live_triangles < triangles - triangles / 20
                                : mesh->live_triangles == triangles);
        finish(&field);
    }
}

/* A mesh that breaks the bound is not made worse. */
static void what_is_farther_than_the_bound_gets_no_farther(void) {
    static struct field field;
    make_field(NULL, 0, 0, &field);
    advance(&field, 30);
    struct grid_error before = judge_working(&field, &field.tile.mesh);
    const struct fit_options options = {.tolerance_m = 1, .height_unit_m = UNIT_M};
    CU_ASSERT_EQUAL(fit_mesh(field.memory, &field.tile.mesh, &field.tile.samples, &options, NULL), SCREE_OK);
    struct grid_error after = judge_working(&field, &field.tile.mesh);
    CU_ASSERT(after.covers && after.rms_m < 0.9 * before.rms_m && after.max_m <= before.max_m + 1e-6);
    finish(&field);
}

static void places_and_edges_stay_if_they_are_to(void) {
    static struct field field;
    struct mesh copy;
    make_field(NULL, 0, 0, &field);
    advance(&field, 10);
    struct mesh *mesh = &field.tile.mesh;
    copy_mesh(field.memory, mesh, &copy);
    struct fit_options options = {.tolerance_m = 10, .height_unit_m = UNIT_M, .in_place = true, .keep_edges = true};
    CU_ASSERT_EQUAL(fit_mesh(field.memory, mesh, &field.tile.samples, &options, NULL), SCREE_OK);
    int other_heights = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        CU_ASSERT(mesh->vertices[v].at.x == copy.vertices[v].at.x && mesh->vertices[v].at.y == copy.vertices[v].at.y);
        other_heights += mesh->heights[v] != copy.heights[v];
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        CU_ASSERT_EQUAL(memcmp(mesh->triangles[t].vertex, copy.triangles[t].vertex, sizeof copy.triangles[t].vertex),
                        0);
    CU_ASSERT(other_heights > mesh->live_vertices / 2);
    /* vertices of the lattice's corners stay when all the others may go or move */
    options = (struct fit_options){.tolerance_m = 10, .height_unit_m = UNIT_M, .thins = true, .locked_step = 2};
    CU_ASSERT_EQUAL(fit_mesh(field.memory, mesh, &field.tile.samples, &options, NULL), SCREE_OK);
    int locked = 0;
    for (int32_t v = 0; v < copy.vertex_count; v++) {
        const struct sample *at = &copy.vertices[v].at, *now = &mesh->vertices[v].at;
        if (copy.vertices[v].edge == MESH_NONE || at->x % 2 != 0 || at->y % 2 != 0) continue;
        CU_ASSERT(mesh->vertices[v].edge != MESH_NONE && now->x == at->x && now->y == at->y);
        locked++;
    }
    CU_ASSERT(locked > 20 && mesh->live_vertices < copy.live_vertices);
    mesh_release(field.memory, &copy);
    finish(&field);
}

/* ---- tiles ---- */

static struct scree_vertex on_line(const struct scree_mesh *mesh, bool upright, int32_t line, int32_t position) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const struct scree_vertex *vertex = &mesh->vertices[v];
        if ((upright ? vertex->x : vertex->y) == line && (upright ? vertex->y : vertex->x) == position) return *vertex;
    }
    return (struct scree_vertex){-1, -1, INT32_MIN};
}

static void neighbours_agree(void) {
    static struct field west, east;
    struct fitted_tile fitted[2];
    int kept = 0;
    make_field(NULL, 0, 0, &west);
    make_field(NULL, CELLS, 0, &east);
    advance(&west, 6);
    advance(&east, 6);
    CU_ASSERT_EQUAL_FATAL(tile_fit_new(&west.tile, CODES, 6, &fitted[0], NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_fit_new(&east.tile, CODES, 6, &fitted[1], NULL), SCREE_OK);
    for (int32_t y = 0; y <= CELLS; y++) {
        struct scree_vertex one = on_line(&fitted[0].mesh, true, CELLS, y),
                            other = on_line(&fitted[1].mesh, true, 0, y);
        CU_ASSERT_EQUAL(one.height, other.height);
        CU_ASSERT_EQUAL(one.height != INT32_MIN, border_keeps(&west.tile.lines[SIDE_EAST], y));
        kept += one.height != INT32_MIN;
    }
    CU_ASSERT(kept > 5 && kept < CELLS / 2);
    struct grid_error error = judge(&west, &fitted[0].mesh);
    CU_ASSERT(error.covers && error.max_m <= 6 + 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(error.max_m, fitted[0].max_error_m, 1e-4);
    CU_ASSERT(fitted[0].mesh.vertex_count < (uint32_t)west.tile.mesh.live_vertices);
    fitted_tile_release(west.memory, &fitted[0]);
    fitted_tile_release(east.memory, &fitted[1]);
    finish(&east);
    finish(&west);
}

/* A parent's fitted mesh is the union of its children's, and knows their errors at every post. */
static void parents_are_the_union_of_their_children(void) {
    static struct field children[4], parent;
    struct scree_memory memory = {0};
    struct coarse_tile *coarse[4];
    struct fitted_tile fitted;
    const double tolerance_m = 9;
    const struct fractal fractal = {.seed = 33};
    memset(&parent, 0, sizeof parent);
    parent.across = MAX_ACROSS;
    fractal_window(&fractal, 0, 0, MAX_ACROSS, MAX_ACROSS, parent.heights_m, MAX_ACROSS);
    for (int i = 0; i < 4; i++) {
        const struct code_frame codes = {2 * CELLS, i % 2 * CELLS, i / 2 * CELLS};
        make_field(&memory, i % 2 * CELLS, i / 2 * CELLS, &children[i]);
        struct tile *tile = &children[i].tile;
        tile_set_codes(tile, codes);
        CU_ASSERT_EQUAL_FATAL(tile_advance(tile, tolerance_m, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_fit_new(tile, codes, tolerance_m, &tile->rest->fitted, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(tile, &coarse[i], NULL), SCREE_OK);
    }
    const struct tile_geometry geometry = geometry_of(2 * CELLS, 2);
    const struct coarse_tile *const all[4] = {coarse[0], coarse[1], coarse[2], coarse[3]};
    CU_ASSERT_EQUAL_FATAL(tile_from_children(&memory, &geometry, all, &parent.tile, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_fit_join_new(&parent.tile, all, &fitted, NULL), SCREE_OK);
    struct grid_error error = judge(&parent, &fitted.mesh);
    CU_ASSERT(error.covers);
    CU_ASSERT(error.max_m <= tolerance_m + 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(error.max_m, fitted.max_error_m, 1e-4);
    CU_ASSERT(fitted.mmqe_m2 > 0);
    uint32_t triangles = 0;
    for (int i = 0; i < 4; i++) triangles += coarse[i]->fitted.mesh.triangle_count;
    CU_ASSERT_EQUAL(fitted.mesh.triangle_count, triangles);
    for (int32_t i = 0; i <= 2 * CELLS; i++) /* the border is that of the unfitted tile */
        CU_ASSERT_EQUAL(on_line(&fitted.mesh, true, 0, i).height != INT32_MIN,
                        border_keeps(&parent.tile.lines[SIDE_WEST], i));
    fitted_tile_release(&memory, &fitted);
    tile_release(&parent.tile);
    for (int i = 0; i < 4; i++) {
        coarse_tile_free(&memory, coarse[i]);
        tile_release(&children[i].tile);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void the_tile_itself_stays(void) {
    static struct field field;
    struct fitted_tile one, other;
    struct mesh copy;
    make_field(NULL, 0, 0, &field);
    advance(&field, 6);
    copy_mesh(field.memory, &field.tile.mesh, &copy);
    CU_ASSERT_EQUAL_FATAL(tile_fit_new(&field.tile, CODES, 6, &one, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_fit_new(&field.tile, CODES, 6, &other, NULL), SCREE_OK);
    CU_ASSERT(same_meshes(&copy, &field.tile.mesh));
    CU_ASSERT_EQUAL_FATAL(one.mesh.vertex_count, other.mesh.vertex_count);
    CU_ASSERT_EQUAL(memcmp(one.mesh.vertices, other.mesh.vertices, one.mesh.vertex_count * sizeof *one.mesh.vertices),
                    0);
    mesh_release(field.memory, &copy);
    fitted_tile_release(field.memory, &other);
    fitted_tile_release(field.memory, &one);
    finish(&field);
}

static void lack_of_memory_leaves_nothing_fitted(void) {
    static struct field field;
    struct fitted_tile fitted;
    make_field(NULL, 0, 0, &field);
    advance(&field, 20);
    size_t used_bytes = field.memory->used_bytes;
    enum scree_status status = SCREE_E_MEMORY;
    int failures = 0;
    for (uint64_t n = 1; n < 200 && status != SCREE_OK; n++) {
        field.memory->fail_request = field.memory->requests + n;
        status = tile_fit_new(&field.tile, CODES, 20, &fitted, NULL);
        CU_ASSERT(status == SCREE_OK || (status == SCREE_E_MEMORY && fitted.mesh.vertices == NULL));
        failures += status != SCREE_OK;
        fitted_tile_release(field.memory, &fitted);
        CU_ASSERT_EQUAL(field.memory->used_bytes, used_bytes);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT(failures > 10);
    finish(&field);
}

int suite_fit(void) {
    CU_pSuite suite = CU_add_suite("fit", NULL, NULL);
    CU_ADD_TEST(suite, every_post_counts_once);
    CU_ADD_TEST(suite, every_extreme_counts_once);
    CU_ADD_TEST(suite, sums_lead_to_the_best_height);
    CU_ADD_TEST(suite, one_vertex_takes_the_height_of_least_squares);
    CU_ADD_TEST(suite, the_mean_falls_and_the_bound_holds);
    CU_ADD_TEST(suite, what_is_farther_than_the_bound_gets_no_farther);
    CU_ADD_TEST(suite, places_and_edges_stay_if_they_are_to);
    CU_ADD_TEST(suite, neighbours_agree);
    CU_ADD_TEST(suite, parents_are_the_union_of_their_children);
    CU_ADD_TEST(suite, the_tile_itself_stays);
    CU_ADD_TEST(suite, lack_of_memory_leaves_nothing_fitted);
    return 0;
}
