/* Mesh files among the inputs as one lot of triangles. */
#ifndef SCREE_SRC_MESH_JOIN_IO_H
#define SCREE_SRC_MESH_JOIN_IO_H

#include "lod/tin.h"
#include "src/raster_io.h"

/* Reads those of the inputs that `is_mesh` marks, at least one, into an empty TIN, whose memory is set: triangles as
 * they are there, still to be mended. Failures name the file. The TIN is to be released in any case. */
enum scree_status mesh_join(const struct raster_options *options, const bool *is_mesh, struct tin *tin,
                            struct scree_error *error);

#endif
