/* Meshes as files, made by code byte by byte: a square of two triangles in every format that is read, with northings
 * that no float holds. */
#ifndef SCREE_TESTS_MESH_FILE_MAKER_H
#define SCREE_TESTS_MESH_FILE_MAKER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MESH_FILE_BYTES 2048
#define MESH_FILE_KINDS 9

struct mesh_file_bytes {
    unsigned char bytes[MESH_FILE_BYTES];
    size_t size_bytes;
};

struct mesh_file_kind {
    const char *name, *about;
    void (*make)(struct mesh_file_bytes *made); /* into an empty one */
    bool has_floats;                            /* coordinates are kept as floats */
    bool has_own_corners;                       /* every triangle has points of its own */
};

extern const struct mesh_file_kind mesh_file_kinds[MESH_FILE_KINDS];

/* The square's points, and the corners of its triangles. */
extern const double mesh_file_square[4][3];
extern const uint32_t mesh_file_corners[6];

/* Adds text; stops the program when it is too long. */
void mesh_file_put_text(struct mesh_file_bytes *made, const char *text);

#endif
