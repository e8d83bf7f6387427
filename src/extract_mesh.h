/* Tiles put together: vertices that two tiles share become one, by their exact position. Pure.
 *
 *     struct extract_mesh mesh = {.lattice = ..., .zoom = ...};
 *     for each tile: extract_mesh_add(&memory, &mesh, id, &tile, &error);
 * or, for tiles whose vertices are posts of the lattice, at any zooms:
 *     struct extract_mesh mesh = {.lattice = ..., .in_posts = true};
 *     for each tile: extract_mesh_add_posts(&memory, &mesh, &posts, &error);
 * then
 *     extract_mesh_place(&mesh, true, NULL);
 *     ... extract_mesh_free(&memory, &mesh); */
#ifndef SCREE_EXTRACT_MESH_H
#define SCREE_EXTRACT_MESH_H

#include "src/decoded_place.h"
#include "src/lattice.h"
#include "src/quantized_mesh_decode.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>
#include <stdbool.h>

struct extract_vertex {
    int64_t x, y; /* from the south-western corner of the root: codes, DECODED_TOP a tile, or lattice steps */
    double height_m;
};

struct extract_mesh {
    const struct lattice *lattice; /* set by the caller */
    int zoom;                      /* set by the caller: of all tiles, unless `in_posts` */
    bool in_posts;                 /* set by the caller: vertices are posts of the lattice */
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

/* A mesh of posts, and where on the lattice its corner lies. */
struct extract_posts {
    int64_t x, y; /* lattice steps of the south-western corner */
    uint32_t vertex_count, triangle_count;
    const struct scree_vertex *vertices;
    const uint32_t *corners;
    double height_unit_m;
    const struct lattice_window *only; /* adds the triangles that lie in it and no others; NULL: all */
};

/* The same for a mesh of posts; the vertices of triangles that are left out are not added either. */
enum scree_status extract_mesh_add_posts(struct scree_memory *memory, struct extract_mesh *mesh,
                                         const struct extract_posts *posts, struct scree_error *error);

/* Computes xyz in metres: east, north, up of the horizon at `frame`, or ECEF where that is NULL; in the local profile
 * CRS x and y, and metres of height. Where coordinates are too large for floats to keep millimetres, whole metres are
 * taken off all of them, as `origin` tells. */
enum scree_status extract_mesh_place(struct scree_memory *memory, struct extract_mesh *mesh,
                                     const struct horizon_frame *frame, struct scree_error *error);

/* Room for so many more; SCREE_E_LIMIT beyond 2^30 of either. */
enum scree_status extract_mesh_reserve(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t vertices,
                                       uint32_t triangles, struct scree_error *error);

/* Codes around the globe and from pole to pole; 0 in the local profile. */
int64_t extract_mesh_around(const struct extract_mesh *mesh);

/* Safe on a zeroed mesh and twice. */
void extract_mesh_free(struct scree_memory *memory, struct extract_mesh *mesh);

#endif
