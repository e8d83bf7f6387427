/* The scale ladder: which vertical error each zoom and each rung may have, and in which steps heights are written.
 * Pure.
 *
 * Rungs are a quarter of an octave apart and grow with detail. Rung 4z has the tolerance of zoom z; between two zooms
 * tolerances are interpolated geometrically, beyond the finest and the coarsest they go on by 2^(-1/4) a rung. A tile
 * of zoom z goes from rung 4z to rung 4(z - 1); one of the finest zoom begins at the finest rung. */
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

#define RUNGS_A_ZOOM           4
#define DEFAULT_FINEST_OCTAVES 2
#define MAX_FINEST_OCTAVES     8
#define MAX_COARSE_OCTAVES     8
#define FINEST_OCTAVES_UNSAID  (-1) /* what is usual for the source: build.h */

struct ladder_options {
    double root_error_m;             /* tolerance of zoom 0, halving with each zoom; 0: the default, which stops where
                                        heights cannot be written more finely */
    double error_at_m[MAX_ZOOM + 1]; /* overrules single zooms; 0: not given */
    double relief_m;                 /* of the whole source */
    double wall_m;                   /* how far it stands above or below what surrounds it: one tile may have it all */
    double largest_height_m;         /* absolute */
    int zooms_above;                 /* of the lattice's finest one lies the finest zoom of tiles: that of a TIN's */
    int finest_octaves;              /* how far the finest zoom goes on below its tolerance */
    bool lossless;                   /* the finest rung is the full grid, or all of a TIN */
    int coarse_octaves;              /* how far zoom 0 goes on beyond the octave that every zoom has */
    double quantum_m;                /* what heights are multiples of, and no finer are they counted; 0: nothing */
};

struct ladder {
    double tolerance_m[MAX_ZOOM + 1];  /* by zoom, falling */
    double height_unit_m;              /* power of two: what meshes count heights in */
    int32_t border_step[MAX_ZOOM + 1]; /* height units: border heights of a zoom's static tiles are multiples of it */
    int finest_zoom;                   /* of the tiles */
    int finest_rung;                   /* what tiles of the finest zoom begin at */
    int coarsest_rung;                 /* what tiles of zoom 0 end at */
    bool lossless; /* the finest rung is the full grid: its tolerance is that of the rung before it */
};

/* The tolerance of a rung, finest_rung to coarsest_rung: what its mesh keeps to. Where the steps of static heights are
 * coarser than those of meshes, half a step is left at the finest zoom for rounding to them. */
double ladder_rung_tolerance_m(const struct ladder *ladder, int rung);

/* The octaves of the finest zoom below its static tile. */
static inline int ladder_finest_octaves(const struct ladder *ladder) {
    return ladder->finest_rung / RUNGS_A_ZOOM - ladder->finest_zoom;
}

/* How many octaves below its static tile a TIN of the lattice's finest zoom may go before heights are told apart more
 * finely than they were measured. */
int ladder_octaves_of_tin(const struct lattice *lattice, const struct ladder_options *options);

/* SCREE_E_ARGUMENT when tolerances grow with the zoom, or the finest is below the step of the heights. */
enum scree_status ladder_make(const struct lattice *lattice, const struct ladder_options *options,
                              struct ladder *ladder, struct scree_error *error);

#endif
