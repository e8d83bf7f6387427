/* A tile of posts as a method of the literature sees it: whole cells, and metres. Pure.
 *
 * Where the lattice ends within a cell, posts are interpolated from the first to the last one at equal distances, and
 * the border lines are stretched to match. */
#ifndef SCREE_METHOD_VIEW_H
#define SCREE_METHOD_VIEW_H

#include "lod/method_codes.h"
#include "lod/post_tile.h"
#include "src/tile_place.h"

struct method_view {
    struct method_tile tile;
    struct method_frame frame;
    float *stretched_m;         /* posts; NULL: they are the tile's own */
    struct border_line *border; /* SIDE_COUNT lines; NULL: they are the tile's own */
};

/* Points into `tile`, which must outlive it. To be released in any case. */
enum scree_status method_view_make(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                   struct method_view *view, struct scree_error *error);

/* Fine on a zeroed one, and twice. */
void method_view_release(struct scree_memory *memory, struct method_view *view);

#endif
