/* Neighbours in a cut of the quadtree (include/scree/cut.h): a walk along the cells of the deepest zoom just outside of
 * a side, from tile to tile, each found by bisection along the Z curve. */
#include "stream/cut.h"

#include <stdbool.h>

int scree_tile_compare(const struct scree_tile_id *a, const struct scree_tile_id *b) {
    uint64_t first = cut_first_cell(a), other = cut_first_cell(b);
    if (first != other) return first < other ? -1 : 1;
    return (a->zoom > b->zoom) - (a->zoom < b->zoom);
}

/* How many tiles begin at or before a cell. */
static uint32_t tiles_up_to(const struct scree_tile_id *cut, uint32_t count, uint64_t cell) {
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (cut_first_cell(&cut[middle]) <= cell)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* log2 of the side of the largest square of the quadtree around a cell that does not hold `other`. */
static int levels_apart(uint64_t cell, uint64_t other) {
    uint64_t differing = cell ^ other;
    int levels = 0;
    while (levels < SCREE_MAX_ZOOM && differing >> 2 * (levels + 1) != 0) levels++;
    return levels;
}

/* The line of cells along the outside of a side: those from `first` to before `end` of row or column `across`. */
struct outside {
    bool exists, upright; /* cells differ in y */
    int64_t across, first, end;
};

static struct outside outside_of(enum scree_profile profile, const struct scree_tile_id *tile, enum scree_side side) {
    int64_t span = (int64_t)1 << (SCREE_MAX_ZOOM - tile->zoom), rows = (int64_t)1 << SCREE_MAX_ZOOM;
    int64_t columns = profile == SCREE_GEODETIC ? 2 * rows : rows;
    struct outside line = {.exists = true, .upright = side == SCREE_EAST || side == SCREE_WEST};
    int64_t from = line.upright ? tile->x * span : tile->y * span;
    int64_t limit = line.upright ? columns : rows;
    line.first = line.upright ? tile->y * span : tile->x * span;
    line.end = line.first + span;
    line.across = side == SCREE_EAST || side == SCREE_NORTH ? from + span : from - 1;
    if (line.across < 0 || line.across >= limit) {
        line.exists = line.upright && profile == SCREE_GEODETIC;
        line.across = line.across < 0 ? limit - 1 : 0;
    }
    return line;
}

uint32_t scree_cut_neighbours(const struct scree_tile_id *cut, uint32_t count, enum scree_profile profile,
                              const struct scree_tile_id *tile, enum scree_side side, uint32_t *neighbours,
                              uint32_t capacity) {
    struct outside line = outside_of(profile, tile, side);
    uint32_t found = 0;
    if (!line.exists) return 0;
    for (int64_t along = line.first; along < line.end;) {
        uint32_t x = (uint32_t)(line.upright ? line.across : along), y = (uint32_t)(line.upright ? along : line.across);
        uint64_t cell = cut_interleave(x, y);
        uint32_t next = tiles_up_to(cut, count, cell);
        int levels; /* of the square around the cell that is dealt with now */
        if (next > 0 && cut_last_cell(&cut[next - 1]) >= cell) {
            if (found < capacity) neighbours[found] = next - 1;
            found++;
            levels = SCREE_MAX_ZOOM - cut[next - 1].zoom;
        } else { /* a hole: on to the end of the largest square without tiles */
            levels = SCREE_MAX_ZOOM;
            if (next > 0) levels = levels_apart(cell, cut_last_cell(&cut[next - 1]));
            int after = next < count ? levels_apart(cell, cut_first_cell(&cut[next])) : SCREE_MAX_ZOOM;
            if (after < levels) levels = after;
        }
        along = ((along >> levels) + 1) << levels;
    }
    return found;
}
