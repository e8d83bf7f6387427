/* Vertical CRS: heights become ellipsoidal by the operation that PROJ finds; a grid that it cannot find is an error,
 * never a silent shift of nothing.
 *
 * The shift is looked up at the post's WGS 84 longitude and latitude, whatever the horizontal datum of the source:
 * datums differ by some hundred metres at most, and the geoid's slope is below 1e-4, which makes a centimetre. */
#include "src/raster_parts_io.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The vertical part of a compound CRS; NULL when it has none. */
static PJ *vertical_of(PJ_CONTEXT *proj, const PJ *crs) {
    if (crs == NULL || proj_get_type(crs) != PJ_TYPE_COMPOUND_CRS) return NULL;
    return proj_crs_get_sub_crs(proj, crs, 1);
}

static bool axis_metres(PJ_CONTEXT *proj, PJ *crs, int axis, double *metres) {
    /* A vertical CRS may be bound to a grid of its own; its axis is that of the inner one. */
    PJ *inner = proj_get_type(crs) == PJ_TYPE_BOUND_CRS ? proj_get_source_crs(proj, crs) : NULL;
    PJ *system = proj_crs_get_coordinate_system(proj, inner != NULL ? inner : crs);
    const char *direction = NULL;
    bool found = system != NULL && proj_cs_get_axis_count(proj, system) > axis &&
                 proj_cs_get_axis_info(proj, system, axis, NULL, NULL, &direction, metres, NULL, NULL, NULL) &&
                 *metres > 0;
    if (found && direction != NULL && strcmp(direction, "down") == 0) *metres = -*metres;
    proj_destroy(system);
    proj_destroy(inner);
    return found;
}

bool raster_vertical_metres(PJ_CONTEXT *proj, const char *crs_wkt, double *metres) {
    if (crs_wkt[0] == '\0') return false;
    double found_metres = 1;
    PJ *crs = raster_crs_new(proj, crs_wkt);
    PJ *vertical = vertical_of(proj, crs);
    bool found = false;
    if (vertical != NULL)
        found = axis_metres(proj, vertical, 0, &found_metres);
    else if (crs != NULL && proj_get_type(crs) == PJ_TYPE_GEOGRAPHIC_3D_CRS)
        found = axis_metres(proj, crs, 2, &found_metres);
    if (found) *metres = found_metres;
    proj_destroy(vertical);
    proj_destroy(crs);
    return found;
}

static char *format_line(const char *format, const char *first, const char *second) {
    int length = snprintf(NULL, 0, format, first, second);
    char *line = length < 0 ? NULL : malloc((size_t)length + 1);
    if (line != NULL) snprintf(line, (size_t)length + 1, format, first, second);
    return line;
}

/* The compound of a geographic and a vertical CRS. */
static PJ *compound_new(PJ_CONTEXT *proj, const PJ *horizontal, const PJ *vertical) {
    static const char *const one_line[] = {"MULTILINE=NO", NULL};
    const char *text = horizontal == NULL ? NULL : proj_as_wkt(proj, horizontal, PJ_WKT2_2019, one_line);
    char *first = text == NULL ? NULL : strdup(text); /* PROJ keeps one text an object, and none for ever */
    const char *second = proj_as_wkt(proj, vertical, PJ_WKT2_2019, one_line);
    char *wkt = first == NULL || second == NULL ? NULL : format_line("COMPOUNDCRS[\"source\",%s,%s]", first, second);
    PJ *compound = wkt == NULL ? NULL : proj_create(proj, wkt);
    free(wkt);
    free(first);
    return compound;
}

static enum scree_status find_pipeline(PJ_CONTEXT *proj, const char *name, const PJ *crs, const PJ *vertical,
                                       struct raster_group *group, char **line, struct scree_error *error) {
    enum scree_status status = SCREE_E_UNSUPPORTED;
    char *description = NULL, *missing_grid = NULL;
    const double area_deg[4] = {group->west_deg, group->south_deg, group->east_deg, group->north_deg};
    bool has_area = group->east_deg - group->west_deg < 180 && group->west_deg >= -180 && group->east_deg <= 180;
    PJ *horizontal = proj_crs_get_geodetic_crs(proj, crs);
    PJ *source = compound_new(proj, horizontal, vertical);
    PJ *target = proj_create(proj, "EPSG:4979");
    if (source != NULL && target != NULL)
        status = raster_operation_find(proj, source, target, has_area ? area_deg : NULL, false, &group->shift,
                                       &description, &missing_grid);
    if (status == SCREE_OK) {
        *line = format_line("heights: %s, made ellipsoidal (WGS 84) by \"%s\"", proj_get_name(vertical),
                            description != NULL ? description : "");
        if (*line == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
    } else if (missing_grid != NULL) {
        status = scree_fail(error, SCREE_E_IO,
                            "%s: its heights are %s, and PROJ cannot find the grid %s that makes them ellipsoidal; "
                            "install the grid (or set PROJ_NETWORK=ON), or give --s_srs without a vertical part",
                            name, proj_get_name(vertical), missing_grid);
    } else {
        status = scree_fail(error, SCREE_E_UNSUPPORTED,
                            "%s: its heights are %s, and PROJ knows no way to make them ellipsoidal; give --s_srs "
                            "without a vertical part to take them as they are",
                            name, proj_get_name(vertical));
    }
    proj_destroy(target);
    proj_destroy(source);
    proj_destroy(horizontal);
    free(missing_grid);
    free(description);
    return status;
}

/* GeoTIFF files without a vertical datum may name one "unknown". */
static bool is_named(const PJ *vertical) {
    const char *name = vertical == NULL ? NULL : proj_get_name(vertical);
    return name != NULL && name[0] != '\0' && strcasecmp(name, "unknown") != 0 && strcasecmp(name, "unnamed") != 0;
}

enum scree_status raster_shift_find(PJ_CONTEXT *proj, const char *name, const char *crs_wkt, struct raster_group *group,
                                    char **line, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    PJ *crs = raster_crs_new(proj, crs_wkt);
    PJ *vertical = vertical_of(proj, crs);
    if (is_named(vertical)) {
        double axis = 1;
        if (!axis_metres(proj, vertical, 0, &axis)) axis = 1;
        group->shift_scale = 1 / axis;
        status = find_pipeline(proj, name, crs, vertical, group, line, error);
    } else {
        bool is_ellipsoidal = crs != NULL && proj_get_type(crs) == PJ_TYPE_GEOGRAPHIC_3D_CRS;
        *line = strdup(is_ellipsoidal ? "heights: ellipsoidal, as the source says"
                                      : "heights: no vertical datum is named, taken as ellipsoidal (WGS 84); name one "
                                        "with --s_srs, for example EPSG:4326+5773 for EGM96");
        if (*line == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a line");
    }
    proj_destroy(vertical);
    proj_destroy(crs);
    return status;
}

bool raster_shift_row(PJ *shift, double shift_scale, double west_deg, double spacing_deg, double latitude_deg,
                      int count, float *heights_m) {
    enum { CHUNK = 128 };
    bool is_pole = fabs(latitude_deg) >= 90; /* one point: one shift */
    for (int start = 0; start < count; start += CHUNK) {
        double x[CHUNK], y[CHUNK], z[CHUNK];
        int n = 0, where[CHUNK];
        for (int i = start; i < count && i < start + CHUNK; i++) {
            if (isnan(heights_m[i])) continue;
            double longitude_deg = is_pole ? 0 : west_deg + i * spacing_deg;
            x[n] = longitude_deg - 360 * floor((longitude_deg + 180) / 360);
            y[n] = latitude_deg;
            z[n] = heights_m[i] * shift_scale;
            where[n++] = i;
        }
        size_t size = sizeof *x, many = (size_t)n;
        if (n > 0) proj_trans_generic(shift, PJ_FWD, x, size, many, y, size, many, z, size, many, NULL, 0, 0);
        for (int i = 0; i < n; i++) {
            if (!isfinite(z[i])) return false;
            heights_m[where[i]] = (float)z[i];
        }
    }
    return true;
}
