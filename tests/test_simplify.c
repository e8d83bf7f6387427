/* The collapse: errors against brute force, the bound against the judge that shares no code with it, and what else is
 * promised to the tiles. */
#include "lod/code_collapse.h"
#include "lod/compact.h"
#include "lod/grid_error.h"
#include "lod/merge.h"
#include "lod/quadric.h"
#include "lod/simplify.h"
#include "tests/fractal.h"
#include "tests/mesh_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- errors of triangles ---- */

static bool is_inside(const struct sample *a, const struct sample *b, const struct sample *c, const struct sample *p) {
    return sample_area2(a, b, p) >= 0 && sample_area2(b, c, p) >= 0 && sample_area2(c, a, p) >= 0;
}

/* The distance of a sample from the triangle, by barycentric weights. */
static double distance_m(const struct sample corner[3], const struct sample *p, struct drop drop) {
    double whole = (double)sample_area2(&corner[0], &corner[1], &corner[2]), drawn_m = 0;
    for (int i = 0; i < 3; i++) {
        double share = (double)sample_area2(&corner[(i + 1) % 3], &corner[(i + 2) % 3], p) / whole;
        drawn_m += share * sample_drawn_m(&corner[i], &corner[0], drop);
    }
    return fabs(sample_drawn_m(p, &corner[0], drop) - drawn_m);
}

static void add_distance(const struct sample corner[3], const struct sample *p, struct drop drop, double *max_m,
                         double *sum_m2) {
    if (!is_inside(&corner[0], &corner[1], &corner[2], p)) return;
    double size_m = distance_m(corner, p, drop);
    *max_m = fmax(*max_m, size_m);
    *sum_m2 += size_m * size_m;
}

static void brute_force(const struct samples *samples, const struct sample corner[3], double *max_m, double *sum_m2) {
    struct drop drop = samples_drop(samples, ((double)corner[0].y + corner[1].y + corner[2].y) / 3);
    *max_m = *sum_m2 = 0;
    if (samples->posts != NULL) {
        for (int32_t y = 0; y <= samples->rows; y++)
            for (int32_t x = 0; x <= samples->columns; x++) {
                struct sample post = {x, y, samples->posts[y * samples->stride + x]};
                add_distance(corner, &post, drop, max_m, sum_m2);
            }
        return;
    }
    for (int32_t i = 0; i < 2 * samples->columns * samples->rows; i++)
        add_distance(corner, &samples->extremes[i], drop, max_m, sum_m2);
}

static struct sample any_corner(const struct samples *samples, int32_t columns, int32_t rows, uint64_t *random) {
    struct sample at = {any_number(random, columns + 1), any_number(random, rows + 1), 0};
    at.height_m =
        samples->posts != NULL ? samples->posts[at.y * samples->stride + at.x] : (float)any_number(random, 2000) / 4;
    return at;
}

/* Triangles of all sizes over a window of columns x rows steps, a third of them with a level or an upright edge. */
static void compare_triangles(const struct samples *samples, int32_t columns, int32_t rows, uint64_t random) {
    int measured = 0;
    double max_m, sum_m2;
    for (int tries = 0; tries < 4000; tries++) {
        struct sample corner[3];
        for (int i = 0; i < 3; i++) corner[i] = any_corner(samples, columns, rows, &random);
        if (samples->posts == NULL && tries % 6 == 0) corner[1].y = corner[0].y;
        if (samples->posts == NULL && tries % 6 == 1) corner[1].x = corner[0].x;
        int64_t area2 = sample_area2(&corner[0], &corner[1], &corner[2]);
        if (area2 < 0) {
            struct sample first = corner[0];
            corner[0] = corner[1];
            corner[1] = first;
        }
        if (area2 == 0) continue;
        struct triangle_error error = samples_triangle_error(samples, &corner[0], &corner[1], &corner[2]);
        brute_force(samples, corner, &max_m, &sum_m2);
        if (fabs(error.max_m - max_m) > 1e-4 + 1e-6 * max_m ||
            fabs(error.sum_squares_m2 - sum_m2) > 1e-2 + 1e-5 * sum_m2)
            printf("\n    (%d, %d) (%d, %d) (%d, %d): %g m, %g m2; brute force %g, %g\n", corner[0].x, corner[0].y,
                   corner[1].x, corner[1].y, corner[2].x, corner[2].y, error.max_m, error.sum_squares_m2, max_m,
                   sum_m2);
        CU_ASSERT_DOUBLE_EQUAL_FATAL(error.max_m, max_m, 1e-4 + 1e-6 * max_m);
        CU_ASSERT_DOUBLE_EQUAL_FATAL(error.sum_squares_m2, sum_m2, 1e-2 + 1e-5 * sum_m2);
        measured++;
    }
    CU_ASSERT(measured > 3000);
}

#define ACROSS 41
#define UP     34

static void errors_at_posts_are_those_of_brute_force(void) {
    float posts[ACROSS * UP], east_drop_m[UP];
    uint64_t random = 11;
    for (int i = 0; i < ACROSS * UP; i++) posts[i] = (float)any_number(&random, 8000) / 8;
    for (int i = 0; i < UP; i++) east_drop_m[i] = 0.1f + 0.02f * (float)i;
    struct samples samples = {.columns = ACROSS - 1, .rows = UP - 1, .cell_span = 1, .posts = posts, .stride = ACROSS};
    compare_triangles(&samples, ACROSS - 1, UP - 1, 1);
    samples.east_drop_m = east_drop_m;
    samples.north_drop_m = 0.3f;
    compare_triangles(&samples, ACROSS - 1, UP - 1, 2);
}

/* Two samples a cell, anywhere in the closed cell; the last cells are cut by the window. */
static void fill_extremes(struct sample *extremes, int32_t cells_x, int32_t cells_y, int32_t span, int32_t columns,
                          int32_t rows, uint64_t random) {
    for (int32_t i = 0; i < 2 * cells_x * cells_y; i++) {
        int32_t x = i / 2 % cells_x * span + any_number(&random, span + 1);
        int32_t y = i / 2 / cells_x * span + any_number(&random, span + 1);
        extremes[i] =
            (struct sample){x < columns ? x : columns, y < rows ? y : rows, (float)any_number(&random, 2000) / 4};
    }
}

static void errors_at_extremes_are_those_of_brute_force(void) {
    enum { CELLS_X = 12, CELLS_Y = 9 };
    static const int32_t spans[] = {2, 4, 16, 1024};
    struct sample extremes[2 * CELLS_X * CELLS_Y];
    float east_drop_m[CELLS_Y + 1];
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++)
        for (int32_t cut = 0; cut < 2; cut++) {
            int32_t columns = CELLS_X * spans[i] - cut, rows = CELLS_Y * spans[i] - cut;
            double step = 4.0 / (double)spans[i];
            fill_extremes(extremes, CELLS_X, CELLS_Y, spans[i], columns, rows, 5 + i);
            for (int32_t row = 0; row <= CELLS_Y; row++) east_drop_m[row] = (float)((0.2 + 0.1 * row) * step * step);
            struct samples samples = {.columns = CELLS_X, .rows = CELLS_Y, .cell_span = spans[i], .extremes = extremes};
            compare_triangles(&samples, columns, rows, 3 + i);
            samples.east_drop_m = east_drop_m;
            samples.north_drop_m = (float)(0.5 * step * step);
            compare_triangles(&samples, columns, rows, 30 + i);
        }
}

static void rounded_positions_cost_by_the_slope(void) {
    float posts[9] = {0, 2, 4, 5, 7, 9, 10, 12, 14}; /* 2 m a step east, 5 m north */
    struct samples samples = {.columns = 2,
                              .rows = 2,
                              .cell_span = 1,
                              .posts = posts,
                              .stride = 3,
                              .rounding_steps = 0.25f,
                              .rounding_limit_m = 1e9f};
    struct sample a = {0, 0, 0}, b = {2, 0, 4}, c = {0, 2, 10};
    CU_ASSERT_DOUBLE_EQUAL(samples_triangle_error(&samples, &a, &b, &c).max_m, 0.25 * (2 + 5), 1e-6);
    CU_ASSERT_DOUBLE_EQUAL(samples_triangle_error(&samples, &a, &b, &c).sum_squares_m2, 0, 1e-6);
}

/* ---- the queue ---- */

static void the_queue_is_first_in_first_out_by_classes(void) {
    struct scree_memory memory = {0};
    struct queue queue = {0};
    CU_ASSERT_EQUAL_FATAL(queue_allocate(&memory, 6, &queue, NULL), SCREE_OK);
    queue_reset(&queue, 2);
    CU_ASSERT_EQUAL(queue_class(&queue, 0), 0);
    CU_ASSERT_EQUAL(queue_class(&queue, -5), 0);
    CU_ASSERT_EQUAL(queue_class(&queue, 1.99f), 0);
    CU_ASSERT_EQUAL(queue_class(&queue, 2), 1);
    CU_ASSERT_EQUAL(queue_class(&queue, 4), 2);
    CU_ASSERT_EQUAL(queue_class(&queue, INFINITY), QUEUE_CLASSES - 1);
    CU_ASSERT_EQUAL(queue_class(&queue, NAN), QUEUE_CLASSES - 1);
    queue_push(&queue, 4, 7);
    queue_push(&queue, 1, 2);
    queue_push(&queue, 5, 2);
    queue_push(&queue, 0, 2);
    CU_ASSERT_EQUAL(queue_pop(&queue), 1);
    CU_ASSERT_EQUAL(queue_class(&queue, 0), 2); /* classes that are done do not come back */
    queue_push(&queue, 3, 2);
    CU_ASSERT_EQUAL(queue_pop(&queue), 5);
    CU_ASSERT_EQUAL(queue_pop(&queue), 0);
    CU_ASSERT_EQUAL(queue_pop(&queue), 3);
    CU_ASSERT_EQUAL(queue_pop(&queue), 4);
    CU_ASSERT_EQUAL(queue_pop(&queue), QUEUE_NONE);
    CU_ASSERT_EQUAL(queue_pop(&queue), QUEUE_NONE);
    queue_reset(&queue, 0); /* a tolerance of 0 */
    CU_ASSERT_EQUAL(queue_class(&queue, 1), QUEUE_CLASSES - 1);
    CU_ASSERT_EQUAL(queue_pop(&queue), QUEUE_NONE);
    queue_release(&memory, &queue);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- a tile's interior ---- */

#define CELLS 128
#define SIDE  (CELLS + 1)

/* A fractal of whole metres as a full grid, ready to be simplified. */
struct field {
    struct scree_memory memory;
    float posts[SIDE * SIDE];
    struct mesh mesh;
    struct samples samples;
    struct simplifier simplifier;
};

static void start_simplifier(struct field *field, const struct simplify_options *options) {
    mesh_measure(&field->mesh, &field->samples);
    CU_ASSERT_EQUAL_FATAL(
        simplifier_start(&field->memory, &field->mesh, &field->samples, options, &field->simplifier, NULL), SCREE_OK);
}

static void start_field(struct field *field, uint64_t seed, const struct simplify_options *options) {
    struct fractal fractal = {seed, true};
    memset(field, 0, sizeof *field);
    fractal_window(&fractal, 5000, 7000, SIDE, SIDE, field->posts, SIDE);
    make_grid_mesh(&field->memory, CELLS, CELLS, 1, field->posts, SIDE, &field->mesh);
    field->samples =
        (struct samples){.columns = CELLS, .rows = CELLS, .cell_span = 1, .posts = field->posts, .stride = SIDE};
    start_simplifier(field, options);
}

static void end_field(struct field *field) {
    simplifier_release(&field->simplifier);
    mesh_release(&field->memory, &field->mesh);
    CU_ASSERT_EQUAL(field->memory.used_bytes, 0);
}

static struct grid_error judge(struct field *field) {
    struct scree_mesh copy;
    struct grid_error result;
    CU_ASSERT_EQUAL_FATAL(mesh_export_new(&field->memory, &field->mesh, &copy, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(
        grid_error_measure(field->posts, SIDE, SIDE, SIDE, &copy, NULL, &field->memory, &result, NULL), SCREE_OK);
    scree_release(&field->memory, copy.corners);
    scree_release(&field->memory, copy.vertices);
    return result;
}

static void the_bound_holds_exactly(void) {
    static struct field field;
    static const float tolerances_m[] = {1, 2, 5, 10, 40, 150};
    const struct simplify_options options = {0};
    for (uint64_t seed = 1; seed <= 3; seed++) {
        start_field(&field, seed, &options);
        for (size_t i = 0; i < sizeof tolerances_m / sizeof *tolerances_m; i++) {
            int32_t before = field.mesh.live_vertices;
            simplify_interior(&field.simplifier, tolerances_m[i]);
            struct grid_error result = judge(&field);
            CU_ASSERT(result.max_m <= (double)tolerances_m[i]); /* exactly: no slack for rounding */
            CU_ASSERT_TRUE(result.covers);
            CU_ASSERT_DOUBLE_EQUAL(mesh_max_error_m(&field.mesh, &field.samples), result.max_m, 1e-4);
            CU_ASSERT_PTR_NULL(mesh_fault(&field.mesh, CELLS, CELLS));
            CU_ASSERT(field.mesh.live_vertices < before);
        }
        CU_ASSERT(field.mesh.live_vertices < SIDE * SIDE / 10);
        end_field(&field);
    }
}

/* The errors that triangles carry, from which growths are told, are those that measuring anew gives. */
static void carried_errors_are_true(void) {
    static struct field field;
    const struct simplify_options options = {0};
    struct mesh fresh;
    start_field(&field, 4, &options);
    simplify_interior(&field.simplifier, 3);
    simplify_interior(&field.simplifier, 12);
    copy_mesh(&field.memory, &field.mesh, &fresh);
    mesh_measure(&fresh, &field.samples);
    for (int32_t t = 0; t < fresh.triangle_count; t++) {
        if (fresh.triangles[t].vertex[0] == MESH_NONE) continue;
        CU_ASSERT_EQUAL(fresh.triangles[t].max_m, field.mesh.triangles[t].max_m);
        CU_ASSERT_EQUAL(fresh.triangles[t].sum_squares_m2, field.mesh.triangles[t].sum_squares_m2);
    }
    mesh_release(&field.memory, &fresh);
    end_field(&field);
}

/* Nothing that could go within the tolerance is forgotten: a second call at the same one finds nothing. */
static void a_rung_is_used_up(void) {
    static struct field field;
    const struct simplify_options options = {0};
    start_field(&field, 5, &options);
    simplify_interior(&field.simplifier, 8);
    int32_t live_vertices = field.mesh.live_vertices;
    simplify_interior(&field.simplifier, 8);
    CU_ASSERT(live_vertices - field.mesh.live_vertices <= live_vertices / 200);
    end_field(&field);
}

static void level_ground_leaves_its_border_and_small_stars(void) {
    static struct field field;
    const struct simplify_options options = {0};
    start_field(&field, 1, &options);
    for (int i = 0; i < SIDE * SIDE; i++) field.posts[i] = 7;
    for (int32_t v = 0; v < field.mesh.vertex_count; v++) field.mesh.vertices[v].at.height_m = 7;
    mesh_measure(&field.mesh, &field.samples);
    simplify_interior(&field.simplifier, 0);
    CU_ASSERT(field.mesh.live_vertices < 4 * CELLS + 40);
    CU_ASSERT_PTR_NULL(mesh_fault(&field.mesh, CELLS, CELLS));
    for (int32_t v = 0; v < field.mesh.vertex_count; v++) {
        const struct mesh_vertex *vertex = &field.mesh.vertices[v];
        bool on_border = vertex->at.x % CELLS == 0 || vertex->at.y % CELLS == 0;
        if (on_border) CU_ASSERT_NOT_EQUAL(vertex->edge, MESH_NONE);
        if (vertex->edge != MESH_NONE) CU_ASSERT(mesh_degree(&field.mesh, v) <= 48);
    }
    end_field(&field);
}

static void locked_vertices_stay(void) {
    static struct field field;
    const struct simplify_options options = {.locked_step = 32};
    start_field(&field, 6, &options);
    simplify_interior(&field.simplifier, 1e6f);
    for (int32_t v = 0; v < field.mesh.vertex_count; v++) {
        const struct sample *at = &field.mesh.vertices[v].at;
        if (at->x % 32 == 0 && at->y % 32 == 0) CU_ASSERT_NOT_EQUAL(field.mesh.vertices[v].edge, MESH_NONE);
    }
    CU_ASSERT(field.mesh.live_vertices < SIDE * SIDE / 10);
    end_field(&field);
}

/* ---- position codes ---- */

static void codes_are_rounded_to_nearest(void) {
    CU_ASSERT_EQUAL(position_code(0, 1 << 20), 0);
    CU_ASSERT_EQUAL(position_code(1 << 20, 1 << 20), 32767);
    CU_ASSERT_EQUAL(position_code(INT64_C(1) << 30, INT64_C(1) << 30), 32767);
    CU_ASSERT_EQUAL(position_code(1, 2 * 32767), 1); /* a half goes up */
    CU_ASSERT_EQUAL(position_code(5, 10 * 32767), 1);
    CU_ASSERT_EQUAL(position_code(4, 10 * 32767), 0);
    const struct code_frame fine = {32767, 0, 0}, coarse = {1 << 18, 0, 0};
    struct sample a = {0, 0, 0}, b = {8, 0, 0}, near = {1, 2, 0}, far = {1, 8, 0};
    CU_ASSERT_TRUE(codes_positive(&fine, &a, &b, &near));
    CU_ASSERT_FALSE(codes_positive(&coarse, &a, &b, &near)); /* its three codes are on a line */
    CU_ASSERT_TRUE(codes_positive(&coarse, &a, &b, &far));
    CU_ASSERT_FALSE(codes_positive(&coarse, &a, &far, &b));
    CU_ASSERT_FALSE(codes_positive(&fine, &a, &a, &b));

    /* Of a tile of 2048 steps: codes are sixteen times finer than the lattice, and turn this needle over. */
    const struct code_frame finer = {2048, 0, 0}, none = {0};
    const struct sample low = {1024, 256, 0}, middle = {1039, 273, 0}, high = {1068, 306, 0}, beside = {1068, 307, 0};
    CU_ASSERT_TRUE(codes_positive(&none, &low, &middle, &high));
    CU_ASSERT_FALSE(codes_positive(&finer, &low, &middle, &high));
    CU_ASSERT_TRUE(codes_positive(&finer, &low, &middle, &beside));
}

static int32_t flat_in_codes(const struct mesh *mesh, const struct code_frame *frame) {
    int32_t count = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        struct sample code[3];
        if (mesh->triangles[t].vertex[0] == MESH_NONE) continue;
        for (int i = 0; i < 3; i++) {
            const struct sample *at = &mesh->vertices[mesh->triangles[t].vertex[i]].at;
            code[i].x = position_code((int64_t)at->x + frame->x, frame->span);
            code[i].y = position_code((int64_t)at->y + frame->y, frame->span);
        }
        count += sample_area2(&code[0], &code[1], &code[2]) <= 0;
    }
    return count;
}

/* Inner vertices 10 steps apart, each shifted by up to 2; a code has 8 steps, so triangles fall flat in codes. */
static void triangles_become_positive_in_codes(void) {
    enum { STEP = 10 };
    static struct field field;
    struct sample extremes[2] = {{0, 0, 0}, {0, 0, 0}};
    static const struct code_frame frames[] = {{1 << 18, 0, 0}, {1 << 18, 1 << 17, 0}, {1 << 18, 1 << 17, 1 << 17}};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        struct simplify_options options = {.codes = frames[i]};
        uint64_t random = 8;
        memset(&field, 0, sizeof field);
        make_grid_mesh(&field.memory, CELLS, CELLS, STEP, NULL, 0, &field.mesh);
        for (int32_t v = 0; v < field.mesh.vertex_count; v++) {
            struct sample *at = &field.mesh.vertices[v].at;
            if (at->x % (CELLS * STEP) == 0 || at->y % (CELLS * STEP) == 0) continue;
            at->x += any_number(&random, 5) - 2;
            at->y += any_number(&random, 5) - 2;
        }
        CU_ASSERT_PTR_NULL_FATAL(mesh_fault(&field.mesh, CELLS * STEP, CELLS * STEP));
        field.samples = (struct samples){.columns = 1, .rows = 1, .cell_span = CELLS * STEP, .extremes = extremes};
        start_simplifier(&field, &options);
        CU_ASSERT(flat_in_codes(&field.mesh, &frames[i]) > 10);
        CU_ASSERT_EQUAL(code_collapse(&field.simplifier), 0);
        CU_ASSERT_EQUAL(flat_in_codes(&field.mesh, &frames[i]), 0);
        CU_ASSERT_PTR_NULL(mesh_fault(&field.mesh, CELLS * STEP, CELLS * STEP));
        CU_ASSERT(field.mesh.live_vertices > SIDE * SIDE / 2); /* no more than need be */
        simplify_interior(&field.simplifier, 1);
        CU_ASSERT(field.mesh.live_vertices < SIDE * SIDE / 10);
        CU_ASSERT_EQUAL(flat_in_codes(&field.mesh, &frames[i]), 0);
        end_field(&field);
    }
}

/* ---- scale ---- */

static void planes_have_no_quadric_error(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    struct samples samples = {.cell_span = 1};
    make_grid_mesh(&memory, 12, 9, 1, NULL, 0, &mesh);
    for (int32_t v = 0; v < mesh.vertex_count; v++) {
        struct sample *at = &mesh.vertices[v].at;
        at->height_m = 40 + 3 * (float)at->x - 7 * (float)at->y;
    }
    CU_ASSERT_DOUBLE_EQUAL(quadric_mmqe_m2(&mesh, &samples, 30, 20), 0, 1e-12);
    mesh.vertices[6 * 13 + 6].at.height_m += 5;
    CU_ASSERT(quadric_mmqe_m2(&mesh, &samples, 30, 20) > 1e-3);
    mesh_release(&memory, &mesh);
}

/* A summit of 5 m in the middle of a square of 20 m, by hand. Going to a corner of the square, it comes to lie on two
 * of its planes and 10 m above or below the two others, which rise by 1 in 2. A corner goes to the summit, which lies
 * on both of its planes. */
static void a_pyramid_has_the_error_of_its_geometry(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    struct samples samples = {.cell_span = 1};
    static const int32_t quarters[4][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    static const struct sample at[5] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 5}};
    CU_ASSERT_EQUAL_FATAL(mesh_allocate(&memory, 5, 4, &mesh, NULL), SCREE_OK);
    for (int i = 0; i < 5; i++) mesh.vertices[i].at = at[i];
    for (int i = 0; i < 4; i++) memcpy(mesh.triangles[i].vertex, quarters[i], sizeof quarters[i]);
    mesh.vertex_count = 5;
    mesh.triangle_count = 4;
    CU_ASSERT_EQUAL_FATAL(mesh_connect(&memory, &mesh, NULL), SCREE_OK);
    double distance2_m2 = 10 * 10 / (1 + 0.5 * 0.5);
    CU_ASSERT_DOUBLE_EQUAL(quadric_mmqe_m2(&mesh, &samples, 10, 10), 2 * distance2_m2 / 5, 1e-9);
    mesh_release(&memory, &mesh);
}

static void the_scale_grows_as_a_mesh_gets_coarser(void) {
    static struct field field;
    const struct simplify_options options = {0};
    start_field(&field, 7, &options);
    double before_m2 = quadric_mmqe_m2(&field.mesh, &field.samples, 30, 30);
    for (float tolerance_m = 4; tolerance_m < 100; tolerance_m *= 2) {
        simplify_interior(&field.simplifier, tolerance_m);
        double mmqe_m2 = quadric_mmqe_m2(&field.mesh, &field.samples, 30, 30);
        CU_ASSERT(mmqe_m2 > before_m2);
        before_m2 = mmqe_m2;
    }
    end_field(&field);
}

/* ---- watching ---- */

struct watch {
    const struct mesh *mesh;
    int removals;
};

static void watch_removal(void *context, const struct star *star) {
    struct watch *watch = context;
    CU_ASSERT_NOT_EQUAL(watch->mesh->vertices[star->vertex].edge, MESH_NONE); /* told before it is done */
    CU_ASSERT(!star->open && star->degree >= 3);
    for (int32_t i = 0; i < star->degree; i++)
        CU_ASSERT_NOT_EQUAL(watch->mesh->vertices[star->ring[i]].edge, MESH_NONE);
    watch->removals++;
}

static void an_observer_sees_every_removal(void) {
    static struct field field;
    struct watch watch = {&field.mesh, 0};
    const struct simplify_observer observer = {&watch, watch_removal};
    const struct simplify_options options = {.observer = &observer};
    start_field(&field, 8, &options);
    simplify_interior(&field.simplifier, 5);
    simplify_interior(&field.simplifier, 25);
    CU_ASSERT(watch.removals > SIDE * SIDE / 2);
    CU_ASSERT_EQUAL(watch.removals, SIDE * SIDE - field.mesh.live_vertices);
    end_field(&field);
}

/* ---- gaps ---- */

static void closing_gaps_changes_no_result(void) {
    static struct field field, compacted;
    const struct simplify_options options = {0};
    struct scree_mesh mesh, same;
    start_field(&field, 8, &options);
    start_field(&compacted, 8, &options);
    for (float tolerance_m = 4; tolerance_m < 40; tolerance_m *= 1.5F) {
        simplify_interior(&field.simplifier, tolerance_m);
        simplify_interior(&compacted.simplifier, tolerance_m);
        CU_ASSERT_EQUAL_FATAL(simplifier_compact(&compacted.simplifier, NULL), SCREE_OK);
        CU_ASSERT_PTR_NULL(mesh_fault(&compacted.mesh, CELLS, CELLS));
        CU_ASSERT_EQUAL(compacted.mesh.vertex_count, field.mesh.live_vertices);
        CU_ASSERT_EQUAL(compacted.mesh.triangle_count, field.mesh.live_triangles);
        CU_ASSERT_EQUAL_FATAL(mesh_export_new(&field.memory, &field.mesh, &mesh, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(mesh_export_new(&compacted.memory, &compacted.mesh, &same, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(mesh.vertex_count, same.vertex_count);
        CU_ASSERT_EQUAL(memcmp(mesh.vertices, same.vertices, mesh.vertex_count * sizeof *mesh.vertices), 0);
        CU_ASSERT_EQUAL(memcmp(mesh.corners, same.corners, mesh.triangle_count * 3 * sizeof *mesh.corners), 0);
        scree_release(&field.memory, mesh.vertices);
        scree_release(&field.memory, mesh.corners);
        scree_release(&compacted.memory, same.vertices);
        scree_release(&compacted.memory, same.corners);
    }
    compacted.memory.fail_request = compacted.memory.requests + 2;
    size_t used_bytes = compacted.memory.used_bytes;
    CU_ASSERT_EQUAL(simplifier_compact(&compacted.simplifier, NULL), SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(compacted.memory.used_bytes, used_bytes);
    end_field(&compacted);
    end_field(&field);
}

/* ---- merging, and memory ---- */

static void lack_of_memory_leaves_no_simplifier(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    struct samples samples = {.cell_span = 1};
    struct simplifier simplifier;
    const struct simplify_options options = {0};
    make_grid_mesh(&memory, 4, 4, 1, NULL, 0, &mesh);
    size_t used_bytes = memory.used_bytes;
    uint64_t n = 0;
    for (enum scree_status status = SCREE_E_MEMORY; status != SCREE_OK; n++) {
        memory.requests = 0;
        memory.fail_request = n + 1;
        status = simplifier_start(&memory, &mesh, &samples, &options, &simplifier, NULL);
        CU_ASSERT(status == SCREE_OK || (status == SCREE_E_MEMORY && memory.used_bytes == used_bytes));
    }
    CU_ASSERT_EQUAL(n, 6); /* five arrays */
    simplifier_release(&simplifier);
    CU_ASSERT_EQUAL(memory.used_bytes, used_bytes);
    mesh_release(&memory, &mesh);
}

/* Two squares of two triangles, one step wide. */
static struct scree_vertex west_side[] = {{0, 0, 5}, {1, 0, 6}, {1, 1, 7}, {0, 1, 8}};
static struct scree_vertex east_side[] = {{0, 0, 6}, {1, 0, 1}, {1, 1, 2}, {0, 1, 7}};
static uint32_t halves[] = {0, 1, 2, 0, 2, 3};

static void lack_of_memory_leaves_no_merged_mesh(void) {
    struct scree_memory memory = {0};
    const struct scree_mesh west = {4, 2, west_side, halves}, east = {4, 2, east_side, halves};
    const struct scree_mesh *const children[4] = {&west, &east, NULL, NULL};
    struct mesh mesh;
    uint64_t n = 0;
    for (enum scree_status status = SCREE_E_MEMORY; status != SCREE_OK; n++) {
        memory.requests = 0;
        memory.fail_request = n + 1;
        status = mesh_merge(&memory, children, 1, &mesh, NULL);
        CU_ASSERT(status == SCREE_OK || (status == SCREE_E_MEMORY && memory.used_bytes == 0));
    }
    CU_ASSERT_EQUAL(n, 8); /* two lists, three arrays of the mesh, two to connect it */
    CU_ASSERT_EQUAL(mesh.live_vertices, 6);
    CU_ASSERT_EQUAL(mesh.live_triangles, 4);
    CU_ASSERT_PTR_NULL(mesh_fault(&mesh, 2, 1));
    mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void heights_that_differ_are_not_merged(void) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct scree_vertex other_side[4];
    memcpy(other_side, east_side, sizeof other_side);
    other_side[3].height++;
    const struct scree_mesh west = {4, 2, west_side, halves}, east = {4, 2, other_side, halves};
    const struct scree_mesh *const children[4] = {&west, &east, NULL, NULL};
    struct mesh mesh;
    CU_ASSERT_EQUAL(mesh_merge(&memory, children, 1, &mesh, &error), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(error.status, SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_simplify(void) {
    CU_pSuite suite = CU_add_suite("simplify", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, errors_at_posts_are_those_of_brute_force);
    CU_ADD_TEST(suite, errors_at_extremes_are_those_of_brute_force);
    CU_ADD_TEST(suite, rounded_positions_cost_by_the_slope);
    CU_ADD_TEST(suite, the_queue_is_first_in_first_out_by_classes);
    CU_ADD_TEST(suite, the_bound_holds_exactly);
    CU_ADD_TEST(suite, carried_errors_are_true);
    CU_ADD_TEST(suite, a_rung_is_used_up);
    CU_ADD_TEST(suite, level_ground_leaves_its_border_and_small_stars);
    CU_ADD_TEST(suite, locked_vertices_stay);
    CU_ADD_TEST(suite, codes_are_rounded_to_nearest);
    CU_ADD_TEST(suite, triangles_become_positive_in_codes);
    CU_ADD_TEST(suite, planes_have_no_quadric_error);
    CU_ADD_TEST(suite, a_pyramid_has_the_error_of_its_geometry);
    CU_ADD_TEST(suite, the_scale_grows_as_a_mesh_gets_coarser);
    CU_ADD_TEST(suite, an_observer_sees_every_removal);
    CU_ADD_TEST(suite, closing_gaps_changes_no_result);
    CU_ADD_TEST(suite, lack_of_memory_leaves_no_simplifier);
    CU_ADD_TEST(suite, lack_of_memory_leaves_no_merged_mesh);
    CU_ADD_TEST(suite, heights_that_differ_are_not_merged);
    return 0;
}
