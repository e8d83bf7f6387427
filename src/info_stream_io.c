#include "src/info_stream_io.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- a tile ---- */

static const char *profile_name(bool is_geodetic) {
    return is_geodetic ? "geodetic" : "local";
}

/* Where a rung's block ends: the bytes that a client has read when it shows the rung. */
static uint64_t end_of(const struct scree_rung *rung) {
    return rung->offset_bytes + rung->size_bytes;
}

/* How many rungs a file of this size has whole. */
static uint32_t whole_rungs(const struct scree_stream_header *header, uint64_t file_bytes) {
    uint32_t whole = 0;
    while (whole < header->rung_count && end_of(&header->rungs[whole]) <= file_bytes) whole++;
    return whole;
}

static void print_tile(const char *path, const struct scree_stream_header *header, uint64_t file_bytes) {
    uint32_t whole = whole_rungs(header, file_bytes);
    uint64_t wanted_bytes = end_of(&header->rungs[header->rung_count - 1]);
    printf("%s: stream version %" PRIu32 " of tile %d/%" PRIu32 "/%" PRIu32 ", %s profile, %" PRIu64 " bytes\n", path,
           header->version, header->zoom, header->tile_x, header->tile_y,
           profile_name(header->profile == SCREE_GEODETIC), file_bytes);
    printf("covers  %.9g %.9g %.9g %.9g, %" PRId32 " x %" PRId32 " lattice steps\n", header->west, header->south,
           header->west + header->columns * header->spacing_x, header->south + header->rows * header->spacing_y,
           header->columns, header->rows);
    printf("heights in steps of %.9g m, header of %" PRIu32 " bytes\n", ldexp(1, header->height_exponent),
           header->size_bytes);
    printf("\n  rung        SVO m  max error m   vertices  triangles  bytes so far\n");
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        printf("  %4" PRId32 " %12.4g %12.4g %10" PRIu32 " %10" PRIu32 " %13" PRIu64 "%s\n", rung->rung, rung->svo_m,
               rung->max_error_m, rung->vertex_count, rung->triangle_count, end_of(rung),
               i < whole ? "" : "  not in the file");
    }
    if (file_bytes < wanted_bytes)
        printf("\nThe file ends after %" PRIu64 " of %" PRIu64 " bytes: %" PRIu32 " of %" PRIu32 " rungs are whole.\n",
               file_bytes, wanted_bytes, whole, header->rung_count);
    if (file_bytes > wanted_bytes)
        printf("\nThe stream ends after %" PRIu64 " bytes: what follows is not part of it.\n", wanted_bytes);
}

static void put_rung(struct json_text *json, const struct scree_rung *rung, bool is_whole) {
    json_open_line(json, '{');
    json_key(json, "rung");
    json_integer(json, rung->rung);
    json_key(json, "svo_m");
    json_number(json, rung->svo_m);
    json_key(json, "mmqe_m2");
    json_number(json, rung->mmqe_m2);
    json_key(json, "max_error_m");
    json_number(json, rung->max_error_m);
    json_key(json, "vertices");
    json_integer(json, rung->vertex_count);
    json_key(json, "triangles");
    json_integer(json, rung->triangle_count);
    json_key(json, "bytes_so_far");
    json_integer(json, (int64_t)end_of(rung));
    json_key(json, "whole");
    json_boolean(json, is_whole);
    json_close(json, '}');
}

static void put_tile(struct json_text *json, const char *path, const struct scree_stream_header *header,
                     uint64_t file_bytes) {
    uint32_t whole = whole_rungs(header, file_bytes);
    json_open(json, '{');
    json_key(json, "stream");
    json_string(json, path);
    json_key(json, "version");
    json_integer(json, header->version);
    json_key(json, "profile");
    json_string(json, profile_name(header->profile == SCREE_GEODETIC));
    json_key(json, "tile");
    json_open_line(json, '[');
    json_integer(json, header->zoom);
    json_integer(json, header->tile_x);
    json_integer(json, header->tile_y);
    json_close(json, ']');
    json_key(json, "bytes");
    json_integer(json, (int64_t)file_bytes);
    json_key(json, "whole");
    json_boolean(json, file_bytes == end_of(&header->rungs[header->rung_count - 1]));
    json_key(json, "columns");
    json_integer(json, header->columns);
    json_key(json, "rows");
    json_integer(json, header->rows);
    json_key(json, "west");
    json_number(json, header->west);
    json_key(json, "south");
    json_number(json, header->south);
    json_key(json, "spacing_x");
    json_number(json, header->spacing_x);
    json_key(json, "spacing_y");
    json_number(json, header->spacing_y);
    json_key(json, "height_step_m");
    json_number(json, ldexp(1, header->height_exponent));
    json_key(json, "rungs");
    json_open(json, '[');
    for (uint32_t i = 0; i < header->rung_count; i++) put_rung(json, &header->rungs[i], i < whole);
    json_close(json, ']');
    json_close(json, '}');
}

enum scree_status info_stream_file(struct scree_memory *memory, const char *path, struct json_text *json,
                                   struct scree_error *error) {
    uint64_t file_bytes = 0;
    struct scree_stream_header *header = scree_allocate(memory, 1, sizeof *header, "a stream's header", error);
    if (header == NULL) return SCREE_E_MEMORY;
    enum scree_status status = stream_file_header(memory, path, header, &file_bytes, error);
    if (status == SCREE_OK && json != NULL) {
        put_tile(json, path, header, file_bytes);
    } else if (status == SCREE_OK) {
        print_tile(path, header, file_bytes);
    }
    scree_release(memory, header);
    return status;
}

/* ---- a set ---- */

static void print_scale(const struct stream_scale *scale) {
    printf(" | %4" PRId32 " %11" PRIu64 " %10.4g %10.4g", scale->rung, scale->vertices, scale->svo_max_m,
           scale->error_max_m);
}

static void print_set(const struct stream_set *set) {
    const struct scree_info *info = &set->info;
    printf("%s: streams, %s profile, zooms %d to %d, rungs %" PRId32 " to %" PRId32 "%s\n", set->folder,
           profile_name(info->lattice.profile == PROFILE_GEODETIC), info->min_zoom, info->max_zoom, info->first_rung,
           info->first_rung + (int32_t)info->rung_count - 1, info->is_lossless ? ", lossless" : "");
    printf("bounds  %.9g %.9g %.9g %.9g\n", info->bounds[0], info->bounds[1], info->bounds[2], info->bounds[3]);
    printf("ladder  tolerances from %.4g to %.4g m; heights in steps of %.9g m\n", info->tolerance_m[0],
           info->tolerance_m[info->rung_count - 1], ldexp(1, info->height_exponent));
    if (info->datum[0] != '\0') printf("%s\n", info->datum);
    if (info->attribution[0] != '\0') printf("source  %s\n", info->attribution);
    printf("\n                               |     at the coarsest rungs               |     at the finest rungs\n"
           "  zoom      tiles        bytes | rung    vertices      SVO m    error m | rung    vertices      SVO m    "
           "error m\n");
    for (int zoom = info->min_zoom; zoom <= info->max_zoom; zoom++) {
        const struct scree_zoom_info *told = &info->zooms[zoom];
        if (!told->is_told) continue;
        printf("  %4d %10" PRIu64 " %12" PRIu64, zoom, told->tiles, told->bytes);
        if (told->tiles != 0) print_scale(&told->coarsest);
        if (told->tiles != 0) print_scale(&told->finest);
        printf("\n");
    }
}

static void put_scale(struct json_text *json, const char *key, const struct stream_scale *scale) {
    json_key(json, key);
    json_open_line(json, '{');
    json_key(json, "rung");
    json_integer(json, scale->rung);
    json_key(json, "vertices");
    json_integer(json, (int64_t)scale->vertices);
    json_key(json, "triangles");
    json_integer(json, (int64_t)scale->triangles);
    json_key(json, "svo_min_m");
    json_number(json, scale->svo_min_m);
    json_key(json, "svo_max_m");
    json_number(json, scale->svo_max_m);
    json_key(json, "max_error_min_m");
    json_number(json, scale->error_min_m);
    json_key(json, "max_error_max_m");
    json_number(json, scale->error_max_m);
    json_close(json, '}');
}

static void put_set(struct json_text *json, const struct stream_set *set) {
    const struct scree_info *info = &set->info;
    json_open(json, '{');
    json_key(json, "folder");
    json_string(json, set->folder);
    json_key(json, "profile");
    json_string(json, profile_name(info->lattice.profile == PROFILE_GEODETIC));
    json_key(json, "min_zoom");
    json_integer(json, info->min_zoom);
    json_key(json, "max_zoom");
    json_integer(json, info->max_zoom);
    json_key(json, "bounds");
    json_open_line(json, '[');
    for (int i = 0; i < 4; i++) json_number(json, info->bounds[i]);
    json_close(json, ']');
    json_key(json, "datum");
    json_string(json, info->datum);
    json_key(json, "height_step_m");
    json_number(json, ldexp(1, info->height_exponent));
    json_key(json, "lossless");
    json_boolean(json, info->is_lossless);
    json_key(json, "first_rung");
    json_integer(json, info->first_rung);
    json_key(json, "tolerance_m");
    json_open_line(json, '[');
    for (uint32_t i = 0; i < info->rung_count; i++) json_number(json, info->tolerance_m[i]);
    json_close(json, ']');
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = info->min_zoom; zoom <= info->max_zoom; zoom++) {
        const struct scree_zoom_info *told = &info->zooms[zoom];
        if (!told->is_told) continue;
        json_open(json, '{');
        json_key(json, "zoom");
        json_integer(json, zoom);
        json_key(json, "tiles");
        json_integer(json, (int64_t)told->tiles);
        json_key(json, "bytes");
        json_integer(json, (int64_t)told->bytes);
        if (told->tiles != 0) put_scale(json, "coarsest", &told->coarsest);
        if (told->tiles != 0) put_scale(json, "finest", &told->finest);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

enum scree_status info_stream_set(struct scree_memory *memory, const char *path, struct json_text *json,
                                  struct scree_error *error) {
    struct stream_set *set = calloc(1, sizeof *set);
    if (set == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    enum scree_status status = stream_set_open(memory, path, set, error);
    if (status == SCREE_OK && json != NULL) {
        put_set(json, set);
    } else if (status == SCREE_OK) {
        print_set(set);
    }
    stream_set_free(memory, set);
    free(set);
    return status;
}
