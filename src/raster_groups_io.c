/* Gathers inputs that share one pixel grid into groups, so that no seam shows where tiles abut, and finds where each
 * group lies on the globe. */
#include "src/raster_parts_io.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRID_SLACK     0.01 /* pixels: grids that differ by no more are one */
#define TURN_SLACK     0.25 /* pixels: how badly a whole turn may be met */
#define CIRCLE_GAP_DEG 3.0  /* data with no larger gap between longitudes go around the globe */
enum { GRID_SAMPLES = 33, EDGE_SAMPLES = 257, ALL_SAMPLES = GRID_SAMPLES * GRID_SAMPLES + 4 * EDGE_SAMPLES };

void raster_group_free(struct raster_group *group) {
    free(group->to_lonlat);
    free(group->shift);
    raster_enclosed_free(&group->enclosed);
    *group = (struct raster_group){0};
}

static bool is_upright(const double g[6]) {
    return g[2] == 0 && g[4] == 0;
}

/* The column of the input in the group's grid, for a geographic grid in the turn that keeps the group narrow. */
static double best_column(const struct raster_group *group, const struct raster_input *input) {
    double spacing = group->geotransform[1];
    double column = (input->geotransform[0] - group->geotransform[0]) / spacing;
    if (!group->is_geographic) return column;
    double turn = 360 / fabs(spacing), best = column, best_width = INFINITY;
    static const int turns[] = {0, 1, -1};
    for (int i = 0; i < 3; i++) {
        double candidate = column + turns[i] * turn;
        double width = fmax(candidate + input->columns, group->columns) - fmin(candidate, 0);
        if (width < best_width - 0.5) {
            best = candidate;
            best_width = width;
        }
    }
    return best;
}

static bool joins(const struct raster *raster, const struct raster_group *group, const struct raster_input *input,
                  double *column, double *row) {
    const struct raster_input *first = &raster->inputs[group->first_input];
    const double *a = group->geotransform, *b = input->geotransform;
    if (strcmp(first->crs_wkt, input->crs_wkt) != 0 || !is_upright(a) || !is_upright(b)) return false;
    double longest = fmax(fmax(group->columns, group->rows), fmax(input->columns, input->rows));
    if (fabs(a[1] - b[1]) * longest > GRID_SLACK * fabs(a[1])) return false;
    if (fabs(a[5] - b[5]) * longest > GRID_SLACK * fabs(a[5])) return false;
    *column = best_column(group, input);
    *row = (b[3] - a[3]) / a[5];
    return fabs(*column - round(*column)) < GRID_SLACK && fabs(*row - round(*row)) < GRID_SLACK &&
           fmax(*column + input->columns, group->columns) - fmin(*column, 0) < INT_MAX &&
           fmax(*row + input->rows, group->rows) - fmin(*row, 0) < INT_MAX;
}

static void join(struct raster *raster, struct raster_group *group, struct raster_input *input, double at_column,
                 double at_row) {
    int column = (int)round(at_column), row = (int)round(at_row);
    int left = column < 0 ? column : 0, top = row < 0 ? row : 0;
    for (int i = 0; i < group->input_count; i++) {
        raster->inputs[group->first_input + i].group_column -= left;
        raster->inputs[group->first_input + i].group_row -= top;
    }
    input->group_column = column - left;
    input->group_row = row - top;
    int right = column + input->columns, bottom = row + input->rows;
    group->columns = (right > group->columns ? right : group->columns) - left;
    group->rows = (bottom > group->rows ? bottom : group->rows) - top;
    group->geotransform[0] += left * group->geotransform[1];
    group->geotransform[3] += top * group->geotransform[5];
    group->input_count++;
}

/* Columns that meet themselves after a turn get exactly a turn's spacing. */
static void close_turn(struct raster_group *group) {
    double *g = group->geotransform;
    double turn = round(360 / fabs(g[1]));
    if (!group->is_geographic || !is_upright(g) || group->columns < turn || turn < 2) return;
    if (fabs(turn * fabs(g[1]) - 360) > TURN_SLACK * fabs(g[1])) return;
    double spacing = copysign(360 / turn, g[1]);
    g[0] += (g[1] - spacing) / 2; /* the first column's centre stays */
    g[1] = spacing;
    group->columns = (int)turn;
    group->is_around = true;
}

static int compare_doubles(const void *a, const void *b) {
    double left = *(const double *)a, right = *(const double *)b;
    if (left != right) return left < right ? -1 : 1;
    return a < b ? -1 : 1; /* equal numbers are interchangeable */
}

/* The arc that holds all longitudes: what the largest gap between two of them leaves. */
static void find_arc(double *longitude, int count, double *west, double *east) {
    for (int i = 0; i < count; i++) longitude[i] -= 360 * floor((longitude[i] + 180) / 360);
    qsort(longitude, (size_t)count, sizeof *longitude, compare_doubles);
    double gap = longitude[0] + 360 - longitude[count - 1];
    *west = longitude[0];
    *east = longitude[count - 1];
    for (int i = 1; i < count; i++)
        if (longitude[i] - longitude[i - 1] > gap) {
            gap = longitude[i] - longitude[i - 1];
            *west = longitude[i];
            *east = longitude[i - 1] + 360;
        }
    if (gap < CIRCLE_GAP_DEG) {
        *west = -180;
        *east = 180;
    }
}

/* Pixel positions over the whole raster, closest along its edges. */
static int sample_pixels(double columns, double rows, double *x, double *y) {
    int n = 0;
    for (int j = 0; j < GRID_SAMPLES; j++)
        for (int i = 0; i < GRID_SAMPLES; i++, n++) {
            x[n] = columns * i / (GRID_SAMPLES - 1);
            y[n] = rows * j / (GRID_SAMPLES - 1);
        }
    for (int i = 0; i < EDGE_SAMPLES; i++) {
        double s = (double)i / (EDGE_SAMPLES - 1);
        const double edge[4][2] = {{s * columns, 0}, {s * columns, rows}, {0, s * rows}, {columns, s * rows}};
        for (int k = 0; k < 4; k++, n++) {
            x[n] = edge[k][0];
            y[n] = edge[k][1];
        }
    }
    return n;
}

static bool holds_pole(struct raster_transform *transform, double latitude_deg) {
    double x = 180, y = latitude_deg + 90;
    int success = 0;
    raster_transform_points(transform, TRUE, 1, &x, &y, NULL, &success);
    return success && x >= 0 && x <= transform->columns && y >= 0 && y <= transform->rows;
}

static bool find_bounds(struct raster_group *group, PJ *to_lonlat) {
    struct raster_transform transform;
    if (!raster_transform_make(&transform, group->geotransform, group->columns, group->rows, group->is_geographic,
                               to_lonlat))
        return false;
    transform.west = -180; /* a destination whose pixels are degrees */
    transform.south = -90;
    transform.spacing_x = transform.spacing_y = 1;
    double x[ALL_SAMPLES], y[ALL_SAMPLES];
    int success[ALL_SAMPLES];
    int count = sample_pixels(group->columns, group->rows, x, y), valid = 0;
    raster_transform_points(&transform, FALSE, count, x, y, NULL, success);
    double south = INFINITY, north = -INFINITY, west = INFINITY, east = -INFINITY;
    for (int i = 0; i < count; i++) {
        if (!success[i]) continue;
        double longitude = x[i] - 180;
        x[valid++] = longitude;
        west = fmin(west, longitude);
        east = fmax(east, longitude);
        south = fmin(south, y[i] - 90);
        north = fmax(north, y[i] - 90);
    }
    if (valid == 0) return false;
    if (!group->is_geographic) find_arc(x, valid, &west, &east);
    group->south_deg = fmax(south, -90);
    group->north_deg = fmin(north, 90);
    if (!group->is_geographic)
        for (int pole = -1; pole <= 1; pole += 2) {
            if (!holds_pole(&transform, pole * 90.0)) continue;
            if (pole < 0) group->south_deg = -90;
            if (pole > 0) group->north_deg = 90;
            west = -180;
            east = 180;
        }
    group->west_deg = west;
    group->east_deg = group->is_around ? west + 360 : east;
    double u[3] = {group->columns / 2.0, group->columns / 2.0 + 1, group->columns / 2.0};
    double v[3] = {group->rows / 2.0, group->rows / 2.0, group->rows / 2.0 + 1};
    raster_transform_points(&transform, FALSE, 3, u, v, NULL, success);
    double along_row = fmax(fabs(remainder(u[1] - u[0], 360)), fabs(v[1] - v[0]));
    double along_column = fmax(fabs(remainder(u[2] - u[0], 360)), fabs(v[2] - v[0]));
    bool has_centre = success[0] && success[1] && success[2] && along_row > 0 && along_column > 0;
    group->spacing_deg = has_centre ? fmin(along_row, along_column) : (north - south) / group->rows;
    return group->spacing_deg > 0;
}

static enum scree_status check_geographic(const struct raster_group *group, const char *name,
                                          struct scree_error *error) {
    const double *g = group->geotransform;
    double corner_x[2] = {g[0], g[0] + group->columns * g[1] + group->rows * g[2]};
    double corner_y[2] = {g[3], g[3] + group->columns * g[4] + group->rows * g[5]};
    double step_x = fabs(g[1]) + fabs(g[2]), step_y = fabs(g[4]) + fabs(g[5]);
    for (int i = 0; i < 2; i++)
        if (fabs(corner_y[i]) > 90 + 1.01 * step_y || fabs(corner_x[i]) > 720 + step_x)
            return scree_fail(error, SCREE_E_CORRUPT,
                              "%s: reaches longitude %g, latitude %g, which is not on Earth; is its coordinate system "
                              "really in degrees? (--s_srs names another)",
                              name, corner_x[i], corner_y[i]);
    if (fabs(corner_x[1] - corner_x[0]) > 360 + 2.01 * step_x)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: spans %g degrees of longitude, more than the globe has", name,
                          fabs(corner_x[1] - corner_x[0]));
    return SCREE_OK;
}

static enum scree_status locate(struct raster *raster, struct raster_group *group, PJ_CONTEXT *proj,
                                struct scree_error *error) {
    const struct raster_input *first = &raster->inputs[group->first_input];
    enum scree_status status = SCREE_OK;
    if (group->is_geographic) status = check_geographic(group, first->name, error);
    if (status != SCREE_OK) return status;
    close_turn(group);
    PJ *to_lonlat = NULL;
    /* First where it lies by PROJ's operation for anywhere, then by the best one for that area. */
    for (int pass = 0; pass < 2 && status == SCREE_OK; pass++) {
        if (pass == 1) {
            bool is_narrow = group->east_deg <= 180 && group->west_deg >= -180;
            double area_deg[4] = {group->west_deg, group->south_deg, group->east_deg, group->north_deg};
            if (to_lonlat == NULL || !is_narrow) break;
            free(group->to_lonlat);
            group->to_lonlat = NULL;
            status = raster_crs_to_lonlat(proj, first->name, first->crs_wkt, area_deg, &group->to_lonlat,
                                          &group->is_geographic, error);
            proj_destroy(to_lonlat);
            to_lonlat = NULL;
            if (status != SCREE_OK) break;
        }
        if (group->to_lonlat != NULL) {
            to_lonlat = proj_create(proj, group->to_lonlat);
            if (to_lonlat == NULL)
                status = scree_fail(error, SCREE_E_UNSUPPORTED, "%s: PROJ cannot carry out %s", first->name,
                                    group->to_lonlat);
        }
        if (status == SCREE_OK && !find_bounds(group, to_lonlat))
            status = scree_fail(error, SCREE_E_CORRUPT,
                                "%s: lies nowhere on Earth in its coordinate system; is its geotransform right? "
                                "(--s_srs names another system)",
                                first->name);
    }
    proj_destroy(to_lonlat);
    return status;
}

static enum scree_status begin_group(struct raster *raster, int input_index, PJ_CONTEXT *proj,
                                     struct scree_error *error) {
    struct raster_input *input = &raster->inputs[input_index];
    struct raster_group *group = &raster->groups[raster->group_count++];
    *group = (struct raster_group){
        .first_input = input_index, .input_count = 1, .columns = input->columns, .rows = input->rows};
    memcpy(group->geotransform, input->geotransform, sizeof group->geotransform);
    if (raster->options.profile == PROFILE_LOCAL) return SCREE_OK;
    return raster_crs_to_lonlat(proj, input->name, input->crs_wkt, NULL, &group->to_lonlat, &group->is_geographic,
                                error);
}

enum scree_status raster_groups_make(struct raster *raster, PJ_CONTEXT *proj, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < raster->input_count && status == SCREE_OK; i++) {
        struct raster_input *input = &raster->inputs[i];
        struct raster_group *last = raster->group_count > 0 ? &raster->groups[raster->group_count - 1] : NULL;
        double column, row;
        if (last != NULL && joins(raster, last, input, &column, &row))
            join(raster, last, input, column, row);
        else if (last != NULL && raster->options.profile == PROFILE_LOCAL)
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "%s: is not on the pixel grid of %s, which the local profile needs; gdalwarp it to that "
                              "grid, or use --profile geodetic",
                              input->name, raster->inputs[0].name);
        else
            status = begin_group(raster, i, proj, error);
        input->group = raster->group_count - 1;
    }
    if (raster->options.profile == PROFILE_LOCAL || status != SCREE_OK) return status;
    for (int i = 0; i < raster->group_count && status == SCREE_OK; i++)
        status = locate(raster, &raster->groups[i], proj, error);
    return status;
}
