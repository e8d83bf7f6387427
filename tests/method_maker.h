/* Tiles for the methods of the literature, made by code, and a judge of what they give: it shares no code with any of
 * them. */
#ifndef SCREE_TESTS_METHOD_MAKER_H
#define SCREE_TESTS_METHOD_MAKER_H

#include "lod/method.h"

/* A tile with what it points at; must not be moved. made_method_tile_free gives it back. */
struct made_method_tile {
    struct method_tile tile;
    struct border_line lines[SIDE_COUNT];
    float *heights_m;
};

/* How a tile is made. Zero is fine for all but columns and rows. */
struct method_recipe {
    int32_t columns, rows;        /* cells */
    int32_t cell_span;            /* 0: 1. Beyond 1 border lines have samples between the posts as well */
    double border_tolerance_m;    /* what the lines are reduced to */
    uint64_t seed;                /* of the fractal; 0: 7 */
    bool whole_metres;            /* round the fractal's heights */
    double metres_a_step;         /* 0: 30 */
    bool is_round;                /* an Earth with a drop; else a flat one */
    const float *given_heights_m; /* (rows + 1) x (columns + 1) heights instead of the fractal; NULL: the fractal */
};

/* Stops the test program when there is no memory. */
struct made_method_tile *made_method_tile_new(const struct method_recipe *recipe);
void made_method_tile_free(struct made_method_tile *made);

/* What a mesh is. */
struct method_verdict {
    bool is_triangulation; /* all that lod/method.h promises; else `fault` says what is wrong */
    const char *fault;
    double max_m, rms_m; /* over all posts, vertically, less the drop */
};
struct method_verdict method_judge(const struct method_tile *tile, const struct method_mesh *mesh);

/* Whether two meshes are the same, vertex for vertex and triangle for triangle. */
bool method_meshes_equal(const struct method_mesh *one, const struct method_mesh *other);

#endif
