/* Point clouds among the inputs as one cloud in one coordinate system, as the options say. */
#ifndef SCREE_SRC_CLOUD_JOIN_IO_H
#define SCREE_SRC_CLOUD_JOIN_IO_H

#include "lod/cloud.h"
#include "src/raster_io.h"

#include <ogr_srs_api.h>

struct cloud_meaning {
    OGRSpatialReferenceH crs; /* NULL: none is told */
    double height_metres;     /* of a unit of height, before what the CRS says of its heights; 1 where it says that */
};

struct joined_cloud {
    struct cloud cloud; /* its memory has a limit: --memory or the default */
    struct cloud_meaning meaning;
};

/* The bytes that clouds and TINs may take: --memory, or its default. */
size_t cloud_memory_bytes(const struct cloud_options *options);

/* What coordinates mean. `source_srs` goes before `wkt`, which a file tells; both may be NULL. `unit` is of heights,
 * "" when nothing is told. */
enum scree_status cloud_meaning_take(const char *source_srs, const char *wkt, const char *unit,
                                     struct cloud_meaning *meaning, struct scree_error *error);
void cloud_meaning_free(struct cloud_meaning *meaning);

/* Reads those of the inputs that `is_cloud` marks, at least one; they are to have one CRS. Outliers are taken out and
 * the rest is thinned. joined->cloud.memory is set; `joined` is to be released in any case. Failures name the file. */
enum scree_status cloud_join(const struct raster_options *options, const char *source_srs, const bool *is_cloud,
                             struct joined_cloud *joined, struct scree_error *error);
void joined_cloud_release(struct joined_cloud *joined);

#endif
