/* What a filter has changed, as a picture. Pure.
 *
 * After Figure 3 of S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi
 * scale analysis" (GRAPP 2015): red where the unfiltered heights are above the filtered ones, blue where below, the
 * darker the farther. */
#ifndef SCREE_FILTER_PICTURE_H
#define SCREE_FILTER_PICTURE_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define FILTER_PICTURE_PX 4096 /* a side at most */

struct filter_difference {
    const float *before_m, *after_m; /* row by row from the south */
    const uint8_t *is_outside;       /* posts that are left grey; NULL: none */
    int32_t columns, rows;
    double darkest_m; /* above 0: larger differences are no darker */
};

struct filter_picture {
    uint8_t *rgb; /* rows from the north */
    uint32_t width_px, height_px;
};

/* One post a pixel; of larger rasters each pixel shows the largest difference of its square of posts. `picture->rgb`
 * belongs to `memory`; NULL on failure. */
enum scree_status filter_picture_new(struct scree_memory *memory, const struct filter_difference *difference,
                                     struct filter_picture *picture, struct scree_error *error);

#endif
