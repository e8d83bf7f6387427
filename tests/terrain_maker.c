#include "tests/terrain_maker.h"

#include "src/layer_json.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void tile_path(const struct made_terrain *terrain, struct tile_id id, char path[400]) {
    snprintf(path, 400, "%s/%d/%u/%u.terrain", terrain->folder, id.zoom, (unsigned)id.x, (unsigned)id.y);
}

static void write_file(const char *path, const void *bytes, size_t size_bytes) {
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(bytes, 1, size_bytes, file) != size_bytes || fclose(file) != 0) {
        perror(path);
        exit(99);
    }
}

struct tile_recipe made_terrain_recipe(struct tile_id id, bool has_normals) {
    struct lattice lattice = lattice_geodetic(MADE_FINEST);
    struct tile_recipe recipe = tile_recipe_grid(MADE_CELLS, 32767, 32767);
    double bounds[4];
    lattice_tile_bounds(&lattice, id, bounds);
    tile_recipe_relief(&recipe, bounds);
    tile_recipe_header(&recipe, PROFILE_GEODETIC, bounds);
    if (!has_normals) return recipe;
    recipe.normals = calloc(recipe.vertex_count, 2);
    for (uint32_t i = 0; i < recipe.vertex_count; i++) { /* a function of the place, as normals are */
        recipe.normals[2 * i] = (uint8_t)recipe.h[i];
        recipe.normals[2 * i + 1] = (uint8_t)(recipe.h[i] >> 8);
    }
    return recipe;
}

static void write_tile(struct made_terrain *terrain, struct tile_id id, struct tile_recipe *recipe) {
    char path[400];
    struct stat before;
    size_t size_bytes;
    unsigned char *bytes = tile_recipe_encode(recipe, &size_bytes);
    tile_path(terrain, id, path);
    if (stat(path, &before) == 0) terrain->bytes[id.zoom] -= (uint64_t)before.st_size;
    if ((id.x + id.y) % 2 == 1) {
        size_t gzip_bytes;
        unsigned char *packed = tile_gzip(bytes, size_bytes, &gzip_bytes);
        write_file(path, packed, gzip_bytes);
        terrain->bytes[id.zoom] += gzip_bytes;
        free(packed);
    } else {
        write_file(path, bytes, size_bytes);
        terrain->bytes[id.zoom] += size_bytes;
    }
    free(bytes);
    tile_recipe_free(recipe);
}

void made_terrain_manifest(const struct made_terrain *terrain, uint32_t finest_tiles) {
    struct lattice lattice = lattice_geodetic(MADE_FINEST);
    struct tile_id roots[2] = {{.x = 0}, {.x = 1}}, finest[8];
    for (uint32_t i = 0; i < 8; i++) finest[i] = (struct tile_id){.zoom = 1, .x = i % 4, .y = i / 4};
    const uint64_t vertices = MADE_SIDE * MADE_SIDE, triangles = 2 * MADE_CELLS * MADE_CELLS;
    struct layer_zoom zooms[2] = {
        {.tolerance_m = 200, .max_error_m = 180, .svo_m = 50, .tile_count = 2, .tiles = roots},
        {.tolerance_m = 100, .max_error_m = 90, .svo_m = 25, .tile_count = finest_tiles, .tiles = finest}};
    for (int zoom = 0; zoom < 2; zoom++) {
        zooms[zoom].height_step_m = 1.0 / 16;
        zooms[zoom].vertices = zooms[zoom].tile_count * vertices;
        zooms[zoom].triangles = zooms[zoom].tile_count * triangles;
        zooms[zoom].bytes = terrain->bytes[zoom];
    }
    struct layer layer = {.lattice = &lattice,
                          .max_zoom = MADE_FINEST,
                          .bounds = {-180, -90, 180, 90},
                          .crs_wkt = "",
                          .datum = "a test's",
                          .attribution = "",
                          .has_normals = terrain->has_normals,
                          .zooms = zooms};
    char *text = layer_json_new(&layer, NULL);
    made_terrain_text(terrain, "layer.json", text);
    free(text);
}

void made_terrain_write(struct made_terrain *terrain, struct tile_id id, struct tile_recipe *recipe) {
    write_tile(terrain, id, recipe);
    made_terrain_manifest(terrain, 8);
}

struct made_terrain made_terrain_globe(bool has_normals) {
    struct made_terrain terrain = {.has_normals = has_normals};
    const char *place = getenv("TMPDIR");
    char path[400];
    snprintf(terrain.folder, sizeof terrain.folder, "%s/scree-test-XXXXXX", place == NULL ? "." : place);
    if (mkdtemp(terrain.folder) == NULL) {
        perror(terrain.folder);
        exit(99);
    }
    for (int zoom = 0; zoom <= MADE_FINEST; zoom++) {
        snprintf(path, sizeof path, "%s/%d", terrain.folder, zoom);
        mkdir(path, 0777);
        for (uint32_t x = 0; x < 2u << zoom; x++) {
            snprintf(path, sizeof path, "%s/%d/%u", terrain.folder, zoom, (unsigned)x);
            mkdir(path, 0777);
            for (uint32_t y = 0; y < 1u << zoom; y++) {
                struct tile_id id = {.zoom = zoom, .x = x, .y = y};
                struct tile_recipe recipe = made_terrain_recipe(id, has_normals);
                write_tile(&terrain, id, &recipe);
            }
        }
    }
    made_terrain_manifest(&terrain, 8);
    return terrain;
}

void made_terrain_text(const struct made_terrain *terrain, const char *name, const char *text) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", terrain->folder, name);
    write_file(path, text, strlen(text));
}

void made_terrain_delete(const struct made_terrain *terrain, struct tile_id id) {
    char path[400];
    tile_path(terrain, id, path);
    remove(path);
}

void made_terrain_truncate(const struct made_terrain *terrain, struct tile_id id, long size_bytes) {
    char path[400];
    tile_path(terrain, id, path);
    if (truncate(path, size_bytes) != 0) perror(path);
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *ftw) {
    (void)status;
    (void)kind;
    (void)ftw;
    return remove(path);
}

void made_terrain_remove(struct made_terrain *terrain) {
    nftw(terrain->folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    terrain->folder[0] = '\0';
}
