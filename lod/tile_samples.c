#include "lod/tile_samples.h"

#include "lod/tile_parts.h"

bool tile_samples_are_whole(const struct coarse_tile *const children[4]) {
    for (int i = 0; i < 4; i++)
        if (children[i] != NULL && children[i]->cell_first != NULL) return true;
    return false;
}

struct range {
    uint32_t first, end;
};

/* The samples of a child's cell: a pair may be one twice. */
static struct range samples_of(const struct coarse_tile *child, int32_t cell) {
    if (child->cell_first != NULL) return (struct range){child->cell_first[cell], child->cell_first[cell + 1]};
    const struct sample *low = &child->extremes[2 * (int64_t)cell], *high = low + 1;
    bool is_one = low->x == high->x && low->y == high->y;
    return (struct range){2 * (uint32_t)cell, 2 * (uint32_t)cell + (is_one ? 1 : 2)};
}

/* Adds up the samples of each cell, and once there is room for them puts them in. */
static void visit_child(struct tile *tile, const struct coarse_tile *child, int32_t x, int32_t y, bool puts) {
    int32_t span = tile->samples.cell_span;
    for (int32_t row = 0; row < child->cell_rows; row++)
        for (int32_t column = 0; column < child->cell_columns; column++) {
            int64_t own = (int64_t)(y / span + row) * tile->samples.columns + x / span + column;
            struct range range = samples_of(child, row * child->cell_columns + column);
            for (uint32_t i = range.first; i < range.end && puts; i++) {
                struct sample *sample = &tile->extremes[tile->cell_first[own] + i - range.first];
                *sample = child->extremes[i];
                sample->x += x;
                sample->y += y;
            }
            tile->cell_first[own] += range.end - range.first;
        }
}

static void visit_children(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                           bool puts) {
    for (int i = 0; i < 4; i++)
        if (children[i] != NULL) visit_child(tile, children[i], i % 2 * child_span, i / 2 * child_span, puts);
}

enum scree_status tile_samples_join(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error) {
    tile->samples = tile_own_samples(tile);
    size_t cells = (size_t)tile->samples.columns * (size_t)tile->samples.rows;
    tile->cell_first = scree_allocate(tile->memory, cells + 1, sizeof *tile->cell_first, "a tile's samples", error);
    if (tile->cell_first == NULL) return SCREE_E_MEMORY;
    visit_children(tile, children, child_span, false);
    uint32_t begin = 0;
    for (size_t cell = 0; cell < cells; cell++) {
        uint32_t count = tile->cell_first[cell];
        tile->cell_first[cell] = begin;
        begin += count;
    }
    tile->extremes = scree_allocate(tile->memory, begin, sizeof *tile->extremes, "a tile's samples", error);
    if (tile->extremes == NULL) return SCREE_E_MEMORY;
    visit_children(tile, children, child_span, true);
    for (size_t cell = cells; cell > 0; cell--) tile->cell_first[cell] = tile->cell_first[cell - 1];
    tile->cell_first[0] = 0;
    tile->samples.extremes = tile->extremes;
    tile->samples.cell_first = tile->cell_first;
    return SCREE_OK;
}

/* The lowest and the highest of the tile's samples in each of the parent's cells, which are 2 x 2 of its own. */
void tile_samples_leave_pairs(struct tile *tile) {
    struct coarse_tile *rest = tile->rest;
    for (int32_t cell = 0; cell < rest->cell_columns * rest->cell_rows; cell++) {
        struct sample *pair = &rest->extremes[2 * (int64_t)cell];
        int32_t column = cell % rest->cell_columns * 2, row = cell / rest->cell_columns * 2;
        bool is_first = true;
        for (int32_t y = row; y < row + 2 && y < tile->samples.rows; y++)
            for (int32_t x = column; x < column + 2 && x < tile->samples.columns; x++) {
                int64_t own = (int64_t)y * tile->samples.columns + x;
                for (uint32_t i = tile->cell_first[own]; i < tile->cell_first[own + 1]; i++, is_first = false) {
                    if (is_first || tile->extremes[i].height_m < pair[0].height_m) pair[0] = tile->extremes[i];
                    if (is_first || tile->extremes[i].height_m > pair[1].height_m) pair[1] = tile->extremes[i];
                }
            }
    }
}

void tile_samples_hand_up(struct tile *tile) {
    tile->rest->extremes = tile->extremes;
    tile->rest->cell_first = tile->cell_first;
    tile->extremes = NULL;
    tile->cell_first = NULL;
}
