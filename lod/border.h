/* Borders: the one-dimensional rule by which both tiles of an edge keep the same vertices. Pure.
 *
 * A line of posts is simplified on its own: always the vertex whose removal costs the least leaves, as long as the
 * cost stays within the tolerance given. The rule looks at nothing but the line, so neighbours agree without knowing
 * of each other, in any order of processing; sets are nested from rung to rung because each starts from the last.
 *
 * Cost is the largest vertical distance between a sample of the line and the chord that would replace two pieces, with
 * the sagitta of the ellipsoid under that chord. Equal costs are told apart by the vertex's place in the lattice
 * (fewest trailing zero bits first, then the lower one), so level lines keep a dyadic set whatever zoom they start at.
 */
#ifndef SCREE_LOD_BORDER_H
#define SCREE_LOD_BORDER_H

#include "lod/samples.h"
#include <stdbool.h>
#include <stdint.h>

#define BORDER_MAX_VERTICES 4097
#define BORDER_MAX_SAMPLES  520

/* What part of a rung's tolerance the lines use up; the rest is for the triangles that end on them. Measured: 0.7
 * costs no more than a few percent of triangles against free borders. */
#define BORDER_SHARE 0.7

enum tile_side { SIDE_SOUTH, SIDE_EAST, SIDE_NORTH, SIDE_WEST, SIDE_COUNT };

/* The side of a window of `columns` x `rows` steps on which a point that is no corner lies, and its position from the
 * side's south or west end; SIDE_COUNT inside and at corners. */
enum tile_side border_side(int32_t columns, int32_t rows, const struct sample *at, int32_t *position);

struct border_sample {
    int32_t position; /* lattice steps from the start of the line */
    float height_m;
};

struct border_line {
    int32_t vertex_count, sample_count;
    double curvature_m; /* sagitta = curvature_m * (t - a) * (c - t) of a chord from a to c; metres a square step */
    struct border_sample vertices[BORDER_MAX_VERTICES]; /* kept, by position; heights as the mesh has them */
    struct border_sample samples[BORDER_MAX_SAMPLES];   /* measured against, by position */
};

/* Removes vertices, ends excepted, while the cheapest costs at most `tolerance_m`; never one at a multiple of
 * `locked_step` (0: none is locked). */
void border_reduce(struct border_line *line, double tolerance_m, int64_t locked_step);

/* Removes the second of two vertices whose position codes (0..32767 over `code_span` steps, counted from `offset` steps
 * before the line) coincide, never an end. */
void border_separate_codes(struct border_line *line, int64_t code_span, int32_t offset);

/* The last kept vertex at or before a position. */
int32_t border_before(const struct border_line *line, int32_t position);

/* Whether a vertex at this position is kept. */
bool border_keeps(const struct border_line *line, int32_t position);

/* Puts `second` behind `first`, whose last vertex is the first of `second`; samples keep the lowest and the highest
 * height of every cell of `cell_span` steps (closed cells), or with `keeps_samples` all, if there is room for them.
 * `first` ends at `joint` steps; `second` may be NULL. False when there are more than BORDER_MAX_VERTICES vertices. */
bool border_join(const struct border_line *first, const struct border_line *second, int32_t joint, int32_t cell_span,
                 bool keeps_samples, struct border_line *line);

#endif
