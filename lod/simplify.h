/* The collapse: a mesh is taken to a coarser tolerance by half-edge collapses, each of them within the bound. Pure.
 *
 * Order and admission (design of Scree; quadrics: Garland and Heckbert 1997):
 *   - the quadric of a vertex's triangles proposes which neighbour it may go to;
 *   - the exact errors of the triangles that a collapse would make decide: it is admitted when none of them passes the
 *     tolerance, and the cheapest growth of the sum of squared errors goes first;
 *   - every remaining triangle keeps a strictly positive area in the lattice plane.
 * A vertex that the bound refuses is looked at again when its star changes or the tolerance grows.
 *
 * Border vertices leave only when the caller's border sets say so (lod/border.h), by lod/border_collapse.h. */
#ifndef SCREE_LOD_SIMPLIFY_H
#define SCREE_LOD_SIMPLIFY_H

#include "lod/mesh.h"
#include "lod/position_code.h"
#include "lod/queue.h"
#include "lod/samples.h"

/* Someone who watches the simplification, such as the recorder of lod/recorder.h. */
struct simplify_observer {
    void *context;
    /* Before anything at the star's vertex changes: it is about to go. Where edges are flipped first it is called with
     * the star as it was before the flips, and maybe once more after them. */
    void (*remove)(void *context, const struct star *star);
};

struct ahead;

struct simplify_options {
    int64_t locked_step;     /* vertices whose x and y are multiples of it never go; 0: none are locked */
    struct code_frame codes; /* triangles stay positive in these codes too; span 0: codes are not looked at */
    const struct simplify_observer *observer; /* NULL: nobody watches */
    const struct ahead *ahead;                /* rungs that must stay within reach (lod/ahead.h); NULL: none */
    bool is_unbounded;                        /* any error is admitted: the order alone decides */
    int32_t least_vertices;                   /* stop when no more than so many are alive; 0: go on */
};

struct simplifier {
    struct scree_memory *memory;
    struct mesh *mesh;
    struct samples samples;
    struct simplify_options options;
    struct queue queue;
    float tolerance_m;
    unsigned char *state; /* one a vertex, see simplify.c */
    int32_t *order;       /* of vertices: in which they are looked at first */
    int32_t *target;      /* the neighbour that a vertex would go to */
    float *refused_m;     /* the tolerance below which it cannot go */
};

/* `mesh`, connected and with the errors of its triangles set, is borrowed until simplifier_release. */
enum scree_status simplifier_start(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                                   const struct simplify_options *options, struct simplifier *simplifier,
                                   struct scree_error *error);
void simplifier_release(struct simplifier *simplifier);

/* Collapses interior vertices as far as the tolerance goes. Tolerances must not fall from call to call. */
void simplify_interior(struct simplifier *simplifier, float tolerance_m);

/* Collapses the star's vertex into its cheapest neighbour, if one is admissible at the present tolerance. */
bool simplify_vertex(struct simplifier *simplifier, const struct star *star);

/* Tells the observer that the star's vertex is about to go. */
void simplify_tell(const struct simplifier *simplifier, const struct star *star);

/* Whether a vertex may ever be collapsed: it is alive, inside, and not locked. */
bool simplifier_may_collapse(const struct simplifier *simplifier, int32_t vertex);

/* Tells that the stars of these vertices have changed. */
void simplifier_star_changed(struct simplifier *simplifier, const struct star *star);

/* The largest error of the living triangles, measured anew, with the vertices at their posts. */
double mesh_max_error_m(const struct mesh *mesh, const struct samples *samples);

/* Measures every living triangle anew. */
void mesh_measure(struct mesh *mesh, const struct samples *samples);

/* Triangles around a vertex. */
int32_t mesh_degree(const struct mesh *mesh, int32_t vertex);

#endif
