/* Point clouds out of files: LAS, text, and layers of points that OGR reads. */
#ifndef SCREE_SRC_CLOUD_READ_IO_H
#define SCREE_SRC_CLOUD_READ_IO_H

#include "lod/cloud.h"
#include "src/cloud_options.h"

/* What the points' coordinates mean, as far as a file tells. */
struct cloud_crs {
    char *wkt;     /* NULL: nothing is told */
    char unit[40]; /* of heights, where that is told apart from a vertical CRS; "": it is not */
};
void cloud_crs_free(struct cloud_crs *crs);

/* Whether a file is a cloud: LAS; what is no raster but text by its name (.xyz, .csv, .txt, .pts) or has a layer of
 * OGR's. With `is_wanted`, text is a cloud also where GDAL could read it as a raster. */
bool cloud_is_cloud(const char *name, bool is_wanted);

/* Adds a file's points to the cloud: those that options.classes and options.returns let through. `crs` is to be freed
 * in any case; NULL: what the file says of its coordinate system is not looked at. SCREE_E_CORRUPT also when no point
 * is left. */
enum scree_status cloud_read(const char *name, const struct cloud_options *options, struct cloud *cloud,
                             struct cloud_crs *crs, struct scree_error *error);

#endif
