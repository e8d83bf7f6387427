/* A triangle mesh of terrain as every room hands it on: posts of the lattice, joined by triangles.
 *
 * Positions are lattice steps from the tile's south-west corner (x to the east, y to the north), one step being the
 * distance between posts of the finest zoom; heights are whole multiples of the build's height unit. */
#ifndef SCREE_MESH_H
#define SCREE_MESH_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct scree_vertex {
    int32_t x;      /* lattice steps east of the tile's western border */
    int32_t y;      /* lattice steps north of the tile's southern border */
    int32_t height; /* height units */
};

struct scree_mesh {
    uint32_t vertex_count;
    uint32_t triangle_count;
    struct scree_vertex *vertices; /* vertex_count of them; owned by whoever made the mesh */
    uint32_t *corners;             /* 3 * triangle_count vertex indices, counter-clockwise seen from above */
};

#ifdef __cplusplus
}
#endif
#endif
