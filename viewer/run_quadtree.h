// scree-view --quadtree: a raster whose mesh follows the observer, in a window, in a picture or along a flight.
#ifndef SCREE_VIEWER_RUN_QUADTREE_H
#define SCREE_VIEWER_RUN_QUADTREE_H

#include "viewer/view_arguments.h"

#include <string>

// Ends when it is done; false, and one line in `error`, when it failed. A flight prints what it took.
bool run_quadtree(const ViewArguments &arguments, std::string *error);

// The keys of its window, one line each.
std::string quadtree_keys_help();

#endif
