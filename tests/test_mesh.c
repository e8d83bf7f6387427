/* The half-edge mesh: whatever is collapsed and flipped, it stays a surface that covers its rectangle once. */
#include "tests/mesh_maker.h"

#include <CUnit/CUnit.h>
#include <stdio.h>
#include <string.h>

static void check(const struct mesh *mesh, int32_t columns, int32_t rows) {
    const char *fault = mesh_fault(mesh, columns, rows);
    if (fault != NULL) printf("\n    %s\n", fault);
    CU_ASSERT_PTR_NULL_FATAL(fault);
}

/* Whether the star's vertex may go into ring[target]: what is left of its triangles keeps a positive area, and a border
 * vertex leaves the border where it is. */
static bool may_collapse(const struct mesh *mesh, const struct star *star, int32_t target) {
    int32_t first = target == 0 ? 1 : 0, count = star->degree - 1;
    if (star->open) {
        if (target != 0 && target != star->degree) return false;
        if (sample_area2(&star->at[0], &mesh->vertices[star->vertex].at, &star->at[star->degree]) != 0) return false;
    } else {
        first = target + 1;
        count = star->degree - 2;
    }
    for (int32_t i = first; i < first + count; i++) {
        int32_t j = star->open ? i : i % star->degree;
        if (sample_area2(&star->at[target], &star->at[j], &star->at[j + 1]) <= 0) return false;
    }
    return true;
}

static bool may_flip(const struct mesh *mesh, int32_t edge) {
    int32_t twin = mesh_twin(mesh, edge);
    if (twin == MESH_NONE) return false;
    const struct sample *a = &mesh->vertices[mesh_origin(mesh, edge)].at;
    const struct sample *b = &mesh->vertices[mesh_origin(mesh, twin)].at;
    const struct sample *c = &mesh->vertices[mesh_origin(mesh, mesh_previous(edge))].at;
    const struct sample *d = &mesh->vertices[mesh_origin(mesh, mesh_previous(twin))].at;
    return sample_area2(d, c, a) > 0 && sample_area2(c, d, b) > 0;
}

static int32_t live_edge(const struct mesh *mesh, uint64_t *random) {
    int32_t triangle;
    do triangle = any_number(random, mesh->triangle_count);
    while (mesh->triangles[triangle].vertex[0] == MESH_NONE);
    return 4 * triangle + any_number(random, 3);
}

/* One attempt at a collapse; true when it was legal and done. */
static bool collapse_any(struct mesh *mesh, uint64_t *random) {
    struct star star;
    int32_t vertex = any_number(random, mesh->vertex_count);
    if (mesh->vertices[vertex].edge == MESH_NONE) return false;
    CU_ASSERT_TRUE_FATAL(mesh_star(mesh, vertex, &star));
    int32_t target = star.open ? any_number(random, 2) * star.degree : any_number(random, star.degree);
    if (!may_collapse(mesh, &star, target)) return false;
    int32_t live_vertices = mesh->live_vertices, live_triangles = mesh->live_triangles;
    mesh_collapse(mesh, &star, target);
    CU_ASSERT_EQUAL(mesh->live_vertices, live_vertices - 1);
    CU_ASSERT_EQUAL(mesh->live_triangles, live_triangles - (star.open ? 1 : 2));
    CU_ASSERT_EQUAL(mesh->vertices[vertex].edge, MESH_NONE);
    return true;
}

/* Half of the tries are flips, so that stars of all shapes come up. */
static void wear_down(struct mesh *mesh, int32_t columns, int32_t rows, uint64_t seed) {
    uint64_t random = seed;
    int collapses = 0, flips = 0;
    for (int tries = 0; tries < 6000; tries++) {
        bool done;
        if (any_number(&random, 2) == 0) {
            int32_t edge = live_edge(mesh, &random);
            if ((done = may_flip(mesh, edge))) mesh_flip(mesh, edge);
            flips += done;
        } else {
            done = collapse_any(mesh, &random);
            collapses += done;
        }
        if (done) check(mesh, columns, rows);
    }
    CU_ASSERT(collapses > mesh->vertex_count / 2);
    CU_ASSERT(columns == 1 || flips > mesh->vertex_count / 2);
}

static void collapses_and_flips_keep_a_surface(void) {
    static const int32_t sizes[][2] = {{9, 7}, {16, 16}, {1, 12}, {20, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct scree_memory memory = {0};
            struct mesh mesh;
            make_grid_mesh(&memory, sizes[i][0], sizes[i][1], 1, NULL, 0, &mesh);
            check(&mesh, sizes[i][0], sizes[i][1]);
            wear_down(&mesh, sizes[i][0], sizes[i][1], seed);
            mesh_release(&memory, &mesh);
            CU_ASSERT_EQUAL(memory.used_bytes, 0);
        }
}

/* Every vertex but the corners can go, down to two triangles: on a flat grid something is always legal. */
static void a_grid_wears_down_to_two_triangles(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    uint64_t random = 77;
    make_grid_mesh(&memory, 12, 12, 5, NULL, 0, &mesh);
    for (int tries = 0; tries < 200000 && mesh.live_vertices > 4; tries++) collapse_any(&mesh, &random);
    CU_ASSERT_EQUAL(mesh.live_vertices, 4);
    CU_ASSERT_EQUAL(mesh.live_triangles, 2);
    check(&mesh, 60, 60);
    mesh_release(&memory, &mesh);
}

static void stars_turn_counter_clockwise_from_the_border(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    struct star star;
    make_grid_mesh(&memory, 2, 2, 1, NULL, 0, &mesh); /* the middle has all four diagonals */
    CU_ASSERT_TRUE(mesh_star(&mesh, 4, &star));
    CU_ASSERT_FALSE(star.open);
    CU_ASSERT_EQUAL(star.degree, 8);
    for (int32_t i = 0; i < star.degree; i++)
        CU_ASSERT(sample_area2(&mesh.vertices[4].at, &star.at[i], &star.at[i + 1]) > 0);
    CU_ASSERT_TRUE(mesh_star(&mesh, 1, &star)); /* the middle of the southern border */
    CU_ASSERT_TRUE(star.open);
    CU_ASSERT_EQUAL(star.degree, 2);
    CU_ASSERT_EQUAL(star.ring[0], 2);
    CU_ASSERT_EQUAL(star.ring[1], 4);
    CU_ASSERT_EQUAL(star.ring[2], 0);
    mesh_release(&memory, &mesh);
}

static void a_flip_turns_the_diagonal_as_told(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    make_grid_mesh(&memory, 1, 1, 1, NULL, 0, &mesh); /* (0, 1, 3) and (3, 2, 0): the diagonal is edge 2, from 3 to 0 */
    CU_ASSERT_EQUAL(mesh_origin(&mesh, 2), 3);
    CU_ASSERT_EQUAL(mesh_twin(&mesh, 2), 6);
    mesh_flip(&mesh, 2);
    check(&mesh, 1, 1);
    CU_ASSERT_EQUAL(mesh_origin(&mesh, 2), 2); /* (far corner, own third corner, origin) */
    CU_ASSERT_EQUAL(mesh_origin(&mesh, 0), 1);
    CU_ASSERT_EQUAL(mesh_origin(&mesh, 1), 3);
    mesh_release(&memory, &mesh);
}

/* A fan around the origin: stars of the largest size are seen, larger ones refused. */
static void stars_beyond_the_largest_are_refused(void) {
    for (int32_t extra = 0; extra <= 1; extra++) {
        struct scree_memory memory = {0};
        struct mesh mesh;
        struct star star;
        int32_t count = MESH_MAX_DEGREE + extra; /* triangles */
        CU_ASSERT_EQUAL_FATAL(mesh_allocate(&memory, count + 2, count, &mesh, NULL), SCREE_OK);
        for (int32_t i = 0; i <= count; i++) mesh.vertices[i + 1].at = (struct sample){count - i, i, 0};
        for (int32_t i = 0; i < count; i++)
            memcpy(mesh.triangles[i].vertex, (int32_t[3]){0, i + 1, i + 2}, 3 * sizeof(int32_t));
        mesh.vertex_count = count + 2;
        mesh.triangle_count = count;
        CU_ASSERT_EQUAL_FATAL(mesh_connect(&memory, &mesh, NULL), SCREE_OK);
        CU_ASSERT_EQUAL(mesh_star(&mesh, 0, &star), extra == 0);
        mesh_release(&memory, &mesh);
    }
}

static enum scree_status connect(const int32_t (*triangles)[3], int32_t triangle_count, int32_t vertex_count) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct mesh mesh;
    CU_ASSERT_EQUAL_FATAL(mesh_allocate(&memory, vertex_count, triangle_count, &mesh, &error), SCREE_OK);
    for (int32_t t = 0; t < triangle_count; t++) memcpy(mesh.triangles[t].vertex, triangles[t], sizeof triangles[t]);
    mesh.vertex_count = vertex_count;
    mesh.triangle_count = triangle_count;
    enum scree_status status = mesh_connect(&memory, &mesh, &error);
    CU_ASSERT_EQUAL(error.status, status);
    mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return status;
}

static void what_is_no_surface_is_refused(void) {
    static const int32_t square[][3] = {{0, 1, 2}, {0, 2, 3}};
    static const int32_t twice[][3] = {{0, 1, 2}, {0, 1, 2}};
    static const int32_t turned[][3] = {{0, 1, 2}, {0, 3, 2}, {0, 2, 4}}; /* two triangles on one side of 0-2 */
    static const int32_t three[][3] = {{0, 1, 2}, {2, 1, 3}, {1, 4, 2}, {2, 1, 5}};
    static const int32_t bow_tie[][3] = {{0, 1, 2}, {0, 3, 4}};
    CU_ASSERT_EQUAL(connect(square, 2, 4), SCREE_OK);
    CU_ASSERT_EQUAL(connect(twice, 2, 3), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(connect(turned, 3, 5), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(connect(three, 4, 6), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(connect(bow_tie, 2, 5), SCREE_E_CORRUPT);
}

static void a_copy_holds_what_is_alive(void) {
    struct scree_memory memory = {0};
    struct mesh mesh;
    struct scree_mesh copy;
    uint64_t random = 5;
    make_grid_mesh(&memory, 10, 10, 3, NULL, 0, &mesh);
    for (int32_t v = 0; v < mesh.vertex_count; v++) mesh.heights[v] = 1000 + v;
    for (int tries = 0; tries < 300; tries++) collapse_any(&mesh, &random);
    CU_ASSERT_EQUAL_FATAL(mesh_export_new(&memory, &mesh, &copy, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(copy.vertex_count, (uint32_t)mesh.live_vertices);
    CU_ASSERT_EQUAL(copy.triangle_count, (uint32_t)mesh.live_triangles);
    CU_ASSERT(copy.vertex_count < 100);
    uint32_t vertex = 0, triangle = 0;
    for (int32_t v = 0; v < mesh.vertex_count; v++) {
        if (mesh.vertices[v].edge == MESH_NONE) continue;
        CU_ASSERT_EQUAL(copy.vertices[vertex].x, mesh.vertices[v].at.x);
        CU_ASSERT_EQUAL(copy.vertices[vertex].y, mesh.vertices[v].at.y);
        CU_ASSERT_EQUAL(copy.vertices[vertex++].height, 1000 + v);
    }
    for (int32_t t = 0; t < mesh.triangle_count; t++) {
        if (mesh.triangles[t].vertex[0] == MESH_NONE) continue;
        for (uint32_t i = 0; i < 3; i++)
            CU_ASSERT_EQUAL(copy.vertices[copy.corners[3 * triangle + i]].height, 1000 + mesh.triangles[t].vertex[i]);
        triangle++;
    }
    scree_release(&memory, copy.corners);
    scree_release(&memory, copy.vertices);
    mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static enum scree_status make_connect_copy(struct scree_memory *memory) {
    struct mesh mesh;
    struct scree_mesh copy;
    struct scree_error error = {0};
    enum scree_status status = mesh_allocate(memory, 3, 1, &mesh, &error);
    if (status != SCREE_OK) return status;
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    memcpy(mesh.triangles[0].vertex, (int32_t[3]){0, 1, 2}, 3 * sizeof(int32_t));
    if ((status = mesh_connect(memory, &mesh, &error)) == SCREE_OK &&
        (status = mesh_export_new(memory, &mesh, &copy, &error)) == SCREE_OK) {
        scree_release(memory, copy.corners);
        scree_release(memory, copy.vertices);
    }
    mesh_release(memory, &mesh);
    return status;
}

static void lack_of_memory_leaves_nothing_behind(void) {
    struct scree_memory memory = {0};
    CU_ASSERT_EQUAL_FATAL(make_connect_copy(&memory), SCREE_OK);
    uint64_t requests = memory.requests;
    CU_ASSERT_EQUAL(requests, 8);
    for (uint64_t n = 1; n <= requests; n++) {
        struct scree_memory failing = {.fail_request = n};
        CU_ASSERT_EQUAL(make_connect_copy(&failing), SCREE_E_MEMORY);
        CU_ASSERT_EQUAL(failing.used_bytes, 0);
    }
}

int suite_mesh(void) {
    CU_pSuite suite = CU_add_suite("mesh", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, collapses_and_flips_keep_a_surface);
    CU_ADD_TEST(suite, a_grid_wears_down_to_two_triangles);
    CU_ADD_TEST(suite, stars_turn_counter_clockwise_from_the_border);
    CU_ADD_TEST(suite, a_flip_turns_the_diagonal_as_told);
    CU_ADD_TEST(suite, stars_beyond_the_largest_are_refused);
    CU_ADD_TEST(suite, what_is_no_surface_is_refused);
    CU_ADD_TEST(suite, a_copy_holds_what_is_alive);
    CU_ADD_TEST(suite, lack_of_memory_leaves_nothing_behind);
    return 0;
}
