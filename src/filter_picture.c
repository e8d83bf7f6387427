/* The picture of differences: see the header. */
#include "src/filter_picture.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define GREY     200
#define DARKNESS 135 /* what the darkest red and blue lose */

/* The largest difference of a square of posts, which the raster may cut; false: all of it is outside. */
static bool largest(const struct filter_difference *d, int32_t west, int32_t south, int32_t side, double *away_m) {
    bool is_inside = false;
    *away_m = 0;
    for (int32_t y = south; y < south + side && y < d->rows; y++)
        for (int32_t x = west; x < west + side && x < d->columns; x++) {
            const size_t post = (size_t)y * (size_t)d->columns + (size_t)x;
            if (d->is_outside != NULL && d->is_outside[post]) continue;
            const double here_m = (double)d->before_m[post] - d->after_m[post];
            is_inside = true;
            if (fabs(here_m) > fabs(*away_m)) *away_m = here_m;
        }
    return is_inside;
}

/* White at 0; a root, so that what is small can be seen. */
static void paint(const struct filter_difference *d, double away_m, uint8_t *rgb) {
    const double share = sqrt(fmin(fabs(away_m) / d->darkest_m, 1));
    const uint8_t pale = (uint8_t)lround(255 * (1 - share)), strong = (uint8_t)lround(255 - DARKNESS * share * share);
    rgb[0] = away_m >= 0 ? strong : pale;
    rgb[1] = pale;
    rgb[2] = away_m >= 0 ? pale : strong;
    if (away_m == 0) memset(rgb, 255, 3);
}

enum scree_status filter_picture_new(struct scree_memory *memory, const struct filter_difference *difference,
                                     struct filter_picture *picture, struct scree_error *error) {
    const int32_t columns = difference->columns, rows = difference->rows, most = columns > rows ? columns : rows;
    const int32_t side = (most - 1) / FILTER_PICTURE_PX + 1;
    picture->width_px = (uint32_t)((columns - 1) / side + 1);
    picture->height_px = (uint32_t)((rows - 1) / side + 1);
    picture->rgb = scree_allocate(memory, (size_t)picture->width_px * picture->height_px, 3, "the picture", error);
    if (picture->rgb == NULL) return SCREE_E_MEMORY;
    for (uint32_t y = 0; y < picture->height_px; y++)
        for (uint32_t x = 0; x < picture->width_px; x++) {
            uint8_t *rgb = picture->rgb + 3 * ((size_t)(picture->height_px - 1 - y) * picture->width_px + x);
            double away_m;
            if (largest(difference, (int32_t)x * side, (int32_t)y * side, side, &away_m))
                paint(difference, away_m, rgb);
            else
                memset(rgb, GREY, 3);
        }
    return SCREE_OK;
}
