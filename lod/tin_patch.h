/* The triangles of a TIN in and around one tile, with numbers of their own. Pure. */
#ifndef SCREE_LOD_TIN_PATCH_H
#define SCREE_LOD_TIN_PATCH_H

#include "lod/tin_lattice.h"
#include <stdbool.h>

#define TIN_PATCH_NONE UINT32_MAX

/* Half-edge 3 * t + k leads from corner k of triangle t to the next one. */
struct tin_patch {
    struct scree_memory *memory;
    struct tin_post *points; /* in steps from the tile's south-western corner, in the order of the TIN's points */
    uint32_t *corners;
    uint32_t *twins; /* of half-edges; TIN_PATCH_NONE on the surface's outline */
    uint32_t point_count, triangle_count;
};

/* The patch of tile (column, row) of the lattice's frame. */
enum scree_status tin_patch_make(struct scree_memory *memory, const struct tin_lattice *lattice, int32_t column,
                                 int32_t row, struct tin_patch *patch, struct scree_error *error);

/* Fine on a zeroed struct. */
void tin_patch_release(struct tin_patch *patch);

static inline uint32_t tin_patch_origin(const struct tin_patch *patch, uint32_t edge) {
    return patch->corners[edge];
}
static inline uint32_t tin_patch_target(const struct tin_patch *patch, uint32_t edge) {
    return patch->corners[edge % 3 == 2 ? edge - 2 : edge + 1];
}

/* The surface at a place, which `post` names: true, and its height and slope are set, where the patch covers it. A
 * place no farther than `slack` steps outside of a triangle counts when none covers it. */
bool tin_patch_covers(const struct tin_patch *patch, int32_t slack, struct tin_post *post);

/* Where the edge between two points, in either order, crosses the line `x == at` (or `y == at`): rounded along it. The
 * points lie on different sides of it. */
struct tin_post tin_patch_cross(const struct tin_patch *patch, uint32_t a, uint32_t b, bool is_upright, int32_t at);

#endif
