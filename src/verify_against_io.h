/* Every zoom of a terrain product against its source: the error at every post of the finest lattice that the source
 * covers and a tile lies under. Posts are read once, in blocks; for each zoom one tile is held. */
#ifndef SCREE_VERIFY_AGAINST_IO_H
#define SCREE_VERIFY_AGAINST_IO_H

#include "src/mesh_residual.h"
#include "src/raster_io.h"
#include "src/terrain_set_io.h"
#include "src/verify_terrain_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Opens the rasters and places them on the lattice of what was built from them; SCREE_E_ARGUMENT when they are others.
 * `raster` is to be freed in any case. */
enum scree_status verify_open_source(const struct raster_options *options, const struct lattice *lattice,
                                     struct raster **raster, struct scree_error *error);

struct against {
    struct residuals *zooms; /* MAX_ZOOM + 1 of them */
};

/* Measures. `options.profile` is set here, from layer.json. Fails when the source cannot be read or memory runs out;
 * tiles that do not decode are left out (verify_terrain tells of them). */
enum scree_status verify_against(struct scree_memory *memory, const struct terrain_set *set,
                                 struct raster_options options, verify_progress *progress, void *context,
                                 struct against *against, struct scree_error *error);

/* Books PROMISE_ERROR: at the finest zoom no post is farther from the mesh as drawn than the tolerance. */
void verify_against_judge(const struct terrain_set *set, const struct against *against, struct verify_report *report);

/* Safe on a zeroed one and twice. */
void against_free(struct scree_memory *memory, struct against *against);

#endif
