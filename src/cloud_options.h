/* How point clouds among the inputs become posts: what the options of the command line say. Zeroes are defaults. */
#ifndef SCREE_SRC_CLOUD_OPTIONS_H
#define SCREE_SRC_CLOUD_OPTIONS_H

#include <stdbool.h>

enum cloud_returns {
    CLOUD_EVERY_RETURN,
    CLOUD_FIRST_RETURN,
    CLOUD_LAST_RETURN,
    CLOUD_ONLY_RETURN /* of pulses that came back once */
};

struct cloud_options {
    const char *named; /* an option that only clouds have, as it was written; NULL: there was none */
    bool has_classes;  /* only points of `classes`; else all but noise (7 and 18) */
    bool classes[256];
    enum cloud_returns returns;
    double thin;         /* side of the squares that keep one point, in units of the clouds' CRS; 0: all stay */
    double outliers;     /* largest height above or below the median around, in the heights' units; 0: any */
    double grid;         /* spacing of posts, in units of the clouds' CRS; 0: from the points' mean distance */
    double longest_edge; /* of a triangle that makes heights; 0: 100 posts */
    int memory_mb;       /* 0: 2048 */
};

#endif
