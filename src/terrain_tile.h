/* What the pyramid hands to the terrain product: one tile's mesh with all that a writer of static tiles needs. */
#ifndef SCREE_TERRAIN_TILE_H
#define SCREE_TERRAIN_TILE_H

#include "src/lattice.h"
#include <scree/mesh.h>
#include <stdbool.h>

struct terrain_tile {
    const struct lattice *lattice;
    struct tile_id id;
    const struct scree_mesh *mesh; /* lattice steps from the tile's south-western corner */
    bool is_coded;                 /* not steps: position codes already (lod/position_code.h) */
    const float *slopes;           /* 2 a vertex: dh/deast, dh/dnorth (metres a metre); NULL: no normals */
    double height_unit_m;          /* a power of two; what the mesh's heights count */
    int32_t border_step;           /* height units, a power of two: border heights are written as multiples of it */
};

/* Sums over tiles of a zoom; kept a tile and added up in tile order, so that no thread's timing shows. */
struct terrain_tile_statistics {
    uint32_t vertices;
    uint32_t triangles;
    uint64_t bytes;
    double tolerance_m;
    double max_error_m; /* what was measured while simplifying */
    double mmqe_m2;     /* mean minimum quadric error of the tile's mesh */
};

#endif
