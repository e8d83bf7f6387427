/* Triangles in fans, vertices by first use (src/quantized_mesh_order.h). */
#include "src/quantized_mesh_order.h"

#define NONE UINT32_MAX

/* Of a triangle. PRECEDED: not written, and follows another triangle of the fan at hand. */
enum state { WAITING, PRECEDED, WRITTEN };

struct walk {
    const uint32_t *corners;
    uint32_t triangle_count, vertex_count;
    uint32_t *first;      /* of each vertex: where its corners start in `around` */
    uint32_t *around;     /* corners (4 * triangle + 0..2) grouped by vertex, in the order of the triangles */
    uint32_t *follower;   /* of each vertex: within one fan, the corner whose triangle begins there; else NONE */
    uint32_t *fan;        /* corners of one fan */
    uint32_t *number;     /* of each vertex: new number, or NONE */
    unsigned char *state; /* of each triangle */
    uint32_t written_count, numbered_count;
    uint32_t *ordered, *vertex_order; /* results */
};

static uint32_t vertex_at(const struct walk *walk, uint32_t corner) {
    return walk->corners[3 * (corner >> 2) + (corner & 3)];
}

static uint32_t next_corner(uint32_t corner) {
    return (corner & 3) == 2 ? corner - 2 : corner + 1;
}

static uint32_t previous_corner(uint32_t corner) {
    return (corner & 3) == 0 ? corner + 2 : corner - 1;
}

/* One block holds every array; it is handed back through `block`. */
static enum scree_status walk_open(struct walk *walk, struct scree_memory *memory, uint32_t **block,
                                   struct scree_error *error) {
    size_t corner_count = 3 * (size_t)walk->triangle_count, vertex_count = walk->vertex_count;
    size_t numbers = 3 * vertex_count + 1 + 2 * corner_count + (walk->triangle_count + 3) / 4;
    *block = scree_allocate(memory, numbers, sizeof **block, "the order of a tile's triangles", error);
    if (*block == NULL) return error->status;
    uint32_t *space = *block;
    walk->first = space, space += vertex_count + 1;
    walk->follower = space, space += vertex_count;
    walk->number = space, space += vertex_count;
    walk->around = space, space += corner_count;
    walk->fan = space, space += corner_count;
    walk->state = (unsigned char *)space;
    return SCREE_OK;
}

static void group_by_vertex(struct walk *walk) {
    size_t corner_count = 3 * (size_t)walk->triangle_count;
    for (size_t c = 0; c < corner_count; c++) walk->first[walk->corners[c]]++;
    uint32_t end = 0;
    for (uint32_t v = 0; v < walk->vertex_count; v++) {
        end += walk->first[v];
        walk->first[v] = end; /* moves down to the group's start below */
        walk->follower[v] = walk->number[v] = NONE;
    }
    walk->first[walk->vertex_count] = end;
    for (uint32_t t = walk->triangle_count; t-- > 0;)
        for (uint32_t k = 3; k-- > 0;) walk->around[--walk->first[walk->corners[3 * (size_t)t + k]]] = 4 * t + k;
}

static uint32_t number_of(struct walk *walk, uint32_t vertex) {
    if (walk->number[vertex] == NONE) {
        walk->number[vertex] = walk->numbered_count;
        walk->vertex_order[walk->numbered_count++] = vertex;
    }
    return walk->number[vertex];
}

/* Writes the triangle at `corner` and those that follow it around that corner's vertex. */
static void write_run(struct walk *walk, uint32_t corner) {
    while (corner != NONE && walk->state[corner >> 2] != WRITTEN) {
        uint32_t *out = walk->ordered + 3 * (size_t)walk->written_count++;
        uint32_t end = vertex_at(walk, previous_corner(corner));
        walk->state[corner >> 2] = WRITTEN;
        out[0] = number_of(walk, vertex_at(walk, corner));
        out[1] = number_of(walk, vertex_at(walk, next_corner(corner)));
        out[2] = number_of(walk, end);
        corner = walk->follower[end];
    }
}

/* Writes the triangles left around `centre` counter-clockwise: first the runs that have a beginning, then a full turn
 * from any of its triangles. */
static void write_fan(struct walk *walk, uint32_t centre) {
    uint32_t count = 0;
    for (uint32_t i = walk->first[centre]; i < walk->first[centre + 1]; i++) {
        uint32_t corner = walk->around[i];
        if (walk->state[corner >> 2] == WRITTEN) continue;
        walk->fan[count++] = corner;
        walk->follower[vertex_at(walk, next_corner(corner))] = corner;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t next = walk->follower[vertex_at(walk, previous_corner(walk->fan[i]))];
        if (next != NONE) walk->state[next >> 2] = PRECEDED;
    }
    for (uint32_t i = 0; i < count; i++)
        if (walk->state[walk->fan[i] >> 2] == WAITING) write_run(walk, walk->fan[i]);
    for (uint32_t i = 0; i < count; i++) {
        write_run(walk, walk->fan[i]);
        walk->follower[vertex_at(walk, next_corner(walk->fan[i]))] = NONE;
    }
}

enum scree_status quantized_mesh_order(struct scree_memory *memory, const uint32_t *corners, uint32_t triangle_count,
                                       uint32_t vertex_count, uint32_t *ordered, uint32_t *vertex_order, uint32_t *used,
                                       struct scree_error *error) {
    struct scree_error own = {0};
    if (error == NULL) error = &own;
    struct walk walk = {.corners = corners,
                        .triangle_count = triangle_count,
                        .vertex_count = vertex_count,
                        .ordered = ordered,
                        .vertex_order = vertex_order};
    uint32_t *block = NULL;
    enum scree_status status = walk_open(&walk, memory, &block, error);
    if (status != SCREE_OK) return status;
    group_by_vertex(&walk);
    uint32_t fanned = 0; /* vertices, in the new numbering, whose fan is written */
    for (uint32_t seed = 0; seed < vertex_count; seed++) {
        if (walk.number[seed] != NONE) continue;
        write_fan(&walk, seed); /* numbers the seed, unless it has no triangle */
        for (; fanned < walk.numbered_count; fanned++) write_fan(&walk, vertex_order[fanned]);
    }
    *used = walk.numbered_count;
    scree_release(memory, block);
    return SCREE_OK;
}
