/* Rungs to come, looked at ahead: what their border lines will make of a mesh. Pure.
 *
 * Border lines drop vertices whatever lies beside them, and by then the interior vertices that would have helped may be
 * gone. So while a mesh is taken from rung to rung, every triangle that is made is measured as it is, and once more for
 * each rung to come, as it will be when the border vertices which that rung drops have moved along the border to one
 * that it keeps. All rungs to come stay within reach then: collapsing each dropped vertex to where it has moved gives
 * triangles that have been measured.
 *
 * The full grid is a mesh to begin with: a triangle that holds no posts but those of the border line, moved or not, is
 * as exact as that line. */
#ifndef SCREE_LOD_AHEAD_H
#define SCREE_LOD_AHEAD_H

#include "lod/border.h"
#include "lod/position_code.h"

struct ahead_rung {
    float tolerance_m;
    struct code_frame codes;              /* of a rung that is written; else span 0 */
    struct samples samples;               /* with its position rounding */
    struct border_line lines[SIDE_COUNT]; /* what it keeps; samples of the lines are not used */
};

struct ahead {
    int32_t columns, rows; /* lattice steps of the tile */
    int next, count;       /* rungs[next] ... rungs[count - 1] are to come */
    struct ahead_rung *rungs;
};

/* Whether a triangle, whose error as it is is `error_m`, leaves all rungs to come within reach: at each of them it is
 * gone, or positive, in its codes too, and within the tolerance. True without rungs to come, NULL. */
bool ahead_admits(const struct ahead *ahead, const struct sample *a, const struct sample *b, const struct sample *c,
                  float error_m);

#endif
