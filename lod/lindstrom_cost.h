/* What collapsing an edge costs and where its vertex goes, from nothing but the triangles around the edge. Pure.
 *
 * P. Lindstrom and G. Turk, "Fast and Memory Efficient Polygonal Simplification" (Visualization 1998), and "Evaluation
 * of Memoryless Simplification" (IEEE TVCG 5(2), 1999). The place is the meeting point of three planes, found one after
 * another: the volume under the surface stays the same; the squared volumes between the old triangles and the new ones
 * are least; where these leave a direction open (level or straight ground), the squared lengths of the new edges are
 * least. A plane counts only if it makes more than one degree with those before it (their alpha).
 *
 * All coordinates are relative to one origin near the edge, which keeps the sums free of cancellation. */
#ifndef SCREE_LOD_LINDSTROM_COST_H
#define SCREE_LOD_LINDSTROM_COST_H

#include <stdbool.h>

struct lindstrom_weights {
    double volume, boundary, shape;
};

/* Sums over the triangles, the border edges and the neighbours of an edge's two ends. */
struct lindstrom_sums {
    double normal[3], offset;                 /* of area normals n, and of n . corner: the volume */
    double hessian[6], gradient[3], constant; /* of n n^T (xx xy xz yy yz zz), (n . corner) n, (n . corner)^2 */
    double border_hessian[6], border_gradient[3], border; /* the same of squared areas swept along the border */
    double link[3], link_squares;                         /* of neighbours */
    int link_count;
};

/* A triangle by one of its corners and the two edges from there, counter-clockwise. */
void lindstrom_add_triangle(struct lindstrom_sums *sums, const double corner[3], const double edge[3],
                            const double other_edge[3]);
void lindstrom_add_border(struct lindstrom_sums *sums, const double from[3], const double to[3]);
void lindstrom_add_neighbour(struct lindstrom_sums *sums, const double at[3]);

/* Where the vertex goes; false when no three planes meet well. For edges inside: the border takes no part. */
bool lindstrom_place(const struct lindstrom_sums *sums, double place[3]);

/* What it costs to have it there: weighted squared volume, area along the border times the edge's length, and lengths
 * times its cube, all of the sixth power of a length. */
double lindstrom_cost(const struct lindstrom_sums *sums, const struct lindstrom_weights *weights, double squared_length,
                      const double place[3]);

#endif
