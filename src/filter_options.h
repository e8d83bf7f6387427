/* How a raster is filtered before it is used: what the options of the command line say. Zeroes are defaults. */
#ifndef SCREE_SRC_FILTER_OPTIONS_H
#define SCREE_SRC_FILTER_OPTIONS_H

#include "lod/context_filter.h"

struct filter_options {
    bool is_wanted;                 /* --filter: rasters are filtered when they are opened */
    const char *named;              /* another of these options, as it was written; NULL: there was none */
    struct context_options context; /* spline_steps 0: context_defaults() in all */
    const char *landuse;            /* a vector source that OGR reads; NULL: nothing is known of land use */
    const char *rules;              /* what its attributes mean; NULL: `class` holds the name of the use */
    int memory_mb;                  /* 0: 4000 */
};

#endif
