/* Points as text: one a line, three numbers or more with blanks, tabs, commas or semicolons between them. Pure.
 *
 * Lines that are empty or begin with # or // say nothing. The first other line may name the columns: x, y and z, or
 * easting and northing, longitude and latitude, lon and lat, height, elevation; without names the first three columns
 * are x, y and z. */
#ifndef SCREE_SRC_CLOUD_TEXT_H
#define SCREE_SRC_CLOUD_TEXT_H

#include "lod/cloud.h"
#include <stdbool.h>

#define CLOUD_LONGEST_LINE 4096 /* with its end */

struct cloud_text {
    const char *name; /* of the file, for errors; set it, zero the rest */
    uint64_t line;    /* the one that was taken last, from 1 */
    int column[3];    /* of x, y and z */
    bool has_begun;   /* a line with names or numbers has been there */
};

/* Takes one line, a string without its end. `*has_point` tells whether it holds a point. SCREE_E_CORRUPT: it is ragged,
 * or holds what is no number. */
enum scree_status cloud_text_take(struct cloud_text *text, const char *line, bool *has_point, struct cloud_point *point,
                                  struct scree_error *error);

#endif
