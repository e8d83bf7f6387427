/* Any tile, whatever it was made of: from rung to rung, and up. */
#include "lod/tile.h"

#include "lod/code_collapse.h"
#include "lod/quadric.h"
#include "lod/tile_lines.h"
#include "lod/tile_samples.h"

#include <math.h>
#include <string.h>

#define ROUNDING_SHARE 0.125f /* of the tolerance, for what position codes may move */

/* A code is off by half a step at the most. */
static float rounding_steps(struct code_frame codes) {
    return (float)(0.5 * (double)codes.span / POSITION_TOP);
}

struct samples tile_samples_written(const struct tile *tile, struct code_frame codes, double tolerance_m) {
    struct samples samples = tile->samples;
    samples.rounding_steps = rounding_steps(codes);
    samples.rounding_limit_m = ROUNDING_SHARE * (float)tolerance_m;
    return samples;
}

void tile_set_codes(struct tile *tile, struct code_frame codes) {
    tile->simplifier.options.codes = codes;
    tile->simplifier.samples.rounding_steps = rounding_steps(codes);
}

/* The first rung to come has come, as far as the border goes. */
static void look_further(struct tile *tile) {
    tile->ahead.next++;
    if (tile->ahead.next == tile->ahead.count) tile->simplifier.options.ahead = NULL;
}

static enum scree_status advance(struct tile *tile, double tolerance_m, bool written, struct scree_error *error) {
    struct simplifier *simplifier = &tile->simplifier;
    bool looks_ahead = simplifier->options.ahead != NULL;
    float bound_m = looks_ahead ? tile->ahead.rungs[tile->ahead.next].tolerance_m : (float)tolerance_m;
    simplifier->samples.rounding_limit_m = looks_ahead && !written ? 0 : ROUNDING_SHARE * bound_m;
    tile_lines_reduce(tile->lines, tolerance_m, tile->geometry.locked_step,
                      written ? &simplifier->options.codes : NULL);
    enum scree_status status =
        border_collapse(simplifier, tile->lines, tile->geometry.columns, tile->geometry.rows, bound_m, error);
    if (status != SCREE_OK) return status;
    if (looks_ahead) look_further(tile);
    simplify_interior(simplifier, bound_m);
    if (!written || code_collapse(simplifier) == 0) return SCREE_OK;
    return scree_fail(error, SCREE_E_LIMIT, "a tile's triangles are too small for the position codes of a coarse zoom");
}

enum scree_status tile_advance(struct tile *tile, double tolerance_m, struct scree_error *error) {
    return advance(tile, tolerance_m, true, error);
}

enum scree_status tile_advance_between(struct tile *tile, double tolerance_m, struct scree_error *error) {
    return advance(tile, tolerance_m, false, error);
}

/* The rounding of positions comes with a written rung; room is left for it in the rungs before. */
static float bound_of(const struct tile_rung *rung) {
    if (rung->codes.span != 0) return (float)rung->tolerance_m;
    const struct tile_rung *written = rung;
    while (written->codes.span == 0) written++;
    return fminf((float)rung->tolerance_m, (1 - ROUNDING_SHARE) * (float)written->tolerance_m);
}

enum scree_status tile_look_ahead(struct tile *tile, const struct tile_rung *rungs, int count,
                                  struct scree_error *error) {
    struct ahead *ahead = &tile->ahead;
    ahead->rungs = scree_allocate(tile->memory, (size_t)count, sizeof *ahead->rungs, "rungs to come", error);
    if (ahead->rungs == NULL) return SCREE_E_MEMORY;
    ahead->columns = tile->geometry.columns;
    ahead->rows = tile->geometry.rows;
    ahead->count = count;
    for (int i = 0; i < count; i++) {
        struct ahead_rung *rung = &ahead->rungs[i];
        rung->tolerance_m = bound_of(&rungs[i]);
        rung->codes = rungs[i].codes;
        rung->samples = tile->samples;
        rung->samples.rounding_steps = rounding_steps(rung->codes);
        rung->samples.rounding_limit_m = ROUNDING_SHARE * rung->tolerance_m;
        memcpy(rung->lines, i == 0 ? tile->lines : rung[-1].lines, sizeof rung->lines);
        tile_lines_reduce(rung->lines, rungs[i].tolerance_m, tile->geometry.locked_step,
                          rung->codes.span != 0 ? &rung->codes : NULL);
    }
    tile->simplifier.options.ahead = ahead;
    return SCREE_OK;
}

double tile_max_error_m(const struct tile *tile) {
    return mesh_max_error_m(&tile->mesh, &tile->samples);
}

double tile_mmqe_m2(const struct tile *tile) {
    return quadric_mmqe_m2(&tile->mesh, &tile->samples, tile->geometry.east_m, tile->geometry.north_m);
}

enum scree_status tile_hand_up_new(struct tile *tile, struct coarse_tile **coarse, struct scree_error *error) {
    enum scree_status status = mesh_export_new(tile->memory, &tile->mesh, &tile->rest->mesh, error);
    if (status != SCREE_OK) return status;
    memcpy(tile->rest->lines, tile->lines, sizeof tile->lines);
    tile->rest->max_error_m = tile_max_error_m(tile);
    if (tile->cell_first != NULL && tile->geometry.keeps_cells) tile_samples_hand_up(tile);
    *coarse = tile->rest;
    tile->rest = NULL;
    return SCREE_OK;
}

void tile_release(struct tile *tile) {
    if (tile == NULL || tile->memory == NULL) return;
    if (tile->simplifier.memory != NULL) simplifier_release(&tile->simplifier);
    coarse_tile_free(tile->memory, tile->rest);
    slope_grid_release(tile->memory, &tile->slopes);
    scree_release(tile->memory, tile->extremes);
    scree_release(tile->memory, tile->cell_first);
    scree_release(tile->memory, tile->posts);
    scree_release(tile->memory, tile->east_drop_m);
    scree_release(tile->memory, tile->ahead.rungs);
    mesh_release(tile->memory, &tile->mesh);
    memset(tile, 0, sizeof *tile);
}

void coarse_tile_free(struct scree_memory *memory, struct coarse_tile *coarse) {
    if (coarse == NULL) return;
    scree_release(memory, coarse->mesh.corners);
    scree_release(memory, coarse->mesh.vertices);
    scree_release(memory, coarse->fitted.mesh.corners);
    scree_release(memory, coarse->fitted.mesh.vertices);
    slope_grid_release(memory, &coarse->slopes);
    scree_release(memory, coarse->extremes);
    scree_release(memory, coarse->cell_first);
    scree_release(memory, coarse);
}
