/* Lines simplified together: none comes to cross or touch another one, or changes sides with a point of one. Pure.
 *
 * The lines are constraints of a triangulation of the plane, whose points are all on lines or on its border. The inner
 * point of a line whose removal costs the least leaves, again and again, as long as the triangulation says that the
 * topology stays (lod/constrained.h; Dyken, Daehlen and Sevaldrud, "Simultaneous curve simplification", 2009). As in
 * Campos et al. (2020), section 4.3.1, the cost is measured in space: the largest distance of any point that the line
 * ever had between two neighbours from the segment that joins them now. */
#ifndef SCREE_LOD_POLYLINE_H
#define SCREE_LOD_POLYLINE_H

#include "lod/constrained.h"
#include "stream/ellipsoid.h"

struct polylines {
    uint32_t line_count;
    const uint32_t *starts; /* line_count + 1: where lines begin in `points` */
    uint32_t *points;       /* of the triangulation; a closed line has its first point once more at its end. Lines meet
                               at ends only, and neighbours are joined by constraints */
};

/* Takes points out of the lines and the triangulation as long as one costs at most `tolerance_m`; those that have left
 * become CONSTRAINED_NONE in `points`. Ends stay. `places_m` has the place of every point of the triangulation. Ties go
 * to the line and the point that come first. */
enum scree_status polylines_simplify(struct scree_memory *memory, const struct vector3 *places_m, double tolerance_m,
                                     struct constrained *triangulation, struct polylines *lines,
                                     struct scree_error *error);

#endif
