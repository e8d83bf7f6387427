/* Progressive tiles made by chance, for tests and measurements of playback that want no codec: a rectangle of two
 * triangles, into which vertices are put one after the other, each with the polygon that it sees around it. */
#ifndef SCREE_TESTS_PROGRESSIVE_MAKER_H
#define SCREE_TESTS_PROGRESSIVE_MAKER_H

#include "stream/memory.h"
#include "stream/progressive.h"
#include <stdbool.h>

struct progressive_wish {
    uint64_t seed;
    int32_t columns, rows; /* lattice steps */
    uint32_t base_splits;  /* vertices of the base mesh beyond the four corners */
    uint32_t splits;
    bool half_edges; /* polygons are parts of their parent's star, as half-edge collapses leave them */
};

/* Fewer splits where the lattice is full. Stops the test program when memory lacks. */
void make_progressive(struct scree_memory *memory, const struct progressive_wish *wish,
                      struct progressive *progressive);
void release_progressive(struct scree_memory *memory, struct progressive *progressive);

/* What is wrong with triangles that are to cover columns x rows steps, or NULL: corners exist, areas are positive and
 * add up, every edge inside has a triangle on both sides, Euler's sum is 1. */
const char *triangles_fault(struct scree_memory *memory, const struct scree_vertex *vertices, uint32_t vertex_count,
                            const uint32_t *corners, uint32_t triangle_count, int32_t columns, int32_t rows);

#endif
