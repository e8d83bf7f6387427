#include "tests/tile_maker.h"

#include "stream/cursor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

#define TOP             32767
#define RADIUS_EQUATOR  6378137.0
#define RADIUS_POLE     6356752.3142451793
#define RADIANS         0.017453292519943295
#define MOST_CODE_WIDTH 65536

struct tile_recipe tile_recipe_grid(int cells, uint16_t right, uint16_t top) {
    uint32_t side = (uint32_t)cells + 1, count = side * side;
    struct tile_recipe recipe = {.height_min_m = -100, .height_max_m = -100 + TOP / 16.0f};
    recipe.vertex_count = count;
    recipe.triangle_count = 2 * (uint32_t)cells * (uint32_t)cells;
    recipe.u = calloc(count + 1, sizeof *recipe.u);
    recipe.v = calloc(count + 1, sizeof *recipe.v);
    recipe.h = calloc(count + 1, sizeof *recipe.h);
    recipe.corners = calloc(recipe.triangle_count + 2, 3 * sizeof *recipe.corners);
    for (int s = 0; s < 4; s++) recipe.edges[s] = calloc(side + 1, sizeof *recipe.edges[s]);
    uint32_t *corner = recipe.corners;
    for (uint32_t j = 0; j < side; j++)
        for (uint32_t i = 0; i < side; i++) {
            uint32_t at = j * side + i;
            recipe.u[at] = (uint16_t)(i * right / (uint32_t)cells);
            recipe.v[at] = (uint16_t)(j * top / (uint32_t)cells);
            if (i == 0) recipe.edges[0][recipe.edge_count[0]++] = at;
            if (j == 0) recipe.edges[1][recipe.edge_count[1]++] = at;
            if (i == side - 1) recipe.edges[2][recipe.edge_count[2]++] = at;
            if (j == side - 1) recipe.edges[3][recipe.edge_count[3]++] = at;
            if (i == side - 1 || j == side - 1) continue;
            const uint32_t square[6] = {at, at + 1, at + side + 1, at, at + side + 1, at + side};
            memcpy(corner, square, sizeof square);
            corner += 6;
        }
    return recipe;
}

void tile_recipe_relief(struct tile_recipe *recipe, const double bounds[4]) {
    double width = bounds[2] - bounds[0], height = bounds[3] - bounds[1];
    for (uint32_t i = 0; i < recipe->vertex_count; i++) {
        double x = bounds[0] + width * recipe->u[i] / TOP, y = bounds[1] + height * recipe->v[i] / TOP;
        recipe->h[i] = (uint16_t)lround(16000.3 + 9000 * sin(5 * RADIANS * x) + 6000 * cos(0.07 * y)); /* once around */
    }
}

static void ecef(double lon_deg, double lat_deg, double height_m, double out[3]) {
    double ratio = RADIUS_POLE / RADIUS_EQUATOR, e2 = 1 - ratio * ratio;
    double n = RADIUS_EQUATOR / sqrt(1 - e2 * pow(sin(lat_deg * RADIANS), 2));
    out[0] = (n + height_m) * cos(lat_deg * RADIANS) * cos(lon_deg * RADIANS);
    out[1] = (n + height_m) * cos(lat_deg * RADIANS) * sin(lon_deg * RADIANS);
    out[2] = (n * (1 - e2) + height_m) * sin(lat_deg * RADIANS);
}

static void vertex_point(const struct tile_recipe *recipe, uint32_t i, enum profile profile, const double bounds[4],
                         double point[3]) {
    double x = bounds[0] + (bounds[2] - bounds[0]) * recipe->u[i] / TOP;
    double y = bounds[1] + (bounds[3] - bounds[1]) * recipe->v[i] / TOP;
    double z = recipe->height_min_m + recipe->h[i] * (((double)recipe->height_max_m - recipe->height_min_m) / TOP);
    if (profile == PROFILE_GEODETIC) {
        ecef(x, y, z, point);
    } else {
        point[0] = x;
        point[1] = y;
        point[2] = z;
    }
}

static double length(const double a[3]) {
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* How far along `unit` (scaled space) a point has to be to be seen from wherever `point_m` is seen. */
static double occlusion_magnitude(const double unit[3], const double point_m[3]) {
    double s[3] = {point_m[0] / RADIUS_EQUATOR, point_m[1] / RADIUS_EQUATOR, point_m[2] / RADIUS_POLE};
    double size = length(s), cosine = (s[0] * unit[0] + s[1] * unit[1] + s[2] * unit[2]) / size;
    double angle = acos(fmin(1, cosine)) + acos(1 / fmax(size, 1));
    return angle < 1.57 ? 1 / cos(angle) : 1e6;
}

void tile_recipe_header(struct tile_recipe *recipe, enum profile profile, const double bounds[4]) {
    double x = (bounds[0] + bounds[2]) / 2, y = (bounds[1] + bounds[3]) / 2, magnitude = 1;
    double *center = recipe->center_m;
    if (profile == PROFILE_GEODETIC) {
        ecef(x, y, 0, center);
    } else {
        center[0] = x;
        center[1] = y;
        center[2] = 0;
    }
    double unit[3] = {center[0] / RADIUS_EQUATOR, center[1] / RADIUS_EQUATOR, center[2] / RADIUS_POLE};
    double size = length(unit);
    for (int k = 0; k < 3; k++) unit[k] /= size;
    memcpy(recipe->sphere_center_m, center, sizeof recipe->center_m);
    recipe->sphere_radius_m = 0;
    for (uint32_t i = 0; i < recipe->vertex_count; i++) {
        double point[3], offset[3];
        vertex_point(recipe, i, profile, bounds, point);
        for (int k = 0; k < 3; k++) offset[k] = point[k] - center[k];
        recipe->sphere_radius_m = fmax(recipe->sphere_radius_m, length(offset));
        if (profile == PROFILE_GEODETIC) magnitude = fmax(magnitude, occlusion_magnitude(unit, point));
    }
    recipe->sphere_radius_m += 0.01;
    for (int k = 0; k < 3; k++) recipe->occlusion[k] = profile == PROFILE_GEODETIC ? magnitude * 1.000001 * unit[k] : 0;
}

static void write_codes(struct scree_writer *writer, const uint16_t *codes, const uint32_t *order, uint32_t count) {
    int32_t before = 0;
    for (uint32_t i = 0; i < count; i++) {
        int32_t difference = codes[order[i]] - before;
        scree_write_u16(writer, (uint16_t)(difference < 0 ? -2 * difference - 1 : 2 * difference));
        before = codes[order[i]];
    }
}

static void write_index(struct scree_writer *writer, uint32_t index, bool wide) {
    if (wide) {
        scree_write_u32(writer, index);
    } else {
        scree_write_u16(writer, (uint16_t)index);
    }
}

/* order[new] = old and number[old] = new, by first use. Returns how many vertices the triangles use. */
static uint32_t renumber(const struct tile_recipe *recipe, uint32_t *order, uint32_t *number) {
    uint32_t next = 0;
    memset(number, 0xff, recipe->vertex_count * sizeof *number);
    for (size_t i = 0; i < 3 * (size_t)recipe->triangle_count; i++) {
        uint32_t old = recipe->corners[i];
        if (number[old] != UINT32_MAX) continue;
        number[old] = next;
        order[next++] = old;
    }
    uint32_t used = next;
    for (uint32_t old = 0; old < recipe->vertex_count; old++) {
        if (number[old] != UINT32_MAX) continue;
        number[old] = next;
        order[next++] = old;
    }
    return used;
}

unsigned char *tile_recipe_encode(const struct tile_recipe *recipe, size_t *size_bytes) {
    size_t capacity_bytes = 200 + 30 * (size_t)recipe->vertex_count + 12 * (size_t)recipe->triangle_count;
    unsigned char *bytes = malloc(capacity_bytes);
    uint32_t *order = malloc((recipe->vertex_count + 1) * sizeof *order);
    uint32_t *number = malloc((recipe->vertex_count + 1) * sizeof *number);
    bool wide = recipe->vertex_count > MOST_CODE_WIDTH;
    struct scree_writer writer = scree_writer(bytes, capacity_bytes);
    renumber(recipe, order, number);
    for (int k = 0; k < 3; k++) scree_write_f64(&writer, recipe->center_m[k]);
    scree_write_f32(&writer, recipe->height_min_m);
    scree_write_f32(&writer, recipe->height_max_m);
    for (int k = 0; k < 3; k++) scree_write_f64(&writer, recipe->sphere_center_m[k]);
    scree_write_f64(&writer, recipe->sphere_radius_m);
    for (int k = 0; k < 3; k++) scree_write_f64(&writer, recipe->occlusion[k]);
    scree_write_u32(&writer, recipe->vertex_count);
    write_codes(&writer, recipe->u, order, recipe->vertex_count);
    write_codes(&writer, recipe->v, order, recipe->vertex_count);
    write_codes(&writer, recipe->h, order, recipe->vertex_count);
    scree_write_align(&writer, wide ? 4 : 2);
    scree_write_u32(&writer, recipe->triangle_count);
    uint32_t highest = 0;
    for (size_t i = 0; i < 3 * (size_t)recipe->triangle_count; i++) {
        uint32_t vertex = number[recipe->corners[i]];
        write_index(&writer, highest - vertex, wide);
        if (vertex == highest) highest++;
    }
    for (int s = 0; s < 4; s++) {
        scree_write_u32(&writer, recipe->edge_count[s]);
        for (uint32_t i = 0; i < recipe->edge_count[s]; i++) write_index(&writer, number[recipe->edges[s][i]], wide);
    }
    if (recipe->normals != NULL) {
        scree_write_u8(&writer, 1);
        scree_write_u32(&writer, 2 * recipe->vertex_count);
        for (uint32_t i = 0; i < recipe->vertex_count; i++)
            scree_write_bytes(&writer, recipe->normals + 2 * order[i], 2);
    }
    free(number);
    free(order);
    *size_bytes = writer.at_bytes;
    return bytes;
}

void tile_recipe_free(struct tile_recipe *recipe) {
    free(recipe->u);
    free(recipe->v);
    free(recipe->h);
    free(recipe->corners);
    free(recipe->normals);
    for (int s = 0; s < 4; s++) free(recipe->edges[s]);
    *recipe = (struct tile_recipe){0};
}

unsigned char *tile_gzip(const unsigned char *bytes, size_t size_bytes, size_t *gzip_bytes) {
    z_stream zlib = {0};
    deflateInit2(&zlib, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
    size_t capacity_bytes = deflateBound(&zlib, size_bytes);
    unsigned char *packed = malloc(capacity_bytes);
    zlib.next_in = (unsigned char *)bytes;
    zlib.avail_in = (unsigned)size_bytes;
    zlib.next_out = packed;
    zlib.avail_out = (unsigned)capacity_bytes;
    deflate(&zlib, Z_FINISH);
    *gzip_bytes = zlib.total_out;
    deflateEnd(&zlib);
    return packed;
}

const char *tile_test_data(const char *test) {
    const char *folder = getenv("SCREE_TEST_DATA");
    struct stat status;
    if (folder == NULL) folder = TEST_DATA_DEFAULT;
    if (stat(folder, &status) == 0) return folder;
    printf("\n    skipped: %s: there are no test data at %s (SCREE_TEST_DATA says where they are)\n", test, folder);
    return NULL;
}
