/* Where the streams of a TIN end: the base mesh, chosen by its size or its scale. Pure. */
#ifndef SCREE_SRC_BASE_H
#define SCREE_SRC_BASE_H

#include "src/pyramid.h"

enum base_kind {
    BASE_SHARE,     /* of the triangles of the whole TIN */
    BASE_TRIANGLES, /* at most so many of them */
    BASE_SVO        /* the first whose SVO is as large, metres */
};

struct base_choice {
    enum base_kind kind;
    double value; /* 0: BASE_SHARE of DEFAULT_BASE_SHARE */
};

#define DEFAULT_BASE_SHARE 0.2 /* Ai et al. 2019, section 2.1 */

/* "20%", "5000" or "0.5m". */
bool base_parse(const char *text, struct base_choice *choice);

/* What a census has to count for the choice. */
enum census base_census(const struct base_choice *choice);

/* The finest rung that all tiles may end with: the meshes of all tiles together are what was asked for. Where none is,
 * it is the coarsest. */
int base_rung(const struct base_choice *choice, const struct ladder *ladder, const struct pyramid *census);

/* The coarsest zoom whose streams reach beyond their finest rung when they end at `rung`. */
int base_zoom(const struct ladder *ladder, int rung);

#endif
