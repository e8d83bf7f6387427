/* Static tiles as they are written: the ellipsoid, culling aids, the order of triangles, the codes. Tiles are read back
 * by src/quantized_mesh_decode.c, which shares no code with the writer. */
#include "src/occlusion.h"
#include "src/octahedral.h"
#include "src/quantized_mesh.h"
#include "src/quantized_mesh_decode.h"
#include "src/quantized_mesh_order.h"
#include "src/verify_tile.h"
#include "stream/ellipsoid.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RADIANS_PER_DEGREE 0.017453292519943295

/* ---- fixtures ---- */

static uint64_t next_random(uint64_t *state) { /* splitmix64 */
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double random_between(uint64_t *state, double low, double high) {
    return low + (high - low) * (double)(next_random(state) >> 11) / 9007199254740992.0;
}

/* A tile of columns x rows vertices spread over its window, heights by `height_of` of the lattice position. */
struct fixture {
    struct lattice lattice;
    struct terrain_tile tile;
    struct scree_mesh mesh;
    float *slopes;
};

static int32_t hills(int64_t x, int64_t y) { /* -300..300 */
    return (int32_t)lround(200 * sin((double)x * 0.05) * cos((double)y * 0.03) + 100 * sin((double)(x + 2 * y) * 0.21));
}

static struct fixture *fixture_new(struct lattice lattice, struct tile_id id, int columns, int rows,
                                   int32_t (*height_of)(int64_t x, int64_t y)) {
    struct fixture *f = calloc(1, sizeof *f);
    f->lattice = lattice;
    struct lattice_window window = lattice_tile_window(&lattice, id);
    uint32_t count = (uint32_t)(columns * rows);
    f->mesh.vertices = calloc(count + 2, sizeof *f->mesh.vertices);
    f->mesh.corners = calloc((size_t)count * 6 + 12, sizeof *f->mesh.corners);
    f->slopes = calloc((size_t)count + 2, 2 * sizeof *f->slopes);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            struct scree_vertex *vertex = &f->mesh.vertices[f->mesh.vertex_count++];
            vertex->x = (int32_t)((int64_t)window.columns * c / (columns - 1));
            vertex->y = (int32_t)((int64_t)window.rows * r / (rows - 1));
            vertex->height = height_of(window.x + vertex->x, window.y + vertex->y);
            float *slope = &f->slopes[2 * (f->mesh.vertex_count - 1)];
            slope[0] = 0.01f * (float)hills(window.y + vertex->y, window.x + vertex->x);
            slope[1] = 0.01f * (float)hills(window.x + vertex->x, 3);
        }
    uint32_t *corner = f->mesh.corners;
    for (int r = 0; r + 1 < rows; r++)
        for (int c = 0; c + 1 < columns; c++) {
            uint32_t sw = (uint32_t)(r * columns + c), se = sw + 1, nw = sw + (uint32_t)columns, ne = nw + 1;
            uint32_t square[2][6] = {{sw, se, ne, sw, ne, nw}, {sw, se, nw, se, ne, nw}};
            memcpy(corner, square[(r + c) % 2], sizeof square[0]);
            corner += 6;
        }
    f->mesh.triangle_count = (uint32_t)(corner - f->mesh.corners) / 3;
    f->tile = (struct terrain_tile){.lattice = &f->lattice,
                                    .id = id,
                                    .mesh = &f->mesh,
                                    .slopes = f->slopes,
                                    .height_unit_m = 0.0625,
                                    .border_step = 16};
    return f;
}

static void fixture_free(struct fixture *f) {
    free(f->slopes);
    free(f->mesh.corners);
    free(f->mesh.vertices);
    free(f);
}

/* One more vertex, in the middle of triangle `t`. */
static void split_triangle(struct fixture *f, uint32_t t) {
    struct scree_mesh *mesh = &f->mesh;
    uint32_t *c = &mesh->corners[3 * (size_t)t], number = mesh->vertex_count++, last = c[2];
    struct scree_vertex *v = mesh->vertices;
    v[number].x = (v[c[0]].x + v[c[1]].x + v[c[2]].x) / 3;
    v[number].y = (v[c[0]].y + v[c[1]].y + v[c[2]].y) / 3;
    c[2] = number;
    uint32_t *more = &mesh->corners[3 * (size_t)mesh->triangle_count];
    memcpy(more, (uint32_t[]){c[1], last, number, last, c[0], number}, 6 * sizeof *more);
    mesh->triangle_count += 2;
}

struct encoded {
    struct scree_memory memory;
    unsigned char *bytes;
    size_t size_bytes;
    struct decoded_tile tile;
};

/* Encodes and decodes; fails the test when that does not work or when verify finds a fault. */
static struct encoded encode(const struct fixture *f) {
    struct encoded e = {0};
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(quantized_mesh_encode_new(&e.memory, &f->tile, &e.bytes, &e.size_bytes, &error), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(decoded_tile_read(&e.memory, e.bytes, e.size_bytes, &e.tile, &error), SCREE_OK);
    struct verify_report *report = calloc(1, sizeof *report);
    struct tile_frame frame = tile_frame_of(&f->lattice, f->tile.id, true);
    CU_ASSERT_EQUAL(verify_tile(&e.memory, &e.tile, &frame, report, &error), SCREE_OK);
    CU_ASSERT_EQUAL(report_broken_promises(report), 0);
    CU_ASSERT_EQUAL(report->promises[PROMISE_COVER].checked, 1);
    CU_ASSERT_EQUAL(report->promises[PROMISE_OCCLUSION].checked, f->lattice.profile == PROFILE_GEODETIC);
    free(report);
    return e;
}

static void encoded_free(struct encoded *e) {
    decoded_tile_free(&e->memory, &e->tile);
    scree_release(&e->memory, e->bytes);
    CU_ASSERT_EQUAL(e->memory.used_bytes, 0);
}

static enum scree_status status_of(const struct fixture *f, struct scree_error *error) {
    struct scree_memory memory = {0};
    unsigned char *bytes;
    size_t size_bytes;
    enum scree_status status = quantized_mesh_encode_new(&memory, &f->tile, &bytes, &size_bytes, error);
    scree_release(&memory, bytes);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    return status;
}

/* ECEF by the textbook and the C library's sines. */
static struct vector3 textbook_point(double lon_deg, double lat_deg, double height_m) {
    double f = 1 / 298.257223563, e2 = f * (2 - f), lon = lon_deg * RADIANS_PER_DEGREE,
           lat = lat_deg * RADIANS_PER_DEGREE;
    double n = 6378137.0 / sqrt(1 - e2 * sin(lat) * sin(lat));
    return (struct vector3){(n + height_m) * cos(lat) * cos(lon), (n + height_m) * cos(lat) * sin(lon),
                            (n * (1 - e2) + height_m) * sin(lat)};
}

static struct vector3 decoded_point(const struct fixture *f, const struct decoded_tile *tile, uint32_t vertex) {
    double bounds[4];
    lattice_tile_bounds(&f->lattice, f->tile.id, bounds);
    double x = bounds[0] + (bounds[2] - bounds[0]) * tile->u[vertex] / 32767.0;
    double y = bounds[1] + (bounds[3] - bounds[1]) * tile->v[vertex] / 32767.0;
    double height_m = decoded_height_m(tile, vertex);
    return f->lattice.profile == PROFILE_LOCAL ? (struct vector3){x, y, height_m} : textbook_point(x, y, height_m);
}

static double distance(struct vector3 a, struct vector3 b) {
    struct vector3 offset = vector3_minus(a, b);
    return sqrt(vector3_dot(offset, offset));
}

/* ---- the ellipsoid ---- */

static void sines_agree_with_the_library(void) {
    uint64_t seed = 1;
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        double angle_deg = random_between(&seed, -400, 400), sine, cosine;
        sine_cosine_deg(angle_deg, &sine, &cosine);
        double turn_deg = fmod(angle_deg, 360);
        worst = fmax(worst, fabs(sine - sin(turn_deg * RADIANS_PER_DEGREE)));
        worst = fmax(worst, fabs(cosine - cos(turn_deg * RADIANS_PER_DEGREE)));
    }
    CU_ASSERT(worst < 2e-15);
    for (int quarter = -8; quarter <= 8; quarter++) {
        static const double sines[] = {0, 1, 0, -1};
        double sine, cosine;
        sine_cosine_deg(90.0 * quarter, &sine, &cosine);
        CU_ASSERT_EQUAL(sine, sines[quarter & 3]);
        CU_ASSERT_EQUAL(cosine, sines[(quarter + 1) & 3]);
    }
}

static void points_lie_where_the_textbook_says(void) {
    uint64_t seed = 2;
    double worst_m = 0;
    for (int i = 0; i < 5000; i++) {
        double lon = random_between(&seed, -180, 180), lat = random_between(&seed, -90, 90);
        double height_m = random_between(&seed, -11000, 9000);
        struct east_north_up frame = ellipsoid_frame(lon, lat);
        worst_m = fmax(worst_m, distance(ellipsoid_point(frame.up, height_m), textbook_point(lon, lat, height_m)));
    }
    CU_ASSERT(worst_m < 1e-8);
    struct vector3 pole = ellipsoid_point(ellipsoid_frame(77, 90).up, 0);
    CU_ASSERT_EQUAL(pole.x, 0);
    CU_ASSERT_EQUAL(pole.y, 0);
    CU_ASSERT_DOUBLE_EQUAL(pole.z, WGS84_MINOR_M, 1e-8);
    CU_ASSERT_DOUBLE_EQUAL(ellipsoid_point(ellipsoid_frame(0, 0).up, 5).x, WGS84_MAJOR_M + 5, 1e-9);
}

/* The normal from slopes against that of the surface itself, by differences of points. */
static void normals_stand_on_the_surface(void) {
    const double lon = 11, lat = 47, step_m = 10, slope_east = 0.7, slope_north = -1.3;
    struct east_north_up frame = ellipsoid_frame(lon, lat);
    struct vector3 here = ellipsoid_point(frame.up, 0);
    struct vector3 normal = ellipsoid_normal(&frame, slope_east, slope_north);
    double east_deg = step_m / (6388000.0 * cos(lat * RADIANS_PER_DEGREE)) / RADIANS_PER_DEGREE;
    double north_deg = step_m / 6370000.0 / RADIANS_PER_DEGREE;
    struct vector3 east = vector3_minus(textbook_point(lon + east_deg, lat, slope_east * step_m), here);
    struct vector3 north = vector3_minus(textbook_point(lon, lat + north_deg, slope_north * step_m), here);
    CU_ASSERT_DOUBLE_EQUAL(vector3_dot(normal, normal), 1, 1e-14);
    CU_ASSERT(fabs(vector3_dot(normal, east)) < 0.01 * step_m);
    CU_ASSERT(fabs(vector3_dot(normal, north)) < 0.01 * step_m);
    CU_ASSERT(vector3_dot(normal, frame.up) > 0);
}

/* ---- culling ---- */

/* CesiumJS's test of a point in scaled space (EllipsoidalOccluder.isScaledSpacePointVisible), said anew: the segment
 * from the camera goes through the unit sphere. */
static bool is_hidden(struct vector3 camera, struct vector3 point) {
    struct vector3 ray = vector3_minus(point, camera);
    double towards = -vector3_dot(ray, camera), beyond = vector3_dot(camera, camera) - 1;
    return beyond > 0 && towards > beyond && towards * towards / vector3_dot(ray, ray) > beyond;
}

static void check_culling(struct tile_id id, bool far) {
    struct fixture *f = fixture_new(lattice_geodetic(id.zoom + 1), id, 20, 20, hills);
    struct encoded e = encode(f);
    struct vector3 hop = {e.tile.occlusion[0], e.tile.occlusion[1], e.tile.occlusion[2]};
    double reach = sqrt(vector3_dot(hop, hop));
    CU_ASSERT_EQUAL(far, reach > 0.9 * OCCLUSION_FAR);
    CU_ASSERT(reach >= 1);
    struct vector3 points[400],
        sphere = {e.tile.sphere_center_m[0], e.tile.sphere_center_m[1], e.tile.sphere_center_m[2]};
    double farthest_m = 0;
    for (uint32_t i = 0; i < 400; i++) {
        struct vector3 point = decoded_point(f, &e.tile, i);
        farthest_m = fmax(farthest_m, distance(point, sphere));
        points[i] = occlusion_scaled(point);
        double height = sqrt(vector3_dot(points[i], points[i])); /* the far point hides what lies on the ellipsoid */
        if (far) points[i] = (struct vector3){points[i].x / height, points[i].y / height, points[i].z / height};
    }
    CU_ASSERT(farthest_m <= e.tile.sphere_radius_m);
    CU_ASSERT(e.tile.sphere_radius_m < 1.001 * farthest_m + 1);
    uint64_t seed = 3;
    int hidden = 0, broken = 0;
    for (int i = 0; i < 4000; i++) { /* cameras everywhere, from the ground to far out */
        struct vector3 camera =
            ellipsoid_point(ellipsoid_frame(random_between(&seed, -180, 180), random_between(&seed, -90, 90)).up,
                            pow(10, random_between(&seed, 3, 8)));
        camera = occlusion_scaled(camera);
        if (!is_hidden(camera, hop)) continue;
        hidden++;
        for (int k = 0; k < 400; k++)
            broken += (far || vector3_dot(points[k], points[k]) > 1) && !is_hidden(camera, points[k]);
    }
    CU_ASSERT_EQUAL(broken, 0);
    CU_ASSERT(hidden > 100);
    encoded_free(&e);
    fixture_free(f);
}

static void what_is_behind_the_horizon_is_hidden(void) {
    check_culling((struct tile_id){0, 0, 0}, true);
    check_culling((struct tile_id){0, 1, 0}, true);
    check_culling((struct tile_id){1, 1, 1}, false);
    check_culling((struct tile_id){3, 5, 7}, false); /* at the north pole */
    check_culling((struct tile_id){6, 127, 30}, false);
    check_culling((struct tile_id){13, 4000, 6001}, false);
}

static void hiding_is_not_overdone(void) {
    struct vector3 up = ellipsoid_frame(20, 30).up, point = ellipsoid_point(up, 4000);
    struct vector3 hop = horizon_occlusion_point(&point, 1, ellipsoid_point(up, 0));
    CU_ASSERT(distance(hop, occlusion_scaled(point)) < 1e-5); /* a single point hides itself: no farther out */
    struct vector3 deep = ellipsoid_point(up, -400);
    hop = horizon_occlusion_point(&deep, 1, ellipsoid_point(up, 0));
    CU_ASSERT_DOUBLE_EQUAL(vector3_dot(hop, hop), 1, 1e-9);
}

/* ---- order ---- */

static int compare_triangles(const void *a, const void *b) {
    return memcmp(a, b, 3 * sizeof(uint32_t));
}

/* The smallest corner first, so that rotated triangles compare equal. */
static void sort_triangles(uint32_t *corners, uint32_t count) {
    for (uint32_t *c = corners; c < corners + 3 * (size_t)count; c += 3)
        while (c[0] > c[1] || c[0] > c[2]) memcpy(c, (uint32_t[]){c[1], c[2], c[0]}, 3 * sizeof *c);
    qsort(corners, count, 3 * sizeof *corners, compare_triangles);
}

static void check_order(const uint32_t *corners, uint32_t triangle_count, uint32_t vertex_count, uint32_t in_use) {
    struct scree_memory memory = {0};
    uint32_t *ordered = calloc(3 * (size_t)triangle_count, sizeof *ordered),
             *order = calloc(vertex_count, sizeof *order);
    uint32_t *same = calloc(3 * (size_t)triangle_count, sizeof *same), used, next = 0, wrong = 0;
    CU_ASSERT_EQUAL_FATAL(
        quantized_mesh_order(&memory, corners, triangle_count, vertex_count, ordered, order, &used, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(used, in_use);
    for (size_t c = 0; c < 3 * (size_t)triangle_count; c++) { /* numbered by first use */
        wrong += ordered[c] > next;
        next += ordered[c] == next;
        same[c] = corners[c];
    }
    CU_ASSERT_EQUAL(wrong, 0);
    CU_ASSERT_EQUAL(next, used);
    for (size_t c = 0; c < 3 * (size_t)triangle_count; c++) ordered[c] = order[ordered[c]];
    sort_triangles(ordered, triangle_count);
    sort_triangles(same, triangle_count);
    CU_ASSERT_EQUAL(memcmp(ordered, same, 3 * (size_t)triangle_count * sizeof *same), 0);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(same);
    free(order);
    free(ordered);
}

static void order_keeps_every_triangle(void) {
    struct fixture *f = fixture_new(lattice_geodetic(3), (struct tile_id){3, 2, 1}, 30, 17, hills);
    check_order(f->mesh.corners, f->mesh.triangle_count, f->mesh.vertex_count, f->mesh.vertex_count);
    fixture_free(f);
    const uint32_t apart[] = {5, 3, 9, 1, 2, 0}; /* two pieces, and vertices without a triangle */
    check_order(apart, 2, 12, 6);
    const uint32_t bow_tie[] = {0, 1, 2, 0, 3, 4, 0, 5, 6, 0, 6, 7, 0, 7, 5}; /* two runs and a full turn at a vertex */
    check_order(bow_tie, 5, 8, 8);
    uint64_t seed = 4;
    for (int round = 0; round < 200; round++) { /* soups: edges with any number of triangles */
        uint32_t corners[60], in_use = 0;
        bool seen[12] = {false};
        for (int t = 0; t < 20; t++) {
            uint32_t a = (uint32_t)(next_random(&seed) % 12), b = (a + 1 + (uint32_t)(next_random(&seed) % 5)) % 12;
            memcpy(&corners[3 * t], (uint32_t[]){a, b, (b + 1 + (uint32_t)(next_random(&seed) % 5)) % 12}, 12);
            if (corners[3 * t + 2] == a) corners[3 * t + 2] = (a + 6) % 12 == b ? (a + 7) % 12 : (a + 6) % 12;
        }
        for (int c = 0; c < 60; c++) in_use += !seen[corners[c]], seen[corners[c]] = true;
        check_order(corners, 20, 12, in_use);
    }
}

/* Nearly every triangle of a grid shares an edge with the one before, and codes stay within the width of a front. */
static void order_runs_along_neighbours(void) {
    struct fixture *f = fixture_new(lattice_geodetic(3), (struct tile_id){3, 2, 1}, 40, 40, hills);
    struct encoded e = encode(f);
    uint32_t shared = 0;
    for (uint32_t t = 1; t < e.tile.triangle_count; t++) {
        uint32_t common = 0;
        for (int i = 0; i < 9; i++) common += e.tile.corners[3 * t + i / 3] == e.tile.corners[3 * (t - 1) + i % 3];
        shared += common >= 2;
    }
    CU_ASSERT(shared > e.tile.triangle_count / 2);
    encoded_free(&e);
    fixture_free(f);
}

/* ---- codes ---- */

static int64_t half_up(int32_t height, int64_t step) {
    return (int64_t)floor((double)height / (double)step + 0.5) * step;
}

/* Every vertex of the mesh is found in the tile at its rounded position, with its height as the rule says. */
static void check_codes(const struct fixture *f, const struct decoded_tile *tile, double interior_step_units) {
    struct lattice_window window = lattice_tile_window(&f->lattice, f->tile.id);
    int64_t span = lattice_tile_span(&f->lattice, f->tile.id.zoom);
    uint32_t missing = 0;
    CU_ASSERT_EQUAL(decoded_step_m(tile), interior_step_units * f->tile.height_unit_m);
    CU_ASSERT_EQUAL(fmod(tile->height_min_m, f->tile.border_step * f->tile.height_unit_m), 0);
    for (uint32_t i = 0; i < f->mesh.vertex_count; i++) {
        const struct scree_vertex *v = &f->mesh.vertices[i];
        bool border = v->x == 0 || v->y == 0 || v->x == window.columns || v->y == window.rows;
        int64_t step = border ? f->tile.border_step : interior_step_units > 1 ? (int64_t)interior_step_units : 1;
        double height_m = (double)half_up(v->height, step) * f->tile.height_unit_m;
        long u = lround(floor(32767.0 * v->x / (double)span + 0.5)),
             w = lround(floor(32767.0 * v->y / (double)span + 0.5));
        bool found = false;
        for (uint32_t k = 0; k < tile->vertex_count && !found; k++)
            found = tile->u[k] == u && tile->v[k] == w && decoded_height_m(tile, k) == height_m;
        missing += !found;
    }
    CU_ASSERT_EQUAL(missing, 0);
}

static int32_t mountains(int64_t x, int64_t y) { /* relief of 12,000: too much for a step of an eighth */
    return 20 * hills(x, y) + 5;
}

static int32_t alps(int64_t x, int64_t y) { /* relief of about 70,000 units: two or more units a step */
    return 120 * hills(x, y) - 1;
}

static int32_t plain(int64_t x, int64_t y) {
    (void)x, (void)y;
    return -7;
}

static void heights_are_exact(void) {
    struct fixture *f = fixture_new(lattice_geodetic(2), (struct tile_id){2, 3, 2}, 24, 24, mountains);
    struct encoded e = encode(f);
    check_codes(f, &e.tile, 1);
    encoded_free(&e);
    fixture_free(f);
    f = fixture_new(lattice_geodetic(2), (struct tile_id){2, 3, 2}, 24, 24, alps);
    e = encode(f);
    check_codes(f, &e.tile, 4);
    encoded_free(&e);
    fixture_free(f);
}

/* The header's maximum lies 32767 steps up whatever the relief: on small tiles the steps become finer. */
static void low_tiles_have_low_headers(void) {
    struct fixture *f = fixture_new(lattice_geodetic(17), (struct tile_id){17, 70000, 90000}, 9, 9, plain);
    struct encoded e = encode(f);
    CU_ASSERT(e.tile.height_max_m - e.tile.height_min_m < 20); /* the tile is 150 m wide */
    CU_ASSERT_EQUAL(e.tile.height_min_m, -1);
    CU_ASSERT_EQUAL(decoded_height_m(&e.tile, 40), e.tile.h[40] == 0 ? -1.0 : -0.4375);
    encoded_free(&e);
    fixture_free(f);
}

static void both_floats_are_exact(void) {
    struct fixture *f = fixture_new(lattice_geodetic(2), (struct tile_id){2, 3, 2}, 24, 24, hills);
    f->tile.height_unit_m = ldexp(1, -12);
    f->tile.border_step = 1 << 14;
    for (uint32_t i = 0; i < f->mesh.vertex_count; i++) f->mesh.vertices[i].height += 8000 << 12;
    struct encoded e = encode(f); /* the sum would need 27 bits in steps of a unit */
    check_codes(f, &e.tile, decoded_step_m(&e.tile) / f->tile.height_unit_m);
    CU_ASSERT(decoded_step_m(&e.tile) > f->tile.height_unit_m);
    encoded_free(&e);
    fixture_free(f);
}

static int32_t find_at(const struct decoded_tile *tile, enum edge_side side, uint16_t along) {
    bool vertical = side == EDGE_WEST || side == EDGE_EAST;
    for (uint32_t i = 0; i < tile->edge_count[side]; i++) {
        uint32_t vertex = tile->edges[side][i];
        if ((vertical ? tile->v : tile->u)[vertex] == along) return (int32_t)vertex;
    }
    return -1;
}

/* One tile's side against its neighbour's: as many vertices, the same places, heights and normals, to the bit. */
static void check_border(struct tile_id one, enum edge_side side, struct tile_id other, enum edge_side other_side) {
    struct lattice lattice = lattice_geodetic(7);
    struct fixture *f = fixture_new(lattice, one, 40, 40, mountains),
                   *g = fixture_new(lattice, other, 40, 40, mountains);
    for (uint32_t i = 0; i < g->mesh.vertex_count; i++) /* another relief inside, and so other steps */
        if (i % 40 != 0 && i % 40 != 39 && i >= 40 && i < 1560) g->mesh.vertices[i].height *= 3;
    bool vertical = side == EDGE_WEST || side == EDGE_EAST;
    for (uint32_t i = 0; i < 40; i++) { /* heights and slopes are the posts' own */
        uint32_t at = vertical ? 40 * i + (side == EDGE_EAST ? 39 : 0) : i + (side == EDGE_NORTH ? 1560 : 0);
        uint32_t there =
            vertical ? 40 * i + (other_side == EDGE_EAST ? 39 : 0) : i + (other_side == EDGE_NORTH ? 1560 : 0);
        memcpy(&g->slopes[2 * there], &f->slopes[2 * at], 2 * sizeof *f->slopes);
        g->mesh.vertices[there].height = f->mesh.vertices[at].height; /* the antimeridian is one line, too */
    }
    struct encoded e = encode(f), h = encode(g);
    CU_ASSERT_NOT_EQUAL(decoded_step_m(&e.tile), decoded_step_m(&h.tile));
    CU_ASSERT_EQUAL(e.tile.edge_count[side], 40);
    CU_ASSERT_EQUAL(h.tile.edge_count[other_side], 40);
    uint32_t different = 0;
    for (uint32_t i = 0; i < e.tile.edge_count[side]; i++) {
        uint32_t vertex = e.tile.edges[side][i];
        int32_t same = find_at(&h.tile, other_side, vertical ? e.tile.v[vertex] : e.tile.u[vertex]);
        different += same < 0 || decoded_height_m(&e.tile, vertex) != decoded_height_m(&h.tile, (uint32_t)same) ||
                     memcmp(&e.tile.normals[2 * vertex], &h.tile.normals[2 * same], 2) != 0;
    }
    CU_ASSERT_EQUAL(different, 0);
    encoded_free(&h);
    encoded_free(&e);
    fixture_free(g);
    fixture_free(f);
}

static void neighbours_agree_to_the_bit(void) {
    check_border((struct tile_id){5, 9, 17}, EDGE_EAST, (struct tile_id){5, 10, 17}, EDGE_WEST);
    check_border((struct tile_id){6, 9, 17}, EDGE_NORTH, (struct tile_id){6, 9, 18}, EDGE_SOUTH);
    check_border((struct tile_id){7, 255, 40}, EDGE_EAST, (struct tile_id){7, 0, 40}, EDGE_WEST); /* antimeridian */
}

static void edges_are_sorted_and_have_corners(void) {
    struct fixture *f = fixture_new(lattice_geodetic(5), (struct tile_id){4, 3, 9}, 13, 21, hills);
    struct encoded e = encode(f);
    const struct decoded_tile *tile = &e.tile;
    static const uint32_t counts[EDGE_COUNT] = {21, 13, 21, 13};
    for (int side = 0; side < EDGE_COUNT; side++) {
        bool vertical = side == EDGE_WEST || side == EDGE_EAST;
        const uint16_t *along = vertical ? tile->v : tile->u, *across = vertical ? tile->u : tile->v;
        CU_ASSERT_EQUAL_FATAL(tile->edge_count[side], counts[side]);
        for (uint32_t i = 0; i < counts[side]; i++) {
            CU_ASSERT_EQUAL(across[tile->edges[side][i]], side == EDGE_WEST || side == EDGE_SOUTH ? 0 : DECODED_TOP);
            if (i > 0) CU_ASSERT(along[tile->edges[side][i]] > along[tile->edges[side][i - 1]]);
        }
        CU_ASSERT_EQUAL(along[tile->edges[side][0]], 0);
        CU_ASSERT_EQUAL(along[tile->edges[side][counts[side] - 1]], DECODED_TOP);
    }
    encoded_free(&e);
    fixture_free(f);
}

/* How far, in degrees, the tile's normals lie from those of the slopes. */
static void normals_follow_the_slopes(void) {
    struct fixture *f = fixture_new(lattice_geodetic(5), (struct tile_id){5, 3, 9}, 16, 16, hills);
    struct encoded e = encode(f);
    double bounds[4], worst = 1;
    CU_ASSERT_PTR_NOT_NULL_FATAL(e.tile.normals);
    lattice_tile_bounds(&f->lattice, f->tile.id, bounds);
    for (uint32_t i = 0; i < f->mesh.vertex_count; i++) {
        long u = lround(32767.0 * f->mesh.vertices[i].x / 256), v = lround(32767.0 * f->mesh.vertices[i].y / 256);
        uint32_t k = 0;
        while (k < 255 && (e.tile.u[k] != u || e.tile.v[k] != v)) k++;
        double x = e.tile.normals[2 * k] / 127.5 - 1, y = e.tile.normals[2 * k + 1] / 127.5 - 1,
               z = 1 - fabs(x) - fabs(y);
        if (z < 0) { /* the specification's decoder */
            double folded = (1 - fabs(y)) * (x < 0 ? -1 : 1);
            y = (1 - fabs(x)) * (y < 0 ? -1 : 1);
            x = folded;
        }
        double length = sqrt(x * x + y * y + z * z);
        struct east_north_up frame = ellipsoid_frame(bounds[0] + (bounds[2] - bounds[0]) * (double)u / 32767,
                                                     bounds[1] + (bounds[3] - bounds[1]) * (double)v / 32767);
        struct vector3 wanted = ellipsoid_normal(&frame, f->slopes[2 * i], f->slopes[2 * i + 1]);
        worst = fmin(worst, vector3_dot(wanted, (struct vector3){x / length, y / length, z / length}));
    }
    CU_ASSERT(worst > cos(1.0 * RADIANS_PER_DEGREE));
    encoded_free(&e);
    f->tile.slopes = NULL;
    e = encode(f);
    CU_ASSERT_PTR_NULL(e.tile.normals);
    encoded_free(&e);
    fixture_free(f);
}

static void octahedral_corners(void) {
    unsigned char code[2];
    static const struct {
        struct vector3 unit;
        unsigned char code[2];
    } cases[] = {{{0, 0, 1}, {128, 128}}, {{1, 0, 0}, {255, 128}}, {{0, -1, 0}, {128, 0}}, {{0, 0, -1}, {255, 255}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        octahedral_encode(cases[i].unit, code);
        CU_ASSERT_EQUAL(memcmp(code, cases[i].code, 2), 0);
    }
}

/* ---- sizes ---- */

static void check_count(int columns, int rows, int splits, uint32_t wanted) {
    struct fixture *f = fixture_new(lattice_geodetic(6), (struct tile_id){0, 1, 0}, columns, rows, hills);
    for (int i = 0; i < splits; i++) split_triangle(f, 1000 * (uint32_t)i);
    struct encoded e = encode(f);
    CU_ASSERT_EQUAL(e.tile.vertex_count, wanted);
    CU_ASSERT_EQUAL(e.tile.used_vertex_count, wanted);
    CU_ASSERT_EQUAL(e.tile.triangle_count, f->mesh.triangle_count);
    size_t index_bytes = wanted > 65535 ? 4 : 2, padding = wanted > 65535 && wanted % 2 == 1 ? 2 : 0, edges = 0;
    for (int side = 0; side < EDGE_COUNT; side++) edges += e.tile.edge_count[side];
    CU_ASSERT_EQUAL(edges, (size_t)(2 * columns + 2 * rows));
    CU_ASSERT_EQUAL(e.size_bytes, 88 + 4 + 6 * (size_t)wanted + padding + 4 + 3 * index_bytes * e.tile.triangle_count +
                                      16 + index_bytes * edges + 5 + 2 * (size_t)wanted);
    int64_t area = 0; /* no triangle is lost or laid twice: twice the area of the square */
    for (const uint32_t *c = e.tile.corners; c < e.tile.corners + 3 * (size_t)e.tile.triangle_count; c += 3) {
        const uint16_t *u = e.tile.u, *v = e.tile.v;
        int64_t twice =
            (int64_t)(u[c[1]] - u[c[0]]) * (v[c[2]] - v[c[0]]) - (int64_t)(u[c[2]] - u[c[0]]) * (v[c[1]] - v[c[0]]);
        CU_ASSERT(twice > 0);
        area += twice;
    }
    CU_ASSERT_EQUAL(area, 2 * INT64_C(32767) * 32767);
    encoded_free(&e);
    fixture_free(f);
}

static void index_width_changes_where_clients_agree(void) {
    check_count(255, 257, 0, 65535);
    check_count(255, 257, 1, 65537); /* one vertex is written twice */
    check_count(256, 256, 1, 65537);
    check_count(256, 256, 2, 65538);
}

static void a_ring_of_65536_border_vertices_is_refused(void) {
    struct fixture *f = fixture_new(lattice_geodetic(9), (struct tile_id){0, 0, 0}, 32768, 2, plain);
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(f->mesh.vertex_count, 65536);
    CU_ASSERT_EQUAL(status_of(f, &error), SCREE_E_LIMIT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "65,536"));
    fixture_free(f);
}

/* ---- the local profile ---- */

static void local_tiles_are_cut(void) {
    struct lattice lattice;
    CU_ASSERT_EQUAL_FATAL(lattice_local(401, 301, 500000, 4000000, 30, 30, 1, &lattice, NULL), SCREE_OK);
    struct fixture *f = fixture_new(lattice, (struct tile_id){1, 1, 1}, 20, 10, hills);
    struct encoded e = encode(f);
    check_codes(f, &e.tile, decoded_step_m(&e.tile) / f->tile.height_unit_m);
    struct lattice_window window = lattice_tile_window(&lattice, f->tile.id);
    CU_ASSERT_EQUAL(window.columns, 144);
    CU_ASSERT_EQUAL(e.tile.edge_count[EDGE_EAST], 10);
    CU_ASSERT_EQUAL(e.tile.edge_count[EDGE_NORTH], 20);
    for (uint32_t i = 0; i < 10; i++) /* the eastern edge lies where the raster ends, not where the tile would */
        CU_ASSERT_EQUAL(e.tile.u[e.tile.edges[EDGE_EAST][i]], (2 * 144 * 32767 + 256) / 512);
    CU_ASSERT_EQUAL(e.tile.center_m[0], 500000 + 30 * (256 + 72));
    CU_ASSERT_EQUAL(e.tile.center_m[1], 4000000 + 30 * (256 + 22));
    CU_ASSERT_EQUAL(e.tile.occlusion[0], 0);
    struct vector3 sphere = {e.tile.sphere_center_m[0], e.tile.sphere_center_m[1], e.tile.sphere_center_m[2]};
    for (uint32_t i = 0; i < e.tile.vertex_count; i++)
        CU_ASSERT(distance(sphere, decoded_point(f, &e.tile, i)) <= e.tile.sphere_radius_m);
    encoded_free(&e);
    fixture_free(f);
}

/* ---- what is refused ---- */

static struct fixture *small(void) {
    return fixture_new(lattice_geodetic(8), (struct tile_id){8, 100, 90}, 4, 4, hills);
}

static void check_refused(struct fixture *f, enum scree_status wanted, const char *why) {
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(status_of(f, &error), wanted);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, why));
    CU_ASSERT_EQUAL(status_of(f, NULL), wanted);
    fixture_free(f);
}

static void nonsense_is_refused(void) {
    struct fixture *f = small();
    f->mesh.vertices[5].x = 257;
    check_refused(f, SCREE_E_ARGUMENT, "outside of its window");
    f = small();
    f->mesh.vertices[5].y = -1;
    check_refused(f, SCREE_E_ARGUMENT, "outside of its window");
    f = small();
    f->mesh.corners[7] = 16;
    check_refused(f, SCREE_E_ARGUMENT, "does not exist");
    f = small();
    f->slopes[9] = NAN;
    check_refused(f, SCREE_E_ARGUMENT, "not finite");
    f = small();
    f->tile.border_step = 3;
    check_refused(f, SCREE_E_ARGUMENT, "powers of two");
    f = small();
    f->tile.height_unit_m = 0.1;
    check_refused(f, SCREE_E_ARGUMENT, "powers of two");
    f = small();
    f->tile.id.y = 4096;
    check_refused(f, SCREE_E_ARGUMENT, "outside of the terrain");
    f = small();
    f->mesh.triangle_count = 0;
    check_refused(f, SCREE_E_ARGUMENT, "no triangles");
    f = small();
    f->mesh.vertices[5].x = f->mesh.vertices[4].x; /* a triangle without area, others turned over */
    check_refused(f, SCREE_E_ARGUMENT, "counter-clockwise");
}

static void too_much_relief_is_refused(void) {
    struct fixture *f = small();
    f->mesh.vertices[5].height = 16 * 32767 + 400;
    f->mesh.vertices[6].height = -400;
    check_refused(f, SCREE_E_LIMIT, "coarser step");
    f = small();
    f->tile.height_unit_m = 1;
    f->tile.border_step = 1; /* beyond 2^24 floats are even */
    for (uint32_t i = 0; i < 16; i++) f->mesh.vertices[i].height = (1 << 26) + 1;
    check_refused(f, SCREE_E_LIMIT, "coarser step");
}

static void positions_that_round_together_are_refused(void) {
    struct fixture *f = fixture_new(lattice_geodetic(9), (struct tile_id){0, 0, 0}, 3, 3, hills);
    f->mesh.vertices[4].x = 1; /* 2^17 steps across: four of them a code */
    check_refused(f, SCREE_E_ARGUMENT, "counter-clockwise");
}

static void every_failed_allocation_is_survived(void) {
    struct fixture *f = fixture_new(lattice_geodetic(2), (struct tile_id){0, 1, 0}, 256, 256, hills);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t n = 0;
    while (status != SCREE_OK && n < 100) {
        struct scree_memory memory = {.fail_request = ++n};
        unsigned char *bytes;
        size_t size_bytes;
        status = quantized_mesh_encode_new(&memory, &f->tile, &bytes, &size_bytes, NULL);
        if (status != SCREE_OK) {
            CU_ASSERT_EQUAL(status, SCREE_E_MEMORY);
            CU_ASSERT_PTR_NULL(bytes);
        }
        scree_release(&memory, bytes);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT(n > 8);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    fixture_free(f);
}

/* The bytes of one tile by their FNV-1a hash: compilers, flags and C libraries must not change them. Whoever changes
 * them on purpose changes the number. */
static void bytes_are_the_same_everywhere(void) {
    struct fixture *f = fixture_new(lattice_geodetic(6), (struct tile_id){5, 40, 21}, 33, 33, plain);
    for (uint32_t i = 0; i < f->mesh.vertex_count; i++) { /* no sine of the C library in it */
        f->mesh.vertices[i].height = (int32_t)(i * i % 977);
        f->slopes[2 * i] = (float)(i % 7) / 4 - 1;
        f->slopes[2 * i + 1] = (float)(i % 5) / 8 - 0.25f;
    }
    struct encoded e = encode(f);
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < e.size_bytes; i++) hash = (hash ^ e.bytes[i]) * 0x100000001b3u;
    CU_ASSERT_EQUAL(hash, UINT64_C(0x6ae1fcf023257918));
    encoded_free(&e);
    fixture_free(f);
}

int suite_terrain(void) {
    CU_pSuite suite = CU_add_suite("terrain", NULL, NULL);
    if (suite == NULL) return 1;
    static const struct {
        const char *name;
        CU_TestFunc run;
    } tests[] = {
        {"sines agree with the library", sines_agree_with_the_library},
        {"points lie where the textbook says", points_lie_where_the_textbook_says},
        {"normals stand on the surface", normals_stand_on_the_surface},
        {"what is behind the horizon is hidden", what_is_behind_the_horizon_is_hidden},
        {"hiding is not overdone", hiding_is_not_overdone},
        {"order keeps every triangle", order_keeps_every_triangle},
        {"order runs along neighbours", order_runs_along_neighbours},
        {"heights are exact", heights_are_exact},
        {"low tiles have low headers", low_tiles_have_low_headers},
        {"both floats are exact", both_floats_are_exact},
        {"neighbours agree to the bit", neighbours_agree_to_the_bit},
        {"edges are sorted and have corners", edges_are_sorted_and_have_corners},
        {"normals follow the slopes", normals_follow_the_slopes},
        {"octahedral corners", octahedral_corners},
        {"index width changes where clients agree", index_width_changes_where_clients_agree},
        {"a ring of 65,536 border vertices is refused", a_ring_of_65536_border_vertices_is_refused},
        {"local tiles are cut", local_tiles_are_cut},
        {"nonsense is refused", nonsense_is_refused},
        {"too much relief is refused", too_much_relief_is_refused},
        {"positions that round together are refused", positions_that_round_together_are_refused},
        {"every failed allocation is survived", every_failed_allocation_is_survived},
        {"bytes are the same everywhere", bytes_are_the_same_everywhere},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (CU_add_test(suite, tests[i].name, tests[i].run) == NULL) return 1;
    return 0;
}
