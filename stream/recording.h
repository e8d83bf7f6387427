/* A simplification as it went: what the recorder of lod/ hands to the encoder. Plain arrays, fine to coarse.
 *
 * A removal takes one vertex out of the mesh: the triangles around it go, and the polygon of its neighbours is
 * triangulated anew, in whatever way. Read backwards it is an insertion: the triangles inside the polygon give way to
 * the fan of the polygon's edges around the vertex. So a removal is told by its polygon alone. */
#ifndef SCREE_STREAM_RECORDING_H
#define SCREE_STREAM_RECORDING_H

#include <scree/mesh.h>
#include <stdbool.h>
#include <stdint.h>

struct recording_removal {
    uint32_t vertex;
    uint32_t ring_first; /* into `ring` */
    uint32_t ring_count; /* neighbours, counter-clockwise; of a border vertex from the one that follows it on the
                            border to the one before it */
    bool open;           /* a border vertex */
};

/* The mesh at a rung. */
struct recording_rung {
    int32_t rung;      /* L of the ladder */
    uint32_t removals; /* done when the mesh has come to this rung */
    float mmqe_m2;     /* mean minimum quadric error */
    float max_error_m; /* measured */
};

struct recording {
    /* all vertices of the finest rung by their number; numbers of vertices that are not part of it are not used */
    uint32_t vertex_count;
    const struct scree_vertex *vertices; /* lattice steps from the tile's south-western corner; height units */
    uint32_t removal_count;
    const struct recording_removal *removals; /* in the order in which they were done */
    const uint32_t *ring;
    uint32_t rung_count;
    const struct recording_rung *rungs; /* fine to coarse; the first has removals 0, the last is the base mesh */
    /* Removals beyond the base: they go on down to the tile's four corners, without regard to error, so that the base
     * is written by the same means. Each stage is a layer of some of the vertices. */
    uint32_t stage_count;
    const uint32_t *stage_removals; /* removals done at the end of each stage; the last is removal_count */
    uint32_t corners[4];            /* what is left: south-west, south-east, north-west, north-east */
    bool rising;                    /* of the two triangles left: the diagonal goes from south-west to north-east */
};

#endif
