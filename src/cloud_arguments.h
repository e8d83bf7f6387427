/* The options of a command line that are for point clouds and meshes. Pure. */
#ifndef SCREE_SRC_CLOUD_ARGUMENTS_H
#define SCREE_SRC_CLOUD_ARGUMENTS_H

#include "src/arguments.h"
#include "src/cloud_options.h"
#include <scree/error.h>

/* Looks at argv[*at]; what was taken is stepped over. The options keep the word, not a copy of it. */
enum argument_result cloud_argument_take(int argc, char **argv, int *at, struct cloud_options *options,
                                         struct scree_error *error);

/* Lines for a command's --help. */
#define CLOUD_ARGUMENTS_HELP                                                                                         \
    "Point clouds, in place of rasters: LAS; .xyz, .csv, .txt or .pts text; layers of points with z; and meshes:\n"  \
    ".ply, .obj, .stl, .off, .om. build and verify keep them as triangles, where posts are wanted they become "      \
    "posts.\n"                                                                                                       \
    "M in their CRS's units; several are one:\n"                                                                     \
    "  --grid M             posts in place of triangles, M apart; default, where posts are wanted, about as the "    \
    "points\n"                                                                                                       \
    "  --max-edge M         longest edge of a triangle between points, default 100 posts or mean distances\n"        \
    "  --class LIST         only points of these classes, 2,9 for ground and water; default all but noise (7, 18)\n" \
    "  --returns WHICH      all (default), first, last or only: of pulses that came back once\n"                     \
    "  --thin M             one point of each square with sides of M\n"                                              \
    "  --outliers M         without points more than M above or below the median of those around\n"                  \
    "  --memory MB          for clouds and meshes, default 2048\n"

#endif
