/* The heights that a mesh is measured against, and the measuring. Pure.
 *
 * A tile of the finest zoom is measured against every post, or against every point of its TIN. A coarser tile keeps,
 * for each of its cells, the lowest and the highest finest post inside it, at its true position, so that summits and
 * valley floors are never sampled away while memory stays that of one tile.
 *
 * What is measured is what a globe draws: a triangle between three points of the ellipsoid is flat and lies below the
 * curved surface between them. So heights are compared less the drop of the ellipsoid below the tangent plane at the
 * triangle, about (east^2 + north^2) / 2R. */
#ifndef SCREE_LOD_SAMPLES_H
#define SCREE_LOD_SAMPLES_H

#include <scree/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A point of the lattice plane with a height. */
struct sample {
    int32_t x, y; /* lattice steps from the tile's south-western corner */
    float height_m;
};

struct samples {
    int32_t columns, rows; /* cells */
    int32_t cell_span;     /* lattice steps a cell */
    const float *posts;    /* cells of 1 step: (rows + 1) rows of `stride` heights; NULL: there are extremes */
    int32_t stride;
    const struct sample *extremes; /* 2 a cell, lowest then highest, row by row; NULL: there are posts */
    const uint32_t *cell_first; /* of each cell and one more, row by row: where its samples begin in `extremes`, which
                                   then has any number of them a cell, each in one cell that it lies in or on; NULL:
                                   there are two a cell */
    const float *east_drop_m;   /* ellipsoid's drop at one step to the east, at the rows + 1 borders of rows of cells;
                                   NULL: the Earth is flat */
    float north_drop_m;         /* the same to the north */
    float rounding_steps;   /* how far the drawn position of a vertex may be off its lattice position, in x and in y */
    float rounding_limit_m; /* the most that this may add to an error: on a cliff the format itself moves heights by
                               metres, and keeping every post of it would not help */
};

struct triangle_error {
    float max_m;          /* largest vertical distance of a sample in the closed triangle, with the position rounding */
    float sum_squares_m2; /* of those distances */
};

/* How far the ellipsoid drops below the tangent plane at row `y`, over dx^2 and over dy^2. */
struct drop {
    double east_m, north_m;
};
static inline struct drop samples_drop(const struct samples *samples, double y) {
    if (samples->east_drop_m == NULL) return (struct drop){0, 0};
    double row = samples->cell_span == 1 ? y : y / samples->cell_span;
    int32_t below = row < samples->rows ? (int32_t)row : samples->rows - 1;
    const float *drop_m = samples->east_drop_m + below;
    return (struct drop){drop_m[0] + (row - below) * (drop_m[1] - drop_m[0]), samples->north_drop_m};
}

/* The height of a point less the drop, both as seen from `origin`. */
static inline double sample_drawn_m(const struct sample *at, const struct sample *origin, struct drop drop) {
    double dx = at->x - origin->x, dy = at->y - origin->y;
    return (double)at->height_m - origin->height_m - drop.east_m * dx * dx - drop.north_m * dy * dy;
}

/* Measures the counter-clockwise triangle (a, b, c) of positive area; in doubles, so that a distance that is exactly
 * the tolerance, as whole metres often are, passes. */
struct triangle_error samples_triangle_error(const struct samples *samples, const struct sample *a,
                                             const struct sample *b, const struct sample *c);

/* Twice the signed area of (a, b, c) in lattice steps: exact, positive when counter-clockwise. */
static inline int64_t sample_area2(const struct sample *a, const struct sample *b, const struct sample *c) {
    return (int64_t)(b->x - a->x) * (c->y - a->y) - (int64_t)(c->x - a->x) * (b->y - a->y);
}

#endif
