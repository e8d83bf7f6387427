/* Triangles in fans, vertices by first use (src/quantized_mesh_order.h).
 *
 * After Sander, Nehab and Barczak, "Fast triangle reordering for vertex locality and reduced overdraw" (SIGGRAPH 2007):
 * all triangles left around a vertex are written, then the walk moves on to a vertex of the fan that is still in a
 * simulated cache, or back along the way it came. Here each fan is written in the order of its turn around the
 * vertex, so that nearly every triangle shares an edge with the one before. */
#include "src/quantized_mesh_order.h"

#define CACHE_SIZE 16 /* vertices; what graphics chips are said to reuse */
#define NONE       UINT32_MAX

enum state { WAITING, PRECEDED, WRITTEN };

struct walk {
    const uint32_t *corners;
    uint32_t triangle_count, vertex_count;
    uint32_t *first;      /* of each vertex: where its triangles start in `around` */
    uint32_t *around;     /* 3 a triangle: corner numbers (3 * triangle + 0..2), grouped by vertex */
    uint32_t *live;       /* of each vertex: triangles not written yet */
    uint32_t *entered;    /* of each vertex: time at which it entered the cache; 0: never */
    uint32_t *follower;   /* of each vertex, within one fan: corner whose triangle begins there; else NONE */
    uint32_t *fan;        /* corners of one fan */
    uint32_t *trail;      /* vertices passed, newest last */
    uint32_t *number;     /* of each vertex: new number, or NONE */
    unsigned char *state; /* of each triangle: enum state */
    uint32_t trail_count, now, cursor;
    uint32_t written_count, numbered_count;
    uint32_t *ordered, *vertex_order; /* results */
};

static uint32_t next_corner(uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static uint32_t previous_corner(uint32_t corner) {
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/* One block holds every array; it is handed back through `block`. */
static enum scree_status walk_open(struct walk *walk, struct scree_memory *memory, uint32_t **block,
                                   struct scree_error *error) {
    size_t corner_count = 3 * (size_t)walk->triangle_count, vertex_count = walk->vertex_count;
    size_t numbers = 5 * vertex_count + 1 + 3 * corner_count + (walk->triangle_count + 3) / 4;
    *block = scree_allocate(memory, numbers, sizeof **block, "the order of a tile's triangles", error);
    if (*block == NULL) return error->status;
    uint32_t *free_space = *block;
    walk->first = free_space, free_space += vertex_count + 1;
    walk->live = free_space, free_space += vertex_count;
    walk->entered = free_space, free_space += vertex_count;
    walk->follower = free_space, free_space += vertex_count;
    walk->number = free_space, free_space += vertex_count;
    walk->around = free_space, free_space += corner_count;
    walk->fan = free_space, free_space += corner_count;
    walk->trail = free_space, free_space += corner_count;
    walk->state = (unsigned char *)free_space;
    return SCREE_OK;
}

static void group_by_vertex(struct walk *walk) {
    uint32_t corner_count = 3 * walk->triangle_count;
    for (uint32_t c = 0; c < corner_count; c++) walk->live[walk->corners[c]]++;
    uint32_t start = 0;
    for (uint32_t v = 0; v < walk->vertex_count; v++) {
        start += walk->live[v];
        walk->first[v] = start; /* its end; moves down to its start below */
        walk->follower[v] = walk->number[v] = NONE;
    }
    walk->first[walk->vertex_count] = start;
    for (uint32_t c = corner_count; c-- > 0;) walk->around[--walk->first[walk->corners[c]]] = c;
}

static uint32_t renumber(struct walk *walk, uint32_t vertex) {
    if (walk->number[vertex] == NONE) {
        walk->number[vertex] = walk->numbered_count;
        walk->vertex_order[walk->numbered_count++] = vertex;
    }
    if (walk->entered[vertex] + CACHE_SIZE < walk->now) walk->entered[vertex] = walk->now++;
    walk->trail[walk->trail_count++] = vertex;
    walk->live[vertex]--;
    return walk->number[vertex];
}

static void write_triangle(struct walk *walk, uint32_t corner) {
    uint32_t *out = walk->ordered + 3 * (size_t)walk->written_count++;
    walk->state[corner / 3] = WRITTEN;
    out[0] = renumber(walk, walk->corners[corner]);
    out[1] = renumber(walk, walk->corners[next_corner(corner)]);
    out[2] = renumber(walk, walk->corners[previous_corner(corner)]);
}

/* Writes the triangles left around `centre` counter-clockwise, one unbroken run of neighbours after the other, each
 * from its beginning; a full turn from any of its triangles. */
static void write_fan(struct walk *walk, uint32_t centre) {
    const uint32_t *corners = walk->corners;
    uint32_t count = 0;
    for (uint32_t i = walk->first[centre]; i < walk->first[centre + 1]; i++) {
        uint32_t corner = walk->around[i];
        if (walk->state[corner / 3] == WRITTEN) continue;
        walk->fan[count++] = corner;
        walk->follower[corners[next_corner(corner)]] = corner;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t next = walk->follower[corners[previous_corner(walk->fan[i])]];
        if (next != NONE) walk->state[next / 3] = PRECEDED;
    }
    for (int full_turn = 0; full_turn <= 1; full_turn++)
        for (uint32_t i = 0; i < count; i++) {
            if (walk->state[walk->fan[i] / 3] > (full_turn ? PRECEDED : WAITING)) continue;
            for (uint32_t corner = walk->fan[i]; corner != NONE && walk->state[corner / 3] != WRITTEN;) {
                write_triangle(walk, corner);
                corner = walk->follower[corners[previous_corner(corner)]];
            }
        }
    for (uint32_t i = 0; i < count; i++) walk->follower[corners[next_corner(walk->fan[i])]] = NONE;
}

/* The vertex to fan around next: of those just written (`from` on in the trail), the one longest in the cache that
 * will still be there when its own fan is through; else the last one passed that has triangles left; else the first. */
static uint32_t next_centre(struct walk *walk, uint32_t from) {
    uint32_t best = NONE, best_age = 0;
    for (uint32_t i = from; i < walk->trail_count; i++) {
        uint32_t vertex = walk->trail[i];
        if (walk->live[vertex] == 0) continue;
        uint32_t age = walk->now - walk->entered[vertex];
        if (age + 2 * walk->live[vertex] > CACHE_SIZE) age = 0;
        if (best == NONE || age > best_age) {
            best = vertex;
            best_age = age;
        }
    }
    if (best != NONE) return best;
    while (walk->trail_count > 0)
        if (walk->live[walk->trail[--walk->trail_count]] > 0) return walk->trail[walk->trail_count];
    while (walk->cursor < walk->vertex_count && walk->live[walk->cursor] == 0) walk->cursor++;
    return walk->cursor < walk->vertex_count ? walk->cursor : NONE;
}

enum scree_status quantized_mesh_order(struct scree_memory *memory, const uint32_t *corners, uint32_t triangle_count,
                                       uint32_t vertex_count, uint32_t *ordered, uint32_t *vertex_order, uint32_t *used,
                                       struct scree_error *error) {
    struct scree_error own = {0};
    if (error == NULL) error = &own;
    struct walk walk = {.corners = corners,
                        .triangle_count = triangle_count,
                        .vertex_count = vertex_count,
                        .now = CACHE_SIZE + 1, /* so that 0 means long ago */
                        .ordered = ordered,
                        .vertex_order = vertex_order};
    uint32_t *block = NULL;
    enum scree_status status = walk_open(&walk, memory, &block, error);
    if (status != SCREE_OK) return status;
    group_by_vertex(&walk);
    for (uint32_t centre = next_centre(&walk, 0); centre != NONE;) {
        uint32_t from = walk.trail_count;
        write_fan(&walk, centre);
        centre = next_centre(&walk, from);
    }
    *used = walk.numbered_count;
    scree_release(memory, block);
    return SCREE_OK;
}
