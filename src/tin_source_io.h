/* Mesh files and point clouds that are kept as the triangles they are: from the files to a TIN on a lattice. */
#ifndef SCREE_SRC_TIN_SOURCE_IO_H
#define SCREE_SRC_TIN_SOURCE_IO_H

#include "lod/tin.h"
#include "lod/tin_lattice.h"
#include "src/lattice.h"
#include "src/raster_io.h"

#define TIN_BLOCK_POINTS 8192 /* the default of --block */

struct tin_source {
    struct scree_memory memory;    /* that pays for all that is kept; limited by --memory */
    struct raster_summary summary; /* as of rasters; bounds are those of the points, spacings their mean distance */
    struct tin_mended mended;      /* what was put right in mesh files */
    struct lattice lattice;
    int leaf_zoom;    /* tiles of this zoom are the sub-blocks that the TIN is cut into */
    int32_t cells;    /* along a leaf tile's side: a power of two, 16 to 256; about one point a cell */
    double quantum_m; /* heights are multiples of it, as far as floats tell; 0: of nothing */
    double outside_m; /* height outside of the surface */
    int64_t x, y;     /* post of the lattice at which the frame of `placed` begins: a multiple of a leaf tile's side */
    struct lattice_window window; /* of posts: all that the surface and its wall touch */
    struct tin_lattice placed;
};

/* Whether the inputs are kept as triangles: they are mesh files or point clouds, all of them, and no --grid asks for
 * posts. SCREE_E_ARGUMENT when some are and others are not. */
enum scree_status tin_source_is_wanted(const struct raster_options *options, bool *is_wanted,
                                       struct scree_error *error);

/* Reads the inputs, makes one TIN of them, and places it. `block_points`: the most points of a sub-block, 0 for the
 * default. `has_outside`: options->nodata_height_m was given; else it is lowest height in the local profile, 0 in the
 * geodetic one. To be released in any case. Failures as raster_open and tin_mend tell them, with the file's name; and
 * what --memory does not pay for. */
enum scree_status tin_source_open(const struct raster_options *options, uint32_t block_points, bool has_outside,
                                  struct tin_source *source, struct scree_error *error);
void tin_source_release(struct tin_source *source);

#endif
