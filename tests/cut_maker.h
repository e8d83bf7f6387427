/* Random cuts of a quadtree, with a small mesh of its own making for each tile: border vertices are a function of their
 * place and of the tile's scale, nested from scale to scale, as a build leaves them. */
#ifndef SCREE_TESTS_CUT_MAKER_H
#define SCREE_TESTS_CUT_MAKER_H

#include <scree/cut.h>
#include <scree/stitch.h>
#include <stdbool.h>

#define CUT_FINEST     3 /* zoom */
#define CUT_TILE_STEPS 8 /* of a tile of the finest zoom */
#define CUT_MOST_TILES 128
#define CUT_RUNGS      16

#define CUT_MOST_VERTICES  320
#define CUT_MOST_TRIANGLES 640

/* A tile with its mesh; it must not be moved. */
struct cut_tile {
    struct scree_tile_id id;
    int64_t x, y; /* of its south-western corner, in the lattice */
    struct scree_stream_header header;
    uint32_t vertex_count, triangle_count;
    struct scree_vertex vertices[CUT_MOST_VERTICES];
    uint32_t indices[3 * CUT_MOST_TRIANGLES];
    uint32_t border_vertices[SCREE_SIDES][CUT_MOST_VERTICES], border_apexes[SCREE_SIDES][CUT_MOST_VERTICES];
    struct scree_stitch_tile view;
};

struct cut {
    enum scree_profile profile;
    int64_t columns, rows; /* steps that all tiles cover */
    uint32_t count;
    struct scree_tile_id ids[CUT_MOST_TILES]; /* sorted */
    struct cut_tile tiles[CUT_MOST_TILES];    /* in the same order */
};

/* Tiles of a random cut: the globe, or a local rectangle of which tiles may be cut. With `holes`, some are missing. */
void cut_make_ids(uint64_t *state, bool holes, struct cut *cut);

/* Their meshes, each at a scale of its own. Stops the test program when a tile has too many vertices. */
void cut_make_meshes(uint64_t *state, struct cut *cut);

/* Makes the borders of a tile's mesh and what refers to it. */
void cut_tile_finish(struct cut_tile *tile);

/* A reproducible number from 0 to below `limit`. */
int32_t cut_number(uint64_t *state, int32_t limit);

#endif
