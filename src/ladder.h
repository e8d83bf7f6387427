/* The scale ladder: which vertical error each zoom may have, and in which steps its heights are written. Pure. */
#ifndef SCREE_LADDER_H
#define SCREE_LADDER_H

#include "src/lattice.h"
#include <scree/error.h>

/* Cesium's own error of a level: this many metres at zoom 0, half of it with each zoom. */
#define CESIUM_LEVEL_ERROR_M 77067.34

/* The default tolerance as a share of Cesium's level error. A client that lets a level's error grow to 2 pixels then
 * sees at most a quarter of a pixel of ours; what the eye sees is the shading. Chosen by looking at two ranges (SRTM of
 * 90 m and of 30 m) through CesiumJS from several distances: at a quarter, small ridges run together and slopes show
 * facets; at an eighth, shapes are right and facets show from close by only; at a sixteenth, hardly any. Against a
 * thirty-second, 5-9 %, 2 % and 0.3 % of the pixels of the whole range differ by over 16 of 255. Halving costs 1.9-2.4
 * times the triangles and 1.8-2.2 times the bytes. */
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

/* SCREE_E_ARGUMENT when tolerances grow with the zoom, or the finest is below the step of the heights. */
enum scree_status ladder_make(const struct lattice *lattice, const struct ladder_options *options,
                              struct ladder *ladder, struct scree_error *error);

#endif
