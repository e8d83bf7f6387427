/* The list of methods: options of each, in the order in which `run` finds their values, and a line in the table. */
#include "src/methods.h"

#include "lod/method_greedy.h"

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

/* ---- the table ---- */

/* name, what it is good for, its options, contradictions, run */
const struct method method_table[] = {
    {"greedy", "Garland and Heckbert's insertion: fast, keeps to a vertical error", OPTIONS(greedy_options), NULL,
     run_greedy},
    {NULL, NULL, 0, NULL, NULL, NULL},
};
