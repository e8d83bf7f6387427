/* The four border lines of a tile on their way from fine to coarse: the same for every tile, whoever makes its mesh, so
 * that neighbours agree. Pure. */
#ifndef SCREE_LOD_TILE_LINES_H
#define SCREE_LOD_TILE_LINES_H

#include "lod/border.h"
#include "lod/position_code.h"
#include <scree/error.h>

/* A line of posts, `step` lattice steps apart over `length` steps; heights, `stride` floats apart, are measured against
 * as they are and kept rounded to whole units. */
void tile_line_start(struct border_line *line, int32_t length, int32_t step, double curvature_m, double height_unit_m,
                     const float *heights_m, int32_t stride);

/* The lines of a parent from those of its children, in the order south-west, south-east, north-west, north-east; NULL
 * outside of the lattice. Children are `child_span` steps wide, the parent's cells `cell_span`; `keeps_samples`: see
 * border_join. SCREE_E_LIMIT when a line has too many vertices. */
enum scree_status tile_lines_join(const struct border_line *const children[4], int32_t child_span, int32_t cell_span,
                                  bool keeps_samples, const double side_drop_m[SIDE_COUNT],
                                  struct border_line lines[SIDE_COUNT], struct scree_error *error);

/* Takes all four to the tolerance of a rung. `codes`: NULL when the rung is not written. */
void tile_lines_reduce(struct border_line lines[SIDE_COUNT], double tolerance_m, int64_t locked_step,
                       const struct code_frame *codes);

#endif
