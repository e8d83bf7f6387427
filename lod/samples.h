/* The heights that a mesh is measured against, and the measuring. Pure.
 *
 * A tile of the finest zoom is measured against every post. A coarser tile keeps, for each of its cells, the lowest and
 * the highest finest post inside it, at its true position, so that summits and valley floors are never sampled away
 * while memory stays that of one tile.
 *
 * Heights here are *drawn heights*: metres above a reference of the tile, less the drop of the ellipsoid below the
 * tile's tangent plane; on them, linear interpolation over a triangle is the flat triangle that a globe draws. */
#ifndef SCREE_LOD_SAMPLES_H
#define SCREE_LOD_SAMPLES_H

#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

/* A point of the lattice plane with its drawn height. */
struct sample {
    int32_t x, y; /* lattice steps from the tile's south-western corner */
    float drawn_m;
};

struct samples {
    int32_t columns, rows; /* cells */
    int32_t cell_span;     /* lattice steps a cell */
    const float *posts;    /* cells of 1 step: (rows + 1) rows of `stride` drawn heights; NULL: there are extremes */
    int32_t stride;
    const struct sample *extremes; /* 2 a cell, lowest then highest, row by row; NULL: there are posts */
    float rounding_steps; /* how far the drawn position of a vertex may be off its lattice position, in x and in y */
};

struct triangle_error {
    float max_m;          /* largest vertical distance of a sample in the closed triangle, with the position rounding */
    float sum_squares_m2; /* of those distances */
};

/* Measures the counter-clockwise triangle (a, b, c) of positive area. */
struct triangle_error samples_triangle_error(const struct samples *samples, const struct sample *a,
                                             const struct sample *b, const struct sample *c);

/* Twice the signed area of (a, b, c) in lattice steps: exact, positive when counter-clockwise. */
static inline int64_t sample_area2(const struct sample *a, const struct sample *b, const struct sample *c) {
    return (int64_t)(b->x - a->x) * (c->y - a->y) - (int64_t)(c->x - a->x) * (b->y - a->y);
}

#endif
