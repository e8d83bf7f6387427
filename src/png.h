/* Pictures as PNG files. Pure. */
#ifndef SCREE_PNG_H
#define SCREE_PNG_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stddef.h>
#include <stdint.h>

#define PNG_MOST_PX 16384 /* a side */

/* The file of a picture: `rgb` has height_px rows, from the top, of 3 * width_px bytes. `*bytes` belongs to `memory`.
 * SCREE_E_ARGUMENT: a side is 0 or beyond PNG_MOST_PX. */
enum scree_status png_encode_new(struct scree_memory *memory, const uint8_t *rgb, uint32_t width_px, uint32_t height_px,
                                 unsigned char **bytes, size_t *size_bytes, struct scree_error *error);

#endif
