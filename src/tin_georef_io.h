/* Where on Earth a TIN is: from its own coordinate system to that of the profile, and heights to metres. */
#ifndef SCREE_SRC_TIN_GEOREF_IO_H
#define SCREE_SRC_TIN_GEOREF_IO_H

#include "lod/tin.h"
#include "src/cloud_join_io.h"

/* In the geodetic profile positions become WGS 84 longitude and latitude, in one turn, and heights ellipsoidal, by the
 * operations that rasters use; in the local profile only heights change, by their unit. Fills the summary but for
 * columns, rows and spacings; its strings are to be freed in any case. `height_unit_m`: what all heights were
 * multiplied by, 0: a datum has changed them. `name` stands in failures: no CRS (geodetic), one that PROJ cannot carry
 * out, positions nowhere on Earth, across the antimeridian or around a pole, heights beyond 20 km. */
enum scree_status tin_georeference(const struct raster_options *options, const char *name,
                                   const struct cloud_meaning *meaning, struct tin *tin, struct raster_summary *summary,
                                   double *height_unit_m, struct scree_error *error);

#endif
