#include "tests/cut_maker.h"

#include <stdio.h>
#include <stdlib.h>

static uint64_t mix(uint64_t number) { /* splitmix64 */
    number += 0x9e3779b97f4a7c15u;
    number = (number ^ number >> 30) * 0xbf58476d1ce4e5b9u;
    number = (number ^ number >> 27) * 0x94d049bb133111ebu;
    return number ^ number >> 31;
}

int32_t cut_number(uint64_t *state, int32_t limit) {
    *state = mix(*state);
    return (int32_t)(*state >> 33) % limit;
}

/* All of the test's terrains have this height and, where a border runs, this rung at a post. */
static uint64_t post(const struct cut *cut, int64_t x, int64_t y) {
    if (cut->profile == SCREE_GEODETIC) x %= cut->columns;
    return mix((uint64_t)x << 32 | (uint64_t)y);
}

static int32_t height_at(const struct cut *cut, int64_t x, int64_t y) {
    return (int32_t)(post(cut, x, y) % 1000) - 300;
}

/* The coarsest rung whose borders have a vertex there; CUT_RUNGS and more: none has. */
static int32_t first_rung(const struct cut *cut, int64_t x, int64_t y) {
    return (int32_t)(post(cut, x, y) >> 32) % (CUT_RUNGS + 4);
}

static void divide(uint64_t *state, bool holes, struct scree_tile_id id, struct cut *cut) {
    int64_t span = CUT_TILE_STEPS << (CUT_FINEST - id.zoom);
    if (id.x * span >= cut->columns || id.y * span >= cut->rows) return;
    if (id.zoom < CUT_FINEST && cut_number(state, 10) < 7 - id.zoom) {
        for (uint32_t child = 0; child < 4; child++)
            divide(state, holes, (struct scree_tile_id){id.zoom + 1, 2 * id.x + child % 2, 2 * id.y + child / 2}, cut);
        return;
    }
    if (holes && cut_number(state, 4) == 0) return;
    cut->ids[cut->count++] = id;
}

void cut_make_ids(uint64_t *state, bool holes, struct cut *cut) {
    int32_t root_steps = CUT_TILE_STEPS << CUT_FINEST;
    cut->profile = cut_number(state, 2) == 0 ? SCREE_GEODETIC : SCREE_LOCAL;
    cut->columns = 2 * root_steps;
    cut->rows = root_steps;
    cut->count = 0;
    if (cut->profile == SCREE_LOCAL) {
        cut->columns = root_steps / 2 + 1 + cut_number(state, root_steps / 2);
        cut->rows = 1 + cut_number(state, root_steps);
    }
    for (uint32_t x = 0; x < (cut->profile == SCREE_GEODETIC ? 2u : 1u); x++)
        divide(state, holes, (struct scree_tile_id){0, x, 0}, cut);
}

static int64_t doubled_area(const struct scree_vertex *a, const struct scree_vertex *b, const struct scree_vertex *c) {
    return (int64_t)(b->x - a->x) * (c->y - a->y) - (int64_t)(c->x - a->x) * (b->y - a->y);
}

static void add_triangle(struct cut_tile *tile, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *corners = &tile->indices[3 * (size_t)tile->triangle_count++];
    corners[0] = a, corners[1] = b, corners[2] = c;
}

/* Splits the triangle that the vertex lies in, or the one on whose border edge it lies; leaves it out on other edges.
 */
static void insert(struct cut_tile *tile, struct scree_vertex vertex) {
    if (tile->vertex_count == CUT_MOST_VERTICES || tile->triangle_count + 2 > CUT_MOST_TRIANGLES) {
        fprintf(stderr, "a tile of the test has too many vertices\n");
        exit(2);
    }
    for (uint32_t t = 0; t < tile->triangle_count; t++) {
        uint32_t *corners = &tile->indices[3 * (size_t)t], a = corners[0], b = corners[1], c = corners[2];
        int64_t areas[3];
        int zeros = 0, zero = 0, negative = 0;
        for (int i = 0; i < 3; i++) {
            areas[i] = doubled_area(&tile->vertices[corners[i]], &tile->vertices[corners[(i + 1) % 3]], &vertex);
            if (areas[i] < 0) negative++;
            if (areas[i] == 0) zeros++, zero = i;
        }
        if (negative > 0 || zeros > 1) continue;
        bool border =
            vertex.x == 0 || vertex.y == 0 || vertex.x == tile->header.columns || vertex.y == tile->header.rows;
        uint32_t number = tile->vertex_count;
        if (zeros == 1 && !border) return;
        tile->vertices[tile->vertex_count++] = vertex;
        if (zeros == 0) {
            corners[2] = number;
            add_triangle(tile, b, c, number);
            add_triangle(tile, c, a, number);
        } else {
            uint32_t to = corners[(zero + 1) % 3], third = corners[(zero + 2) % 3];
            corners[(zero + 1) % 3] = number;
            add_triangle(tile, number, to, third);
        }
        return;
    }
}

static void shuffle(uint64_t *state, struct scree_vertex *vertices, int32_t count) {
    for (int32_t i = count - 1; i > 0; i--) {
        int32_t other = cut_number(state, i + 1);
        struct scree_vertex moved = vertices[i];
        vertices[i] = vertices[other];
        vertices[other] = moved;
    }
}

/* The border of the scale, and any interior; a share of the vertices of the next rung are there as well. */
static int32_t choose_vertices(uint64_t *state, const struct cut *cut, const struct cut_tile *tile,
                               struct scree_vertex *chosen) {
    int32_t columns = tile->header.columns, rows = tile->header.rows, count = 0;
    int32_t rung = cut_number(state, CUT_RUNGS), share = cut_number(state, 100);
    for (int32_t y = 0; y <= rows; y++)
        for (int32_t x = 0; x <= columns; x += y == 0 || y == rows ? 1 : columns) {
            if ((x == 0 || x == columns) && (y == 0 || y == rows)) continue;
            int32_t first = first_rung(cut, tile->x + x, tile->y + y);
            if (first <= rung || (first == rung + 1 && cut_number(state, 100) < share))
                chosen[count++] = (struct scree_vertex){x, y, height_at(cut, tile->x + x, tile->y + y)};
        }
    for (int32_t inner = columns > 1 && rows > 1 ? cut_number(state, 8) : 0; inner > 0; inner--) {
        int32_t x = 1 + cut_number(state, columns - 1), y = 1 + cut_number(state, rows - 1);
        chosen[count++] = (struct scree_vertex){x, y, height_at(cut, tile->x + x, tile->y + y)};
    }
    shuffle(state, chosen, count);
    return count;
}

static void make_mesh(uint64_t *state, const struct cut *cut, struct cut_tile *tile) {
    struct scree_vertex chosen[CUT_MOST_VERTICES];
    int32_t columns = tile->header.columns, rows = tile->header.rows;
    for (int32_t corner = 0; corner < 4; corner++) {
        int32_t x = corner % 2 * columns, y = corner / 2 * rows;
        tile->vertices[corner] = (struct scree_vertex){x, y, height_at(cut, tile->x + x, tile->y + y)};
    }
    tile->vertex_count = 4;
    tile->triangle_count = 0;
    if (cut_number(state, 2) == 0) {
        add_triangle(tile, 0, 1, 3);
        add_triangle(tile, 0, 3, 2);
    } else {
        add_triangle(tile, 0, 1, 2);
        add_triangle(tile, 1, 3, 2);
    }
    int32_t count = choose_vertices(state, cut, tile, chosen);
    for (int32_t i = 0; i < count; i++) insert(tile, chosen[i]);
}

static void collect_border(struct cut_tile *tile, enum scree_side side) {
    struct scree_border *border = &tile->view.borders[side];
    uint32_t *vertices = tile->border_vertices[side], *apexes = tile->border_apexes[side], edges = 0;
    bool upright = side == SCREE_EAST || side == SCREE_WEST;
    int32_t across = side == SCREE_EAST ? tile->header.columns : side == SCREE_NORTH ? tile->header.rows : 0;
    for (uint32_t slot = 0; slot < 3 * tile->triangle_count; slot++) {
        uint32_t base = slot / 3 * 3, from = tile->indices[base + (slot + 1) % 3],
                 to = tile->indices[base + (slot + 2) % 3];
        const struct scree_vertex *a = &tile->vertices[from], *b = &tile->vertices[to];
        if ((upright ? a->x : a->y) != across || (upright ? b->x : b->y) != across) continue;
        if (upright ? a->y > b->y : a->x > b->x) from = to, a = b;
        uint32_t at = edges++; /* insertion sort by the edge's lower end */
        for (; at > 0; at--) {
            const struct scree_vertex *before = &tile->vertices[vertices[at - 1]];
            if (upright ? before->y < a->y : before->x < a->x) break;
            vertices[at] = vertices[at - 1];
            apexes[at] = apexes[at - 1];
        }
        vertices[at] = from;
        apexes[at] = slot;
    }
    for (uint32_t v = 0; v < 4; v++) { /* the corners are vertices 0 .. 3 */
        const struct scree_vertex *corner = &tile->vertices[v];
        bool last = upright ? corner->x == across && corner->y > 0 : corner->y == across && corner->x > 0;
        if (last) vertices[edges] = v;
    }
    *border = (struct scree_border){edges + 1, vertices, apexes};
}

void cut_tile_finish(struct cut_tile *tile) {
    tile->view.header = &tile->header;
    tile->view.vertices = tile->vertices;
    tile->view.indices = tile->indices;
    for (int side = 0; side < SCREE_SIDES; side++) collect_border(tile, (enum scree_side)side);
}

void cut_make_meshes(uint64_t *state, struct cut *cut) {
    bool geodetic = cut->profile == SCREE_GEODETIC;
    double spacing = geodetic ? 180.0 / (CUT_TILE_STEPS << CUT_FINEST) : 30.1;
    for (uint32_t i = 0; i < cut->count; i++) {
        struct cut_tile *tile = &cut->tiles[i];
        int64_t span = CUT_TILE_STEPS << (CUT_FINEST - cut->ids[i].zoom);
        tile->id = cut->ids[i];
        tile->x = tile->id.x * span;
        tile->y = tile->id.y * span;
        tile->header.profile = cut->profile;
        tile->header.zoom = tile->id.zoom;
        tile->header.tile_x = tile->id.x;
        tile->header.tile_y = tile->id.y;
        tile->header.columns = (int32_t)(cut->columns - tile->x < span ? cut->columns - tile->x : span);
        tile->header.rows = (int32_t)(cut->rows - tile->y < span ? cut->rows - tile->y : span);
        tile->header.west = (geodetic ? -180 : 417213.7) + (double)tile->x * spacing;
        tile->header.south = (geodetic ? -90 : 3798411.3) + (double)tile->y * spacing;
        tile->header.spacing_x = tile->header.spacing_y = spacing;
        tile->header.height_exponent = -2;
        make_mesh(state, cut, tile);
        cut_tile_finish(tile);
    }
}
