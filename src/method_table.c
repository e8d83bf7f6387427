/* The list of methods: options of each, in the order in which `run` finds their values, and a line in the table. */
#include "src/methods.h"

#include "lod/method_greedy.h"
#include "lod/method_quadtree.h"

#include <math.h>
#include <stddef.h>

#define OPTIONS(list) (int)(sizeof(list) / sizeof *(list)), list

/* ---- greedy ---- */

static const struct method_option greedy_options[] = {
    {"g_e", "largest vertical error, metres; default: the zoom's --error", 0, 1e7, 0, 1, false},
    {"g_g", "cells a side of a grid of posts to begin with; default 0, none", 0, 8192, 0, 0, true},
};

static enum scree_status run_greedy(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                    struct method_mesh *mesh, struct scree_error *error) {
    const struct method_greedy_options options = {.tolerance_m = values[0], .grid_cells = (int32_t)values[1]};
    return method_greedy(memory, tile, &options, mesh, error);
}

/* ---- quadtree ---- */

static const struct method_option quadtree_options[] = {
    {"q_k", "largest sum of curvature of a node, no unit; default: what q_e asks for", 0, 1e9, NAN, 0, false},
    {"q_e", "vertical error aimed at, not held, metres; default: the zoom's --error", 0, 1e7, 0, 1, false},
};

static enum scree_status run_quadtree(struct scree_memory *memory, const struct method_tile *tile,
                                      const double values[], struct method_mesh *mesh, struct scree_error *error) {
    const double threshold = isnan(values[0]) ? method_quadtree_threshold(tile, values[1]) : values[0];
    return method_quadtree(memory, tile, &(struct method_quadtree_options){.threshold = threshold}, mesh, error);
}

/* ---- the table ---- */

/* name, what it is good for, its options, contradictions, run */
const struct method method_table[] = {
    {"greedy", "Garland and Heckbert's insertion: fast, keeps to a vertical error", OPTIONS(greedy_options), NULL,
     run_greedy},
    {"quadtree", "Cifuentes' quadtree of leaves with little curvature: by far the fastest", OPTIONS(quadtree_options),
     NULL, run_quadtree},
    {NULL, NULL, 0, NULL, NULL, NULL},
};
