/* What other formats need for the same terrain: quantized-mesh under gzip, Draco, lossless JPEG 2000. */
#ifndef SCREE_TESTS_BENCH_RIVALS_H
#define SCREE_TESTS_BENCH_RIVALS_H

#include "lod/slopes.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>
#include <stddef.h>

/* Bytes of the mesh as a gzipped quantized-mesh tile of the local profile, as `scree build` writes it; `slopes` NULL:
 * without normals. */
enum scree_status rival_quantized_mesh(struct scree_memory *memory, const struct scree_mesh *mesh, int32_t columns,
                                       int32_t rows, int height_exponent, double spacing_m,
                                       const struct slope_grid *slopes, size_t *size_bytes, struct scree_error *error);

/* Bytes of the mesh as draco_encoder writes it at its best, from whole numbers: without loss. SCREE_E_UNSUPPORTED when
 * the program is not installed. `folder` is for its files. */
enum scree_status rival_draco(const char *folder, const struct scree_mesh *mesh, size_t *size_bytes,
                              struct scree_error *error);

/* Bytes of a grid of whole metres as lossless JPEG 2000 by GDAL's OpenJPEG driver. SCREE_E_UNSUPPORTED when there is no
 * such driver. */
enum scree_status rival_jpeg2000(const char *folder, const float *heights_m, int stride, int columns, int rows,
                                 size_t *size_bytes, struct scree_error *error);

#endif
