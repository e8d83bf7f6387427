/* Do the triangles of a tile cover its window exactly once? Pure; integers only.
 *
 * If every triangle has a positive area, every directed edge is used once and has its opposite unless it runs along
 * the window's border, and those border edges go around once, then every point of the window lies in exactly one
 * triangle (the degree of the map is one, and it never folds). The sum of the areas is compared as well. */
#ifndef SCREE_VERIFY_COVER_H
#define SCREE_VERIFY_COVER_H

#include "src/quantized_mesh_decode.h"
#include "stream/memory.h"
#include <scree/error.h>

struct cover_result {
    uint32_t flat_triangles, flipped_triangles;
    uint32_t outside_vertices; /* beyond the window */
    uint32_t walls;            /* vertices at the same place and not of the same height */
    uint32_t open_edges;       /* without an opposite, away from the border */
    uint32_t repeated_edges;   /* directed edges that a second triangle uses too */
    int64_t double_area;       /* twice the signed area of all triangles, in codes */
    bool is_exact;             /* none of the above, once around the border, and the area is the window's */
};

/* `right` and `top` are the codes of the window's eastern and northern border. */
enum scree_status cover_check(struct scree_memory *memory, const struct decoded_tile *tile, uint16_t right,
                              uint16_t top, struct cover_result *result, struct scree_error *error);

#endif
