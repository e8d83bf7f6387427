/* Decoded tiles of one zoom put together: vertices that two tiles share become one, by their exact position. Pure.
 *
 *     struct extract_mesh mesh = {.lattice = ..., .zoom = ...};
 *     for each tile: extract_mesh_add(&memory, &mesh, id, &tile, &error);
 *     extract_mesh_place(&mesh, true, NULL);
 *     ... extract_mesh_free(&memory, &mesh); */
#ifndef SCREE_EXTRACT_MESH_H
#define SCREE_EXTRACT_MESH_H

#include "src/decoded_place.h"
#include "src/lattice.h"
#include "src/quantized_mesh_decode.h"
#include "stream/memory.h"
#include <scree/error.h>

struct extract_vertex {
    int64_t x, y; /* codes from the south-western corner of the root, DECODED_TOP a tile */
    double height_m;
};

struct extract_mesh {
    const struct lattice *lattice; /* set by the caller */
    int zoom;                      /* set by the caller: of all tiles */
    uint32_t vertex_count, vertex_room;
    struct extract_vertex *vertices;
    uint32_t triangle_count, triangle_room;
    uint32_t *corners; /* 3 a triangle */
    uint32_t *table;   /* of vertex_room * 2 slots: vertex + 1 */
    double *xyz;       /* 3 a vertex, after extract_mesh_place */
    double origin[3];  /* what extract_mesh_place took off */
};

/* Adds a tile. Vertices join those of earlier tiles at the same place and height; around the globe and at the poles as
 * well (geodetic). Triangles that this leaves without an area are dropped. */
enum scree_status extract_mesh_add(struct scree_memory *memory, struct extract_mesh *mesh, struct tile_id id,
                                   const struct decoded_tile *tile, struct scree_error *error);

/* Computes xyz in metres: east, north, up of the horizon at `frame`, or ECEF where that is NULL; in the local profile
 * CRS x and y, and metres of height. Where coordinates are too large for floats to keep millimetres, whole metres are
 * taken off all of them, as `origin` tells. */
enum scree_status extract_mesh_place(struct scree_memory *memory, struct extract_mesh *mesh,
                                     const struct horizon_frame *frame, struct scree_error *error);

/* Safe on a zeroed mesh and twice. */
void extract_mesh_free(struct scree_memory *memory, struct extract_mesh *mesh);

#endif
