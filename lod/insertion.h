/* Greedy insertion after Garland and Heckbert, "Fast Polygonal Approximation of Terrains and Height Fields" (1995),
 * algorithm IV: a Delaunay triangulation gains, again and again, the post whose vertical error is the largest. Every
 * triangle knows its worst post, a heap knows the worst triangle, and only triangles that changed are scanned again.
 * Pure.
 *
 * Two methods are made of it: lod/greedy.h, with borders that are free, and lod/method_greedy.h, with given ones.
 *
 * The order of insertion is total (largest error first, ties by triangle), so the mesh depends on nothing but the posts
 * and the vertices that were placed first. */
#ifndef SCREE_LOD_INSERTION_H
#define SCREE_LOD_INSERTION_H

#include "lod/delaunay.h"

/* A rectangle of posts, `span` steps of the triangulation apart. */
struct insertion_posts {
    const float *heights_m; /* finite; rows of `stride` floats, from the south */
    int32_t columns, rows;  /* posts: at least 2 */
    int32_t stride, span;
    int32_t margin; /* posts this near to the border are never looked at: 1, the border is given; 0, it is free */
};

struct insertion_entry {
    double error_m;
    uint32_t triangle;
};

struct insertion {
    struct scree_memory *memory;
    struct insertion_posts posts;
    double tolerance_m;
    double cells_a_step;
    double rounding;      /* relative to the extent of a triangle; 0 where all heights are whole numbers */
    struct delaunay mesh; /* marks of its triangles: the worst post, the place in the heap */
    double *heights_m;    /* one a point of the mesh */
    struct insertion_entry *heap;
    uint32_t heap_count, capacity;
};

/* Begins with the two triangles between the corner posts. `largest_vertex_m`: the largest absolute height of vertices
 * that will be placed; `whole`: these heights are whole numbers. SCREE_E_ARGUMENT when a post's height is not finite.
 * To be released in any case. */
enum scree_status insertion_start(struct scree_memory *memory, const struct insertion_posts *posts,
                                  double largest_vertex_m, bool whole, struct insertion *insertion,
                                  struct scree_error *error);
void insertion_release(struct insertion *insertion);

/* Puts a vertex of one's own at a place; where there is one already, that one gets the height. */
enum scree_status insertion_place(struct insertion *insertion, struct delaunay_point point, double height_m,
                                  struct scree_error *error);

/* Inserts posts until none is farther than the tolerance from the surface, or there are `most_points` vertices. Once.
 */
enum scree_status insertion_run(struct insertion *insertion, double tolerance_m, uint32_t most_points,
                                struct scree_error *error);

/* The largest error that is left. */
double insertion_error_m(const struct insertion *insertion);

#endif
