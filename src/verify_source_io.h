/* What a product is measured against: the posts of rasters, or the points of meshes and clouds. */
#ifndef SCREE_VERIFY_SOURCE_IO_H
#define SCREE_VERIFY_SOURCE_IO_H

#include "src/point_residual.h"
#include "src/raster_io.h"
#include "src/tin_points_io.h"

/* What was built, as its manifest tells. */
struct verify_built {
    const struct lattice *lattice;
    int max_zoom;         /* of its tiles */
    const double *bounds; /* four, of the data */
};

struct verify_source {
    bool is_tin;
    struct raster *raster; /* placed on the lattice; NULL with a TIN */
    struct raster_reader *reader;
    struct tin_points tin;
    struct residual_points points; /* of the TIN */
};

/* Opens the inputs and places them on the lattice of what was built from them; SCREE_E_ARGUMENT when they are others.
 * options->profile is set here. `source` is zeroed, must not move, and is to be closed in any case. */
enum scree_status verify_source_open(struct scree_memory *memory, struct raster_options *options,
                                     const struct verify_built *built, struct verify_source *source,
                                     struct scree_error *error);
void verify_source_close(struct verify_source *source);

/* The zoom whose tiles are measured against all of the source while they are made. */
int verify_source_finest(const struct verify_source *source, const struct verify_built *built);

#endif
