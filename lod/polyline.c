#include "lod/polyline.h"

#include <math.h>

#define NONE CONSTRAINED_NONE

/* A point of a line: ends have no neighbour on one side. */
struct node {
    uint32_t previous, next;
    uint32_t heap_slot; /* NONE: not in the heap */
    bool is_blocked;    /* the topology holds it back */
    double cost_m;
};

struct work {
    const struct vector3 *places_m;
    struct constrained *triangulation;
    uint32_t *points; /* the lines', as they were */
    struct node *nodes;
    uint32_t *heap; /* nodes: the cheapest on top */
    uint32_t *blocked;
    uint32_t heap_count, blocked_count;
    double tolerance_m;
};

/* ---- a heap of nodes by cost, ties by number ---- */

static bool goes_before(const struct work *work, uint32_t a, uint32_t b) {
    double cost_a = work->nodes[a].cost_m, cost_b = work->nodes[b].cost_m;
    return cost_a < cost_b || (cost_a == cost_b && a < b);
}

static void heap_put(struct work *work, uint32_t slot, uint32_t node) {
    work->heap[slot] = node;
    work->nodes[node].heap_slot = slot;
}

/* Lets a node rise or sink from a free slot to where it belongs. */
static void heap_settle(struct work *work, uint32_t slot, uint32_t node) {
    while (slot > 0 && goes_before(work, node, work->heap[(slot - 1) / 2])) {
        heap_put(work, slot, work->heap[(slot - 1) / 2]);
        slot = (slot - 1) / 2;
    }
    for (;;) {
        uint32_t child = 2 * slot + 1;
        if (child >= work->heap_count) break;
        if (child + 1 < work->heap_count && goes_before(work, work->heap[child + 1], work->heap[child])) child++;
        if (!goes_before(work, work->heap[child], node)) break;
        heap_put(work, slot, work->heap[child]);
        slot = child;
    }
    heap_put(work, slot, node);
}

static void heap_remove(struct work *work, uint32_t node) {
    uint32_t slot = work->nodes[node].heap_slot;
    if (slot == NONE) return;
    work->nodes[node].heap_slot = NONE;
    uint32_t last = work->heap[--work->heap_count];
    if (last != node) heap_settle(work, slot, last);
}

static void heap_add(struct work *work, uint32_t node) {
    heap_settle(work, work->heap_count++, node);
}

/* ---- costs ---- */

static double distance_to_segment_m(struct vector3 at, struct vector3 a, struct vector3 b) {
    struct vector3 along = vector3_minus(b, a), from = vector3_minus(at, a);
    double length2 = vector3_dot(along, along), share = length2 > 0 ? vector3_dot(from, along) / length2 : 0;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    struct vector3 off = vector3_plus_scaled(from, -share, along);
    return sqrt(vector3_dot(off, off));
}

/* Prices a node that is no end, and files it if it may leave. */
static void price(struct work *work, uint32_t node) {
    struct node *n = &work->nodes[node];
    if (n->previous == NONE || n->next == NONE) return;
    struct vector3 a = work->places_m[work->points[n->previous]], b = work->places_m[work->points[n->next]];
    heap_remove(work, node);
    n->cost_m = 0;
    for (uint32_t i = n->previous + 1; i < n->next; i++)
        n->cost_m = fmax(n->cost_m, distance_to_segment_m(work->places_m[work->points[i]], a, b));
    if (n->cost_m <= work->tolerance_m) heap_add(work, node);
}

/* Takes out what the heap has; nodes that the topology holds back are set aside. Returns how many have left. */
static uint32_t drain(struct work *work) {
    uint32_t gone = 0;
    while (work->heap_count > 0) {
        uint32_t node = work->heap[0];
        struct node *n = &work->nodes[node];
        heap_remove(work, node);
        if (!constrained_shortcut(work->triangulation, work->points[node])) {
            if (!n->is_blocked) work->blocked[work->blocked_count++] = node;
            n->is_blocked = true;
            continue;
        }
        gone++;
        work->nodes[n->previous].next = n->next;
        work->nodes[n->next].previous = n->previous;
        price(work, n->previous);
        price(work, n->next);
        n->previous = n->next = NONE;
    }
    return gone;
}

/* What was held back may go after others have gone. */
static void try_blocked_again(struct work *work) {
    for (uint32_t i = 0; i < work->blocked_count; i++) {
        work->nodes[work->blocked[i]].is_blocked = false;
        price(work, work->blocked[i]);
    }
    work->blocked_count = 0;
}

static void set_up(struct work *work, const struct polylines *lines) {
    for (uint32_t line = 0; line < lines->line_count; line++) {
        uint32_t first = lines->starts[line], last = lines->starts[line + 1] - 1;
        for (uint32_t i = first; i <= last; i++)
            work->nodes[i] = (struct node){i > first ? i - 1 : NONE, i < last ? i + 1 : NONE, NONE, false, 0};
        for (uint32_t i = first; i <= last; i++) price(work, i);
    }
}

static void mark_gone(const struct work *work, struct polylines *lines) {
    for (uint32_t i = 0; i < lines->starts[lines->line_count]; i++)
        if (work->nodes[i].previous == NONE && work->nodes[i].next == NONE) lines->points[i] = NONE;
}

enum scree_status polylines_simplify(struct scree_memory *memory, const struct vector3 *places_m, double tolerance_m,
                                     struct constrained *triangulation, struct polylines *lines,
                                     struct scree_error *error) {
    struct work work = {places_m, triangulation, lines->points, .tolerance_m = tolerance_m};
    uint32_t count = lines->starts[lines->line_count];
    enum scree_status status = SCREE_E_MEMORY;
    work.nodes = scree_allocate(memory, count, sizeof *work.nodes, "points of lines", error);
    work.heap = scree_allocate(memory, count, sizeof *work.heap, "the queue of points of lines", error);
    work.blocked = scree_allocate(memory, count, sizeof *work.blocked, "the queue of points of lines", error);
    if (work.nodes == NULL || work.heap == NULL || work.blocked == NULL) goto cleanup;
    set_up(&work, lines);
    while (drain(&work) > 0 && work.blocked_count > 0) try_blocked_again(&work);
    mark_gone(&work, lines);
    status = SCREE_OK;
cleanup:
    scree_release(memory, work.blocked);
    scree_release(memory, work.heap);
    scree_release(memory, work.nodes);
    return status;
}
