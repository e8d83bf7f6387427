/* The borders of decoded tiles, and whether two neighbours have the same one. Pure. */
#ifndef SCREE_VERIFY_BORDER_H
#define SCREE_VERIFY_BORDER_H

#include "src/quantized_mesh_decode.h"
#include "src/verify_tile.h"
#include "stream/memory.h"
#include <scree/error.h>

struct border_vertex {
    uint16_t at; /* code along the border */
    uint8_t normal[2];
    double height_m;
};

struct tile_border {
    bool has_normals;
    uint32_t count;
    struct border_vertex *vertices; /* ascending, one a place */
};

struct border_difference {
    uint32_t lone_vertices; /* on one side only */
    uint32_t normals;       /* shared vertices whose normals differ, */
    uint16_t normal_at;     /* and the code along the border of the first */
    double largest_m;       /* between the two heights along the border, linear from vertex to vertex */
};

/* The border of a side of the tile's window, from the vertices themselves (edge lists may be wrong). */
enum scree_status tile_border_new(struct scree_memory *memory, const struct decoded_tile *tile,
                                  const struct tile_frame *frame, enum edge_side side, struct tile_border *border,
                                  struct scree_error *error);

/* Safe on a zeroed border and twice. */
void tile_border_free(struct scree_memory *memory, struct tile_border *border);

struct border_difference tile_border_compare(const struct tile_border *one, const struct tile_border *other);

#endif
