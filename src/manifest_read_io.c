#include "src/manifest_read_io.h"

#include "src/file_read_io.h"

#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#define MANIFEST_LIMIT_BYTES (256u << 20)

/* ---- members ---- */

const char *manifest_text(struct json_object *parent, const char *name) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member) || !json_object_is_type(member, json_type_string))
        return NULL;
    return json_object_get_string(member);
}

double manifest_number(struct json_object *parent, const char *name, double otherwise) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member)) return otherwise;
    if (!json_object_is_type(member, json_type_double) && !json_object_is_type(member, json_type_int)) return otherwise;
    double value = json_object_get_double(member);
    return isfinite(value) ? value : otherwise;
}

bool manifest_is_true(struct json_object *parent, const char *name) {
    struct json_object *member;
    return json_object_object_get_ex(parent, name, &member) && json_object_get_boolean(member);
}

struct json_object *manifest_array(struct json_object *parent, const char *name) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member) || !json_object_is_type(member, json_type_array)) return NULL;
    return member;
}

struct json_object *manifest_object(struct json_object *parent, const char *name) {
    struct json_object *member;
    if (!json_object_object_get_ex(parent, name, &member) || !json_object_is_type(member, json_type_object))
        return NULL;
    return member;
}

bool manifest_integer(struct json_object *parent, const char *name, int64_t low, int64_t high, int64_t *number) {
    double value = manifest_number(parent, name, NAN);
    if (!(value >= (double)low && value <= (double)high) || value != floor(value)) return false;
    *number = (int64_t)value;
    return true;
}

int64_t manifest_count(struct json_object *parent, const char *name, int64_t highest) {
    int64_t count;
    return manifest_integer(parent, name, 0, highest, &count) ? count : -1;
}

bool manifest_rectangle(struct json_object *parent, const char *name, double rectangle[4]) {
    struct json_object *list = manifest_array(parent, name);
    bool is_whole = list != NULL && json_object_array_length(list) == 4;
    for (size_t i = 0; i < 4; i++) {
        rectangle[i] = is_whole ? json_object_get_double(json_object_array_get_idx(list, i)) : 0;
        if (!isfinite(rectangle[i])) rectangle[i] = 0;
    }
    return is_whole;
}

char *manifest_copy_text(struct scree_memory *memory, const char *text, struct scree_error *error) {
    size_t size_bytes = text == NULL ? 0 : strlen(text);
    char *copy = scree_allocate(memory, size_bytes + 1, 1, "a text of the manifest", error);
    if (copy != NULL && size_bytes != 0) memcpy(copy, text, size_bytes);
    return copy;
}

/* ---- lattice and tiles ---- */

enum scree_status manifest_read_lattice(struct json_object *parent, const char *where, struct lattice *lattice,
                                        struct scree_error *error) {
    const char *profile = manifest_text(parent, "profile");
    struct json_object *member = manifest_object(parent, "lattice");
    if (member == NULL) return scree_fail(error, SCREE_E_CORRUPT, "its %slattice is missing", where);
    int64_t finest_zoom = manifest_count(member, "finest_zoom", MAX_ZOOM);
    if (finest_zoom < 0)
        return scree_fail(error, SCREE_E_CORRUPT, "its %slattice.finest_zoom is not 0..%d", where, MAX_ZOOM);
    if (profile != NULL && strcmp(profile, "geodetic") == 0) {
        *lattice = lattice_geodetic((int)finest_zoom);
        return SCREE_OK;
    }
    if (profile == NULL || strcmp(profile, "local") != 0)
        return scree_fail(error, SCREE_E_CORRUPT, "its %sprofile is neither geodetic nor local", where);
    int64_t columns = manifest_count(member, "columns", INT64_C(1) << 40),
            rows = manifest_count(member, "rows", INT64_C(1) << 40);
    double west = manifest_number(member, "west", NAN), south = manifest_number(member, "south", NAN);
    double spacing_x = manifest_number(member, "spacing_x", NAN), spacing_y = manifest_number(member, "spacing_y", NAN);
    enum scree_status status = lattice_local(columns, rows, west, south, spacing_x, spacing_y, 1, lattice, error);
    if (status != SCREE_OK) return status;
    lattice->metres_x = manifest_number(member, "metres_x", spacing_x);
    lattice->metres_y = manifest_number(member, "metres_y", spacing_y);
    if (lattice->finest_zoom != finest_zoom)
        return scree_fail(error, SCREE_E_CORRUPT, "its %slattice.finest_zoom does not fit its columns and rows", where);
    return SCREE_OK;
}

static enum scree_status read_list(struct scree_memory *memory, struct json_object *list, int zoom,
                                   const struct lattice *lattice, struct manifest_ranges *ranges,
                                   struct scree_error *error) {
    int64_t tiles_x = lattice_tiles_x(lattice, zoom), tiles_y = lattice_tiles_y(lattice, zoom);
    size_t count = json_object_array_length(list);
    if (count > UINT32_MAX) return scree_fail(error, SCREE_E_LIMIT, "its list of available tiles is too long");
    ranges->ranges[zoom] = scree_allocate(memory, count, sizeof *ranges->ranges[zoom], "available tiles", error);
    if (ranges->ranges[zoom] == NULL) return SCREE_E_MEMORY;
    ranges->counts[zoom] = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        struct json_object *item = json_object_array_get_idx(list, i);
        int64_t x0 = manifest_count(item, "startX", tiles_x - 1), x1 = manifest_count(item, "endX", tiles_x - 1);
        int64_t y0 = manifest_count(item, "startY", tiles_y - 1), y1 = manifest_count(item, "endY", tiles_y - 1);
        if (x0 < 0 || y0 < 0 || x1 < x0 || y1 < y0)
            return scree_fail(error, SCREE_E_CORRUPT, "range %zu of zoom %d in `available` is no range of tiles", i,
                              zoom);
        ranges->ranges[zoom][i] = (struct layer_range){(uint32_t)x0, (uint32_t)y0, (uint32_t)x1, (uint32_t)y1};
    }
    return SCREE_OK;
}

enum scree_status manifest_read_ranges(struct scree_memory *memory, struct json_object *available,
                                       const struct lattice *lattice, struct manifest_ranges *ranges,
                                       struct scree_error *error) {
    for (size_t z = 0; z < json_object_array_length(available); z++) {
        struct json_object *list = json_object_array_get_idx(available, z);
        if (!json_object_is_type(list, json_type_array))
            return scree_fail(error, SCREE_E_CORRUPT, "item %zu of `available` is not a list", z);
        if (json_object_array_length(list) == 0) continue;
        if (z > (size_t)lattice->finest_zoom)
            return scree_fail(error, SCREE_E_CORRUPT, "`available` lists tiles of zoom %zu, below the finest", z);
        enum scree_status status = read_list(memory, list, (int)z, lattice, ranges, error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}

void manifest_ranges_free(struct scree_memory *memory, struct manifest_ranges *ranges) {
    for (int zoom = MAX_ZOOM; zoom >= 0; zoom--) scree_release(memory, ranges->ranges[zoom]);
    *ranges = (struct manifest_ranges){0};
}

/* ---- the file ---- */

static enum scree_status parse(const unsigned char *bytes, size_t size_bytes, manifest_take *take, void *context,
                               struct scree_error *error) {
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
    status = take(context, root, error);
cleanup:
    json_object_put(root);
    json_tokener_free(tokener);
    return status;
}

enum scree_status manifest_read(struct scree_memory *memory, const char *path, manifest_take *take, void *context,
                                struct scree_error *error) {
    unsigned char *bytes;
    size_t size_bytes = 0;
    struct scree_error why = {0};
    enum scree_status status = file_read_new(memory, path, MANIFEST_LIMIT_BYTES, &bytes, &size_bytes, error);
    if (status != SCREE_OK) return status;
    status = parse(bytes, size_bytes, take, context, &why);
    scree_release(memory, bytes);
    if (status != SCREE_OK) scree_fail(error, status, "%s: %s", path, why.text);
    return status;
}
