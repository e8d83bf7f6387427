/* The points of meshes or clouds on a lattice that something has been built on: what verify measures at. */
#ifndef SCREE_SRC_TIN_POINTS_IO_H
#define SCREE_SRC_TIN_POINTS_IO_H

#include "lod/tin_lattice.h"
#include "src/raster_io.h"

struct tin_points {
    struct scree_memory memory; /* limited by --memory */
    struct tin_post *points;    /* without slopes; those that have triangles once they are rounded */
    uint32_t count;
    int64_t x, y; /* post of the lattice from which they are counted: none lies west or south of it */
};

/* Reads inputs that tin_source_is_wanted finds to be kept as triangles, as tin_source_open does. SCREE_E_ARGUMENT when
 * their bounds are not those of what was built. To be released in any case. */
enum scree_status tin_points_open(const struct raster_options *options, const struct lattice *lattice,
                                  const double built_bounds[4], struct tin_points *points, struct scree_error *error);
void tin_points_release(struct tin_points *points);

#endif
