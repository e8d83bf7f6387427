#include "src/scree_read_io.h"

#include <json-c/json.h>
#include <math.h>
#include <string.h>

#define RUNG_LIMIT    (INT64_C(1) << 20)
#define LARGEST_COUNT (INT64_C(1) << 53)

struct reading {
    struct scree_memory *memory;
    struct scree_info *info;
};

static enum scree_status read_head(struct json_object *root, struct scree_error *error) {
    const char *format = manifest_text(root, "format"), *scheme = manifest_text(root, "scheme");
    int64_t version = manifest_count(root, "format_version", LARGEST_COUNT);
    if (format == NULL) return scree_fail(error, SCREE_E_CORRUPT, "it has no format; it is no manifest of streams");
    if (strcmp(format, "scree-stream") != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its format is %s, not scree-stream", format);
    if (version < 1) return scree_fail(error, SCREE_E_CORRUPT, "its format_version is no version");
    if (version > SCREE_STREAM_VERSION)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its format_version is %lld; this scree reads up to %d",
                          (long long)version, SCREE_STREAM_VERSION);
    if (scheme == NULL || strcmp(scheme, "tms") != 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "its tiles are numbered by scheme %s, not tms",
                          scheme == NULL ? "none" : scheme);
    return SCREE_OK;
}

/* What is a single number or text. */
static enum scree_status read_members(struct scree_memory *memory, struct json_object *root, struct scree_info *info,
                                      struct scree_error *error) {
    int64_t min_zoom = manifest_count(root, "min_zoom", MAX_ZOOM),
            max_zoom = manifest_count(root, "max_zoom", MAX_ZOOM);
    int64_t exponent;
    if (min_zoom < 0 || max_zoom < min_zoom || max_zoom > info->lattice.finest_zoom)
        return scree_fail(error, SCREE_E_CORRUPT, "its min_zoom and max_zoom are no zooms of its lattice");
    if (!manifest_integer(root, "height_exponent", -64, 64, &exponent))
        return scree_fail(error, SCREE_E_CORRUPT, "its height_exponent is not -64..64");
    if (!manifest_rectangle(root, "data_bounds", info->bounds))
        return scree_fail(error, SCREE_E_CORRUPT, "its data_bounds are not four numbers");
    info->min_zoom = (int)min_zoom;
    info->max_zoom = (int)max_zoom;
    info->height_exponent = (int32_t)exponent;
    info->nodata_height_m = manifest_number(root, "nodata_height_m", 0);
    info->crs_wkt = manifest_copy_text(memory, manifest_text(root, "crs_wkt"), error);
    info->datum = manifest_copy_text(memory, manifest_text(root, "datum"), error);
    info->attribution = manifest_copy_text(memory, manifest_text(root, "attribution"), error);
    return info->crs_wkt == NULL || info->datum == NULL || info->attribution == NULL ? SCREE_E_MEMORY : SCREE_OK;
}

static enum scree_status read_tolerances(struct scree_memory *memory, struct json_object *ladder,
                                         struct scree_info *info, struct scree_error *error) {
    struct json_object *list = manifest_array(ladder, "tolerance_m");
    size_t count = list == NULL ? 0 : json_object_array_length(list);
    if (count < 1 || count > MANIFEST_MAX_RUNGS)
        return scree_fail(error, SCREE_E_CORRUPT, "its ladder.tolerance_m is no list of 1..%d rungs",
                          MANIFEST_MAX_RUNGS);
    info->tolerance_m = scree_allocate(memory, count, sizeof *info->tolerance_m, "the ladder", error);
    if (info->tolerance_m == NULL) return SCREE_E_MEMORY;
    info->rung_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        struct json_object *item = json_object_array_get_idx(list, i);
        bool is_number = json_object_is_type(item, json_type_double) || json_object_is_type(item, json_type_int);
        double tolerance_m = is_number ? json_object_get_double(item) : NAN;
        bool is_next = isfinite(tolerance_m) && tolerance_m >= 0 && (i == 0 || tolerance_m <= info->tolerance_m[i - 1]);
        if (!is_next)
            return scree_fail(error, SCREE_E_CORRUPT,
                              "item %zu of its ladder.tolerance_m is no tolerance, or larger "
                              "than the one before",
                              i);
        info->tolerance_m[i] = tolerance_m;
    }
    return SCREE_OK;
}

static enum scree_status read_ladder(struct scree_memory *memory, struct json_object *root, struct scree_info *info,
                                     struct scree_error *error) {
    struct json_object *ladder = manifest_object(root, "ladder");
    int64_t first, octaves, step;
    if (ladder == NULL) return scree_fail(error, SCREE_E_CORRUPT, "its ladder is missing");
    if (!manifest_integer(ladder, "first_rung", -RUNG_LIMIT, RUNG_LIMIT, &first))
        return scree_fail(error, SCREE_E_CORRUPT, "its ladder.first_rung is no rung");
    if (!manifest_integer(ladder, "finest_octaves", 0, 64, &octaves))
        return scree_fail(error, SCREE_E_CORRUPT, "its ladder.finest_octaves is not 0..64");
    if (!manifest_integer(ladder, "rungs_per_increment", 1, MANIFEST_MAX_RUNGS, &step))
        return scree_fail(error, SCREE_E_CORRUPT, "its ladder.rungs_per_increment is not 1..%d", MANIFEST_MAX_RUNGS);
    info->first_rung = (int32_t)first;
    info->finest_octaves = (int)octaves;
    info->rungs_per_increment = (uint32_t)step;
    info->is_lossless = manifest_is_true(ladder, "lossless");
    return read_tolerances(memory, ladder, info, error);
}

/* A list of two numbers, the first not above the second. */
static bool read_pair(struct json_object *parent, const char *name, double *low, double *high) {
    struct json_object *list = manifest_array(parent, name);
    if (list == NULL || json_object_array_length(list) != 2) return false;
    *low = json_object_get_double(json_object_array_get_idx(list, 0));
    *high = json_object_get_double(json_object_array_get_idx(list, 1));
    return isfinite(*low) && isfinite(*high) && *low <= *high;
}

static bool read_scale(struct json_object *zoom, const char *name, struct stream_scale *scale) {
    struct json_object *member = manifest_object(zoom, name);
    int64_t rung, vertices = manifest_count(member, "vertices", LARGEST_COUNT);
    int64_t triangles = manifest_count(member, "triangles", LARGEST_COUNT);
    if (!manifest_integer(member, "rung", -RUNG_LIMIT, RUNG_LIMIT, &rung) || vertices < 0 || triangles < 0)
        return false;
    *scale =
        (struct stream_scale){.rung = (int32_t)rung, .vertices = (uint64_t)vertices, .triangles = (uint64_t)triangles};
    return read_pair(member, "svo_m", &scale->svo_min_m, &scale->svo_max_m) &&
           read_pair(member, "max_error_m", &scale->error_min_m, &scale->error_max_m);
}

static enum scree_status read_zooms(struct json_object *root, struct scree_info *info, struct scree_error *error) {
    struct json_object *zooms = manifest_array(root, "zooms");
    if (zooms == NULL) return scree_fail(error, SCREE_E_CORRUPT, "its zooms are missing");
    for (size_t i = 0; i < json_object_array_length(zooms); i++) {
        struct json_object *item = json_object_array_get_idx(zooms, i);
        int64_t zoom = manifest_count(item, "zoom", info->max_zoom);
        if (zoom < 0 || info->zooms[zoom].is_told)
            return scree_fail(error, SCREE_E_CORRUPT, "item %zu of its zooms is of no zoom, or of one told before", i);
        struct scree_zoom_info *told = &info->zooms[zoom];
        int64_t tiles = manifest_count(item, "tiles", LARGEST_COUNT),
                bytes = manifest_count(item, "bytes", LARGEST_COUNT);
        bool is_whole = tiles >= 0 && bytes >= 0;
        if (is_whole && tiles > 0)
            is_whole = read_scale(item, "coarsest", &told->coarsest) && read_scale(item, "finest", &told->finest);
        if (!is_whole)
            return scree_fail(error, SCREE_E_CORRUPT, "its figures of zoom %lld are not complete", (long long)zoom);
        told->is_told = true;
        told->tiles = (uint64_t)tiles;
        told->bytes = (uint64_t)bytes;
    }
    return SCREE_OK;
}

static enum scree_status take(void *context, struct json_object *root, struct scree_error *error) {
    struct reading *reading = context;
    struct scree_info *info = reading->info;
    enum scree_status status = read_head(root, error);
    if (status == SCREE_OK) status = manifest_read_lattice(root, "", &info->lattice, error);
    if (status == SCREE_OK) status = read_members(reading->memory, root, info, error);
    if (status == SCREE_OK) status = read_ladder(reading->memory, root, info, error);
    if (status == SCREE_OK) status = read_zooms(root, info, error);
    if (status != SCREE_OK) return status;
    struct json_object *available = manifest_array(root, "available");
    if (available == NULL) return scree_fail(error, SCREE_E_CORRUPT, "its list of available tiles is missing");
    return manifest_read_ranges(reading->memory, available, &info->lattice, &info->available, error);
}

enum scree_status scree_read(struct scree_memory *memory, const char *path, struct scree_info *info,
                             struct scree_error *error) {
    struct reading reading = {memory, info};
    memset(info, 0, sizeof *info);
    enum scree_status status = manifest_read(memory, path, take, &reading, error);
    if (status != SCREE_OK) scree_info_free(memory, info);
    return status;
}

void scree_info_free(struct scree_memory *memory, struct scree_info *info) {
    manifest_ranges_free(memory, &info->available);
    scree_release(memory, info->tolerance_m);
    scree_release(memory, info->attribution);
    scree_release(memory, info->datum);
    scree_release(memory, info->crs_wkt);
    memset(info, 0, sizeof *info);
}
