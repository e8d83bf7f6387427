/* Heights of new vertices: how far they are off the plane of the triangle that they lie in. Pure. */
#ifndef SCREE_STREAM_HEIGHTS_H
#define SCREE_STREAM_HEIGHTS_H

#include "stream/range_coder.h"
#include "stream/surface.h"

#define HEIGHT_BITS 31

/* Residuals as a length in bits and the bits themselves, inside and on the border; their sign by how many of the
 * neighbouring triangles' far corners lie above the plane, since hills go on as hills. */
struct height_models {
    struct bit_model length[2][HEIGHT_BITS + 1];
    struct bit_model mantissa[2][HEIGHT_BITS + 1][3];
    struct bit_model sign[4];
};
void height_models_start(struct height_models *models);

/* Residuals shrink from rung to rung: what was learned of them is soon overruled. */
void height_models_hurry(struct height_models *models);

/* Codes the height of a place in the triangle, a multiple of `step`; what it is counts only when writing. False when
 * bytes name one beyond +-2^30. */
bool height_code(struct range_coder *coder, struct height_models *models, const struct surface *surface,
                 uint32_t triangle, bool on_border, int32_t step, struct scree_vertex *at);

#endif
