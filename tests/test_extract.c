/* extract: tiles are joined to one mesh, placed in space, and written in each format. */
#include "src/extract_mesh.h"
#include "src/mesh_file_io.h"
#include "src/terrain_path_io.h"
#include "tests/terrain_maker.h"
#include "tests/tile_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELLS 6

static enum scree_status add_recipe(struct scree_memory *memory, struct extract_mesh *mesh, struct tile_id id,
                                    struct tile_recipe *recipe) {
    struct decoded_tile tile;
    size_t size_bytes;
    struct scree_memory other = {0};
    unsigned char *bytes = tile_recipe_encode(recipe, &size_bytes);
    CU_ASSERT_EQUAL_FATAL(decoded_tile_read(&other, bytes, size_bytes, &tile, NULL), SCREE_OK);
    enum scree_status status = extract_mesh_add(memory, mesh, id, &tile, NULL);
    decoded_tile_free(&other, &tile);
    free(bytes);
    tile_recipe_free(recipe);
    return status;
}

/* All tiles of zoom 1, flat. */
static enum scree_status add_globe(struct scree_memory *memory, struct extract_mesh *mesh) {
    enum scree_status status = SCREE_OK;
    mesh->zoom = 1;
    for (uint32_t x = 0; x < 4 && status == SCREE_OK; x++)
        for (uint32_t y = 0; y < 2 && status == SCREE_OK; y++) {
            struct tile_recipe recipe = tile_recipe_grid(CELLS, DECODED_TOP, DECODED_TOP);
            status = add_recipe(memory, mesh, (struct tile_id){.zoom = 1, .x = x, .y = y}, &recipe);
        }
    return status;
}

/* Every edge of a closed surface has its opposite. */
static size_t open_edges(const struct extract_mesh *mesh) {
    size_t open = 0, count = 3 * (size_t)mesh->triangle_count;
    for (size_t e = 0; e < count; e++) {
        uint32_t a = mesh->corners[e], b = mesh->corners[e - e % 3 + (e + 1) % 3];
        bool found = false;
        for (size_t f = 0; f < count && !found; f++)
            found = mesh->corners[f] == b && mesh->corners[f - f % 3 + (f + 1) % 3] == a;
        open += !found;
    }
    return open;
}

static void the_globe_is_closed(void) {
    struct lattice lattice = lattice_geodetic(1);
    struct scree_memory memory = {0};
    struct extract_mesh mesh = {.lattice = &lattice};
    CU_ASSERT_EQUAL(add_globe(&memory, &mesh), SCREE_OK);
    CU_ASSERT_EQUAL(mesh.vertex_count, 4 * CELLS * (2 * CELLS - 1) + 2); /* and the poles */
    CU_ASSERT_EQUAL(mesh.triangle_count, 2 * mesh.vertex_count - 4);     /* Euler, for a sphere */
    CU_ASSERT_EQUAL(open_edges(&mesh), 0);
    CU_ASSERT_EQUAL(extract_mesh_place(&memory, &mesh, NULL, NULL), SCREE_OK);
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        double x = mesh.xyz[3 * i] + mesh.origin[0], y = mesh.xyz[3 * i + 1] + mesh.origin[1];
        double z = mesh.xyz[3 * i + 2] + mesh.origin[2];
        double radius_m = sqrt(x * x + y * y + z * z);
        CU_ASSERT(radius_m > 6356752 - 101 && radius_m < 6378137 - 99); /* the ellipsoid, 100 m lower */
    }
    extract_mesh_free(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void different_heights_stay_apart(void) {
    struct lattice lattice = lattice_geodetic(1);
    struct scree_memory memory = {0};
    struct extract_mesh mesh = {.lattice = &lattice, .zoom = 1};
    for (uint32_t x = 0; x < 2; x++) {
        struct tile_recipe recipe = tile_recipe_grid(1, DECODED_TOP, DECODED_TOP);
        if (x == 1) recipe.h[2] = 1; /* its north-western corner, at the pole; the south-western one is shared */
        CU_ASSERT_EQUAL(add_recipe(&memory, &mesh, (struct tile_id){.zoom = 1, .x = x, .y = 1}, &recipe), SCREE_OK);
    }
    /* at the equator 3; at the pole the tiles' corners are one place, with two heights */
    CU_ASSERT_EQUAL(mesh.vertex_count, 3 + 2);
    extract_mesh_free(&memory, &mesh);
}

static void places_are_metres_of_the_horizon(void) {
    struct lattice lattice = lattice_geodetic(10);
    struct tile_id id = {.zoom = 10, .x = 1070, .y = 778};
    struct scree_memory memory = {0};
    struct extract_mesh mesh = {.lattice = &lattice, .zoom = 10};
    struct tile_recipe recipe = tile_recipe_grid(2, DECODED_TOP, DECODED_TOP);
    double bounds[4], east_m, north_m;
    recipe.v[4] = recipe.u[4] = 16384;
    CU_ASSERT_EQUAL(add_recipe(&memory, &mesh, id, &recipe), SCREE_OK);
    lattice_tile_bounds(&lattice, id, bounds);
    struct horizon_frame frame = place_horizon((bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2);
    CU_ASSERT_EQUAL(extract_mesh_place(&memory, &mesh, &frame, NULL), SCREE_OK);
    lattice_steps_m(&lattice, 778 * 256 + 128, &east_m, &north_m);
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < mesh.vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], mesh.xyz[3 * i + (uint32_t)k]);
            high[k] = fmax(high[k], mesh.xyz[3 * i + (uint32_t)k]);
        }
    CU_ASSERT_DOUBLE_EQUAL(high[0] - low[0], 256 * east_m, 60); /* meridians draw together */
    CU_ASSERT_DOUBLE_EQUAL(high[1] - low[1], 256 * north_m, 60);
    CU_ASSERT_DOUBLE_EQUAL(high[2], -100, 0.1); /* the middle; the corners lie lower by s^2 / 2R */
    CU_ASSERT_DOUBLE_EQUAL(low[2], -100 - (pow(128 * east_m, 2) + pow(128 * north_m, 2)) / (2 * 6371008.8), 0.5);
    CU_ASSERT_EQUAL(mesh.origin[0], 0);
    extract_mesh_free(&memory, &mesh);
}

static void large_coordinates_of_a_crs_are_reduced(void) {
    struct lattice lattice;
    struct scree_memory memory = {0};
    struct extract_mesh mesh = {.lattice = &lattice};
    CU_ASSERT_EQUAL_FATAL(lattice_local(257, 257, 350000.5, 5700000.25, 1, 1, 1, &lattice, NULL), SCREE_OK);
    struct tile_recipe recipe = tile_recipe_grid(1, DECODED_TOP, DECODED_TOP);
    CU_ASSERT_EQUAL(add_recipe(&memory, &mesh, (struct tile_id){0}, &recipe), SCREE_OK);
    CU_ASSERT_EQUAL(extract_mesh_place(&memory, &mesh, NULL, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(mesh.origin[0], 350128);
    CU_ASSERT_EQUAL(mesh.origin[1], 5700128);
    CU_ASSERT_EQUAL(mesh.origin[2], 0);
    CU_ASSERT_EQUAL(mesh.xyz[0], -127.5);
    CU_ASSERT_EQUAL(mesh.xyz[1], -127.75);
    CU_ASSERT_EQUAL(mesh.xyz[2], -100);
    extract_mesh_free(&memory, &mesh);
}

static void every_allocation_may_fail(void) {
    struct lattice lattice = lattice_geodetic(1);
    enum scree_status status = SCREE_E_MEMORY;
    uint64_t request = 0;
    while (status != SCREE_OK && request < 100) {
        struct scree_memory memory = {.fail_request = ++request};
        struct extract_mesh mesh = {.lattice = &lattice};
        status = add_globe(&memory, &mesh);
        if (status == SCREE_OK) status = extract_mesh_place(&memory, &mesh, NULL, NULL);
        CU_ASSERT(status == SCREE_OK || status == SCREE_E_MEMORY);
        extract_mesh_free(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_EQUAL(status, SCREE_OK);
    CU_ASSERT(request > 8);
}

/* ---- files ---- */

static char *read_text(const char *path, size_t *size_bytes) {
    FILE *file = fopen(path, "rb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    char *text = calloc(1, 100001);
    *size_bytes = fread(text, 1, 100000, file);
    fclose(file);
    return text;
}

static size_t count_lines(const char *text, const char *beginning) {
    size_t count = 0;
    for (const char *line = text; line != NULL; line = strchr(line, '\n')) {
        if (*line == '\n') line++;
        count += strncmp(line, beginning, strlen(beginning)) == 0;
    }
    return count;
}

static void every_format_is_written(void) {
    static const char *const endings[] = {"ply", "obj", "stl", "OFF"};
    const double xyz[] = {0, 0, 1.5, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    const uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    struct made_terrain folder = made_terrain_globe(false); /* for its folder */
    for (size_t i = 0; i < 4; i++) {
        char path[400];
        size_t size_bytes;
        snprintf(path, sizeof path, "%s/mesh.%s", folder.folder, endings[i]);
        CU_ASSERT_EQUAL(mesh_file_write(path, xyz, 4, corners, 2, NULL), SCREE_OK);
        CU_ASSERT_EQUAL(mesh_file_write(path, xyz, 4, corners, 2, NULL), SCREE_OK); /* over the first one */
        char *text = read_text(path, &size_bytes);
        if (i == 0) {
            CU_ASSERT_EQUAL(count_lines(text, "format binary_little_endian"), 1);
            CU_ASSERT_EQUAL(count_lines(text, "element vertex 4"), 1);
            CU_ASSERT_EQUAL(count_lines(text, "element face 2"), 1);
            const char *body = strstr(text, "end_header\n");
            CU_ASSERT_PTR_NOT_NULL_FATAL(body);
            CU_ASSERT_EQUAL(size_bytes - (size_t)(body + 11 - text), 4 * 12 + 2 * 13);
        }
        if (i == 1) {
            CU_ASSERT_EQUAL(count_lines(text, "v "), 4);
            CU_ASSERT_EQUAL(count_lines(text, "f "), 2);
            CU_ASSERT_EQUAL(count_lines(text, "f 1 2 3"), 1);
        }
        if (i == 2) CU_ASSERT_EQUAL(size_bytes, 84 + 2 * 50);
        if (i == 3) CU_ASSERT_EQUAL(strncmp(text, "OFF\n4 2 0\n0 0 1.5\n", 18), 0);
        free(text);
    }
    made_terrain_remove(&folder);
}

/* Three triangles at one edge are no surface; none of them is lost. */
static void triangles_that_make_no_surface_are_kept(void) {
    const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
    const uint32_t corners[] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    struct made_terrain folder = made_terrain_globe(false);
    char path[400];
    size_t size_bytes;
    snprintf(path, sizeof path, "%s/mesh.obj", folder.folder);
    CU_ASSERT_EQUAL(mesh_file_write(path, xyz, 5, corners, 3, NULL), SCREE_OK);
    char *text = read_text(path, &size_bytes);
    CU_ASSERT_EQUAL(count_lines(text, "f "), 3);
    CU_ASSERT_EQUAL(count_lines(text, "v "), 5 + 3);
    free(text);
    made_terrain_remove(&folder);
}

static void what_cannot_be_written_is_said(void) {
    const double xyz[9] = {0};
    const uint32_t corners[] = {0, 1, 2};
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(mesh_file_write("no/such/folder/mesh.ply", xyz, 3, corners, 1, &error), SCREE_E_IO);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "no/such/folder"));
    CU_ASSERT_EQUAL(mesh_file_write("mesh.xyz", xyz, 3, corners, 1, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_FALSE(mesh_file_is_known("a.ply/mesh"));
    CU_ASSERT_FALSE(mesh_file_is_known("mesh"));
    CU_ASSERT_TRUE(mesh_file_is_known("a/b.STL"));
}

static void names_of_tiles_are_parsed_strictly(void) {
    static const char *const bad[] = {"",       "1",      "1/2",     "1/2/3/4", "-1/2/3",
                                      "+1/2/3", "23/0/0", "1/02/3",  "1/2/",    "1//3",
                                      " 1/2/3", "1/2/3 ", "0x1/2/3", "1/2/3.5", "1/2/99999999999"};
    struct tile_id id;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) CU_ASSERT_FALSE(tile_id_parse(bad[i], &id));
    CU_ASSERT_TRUE(tile_id_parse("22/4294967295/0", &id));
    CU_ASSERT(id.zoom == 22 && id.x == UINT32_MAX && id.y == 0);
    CU_ASSERT_TRUE(terrain_path_tile("some/where/10/1070/778.terrain", &id));
    CU_ASSERT(id.zoom == 10 && id.x == 1070 && id.y == 778);
    CU_ASSERT_TRUE(terrain_path_tile("10/1070/778.terrain", &id));
    CU_ASSERT_FALSE(terrain_path_tile("a10/1070/778.terrain", &id));
    CU_ASSERT_FALSE(terrain_path_tile("10/1070/778.terrain.gz", &id));
}

int suite_extract(void) {
    CU_TestInfo tests[] = {
        {"the globe is closed", the_globe_is_closed},
        {"different heights stay apart", different_heights_stay_apart},
        {"places are metres of the horizon", places_are_metres_of_the_horizon},
        {"large coordinates of a CRS are reduced", large_coordinates_of_a_crs_are_reduced},
        {"every allocation may fail", every_allocation_may_fail},
        {"every format is written", every_format_is_written},
        {"triangles that make no surface are kept", triangles_that_make_no_surface_are_kept},
        {"what cannot be written is said", what_cannot_be_written_is_said},
        {"names of tiles are parsed strictly", names_of_tiles_are_parsed_strictly},
        CU_TEST_INFO_NULL,
    };
    CU_SuiteInfo suites[] = {{"extract", NULL, NULL, NULL, NULL, tests}, CU_SUITE_INFO_NULL};
    return CU_register_suites(suites) == CUE_SUCCESS ? 0 : 1;
}
