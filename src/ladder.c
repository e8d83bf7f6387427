#include "src/ladder.h"

#include <math.h>
#include <stddef.h>

#define STEPS_IN_TOLERANCE 16 /* heights are written so much finer than the tolerance */
#define STEEPEST_TILE      4  /* relief of a tile in widths of it that height codes always have room for */
#define HEIGHT_CODES       32767
#define STEPS_IN_FINEST    4 /* the same for the finest rung; 8 costs 5 % more bytes of streams and saves no vertices */
#define LARGEST_UNITS      0x1p24 /* heights are floats while tiles are simplified: all of them are exact */
#define UNTOLD_OCTAVES     5      /* of a TIN whose heights are multiples of nothing */
#define LOSSLESS_UNIT_M    1.0    /* so that sources in whole metres are kept to the last bit */

static double power_of_two_below(double value) {
    return exp2(floor(log2(value)));
}
static double power_of_two_above(double value) {
    return exp2(ceil(log2(value)));
}

/* The least step in which the relief that a tile of the zoom may have can be written. */
static double relief_step_m(const struct lattice *lattice, const struct ladder_options *options, double tolerance_m,
                            int zoom) {
    double east_m, north_m;
    lattice_steps_m(lattice, (double)(lattice->rows - 1) / 2, &east_m, &north_m);
    double width_m = (double)lattice_tile_span(lattice, zoom) * fmax(east_m, north_m);
    double relief_m = fmax(fmin(options->relief_m, STEEPEST_TILE * width_m), options->wall_m);
    relief_m = fmax(relief_m, tolerance_m / HEIGHT_CODES);
    return power_of_two_above(relief_m / HEIGHT_CODES);
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
    for (int zoom = 0; zoom <= ladder->finest_zoom; zoom++) {
        double tolerance_m = ldexp(root_m, -zoom);
        if (options->root_error_m <= 0) tolerance_m = fmax(tolerance_m, relief_step_m(lattice, options, 0, zoom));
        ladder->tolerance_m[zoom] = options->error_at_m[zoom] > 0 ? options->error_at_m[zoom] : tolerance_m;
        if (zoom > 0 && ladder->tolerance_m[zoom] > ladder->tolerance_m[zoom - 1])
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "the tolerance of zoom %d (%g m) is larger than that of zoom %d (%g m): give --error-at "
                              "values that do not grow with the zoom",
                              zoom, ladder->tolerance_m[zoom], zoom - 1, ladder->tolerance_m[zoom - 1]);
    }
    return SCREE_OK;
}

/* Fine against the tolerance, coarse enough for the relief. */
static double border_step_m(const struct lattice *lattice, const struct ladder_options *options, double tolerance_m,
                            int zoom) {
    return fmax(power_of_two_below(tolerance_m / STEPS_IN_TOLERANCE),
                relief_step_m(lattice, options, tolerance_m, zoom));
}

/* What the mesh of a static tile of the finest zoom may be off, so that the tile as written keeps to its tolerance. */
static double static_bound_m(const struct ladder *ladder) {
    int finest = ladder->finest_zoom;
    bool is_rounded = ladder->border_step[finest] > 1;
    return ladder->tolerance_m[finest] - (is_rounded ? 0.5 * ladder->border_step[finest] * ladder->height_unit_m : 0);
}

double ladder_rung_tolerance_m(const struct ladder *ladder, int rung) {
    int finest = ladder->finest_zoom;
    if (ladder->lossless && rung == ladder->finest_rung) rung--;
    int zoom = rung >= 0 ? rung / RUNGS_A_ZOOM : -((RUNGS_A_ZOOM - 1 - rung) / RUNGS_A_ZOOM);
    int beyond = rung - RUNGS_A_ZOOM * zoom; /* rungs finer than that zoom: 0 to 3 */
    double tolerance_m, ratio = 0.5;
    if (zoom >= finest)
        tolerance_m = ldexp(ladder->tolerance_m[finest], finest - zoom);
    else if (zoom < 0)
        tolerance_m = ldexp(ladder->tolerance_m[0], -zoom);
    else {
        tolerance_m = ladder->tolerance_m[zoom];
        ratio = ladder->tolerance_m[zoom + 1] / tolerance_m;
    }
    double half = sqrt(ratio), quarter = sqrt(half); /* the same on every machine, unlike pow() */
    const double shares[RUNGS_A_ZOOM] = {1, quarter, half, half * quarter};
    return fmin(tolerance_m * shares[beyond], zoom >= finest ? static_bound_m(ladder) : INFINITY);
}

/* Meshes count heights as finely as the finest rung wants it, which static tiles may be unable to follow. */
static double height_unit_m(const struct ladder *ladder, const struct ladder_options *options, double static_step_m) {
    double finest_m = ladder_rung_tolerance_m(ladder, ladder->finest_rung);
    double unit_m = fmin(static_step_m, power_of_two_below(finest_m / STEPS_IN_FINEST));
    if (options->lossless) unit_m = fmin(unit_m, LOSSLESS_UNIT_M);
    if (options->quantum_m > 0) unit_m = fmin(static_step_m, power_of_two_below(options->quantum_m / 2));
    while (options->largest_height_m / unit_m > LARGEST_UNITS) unit_m *= 2;
    return unit_m;
}

static enum scree_status check_steps(const struct ladder *ladder, const struct ladder_options *options,
                                     double static_step_m, struct scree_error *error) {
    int finest = ladder->finest_zoom;
    if (ladder->tolerance_m[finest] < static_step_m)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "a tolerance of %g m at zoom %d is finer than the steps of %g m in which a relief of %g m is "
                          "written; ask for --error-at %d=%g or more",
                          ladder->tolerance_m[finest], finest, static_step_m, options->relief_m, finest, static_step_m);
    double finest_m = ladder_rung_tolerance_m(ladder, ladder->finest_rung);
    if (finest_m < ladder->height_unit_m)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "the tolerance of the finest rung, %g m, is finer than the steps of %g m in which heights of "
                          "%g m are counted; ask for larger tolerances or fewer --finest-octaves",
                          finest_m, ladder->height_unit_m, options->largest_height_m);
    return SCREE_OK;
}

int ladder_octaves_of_tin(const struct lattice *lattice, const struct ladder_options *options) {
    struct ladder ladder;
    struct ladder_options coarse = *options;
    coarse.finest_octaves = 0;
    if (options->quantum_m <= 0 || ladder_make(lattice, &coarse, &ladder, NULL) != SCREE_OK) return UNTOLD_OCTAVES;
    double finest_m = power_of_two_below(options->quantum_m / 2);
    double octaves = floor(log2(ladder.tolerance_m[ladder.finest_zoom] / finest_m));
    return (int)fmin(fmax(octaves, 0), MAX_FINEST_OCTAVES);
}

enum scree_status ladder_make(const struct lattice *lattice, const struct ladder_options *options,
                              struct ladder *ladder, struct scree_error *error) {
    int finest = lattice->finest_zoom - options->zooms_above;
    *ladder = (struct ladder){.finest_zoom = finest};
    enum scree_status status = set_tolerances(lattice, options, ladder, error);
    if (status != SCREE_OK) return status;
    ladder->finest_rung = RUNGS_A_ZOOM * (finest + options->finest_octaves) + (options->lossless ? 1 : 0);
    ladder->coarsest_rung = -RUNGS_A_ZOOM * (1 + options->coarse_octaves);
    ladder->lossless = options->lossless;
    double static_step_m = border_step_m(lattice, options, ladder->tolerance_m[finest], finest);
    ladder->height_unit_m = height_unit_m(ladder, options, static_step_m);
    if ((status = check_steps(ladder, options, static_step_m, error)) != SCREE_OK) return status;
    for (int zoom = finest; zoom >= 0; zoom--) {
        double step_m = zoom == finest ? relief_step_m(lattice, options, ladder->tolerance_m[zoom], zoom)
                                       : border_step_m(lattice, options, ladder->tolerance_m[zoom], zoom);
        double steps = step_m / ladder->height_unit_m;
        int32_t finer = zoom < finest ? ladder->border_step[zoom + 1] : 1;
        ladder->border_step[zoom] = steps > finer ? (int32_t)fmin(steps, 1 << 30) : finer;
    }
    return SCREE_OK;
}
