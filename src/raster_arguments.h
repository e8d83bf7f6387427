/* The options of a command line that say how rasters and point clouds are read: the same for every command that reads
 * them. Pure. */
#ifndef SCREE_RASTER_ARGUMENTS_H
#define SCREE_RASTER_ARGUMENTS_H

#include "src/arguments.h"
#include "src/cloud_arguments.h"
#include "src/raster_io.h"
#include <scree/error.h>

/* Looks at argv[*at]; what was taken is stepped over, so that *at is the next argument. */
enum argument_result raster_argument_take(int argc, char **argv, int *at, struct raster_options *options,
                                          struct scree_error *error);

/* When all are taken: do they go together? If not, `error` says which ones do not. */
bool raster_arguments_check(const struct raster_options *options, struct scree_error *error);

/* Lines for a command's --help: what it takes to read rasters, and the same with what filters them. */
#define RASTER_READING_HELP                                                                                      \
    "  -r METHOD            resampling where a raster has to be warped: near, bilinear (default), cubic, ...\n"  \
    "  -b N                 band, from 1\n"                                                                      \
    "  --s_srs CRS          the rasters' CRS, in place of their own; may name a vertical one (EPSG:4326+5773)\n" \
    "  -a_nodata VALUE      this value means no data, in place of what the rasters declare\n"                    \
    "  --nodata-height M    height where there are no data, default 0\n"                                         \
    "  --fill-distance N    interpolate voids up to so many posts wide, default 100; -1: never\n"                \
    "  --any-height         let heights beyond 20 km pass\n"                                                     \
    "  --te W S E N         crop to this extent, degrees or CRS units\n" CLOUD_ARGUMENTS_HELP

#define RASTER_ARGUMENTS_HELP                                                                                  \
    RASTER_READING_HELP                                                                                        \
    "  --filter             filter what is read first, as scree filter does and with its options: --landuse, " \
    "--rules,\n"                                                                                               \
    "                       --spline-steps, --delta, --least, --variant, --thresholds, --filter-memory\n"

#endif
