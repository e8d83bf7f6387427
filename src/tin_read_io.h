/* Mesh files or point clouds as one TIN in its own coordinate system. */
#ifndef SCREE_SRC_TIN_READ_IO_H
#define SCREE_SRC_TIN_READ_IO_H

#include "lod/tin.h"
#include "src/cloud_join_io.h"

/* What the inputs are kept as. */
enum tin_kind {
    TIN_OF_NOTHING, /* posts: rasters, or --grid or --filter asks for them */
    TIN_OF_MESHES,
    TIN_OF_CLOUDS
};

/* SCREE_E_ARGUMENT when inputs of several kinds are to be kept as triangles. */
enum scree_status tin_kind_find(const struct raster_options *options, enum tin_kind *kind, struct scree_error *error);

/* Reads all inputs, which are of one kind, into an empty TIN, whose memory is set. Files of meshes are mended together,
 * clouds triangulated together; what options are for the other kind is refused. `meaning` and `tin` are to be released
 * in any case. Failures name a file. */
enum scree_status tin_read(const struct raster_options *options, enum tin_kind kind, struct tin *tin,
                           struct tin_mended *mended, struct cloud_meaning *meaning, struct scree_error *error);

#endif
