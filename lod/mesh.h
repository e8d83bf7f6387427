/* The working mesh of the simplifier: half-edges by index over flat arrays. Pure.
 *
 * A half-edge is 4 * triangle + corner (corner 0..2); it starts at that corner and runs counter-clockwise. A vertex
 * knows one outgoing half-edge; that of a border vertex is the border edge itself, so that turning counter-clockwise
 * from it visits the whole open star. */
#ifndef SCREE_LOD_MESH_H
#define SCREE_LOD_MESH_H

#include "lod/samples.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/mesh.h>

#define MESH_NONE       (-1)
#define MESH_MAX_DEGREE 1024 /* stars with more triangles are left alone: fans along a cliff are the largest */

struct mesh_vertex {
    struct sample at;
    int32_t edge; /* an outgoing half-edge; MESH_NONE: the vertex has been collapsed away */
};

struct mesh_triangle {
    int32_t vertex[3]; /* vertex[0] == MESH_NONE: the triangle has been collapsed away */
    float sum_squares_m2;
    int32_t twin[3]; /* the half-edge on the other side; MESH_NONE on the border */
    float max_m;     /* its error, as measured by samples_triangle_error */
};

struct mesh {
    int32_t vertex_capacity, triangle_capacity;
    int32_t vertex_count, triangle_count; /* slots in use, dead ones included */
    int32_t live_vertices, live_triangles;
    struct mesh_vertex *vertices;
    int32_t *heights; /* height units, one a vertex */
    struct mesh_triangle *triangles;
};

static inline int32_t mesh_next(int32_t edge) {
    return (edge & 3) == 2 ? edge - 2 : edge + 1;
}
static inline int32_t mesh_previous(int32_t edge) {
    return (edge & 3) == 0 ? edge + 2 : edge - 1;
}
static inline int32_t mesh_origin(const struct mesh *mesh, int32_t edge) {
    return mesh->triangles[edge >> 2].vertex[edge & 3];
}
static inline int32_t mesh_twin(const struct mesh *mesh, int32_t edge) {
    return mesh->triangles[edge >> 2].twin[edge & 3];
}

/* The triangles around a vertex, counter-clockwise: triangle i is (vertex, ring[i], ring[i + 1]). */
struct star {
    int32_t vertex;
    int32_t degree;                    /* triangles */
    bool open;                         /* a border vertex: ring[0] follows and ring[degree] precedes it on the border */
    int32_t edge[MESH_MAX_DEGREE];     /* from the vertex to ring[i] */
    int32_t ring[MESH_MAX_DEGREE + 1]; /* closed stars: ring[degree] == ring[0] */
    struct sample at[MESH_MAX_DEGREE + 1];
};

/* Fills `star`; false when the vertex has more than MESH_MAX_DEGREE triangles. */
bool mesh_star(const struct mesh *mesh, int32_t vertex, struct star *star);

/* Half-edge collapse of the star's vertex into ring[target]: an open star's target must be 0 or degree. The caller has
 * seen to it that all remaining triangles keep a positive area. Their errors are not updated. */
void mesh_collapse(struct mesh *mesh, const struct star *star, int32_t target);

/* Turns the edge between two triangles into the other diagonal of their quadrilateral, which must be convex. The edge's
 * triangle becomes (far corner of its twin, its own third corner, its origin), the twin's the rest. */
void mesh_flip(struct mesh *mesh, int32_t edge);

enum scree_status mesh_allocate(struct scree_memory *memory, int32_t vertex_capacity, int32_t triangle_capacity,
                                struct mesh *mesh, struct scree_error *error);
void mesh_release(struct scree_memory *memory, struct mesh *mesh);

/* A copy, with the same numbers; to be released like any mesh. */
enum scree_status mesh_copy(struct scree_memory *memory, const struct mesh *mesh, struct mesh *copy,
                            struct scree_error *error);

/* Joins the half-edges of a mesh whose triangles' corners are set, and gives every vertex its outgoing edge.
 * SCREE_E_CORRUPT when an edge has more than one triangle on a side or a border vertex more than one open star. */
enum scree_status mesh_connect(struct scree_memory *memory, struct mesh *mesh, struct scree_error *error);

/* A copy of what is alive, in the order of the slots: for writers, and for the next zoom. Release both arrays of the
 * copy with scree_release. */
enum scree_status mesh_export_new(struct scree_memory *memory, const struct mesh *mesh, struct scree_mesh *copy,
                                  struct scree_error *error);

#endif
