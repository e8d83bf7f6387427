#include "src/extract_stitch.h"

#include <stdlib.h>
#include <string.h>

/* A directed edge of a triangle along a line of the lattice. */
struct side {
    bool is_upright; /* the line: x == at, or else y == at */
    bool is_rising;  /* the edge leads to larger coordinates */
    int64_t at, low, high;
    uint32_t triangle, from, to;
};

struct sides {
    uint32_t count;
    struct side *items;
};

/* ---- open edges ---- */

struct edge {
    uint32_t low, high; /* vertices */
    uint32_t triangle;
    bool is_rising; /* from low to high */
};

static int by_vertices(const void *left, const void *right) {
    const struct edge *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static struct edge *edges_new(struct scree_memory *memory, const struct extract_mesh *mesh, struct scree_error *error) {
    struct edge *edges =
        scree_allocate(memory, mesh->triangle_count, 3 * sizeof *edges, "the edges of the mesh", error);
    for (uint32_t t = 0; edges != NULL && t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)t;
        for (int k = 0; k < 3; k++) {
            uint32_t from = corners[k], to = corners[(k + 1) % 3];
            edges[3 * (size_t)t + (size_t)k] =
                (struct edge){from < to ? from : to, from < to ? to : from, t, from < to};
        }
    }
    if (edges != NULL) qsort(edges, 3 * (size_t)mesh->triangle_count, sizeof *edges, by_vertices);
    return edges;
}

/* An open edge as a side, when it runs along a line of the lattice. */
static bool side_of(const struct extract_mesh *mesh, const struct edge *edge, struct side *side) {
    uint32_t from = edge->is_rising ? edge->low : edge->high, to = edge->is_rising ? edge->high : edge->low;
    const struct extract_vertex *a = &mesh->vertices[from], *b = &mesh->vertices[to];
    int64_t around = extract_mesh_around(mesh), ax = a->x, bx = b->x;
    if (around != 0 && ax == 0 && bx > around / 2) ax = around; /* 0 is 360 degrees as well */
    if (around != 0 && bx == 0 && ax > around / 2) bx = around;
    if (ax != bx && a->y != b->y) return false;
    *side = (struct side){.is_upright = ax == bx, .triangle = edge->triangle, .from = from, .to = to};
    side->at = side->is_upright ? ax : a->y;
    int64_t begin = side->is_upright ? a->y : ax, end = side->is_upright ? b->y : bx;
    side->is_rising = begin < end;
    side->low = side->is_rising ? begin : end;
    side->high = side->is_rising ? end : begin;
    return true;
}

/* Along each line the rising sides, then the falling ones, from low to high. */
static int by_line(const void *left, const void *right) {
    const struct side *a = left, *b = right;
    if (a->is_upright != b->is_upright) return a->is_upright ? 1 : -1;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    if (a->is_rising != b->is_rising) return a->is_rising ? -1 : 1;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static enum scree_status sides_new(struct scree_memory *memory, const struct extract_mesh *mesh, struct sides *sides,
                                   struct scree_error *error) {
    size_t count = 3 * (size_t)mesh->triangle_count, open = 0;
    struct edge *edges = edges_new(memory, mesh, error);
    if (edges == NULL) return SCREE_E_MEMORY;
    for (size_t i = 0, next; i < count; i = next) { /* keeps the edges that have no opposite */
        for (next = i + 1; next < count && edges[next].low == edges[i].low && edges[next].high == edges[i].high;)
            next++;
        if (next == i + 1) edges[open++] = edges[i];
    }
    sides->items = scree_allocate(memory, open, sizeof *sides->items, "the open edges of the mesh", error);
    for (size_t i = 0; sides->items != NULL && i < open; i++)
        if (side_of(mesh, &edges[i], &sides->items[sides->count])) sides->count++;
    scree_release(memory, edges);
    if (sides->items == NULL) return SCREE_E_MEMORY;
    qsort(sides->items, sides->count, sizeof *sides->items, by_line);
    return SCREE_OK;
}

/* ---- fans ---- */

/* A coarse side, the triangle that has it, and the chain of finer sides that it faces. */
struct fan {
    uint32_t triangle, side;
    uint32_t first, end; /* of the chain */
};

struct fans {
    uint32_t count;
    struct fan *items;
};

static int by_triangle(const void *left, const void *right) {
    const struct fan *a = left, *b = right;
    if (a->triangle != b->triangle) return a->triangle < b->triangle ? -1 : 1;
    return a->side < b->side ? -1 : a->side > b->side;
}

/* Do the sides from `first` on lead from one end of `side` to the other, in more than one step? */
static bool find_chain(const struct sides *sides, const struct side *side, uint32_t first, uint32_t end,
                       struct fan *fan) {
    uint32_t vertex = side->is_rising ? side->from : side->to, last = side->is_rising ? side->to : side->from;
    uint32_t at = first;
    for (; at < end && vertex != last && sides->items[at].high <= side->high; at++) {
        const struct side *link = &sides->items[at]; /* it leads the other way */
        if ((side->is_rising ? link->to : link->from) != vertex) return false;
        vertex = side->is_rising ? link->from : link->to;
    }
    fan->first = first;
    fan->end = at;
    return vertex == last && at - first > 1;
}

/* Looks for fans among the sides of one direction of a line, [first, end), facing those of the other. */
static void face(const struct sides *sides, uint32_t first, uint32_t end, uint32_t other_first, uint32_t other_end,
                 struct fans *fans) {
    for (uint32_t i = first; i < end; i++) {
        const struct side *side = &sides->items[i];
        struct fan *fan = &fans->items[fans->count];
        while (other_first < other_end && sides->items[other_first].low < side->low) other_first++;
        if (!find_chain(sides, side, other_first, other_end, fan)) continue;
        fan->triangle = side->triangle;
        fan->side = i;
        fans->count++;
    }
}

static void find_fans(const struct sides *sides, struct fans *fans) {
    for (uint32_t first = 0, end; first < sides->count; first = end) {
        const struct side *line = &sides->items[first];
        uint32_t middle = first;
        for (end = first; end < sides->count; end++) {
            const struct side *side = &sides->items[end];
            if (side->is_upright != line->is_upright || side->at != line->at) break;
            if (side->is_rising) middle = end + 1;
        }
        face(sides, first, middle, middle, end, fans);
        face(sides, middle, end, first, middle, fans);
    }
}

/* The triangle (a, c, t) over the side a, c becomes (a, b1, t), (b1, b2, t) ... (bn, c, t). Returns the last one. */
static uint32_t put_fan(struct extract_mesh *mesh, const struct sides *sides, const struct fan *fan) {
    const struct side *side = &sides->items[fan->side];
    uint32_t *corners = mesh->corners + 3 * (size_t)fan->triangle, triangle = fan->triangle;
    int k = 0;
    while (corners[k] != side->from || corners[(k + 1) % 3] != side->to) k++;
    uint32_t apex = corners[(k + 2) % 3], before = side->from;
    for (uint32_t i = 1; i <= fan->end - fan->first; i++) {
        uint32_t link = side->is_rising ? fan->first + i - 1 : fan->end - i;
        uint32_t next = i == fan->end - fan->first ? side->to : sides->items[link].from;
        if (i > 1) triangle = mesh->triangle_count++;
        memcpy(mesh->corners + 3 * (size_t)triangle, (uint32_t[3]){before, next, apex}, 3 * sizeof *mesh->corners);
        before = next;
    }
    return triangle;
}

/* A triangle may have several coarse sides: that behind the fan's belongs to the fan's last triangle from then on. */
static void put_fans(struct extract_mesh *mesh, const struct sides *sides, struct fans *fans) {
    for (uint32_t i = 0; i < fans->count; i++) {
        uint32_t triangle = fans->items[i].triangle, last = put_fan(mesh, sides, &fans->items[i]);
        for (uint32_t j = i + 1; j < fans->count && fans->items[j].triangle == triangle; j++)
            if (sides->items[fans->items[j].side].from == sides->items[fans->items[i].side].to)
                fans->items[j].triangle = last;
    }
}

enum scree_status extract_mesh_stitch(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t *stitched,
                                      struct scree_error *error) {
    struct sides sides = {0};
    struct fans fans = {0};
    uint64_t more = 0;
    *stitched = 0;
    enum scree_status status = sides_new(memory, mesh, &sides, error);
    if (status != SCREE_OK) goto cleanup;
    fans.items = scree_allocate(memory, (size_t)sides.count + 1, sizeof *fans.items, "the borders to stitch", error);
    if (fans.items == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    find_fans(&sides, &fans);
    for (uint32_t i = 0; i < fans.count; i++) more += fans.items[i].end - fans.items[i].first - 1;
    status = extract_mesh_reserve(memory, mesh, 0, (uint32_t)more, error); /* a side is in one chain at most */
    if (status != SCREE_OK) goto cleanup;
    qsort(fans.items, fans.count, sizeof *fans.items, by_triangle);
    put_fans(mesh, &sides, &fans);
    *stitched = fans.count;
cleanup:
    scree_release(memory, fans.items);
    scree_release(memory, sides.items);
    return status;
}
