/* Streams: one tile at every scale, coarse to fine, in one file that is useful from its first bytes on.
 *
 * A stream is a header, a base mesh and increments. Each increment adds vertices to the mesh that is there, and takes
 * it from one rung of the scale ladder to the next. docs/stream.md describes the bytes. */
#ifndef SCREE_STREAM_H
#define SCREE_STREAM_H

#include <scree/error.h>
#include <scree/mesh.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SCREE_STREAM_VERSION 1
#define SCREE_MAX_RUNGS      256 /* of one stream, the base included */
#define SCREE_MAX_TILE_STEPS (1 << 30)
#define SCREE_MAX_VERTICES   (1 << 24) /* of one tile */

enum scree_profile {
    SCREE_GEODETIC, /* EPSG:4326: coordinates are degrees on the WGS84 ellipsoid */
    SCREE_LOCAL     /* the coordinates of the source's own projected CRS; see scree.json for its WKT */
};

/* A mesh of the stream, and the block that adds it to the coarser one before. */
struct scree_rung {
    int32_t rung;          /* L of the ladder; grows with detail */
    uint32_t vertex_count; /* of the mesh at this rung */
    uint32_t triangle_count;
    float mmqe_m2;         /* mean minimum quadric error */
    float svo_m;           /* smallest visible object: its square root, made monotone */
    float max_error_m;     /* largest vertical distance of a post from the mesh, as measured */
    uint32_t size_bytes;   /* of the block */
    uint32_t checksum;     /* CRC-32 of the block */
    uint64_t offset_bytes; /* of the block in the file; blocks follow one another */
};

struct scree_stream_header {
    uint32_t version;
    enum scree_profile profile;
    int32_t zoom;
    uint32_t tile_x, tile_y;     /* from the west, from the south (TMS) */
    int32_t columns, rows;       /* lattice steps that the tile covers; its vertices are 0 .. columns, 0 .. rows */
    double west, south;          /* coordinate of the south-western corner: degrees, or CRS units */
    double spacing_x, spacing_y; /* of a lattice step, in the same units */
    double metres_x, metres_y;   /* local profile: metres of a lattice step; geodetic: 0 */
    int32_t height_exponent;     /* heights are multiples of 2^height_exponent metres */
    uint32_t rung_count;         /* at least 1 */
    struct scree_rung rungs[SCREE_MAX_RUNGS]; /* coarse to fine; the first is the base mesh */
    uint32_t size_bytes;                      /* of the header itself: where the base mesh begins */
};

#ifdef __cplusplus
}
#endif
#endif
