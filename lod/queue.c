#include "lod/queue.h"

#include <math.h>

enum scree_status queue_allocate(struct scree_memory *memory, int32_t vertex_count, struct queue *queue,
                                 struct scree_error *error) {
    queue->next = scree_allocate(memory, (size_t)vertex_count, sizeof *queue->next, "the queue", error);
    queue_reset(queue, 1);
    return queue->next != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

void queue_release(struct scree_memory *memory, struct queue *queue) {
    scree_release(memory, queue->next);
    queue->next = NULL;
}

void queue_reset(struct queue *queue, float least_cost) {
    queue->least_cost = least_cost;
    queue->current = 0;
    for (int i = 0; i < QUEUE_CLASSES; i++) queue->head[i] = queue->tail[i] = QUEUE_NONE;
}

int32_t queue_class(const struct queue *queue, float cost) {
    int exponent = 0;
    float ratio = cost / queue->least_cost;
    if (ratio >= 1) frexpf(ratio, &exponent);
    if (!(ratio < 1e14f) || exponent > QUEUE_CLASSES - 1) exponent = QUEUE_CLASSES - 1;
    return exponent > queue->current ? exponent : queue->current;
}

void queue_push(struct queue *queue, int32_t vertex, int32_t class) {
    queue->next[vertex] = QUEUE_NONE;
    if (queue->tail[class] == QUEUE_NONE)
        queue->head[class] = vertex;
    else
        queue->next[queue->tail[class]] = vertex;
    queue->tail[class] = vertex;
}

int32_t queue_pop(struct queue *queue) {
    while (queue->head[queue->current] == QUEUE_NONE) {
        if (queue->current == QUEUE_CLASSES - 1) return QUEUE_NONE;
        queue->current++;
    }
    int32_t vertex = queue->head[queue->current];
    queue->head[queue->current] = queue->next[vertex];
    if (queue->head[queue->current] == QUEUE_NONE) queue->tail[queue->current] = QUEUE_NONE;
    return vertex;
}
