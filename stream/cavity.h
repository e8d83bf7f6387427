/* Which triangles make way for a vertex: a walk outwards from the one that holds it, told edge by edge. Pure.
 *
 * A step over an edge is offered only where the vertex sees both edges beyond from inside, so whatever bits are read,
 * the fan around the vertex is counter-clockwise, and no triangle is met twice: of the edges of one that the vertex
 * does not lie in, it sees just one from outside. */
#ifndef SCREE_STREAM_CAVITY_H
#define SCREE_STREAM_CAVITY_H

#include "stream/range_coder.h"
#include "stream/surface.h"

#define CAVITY_ANGLES 8 /* classes; a power of two */

/* Whether the walk goes on over an edge: by whether the cavity stays a fan, by how many triangles it has, and by how
 * much Delaunay would have the edge flipped. */
struct cavity_models {
    struct bit_model inside[2][4][CAVITY_ANGLES];
};
void cavity_models_start(struct cavity_models *models);

struct cavity_walk {
    struct range_coder *coder;
    struct cavity_models *models;
    const struct surface *surface;
    /* asked when writing: whether the edge between two vertices is inside the polygon of the vertex at hand */
    bool (*is_inside)(void *context, uint32_t from, uint32_t to);
    void *context;
};

/* Codes the cavity of a place that belongs to the triangle. */
void cavity_code(const struct cavity_walk *walk, uint32_t triangle, const struct scree_vertex *at,
                 struct cavity *cavity);

/* Where the vertex comes out of when the scale changes: the corner about which the cavity is a fan; the nearest where
 * there are several, or none. After surface_insert. */
uint32_t cavity_parent(const struct surface *surface, const struct cavity *cavity, const struct scree_vertex *at);

#endif
