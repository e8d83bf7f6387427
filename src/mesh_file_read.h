/* Surfaces of triangles out of files of common formats, told apart by their endings: PLY (text and binary), OBJ, OFF
 * (text), STL (text and binary), OM. Coordinates are doubles and as exact as the file has them; z is up, and units are
 * what the file's coordinates are in. Polygons become fans of triangles.
 *
 * OM is read by OpenMesh, from a copy that has only what was checked. The other readers are our own: those of OpenMesh
 * 9.0 keep coordinates as floats, which moves a northing of 4412345.678 m by 0.18 m; and they believe counts and
 * headers, so that files of a few bytes make them run for minutes or crash, and OBJ files make them open other files.
 */
#ifndef SCREE_MESH_FILE_READ_H
#define SCREE_MESH_FILE_READ_H

#include "lod/tin.h"

#include <stdbool.h>

#define MESH_MOST_CORNERS 1000 /* of one polygon */

/* Does the name end as those of the formats do? */
bool mesh_file_is_mesh(const char *name);

/* Reads a file, or what GDAL can open like one ("/vsizip/a.zip/b.ply"), into an empty TIN whose memory is set:
 * triangles as they are there, still to be mended. Failures name the file: SCREE_E_IO, SCREE_E_CORRUPT,
 * SCREE_E_UNSUPPORTED (what is written otherwise than here, such as binary OFF), SCREE_E_LIMIT. */
enum scree_status mesh_file_read(const char *path, struct tin *tin, struct scree_error *error);

#endif
