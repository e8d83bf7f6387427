#include "src/ladder.h"

#include <math.h>

#define STEPS_IN_TOLERANCE 16 /* heights are written so much finer than the tolerance */
#define STEEPEST_TILE      4  /* relief of a tile in widths of it that height codes always have room for */
#define HEIGHT_CODES       32767
#define LARGEST_UNITS      1e9

static double power_of_two_below(double value) {
    return exp2(floor(log2(value)));
}
static double power_of_two_above(double value) {
    return exp2(ceil(log2(value)));
}

static enum scree_status set_tolerances(const struct lattice *lattice, const struct ladder_options *options,
                                        struct ladder *ladder, struct scree_error *error) {
    double root_m = options->root_error_m;
    if (root_m <= 0 && lattice->profile == PROFILE_GEODETIC) root_m = CESIUM_LEVEL_ERROR_M * DEFAULT_TOLERANCE_SHARE;
    if (root_m <= 0) { /* the same share of a post's spacing as on the globe */
        double east_m, north_m;
        lattice_steps_m(lattice, 0, &east_m, &north_m);
        root_m = DEFAULT_TOLERANCE_SHARE * fmax(east_m, north_m) * exp2(lattice->finest_zoom);
    }
    for (int zoom = 0; zoom <= lattice->finest_zoom; zoom++) {
        ladder->tolerance_m[zoom] = options->error_at_m[zoom] > 0 ? options->error_at_m[zoom] : ldexp(root_m, -zoom);
        if (zoom > 0 && ladder->tolerance_m[zoom] > ladder->tolerance_m[zoom - 1])
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "the tolerance of zoom %d (%g m) is larger than that of zoom %d (%g m): give --error-at "
                              "values that do not grow with the zoom",
                              zoom, ladder->tolerance_m[zoom], zoom - 1, ladder->tolerance_m[zoom - 1]);
    }
    return SCREE_OK;
}

/* Fine against the tolerance, coarse enough for the relief that a tile of the zoom may have. */
static double border_step_m(const struct lattice *lattice, const struct ladder_options *options, double tolerance_m,
                            int zoom) {
    double east_m, north_m;
    lattice_steps_m(lattice, (double)(lattice->rows - 1) / 2, &east_m, &north_m);
    double width_m = (double)lattice_tile_span(lattice, zoom) * fmax(east_m, north_m);
    double relief_m = fmax(fmin(options->relief_m, STEEPEST_TILE * width_m), tolerance_m / HEIGHT_CODES);
    return fmax(power_of_two_below(tolerance_m / STEPS_IN_TOLERANCE), power_of_two_above(relief_m / HEIGHT_CODES));
}

enum scree_status ladder_make(const struct lattice *lattice, const struct ladder_options *options,
                              struct ladder *ladder, struct scree_error *error) {
    *ladder = (struct ladder){0};
    enum scree_status status = set_tolerances(lattice, options, ladder, error);
    if (status != SCREE_OK) return status;
    int finest = lattice->finest_zoom;
    ladder->height_unit_m = border_step_m(lattice, options, ladder->tolerance_m[finest], finest);
    if (ladder->tolerance_m[finest] < ladder->height_unit_m)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "a tolerance of %g m at zoom %d is finer than the steps of %g m in which a relief of %g m is "
                          "written; ask for --error-at %d=%g or more",
                          ladder->tolerance_m[finest], finest, ladder->height_unit_m, options->relief_m, finest,
                          ladder->height_unit_m);
    while (options->largest_height_m / ladder->height_unit_m > LARGEST_UNITS) ladder->height_unit_m *= 2;
    for (int zoom = finest; zoom >= 0; zoom--) {
        double steps = border_step_m(lattice, options, ladder->tolerance_m[zoom], zoom) / ladder->height_unit_m;
        int32_t finer = zoom < finest ? ladder->border_step[zoom + 1] : 1;
        ladder->border_step[zoom] = steps > finer ? (int32_t)fmin(steps, 1 << 30) : finer;
    }
    return SCREE_OK;
}
