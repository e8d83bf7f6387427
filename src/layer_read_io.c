#include "src/layer_read_io.h"

#include "src/file_read_io.h"

#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#define LAYER_LIMIT_BYTES (256u << 20)

static const char *text_of(struct json_object *parent, const char *name) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member) || !json_object_is_type(member, json_type_string))
        return NULL;
    return json_object_get_string(member);
}

/* Numbers of any JSON kind; `otherwise` where there is none or it is not finite. */
static double number_of(struct json_object *parent, const char *name, double otherwise) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member)) return otherwise;
    if (!json_object_is_type(member, json_type_double) && !json_object_is_type(member, json_type_int)) return otherwise;
    double value = json_object_get_double(member);
    return isfinite(value) ? value : otherwise;
}

static bool is_true(struct json_object *parent, const char *name) {
    struct json_object *member;
    return json_object_object_get_ex(parent, name, &member) && json_object_get_boolean(member);
}

static struct json_object *array_of(struct json_object *parent, const char *name) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member) || !json_object_is_type(member, json_type_array)) return NULL;
    return member;
}

/* A whole number within 0..highest, or -1. */
static int64_t count_of(struct json_object *parent, const char *name, int64_t highest) {
    double value = number_of(parent, name, -1);
    if (!(value >= 0) || value > (double)highest || value != floor(value)) return -1;
    return (int64_t)value;
}

static char *copy_text(struct scree_memory *memory, const char *text, struct scree_error *error) {
    size_t size_bytes = text == NULL ? 0 : strlen(text);
    char *copy = scree_allocate(memory, size_bytes + 1, 1, "a text of layer.json", error);
    if (copy != NULL && size_bytes != 0) memcpy(copy, text, size_bytes);
    return copy;
}

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
    const char *format = text_of(root, "format"), *scheme = text_of(root, "scheme");
    struct json_object *tiles = array_of(root, "tiles"), *bounds = array_of(root, "bounds"), *extensions;
    if (format != NULL && strncmp(format, "quantized-mesh-1.", 17) != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its format is %s, not quantized-mesh-1.0", format);
    if (scheme != NULL && strcmp(scheme, "tms") != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its tiles are numbered by scheme %s, not tms", scheme);
    const char *needed[] = {"tilejson", "format", "version", "scheme", "projection"};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (text_of(root, needed[i]) == NULL) complain(layer, needed[i]);
    if (tiles == NULL || json_object_array_length(tiles) == 0) complain(layer, "tiles");
    if (bounds == NULL || json_object_array_length(bounds) != 4) complain(layer, "bounds");
    for (size_t i = 0; bounds != NULL && i < 4 && i < json_object_array_length(bounds); i++)
        layer->bounds[i] = json_object_get_double(json_object_array_get_idx(bounds, i));
    if (count_of(root, "minzoom", MAX_ZOOM) < 0) complain(layer, "minzoom");
    if (count_of(root, "maxzoom", MAX_ZOOM) < 0) complain(layer, "maxzoom");
    extensions = array_of(root, "extensions");
    for (size_t i = 0; extensions != NULL && i < json_object_array_length(extensions); i++) {
        const char *name = json_object_get_string(json_object_array_get_idx(extensions, i));
        if (name != NULL && strcmp(name, "octvertexnormals") == 0) layer->has_normals = true;
    }
    layer->min_zoom = (int)fmax(0, (double)count_of(root, "minzoom", MAX_ZOOM));
    layer->max_zoom = (int)count_of(root, "maxzoom", MAX_ZOOM);
    return SCREE_OK;
}

static enum scree_status read_zooms(struct json_object *scree, struct layer_info *layer, struct scree_error *error) {
    struct json_object *zooms = array_of(scree, "zooms");
    size_t count = zooms == NULL ? 0 : json_object_array_length(zooms);
    for (size_t i = 0; i < count; i++) {
        struct json_object *item = json_object_array_get_idx(zooms, i);
        int64_t zoom = json_object_is_type(item, json_type_object) ? count_of(item, "zoom", MAX_ZOOM) : -1;
        if (zoom < 0) return scree_fail(error, SCREE_E_CORRUPT, "item %zu of its scree.zooms has no zoom", i);
        struct layer_zoom_info *info = &layer->zooms[zoom];
        *info = (struct layer_zoom_info){
            .is_told = true,
            .tolerance_m = number_of(item, "tolerance_m", NAN),
            .height_step_m = number_of(item, "height_step_m", NAN),
            .max_error_m = number_of(item, "max_error_m", NAN),
            .svo_m = number_of(item, "svo_m", NAN),
            .tiles = (uint64_t)count_of(item, "tiles", INT64_C(1) << 53),
            .vertices = (uint64_t)count_of(item, "vertices", INT64_C(1) << 53),
            .triangles = (uint64_t)count_of(item, "triangles", INT64_C(1) << 53),
            .bytes = (uint64_t)count_of(item, "bytes", INT64_C(1) << 53),
        };
    }
    return SCREE_OK;
}

static enum scree_status read_lattice(struct json_object *scree, struct layer_info *layer, struct scree_error *error) {
    const char *profile = text_of(scree, "profile");
    struct json_object *member;
    if (!json_object_object_get_ex(scree, "lattice", &member) || !json_object_is_type(member, json_type_object))
        return scree_fail(error, SCREE_E_CORRUPT, "its scree.lattice is missing");
    int64_t finest_zoom = count_of(member, "finest_zoom", MAX_ZOOM);
    if (finest_zoom < 0)
        return scree_fail(error, SCREE_E_CORRUPT, "its scree.lattice.finest_zoom is not 0..%d", MAX_ZOOM);
    if (profile != NULL && strcmp(profile, "geodetic") == 0) {
        layer->lattice = lattice_geodetic((int)finest_zoom);
        return SCREE_OK;
    }
    if (profile == NULL || strcmp(profile, "local") != 0)
        return scree_fail(error, SCREE_E_CORRUPT, "its scree.profile is neither geodetic nor local");
    int64_t columns = count_of(member, "columns", INT64_C(1) << 40), rows = count_of(member, "rows", INT64_C(1) << 40);
    double west = number_of(member, "west", NAN), south = number_of(member, "south", NAN);
    double spacing_x = number_of(member, "spacing_x", NAN), spacing_y = number_of(member, "spacing_y", NAN);
    enum scree_status status =
        lattice_local(columns, rows, west, south, spacing_x, spacing_y, 1, &layer->lattice, error);
    if (status != SCREE_OK) return status;
    layer->lattice.metres_x = number_of(member, "metres_x", spacing_x);
    layer->lattice.metres_y = number_of(member, "metres_y", spacing_y);
    if (layer->lattice.finest_zoom != finest_zoom)
        return scree_fail(error, SCREE_E_CORRUPT, "its scree.lattice.finest_zoom does not fit its columns and rows");
    return SCREE_OK;
}

/* Terrain of other producers: the geodetic profile, down to the deepest zoom that it names. */
static enum scree_status assume_lattice(struct json_object *root, struct layer_info *layer, struct scree_error *error) {
    const char *projection = text_of(root, "projection");
    struct json_object *available = array_of(root, "available");
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
        enum scree_status status = read_lattice(scree, layer, error);
        if (status == SCREE_OK) status = read_zooms(scree, layer, error);
        if (status != SCREE_OK) return status;
        layer->is_gzipped = is_true(scree, "gzip");
        layer->nodata_height_m = number_of(scree, "nodata_height_m", 0);
    }
    layer->crs_wkt = copy_text(memory, scree == NULL ? NULL : text_of(scree, "crs_wkt"), error);
    layer->datum = copy_text(memory, scree == NULL ? NULL : text_of(scree, "datum"), error);
    layer->attribution = copy_text(memory, text_of(root, "attribution"), error);
    return layer->crs_wkt == NULL || layer->datum == NULL || layer->attribution == NULL ? SCREE_E_MEMORY : SCREE_OK;
}

static enum scree_status read_ranges(struct scree_memory *memory, struct json_object *list, int zoom,
                                     struct layer_info *layer, struct scree_error *error) {
    int64_t tiles_x = lattice_tiles_x(&layer->lattice, zoom), tiles_y = lattice_tiles_y(&layer->lattice, zoom);
    size_t count = json_object_array_length(list);
    if (count > UINT32_MAX) return scree_fail(error, SCREE_E_LIMIT, "its list of available tiles is too long");
    layer->ranges[zoom] = scree_allocate(memory, count, sizeof *layer->ranges[zoom], "available tiles", error);
    if (layer->ranges[zoom] == NULL) return SCREE_E_MEMORY;
    layer->range_counts[zoom] = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        struct json_object *item = json_object_array_get_idx(list, i);
        int64_t x0 = count_of(item, "startX", tiles_x - 1), x1 = count_of(item, "endX", tiles_x - 1);
        int64_t y0 = count_of(item, "startY", tiles_y - 1), y1 = count_of(item, "endY", tiles_y - 1);
        if (x0 < 0 || y0 < 0 || x1 < x0 || y1 < y0)
            return scree_fail(error, SCREE_E_CORRUPT, "range %zu of zoom %d in `available` is no range of tiles", i,
                              zoom);
        layer->ranges[zoom][i] = (struct layer_range){(uint32_t)x0, (uint32_t)y0, (uint32_t)x1, (uint32_t)y1};
    }
    return SCREE_OK;
}

static enum scree_status read_available(struct scree_memory *memory, struct json_object *root, struct layer_info *layer,
                                        struct scree_error *error) {
    struct json_object *available = array_of(root, "available");
    if (available == NULL || number_of(root, "metadataAvailability", 0) > 0) {
        if (available == NULL && number_of(root, "metadataAvailability", 0) <= 0) complain(layer, "available");
        return SCREE_OK;
    }
    layer->has_available = true;
    for (size_t z = 0; z < json_object_array_length(available); z++) {
        struct json_object *list = json_object_array_get_idx(available, z);
        if (!json_object_is_type(list, json_type_array))
            return scree_fail(error, SCREE_E_CORRUPT, "item %zu of `available` is not a list", z);
        if (json_object_array_length(list) == 0) continue;
        if (z > (size_t)layer->lattice.finest_zoom)
            return scree_fail(error, SCREE_E_CORRUPT, "`available` lists tiles of zoom %zu, below the finest", z);
        layer->available_zooms = (int)z + 1;
        enum scree_status status = read_ranges(memory, list, (int)z, layer, error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}

static enum scree_status parse(struct scree_memory *memory, const unsigned char *bytes, size_t size_bytes,
                               struct layer_info *layer, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct json_tokener *tokener = json_tokener_new();
    struct json_object *root = NULL;
    if (tokener == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for a parser");
    if (size_bytes > INT_MAX - 1) {
        status = scree_fail(error, SCREE_E_LIMIT, "it is too long");
        goto cleanup;
    }
    root = json_tokener_parse_ex(tokener, (const char *)bytes, (int)size_bytes + 1); /* the 0 ends the text */
    if (root == NULL || !json_object_is_type(root, json_type_object)) {
        status = scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)json_tokener_get_parse_end(tokener),
                               "it is no JSON object: %s", json_tokener_error_desc(json_tokener_get_error(tokener)));
        goto cleanup;
    }
    status = read_head(root, layer, error);
    if (status == SCREE_OK) status = read_scree(memory, root, layer, error);
    if (status == SCREE_OK) status = read_available(memory, root, layer, error);
cleanup:
    json_object_put(root);
    json_tokener_free(tokener);
    return status;
}

enum scree_status layer_read(struct scree_memory *memory, const char *path, struct layer_info *layer,
                             struct scree_error *error) {
    unsigned char *bytes;
    size_t size_bytes = 0;
    struct scree_error why = {0};
    *layer = (struct layer_info){0};
    enum scree_status status = file_read_new(memory, path, LAYER_LIMIT_BYTES, &bytes, &size_bytes, error);
    if (status != SCREE_OK) return status;
    status = parse(memory, bytes, size_bytes, layer, &why);
    scree_release(memory, bytes);
    if (status == SCREE_OK) return SCREE_OK;
    layer_info_free(memory, layer);
    return scree_fail(error, why.status, "%s: %s", path, why.text);
}

void layer_info_free(struct scree_memory *memory, struct layer_info *layer) {
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) scree_release(memory, layer->ranges[zoom]);
    scree_release(memory, layer->attribution);
    scree_release(memory, layer->datum);
    scree_release(memory, layer->crs_wkt);
    *layer = (struct layer_info){0};
}

uint64_t layer_listed_tiles(const struct layer_info *layer, int zoom) {
    uint64_t tiles = 0;
    for (uint32_t i = 0; i < layer->range_counts[zoom]; i++) {
        const struct layer_range *range = &layer->ranges[zoom][i];
        tiles += ((uint64_t)range->x_last - range->x_first + 1) * ((uint64_t)range->y_last - range->y_first + 1);
    }
    return tiles;
}
