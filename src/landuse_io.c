/* Polygons of land use, read by OGR and drawn by GDAL: see the header. */
#include "src/landuse_io.h"

#include "lod/context_filter.h"
#include "src/file_read_io.h"
#include "src/raster_parts_io.h"

#include <cpl_string.h>
#include <gdal_alg.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <string.h>

#define MOST_RULES_BYTES (1 << 20)
#define MOST_FEATURES    (1 << 24) /* their numbers are exact in whatever type GDAL draws with */

static const uint8_t use_bits[LANDUSE_COUNT] = {
    [LANDUSE_WATER] = GROUND_WATER,   [LANDUSE_SHORE] = GROUND_SHORE, [LANDUSE_RAILWAY] = GROUND_RAILWAY,
    [LANDUSE_BRIDGE] = GROUND_BRIDGE, [LANDUSE_ROAD] = GROUND_RAMP,   [LANDUSE_FOREST] = GROUND_FOREST};

/* Geometries of one use that lie on the raster. */
struct shapes {
    OGRGeometryH *shapes;
    OGREnvelope *boxes;
    size_t count, room;
};

struct reading {
    struct scree_memory *memory;
    const char *path;
    const struct filter_raster *raster;
    struct landuse_rules rules;
    OGRSpatialReferenceH srs; /* NULL: the raster has none */
    OGREnvelope extent;       /* the raster's pixels */
    struct shapes uses[LANDUSE_COUNT];
    struct landuse_posts *posts;
};

/* ---- features ---- */

static enum landuse use_of(const struct reading *reading, OGRFeatureH feature) {
    for (size_t i = 0; i < reading->rules.count; i++) {
        const struct landuse_rule *rule = &reading->rules.rules[i];
        const int field = OGR_F_GetFieldIndex(feature, rule->attribute);
        if (field < 0 || !OGR_F_IsFieldSetAndNotNull(feature, field)) continue;
        const char *value = OGR_F_GetFieldAsString(feature, field);
        if (rule->value == NULL ? value[0] != '\0' : strcmp(value, rule->value) == 0) return rule->use;
    }
    return LANDUSE_COUNT;
}

/* The geometry in the raster's CRS and valid, or NULL: there is none. */
static OGRGeometryH shape_new(const struct reading *reading, OGRFeatureH feature,
                              OGRCoordinateTransformationH transformation) {
    OGRGeometryH shape = OGR_F_GetGeometryRef(feature);
    if (shape == NULL || OGR_G_IsEmpty(shape)) return NULL;
    shape = OGR_G_Clone(shape);
    if (shape != NULL) OGR_G_FlattenTo2D(shape);
    if (shape != NULL && transformation != NULL && OGR_G_Transform(shape, transformation) != OGRERR_NONE) {
        OGR_G_DestroyGeometry(shape);
        return NULL;
    }
    if (shape == NULL || OGR_G_IsValid(shape)) return shape;
    OGRGeometryH valid = OGR_G_MakeValid(shape);
    OGR_G_DestroyGeometry(shape);
    reading->posts->repaired += valid != NULL;
    return valid;
}

static bool boxes_meet(const OGREnvelope *a, const OGREnvelope *b) {
    return a->MinX <= b->MaxX && b->MinX <= a->MaxX && a->MinY <= b->MaxY && b->MinY <= a->MaxY;
}

static enum scree_status make_room(const struct reading *reading, struct shapes *shapes, struct scree_error *error) {
    static const char what[] = "polygons of land use";
    const size_t room = shapes->room > 0 ? 2 * shapes->room : 64;
    if (room > MOST_FEATURES)
        return scree_fail(error, SCREE_E_LIMIT, "%s: has more than %d features of one use; split it", reading->path,
                          MOST_FEATURES);
    OGRGeometryH *more = scree_reallocate(reading->memory, shapes->shapes, room, sizeof *more, what, error);
    if (more == NULL) return SCREE_E_MEMORY;
    shapes->shapes = more;
    OGREnvelope *boxes = scree_reallocate(reading->memory, shapes->boxes, room, sizeof *boxes, what, error);
    if (boxes == NULL) return SCREE_E_MEMORY;
    shapes->boxes = boxes;
    shapes->room = room;
    return SCREE_OK;
}

/* Takes the shape over. */
static enum scree_status keep(struct reading *reading, enum landuse use, OGRGeometryH shape,
                              struct scree_error *error) {
    struct shapes *shapes = &reading->uses[use];
    OGREnvelope box;
    OGR_G_GetEnvelope(shape, &box);
    if (!boxes_meet(&box, &reading->extent)) {
        reading->posts->outside++;
        OGR_G_DestroyGeometry(shape);
        return SCREE_OK;
    }
    if (shapes->count == shapes->room) {
        enum scree_status status = make_room(reading, shapes, error);
        if (status != SCREE_OK) {
            OGR_G_DestroyGeometry(shape);
            return status;
        }
    }
    shapes->shapes[shapes->count] = shape;
    shapes->boxes[shapes->count++] = box;
    reading->posts->features[use]++;
    return SCREE_OK;
}

static enum scree_status read_layer(struct reading *reading, OGRLayerH layer, struct scree_error *error) {
    OGRSpatialReferenceH from = OGR_L_GetSpatialRef(layer);
    OGRCoordinateTransformationH transformation = NULL;
    if (from != NULL && reading->srs != NULL && !OSRIsSame(from, reading->srs) &&
        (transformation = OCTNewCoordinateTransformation(from, reading->srs)) == NULL)
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: cannot be transformed to the raster's CRS; reproject it with ogr2ogr -t_srs",
                          reading->path);
    enum scree_status status = SCREE_OK;
    OGRFeatureH feature;
    OGR_L_ResetReading(layer);
    while (status == SCREE_OK && (feature = OGR_L_GetNextFeature(layer)) != NULL) {
        const enum landuse use = use_of(reading, feature);
        OGRGeometryH shape = use != LANDUSE_COUNT ? shape_new(reading, feature, transformation) : NULL;
        if (shape != NULL)
            status = keep(reading, use, shape, error);
        else
            reading->posts->empty += use != LANDUSE_COUNT;
        OGR_F_Destroy(feature);
    }
    if (transformation != NULL) OCTDestroyCoordinateTransformation(transformation);
    return status;
}

/* Leaves the roads that meet a bridge. */
static void find_ramps(struct reading *reading) {
    struct shapes *roads = &reading->uses[LANDUSE_ROAD];
    const struct shapes *bridges = &reading->uses[LANDUSE_BRIDGE];
    size_t kept = 0;
    for (size_t i = 0; i < roads->count; i++) {
        bool is_ramp = false;
        for (size_t k = 0; k < bridges->count && !is_ramp; k++)
            is_ramp = boxes_meet(&roads->boxes[i], &bridges->boxes[k]) &&
                      OGR_G_Intersects(roads->shapes[i], bridges->shapes[k]);
        if (is_ramp)
            roads->shapes[kept++] = roads->shapes[i];
        else
            OGR_G_DestroyGeometry(roads->shapes[i]);
    }
    roads->count = kept;
    reading->posts->ramps = (uint32_t)kept;
}

/* ---- posts ---- */

/* Draws shapes on posts, rows from the south, each with a value of its own. */
static bool draw(const struct reading *reading, const struct shapes *shapes, const double *values, void *pixels,
                 GDALDataType type) {
    const struct filter_raster *raster = reading->raster;
    double transform[6] = {reading->extent.MinX, raster->spacing_x, 0, reading->extent.MinY, 0, raster->spacing_y};
    char pointer[64], address[48] = "";
    address[CPLPrintPointer(address, pixels, sizeof address - 1)] = '\0';
    snprintf(pointer, sizeof pointer, "DATAPOINTER=%s", address);
    const char *const options[] = {pointer, NULL};
    GDALDatasetH canvas = GDALCreate(GDALGetDriverByName("MEM"), "", raster->columns, raster->rows, 0, type, NULL);
    int band = 1;
    bool fine = canvas != NULL && GDALSetGeoTransform(canvas, transform) == CE_None &&
                GDALAddBand(canvas, type, (CSLConstList)options) == CE_None;
    fine = fine && GDALRasterizeGeometries(canvas, 1, &band, (int)shapes->count, shapes->shapes, NULL, NULL, values,
                                           NULL, NULL, NULL) == CE_None;
    if (canvas != NULL) GDALClose(canvas);
    return fine;
}

/* Draws a use's shapes on the canvas, with their numbers from 1. */
static enum scree_status draw_numbers(const struct reading *reading, enum landuse use, uint32_t *canvas,
                                      const struct raster_trap *trap, struct scree_error *error) {
    const size_t count = (size_t)reading->raster->columns * (size_t)reading->raster->rows;
    const struct shapes *shapes = &reading->uses[use];
    double *numbers = scree_allocate(reading->memory, shapes->count, sizeof *numbers, "land use", error);
    if (numbers == NULL) return SCREE_E_MEMORY;
    for (size_t i = 0; i < shapes->count; i++) numbers[i] = (double)i + 1;
    memset(canvas, 0, count * sizeof *canvas);
    const bool fine = draw(reading, shapes, numbers, canvas, GDT_UInt32);
    scree_release(reading->memory, numbers);
    if (!fine) return raster_trap_fail(trap, reading->path, error);
    for (size_t post = 0; post < count; post++)
        if (canvas[post] > 0) reading->posts->uses[post] |= use_bits[use];
    return SCREE_OK;
}

/* Water comes last, so that its numbers stay. */
static enum scree_status draw_all(struct reading *reading, const struct raster_trap *trap, struct scree_error *error) {
    static const enum landuse order[LANDUSE_COUNT] = {LANDUSE_SHORE, LANDUSE_RAILWAY, LANDUSE_BRIDGE,
                                                      LANDUSE_ROAD,  LANDUSE_FOREST,  LANDUSE_WATER};
    const size_t count = (size_t)reading->raster->columns * (size_t)reading->raster->rows;
    struct landuse_posts *posts = reading->posts;
    posts->uses = scree_allocate(reading->memory, count, 1, "land use", error);
    posts->waters = scree_allocate(reading->memory, count, sizeof *posts->waters, "land use", error);
    enum scree_status status = posts->uses != NULL && posts->waters != NULL ? SCREE_OK : SCREE_E_MEMORY;
    for (int i = 0; i < LANDUSE_COUNT && status == SCREE_OK; i++)
        if (reading->uses[order[i]].count > 0) status = draw_numbers(reading, order[i], posts->waters, trap, error);
    posts->water_count = (uint32_t)reading->uses[LANDUSE_WATER].count;
    if (status != SCREE_OK || posts->water_count == 0) {
        scree_release(reading->memory, posts->waters);
        posts->waters = NULL;
        return status;
    }
    const uint8_t *is_outside = reading->raster->is_outside;
    for (size_t post = 0; post < count; post++)
        if ((is_outside != NULL && is_outside[post]) || posts->uses[post] & GROUND_BRIDGE) posts->waters[post] = 0;
    return SCREE_OK;
}

/* ---- all of it ---- */

static enum scree_status read_rules(struct reading *reading, const char *path, struct scree_error *error) {
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    enum scree_status status = SCREE_OK;
    if (path != NULL) status = file_read_new(reading->memory, path, MOST_RULES_BYTES, &bytes, &size_bytes, error);
    if (status == SCREE_OK)
        status = landuse_rules_parse(reading->memory, path, (const char *)bytes, size_bytes, &reading->rules, error);
    scree_release(reading->memory, bytes);
    return status;
}

static enum scree_status read_source(struct reading *reading, const struct raster_trap *trap,
                                     struct scree_error *error) {
    GDALDatasetH source = GDALOpenEx(reading->path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (source == NULL) return raster_trap_fail(trap, reading->path, error);
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < GDALDatasetGetLayerCount(source) && status == SCREE_OK; i++)
        status = read_layer(reading, GDALDatasetGetLayer(source, i), error);
    GDALClose(source);
    uint64_t fits = (uint64_t)reading->posts->outside + reading->posts->empty;
    for (int use = 0; use < LANDUSE_COUNT; use++) fits += reading->uses[use].count;
    if (status == SCREE_OK && fits == 0)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: no rule fits any of its features; --rules names a file that says which attributes mean "
                          "what",
                          reading->path);
    return status;
}

static void find_extent(struct reading *reading) {
    const struct filter_raster *raster = reading->raster;
    reading->extent.MinX = raster->west - raster->spacing_x / 2;
    reading->extent.MinY = raster->south - raster->spacing_y / 2;
    reading->extent.MaxX = reading->extent.MinX + raster->columns * raster->spacing_x;
    reading->extent.MaxY = reading->extent.MinY + raster->rows * raster->spacing_y;
    if (raster->crs_wkt[0] == '\0') return;
    reading->srs = OSRNewSpatialReference(NULL);
    OSRSetAxisMappingStrategy(reading->srs, OAMS_TRADITIONAL_GIS_ORDER);
    if (OSRSetFromUserInput(reading->srs, raster->crs_wkt) == OGRERR_NONE) return;
    OSRDestroySpatialReference(reading->srs);
    reading->srs = NULL;
}

enum scree_status landuse_read(struct scree_memory *memory, const char *path, const char *rules_path,
                               const struct filter_raster *raster, struct landuse_posts *posts,
                               struct scree_error *error) {
    struct reading reading = {.memory = memory, .path = path, .raster = raster, .posts = posts};
    struct raster_trap trap;
    *posts = (struct landuse_posts){.uses = NULL};
    raster_trap_set(&trap);
    enum scree_status status = read_rules(&reading, rules_path, error);
    if (status == SCREE_OK) {
        find_extent(&reading);
        status = read_source(&reading, &trap, error);
    }
    if (status == SCREE_OK) {
        find_ramps(&reading);
        status = draw_all(&reading, &trap, error);
    }
    for (int use = 0; use < LANDUSE_COUNT; use++) {
        struct shapes *shapes = &reading.uses[use];
        for (size_t i = 0; i < shapes->count; i++) OGR_G_DestroyGeometry(shapes->shapes[i]);
        scree_release(memory, shapes->shapes);
        scree_release(memory, shapes->boxes);
    }
    if (reading.srs != NULL) OSRDestroySpatialReference(reading.srs);
    landuse_rules_free(memory, &reading.rules);
    raster_trap_clear();
    return status;
}

void landuse_free(struct scree_memory *memory, struct landuse_posts *posts) {
    scree_release(memory, posts->uses);
    scree_release(memory, posts->waters);
    *posts = (struct landuse_posts){.uses = NULL};
}
