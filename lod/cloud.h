/* Points with heights in no order, and what is done to them before they become a surface. Pure.
 *
 * Positions and heights are in the units of the points' own coordinate system. What a function here keeps depends on
 * the points alone, not on their order. */
#ifndef SCREE_LOD_CLOUD_H
#define SCREE_LOD_CLOUD_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define CLOUD_MOST_POINTS 700000000 /* half-edges of their triangulation still have 32 bits */

struct cloud_point {
    double x, y, z;
};

struct cloud {
    struct scree_memory *memory; /* that pays for everything; set it, zero the rest */
    struct cloud_point *points;
    uint32_t count, capacity;
};

void cloud_release(struct cloud *cloud);

/* Adds a point whose coordinates are finite. */
enum scree_status cloud_add(struct cloud *cloud, struct cloud_point point, struct scree_error *error);

/* West, south, east, north of at least one point. */
void cloud_bounds(const struct cloud *cloud, double bounds[4]);

/* Keeps of every square with sides of `side` the point that is nearest to its centre; of equally near ones the lowest.
 * Squares are counted from the coordinate system's origin. Refused where `side` is too small to count in 32 bits. */
enum scree_status cloud_thin(struct cloud *cloud, double side, struct scree_error *error);

/* Takes out every point that is more than `distance` above or below the median height of the points around it: those
 * of its square and the eight around, where a square has about eight points. Fewer than four points are no majority,
 * and stay. */
enum scree_status cloud_drop_outliers(struct cloud *cloud, double distance, struct scree_error *error);

#endif
