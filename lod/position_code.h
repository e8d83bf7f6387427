/* Positions as quantized-mesh writes them: codes 0..32767 over the side of a tile. Pure. */
#ifndef SCREE_LOD_POSITION_CODE_H
#define SCREE_LOD_POSITION_CODE_H

#include "lod/samples.h"
#include <stdbool.h>
#include <stdint.h>

#define POSITION_TOP 32767 /* the largest code */

/* How the positions of a mesh will be written: over `span` lattice steps, counted from (-x, -y). */
struct code_frame {
    int64_t span; /* 0: codes are not looked at */
    int32_t x, y; /* the mesh's origin in the frame */
};

/* A position in a frame of `span` steps as a code, rounded to nearest, halves up. */
static inline int32_t position_code(int64_t position, int64_t span) {
    return (int32_t)((2 * position * POSITION_TOP + span) / (2 * span));
}

/* Whether (a, b, c) is counter-clockwise with a positive area, also in position codes (span 0: they are not looked
 * at): rounding to codes turns thin triangles over, even where codes are finer than the lattice. */
bool codes_positive(const struct code_frame *codes, const struct sample *a, const struct sample *b,
                    const struct sample *c);

#endif
