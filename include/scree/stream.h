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
    float mmqe_m2;       /* mean minimum quadric error */
    float svo_m;         /* smallest visible object: its square root, made monotone */
    float max_error_m;   /* largest vertical distance from the mesh, as measured: at the finest zoom of all posts, above
                            it of the lowest and the highest post of each of the tile's 256 x 256 cells */
    uint32_t size_bytes; /* of the block */
    uint32_t checksum;   /* CRC-32 of the block */
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

/* Reads a header from the first bytes of a stream; those of any stream's header fit into 64 KiB, as a rule into one.
 * SCREE_MORE: not all of it is there yet. `header` is whole after SCREE_OK only. */
SCREE_API enum scree_status scree_stream_header_read(const void *bytes, size_t size_bytes,
                                                     struct scree_stream_header *header, struct scree_error *error);

/* The coarsest mesh of the stream that is good enough, as an index into `rungs`: the first whose SVO or max error is at
 * most so many metres, or whose rung of the ladder is at least `rung`; where none is, the finest. */
SCREE_API uint32_t scree_stream_rung_of_svo(const struct scree_stream_header *header, double svo_m);
SCREE_API uint32_t scree_stream_rung_of_error(const struct scree_stream_header *header, double max_error_m);
SCREE_API uint32_t scree_stream_rung_of_ladder(const struct scree_stream_header *header, int32_t rung);

/* Where a tile's local frame lies in the world: a point (x, y, z) of the frame, in metres, is at
 * origin + x axes[0] + y axes[1] + z axes[2].
 *
 * Geodetic: the world is WGS84 ECEF in metres; the origin is on the ellipsoid at the middle of the tile's longitudes
 * and latitudes, the axes are unit vectors to the east, north and up there. Local: the world is the CRS, heights in
 * metres; the origin is the middle of the tile at height 0, the axes are one metre along those of the CRS. */
struct scree_frame {
    double origin[3];
    double axes[3][3];
};

SCREE_API void scree_stream_frame(const struct scree_stream_header *header, struct scree_frame *frame);

/* The place in the tile's frame, in metres, of a point of its lattice (fractions and points outside are fine) at a
 * height in metres: exact on the ellipsoid, so a tile of the globe is round. */
SCREE_API void scree_stream_position(const struct scree_stream_header *header, const struct scree_frame *frame,
                                     double x, double y, double height_m, double position_m[3]);

#ifdef __cplusplus
}
#endif
#endif
