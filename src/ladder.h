/* The scale ladder: which vertical error each zoom may have, and in which steps its heights are written. Pure. */
#ifndef SCREE_LADDER_H
#define SCREE_LADDER_H

#include "src/lattice.h"
#include <scree/error.h>

/* Cesium's own error of a level: this many metres at zoom 0, half of it with each zoom. */
#define CESIUM_LEVEL_ERROR_M 77067.34

/* The default tolerance as a share of Cesium's level error. A client that draws level errors of 2 pixels then sees at
 * most half a pixel of ours. Chosen by eye: at a half, ridges visibly move when a zoom changes; at an eighth, tiles
 * grow by 60 % and pictures stay the same. */
#define DEFAULT_TOLERANCE_SHARE 0.125

struct ladder_options {
    double root_error_m;             /* tolerance of zoom 0, halving with each zoom; 0: the default */
    double error_at_m[MAX_ZOOM + 1]; /* overrules single zooms; 0: not given */
    double relief_m;                 /* of the whole source */
    double largest_height_m;         /* absolute */
};

struct ladder {
    double tolerance_m[MAX_ZOOM + 1];  /* by zoom, falling */
    double height_unit_m;              /* power of two: what meshes count heights in */
    int32_t border_step[MAX_ZOOM + 1]; /* height units: border heights of a zoom are multiples of it */
};

/* SCREE_E_ARGUMENT when tolerances do not fall from zoom to zoom. */
enum scree_status ladder_make(const struct lattice *lattice, const struct ladder_options *options,
                              struct ladder *ladder, struct scree_error *error);

#endif
