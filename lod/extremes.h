/* The lowest and the highest finest post of every cell, at their true positions: what a coarser tile is measured
 * against. Pure.
 *
 * Cells are closed: posts on their borders count for both sides. Two samples a cell, lowest first. */
#ifndef SCREE_LOD_EXTREMES_H
#define SCREE_LOD_EXTREMES_H

#include "lod/samples.h"

/* Cells of a length. */
static inline int32_t extremes_cells(int32_t length, int32_t cell_span) {
    return (length + cell_span - 1) / cell_span;
}

/* Of cells of 2 x 2 steps over posts of one step. */
void extremes_from_posts(const float *heights_m, int32_t stride, int32_t columns, int32_t rows,
                         struct sample *extremes);

/* Of cells twice as long as those of `fine`, which has `fine_columns` x `fine_rows` of them. */
void extremes_reduce(const struct sample *fine, int32_t fine_columns, int32_t fine_rows, struct sample *extremes);

/* Copies a child's cells into its parent's array of `columns` cells a row, from cell (column, row) on; positions move
 * by (x, y) steps. */
void extremes_place(const struct sample *child, int32_t child_columns, int32_t child_rows, int32_t column, int32_t row,
                    int32_t x, int32_t y, struct sample *extremes, int32_t columns);

#endif
