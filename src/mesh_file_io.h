/* Triangle meshes as files of common formats: PLY, OBJ, STL, OFF (through OpenMesh). */
#ifndef SCREE_MESH_FILE_IO_H
#define SCREE_MESH_FILE_IO_H

#include <scree/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Does the name end in a format that can be written? */
bool mesh_file_is_known(const char *path);

/* Writes `path`, whole or not at all, in the format of its ending. Coordinates are written as floats: take an origin
 * off first where they are large.
 *   xyz      3 * vertex_count coordinates
 *   corners  3 * triangle_count vertex indices, each below vertex_count; no triangle with a vertex twice */
enum scree_status mesh_file_write(const char *path, const double *xyz, uint32_t vertex_count, const uint32_t *corners,
                                  uint32_t triangle_count, struct scree_error *error);

#ifdef __cplusplus
}
#endif
#endif
