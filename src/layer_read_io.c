#include "src/layer_read_io.h"

#include <json-c/json.h>
#include <math.h>
#include <string.h>

static void complain(struct layer_info *layer, const char *what) {
    size_t used = strlen(layer->complaint);
    if (used + strlen(what) + 3 > sizeof layer->complaint) return;
    if (used != 0) {
        memcpy(layer->complaint + used, ", ", 2);
        used += 2;
    }
    memcpy(layer->complaint + used, what, strlen(what) + 1);
}

/* What clients need and some refuse to guess. */
static enum scree_status read_head(struct json_object *root, struct layer_info *layer, struct scree_error *error) {
    const char *format = manifest_text(root, "format"), *scheme = manifest_text(root, "scheme");
    struct json_object *tiles = manifest_array(root, "tiles"), *bounds = manifest_array(root, "bounds"), *extensions;
    if (format != NULL && strncmp(format, "quantized-mesh-1.", 17) != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its format is %s, not quantized-mesh-1.0", format);
    if (scheme != NULL && strcmp(scheme, "tms") != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its tiles are numbered by scheme %s, not tms", scheme);
    const char *needed[] = {"tilejson", "format", "version", "scheme", "projection"};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (manifest_text(root, needed[i]) == NULL) complain(layer, needed[i]);
    if (tiles == NULL || json_object_array_length(tiles) == 0) complain(layer, "tiles");
    if (bounds == NULL || json_object_array_length(bounds) != 4) complain(layer, "bounds");
    for (size_t i = 0; bounds != NULL && i < 4 && i < json_object_array_length(bounds); i++)
        layer->bounds[i] = json_object_get_double(json_object_array_get_idx(bounds, i));
    if (manifest_count(root, "minzoom", MAX_ZOOM) < 0) complain(layer, "minzoom");
    if (manifest_count(root, "maxzoom", MAX_ZOOM) < 0) complain(layer, "maxzoom");
    extensions = manifest_array(root, "extensions");
    for (size_t i = 0; extensions != NULL && i < json_object_array_length(extensions); i++) {
        const char *name = json_object_get_string(json_object_array_get_idx(extensions, i));
        if (name != NULL && strcmp(name, "octvertexnormals") == 0) layer->has_normals = true;
    }
    layer->min_zoom = (int)fmax(0, (double)manifest_count(root, "minzoom", MAX_ZOOM));
    layer->max_zoom = (int)manifest_count(root, "maxzoom", MAX_ZOOM);
    return SCREE_OK;
}

static enum scree_status read_zooms(struct json_object *scree, struct layer_info *layer, struct scree_error *error) {
    struct json_object *zooms = manifest_array(scree, "zooms");
    size_t count = zooms == NULL ? 0 : json_object_array_length(zooms);
    for (size_t i = 0; i < count; i++) {
        struct json_object *item = json_object_array_get_idx(zooms, i);
        int64_t zoom = json_object_is_type(item, json_type_object) ? manifest_count(item, "zoom", MAX_ZOOM) : -1;
        if (zoom < 0) return scree_fail(error, SCREE_E_CORRUPT, "item %zu of its scree.zooms has no zoom", i);
        struct layer_zoom_info *info = &layer->zooms[zoom];
        *info = (struct layer_zoom_info){
            .is_told = true,
            .tolerance_m = manifest_number(item, "tolerance_m", NAN),
            .height_step_m = manifest_number(item, "height_step_m", NAN),
            .max_error_m = manifest_number(item, "max_error_m", NAN),
            .svo_m = manifest_number(item, "svo_m", NAN),
            .tiles = (uint64_t)manifest_count(item, "tiles", INT64_C(1) << 53),
            .vertices = (uint64_t)manifest_count(item, "vertices", INT64_C(1) << 53),
            .triangles = (uint64_t)manifest_count(item, "triangles", INT64_C(1) << 53),
            .bytes = (uint64_t)manifest_count(item, "bytes", INT64_C(1) << 53),
        };
    }
    return SCREE_OK;
}

/* Terrain of other producers: the geodetic profile, down to the deepest zoom that it names. */
static enum scree_status assume_lattice(struct json_object *root, struct layer_info *layer, struct scree_error *error) {
    const char *projection = manifest_text(root, "projection");
    struct json_object *available = manifest_array(root, "available");
    size_t zooms = available == NULL ? 0 : json_object_array_length(available);
    if (projection != NULL && strcmp(projection, "EPSG:4326") != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its projection is %s, not EPSG:4326", projection);
    if (zooms > MAX_ZOOM + 1) return scree_fail(error, SCREE_E_UNSUPPORTED, "it has zooms deeper than %d", MAX_ZOOM);
    int finest_zoom = layer->max_zoom;
    if ((int)zooms - 1 > finest_zoom) finest_zoom = (int)zooms - 1;
    layer->lattice = lattice_geodetic(finest_zoom < 0 ? 0 : finest_zoom);
    return SCREE_OK;
}

static enum scree_status read_scree(struct scree_memory *memory, struct json_object *root, struct layer_info *layer,
                                    struct scree_error *error) {
    struct json_object *scree;
    if (!json_object_object_get_ex(root, "scree", &scree) || !json_object_is_type(scree, json_type_object)) {
        enum scree_status status = assume_lattice(root, layer, error);
        if (status != SCREE_OK) return status;
        scree = NULL;
    } else {
        layer->is_ours = true;
        enum scree_status status = manifest_read_lattice(scree, "scree.", &layer->lattice, error);
        if (status == SCREE_OK) status = read_zooms(scree, layer, error);
        if (status != SCREE_OK) return status;
        layer->is_gzipped = manifest_is_true(scree, "gzip");
        layer->nodata_height_m = manifest_number(scree, "nodata_height_m", 0);
    }
    layer->crs_wkt = manifest_copy_text(memory, scree == NULL ? NULL : manifest_text(scree, "crs_wkt"), error);
    layer->datum = manifest_copy_text(memory, scree == NULL ? NULL : manifest_text(scree, "datum"), error);
    layer->attribution = manifest_copy_text(memory, manifest_text(root, "attribution"), error);
    return layer->crs_wkt == NULL || layer->datum == NULL || layer->attribution == NULL ? SCREE_E_MEMORY : SCREE_OK;
}

static enum scree_status read_available(struct scree_memory *memory, struct json_object *root, struct layer_info *layer,
                                        struct scree_error *error) {
    struct json_object *available = manifest_array(root, "available");
    if (available == NULL || manifest_number(root, "metadataAvailability", 0) > 0) {
        if (available == NULL && manifest_number(root, "metadataAvailability", 0) <= 0) complain(layer, "available");
        return SCREE_OK;
    }
    layer->has_available = true;
    return manifest_read_ranges(memory, available, &layer->lattice, &layer->available, error);
}

struct reading {
    struct scree_memory *memory;
    struct layer_info *layer;
};

static enum scree_status take(void *context, struct json_object *root, struct scree_error *error) {
    struct reading *reading = context;
    enum scree_status status = read_head(root, reading->layer, error);
    if (status == SCREE_OK) status = read_scree(reading->memory, root, reading->layer, error);
    if (status == SCREE_OK) status = read_available(reading->memory, root, reading->layer, error);
    return status;
}

enum scree_status layer_read(struct scree_memory *memory, const char *path, struct layer_info *layer,
                             struct scree_error *error) {
    struct reading reading = {memory, layer};
    *layer = (struct layer_info){0};
    enum scree_status status = manifest_read(memory, path, take, &reading, error);
    if (status != SCREE_OK) layer_info_free(memory, layer);
    return status;
}

void layer_info_free(struct scree_memory *memory, struct layer_info *layer) {
    manifest_ranges_free(memory, &layer->available);
    scree_release(memory, layer->attribution);
    scree_release(memory, layer->datum);
    scree_release(memory, layer->crs_wkt);
    *layer = (struct layer_info){0};
}
