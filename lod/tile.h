/* A tile on its way from fine to coarse: made of posts or of its four children, taken down rung by rung, and handed up
 * to its parent. Pure.
 *
 * A tile of the finest zoom is measured against its posts or its TIN's points, a coarser one against the extremes of
 * its cells (lod/samples.h). A tile at its finest rung is the union of its children at their coarsest, vertex for
 * vertex. */
#ifndef SCREE_LOD_TILE_H
#define SCREE_LOD_TILE_H

#include "lod/ahead.h"
#include "lod/border_collapse.h"
#include "lod/simplify.h"
#include "lod/slopes.h"
#include "lod/tin_piece.h"

/* Where a tile is and how its lattice steps become metres. */
struct tile_geometry {
    int32_t columns, rows; /* lattice steps that the tile covers */
    int32_t cell_span;     /* lattice steps of a cell: 1 at the finest zoom, doubling with each coarser one */
    bool keeps_cells;      /* the parent has cells of the same span: a TIN's tiles until there are enough of them */
    double height_unit_m;
    double east_m, north_m;   /* metres of a step, at the row where eastward steps are longest */
    const float *east_drop_m; /* see struct samples; copied; NULL: the Earth is flat */
    float north_drop_m;
    double side_drop_m[SIDE_COUNT]; /* the same along each border line; equal for both tiles of a line */
    int64_t locked_step;            /* see simplify_options */
};

struct tile {
    struct scree_memory *memory;
    struct tile_geometry geometry;
    struct mesh mesh;
    struct samples samples;
    struct simplifier simplifier;
    struct border_line lines[SIDE_COUNT];
    struct ahead ahead;       /* rungs that must stay within reach */
    struct slope_grid slopes; /* at the corners of the cells */
    float *east_drop_m;
    float *posts;             /* of a tile of posts: else NULL */
    struct sample *extremes;  /* else; of a tile of a TIN's, all of its samples */
    uint32_t *cell_first;     /* of a tile of a TIN's: see struct samples; else NULL */
    struct coarse_tile *rest; /* what will be handed up, but for the mesh and the lines */
};

/* A mesh for a static tile alone, see lod/tile_fit.h. */
struct fitted_tile {
    struct scree_mesh mesh; /* empty: nothing has been fitted */
    double max_error_m;     /* against the samples of the tiles that it was fitted to */
    double mmqe_m2;
};

/* What a tile at its coarsest rung leaves to its parent. */
struct coarse_tile {
    int32_t columns, rows; /* lattice steps */
    int32_t cell_span;     /* of the parent's cells */
    int32_t cell_columns, cell_rows;
    struct sample *extremes;  /* 2 a cell: lowest, highest; heights in metres */
    uint32_t *cell_first;     /* not NULL: `extremes` are all samples, any number a cell, as of struct samples */
    struct slope_grid slopes; /* at the corners of the parent's cells */
    struct scree_mesh mesh;
    struct border_line lines[SIDE_COUNT];
    double max_error_m;        /* of the mesh, against the samples of the tile that left it */
    struct fitted_tile fitted; /* the mesh once more, fitted; empty when nobody asked */
};

/* Heights of a tile of the finest zoom, with a margin of one post on every side for the slopes. */
struct tile_posts {
    const float *heights_m; /* of post (0, 0); rows of `stride` floats, from the south; posts -1 .. columns + 1 exist */
    int32_t stride;
    const double *east_m, *north_m; /* metres of a step at row y, for the slopes: rows + 1 of them */
};

/* geometry->cell_span must be 1. */
enum scree_status tile_from_posts(struct scree_memory *memory, const struct tile_geometry *geometry,
                                  const struct tile_posts *posts, struct tile *tile, struct scree_error *error);

/* A tile of the finest zoom out of a TIN. cell_span may be anything; about one point a cell is fast. */
enum scree_status tile_from_tin(struct scree_memory *memory, const struct tile_geometry *geometry,
                                const struct tin_piece *piece, struct tile *tile, struct scree_error *error);

/* A tile without data, all posts at one height. It starts from a grid of `step` lattice steps, a power of two that
 * divides the tile; any step as fine as its border lines will keep gives the same borders. */
enum scree_status tile_from_level(struct scree_memory *memory, const struct tile_geometry *geometry, int32_t step,
                                  double height_m, struct tile *tile, struct scree_error *error);

/* From now on vertices at multiples of `locked_step`, and no others, are locked (see simplify_options). The tile looks
 * at no rungs to come and is not observed. */
enum scree_status tile_lock(struct tile *tile, int64_t locked_step, struct scree_error *error);

/* Children in the order south-west, south-east, north-west, north-east; NULL outside of the lattice. They stay the
 * caller's. */
enum scree_status tile_from_children(struct scree_memory *memory, const struct tile_geometry *geometry,
                                     const struct coarse_tile *const children[4], struct tile *tile,
                                     struct scree_error *error);

/* The side of a child that no window cuts, in lattice steps. */
int32_t tile_child_span(const struct coarse_tile *const children[4]);

/* Which written form the coming rungs end in. */
void tile_set_codes(struct tile *tile, struct code_frame codes);

/* Takes the tile down to a tolerance: first its borders, then its interior. Tolerances must not fall. */
enum scree_status tile_advance(struct tile *tile, double tolerance_m, struct scree_error *error);

/* The same for a rung on the way to a written one: triangles that position codes turn over are left to that one. */
enum scree_status tile_advance_between(struct tile *tile, double tolerance_m, struct scree_error *error);

/* A rung to come. */
struct tile_rung {
    double tolerance_m;
    struct code_frame codes; /* of the written form; span 0: it is not written */
};

/* For a tile that still is its full grid of posts, or all of its TIN: the coming rungs are exactly these, the last a
 * written one. Every rung leaves the next ones within reach, so all of them are within their tolerances, whatever their
 * border lines drop. */
enum scree_status tile_look_ahead(struct tile *tile, const struct tile_rung *rungs, int count,
                                  struct scree_error *error);

/* What a mesh of the tile is measured against that is written in `codes` within a tolerance. */
struct samples tile_samples_written(const struct tile *tile, struct code_frame codes, double tolerance_m);

/* What holds now: the largest error over all samples, and the mean minimum quadric error. */
double tile_max_error_m(const struct tile *tile);
double tile_mmqe_m2(const struct tile *tile);

/* Hands the tile up: `coarse` gets what the parent needs. The tile keeps nothing of it and is to be released. */
enum scree_status tile_hand_up_new(struct tile *tile, struct coarse_tile **coarse, struct scree_error *error);

/* Both are fine on zeroed structs and on NULL. */
void tile_release(struct tile *tile);
void coarse_tile_free(struct scree_memory *memory, struct coarse_tile *coarse);

#endif
