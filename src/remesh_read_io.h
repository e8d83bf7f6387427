/* A raster's own pixels as posts for a quadtree. */
#ifndef SCREE_REMESH_READ_IO_H
#define SCREE_REMESH_READ_IO_H

#include "src/lattice.h"
#include "src/raster_io.h"
#include "stream/curvature.h"
#include "stream/memory.h"
#include <scree/error.h>

struct remesh_raster {
    struct lattice local, lattice; /* in the units of the raster's CRS, and as remesh_lattice has it */
    float *heights_m;
    struct curvature_posts posts; /* of heights_m */
};

/* Reads all of it, voids filled as raster_read does. The profile of `options` is to be local. Fails as raster_open
 * does, and when there are more than CURVATURE_MAX_POSTS a side, fewer than 2, or latitudes beyond the poles. `raster`
 * is to be freed with remesh_raster_free in any case. */
enum scree_status remesh_read(struct scree_memory *memory, const struct raster_options *options,
                              struct remesh_raster *raster, struct scree_error *error);

void remesh_raster_free(struct scree_memory *memory, struct remesh_raster *raster);

#endif
