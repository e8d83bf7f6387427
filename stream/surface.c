#include "stream/surface.h"

#include <stdlib.h>
#include <string.h>

#define MOST_POSTS 65535

enum scree_status surface_start(struct scree_memory *memory, uint32_t vertex_capacity, uint32_t triangle_capacity,
                                struct surface *surface, struct scree_error *error) {
    memset(surface, 0, sizeof *surface);
    surface->vertices =
        scree_allocate(memory, vertex_capacity, sizeof *surface->vertices, "a stream's vertices", error);
    surface->triangles =
        scree_allocate(memory, triangle_capacity, sizeof *surface->triangles, "a stream's triangles", error);
    surface->vertex_capacity = vertex_capacity;
    surface->triangle_capacity = triangle_capacity;
    if (surface->vertices != NULL && surface->triangles != NULL) return SCREE_OK;
    surface_release(memory, surface);
    return SCREE_E_MEMORY;
}

bool surface_reserve(struct scree_memory *memory, uint32_t vertex_capacity, uint32_t triangle_capacity,
                     struct surface *surface, struct scree_error *error) {
    if (vertex_capacity > surface->vertex_capacity) {
        struct scree_vertex *vertices = scree_reallocate(memory, surface->vertices, vertex_capacity, sizeof *vertices,
                                                         "a stream's vertices", error);
        if (vertices == NULL) return false;
        surface->vertices = vertices;
        surface->vertex_capacity = vertex_capacity;
    }
    if (triangle_capacity > surface->triangle_capacity) {
        struct surface_triangle *triangles = scree_reallocate(memory, surface->triangles, triangle_capacity,
                                                              sizeof *triangles, "a stream's triangles", error);
        if (triangles == NULL) return false;
        surface->triangles = triangles;
        surface->triangle_capacity = triangle_capacity;
    }
    return true;
}

void surface_release(struct scree_memory *memory, struct surface *surface) {
    scree_release(memory, surface->triangles);
    scree_release(memory, surface->vertices);
    memset(surface, 0, sizeof *surface);
}

bool surface_has_post(const struct surface *surface, uint32_t triangle, int32_t x, int32_t y) {
    const struct surface_triangle *at = &surface->triangles[triangle];
    const struct scree_vertex post = {x, y, 0}, *from = &surface->vertices[at->vertex[2]];
    int zeros = 0;
    for (int i = 2, next = 0; next < 3; i = next++) {
        const struct scree_vertex *to = &surface->vertices[at->vertex[next]];
        int64_t left = surface_area2(from, to, &post);
        if (left < 0 || (left == 0 && !surface_owns(from, to, at->twin[i]))) return false;
        zeros += left == 0;
        from = to;
    }
    return zeros < 2; /* two: a corner */
}

static uint32_t common_divisor(uint32_t a, uint32_t b) {
    while (b != 0) {
        uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Into how many steps posts divide an edge. */
static inline uint32_t steps_of(const struct surface *surface, const struct scree_vertex *from,
                                const struct scree_vertex *to) {
    uint32_t a = (uint32_t)abs(to->x - from->x), b = (uint32_t)abs(to->y - from->y);
    return (a | b) < SURFACE_DIVISORS ? surface->divisor[a][b] : common_divisor(a, b);
}

/* Pick's theorem: twice the area is 2 * inside + on the edges - 2. */
static uint16_t count_posts(const struct surface *surface, uint32_t triangle) {
    const struct surface_triangle *at = &surface->triangles[triangle];
    const struct scree_vertex *a = &surface->vertices[at->vertex[0]], *b = &surface->vertices[at->vertex[1]];
    const struct scree_vertex *c = &surface->vertices[at->vertex[2]];
    int64_t area2 = surface_area2(a, b, c);
    if (area2 == 1) return 0;
    int64_t ab = steps_of(surface, a, b);
    int64_t bc = steps_of(surface, b, c);
    int64_t ca = steps_of(surface, c, a);
    int64_t count = (area2 - (ab + bc + ca) + 2) / 2;
    count += surface_owns(a, b, at->twin[0]) * (ab - 1);
    count += surface_owns(b, c, at->twin[1]) * (bc - 1);
    count += surface_owns(c, a, at->twin[2]) * (ca - 1);
    return count < MOST_POSTS ? (uint16_t)count : MOST_POSTS;
}

static void renew(struct surface *surface, uint32_t t) {
    surface->triangles[t].posts = count_posts(surface, t);
    surface->triangles[t].first = SURFACE_NONE;
}

void surface_rectangle(struct surface *surface, int32_t columns, int32_t rows, bool rising) {
    /* corners of the two triangles; the diagonal is the third half-edge of both */
    static const uint32_t corners[2][2][3] = {{{2, 0, 1}, {1, 3, 2}}, {{0, 1, 3}, {3, 2, 0}}};
    for (uint32_t v = 0; v < 4; v++)
        surface->vertices[v] = (struct scree_vertex){v % 2 != 0 ? columns : 0, v / 2 != 0 ? rows : 0, 0};
    surface->vertex_count = 4;
    surface->triangle_count = 2;
    for (uint32_t a = 0; a < SURFACE_DIVISORS; a++)
        for (uint32_t b = 0; b < SURFACE_DIVISORS; b++) surface->divisor[a][b] = (unsigned char)common_divisor(a, b);
    for (uint32_t t = 0; t < 2; t++) {
        memcpy(surface->triangles[t].vertex, corners[rising][t], sizeof corners[rising][t]);
        surface->triangles[t].twin[0] = surface->triangles[t].twin[1] = SURFACE_NONE;
        surface->triangles[t].twin[2] = 4 * (1 - t) + 2;
    }
    for (uint32_t t = 0; t < 2; t++) renew(surface, t);
}

/* The slot that takes the fan's triangle on each outer edge: the triangle of the cavity whose edge it is, if that has
 * none yet; then what is left of the cavity's triangles; then new ones. */
static void choose_slots(struct surface *surface, struct cavity *cavity) {
    uint32_t left = 0; /* triangles of the cavity without an outer edge of their own come last, if at all */
    for (uint32_t i = 0; i < cavity->triangle_count; i++) surface->triangles[cavity->triangles[i]].first = SURFACE_NONE;
    for (uint32_t i = 0; i < cavity->edge_count; i++) {
        uint32_t t = cavity->edges[i] >> 2;
        bool taken = surface->triangles[t].first == 0;
        cavity->slots[i] = taken ? SURFACE_NONE : t;
        surface->triangles[t].first = 0;
    }
    for (uint32_t i = 0; i < cavity->edge_count; i++) {
        if (cavity->slots[i] != SURFACE_NONE) continue;
        while (left < cavity->triangle_count && surface->triangles[cavity->triangles[left]].first == 0) left++;
        cavity->slots[i] = left < cavity->triangle_count ? cavity->triangles[left++] : surface->triangle_count++;
    }
}

static void record_fixups(struct progressive *splits, uint32_t slot, const uint32_t coarse[3], const uint32_t fine[3]) {
    for (uint32_t i = 0; i < 3; i++)
        if (coarse[i] != fine[i])
            splits->fixups[splits->fixup_count++] = (struct progressive_fixup){3 * slot + i, coarse[i], fine[i]};
}

/* One triangle of the fan: the outer edge keeps its corners of the slot where it has been there before. */
static void set_triangle(struct surface *surface, uint32_t slot, int corner, uint32_t from, uint32_t to, uint32_t apex,
                         uint32_t twin, struct progressive *splits) {
    struct surface_triangle *triangle = &surface->triangles[slot];
    uint32_t fine[3];
    fine[corner] = from;
    fine[(corner + 1) % 3] = to;
    fine[(corner + 2) % 3] = apex;
    if (splits != NULL && slot < splits->triangle_count)
        record_fixups(splits, slot, triangle->vertex, fine);
    else if (splits != NULL)
        memcpy(splits->corners + 3 * (size_t)slot, fine, sizeof fine);
    memcpy(triangle->vertex, fine, sizeof fine);
    triangle->twin[corner] = twin;
    if (twin != SURFACE_NONE) surface->triangles[twin >> 2].twin[twin & 3] = 4 * slot + (uint32_t)corner;
}

/* Looks at the outer edges before anything is changed. */
static void look_at_edges(const struct surface *surface, struct cavity *cavity) {
    for (uint32_t i = 0; i < cavity->edge_count; i++) {
        uint32_t edge = cavity->edges[i];
        cavity->from[i] = surface_origin(surface, edge);
        cavity->to[i] = surface_origin(surface, surface_next(edge));
        cavity->twin[i] = surface_twin(surface, edge);
    }
}

void surface_insert(struct surface *surface, struct cavity *cavity, struct progressive *splits) {
    uint32_t apex = surface->vertex_count++, count = cavity->edge_count;
    look_at_edges(surface, cavity);
    choose_slots(surface, cavity);
    for (uint32_t i = 0; i < count; i++) {
        int corner = cavity->slots[i] == cavity->edges[i] >> 2 ? (int)(cavity->edges[i] & 3) : 0;
        set_triangle(surface, cavity->slots[i], corner, cavity->from[i], cavity->to[i], apex, cavity->twin[i], splits);
        cavity->twin[i] = 4 * cavity->slots[i] + (uint32_t)corner; /* from here on: where the outer edge is now */
    }
    for (uint32_t i = 0; i < count; i++) { /* spokes */
        uint32_t next = i + 1 < count ? i + 1 : 0;
        uint32_t leaving = surface_next(cavity->twin[i]), coming = surface_previous(cavity->twin[next]);
        bool border = cavity->open && next == 0;
        surface->triangles[leaving >> 2].twin[leaving & 3] = border ? SURFACE_NONE : coming;
        surface->triangles[coming >> 2].twin[coming & 3] = border ? SURFACE_NONE : leaving;
    }
    for (uint32_t i = 0; i < count; i++) renew(surface, cavity->slots[i]);
    if (splits == NULL) return;
    splits->vertices[apex] = surface->vertices[apex];
    splits->vertex_count = surface->vertex_count;
    splits->triangle_count = surface->triangle_count;
    splits->splits[splits->split_count++].fixup_end = splits->fixup_count;
}
