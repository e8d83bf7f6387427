#include "tests/progressive_maker.h"

#include "tests/mesh_maker.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_RING = 24, MAX_FIXUPS = 3 * MAX_RING, NO_TWIN = -1 };

struct maker {
    const struct progressive_wish *wish;
    struct progressive *progressive;
    uint64_t chance;
    uint32_t *corners; /* at present */
    int32_t *twins;    /* a half-edge, from its slot's corner to the next: the one on the other side */
    uint32_t triangle_count;
};

/* The polygon around a new vertex. */
struct cavity {
    struct scree_vertex vertex;
    uint32_t parent;
    int32_t edges[MAX_RING]; /* half-edges inside the polygon, counter-clockwise */
    uint32_t edge_count;
    int32_t triangles[MAX_RING];
    uint32_t triangle_count;
    bool open; /* the new vertex is on the border: the edge that it cuts is left out; it was before edges[0] */
};

static void *need(struct scree_memory *memory, size_t count, size_t size_bytes) {
    struct scree_error error = {0};
    void *array = scree_allocate(memory, count, size_bytes, "a progressive tile", &error);
    if (array == NULL) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    return array;
}

static int32_t following(int32_t edge) {
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

static int64_t area2(const struct scree_vertex *a, const struct scree_vertex *b, const struct scree_vertex *c) {
    return ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)b->y - a->y) * ((int64_t)c->x - a->x);
}

static const struct scree_vertex *corner_at(const struct maker *maker, int32_t edge) {
    return &maker->progressive->vertices[maker->corners[edge]];
}

static int64_t seen(const struct maker *maker, const struct cavity *cavity, int32_t edge) {
    return area2(&cavity->vertex, corner_at(maker, edge), corner_at(maker, following(edge)));
}

static bool is_border(const struct progressive_wish *wish, const struct scree_vertex *vertex) {
    return vertex->x == 0 || vertex->y == 0 || vertex->x == wish->columns || vertex->y == wish->rows;
}

/* Takes in the triangle behind edge number `at`, if the polygon stays one that its vertex sees all of. */
static bool widen(const struct maker *maker, struct cavity *cavity, uint32_t at) {
    int32_t twin = maker->twins[cavity->edges[at]];
    if (twin == NO_TWIN || cavity->edge_count == MAX_RING) return false;
    int32_t second = following(twin), third = following(second);
    uint32_t apex = maker->corners[third];
    if (seen(maker, cavity, second) <= 0 || seen(maker, cavity, third) <= 0) return false;
    for (uint32_t i = 0; i < cavity->edge_count; i++)
        if (maker->corners[cavity->edges[i]] == apex || maker->corners[following(cavity->edges[i])] == apex)
            return false;
    if (maker->wish->half_edges && apex != cavity->parent && maker->corners[second] != cavity->parent &&
        maker->corners[twin] != cavity->parent)
        return false;
    memmove(&cavity->edges[at + 2], &cavity->edges[at + 1], (cavity->edge_count - at - 1) * sizeof *cavity->edges);
    cavity->edges[at] = second;
    cavity->edges[at + 1] = third;
    cavity->edge_count++;
    cavity->triangles[cavity->triangle_count++] = twin / 3;
    return true;
}

/* A post of a triangle's inside or edges; it may be a corner, or miss. */
static struct scree_vertex any_post(struct maker *maker, int32_t first) {
    const struct scree_vertex *a = corner_at(maker, first), *b = corner_at(maker, first + 1),
                              *c = corner_at(maker, first + 2);
    double u = any_number(&maker->chance, 1001) / 1000.0, v = any_number(&maker->chance, 1001) / 1000.0;
    if (any_number(&maker->chance, 4) == 0) v = 0; /* edges, and so borders, want their vertices too */
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return (struct scree_vertex){(int32_t)(a->x + u * (b->x - a->x) + v * (c->x - a->x)),
                                 (int32_t)(a->y + u * (b->y - a->y) + v * (c->y - a->y)),
                                 any_number(&maker->chance, 4000) - 1000};
}

/* Takes in what is behind edges that the vertex lies on, or leaves them out where they are the border's. */
static bool clear_edges(struct maker *maker, struct cavity *cavity) {
    for (uint32_t i = 0; i < cavity->edge_count; i++) {
        if (seen(maker, cavity, cavity->edges[i]) != 0) continue;
        if (maker->twins[cavity->edges[i]] != NO_TWIN) return widen(maker, cavity, i);
        int32_t rotated[MAX_RING];
        uint32_t kept = cavity->edge_count - 1;
        for (uint32_t k = 0; k < kept; k++) rotated[k] = cavity->edges[(i + 1 + k) % cavity->edge_count];
        cavity->parent =
            maker->corners[any_number(&maker->chance, 2) == 0 ? cavity->edges[i] : following(cavity->edges[i])];
        memcpy(cavity->edges, rotated, kept * sizeof *rotated);
        cavity->edge_count = kept;
        cavity->open = true;
        return true;
    }
    return true;
}

static bool find_cavity(struct maker *maker, struct cavity *cavity) {
    int32_t triangle = any_number(&maker->chance, (int32_t)maker->triangle_count), first = 3 * triangle;
    struct scree_vertex post = any_post(maker, first);
    *cavity = (struct cavity){.vertex = post,
                              .parent = maker->corners[first + any_number(&maker->chance, 3)],
                              .edges = {first, first + 1, first + 2},
                              .edge_count = 3,
                              .triangles = {triangle},
                              .triangle_count = 1};
    uint32_t on_edges = 0;
    for (uint32_t i = 0; i < 3; i++) {
        if (seen(maker, cavity, cavity->edges[i]) < 0) return false;
        on_edges += seen(maker, cavity, cavity->edges[i]) == 0;
    }
    if (on_edges > 1 || !clear_edges(maker, cavity)) return false;
    if (!cavity->open && is_border(maker->wish, &cavity->vertex)) return false;
    for (int32_t tries = any_number(&maker->chance, 6); tries-- > 0;)
        widen(maker, cavity, (uint32_t)any_number(&maker->chance, (int32_t)cavity->edge_count));
    return true;
}

/* Puts a fan's triangle into slots; what is there already and changes is a fix-up. */
static void put_triangle(struct maker *maker, int32_t first, const uint32_t corners[3], bool appended) {
    struct progressive *progressive = maker->progressive;
    for (int i = 0; i < 3; i++) {
        if (appended)
            progressive->corners[first + i] = corners[i];
        else if (maker->corners[first + i] != corners[i])
            progressive->fixups[progressive->fixup_count++] =
                (struct progressive_fixup){(uint32_t)(first + i), maker->corners[first + i], corners[i]};
        maker->corners[first + i] = corners[i];
    }
}

static void join(struct maker *maker, int32_t edge, int32_t twin) {
    maker->twins[edge] = twin;
    if (twin != NO_TWIN) maker->twins[twin] = edge;
}

/* Where the fan's triangle over each edge goes, as the half-edge that the edge becomes: into the triangle that the edge
 * had, as far as that is free, else into another of the cavity, else behind all. */
static void place_fan(struct maker *maker, const struct cavity *cavity, int32_t places[MAX_RING]) {
    bool taken[MAX_RING] = {false};
    for (uint32_t i = 0; i < cavity->edge_count; i++) {
        places[i] = NO_TWIN;
        for (uint32_t k = 0; k < cavity->triangle_count; k++)
            if (cavity->triangles[k] == cavity->edges[i] / 3 && !taken[k]) {
                taken[k] = true;
                places[i] = cavity->edges[i];
            }
    }
    for (uint32_t i = 0, k = 0; i < cavity->edge_count; i++) {
        if (places[i] != NO_TWIN) continue;
        while (k < cavity->triangle_count && taken[k]) k++;
        places[i] = 3 * (k < cavity->triangle_count ? cavity->triangles[k++] : (int32_t)maker->triangle_count++);
    }
}

static void insert(struct maker *maker, const struct cavity *cavity) {
    struct progressive *progressive = maker->progressive;
    uint32_t vertex = progressive->vertex_count++, count = cavity->edge_count;
    uint32_t triangles_before = maker->triangle_count, ends[MAX_RING + 1];
    int32_t outside[MAX_RING], places[MAX_RING];
    progressive->vertices[vertex] = cavity->vertex;
    for (uint32_t i = 0; i < count; i++) {
        outside[i] = maker->twins[cavity->edges[i]];
        ends[i] = maker->corners[cavity->edges[i]];
    }
    ends[count] = maker->corners[following(cavity->edges[count - 1])];
    place_fan(maker, cavity, places);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t corners[3];
        int32_t first = places[i] - places[i] % 3;
        corners[places[i] % 3] = ends[i];
        corners[following(places[i]) % 3] = ends[i + 1];
        corners[following(following(places[i])) % 3] = vertex;
        put_triangle(maker, first, corners, first >= 3 * (int32_t)triangles_before);
    }
    for (uint32_t i = 0; i < count; i++) {
        join(maker, places[i], outside[i]);
        bool ends_here = cavity->open && i + 1 == count;
        int32_t to_vertex = following(places[i]);
        join(maker, to_vertex, ends_here ? NO_TWIN : following(following(places[(i + 1) % count])));
    }
    if (cavity->open) maker->twins[following(following(places[0]))] = NO_TWIN;
    progressive->triangle_count = maker->triangle_count;
    progressive->splits[progressive->split_count++] = (struct progressive_split){
        .parent = cavity->parent, .fixup_end = progressive->fixup_count, .triangle_end = maker->triangle_count};
}

/* What has been inserted so far becomes the base mesh. */
static void start_here(struct maker *maker) {
    struct progressive *progressive = maker->progressive;
    progressive->base_vertices = progressive->vertex_count;
    progressive->base_triangles = maker->triangle_count;
    progressive->split_count = progressive->fixup_count = 0;
    memcpy(progressive->corners, maker->corners, 3 * (size_t)maker->triangle_count * sizeof *maker->corners);
}

static void insert_any(struct maker *maker, uint32_t splits) {
    uint32_t done = 0, room = maker->progressive->fixup_capacity - MAX_FIXUPS;
    for (uint32_t failures = 0; done < splits && failures < 1000; failures++) {
        if (maker->progressive->fixup_count > room) return;
        struct cavity cavity;
        if (!find_cavity(maker, &cavity)) continue;
        insert(maker, &cavity);
        done++;
        failures = 0;
    }
}

void make_progressive(struct scree_memory *memory, const struct progressive_wish *wish,
                      struct progressive *progressive) {
    size_t vertex_count = 4 + (size_t)wish->base_splits + wish->splits, slot_count = 6 * vertex_count;
    static const uint32_t two_triangles[6] = {0, 1, 3, 0, 3, 2};
    struct maker maker = {.wish = wish,
                          .progressive = progressive,
                          .chance = wish->seed,
                          .corners = need(memory, slot_count, sizeof *maker.corners),
                          .twins = need(memory, slot_count, sizeof *maker.twins),
                          .triangle_count = 2};
    *progressive = (struct progressive){.vertices = need(memory, vertex_count, sizeof *progressive->vertices),
                                        .corners = need(memory, slot_count, sizeof *progressive->corners),
                                        .splits = need(memory, vertex_count, sizeof *progressive->splits),
                                        .fixup_capacity = (uint32_t)(8 * vertex_count + MAX_FIXUPS),
                                        .vertex_count = 4};
    progressive->fixups = need(memory, progressive->fixup_capacity, sizeof *progressive->fixups);
    for (uint32_t i = 0; i < 4; i++)
        progressive->vertices[i] = (struct scree_vertex){i % 2 == 0 ? 0 : wish->columns, i < 2 ? 0 : wish->rows, 0};
    memcpy(maker.corners, two_triangles, sizeof two_triangles);
    for (int i = 0; i < 6; i++) maker.twins[i] = NO_TWIN;
    join(&maker, 2, 3);
    insert_any(&maker, wish->base_splits);
    start_here(&maker);
    insert_any(&maker, wish->splits);
    scree_release(memory, maker.twins);
    scree_release(memory, maker.corners);
}

void release_progressive(struct scree_memory *memory, struct progressive *progressive) {
    scree_release(memory, progressive->fixups);
    scree_release(memory, progressive->splits);
    scree_release(memory, progressive->corners);
    scree_release(memory, progressive->vertices);
    *progressive = (struct progressive){0};
}

static int by_ends(const void *a, const void *b) {
    uint64_t first = *(const uint64_t *)a, second = *(const uint64_t *)b;
    return first < second ? -1 : first > second; /* equal ones are the fault that is looked for */
}

/* Whether each directed edge occurs once, and against it another, or the border. */
static const char *edges_fault(uint64_t *edges, uint32_t edge_count, const struct scree_vertex *vertices,
                               int32_t columns, int32_t rows, uint32_t *border_edges) {
    qsort(edges, edge_count, sizeof *edges, by_ends);
    *border_edges = 0;
    for (uint32_t i = 0; i < edge_count; i++) {
        if (i > 0 && edges[i] == edges[i - 1]) return "two triangles on the same side of an edge";
        uint64_t against = edges[i] << 32 | edges[i] >> 32;
        if (bsearch(&against, edges, edge_count, sizeof *edges, by_ends) != NULL) continue;
        const struct scree_vertex *a = &vertices[edges[i] >> 32], *b = &vertices[(uint32_t)edges[i]];
        bool on_side =
            (a->x == b->x && (a->x == 0 || a->x == columns)) || (a->y == b->y && (a->y == 0 || a->y == rows));
        if (!on_side) return "a gap inside";
        (*border_edges)++;
    }
    return NULL;
}

const char *triangles_fault(struct scree_memory *memory, const struct scree_vertex *vertices, uint32_t vertex_count,
                            const uint32_t *corners, uint32_t triangle_count, int32_t columns, int32_t rows) {
    int64_t sum = 0;
    for (uint32_t slot = 0; slot < 3 * triangle_count; slot++)
        if (corners[slot] >= vertex_count) return "a corner that is not there";
    for (uint32_t slot = 0; slot < 3 * triangle_count; slot += 3) {
        int64_t area = area2(&vertices[corners[slot]], &vertices[corners[slot + 1]], &vertices[corners[slot + 2]]);
        if (area <= 0) return "a triangle that is not positive";
        sum += area;
    }
    if (sum != 2 * (int64_t)columns * rows) return "areas that do not add up";
    uint32_t edge_count = 3 * triangle_count, border_edges;
    uint64_t *edges = need(memory, edge_count, sizeof *edges);
    for (uint32_t slot = 0; slot < edge_count; slot++)
        edges[slot] = (uint64_t)corners[slot] << 32 | corners[following((int32_t)slot)];
    const char *fault = edges_fault(edges, edge_count, vertices, columns, rows, &border_edges);
    scree_release(memory, edges);
    if (fault == NULL && vertex_count + triangle_count != (edge_count + border_edges) / 2 + 1)
        return "vertices that no triangle has";
    return fault;
}
