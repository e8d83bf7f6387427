/* A tile at all its scales in memory: what a decoder appends to and a player plays. Plain arrays, coarse to fine.
 *
 * A split adds one vertex: slots of existing triangles change hands (fix-ups) and triangles are appended. Vertices and
 * triangles are in the order in which they appear, so any scale is a prefix of both. */
#ifndef SCREE_STREAM_PROGRESSIVE_H
#define SCREE_STREAM_PROGRESSIVE_H

#include <scree/mesh.h>
#include <stdint.h>

/* corners[slot] is `coarse` before the split and `fine` after it. */
struct progressive_fixup {
    uint32_t slot, coarse, fine;
};

/* Split number i adds vertex base_vertices + i. */
struct progressive_split {
    uint32_t parent;       /* an earlier vertex, joined to this one: where it comes out of when the scale changes */
    uint32_t fixup_end;    /* fix-ups of this and all earlier splits */
    uint32_t triangle_end; /* triangles once it is applied */
};

struct progressive {
    uint32_t base_vertices, base_triangles;
    uint32_t vertex_count, triangle_count, fixup_count, split_count; /* decoded so far; vertex_count is base_vertices +
                                                                        split_count */
    uint32_t fixup_capacity;
    struct scree_vertex *vertices;    /* room for all of the header's finest rung */
    uint32_t *corners;                /* 3 a triangle, counter-clockwise, as they are when the triangle appears */
    struct progressive_split *splits; /* room for all */
    struct progressive_fixup *fixups; /* grows with each increment */
};

#endif
