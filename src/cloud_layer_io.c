/* Points with heights out of the layers of whatever OGR reads. */
#include "src/cloud_parts_io.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdlib.h>
#include <string.h>

static enum scree_status take_geometry(const char *name, OGRGeometryH geometry, struct cloud *cloud,
                                       struct scree_error *error) {
    if (geometry == NULL || OGR_G_IsEmpty(geometry)) return SCREE_OK;
    OGRwkbGeometryType kind = wkbFlatten(OGR_G_GetGeometryType(geometry));
    if (kind != wkbPoint && kind != wkbMultiPoint)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: holds a %s; only points can become terrain", name,
                          OGRGeometryTypeToName(kind));
    if (!OGR_G_Is3D(geometry))
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: holds a point without a height (z)", name);
    if (kind == wkbPoint) {
        struct cloud_point point = {OGR_G_GetX(geometry, 0), OGR_G_GetY(geometry, 0), OGR_G_GetZ(geometry, 0)};
        return cloud_take(name, cloud, point, error);
    }
    enum scree_status status = SCREE_OK;
    int count = OGR_G_GetGeometryCount(geometry);
    for (int i = 0; i < count && status == SCREE_OK; i++)
        status = take_geometry(name, OGR_G_GetGeometryRef(geometry, i), cloud, error);
    return status;
}

static enum scree_status take_crs(const char *name, OGRLayerH layer, bool is_first, struct cloud_crs *crs,
                                  struct scree_error *error) {
    static const char *const wkt2[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", NULL};
    OGRSpatialReferenceH own = OGR_L_GetSpatialRef(layer);
    enum scree_status status = SCREE_OK;
    char *wkt = NULL;
    if (own != NULL && OSRExportToWktEx(own, &wkt, wkt2) != OGRERR_NONE)
        status = scree_fail(error, SCREE_E_UNSUPPORTED, "%s: its coordinate system cannot be told", name);
    if (status == SCREE_OK && is_first) {
        crs->wkt = wkt == NULL ? NULL : strdup(wkt);
        if (wkt != NULL && crs->wkt == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for a CRS");
    } else if (status == SCREE_OK && strcmp(wkt == NULL ? "" : wkt, crs->wkt == NULL ? "" : crs->wkt) != 0) {
        status = scree_fail(error, SCREE_E_UNSUPPORTED, "%s: its layers have different coordinate systems", name);
    }
    CPLFree(wkt);
    return status;
}

enum scree_status cloud_read_layers(const char *name, struct cloud *cloud, struct cloud_crs *crs,
                                    struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct raster_trap trap;
    raster_trap_set(&trap);
    GDALDatasetH dataset =
        GDALOpenEx(name, GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, NULL, NULL, NULL);
    if (dataset == NULL) status = raster_trap_fail(&trap, name, error);
    int count = dataset == NULL ? 0 : GDALDatasetGetLayerCount(dataset);
    for (int i = 0; i < count && status == SCREE_OK; i++) {
        OGRLayerH layer = GDALDatasetGetLayer(dataset, i);
        OGRFeatureH feature;
        if (crs != NULL) status = take_crs(name, layer, i == 0, crs, error);
        while (status == SCREE_OK && (feature = OGR_L_GetNextFeature(layer)) != NULL) {
            status = take_geometry(name, OGR_F_GetGeometryRef(feature), cloud, error);
            OGR_F_Destroy(feature);
        }
        if (status == SCREE_OK && trap.text[0] != '\0') status = raster_trap_fail(&trap, name, error);
    }
    GDALClose(dataset);
    raster_trap_clear();
    return status;
}
