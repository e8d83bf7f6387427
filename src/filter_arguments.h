/* The options of a command line that say how a raster is filtered. Pure. */
#ifndef SCREE_SRC_FILTER_ARGUMENTS_H
#define SCREE_SRC_FILTER_ARGUMENTS_H

#include "src/arguments.h"
#include "src/filter_options.h"
#include <scree/error.h>

/* Looks at argv[*at]; what was taken is stepped over. The options keep words, not copies of them. --filter itself is
 * not among these. */
enum argument_result filter_argument_take(int argc, char **argv, int *at, struct filter_options *options,
                                          struct scree_error *error);

/* What context_filter takes: the options', or its defaults where there were none. */
struct context_options filter_context(const struct filter_options *options);

/* Lines for the --help of the command that tells all of it. */
#define FILTER_ARGUMENTS_HELP                                                                                         \
    "  --landuse FILE       polygons of land use, any vector source that OGR reads: posts near shores, railways,\n"   \
    "                       bridges and roads that meet bridges keep detail, waters are levelled to their mean\n"     \
    "  --rules FILE         what attributes mean, a rule a line, the first that fits counts: USE ATTRIBUTE=VALUE;\n"  \
    "                       uses are water, shore, railway, bridge, road and forest, and * is any value. Default:\n"  \
    "                       the attribute class has the name of the use\n"                                            \
    "  --spline-steps N     halve the grid so often for the spline, 1 to 9, default 3\n"                              \
    "  --delta M            keep detail where the spline is farther away than this, default 4\n"                      \
    "  --least M            differences up to this cannot be seen, and stay with the spline; default 0.3\n"           \
    "  --variant N          2 (default): of the wavelets only what is finer than all that reach their thresholds\n"   \
    "                       goes (the paper's eq. 4); 1: whatever stays below its threshold goes (eq. 3)\n"           \
    "  --thresholds CLASS=T0,T1,...,T8   nine thresholds in metres, from coarse (512 posts) to fine (2 posts); may\n" \
    "                       be given once a class. Classes and their defaults (the paper's Table 1):\n"               \
    "                       near, no farther than 4 posts from what has to be kept: 0,.1,.1,.2,.2,.2,.3,.3,.4\n"      \
    "                       railway, on an embankment: 0,.1,.1,.1,.1,.1,.1,.1,.1\n"                                   \
    "                       hill, farther than delta from the spline: 0,.1,.2,.2,.3,.4,.5,.5,.5\n"                    \
    "                       forest, the same under trees: 0,.1,.2,.2,.3,20,20,20,20\n"                                \
    "  --filter-memory MB   refuse rasters that need more, default 4000; a post takes 24 bytes\n"

#endif
