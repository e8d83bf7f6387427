/* Is a tile at its finest rung the union of its children at their coarsest, vertex for vertex and triangle for
 * triangle? Pure. */
#ifndef SCREE_VERIFY_STREAM_FAMILY_H
#define SCREE_VERIFY_STREAM_FAMILY_H

#include "src/lattice.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/player.h>

/* A triangle by where its corners are, in steps from the parent's south-western corner: the least corner first, then
 * the others counter-clockwise. */
struct family_triangle {
    struct scree_vertex corners[3];
};

/* The triangles of a mesh that lie in a window, sorted. */
struct family_part {
    uint32_t count;
    uint32_t crossing; /* triangles partly inside, left out */
    struct family_triangle *triangles;
};

/* `dx`, `dy` are added to all positions; `window` is in steps after that. */
enum scree_status family_part_new(struct scree_memory *memory, const struct scree_arrays *arrays, int32_t dx,
                                  int32_t dy, const struct lattice_window *window, struct family_part *part,
                                  struct scree_error *error);

/* Safe on a zeroed part and twice. */
void family_part_free(struct scree_memory *memory, struct family_part *part);

/* How many triangles of either are not in the other. */
uint32_t family_part_compare(const struct family_part *one, const struct family_part *other);

#endif
