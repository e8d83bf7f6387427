/* Elevation from GDAL: what the rest of the program calls to open, describe and place rasters (src/raster_io.h). */
#include "src/cloud_read_io.h"
#include "src/mesh_file_read.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define CACHE_BYTES           (64 << 20) /* of GDAL's blocks, all threads together, unless the user configured it */
#define DEFAULT_FILL_DISTANCE 100
#define MAX_FILL_DISTANCE     2048
enum { POLE_SAMPLES = 360, SHIFT_SAMPLES = 33, EXTENT_SAMPLES = 65 };

static const struct {
    const char *name;
    GDALResampleAlg method;
    double overshoot; /* beyond the range of the source, as a share of that range */
} resamplings[] = {
    {"near", GRA_NearestNeighbour, 0},
    {"nearest", GRA_NearestNeighbour, 0},
    {"bilinear", GRA_Bilinear, 0},
    {"cubic", GRA_Cubic, 0.35},
    {"cubicspline", GRA_CubicSpline, 0},
    {"lanczos", GRA_Lanczos, 0.75},
    {"average", GRA_Average, 0},
    {"rms", GRA_RMS, 0},
    {"mode", GRA_Mode, 0},
    {"max", GRA_Max, 0},
    {"min", GRA_Min, 0},
    {"med", GRA_Med, 0},
    {"q1", GRA_Q1, 0},
    {"q3", GRA_Q3, 0},
};

static char *copied(const char *text) {
    return text == NULL ? NULL : strdup(text);
}

static enum scree_status check_options(struct raster *raster, const struct raster_options *options, double *overshoot,
                                       struct scree_error *error) {
    const char *wanted = options->resampling != NULL ? options->resampling : "bilinear";
    size_t i = 0, count = sizeof resamplings / sizeof *resamplings;
    while (i < count && strcasecmp(resamplings[i].name, wanted) != 0) i++;
    if (i == count)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "-r %s: no such resampling; use near, bilinear, cubic, cubicspline, lanczos, average, rms, "
                          "mode, max, min, med, q1 or q3",
                          wanted);
    raster->resampling = resamplings[i].method;
    *overshoot = resamplings[i].overshoot;
    if (options->input_count < 1) return scree_fail(error, SCREE_E_ARGUMENT, "no raster is named");
    if (options->fill_distance > MAX_FILL_DISTANCE)
        return scree_fail(error, SCREE_E_ARGUMENT, "voids can be filled over %d posts at most, not %d",
                          MAX_FILL_DISTANCE, options->fill_distance);
    raster->fill_distance = options->fill_distance < 0    ? 0
                            : options->fill_distance == 0 ? DEFAULT_FILL_DISTANCE
                                                          : options->fill_distance;
    const double *e = options->extent;
    if (options->has_extent) {
        bool is_finite = isfinite(e[0]) && isfinite(e[1]) && isfinite(e[2]) && isfinite(e[3]);
        bool may_wrap = options->profile == PROFILE_GEODETIC;
        if (!is_finite || e[1] >= e[3] || (e[0] >= e[2] && !may_wrap) || e[0] == e[2])
            return scree_fail(error, SCREE_E_ARGUMENT, "--te %g %g %g %g: is to be west south east north", e[0], e[1],
                              e[2], e[3]);
    }
    if (!isfinite(options->nodata_height_m))
        return scree_fail(error, SCREE_E_ARGUMENT, "the height outside of the data is not a number");
    return SCREE_OK;
}

/* The pixels of an input that --te needs, as x, y, columns, rows; false: none. */
static bool extent_pixels(const struct raster *raster, const struct raster_input *input, PJ *to_lonlat, int window[4]) {
    window[0] = window[1] = 0;
    window[2] = input->columns;
    window[3] = input->rows;
    const double *extent = raster->options.extent;
    struct raster_transform transform;
    if (!raster->options.has_extent) return true;
    bool is_local = raster->options.profile == PROFILE_LOCAL;
    bool is_geographic = !is_local && raster->groups[input->group].is_geographic;
    if (!raster_transform_make(&transform, input->geotransform, input->columns, input->rows, is_geographic, to_lonlat))
        return true;
    double east = !is_local && extent[2] < extent[0] ? extent[2] + 360 : extent[2];
    transform.spacing_x = (east - extent[0]) / (EXTENT_SAMPLES - 1);
    transform.spacing_y = (extent[3] - extent[1]) / (EXTENT_SAMPLES - 1);
    transform.south = extent[1];
    double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
    for (int turn = is_geographic ? -1 : 0; turn <= (is_geographic ? 1 : 0); turn++) {
        transform.west = extent[0] + 360 * turn;
        double x[EXTENT_SAMPLES], y[EXTENT_SAMPLES];
        double from_x = INFINITY, to_x = -INFINITY, from_y = INFINITY, to_y = -INFINITY;
        int success[EXTENT_SAMPLES];
        for (int j = 0; j < EXTENT_SAMPLES; j++) {
            for (int i = 0; i < EXTENT_SAMPLES; i++) x[i] = i, y[i] = j;
            raster_transform_points(&transform, TRUE, EXTENT_SAMPLES, x, y, NULL, success);
            for (int i = 0; i < EXTENT_SAMPLES; i++) {
                if (!success[i]) return true; /* rather read all */
                from_x = fmin(from_x, x[i]), to_x = fmax(to_x, x[i]);
                from_y = fmin(from_y, y[i]), to_y = fmax(to_y, y[i]);
            }
        }
        double margin_x = 3 + (to_x - from_x) / EXTENT_SAMPLES, margin_y = 3 + (to_y - from_y) / EXTENT_SAMPLES;
        from_x = fmax(from_x - margin_x, 0), to_x = fmin(to_x + margin_x, input->columns);
        from_y = fmax(from_y - margin_y, 0), to_y = fmin(to_y + margin_y, input->rows);
        if (from_x >= to_x || from_y >= to_y) continue;
        left = fmin(left, from_x), right = fmax(right, to_x);
        top = fmin(top, from_y), bottom = fmax(bottom, to_y);
    }
    if (left >= right || top >= bottom) return false;
    window[0] = (int)floor(left);
    window[1] = (int)floor(top);
    window[2] = (int)ceil(right) - window[0];
    window[3] = (int)ceil(bottom) - window[1];
    return true;
}

static void sample_shift(struct raster_group *group, PJ *shift) {
    double low_m = INFINITY, high_m = -INFINITY;
    float height_m[SHIFT_SAMPLES];
    double step_deg = (group->east_deg - group->west_deg) / (SHIFT_SAMPLES - 1);
    for (int j = 0; j < SHIFT_SAMPLES; j++) {
        double latitude_deg = group->south_deg + (group->north_deg - group->south_deg) * j / (SHIFT_SAMPLES - 1);
        for (int i = 0; i < SHIFT_SAMPLES; i++) {
            height_m[i] = 0;
            if (!raster_shift_row(shift, group->shift_scale, group->west_deg + i * step_deg, step_deg, latitude_deg, 1,
                                  &height_m[i]))
                continue; /* corners of the area may lie outside of the grid */
            low_m = fmin(low_m, height_m[i]);
            high_m = fmax(high_m, height_m[i]);
        }
    }
    group->shift_min_m = low_m <= high_m ? low_m : 0;
    group->shift_max_m = low_m <= high_m ? high_m : 0;
}

/* Appends a line to the datum's text unless it is there already. */
static bool add_line(char **text, const char *line) {
    if (*text != NULL && strstr(*text, line) != NULL) return true;
    size_t old = *text == NULL ? 0 : strlen(*text) + 2, size = old + strlen(line) + 1;
    char *grown = malloc(size);
    if (grown == NULL) return false;
    snprintf(grown, size, "%s%s%s", *text == NULL ? "" : *text, *text == NULL ? "" : "; ", line);
    free(*text);
    *text = grown;
    return true;
}

static enum scree_status find_shifts(struct raster *raster, PJ_CONTEXT *proj, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < raster->group_count && status == SCREE_OK; i++) {
        struct raster_group *group = &raster->groups[i];
        const struct raster_input *first = &raster->inputs[group->first_input];
        char *line = NULL;
        status = raster_shift_find(proj, first->name, first->crs_wkt, group, &line, error);
        if (status == SCREE_OK && !add_line(&raster->summary.datum, line))
            status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
        free(line);
        if (status != SCREE_OK || group->shift == NULL) continue;
        PJ *shift = proj_create(proj, group->shift);
        if (shift == NULL) return scree_fail(error, SCREE_E_UNSUPPORTED, "PROJ cannot carry out %s", group->shift);
        sample_shift(group, shift);
        proj_destroy(shift);
    }
    return status;
}

static enum scree_status describe_heights(struct raster *raster, PJ_CONTEXT *proj, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (raster->options.profile == PROFILE_GEODETIC)
        status = find_shifts(raster, proj, error);
    else if (!add_line(&raster->summary.datum, "heights: metres above the source's own datum (local profile)"))
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
    for (int i = 0; i < raster->input_count && status == SCREE_OK; i++) {
        char line[160];
        if (raster->inputs[i].unit[0] == '\0') continue;
        snprintf(line, sizeof line, "unit \"%.80s\" is unknown and taken as metres", raster->inputs[i].unit);
        if (!add_line(&raster->summary.datum, line)) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
    }
    return status;
}

/* What the scan has gathered about voids, group by group. */
static enum scree_status finish_enclosed(struct raster *raster, struct scree_error *error) {
    struct raster_trap trap;
    raster_trap_set(&trap);
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < raster->group_count && status == SCREE_OK; i++) {
        status = raster_enclosed_finish(&raster->groups[i], error);
        if (raster->groups[i].enclosed.heights_m != NULL) raster->has_enclosed = raster->fill_distance > 0;
    }
    raster_trap_clear();
    return status;
}

static enum scree_status scan(struct raster *raster, PJ_CONTEXT *proj, double overshoot, struct scree_error *error) {
    struct raster_summary *summary = &raster->summary;
    bool has_heights = false;
    summary->height_min_m = INFINITY;
    summary->height_max_m = -INFINITY;
    double uncertainty_m = 0;
    for (int i = 0; i < raster->group_count; i++) {
        enum scree_status status = raster_enclosed_make(&raster->groups[i], error);
        if (status != SCREE_OK) return status;
    }
    for (int i = 0; i < raster->input_count; i++) {
        const struct raster_input *input = &raster->inputs[i];
        const struct raster_group *group = &raster->groups[input->group];
        PJ *to_lonlat = group->to_lonlat != NULL ? proj_create(proj, group->to_lonlat) : NULL;
        int window[4];
        bool is_needed = extent_pixels(raster, input, to_lonlat, window);
        proj_destroy(to_lonlat);
        if (!is_needed) continue;
        struct raster_range range = {0};
        enum scree_status status = raster_input_scan(raster, input, window, &range, error);
        if (status != SCREE_OK) return status;
        if (!range.has_heights) continue;
        has_heights = true;
        summary->height_min_m = fmin(summary->height_min_m, range.min_m + group->shift_min_m);
        summary->height_max_m = fmax(summary->height_max_m, range.max_m + group->shift_max_m);
        uncertainty_m =
            fmax(uncertainty_m, (group->shift_max_m - group->shift_min_m) / 4 + (group->shift != NULL ? 0.5 : 0));
    }
    if (!has_heights)
        return scree_fail(error, SCREE_E_CORRUPT,
                          raster->options.has_extent ? "%s: no height lies within --te"
                                                     : "%s: holds no height, all of its pixels are nodata",
                          raster->inputs[0].name);
    summary->relief_margin_m = uncertainty_m + overshoot * (summary->height_max_m - summary->height_min_m);
    return SCREE_OK;
}

static enum scree_status find_attribution(struct raster *raster, struct scree_error *error) {
    static const char *const keys[] = {"ATTRIBUTION", "TIFFTAG_COPYRIGHT", "COPYRIGHT"};
    struct raster_trap trap;
    raster_trap_set(&trap);
    bool is_done = true;
    for (int i = 0; i < raster->input_count && is_done; i++) {
        GDALDatasetH dataset =
            GDALOpenEx(raster->inputs[i].dataset, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
        for (size_t k = 0; k < sizeof keys / sizeof *keys && dataset != NULL && is_done; k++) {
            const char *text = GDALGetMetadataItem(dataset, keys[k], NULL);
            if (text != NULL && text[0] != '\0') is_done = add_line(&raster->summary.attribution, text);
        }
        if (dataset != NULL) GDALClose(dataset);
    }
    if (is_done && raster->summary.attribution == NULL) is_done = add_line(&raster->summary.attribution, "");
    raster_trap_clear();
    return is_done ? SCREE_OK : scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
}

static enum scree_status summarize_geodetic(struct raster *raster, struct scree_error *error) {
    struct raster_summary *summary = &raster->summary;
    struct lattice lattice = lattice_geodetic(MAX_ZOOM - 1); /* fine enough to tell where data lie */
    summary->spacing_x = INFINITY;
    for (int i = 0; i < raster->group_count; i++)
        summary->spacing_x = fmin(summary->spacing_x, raster->groups[i].spacing_deg);
    summary->spacing_y = summary->spacing_x;
    struct raster_placement placement;
    enum scree_status status = raster_placement_make(raster, &lattice, &placement, error);
    free(placement.layers);
    if (status != SCREE_OK) return status;
    if (placement.columns == 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: lies outside of --te", raster->inputs[0].name);
    summary->bounds[0] = lattice_x(&lattice, (double)placement.x);
    summary->bounds[1] = lattice_y(&lattice, (double)placement.y);
    summary->bounds[2] = lattice_x(&lattice, (double)placement.x + placement.columns - 1);
    summary->bounds[3] = lattice_y(&lattice, (double)placement.y + placement.rows - 1);
    if (placement.columns >= lattice.columns - 1) summary->bounds[2] = summary->bounds[0] + 360;
    summary->crs_wkt = copied("EPSG:4326");
    return summary->crs_wkt != NULL ? SCREE_OK : scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
}

static enum scree_status summarize_local(struct raster *raster, PJ_CONTEXT *proj, struct scree_error *error) {
    struct raster_summary *summary = &raster->summary;
    const struct raster_group *group = &raster->groups[0];
    const double *g = group->geotransform;
    if (g[2] != 0 || g[4] != 0 || g[1] < 0)
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: its rows are not parallel to its coordinate system; gdalwarp it first",
                          raster->inputs[0].name);
    summary->spacing_x = g[1];
    summary->spacing_y = fabs(g[5]);
    double west = g[0] + g[1] / 2, rows = group->rows;
    double south = g[5] < 0 ? g[3] + (rows - 0.5) * g[5] : g[3] + 0.5 * g[5];
    double first[2] = {0, 0}, last[2] = {group->columns - 1.0, rows - 1.0};
    if (raster->options.has_extent) {
        const double *extent = raster->options.extent;
        double origin[2] = {west, south}, spacing[2] = {summary->spacing_x, summary->spacing_y};
        for (int axis = 0; axis < 2; axis++) {
            first[axis] = fmax(first[axis], ceil((extent[axis] - origin[axis]) / spacing[axis] - 1e-6));
            last[axis] = fmin(last[axis], floor((extent[axis + 2] - origin[axis]) / spacing[axis] + 1e-6));
        }
        if (last[0] < first[0] || last[1] < first[1])
            return scree_fail(error, SCREE_E_ARGUMENT, "%s: lies outside of --te", raster->inputs[0].name);
    }
    summary->columns = (int64_t)(last[0] - first[0]) + 1;
    summary->rows = (int64_t)(last[1] - first[1]) + 1;
    raster->local_crop.x = (int64_t)first[0];
    raster->local_crop.y = g[5] < 0 ? group->rows - 1 - (int64_t)last[1] : (int64_t)first[1];
    summary->bounds[0] = west + first[0] * summary->spacing_x;
    summary->bounds[1] = south + first[1] * summary->spacing_y;
    summary->bounds[2] = west + last[0] * summary->spacing_x;
    summary->bounds[3] = south + last[1] * summary->spacing_y;
    summary->metres_per_unit = raster_horizontal_metres(proj, raster->inputs[0].crs_wkt);
    summary->crs_wkt = copied(raster->inputs[0].crs_wkt);
    return summary->crs_wkt != NULL ? SCREE_OK : scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
}

/* Which inputs are clouds or meshes; the options for them need some. */
static enum scree_status find_clouds(const struct raster_options *options, bool *is_cloud, struct scree_error *error) {
    bool has_clouds = false;
    for (int i = 0; i < options->input_count; i++) {
        is_cloud[i] =
            mesh_file_is_mesh(options->inputs[i]) || cloud_is_cloud(options->inputs[i], options->cloud.named != NULL);
        has_clouds = has_clouds || is_cloud[i];
    }
    if (options->cloud.named != NULL && !has_clouds)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s is for point clouds and meshes, and %s is none that can be read",
                          options->cloud.named, options->inputs[0]);
    return SCREE_OK;
}

/* One input is one raster, but all clouds or meshes are one together. */
static enum scree_status open_input(struct raster *raster, const struct raster_options *options, int i,
                                    const bool *is_cloud, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (is_cloud[i] && raster->cloud_path != NULL) return SCREE_OK;
    if (is_cloud[i]) status = raster_clouds_make(raster, options, is_cloud, error);
    if (status != SCREE_OK) return status;
    const char *dataset = is_cloud[i] ? raster->cloud_path : options->inputs[i];
    return raster_input_open(raster, options->inputs[i], dataset, &raster->inputs[raster->input_count++], error);
}

static enum scree_status open_inputs(struct raster *raster, const struct raster_options *options,
                                     struct scree_error *error) {
    raster->inputs = calloc((size_t)options->input_count, sizeof *raster->inputs);
    raster->groups = calloc((size_t)options->input_count, sizeof *raster->groups);
    bool *is_cloud = calloc((size_t)options->input_count, sizeof *is_cloud);
    if (raster->inputs == NULL || raster->groups == NULL || is_cloud == NULL) {
        free(is_cloud);
        return scree_fail(error, SCREE_E_MEMORY, "no memory for %d inputs", options->input_count);
    }
    bool is_asked = raster_compound_ask();
    const bool is_filtered = options->filter.is_wanted;
    enum scree_status status =
        is_filtered ? raster_filter_open(raster, options, error) : find_clouds(options, is_cloud, error);
    for (int i = 0; i < options->input_count && !is_filtered && status == SCREE_OK; i++)
        status = open_input(raster, options, i, is_cloud, error);
    raster_compound_leave(is_asked);
    free(is_cloud);
    return status;
}

enum scree_status raster_open(const struct raster_options *options, struct raster **result, struct scree_error *error) {
    double overshoot = 0;
    PJ_CONTEXT *proj = raster_proj_new();
    struct raster *raster = calloc(1, sizeof *raster);
    enum scree_status status = SCREE_OK;
    if (proj == NULL || raster == NULL) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for a raster");
        goto cleanup;
    }
    struct raster_trap trap;
    raster_trap_set(&trap); /* a driver that cannot be loaded is not missed until a file needs it */
    GDALAllRegister();
    raster_trap_clear();
    if (CPLGetConfigOption("GDAL_CACHEMAX", NULL) == NULL) GDALSetCacheMax64(CACHE_BYTES);
    raster->options = *options;
    raster->options.inputs = NULL; /* the caller's strings need not outlive this call */
    raster->options.resampling = NULL;
    raster->options.source_srs = NULL;
    raster->options.cloud.named = NULL;
    raster->options.filter = (struct filter_options){0};
    raster->source_srs = copied(options->source_srs);
    status = check_options(raster, options, &overshoot, error);
    if (status == SCREE_OK) status = open_inputs(raster, options, error);
    if (status == SCREE_OK) status = raster_groups_make(raster, proj, error);
    if (status == SCREE_OK)
        status = options->profile == PROFILE_LOCAL ? summarize_local(raster, proj, error)
                                                   : summarize_geodetic(raster, error);
    if (status == SCREE_OK) status = describe_heights(raster, proj, error);
    if (status == SCREE_OK) status = scan(raster, proj, overshoot, error);
    if (status == SCREE_OK) status = finish_enclosed(raster, error);
    if (status == SCREE_OK) status = find_attribution(raster, error);
cleanup:
    if (proj != NULL) proj_context_destroy(proj);
    if (status == SCREE_OK)
        *result = raster;
    else
        raster_free(raster);
    return status;
}

const struct raster_summary *raster_summary(const struct raster *raster) {
    return &raster->summary;
}

void raster_summary_free(struct raster_summary *summary) {
    free(summary->crs_wkt);
    free(summary->datum);
    free(summary->filtered);
    free(summary->attribution);
    *summary = (struct raster_summary){0};
}

void raster_free(struct raster *raster) {
    if (raster == NULL) return;
    free(raster->placement.layers);
    for (int i = 0; i < raster->input_count; i++) raster_input_free(&raster->inputs[i]);
    for (int i = 0; i < raster->group_count; i++) raster_group_free(&raster->groups[i]);
    free(raster->groups);
    free(raster->inputs);
    if (raster->cloud_path != NULL) VSIUnlink(raster->cloud_path);
    free(raster->cloud_path);
    if (raster->filter_path != NULL) VSIUnlink(raster->filter_path);
    free(raster->filter_path);
    free(raster->source_srs);
    raster_summary_free(&raster->summary);
    free(raster);
}

/* The mean around the pole's row, from posts a degree apart. */
static enum scree_status find_pole(struct raster *raster, double latitude_deg, float *pole_m,
                                   struct scree_error *error) {
    struct lattice ring = raster->placement.lattice;
    ring.columns = POLE_SAMPLES + 1;
    ring.rows = 1;
    ring.spacing_x = 360.0 / POLE_SAMPLES;
    ring.south = latitude_deg;
    struct raster_placement placement;
    struct raster_field *field = NULL;
    float heights_m[POLE_SAMPLES];
    enum scree_status status = raster_placement_make(raster, &ring, &placement, error);
    if (status == SCREE_OK) status = raster_field_new(raster, &placement, false, &field, error);
    if (status == SCREE_OK) status = raster_field_read(field, 0, 0, POLE_SAMPLES, 1, heights_m, error);
    double sum_m = 0;
    int count = 0;
    for (int i = 0; i < POLE_SAMPLES && status == SCREE_OK; i++)
        if (!isnan(heights_m[i])) {
            sum_m += heights_m[i];
            count++;
        }
    *pole_m = count > 0 ? (float)(sum_m / count) : NAN;
    raster_field_free(field);
    free(placement.layers);
    return status;
}

enum scree_status raster_place(struct raster *raster, const struct lattice *lattice, struct scree_error *error) {
    const struct raster_summary *summary = &raster->summary;
    if (raster->is_placed) return scree_fail(error, SCREE_E_ARGUMENT, "a raster is placed once");
    if (lattice->profile != raster->options.profile ||
        (lattice->profile == PROFILE_LOCAL && (lattice->columns != summary->columns || lattice->rows != summary->rows)))
        return scree_fail(error, SCREE_E_ARGUMENT, "the lattice is not made for this raster");
    enum scree_status status = raster_placement_make(raster, lattice, &raster->placement, error);
    if (status != SCREE_OK) return status;
    const struct raster_placement *placement = &raster->placement;
    if (placement->columns == 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: no post lies within --te", raster->inputs[0].name);
    raster->pole_m[0] = raster->pole_m[1] = NAN;
    if (lattice->profile == PROFILE_GEODETIC) {
        if (placement->y == 0) status = find_pole(raster, -90, &raster->pole_m[0], error);
        if (status == SCREE_OK && placement->y + placement->rows == lattice->rows)
            status = find_pole(raster, 90, &raster->pole_m[1], error);
    }
    raster->is_placed = status == SCREE_OK;
    return status;
}

int raster_windows(const struct raster *raster, struct lattice_window windows[2]) {
    const struct raster_placement *placement = &raster->placement;
    int64_t first = placement->x, steps = placement->columns - 1, south = placement->y;
    int32_t rows = placement->rows - 1;
    int64_t turn = placement->lattice.columns - 1;
    bool is_around = placement->lattice.profile == PROFILE_GEODETIC && placement->columns >= turn;
    if (is_around) {
        first = 0;
        steps = turn;
    }
    if (first + steps <= turn) {
        windows[0] = (struct lattice_window){first, south, (int32_t)steps, rows};
        return 1;
    }
    windows[0] = (struct lattice_window){first, south, (int32_t)(turn - first), rows};
    windows[1] = (struct lattice_window){0, south, (int32_t)(first + steps - turn), rows};
    return 2;
}
