/* Context-sensitive filtering: terrain as a coarse spline, with the detail that people look at. Pure.
 *
 * After S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi scale analysis"
 * (GRAPP 2015), section 5. Heights come from the spline (lod/spline_filter.h), except where they differ by more than
 * 0.3 m from it and the post belongs to a class that asks for more; there they come from the Haar transform
 * (lod/haar_filter.h) with that class's thresholds, if these in turn differ by more than 0.3 m from the spline. */
#ifndef SCREE_LOD_CONTEXT_FILTER_H
#define SCREE_LOD_CONTEXT_FILTER_H

#include "lod/haar_filter.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

#define CONTEXT_NEAR_POSTS 4 /* each way: squares of 9 x 9 posts */

/* What the ground is used for, as bits of one byte a post. */
enum ground_use {
    GROUND_WATER = 1, /* where it ends, there is a shore */
    GROUND_SHORE = 2,
    GROUND_RAILWAY = 4,
    GROUND_BRIDGE = 8,
    GROUND_RAMP = 16, /* a road that meets a bridge */
    GROUND_FOREST = 32
};

/* In the order of the paper's Table 1; the last has no thresholds. */
enum context_class {
    CONTEXT_NEAR,    /* class 1: near shores, railways, bridges and ramps */
    CONTEXT_RAILWAY, /* class 1: on a railway's embankment */
    CONTEXT_HILL,    /* class 2: the spline is farther away than delta */
    CONTEXT_FOREST,  /* class 2, under trees */
    CONTEXT_REST,    /* class 3: the spline is good enough */
    CONTEXT_CLASSES
};

/* "near", "railway", "hill", "forest"; "rest" for the last. */
const char *context_class_name(enum context_class kind);

enum context_detail {
    CONTEXT_FILTERED,   /* heights of classes 1 and 2 are filtered by the Haar transform */
    CONTEXT_UNFILTERED, /* they are left as they are: the paper's Table 2, middle column */
    CONTEXT_NONE        /* nothing but the spline */
};

struct context_options {
    int32_t spline_steps; /* 1 to SPLINE_MAX_STEPS */
    double delta_m;       /* class 2 begins here */
    double least_m;       /* smaller differences cannot be seen */
    enum haar_variant variant;
    enum context_detail detail;
    double thresholds_m[CONTEXT_REST][HAAR_LEVELS]; /* by class, from coarse to fine */
};

/* Three steps, 4 m, 0.3 m, eq. 4, and the thresholds of Table 1. */
struct context_options context_defaults(void);

struct context_posts {
    const float *heights_m; /* row by row; finite */
    int32_t columns, rows;  /* at least 2 */
    const uint8_t *uses;    /* of each post, or NULL: nothing is known */
    const uint32_t *waters; /* of each post the number of its water, 1 to water_count, or 0: none; NULL: no water */
    uint32_t water_count;
};

struct context_counts {
    uint64_t posts[CONTEXT_CLASSES];
    uint64_t detailed; /* posts whose height is not the spline's; water not counted */
    uint64_t levelled; /* posts of water */
};

/* Filters into filtered_m, which has as many heights and is not heights_m. Each water takes the mean of its unfiltered
 * heights. Takes 3 bytes a post, one more with `uses`, and 5 MiB. */
enum scree_status context_filter(struct scree_memory *memory, const struct context_posts *posts,
                                 const struct context_options *options, float *filtered_m,
                                 struct context_counts *counts, struct scree_error *error);

#endif
