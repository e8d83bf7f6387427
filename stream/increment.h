/* One layer of insertions, from one mesh to the next finer one, as both encoder and decoder go through it. Pure.
 *
 * First the places: for every triangle of the coarser mesh, how many of the new vertices lie in it, and on which posts.
 * Then the insertions, in the order of the places as far as it goes: a vertex whose polygon waits for others that are
 * still to come is put off to the next round. Of each: which triangles make way, as a walk outwards from the one that
 * holds it, and its height against the plane of that triangle.
 *
 * Whatever is read gives a triangulation whose triangles are all counter-clockwise: a step of the walk that would not
 * is never offered. */
#ifndef SCREE_STREAM_INCREMENT_H
#define SCREE_STREAM_INCREMENT_H

#include "stream/places.h"
#include "stream/range_coder.h"
#include "stream/surface.h"

struct increment_models;

/* What an encoder knows; all calls get its context. */
struct increment_plan {
    void *context;
    /* The places of this layer's vertices in a triangle, in ascending order of rows and columns; returns how many. */
    uint32_t (*places)(void *context, uint32_t triangle, const struct pending **places);
    /* Takes up the vertex at a place; false when it still waits for another one. */
    bool (*ready)(void *context, const struct pending *pending);
    /* Of the vertex taken up: its height, and whether the edge between two vertices is inside its polygon. */
    int32_t (*height)(void *context);
    bool (*is_inside)(void *context, uint32_t from, uint32_t to);
    /* Before and after the vertex taken up is inserted. */
    void (*inserting)(void *context, const struct cavity *cavity);
    void (*inserted)(void *context, const struct cavity *cavity);
};

struct increment {
    struct scree_memory *memory;
    struct range_coder *coder;
    struct surface *surface;
    struct increment_models *models;
    struct progressive *splits;        /* NULL: not wanted */
    const struct increment_plan *plan; /* NULL when reading */
    int32_t height_step;               /* all heights are multiples of it */
    struct cavity *cavity;
    struct pending *pending;
    uint32_t pending_count, pending_capacity;
    uint32_t *waiting;                  /* pending vertices of the present round */
    uint64_t steps_left, openings_left; /* what may still be looked at, and how many triangles may make way */
    double *position_bits, *connectivity_bits, *height_bits; /* see encode_bits; NULL: not wanted */
};

/* No bytes may cost a reader more time or memory than their number of vertices is worth. Over a whole stream, at most
 * STEPS_FREE + STEPS_PER_VERTEX x vertices edges and vertices are looked at, and at most OPENINGS_FREE +
 * OPENINGS_PER_VERTEX x vertices triangles make way: real ones take up to 100 steps and 3 to 7 openings a
 * vertex, and the simplifier makes no star of more than 48 triangles. */
#define INCREMENT_STEPS_FREE          (1 << 20)
#define INCREMENT_STEPS_PER_VERTEX    1024
#define INCREMENT_OPENINGS_FREE       4096
#define INCREMENT_OPENINGS_PER_VERTEX 48

/* Models and scratch for layers of up to `most` vertices. */
enum scree_status increment_start(struct scree_memory *memory, uint32_t most, struct surface *surface,
                                  struct increment *increment, struct scree_error *error);
void increment_release(struct increment *increment);

/* Scratch for layers of up to `most` vertices, if it lacks. False: no memory, with a line. */
bool increment_reserve(struct increment *increment, uint32_t most, struct scree_error *error);

/* Forgets what has been learned. */
void increment_forget(struct increment *increment);

/* Codes one layer of at most `most` vertices. */
enum scree_status increment_code(struct increment *increment, uint32_t most, struct scree_error *error);

#endif
