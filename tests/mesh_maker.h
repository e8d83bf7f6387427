/* Meshes for the tests of the simplifier, and the one check of all that has to hold for a mesh at any time. */
#ifndef SCREE_TESTS_MESH_MAKER_H
#define SCREE_TESTS_MESH_MAKER_H

#include "lod/mesh.h"

/* A connected grid of columns x rows cells, diagonals alternating, `step` lattice steps from vertex to vertex. Heights:
 * those of whole metres of `posts` (row by row from the south, one a lattice step, `stride` a row), or 0 for NULL.
 * Stops the test program when memory lacks. */
void make_grid_mesh(struct scree_memory *memory, int32_t columns, int32_t rows, int32_t step, const float *posts,
                    int32_t stride, struct mesh *mesh);

/* The same mesh in arrays of its own, dead slots included. */
void copy_mesh(struct scree_memory *memory, const struct mesh *mesh, struct mesh *copy);

/* What is wrong with a mesh of one simply connected piece whose area is columns x rows lattice steps, or NULL: twins
 * are mutual, every living vertex's edge starts there and is the border edge on the border, stars hold all triangles of
 * their vertex, Euler's sum is 1, areas are positive and add up. */
const char *mesh_fault(const struct mesh *mesh, int32_t columns, int32_t rows);

/* Whether two meshes have the same vertices and triangles, twins and edges in the same slots. */
bool same_meshes(const struct mesh *mesh, const struct mesh *other);

/* A reproducible number from 0 to below `limit`; `state` is any number, changed by each call. */
int32_t any_number(uint64_t *state, int32_t limit);

#endif
