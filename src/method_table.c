/* The list of methods: options of each, in the order in which `run` finds their values, and a line in the table. */
#include "src/methods.h"

#include "lod/method_greedy.h"
#include "lod/method_grid.h"
#include "lod/method_hierarchy.h"
#include "lod/method_lindstrom_turk.h"
#include "lod/method_qem.h"
#include "lod/method_quadtree.h"
#include "lod/method_random.h"
#include "lod/method_wlop.h"

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

/* ---- qem ---- */

static const struct method_option qem_options[] = {
    {"error", "largest vertical error, metres; default: the zoom's --error", 0, 1e7, 0, 1, false},
    {"bound", "0: without it, any error will do, and `vertices` says where to stop; default 1", 0, 1, 1, 0, true},
    {"vertices", "stop when so many are left, border included; default: when the bound says so", 4, 1e9, NAN, 0, true},
};

static const char *contradiction_qem(const double values[]) {
    return values[1] == 0 && isnan(values[2]) ? "bound=0 wants vertices=4 or more, to know where to stop" : NULL;
}

static struct method_qem_options qem_values(const double values[]) {
    return (struct method_qem_options){.tolerance_m = values[0],
                                       .is_unbounded = values[1] == 0,
                                       .least_vertices = isnan(values[2]) ? 0 : (uint32_t)values[2]};
}

static enum scree_status run_qem(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                 struct method_mesh *mesh, struct scree_error *error) {
    const struct method_qem_options options = qem_values(values);
    return method_qem(memory, tile, &options, mesh, error);
}

static enum scree_status run_qem_fit(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                     struct method_mesh *mesh, struct scree_error *error) {
    struct method_qem_options options = qem_values(values);
    options.fits = true;
    return method_qem(memory, tile, &options, mesh, error);
}

/* ---- lindstrom-turk ---- */

static const struct method_option lindstrom_turk_options[] = {
    {"e_e", "edges at which to stop; default: when `error` says so", 5, 1e9, NAN, 0, true},
    {"error", "largest vertical error, metres; default: the zoom's --error", 0, 1e7, 0, 1, false},
    {"bound", "1: `error` holds at every post, 0: it is not looked at; default 1, with e_e 0", 0, 1, NAN, 0, true},
    {"e_v", "weight of volumes; default 0.5", 0, 1e9, 0.5, 0, false},
    {"e_b", "weight of areas along free borders, of which a pyramid has none; default 0.5", 0, 1e9, 0.5, 0, false},
    {"e_s", "weight of lengths, which keeps triangles round on level ground; default 1e-10", 0, 1e9, 1e-10, 0, false},
};

static const char *contradiction_lindstrom_turk(const double values[]) {
    if (isnan(values[0]) && values[2] == 0) return "bound=0 wants e_e=5 or more, to know where to stop";
    return values[3] + values[4] + values[5] > 0 ? NULL : "e_v, e_b and e_s are all 0: every collapse would be as good";
}

static enum scree_status run_lindstrom_turk(struct scree_memory *memory, const struct method_tile *tile,
                                            const double values[], struct method_mesh *mesh,
                                            struct scree_error *error) {
    bool by_edges = !isnan(values[0]), bounded = isnan(values[2]) ? !by_edges : values[2] != 0;
    const struct method_lindstrom_turk_options options = {.edges = by_edges ? (uint32_t)values[0] : 0,
                                                          .is_bounded = bounded,
                                                          .tolerance_m = values[1],
                                                          .weights = {values[3], values[4], values[5]},
                                                          .codes = {(int64_t)TILE_CELLS * tile->cell_span, 0, 0}};
    return method_lindstrom_turk(memory, tile, &options, mesh, error);
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

/* ---- point sets ---- */

/* What all four have behind their own options. */
#define OPTION_P_E \
    { "p_e", "error of feature lines in space, metres; default: the zoom's --error", 0, 1e7, 0, 1, false }
#define OPTION_P_M \
    { "p_m", "edges that a feature line has at least; default 5", 1, 1e6, FEATURE_EDGES, 0, true }
#define OPTION_ANGLE \
    { "angle", "of a feature edge, degrees; default 60; 180: none is", 1, 180, FEATURE_ANGLE_DEG, 0, false }
#define OPTION_CUBE \
    { "cube", "1: measure the angle in a tile stretched to a cube; default 0", 0, 1, 0, 0, true }
#define OPTION_SEED \
    { "seed", "of what is random; default 0", 0, 4294967295.0, 0, 0, true }

static struct point_set_options point_set_values(const double values[]) {
    return (struct point_set_options){
        .features = {.least_edges = (int32_t)values[1], .angle_deg = values[2], .in_unit_cube = values[3] != 0},
        .line_tolerance_m = values[0],
        .seed = (uint64_t)values[4]};
}

static const struct method_option random_options[] = {
    {"r_r", "posts to remove, percent; default 95", 0, 100, 95, 0, false},
    OPTION_P_E,
    OPTION_P_M,
    OPTION_ANGLE,
    OPTION_CUBE,
    OPTION_SEED,
};

static enum scree_status run_random(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                    struct method_mesh *mesh, struct scree_error *error) {
    const struct method_random_options options = {.removed_percent = values[0], .points = point_set_values(values + 1)};
    return method_random(memory, tile, &options, mesh, error);
}

static const struct method_option grid_options[] = {
    {"d_g", "side of a cell, metres; default: 8 posts apart", 1e-3, 1e8, NAN, 0, false},
    OPTION_P_E,
    OPTION_P_M,
    OPTION_ANGLE,
    OPTION_CUBE,
    OPTION_SEED,
};

static enum scree_status run_grid(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                  struct method_mesh *mesh, struct scree_error *error) {
    double eight_posts_m = 8 * tile->cell_span * 0.5 * (tile->east_m + tile->north_m);
    const struct method_grid_options options = {.cell_m = isnan(values[0]) ? eight_posts_m : values[0],
                                                .points = point_set_values(values + 1)};
    return method_grid(memory, tile, &options, mesh, error);
}

static const struct method_option hierarchy_options[] = {
    {"h_v", "largest surface variation of a cluster; default 0.01", 0, 1.0 / 3, 0.01, 0, false},
    {"h_c", "most posts in a cluster; default 100", 1, 1e9, 100, 0, true},
    OPTION_P_E,
    OPTION_P_M,
    OPTION_ANGLE,
    OPTION_CUBE,
    OPTION_SEED,
};

static enum scree_status run_hierarchy(struct scree_memory *memory, const struct method_tile *tile,
                                       const double values[], struct method_mesh *mesh, struct scree_error *error) {
    const struct method_hierarchy_options options = {
        .most_variation = values[0], .most_posts = (uint32_t)values[1], .points = point_set_values(values + 2)};
    return method_hierarchy(memory, tile, &options, mesh, error);
}

static const struct method_option wlop_options[] = {
    {"w_p", "posts to retain, percent; default 5", 0, 100, 5, 0, false},
    {"w_r", "radius in which neighbours count, metres, at most 32 posts; default: 8 posts", 1e-3, 1e8, NAN, 0, false},
    {"w_i", "iterations; default 15", 1, 1000, WLOP_ITERATIONS, 0, true},
    OPTION_P_E,
    OPTION_P_M,
    OPTION_ANGLE,
    OPTION_CUBE,
    OPTION_SEED,
};

static enum scree_status run_wlop(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                                  struct method_mesh *mesh, struct scree_error *error) {
    const struct method_wlop_options options = {.kept_percent = values[0],
                                                .radius_m = isnan(values[1]) ? 0 : values[1],
                                                .iterations = (int32_t)values[2],
                                                .points = point_set_values(values + 3)};
    return method_wlop(memory, tile, &options, mesh, error);
}

/* ---- the table ---- */

/* name, what it is good for, its options, contradictions, run */
const struct method method_table[] = {
    {"greedy", "Garland and Heckbert's insertion: fast, keeps to a vertical error", OPTIONS(greedy_options), NULL,
     run_greedy},
    {"qem", "Scree's own collapse on the posts of a zoom: few triangles within a vertical error", OPTIONS(qem_options),
     contradiction_qem, run_qem},
    {"qem-fit", "the same, then fitted to the posts by least squares: least error in the mean", OPTIONS(qem_options),
     contradiction_qem, run_qem_fit},
    {"lindstrom-turk", "Lindstrom and Turk's edge collapse: vertices between the posts, smooth and close in the mean",
     OPTIONS(lindstrom_turk_options), contradiction_lindstrom_turk, run_lindstrom_turk},
    {"quadtree", "Cifuentes' quadtree of leaves with little curvature: quick, holds no bound",
     OPTIONS(quadtree_options), NULL, run_quadtree},
    {"random", "random posts between feature lines: the floor for all others", OPTIONS(random_options), NULL,
     run_random},
    {"grid", "a random post out of each cell of a grid, between feature lines", OPTIONS(grid_options), NULL, run_grid},
    {"hierarchy", "Pauly's clusters of posts that are small and flat, between feature lines",
     OPTIONS(hierarchy_options), NULL, run_hierarchy},
    {"wlop", "Huang's projection: evenly spread and smoothed, for noisy terrain", OPTIONS(wlop_options), NULL,
     run_wlop},
    {NULL, NULL, 0, NULL, NULL, NULL},
};
