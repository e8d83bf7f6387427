/* quantized-mesh-1.0: decoding, of tiles from any producer. Pure. Written from the format's specification and apart
 * from the writer (src/quantized_mesh.c), so that what the two agree on is the format.
 *
 * Nothing in the bytes is believed: counts are compared with the bytes that are left before anything is allocated,
 * every index is in range, and memory comes from a budget. What comes out is safe to walk, not yet a good mesh:
 * src/verify_tile.h judges that. */
#ifndef SCREE_QUANTIZED_MESH_DECODE_H
#define SCREE_QUANTIZED_MESH_DECODE_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DECODED_TOP 32767 /* the largest position and height code */

enum edge_side { EDGE_WEST, EDGE_SOUTH, EDGE_EAST, EDGE_NORTH, EDGE_COUNT }; /* in the order of the format */

struct decoded_tile {
    double center_m[3]; /* ECEF in the geodetic profile; so are the next two */
    float height_min_m, height_max_m;
    double sphere_center_m[3], sphere_radius_m;
    double occlusion[3]; /* horizon occlusion point, in units of the ellipsoid's radii */

    uint32_t vertex_count, triangle_count;
    uint16_t *u, *v, *h;        /* vertex_count codes each: 0..DECODED_TOP, west-east, south-north, low-high */
    uint32_t *corners;          /* 3 * triangle_count vertex indices */
    uint32_t used_vertex_count; /* the triangles name the vertices below this one and no others */
    uint32_t edge_count[EDGE_COUNT];
    uint32_t *edges[EDGE_COUNT]; /* vertex indices */
    uint8_t *normals;            /* 2 bytes a vertex, oct-encoded; NULL: none */

    bool has_water_mask, has_metadata;
    uint32_t unknown_extensions; /* skipped by their length */
};

/* Reads the plain bytes of a tile. SCREE_E_CORRUPT with the byte where it went wrong; SCREE_E_LIMIT or
 * SCREE_E_MEMORY from the budget. On failure *tile holds nothing. */
enum scree_status decoded_tile_read(struct scree_memory *memory, const unsigned char *bytes, size_t size_bytes,
                                    struct decoded_tile *tile, struct scree_error *error);

/* Gives the arrays back to the budget; safe on a zeroed tile and twice. */
void decoded_tile_free(struct scree_memory *memory, struct decoded_tile *tile);

/* Metres of height a code: exact where the writer chose a power of two. */
static inline double decoded_step_m(const struct decoded_tile *tile) {
    return ((double)tile->height_max_m - (double)tile->height_min_m) / DECODED_TOP;
}

static inline double decoded_height_m(const struct decoded_tile *tile, uint32_t vertex) {
    return (double)tile->height_min_m + tile->h[vertex] * decoded_step_m(tile);
}

#endif
