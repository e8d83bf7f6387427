/* Writes layer.json (src/layer_json.h). */
#include "src/layer_json.h"

#include "config.h"
#include "src/json_text.h"
#include "src/manifest_json.h"

static void put_available(struct json_text *json, const struct layer *layer) {
    json_key(json, "available");
    json_open(json, '[');
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++)
        manifest_put_ranges(json, layer->zooms[zoom].tiles, layer->zooms[zoom].tile_count);
    json_close(json, ']');
}

/* ---- what verify and info want to know ---- */

static void put_zooms(struct json_text *json, const struct layer *layer) {
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom *sums = &layer->zooms[zoom];
        json_open_line(json, '{');
        json_key(json, "zoom");
        json_integer(json, zoom);
        json_key(json, "tolerance_m");
        json_number(json, sums->tolerance_m);
        json_key(json, "height_step_m");
        json_number(json, sums->height_step_m);
        json_key(json, "max_error_m");
        json_number(json, sums->max_error_m);
        json_key(json, "svo_m");
        json_number(json, sums->svo_m);
        json_key(json, "tiles");
        json_integer(json, sums->tile_count);
        json_key(json, "vertices");
        json_integer(json, (int64_t)sums->vertices);
        json_key(json, "triangles");
        json_integer(json, (int64_t)sums->triangles);
        json_key(json, "bytes");
        json_integer(json, (int64_t)sums->bytes);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void put_scree(struct json_text *json, const struct layer *layer) {
    json_key(json, "scree");
    json_open(json, '{');
    json_key(json, "generator");
    json_string(json, "scree " PACKAGE_VERSION);
    json_key(json, "profile");
    json_string(json, layer->lattice->profile == PROFILE_GEODETIC ? "geodetic" : "local");
    manifest_put_lattice(json, layer->lattice);
    json_key(json, "min_zoom");
    json_integer(json, layer->min_zoom);
    json_key(json, "max_zoom");
    json_integer(json, layer->max_zoom);
    manifest_put_rectangle(json, "data_bounds", layer->bounds); /* not clamped: the east may lie beyond 180 degrees */
    json_key(json, "crs_wkt");
    json_string(json, layer->crs_wkt);
    json_key(json, "datum");
    json_string(json, layer->datum);
    json_key(json, "nodata_height_m");
    json_number(json, layer->nodata_height_m);
    json_key(json, "gzip");
    json_boolean(json, layer->is_gzipped);
    if (layer->method != NULL) json_key(json, "method");
    if (layer->method != NULL) json_string(json, layer->method);
    put_zooms(json, layer);
    json_close(json, '}');
}

/* ---- the whole ---- */

/* Clients append the version to the tiles' addresses: other tiles get another one, so that no cache mixes two builds.
 */
static void put_version(struct json_text *json, const struct layer *layer) {
    uint64_t hash = manifest_mix(MANIFEST_HASH, layer->bounds, sizeof layer->bounds);
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom *sums = &layer->zooms[zoom];
        const double figures[] = {sums->tolerance_m, sums->height_step_m, sums->max_error_m, sums->svo_m};
        const uint64_t counts[] = {sums->vertices, sums->triangles, sums->bytes, sums->tile_count};
        hash = manifest_mix(manifest_mix(hash, figures, sizeof figures), counts, sizeof counts);
    }
    manifest_put_version(json, hash);
}

static void put_layer(struct json_text *json, const struct layer *layer) {
    json_open(json, '{');
    json_key(json, "tilejson");
    json_string(json, "2.1.0");
    json_key(json, "name");
    json_string(json, "terrain");
    json_key(json, "format");
    json_string(json, "quantized-mesh-1.0");
    put_version(json, layer);
    json_key(json, "scheme");
    json_string(json, "tms");
    manifest_put_projection(json, layer->lattice, layer->crs_wkt);
    json_key(json, "tiles");
    json_open_line(json, '[');
    json_string(json, "{z}/{x}/{y}.terrain?v={version}");
    json_close(json, ']');
    json_key(json, "minzoom");
    json_integer(json, layer->min_zoom);
    json_key(json, "maxzoom");
    json_integer(json, layer->max_zoom);
    manifest_put_bounds(json, layer->lattice, layer->bounds);
    json_key(json, "extensions");
    json_open_line(json, '[');
    if (layer->has_normals) json_string(json, "octvertexnormals");
    json_close(json, ']');
    json_key(json, "attribution");
    json_string(json, layer->attribution == NULL ? "" : layer->attribution);
    put_available(json, layer);
    put_scree(json, layer);
    json_close(json, '}');
}

char *layer_json_new(const struct layer *layer, struct scree_error *error) {
    struct json_text json = {0};
    put_layer(&json, layer);
    char *text = json_text_take(&json);
    if (text == NULL) scree_fail(error, SCREE_E_MEMORY, "no memory for the text of layer.json");
    return text;
}
