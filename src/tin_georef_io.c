#include "src/tin_georef_io.h"

#include "src/raster_parts_io.h"
#include "src/tin_place.h"

#include <cpl_conv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_HEIGHT_M 20000.0 /* as of rasters */
#define HALF_TURN    180.0
enum { SAMPLES = 33, CHUNK = 256 };

/* What a TIN is while its coordinates change. */
struct moving {
    const struct raster_options *options;
    const char *name;
    struct tin *tin;
    PJ_CONTEXT *proj;
    char *crs_wkt; /* "" when there is none */
};

static enum scree_status describe_crs(OGRSpatialReferenceH crs, const char *name, char **crs_wkt,
                                      struct scree_error *error) {
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    char *wkt = NULL;
    OGRErr failed = crs == NULL ? OGRERR_NONE : OSRExportToWktEx(crs, &wkt, wkt2);
    if (failed == OGRERR_NONE) *crs_wkt = strdup(wkt == NULL ? "" : wkt);
    CPLFree(wkt);
    if (crs != NULL && OSRIsGeocentric(crs))
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: its coordinate system is geocentric, which has no heights; project it first", name);
    if (failed != OGRERR_NONE)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: its coordinate system cannot be told; name one with --s_srs",
                          name);
    return *crs_wkt != NULL ? SCREE_OK : scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
}

/* ---- places ---- */

/* The area on the globe that the TIN's bounding box takes, by a pipeline that may be NULL; false: none, or it is
 * wider than half of the globe. */
static bool find_area(const struct tin *tin, PJ *to_lonlat, double area_deg[4]) {
    double bounds[4];
    tin_bounds(tin, bounds);
    area_deg[0] = area_deg[1] = INFINITY;
    area_deg[2] = area_deg[3] = -INFINITY;
    for (int j = 0; j < SAMPLES; j++)
        for (int i = 0; i < SAMPLES; i++) {
            double x = bounds[0] + (bounds[2] - bounds[0]) * i / (SAMPLES - 1);
            double y = bounds[1] + (bounds[3] - bounds[1]) * j / (SAMPLES - 1);
            if (to_lonlat != NULL) proj_trans_generic(to_lonlat, PJ_FWD, &x, 0, 1, &y, 0, 1, NULL, 0, 0, NULL, 0, 0);
            if (!isfinite(x) || !isfinite(y)) continue;
            area_deg[0] = fmin(area_deg[0], x);
            area_deg[1] = fmin(area_deg[1], y);
            area_deg[2] = fmax(area_deg[2], x);
            area_deg[3] = fmax(area_deg[3], y);
        }
    return area_deg[0] <= area_deg[2] && area_deg[2] - area_deg[0] < HALF_TURN;
}

/* PROJ's best operation for where the TIN is, which its operation for anywhere tells. */
static enum scree_status find_operation(const struct moving *moving, PJ **to_lonlat, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    double area_deg[4];
    bool has_area = false, is_geographic;
    *to_lonlat = NULL;
    for (int pass = 0; pass < 2 && status == SCREE_OK; pass++) {
        char *pipeline = NULL;
        if (pass == 1 && (*to_lonlat == NULL || !has_area)) break;
        status = raster_crs_to_lonlat(moving->proj, moving->name, moving->crs_wkt, pass == 1 ? area_deg : NULL,
                                      &pipeline, &is_geographic, error);
        proj_destroy(*to_lonlat);
        *to_lonlat = NULL;
        if (status == SCREE_OK && pipeline != NULL && (*to_lonlat = proj_create(moving->proj, pipeline)) == NULL)
            status = scree_fail(error, SCREE_E_UNSUPPORTED, "%s: PROJ cannot carry out %s", moving->name, pipeline);
        if (status == SCREE_OK) has_area = find_area(moving->tin, *to_lonlat, area_deg);
        free(pipeline);
    }
    return status;
}

/* No triangle may reach around the globe the wrong way; the whole may be a turn or more away. */
static enum scree_status check_turn(const struct moving *moving, struct scree_error *error) {
    struct tin *tin = moving->tin;
    double bounds[4];
    bool is_split = false;
    tin_bounds(tin, bounds);
    double turns = 360 * floor((bounds[0] + HALF_TURN) / 360);
    for (size_t i = 0; i < 3 * (size_t)tin->triangle_count && !is_split; i++) {
        size_t next = i % 3 == 2 ? i - 2 : i + 1;
        is_split = fabs(tin->points[tin->corners[i]].x - tin->points[tin->corners[next]].x) > HALF_TURN;
    }
    if (is_split || bounds[2] - turns > HALF_TURN)
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: reaches across the antimeridian or around a pole, where it cannot be kept as triangles; "
                          "--grid makes posts of it",
                          moving->name);
    for (uint32_t i = 0; i < tin->point_count && turns != 0; i++) tin->points[i].x -= turns;
    return SCREE_OK;
}

static enum scree_status check_position(const struct moving *moving, const struct cloud_point *from,
                                        const struct cloud_point *to, struct scree_error *error) {
    if (fabs(to->x) <= 720 && fabs(to->y) <= 90) return SCREE_OK; /* false for what is no number */
    return scree_fail(error, SCREE_E_CORRUPT,
                      "%s: a point at %.9g %.9g lies nowhere on Earth in its coordinate system; --s_srs names another",
                      moving->name, from->x, from->y);
}

/* A CRS that counts to the west or south shows triangles from below. */
static void turn_mirrored(struct tin *tin) {
    double area2 = 0;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        const struct cloud_point *a = &tin->points[tin->corners[3 * t]], *b = &tin->points[tin->corners[3 * t + 1]];
        const struct cloud_point *c = &tin->points[tin->corners[3 * t + 2]];
        area2 += (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
    }
    for (size_t t = 0; t < tin->triangle_count && area2 < 0; t++) {
        uint32_t second = tin->corners[3 * t + 1];
        tin->corners[3 * t + 1] = tin->corners[3 * t + 2];
        tin->corners[3 * t + 2] = second;
    }
}

static enum scree_status move_places(const struct moving *moving, struct scree_error *error) {
    PJ *to_lonlat;
    struct tin *tin = moving->tin;
    enum scree_status status = find_operation(moving, &to_lonlat, error);
    for (uint32_t i = 0; i < tin->point_count && status == SCREE_OK; i++) {
        struct cloud_point from = tin->points[i], *to = &tin->points[i];
        if (to_lonlat != NULL)
            proj_trans_generic(to_lonlat, PJ_FWD, &to->x, 0, 1, &to->y, 0, 1, NULL, 0, 0, NULL, 0, 0);
        status = check_position(moving, &from, to, error);
    }
    proj_destroy(to_lonlat);
    if (status == SCREE_OK) status = check_turn(moving, error);
    if (status == SCREE_OK) turn_mirrored(tin);
    return status;
}

/* ---- heights ---- */

static bool shift_heights(PJ *shift, double shift_scale, struct tin *tin) {
    for (uint32_t i = 0; i < tin->point_count; i++) {
        struct cloud_point *point = &tin->points[i];
        double x = point->x, y = point->y, z = point->z * shift_scale;
        proj_trans_generic(shift, PJ_FWD, &x, 0, 1, &y, 0, 1, &z, 0, 1, NULL, 0, 0);
        if (!isfinite(z)) return false;
        point->z = z;
    }
    return true;
}

/* Above the ellipsoid, from metres above whatever the CRS says. */
static enum scree_status make_ellipsoidal(const struct moving *moving, struct raster_summary *summary, bool *is_shifted,
                                          struct scree_error *error) {
    double bounds[4];
    tin_bounds(moving->tin, bounds);
    struct raster_group group = {
        .west_deg = bounds[0], .south_deg = bounds[1], .east_deg = bounds[2], .north_deg = bounds[3]};
    enum scree_status status =
        raster_shift_find(moving->proj, moving->name, moving->crs_wkt, &group, &summary->datum, error);
    if (status == SCREE_OK && group.shift != NULL) {
        PJ *shift = proj_create(moving->proj, group.shift);
        if (shift == NULL)
            status = scree_fail(error, SCREE_E_UNSUPPORTED, "PROJ cannot carry out %s", group.shift);
        else if (!shift_heights(shift, group.shift_scale, moving->tin))
            status =
                scree_fail(error, SCREE_E_IO,
                           "%s: reaches beyond the area in which PROJ can make its heights ellipsoidal", moving->name);
        *is_shifted = true;
        proj_destroy(shift);
    }
    raster_group_free(&group);
    return status;
}

static enum scree_status move_heights(const struct moving *moving, const struct cloud_meaning *meaning,
                                      struct raster_summary *summary, double *height_unit_m,
                                      struct scree_error *error) {
    struct tin *tin = moving->tin;
    double vertical_metres = 1;
    bool is_shifted = false;
    enum scree_status status = SCREE_OK;
    raster_vertical_metres(moving->proj, moving->crs_wkt, &vertical_metres);
    *height_unit_m = meaning->height_metres * vertical_metres;
    for (uint32_t i = 0; i < tin->point_count && *height_unit_m != 1; i++) tin->points[i].z *= *height_unit_m;
    if (moving->options->profile == PROFILE_GEODETIC) {
        status = make_ellipsoidal(moving, summary, &is_shifted, error);
        if (is_shifted) *height_unit_m = 0;
    } else {
        summary->datum = strdup("heights: metres above the source's own datum (local profile)");
        if (summary->datum == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
    }
    if (status != SCREE_OK) return status;
    summary->height_min_m = INFINITY;
    summary->height_max_m = -INFINITY;
    for (uint32_t i = 0; i < tin->point_count; i++) {
        summary->height_min_m = fmin(summary->height_min_m, tin->points[i].z);
        summary->height_max_m = fmax(summary->height_max_m, tin->points[i].z);
    }
    double farthest_m = summary->height_max_m > -summary->height_min_m ? summary->height_max_m : summary->height_min_m;
    if (fabs(farthest_m) > MAX_HEIGHT_M && !moving->options->any_height)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: a point has a height of %.9g m; if it really is a height use --any-height, if it is a "
                          "stray point of a cloud --outliers",
                          moving->name, farthest_m);
    return SCREE_OK;
}

/* ---- all of it ---- */

static enum scree_status summarize(struct moving *moving, struct raster_summary *summary, struct scree_error *error) {
    tin_bounds(moving->tin, summary->bounds);
    bool is_local = moving->options->profile == PROFILE_LOCAL;
    summary->metres_per_unit = is_local ? raster_horizontal_metres(moving->proj, moving->crs_wkt) : 0;
    summary->crs_wkt = strdup(is_local ? moving->crs_wkt : "EPSG:4326");
    summary->attribution = strdup("");
    if (summary->crs_wkt == NULL || summary->attribution == NULL)
        return scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
    return SCREE_OK;
}

enum scree_status tin_georeference(const struct raster_options *options, const char *name,
                                   const struct cloud_meaning *meaning, struct tin *tin, struct raster_summary *summary,
                                   double *height_unit_m, struct scree_error *error) {
    struct moving moving = {.options = options, .name = name, .tin = tin, .proj = raster_proj_new()};
    struct raster_trap trap;
    raster_trap_set(&trap);
    enum scree_status status = SCREE_OK;
    if (moving.proj == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for PROJ");
    if (status == SCREE_OK) status = describe_crs(meaning->crs, name, &moving.crs_wkt, error);
    bool is_geodetic = options->profile == PROFILE_GEODETIC;
    if (status == SCREE_OK && is_geodetic && moving.crs_wkt[0] == '\0')
        status = scree_fail(error, SCREE_E_ARGUMENT,
                            "%s: names no coordinate system; name it with --s_srs, or use --profile local", name);
    if (status == SCREE_OK && is_geodetic) status = move_places(&moving, error);
    if (status == SCREE_OK) status = move_heights(&moving, meaning, summary, height_unit_m, error);
    if (status == SCREE_OK) status = summarize(&moving, summary, error);
    free(moving.crs_wkt);
    if (moving.proj != NULL) proj_context_destroy(moving.proj);
    raster_trap_clear();
    return status;
}
