/* What the files behind src/cloud_read_io.h share. */
#ifndef SCREE_SRC_CLOUD_PARTS_IO_H
#define SCREE_SRC_CLOUD_PARTS_IO_H

#include "src/cloud_read_io.h"
#include "src/las.h"

#include <cpl_vsi.h>

/* A file that is read by position. */
struct cloud_file {
    const char *name;
    VSILFILE *stream;
    uint64_t size_bytes;
};

/* Reads exactly so many bytes from a position; a failure names the file. */
enum scree_status cloud_file_read(const struct cloud_file *file, uint64_t at, void *bytes, size_t size_bytes,
                                  struct scree_error *error);

/* Adds a point that is on Earth. */
enum scree_status cloud_take(const char *name, struct cloud *cloud, struct cloud_point point,
                             struct scree_error *error);

/* cloud_las_io.c */
enum scree_status cloud_read_las(const struct cloud_file *file, const struct cloud_options *options,
                                 struct cloud *cloud, struct cloud_crs *crs, struct scree_error *error);

/* cloud_las_crs_io.c: the coordinate system that a LAS file's records tell. */
enum scree_status cloud_las_crs(const struct cloud_file *file, const struct las_header *header, struct cloud_crs *crs,
                                struct scree_error *error);

/* cloud_layer_io.c: layers of points with heights */
enum scree_status cloud_read_layers(const char *name, struct cloud *cloud, struct cloud_crs *crs,
                                    struct scree_error *error);

#endif
