/* scree info: what is in static tiles and streams, or in one of either. */
#include "src/command.h"
#include "src/info_stream_io.h"
#include "src/json_text.h"
#include "src/terrain_path_io.h"
#include "src/terrain_set_io.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "Usage: scree info OUT|TILE.scree|TILE.terrain [--format json]\n"
    "Tells what a terrain holds at each zoom, as its manifests have it: static tiles (layer.json), streams\n"
    "(scree.json) or both. Of one stream: its rungs, with SVO, max error, counts, and the bytes that a client has "
    "read\n"
    "when it shows them; of a static tile, of any producer, what it holds.\n\n"
    "  --format json   for machines; streams are the member \"streams\"\n\n"
    "A stream that lacks its end is told of: the rungs that are whole can be played.\n";

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree info: %s%s; scree info --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* ---- a terrain ---- */

static const char *profile_name(const struct terrain_set *set) {
    return set->layer.lattice.profile == PROFILE_GEODETIC ? "geodetic" : "local";
}

static void print_set(const struct terrain_set *set) {
    const struct layer_info *layer = &set->layer;
    printf("%s: quantized-mesh terrain, %s profile, zooms %d to %d%s%s\n", set->folder, profile_name(set),
           layer->min_zoom, layer->max_zoom, layer->has_normals ? ", normals" : "", layer->is_gzipped ? ", gzip" : "");
    printf("bounds  %.9g %.9g %.9g %.9g\n", layer->bounds[0], layer->bounds[1], layer->bounds[2], layer->bounds[3]);
    if (layer->datum[0] != '\0') printf("%s\n", layer->datum);
    if (layer->attribution[0] != '\0') printf("source  %s\n", layer->attribution);
    printf("\n  zoom      tiles    vertices   triangles        bytes  tolerance m  max error m        SVO m\n");
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        const struct layer_zoom_info *told = &layer->zooms[zoom];
        if (told->is_told) {
            printf("  %4d %10" PRIu64 " %11" PRIu64 " %11" PRIu64 " %12" PRIu64 " %12.4g %12.4g %12.4g\n", zoom,
                   told->tiles, told->vertices, told->triangles, told->bytes, told->tolerance_m, told->max_error_m,
                   told->svo_m);
        } else if (set->tiles[zoom].count != 0) {
            printf("  %4d %10" PRIu32 " %11s %11s %12s %12s %12s %12s\n", zoom, set->tiles[zoom].count, "-", "-", "-",
                   "-", "-", "-");
        }
    }
}

static void put_zoom(struct json_text *json, const struct terrain_set *set, int zoom) {
    const struct layer_zoom_info *told = &set->layer.zooms[zoom];
    json_open_line(json, '{');
    json_key(json, "zoom");
    json_integer(json, zoom);
    json_key(json, "tiles");
    json_integer(json, told->is_told ? (int64_t)told->tiles : (int64_t)set->tiles[zoom].count);
    if (told->is_told) {
        json_key(json, "vertices");
        json_integer(json, (int64_t)told->vertices);
        json_key(json, "triangles");
        json_integer(json, (int64_t)told->triangles);
        json_key(json, "bytes");
        json_integer(json, (int64_t)told->bytes);
        json_key(json, "tolerance_m");
        json_number(json, told->tolerance_m);
        json_key(json, "max_error_m");
        json_number(json, told->max_error_m);
        json_key(json, "svo_m");
        json_number(json, told->svo_m);
    }
    json_close(json, '}');
}

/* The members of the terrain's object. */
static void put_set(struct json_text *json, const struct terrain_set *set) {
    const struct layer_info *layer = &set->layer;
    json_key(json, "terrain");
    json_string(json, set->folder);
    json_key(json, "profile");
    json_string(json, profile_name(set));
    json_key(json, "made_by_scree");
    json_boolean(json, layer->is_ours);
    json_key(json, "min_zoom");
    json_integer(json, layer->min_zoom);
    json_key(json, "max_zoom");
    json_integer(json, layer->max_zoom);
    json_key(json, "bounds");
    json_open_line(json, '[');
    for (int i = 0; i < 4; i++) json_number(json, layer->bounds[i]);
    json_close(json, ']');
    json_key(json, "normals");
    json_boolean(json, layer->has_normals);
    json_key(json, "gzip");
    json_boolean(json, layer->is_gzipped);
    json_key(json, "datum");
    json_string(json, layer->datum);
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++)
        if (layer->zooms[zoom].is_told || set->tiles[zoom].count != 0) put_zoom(json, set, zoom);
    json_close(json, ']');
}

static enum scree_status show_set(struct scree_memory *memory, const char *path, struct json_text *json,
                                  struct scree_error *error) {
    struct terrain_set *set = calloc(1, sizeof *set);
    if (set == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    enum scree_status status = terrain_set_open(memory, path, set, error);
    if (status == SCREE_OK && json != NULL) {
        put_set(json, set);
    } else if (status == SCREE_OK) {
        print_set(set);
    }
    terrain_set_free(memory, set);
    free(set);
    return status;
}

/* ---- a tile ---- */

static void print_tile(const char *path, const struct decoded_tile *tile, uint64_t file_bytes) {
    printf("%s: quantized-mesh-1.0 tile, %" PRIu64 " bytes\n", path, file_bytes);
    printf("  vertices   %" PRIu32 "\n  triangles  %" PRIu32 "\n", tile->vertex_count, tile->triangle_count);
    printf("  edges      %" PRIu32 " west, %" PRIu32 " south, %" PRIu32 " east, %" PRIu32 " north\n",
           tile->edge_count[EDGE_WEST], tile->edge_count[EDGE_SOUTH], tile->edge_count[EDGE_EAST],
           tile->edge_count[EDGE_NORTH]);
    printf("  heights    %.9g to %.9g m, in steps of %.6g m\n", tile->height_min_m, tile->height_max_m,
           decoded_step_m(tile));
    printf("  centre     %.3f %.3f %.3f\n", tile->center_m[0], tile->center_m[1], tile->center_m[2]);
    printf("  sphere     %.3f %.3f %.3f, radius %.3f m\n", tile->sphere_center_m[0], tile->sphere_center_m[1],
           tile->sphere_center_m[2], tile->sphere_radius_m);
    printf("  occlusion  %.9g %.9g %.9g\n", tile->occlusion[0], tile->occlusion[1], tile->occlusion[2]);
    printf("  extensions%s%s%s", tile->normals != NULL ? " normals" : "", tile->has_water_mask ? " water-mask" : "",
           tile->has_metadata ? " metadata" : "");
    if (tile->unknown_extensions != 0) printf(" and %" PRIu32 " unknown", tile->unknown_extensions);
    if (tile->normals == NULL && !tile->has_water_mask && !tile->has_metadata && tile->unknown_extensions == 0)
        printf(" none");
    printf("\n");
}

static void put_point(struct json_text *json, const char *key, const double point[3]) {
    json_key(json, key);
    json_open_line(json, '[');
    for (int i = 0; i < 3; i++) json_number(json, point[i]);
    json_close(json, ']');
}

static void put_tile(struct json_text *json, const char *path, const struct decoded_tile *tile, uint64_t file_bytes) {
    json_open(json, '{');
    json_key(json, "tile");
    json_string(json, path);
    json_key(json, "bytes");
    json_integer(json, (int64_t)file_bytes);
    json_key(json, "vertices");
    json_integer(json, tile->vertex_count);
    json_key(json, "triangles");
    json_integer(json, tile->triangle_count);
    json_key(json, "edges");
    json_open_line(json, '[');
    for (int side = 0; side < EDGE_COUNT; side++) json_integer(json, tile->edge_count[side]);
    json_close(json, ']');
    json_key(json, "height_min_m");
    json_number(json, tile->height_min_m);
    json_key(json, "height_max_m");
    json_number(json, tile->height_max_m);
    put_point(json, "center_m", tile->center_m);
    put_point(json, "sphere_center_m", tile->sphere_center_m);
    json_key(json, "sphere_radius_m");
    json_number(json, tile->sphere_radius_m);
    put_point(json, "occlusion", tile->occlusion);
    json_key(json, "normals");
    json_boolean(json, tile->normals != NULL);
    json_key(json, "water_mask");
    json_boolean(json, tile->has_water_mask);
    json_key(json, "metadata");
    json_boolean(json, tile->has_metadata);
    json_key(json, "unknown_extensions");
    json_integer(json, tile->unknown_extensions);
    json_close(json, '}');
}

static enum scree_status show_tile(struct scree_memory *memory, const char *path, struct json_text *json,
                                   struct scree_error *error) {
    struct decoded_tile tile;
    uint64_t file_bytes;
    enum scree_status status = terrain_file_read(memory, path, &tile, &file_bytes, error);
    if (status != SCREE_OK) return status;
    if (json != NULL) {
        put_tile(json, path, &tile, file_bytes);
    } else {
        print_tile(path, &tile, file_bytes);
    }
    decoded_tile_free(memory, &tile);
    return SCREE_OK;
}

/* ---- whatever it is ---- */

/* A folder with static tiles, streams, or both. */
static enum scree_status show_folder(struct scree_memory *memory, const char *path, struct json_text *json,
                                     struct scree_error *error) {
    bool has_terrain = product_is_there(path, PRODUCT_TERRAIN), has_streams = product_is_there(path, PRODUCT_STREAM);
    enum scree_status status = SCREE_OK;
    if (!has_terrain && !has_streams) return product_fail_none(path, error);
    if (json != NULL) json_open(json, '{');
    if (has_terrain) status = show_set(memory, path, json, error);
    if (has_streams && status == SCREE_OK) {
        if (json != NULL) json_key(json, "streams");
        if (json == NULL && has_terrain) printf("\n");
        status = info_stream_set(memory, path, json, error);
    }
    if (json != NULL) json_close(json, '}');
    return status;
}

static enum scree_status show(const char *path, bool as_json, struct scree_error *error) {
    struct scree_memory memory = {0};
    struct json_text json = {0}, *to = as_json ? &json : NULL;
    enum scree_status status;
    if (terrain_path_is_tile(path)) {
        status = show_tile(&memory, path, to, error);
    } else if (stream_path_is_tile(path)) {
        status = info_stream_file(&memory, path, to, error);
    } else {
        status = show_folder(&memory, path, to, error);
    }
    if (status != SCREE_OK) json_text_free(&json);
    if (status != SCREE_OK || !as_json) return status;
    char *text = json_text_take(&json);
    if (text == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    fputs(text, stdout);
    free(text);
    return SCREE_OK;
}

int command_info(int argc, char **argv) {
    const char *path = NULL;
    bool as_json = false;
    struct scree_error error = {0};
    for (int at = 1; at < argc; at++) {
        if (strcmp(argv[at], "--help") == 0 || strcmp(argv[at], "-h") == 0) {
            fputs(help, stdout);
            return EXIT_DONE;
        }
        if (strcmp(argv[at], "--format") == 0) {
            if (++at == argc || (strcmp(argv[at], "json") != 0 && strcmp(argv[at], "text") != 0))
                return usage("--format wants text or json", "");
            as_json = strcmp(argv[at], "json") == 0;
        } else if (argv[at][0] == '-' && argv[at][1] != '\0') {
            return usage("there is no option ", argv[at]);
        } else if (path != NULL) {
            return usage("one terrain at a time, and then there is ", argv[at]);
        } else {
            path = argv[at];
        }
    }
    if (path == NULL) return usage("which terrain? Name a folder, a .scree or a .terrain file", "");
    if (show(path, as_json, &error) == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree info: %s\n", error.text);
    return EXIT_FAILED;
}
