/* Every zoom of a terrain product against its source: the error at every post of the finest lattice that the source
 * covers and a tile lies under, or at every point of a TIN. Posts are read once, in blocks; for each zoom one tile is
 * held. */
#ifndef SCREE_VERIFY_AGAINST_IO_H
#define SCREE_VERIFY_AGAINST_IO_H

#include "src/mesh_residual.h"
#include "src/raster_io.h"
#include "src/terrain_set_io.h"
#include "src/verify_source_io.h"
#include "src/verify_terrain_io.h"
#include "stream/memory.h"
#include <scree/error.h>

struct against {
    struct residuals *zooms; /* MAX_ZOOM + 1 of them */
    bool is_of_points;       /* of a TIN, and not of a raster's posts */
    int finest;              /* the zoom that was made against all of them */
};

/* Measures. `options.profile` is set here, from layer.json. Fails when the source cannot be read or memory runs out;
 * tiles that do not decode are left out (verify_terrain tells of them). */
enum scree_status verify_against(struct scree_memory *memory, const struct terrain_set *set,
                                 struct raster_options options, verify_progress *progress, void *context,
                                 struct against *against, struct scree_error *error);

/* Books PROMISE_ERROR: at the finest zoom no post or point is farther from the mesh as drawn than the tolerance. */
void verify_against_judge(const struct terrain_set *set, const struct against *against, struct verify_report *report);

/* Safe on a zeroed one and twice. */
void against_free(struct scree_memory *memory, struct against *against);

#endif
