/* Coordinate systems: PROJ's operation from a CRS to longitude and latitude, chosen once for an area, so that every
 * reader uses the same one. */
#include "src/raster_parts_io.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

PJ *raster_crs_new(PJ_CONTEXT *proj, const char *crs_wkt) {
    PJ *crs = proj_create(proj, crs_wkt);
    while (crs != NULL && proj_get_type(crs) == PJ_TYPE_BOUND_CRS) {
        PJ *inner = proj_get_source_crs(proj, crs);
        proj_destroy(crs);
        crs = inner;
    }
    return crs;
}

/* How many grids of an operation PROJ cannot find, and their names in a new string. */
static int missing_grids_of(PJ_CONTEXT *proj, const PJ *operation, char **names) {
    int count = proj_coordoperation_get_grid_used_count(proj, operation), missing = 0;
    char text[256] = "";
    for (int i = 0; i < count; i++) {
        const char *name = NULL, *package = NULL, *url = NULL, *full = NULL;
        int is_direct = 0, is_open = 0, is_available = 0;
        if (!proj_coordoperation_get_grid_used(proj, operation, i, &name, &full, &package, &url, &is_direct, &is_open,
                                               &is_available) ||
            is_available || name == NULL)
            continue;
        size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s%s", missing > 0 ? " and " : "", name);
        missing++;
    }
    *names = missing > 0 ? strdup(text) : NULL;
    return missing;
}

/* Keeps the names of the operation that lacks the fewest grids. */
static void note_missing(PJ_CONTEXT *proj, const PJ *operation, int *least, char **missing_grid) {
    char *names = NULL;
    int missing = missing_grids_of(proj, operation, &names);
    if (names != NULL && missing < *least) {
        free(*missing_grid);
        *missing_grid = names;
        *least = missing;
    } else {
        free(names);
    }
}

enum scree_status raster_operation_find(PJ_CONTEXT *proj, const PJ *source, const PJ *target, const double area_deg[4],
                                        bool allow_ballpark, char **pipeline, char **description, char **missing_grid) {
    PJ_OPERATION_FACTORY_CONTEXT *factory = proj_create_operation_factory_context(proj, NULL);
    if (factory == NULL) return SCREE_E_MEMORY;
    proj_operation_factory_context_set_spatial_criterion(proj, factory, PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
    proj_operation_factory_context_set_grid_availability_use(proj, factory, PROJ_GRID_AVAILABILITY_IGNORED);
    proj_operation_factory_context_set_allow_ballpark_transformations(proj, factory, allow_ballpark);
    if (area_deg != NULL)
        proj_operation_factory_context_set_area_of_interest(proj, factory, area_deg[0], area_deg[1], area_deg[2],
                                                            area_deg[3]);
    PJ_OBJ_LIST *operations = proj_create_operations(proj, source, target, factory);
    int count = operations == NULL ? 0 : proj_list_get_count(operations);
    int least_missing = INT_MAX;
    *pipeline = NULL;
    for (int i = 0; i < count && *pipeline == NULL; i++) {
        PJ *operation = proj_list_get(proj, operations, i);
        if (operation == NULL) continue;
        if (proj_coordoperation_is_instantiable(proj, operation)) {
            PJ *in_map_order = proj_normalize_for_visualization(proj, operation);
            const char *text = in_map_order == NULL ? NULL : proj_as_proj_string(proj, in_map_order, PJ_PROJ_5, NULL);
            if (text != NULL) *pipeline = strdup(text);
            if (text != NULL && description != NULL) *description = strdup(proj_get_name(operation));
            proj_destroy(in_map_order);
        } else if (missing_grid != NULL) {
            note_missing(proj, operation, &least_missing, missing_grid);
        }
        proj_destroy(operation);
    }
    proj_list_destroy(operations);
    proj_operation_factory_context_destroy(factory);
    return *pipeline != NULL ? SCREE_OK : SCREE_E_UNSUPPORTED;
}

enum scree_status raster_crs_to_lonlat(PJ_CONTEXT *proj, const char *name, const char *crs_wkt,
                                       const double area_deg[4], char **pipeline, bool *is_geographic,
                                       struct scree_error *error) {
    enum scree_status status = SCREE_E_UNSUPPORTED;
    PJ *target = proj_create(proj, "EPSG:4326");
    PJ *crs = raster_crs_new(proj, crs_wkt);
    if (crs != NULL && proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS) {
        PJ *horizontal = proj_crs_get_sub_crs(proj, crs, 0);
        proj_destroy(crs);
        crs = horizontal;
    }
    *pipeline = NULL;
    if (crs != NULL && target != NULL) {
        PJ_TYPE type = proj_get_type(crs);
        *is_geographic = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
        status = raster_operation_find(proj, crs, target, area_deg, true, pipeline, NULL, NULL);
    }
    if (status == SCREE_OK && strcmp(*pipeline, "+proj=noop") == 0) {
        free(*pipeline);
        *pipeline = NULL;
    }
    if (status != SCREE_OK)
        status = scree_fail(error, SCREE_E_UNSUPPORTED,
                            "%s: PROJ knows no way from its coordinate system to longitude and latitude; name another "
                            "with --s_srs, or use --profile local",
                            name);
    proj_destroy(crs);
    proj_destroy(target);
    return status;
}

double raster_horizontal_metres(PJ_CONTEXT *proj, const char *crs_wkt) {
    double metres = 1;
    if (crs_wkt[0] == '\0') return metres;
    PJ *crs = raster_crs_new(proj, crs_wkt);
    if (crs != NULL && proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS) {
        PJ *horizontal = proj_crs_get_sub_crs(proj, crs, 0);
        proj_destroy(crs);
        crs = horizontal;
    }
    PJ *system = crs == NULL ? NULL : proj_crs_get_coordinate_system(proj, crs);
    if (system != NULL) proj_cs_get_axis_info(proj, system, 0, NULL, NULL, NULL, &metres, NULL, NULL, NULL);
    PJ_TYPE type = crs == NULL ? PJ_TYPE_UNKNOWN : proj_get_type(crs);
    if (type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS)
        metres *= 6378137.0; /* radians a unit: metres at the equator */
    proj_destroy(system);
    proj_destroy(crs);
    return metres > 0 && isfinite(metres) ? metres : 1;
}
