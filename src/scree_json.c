/* Writes scree.json (src/scree_json.h). */
#include "src/scree_json.h"

#include "config.h"
#include "src/json_text.h"
#include "src/manifest_json.h"

#include <math.h>

/* ---- sums ---- */

struct stream_tile_figures stream_tile_figures_of(const struct scree_stream_header *header, uint64_t file_bytes) {
    return (struct stream_tile_figures){
        .coarsest = header->rungs[0], .finest = header->rungs[header->rung_count - 1], .bytes = file_bytes};
}

static void scale_add(struct stream_scale *scale, const struct scree_rung *mesh, bool is_first) {
    if (is_first) {
        *scale =
            (struct stream_scale){mesh->rung, 0, 0, mesh->svo_m, mesh->svo_m, mesh->max_error_m, mesh->max_error_m};
    }
    scale->vertices += mesh->vertex_count;
    scale->triangles += mesh->triangle_count;
    scale->svo_min_m = fmin(scale->svo_min_m, mesh->svo_m);
    scale->svo_max_m = fmax(scale->svo_max_m, mesh->svo_m);
    scale->error_min_m = fmin(scale->error_min_m, mesh->max_error_m);
    scale->error_max_m = fmax(scale->error_max_m, mesh->max_error_m);
}

void stream_zoom_add(struct stream_zoom *zoom, const struct stream_tile_figures *tile) {
    bool is_first = zoom->tile_count++ == 0;
    scale_add(&zoom->coarsest, &tile->coarsest, is_first);
    scale_add(&zoom->finest, &tile->finest, is_first);
    if (tile->coarsest.rung < zoom->coarsest.rung) zoom->coarsest.rung = tile->coarsest.rung;
    if (tile->finest.rung > zoom->finest.rung) zoom->finest.rung = tile->finest.rung;
    zoom->bytes += tile->bytes;
}

/* ---- text ---- */

static void put_range(struct json_text *json, const char *key, double low, double high) {
    json_key(json, key);
    json_open_line(json, '[');
    json_number(json, low);
    json_number(json, high);
    json_close(json, ']');
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
    put_range(json, "svo_m", scale->svo_min_m, scale->svo_max_m);
    put_range(json, "max_error_m", scale->error_min_m, scale->error_max_m);
    json_close(json, '}');
}

static void put_zooms(struct json_text *json, const struct stream_manifest *manifest) {
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= manifest->max_zoom; zoom++) {
        const struct stream_zoom *sums = &manifest->zooms[zoom];
        json_open(json, '{');
        json_key(json, "zoom");
        json_integer(json, zoom);
        json_key(json, "tiles");
        json_integer(json, sums->tile_count);
        json_key(json, "bytes");
        json_integer(json, (int64_t)sums->bytes);
        if (sums->tile_count != 0) {
            put_scale(json, "coarsest", &sums->coarsest);
            put_scale(json, "finest", &sums->finest);
        }
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void put_available(struct json_text *json, const struct stream_manifest *manifest) {
    json_key(json, "available");
    json_open(json, '[');
    for (int zoom = 0; zoom <= manifest->max_zoom; zoom++)
        manifest_put_ranges(json, manifest->zooms[zoom].tiles, manifest->zooms[zoom].tile_count);
    json_close(json, ']');
}

static void put_ladder(struct json_text *json, const struct stream_manifest *manifest) {
    json_key(json, "ladder");
    json_open(json, '{');
    json_key(json, "first_rung");
    json_integer(json, manifest->first_rung);
    json_key(json, "finest_octaves");
    json_integer(json, manifest->finest_octaves);
    json_key(json, "lossless");
    json_boolean(json, manifest->is_lossless);
    json_key(json, "rungs_per_increment");
    json_integer(json, manifest->rungs_per_increment);
    json_key(json, "tolerance_m");
    json_open_line(json, '[');
    for (uint32_t i = 0; i < manifest->rung_count; i++) json_number(json, manifest->tolerance_m[i]);
    json_close(json, ']');
    json_close(json, '}');
}

/* Other tiles get another version, so that no cache mixes two builds. */
static void put_version(struct json_text *json, const struct stream_manifest *manifest) {
    uint64_t hash = manifest_mix(MANIFEST_HASH, manifest->bounds, sizeof manifest->bounds);
    hash = manifest_mix(hash, manifest->tolerance_m, manifest->rung_count * sizeof *manifest->tolerance_m);
    for (int zoom = 0; zoom <= manifest->max_zoom; zoom++) {
        const struct stream_zoom *sums = &manifest->zooms[zoom];
        const uint64_t counts[] = {sums->tile_count, sums->bytes, sums->coarsest.vertices, sums->finest.vertices};
        const double figures[] = {sums->coarsest.svo_max_m, sums->coarsest.error_max_m, sums->finest.svo_max_m,
                                  sums->finest.error_max_m};
        hash = manifest_mix(manifest_mix(hash, counts, sizeof counts), figures, sizeof figures);
    }
    manifest_put_version(json, hash);
}

static void put_manifest(struct json_text *json, const struct stream_manifest *manifest) {
    json_open(json, '{');
    json_key(json, "format");
    json_string(json, "scree-stream");
    json_key(json, "format_version");
    json_integer(json, SCREE_STREAM_VERSION);
    json_key(json, "generator");
    json_string(json, "scree " PACKAGE_VERSION);
    put_version(json, manifest);
    json_key(json, "scheme");
    json_string(json, "tms");
    json_key(json, "tiles");
    json_open_line(json, '[');
    json_string(json, "{z}/{x}/{y}.scree?v={version}");
    json_close(json, ']');
    json_key(json, "profile");
    json_string(json, manifest->lattice->profile == PROFILE_GEODETIC ? "geodetic" : "local");
    manifest_put_projection(json, manifest->lattice, manifest->crs_wkt);
    json_key(json, "crs_wkt");
    json_string(json, manifest->crs_wkt == NULL ? "" : manifest->crs_wkt);
    json_key(json, "datum");
    json_string(json, manifest->datum == NULL ? "" : manifest->datum);
    json_key(json, "attribution");
    json_string(json, manifest->attribution == NULL ? "" : manifest->attribution);
    manifest_put_bounds(json, manifest->lattice, manifest->bounds);
    manifest_put_rectangle(json, "data_bounds", manifest->bounds); /* the east may lie beyond 180 degrees */
    json_key(json, "min_zoom");
    json_integer(json, manifest->min_zoom);
    json_key(json, "max_zoom");
    json_integer(json, manifest->max_zoom);
    json_key(json, "nodata_height_m");
    json_number(json, manifest->nodata_height_m);
    json_key(json, "height_exponent"); /* heights are multiples of 2 to this power, in metres */
    json_integer(json, manifest->height_exponent);
    json_key(json, "height_step_m");
    json_number(json, ldexp(1, manifest->height_exponent));
    manifest_put_lattice(json, manifest->lattice);
    put_ladder(json, manifest);
    put_zooms(json, manifest);
    put_available(json, manifest);
    json_close(json, '}');
}

char *scree_json_new(const struct stream_manifest *manifest, struct scree_error *error) {
    struct json_text json = {0};
    put_manifest(&json, manifest);
    char *text = json_text_take(&json);
    if (text == NULL) scree_fail(error, SCREE_E_MEMORY, "no memory for the text of scree.json");
    return text;
}
