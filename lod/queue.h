/* A queue of vertices by cost, in classes of a factor of two; first in, first out within a class. Pure.
 *
 * Exact order within a class buys nothing in quality (measured: vertices at equal error differ by less than half a
 * percent), while first-in-first-out walks the tile in order, so that neighbours are still in the cache. Costs below
 * the queue's least class are all alike. */
#ifndef SCREE_LOD_QUEUE_H
#define SCREE_LOD_QUEUE_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stdint.h>

#define QUEUE_CLASSES 48
#define QUEUE_NONE    (-1)

struct queue {
    float least_cost; /* upper end of class 0 */
    int32_t current;  /* the class that vertices are taken from; never falls until the queue is reset */
    int32_t head[QUEUE_CLASSES];
    int32_t tail[QUEUE_CLASSES];
    int32_t *next; /* one a vertex */
};

enum scree_status queue_allocate(struct scree_memory *memory, int32_t vertex_count, struct queue *queue,
                                 struct scree_error *error);
void queue_release(struct scree_memory *memory, struct queue *queue);

/* Empties the queue. */
void queue_reset(struct queue *queue, float least_cost);

/* The class of a cost, at least the current one. */
int32_t queue_class(const struct queue *queue, float cost);

/* Appends a vertex that is in no class now. */
void queue_push(struct queue *queue, int32_t vertex, int32_t cost_class);

/* Takes the first vertex of the cheapest class that has one; QUEUE_NONE when all are empty. */
int32_t queue_pop(struct queue *queue);

#endif
