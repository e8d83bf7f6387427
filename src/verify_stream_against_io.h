/* Streams against their source: the vertical error of every tile at every rung, at every post of the finest lattice
 * that the source covers or every point of a TIN, against what the stream says of that rung. Each zoom reads the source
 * once; one tile and a block of posts are held. */
#ifndef SCREE_VERIFY_STREAM_AGAINST_IO_H
#define SCREE_VERIFY_STREAM_AGAINST_IO_H

#include "src/mesh_residual.h"
#include "src/raster_io.h"
#include "src/stream_set_io.h"
#include "src/verify_report.h"
#include "src/verify_terrain_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* What was measured at one end of a zoom's rungs, over all of its tiles. */
struct stream_measure {
    double stated_m;   /* the largest max error that a tile says */
    double measured_m; /* as drawn: flat triangles on the curved earth */
};

struct stream_against_zoom {
    uint64_t meshes; /* measured: tiles times rungs; 0: nothing was */
    uint64_t beyond; /* of them farther off than they say */
    struct stream_measure coarsest, finest;
    double worst_share; /* the largest of measured over stated */
};

struct stream_against {
    struct stream_against_zoom *zooms; /* MAX_ZOOM + 1 of them */
};

/* Measures, and books PROMISE_STREAM_ERROR for every mesh of the finest zoom: its error is measured against all posts
 * while it is made. Coarser zooms are made against the extremes of their cells; how far that misses is told and no
 * breach. `options.profile` is set here, from scree.json. Fails when the source cannot be read or memory runs out;
 * streams that do not decode are left out (verify_streams tells of them). */
enum scree_status verify_streams_against(struct scree_memory *memory, const struct stream_set *set,
                                         struct raster_options options, verify_progress *progress, void *context,
                                         struct stream_against *against, struct verify_report *report,
                                         struct scree_error *error);

/* Safe on a zeroed one and twice. */
void stream_against_free(struct scree_memory *memory, struct stream_against *against);

#endif
