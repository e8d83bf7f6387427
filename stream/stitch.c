/* Stitched borders (include/scree/stitch.h): each side's vertices are merged with those of its neighbours, then the
 * triangles whose border edge has got further vertices are fanned out anew. */
#include <scree/stitch.h>

#include <math.h>
#include <stdbool.h>

static bool is_upright(enum scree_side side) {
    return side == SCREE_EAST || side == SCREE_WEST;
}

static enum scree_side facing(enum scree_side side) {
    static const enum scree_side opposite[SCREE_SIDES] = {
        [SCREE_SOUTH] = SCREE_NORTH, [SCREE_EAST] = SCREE_WEST, [SCREE_NORTH] = SCREE_SOUTH, [SCREE_WEST] = SCREE_EAST};
    return opposite[side];
}

static int32_t along(enum scree_side side, const struct scree_vertex *vertex) {
    return is_upright(side) ? vertex->y : vertex->x;
}

static const char *side_name(enum scree_side side) {
    static const char *const names[SCREE_SIDES] = {
        [SCREE_SOUTH] = "southern", [SCREE_EAST] = "eastern", [SCREE_NORTH] = "northern", [SCREE_WEST] = "western"};
    return names[side];
}

enum scree_status scree_stitch_look(struct scree_player *player, struct scree_stitch_tile *tile,
                                    struct scree_error *error) {
    struct scree_arrays arrays;
    const struct scree_stream_header *header = scree_player_header(player);
    if (header == NULL || scree_player_rungs_ready(player) == 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "a tile cannot be stitched before its base mesh has arrived");
    scree_player_look(player, &arrays);
    *tile = (struct scree_stitch_tile){.header = header, .vertices = arrays.vertices, .indices = arrays.indices};
    for (int side = 0; side < SCREE_SIDES; side++)
        scree_player_border(player, (enum scree_side)side, &tile->borders[side]);
    return SCREE_OK;
}

struct scree_stitch_size scree_stitch_bound(const struct scree_stitch_tile *tile,
                                            const struct scree_stitch_neighbour *neighbours, uint32_t count) {
    uint64_t edges = 0, vertices = 0, most = UINT32_MAX / 4;
    for (int side = 0; side < SCREE_SIDES; side++) edges += tile->borders[side].vertex_count;
    for (uint32_t n = 0; n < count; n++)
        vertices += neighbours[n].tile->borders[facing(neighbours[n].side)].vertex_count;
    if (vertices > most) vertices = most;
    if (edges > vertices) edges = vertices;
    return (struct scree_stitch_size){(uint32_t)edges, (uint32_t)vertices, (uint32_t)(edges + vertices)};
}

/* Whole steps from one coordinate to another; false when they are not a whole number of steps apart. */
static bool steps_between(double from, double to, double spacing, int64_t *steps) {
    double quotient = (to - from) / spacing;
    if (!(fabs(quotient) < 1e15)) return false;
    *steps = llround(quotient);
    return fabs(quotient - (double)*steps) < 0.25;
}

/* Where the neighbour's side begins, in steps from where the tile's begins. */
static enum scree_status find_offset(const struct scree_stream_header *tile,
                                     const struct scree_stream_header *neighbour, enum scree_side side, int64_t *offset,
                                     struct scree_error *error) {
    int64_t x, y, gap;
    if (tile->profile != neighbour->profile || tile->spacing_x != neighbour->spacing_x ||
        tile->spacing_y != neighbour->spacing_y || tile->height_exponent != neighbour->height_exponent ||
        !steps_between(tile->west, neighbour->west, tile->spacing_x, &x) ||
        !steps_between(tile->south, neighbour->south, tile->spacing_y, &y))
        return scree_fail(error, SCREE_E_ARGUMENT, "the tiles to be stitched are of builds with different steps");
    switch (side) {
    case SCREE_SOUTH: gap = y + neighbour->rows; break;
    case SCREE_EAST: gap = x - tile->columns; break;
    case SCREE_NORTH: gap = y - tile->rows; break;
    default: gap = x + neighbour->columns; break;
    }
    if (tile->profile == SCREE_GEODETIC && is_upright(side))
        gap %= llround(360 / tile->spacing_x); /* around the globe */
    *offset = is_upright(side) ? y : x;
    int64_t length = is_upright(side) ? tile->rows : tile->columns;
    int64_t beside = is_upright(side) ? neighbour->rows : neighbour->columns;
    if (gap != 0 || *offset >= length || *offset + beside <= 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "tile %d/%u/%u does not touch the %s side of tile %d/%u/%u",
                          (int)neighbour->zoom, neighbour->tile_x, neighbour->tile_y, side_name(side), (int)tile->zoom,
                          tile->tile_x, tile->tile_y);
    return SCREE_OK;
}

/* A side while neighbours are merged into it. */
struct merge {
    const struct scree_stitch_tile *tile;
    enum scree_side side;
    int64_t length;
    uint32_t own; /* border vertex of the tile that is looked at */
    int64_t last; /* position of the last vertex of a neighbour, and its height */
    int32_t last_height;
    struct scree_stitch *stitch;
};

static enum scree_status differ(const struct merge *merge, int64_t position, struct scree_error *error) {
    const struct scree_stream_header *tile = merge->tile->header;
    return scree_fail(error, SCREE_E_CORRUPT,
                      "the %s border of tile %d/%u/%u and its neighbours have different heights %lld steps along it: "
                      "the tiles are not of one build",
                      side_name(merge->side), (int)tile->zoom, tile->tile_x, tile->tile_y, (long long)position);
}

static void add_vertex(struct merge *merge, int64_t position, int32_t height, struct scree_stitch_source source) {
    struct scree_stitch *stitch = merge->stitch;
    const struct scree_stream_header *header = merge->tile->header;
    uint32_t number = stitch->count.vertices++;
    bool upright = is_upright(merge->side);
    int32_t across = merge->side == SCREE_EAST ? header->columns : merge->side == SCREE_NORTH ? header->rows : 0;
    stitch->vertices[number] =
        (struct scree_vertex){upright ? across : (int32_t)position, upright ? (int32_t)position : across, height};
    if (stitch->sources != NULL) stitch->sources[number] = source;
}

/* Adds the vertices of a neighbour that the tile does not have. */
static enum scree_status merge_neighbour(struct merge *merge, const struct scree_stitch_neighbour *neighbour,
                                         uint32_t number, struct scree_error *error) {
    const struct scree_border *own = &merge->tile->borders[merge->side];
    const struct scree_border *border = &neighbour->tile->borders[facing(merge->side)];
    int64_t offset = 0;
    enum scree_status status = find_offset(merge->tile->header, neighbour->tile->header, merge->side, &offset, error);
    for (uint32_t v = 0; status == SCREE_OK && v < border->vertex_count; v++) {
        const struct scree_vertex *vertex = &neighbour->tile->vertices[border->vertices[v]];
        int64_t position = along(merge->side, vertex) + offset;
        if (position < 0 || position > merge->length) continue;
        if (position < merge->last)
            return scree_fail(error, SCREE_E_ARGUMENT, "neighbours on the %s side of a tile are not in order",
                              side_name(merge->side));
        if (position == merge->last) { /* where two neighbours meet */
            if (vertex->height != merge->last_height) return differ(merge, position, error);
            continue;
        }
        merge->last = position;
        merge->last_height = vertex->height;
        const struct scree_vertex *at = &merge->tile->vertices[own->vertices[merge->own]];
        while (merge->own + 1 < own->vertex_count && along(merge->side, at) < position)
            at = &merge->tile->vertices[own->vertices[++merge->own]];
        if (along(merge->side, at) != position)
            add_vertex(merge, position, vertex->height, (struct scree_stitch_source){number, border->vertices[v]});
        else if (at->height != vertex->height)
            return differ(merge, position, error);
    }
    return status;
}

/* An edge of the border: its ends with the tile to their left, and the further vertices between them. */
struct edge {
    uint32_t triangle, from, to, third;
    uint32_t first, count; /* further vertices */
    bool reversed;         /* they run from `to` to `from` */
};

/* Edge number i of a side, whose further vertices begin at `first` at the earliest and end before `end`. */
static struct edge edge_at(const struct scree_stitch_tile *tile, const struct scree_stitch *stitch,
                           enum scree_side side, uint32_t i, uint32_t first, uint32_t end) {
    const struct scree_border *border = &tile->borders[side];
    uint32_t a = border->vertices[i], c = border->vertices[i + 1];
    struct edge edge = {.triangle = border->apexes[i] / 3,
                        .from = a,
                        .to = c,
                        .third = tile->indices[border->apexes[i]],
                        .first = first,
                        .reversed = side == SCREE_NORTH || side == SCREE_WEST};
    while (edge.first < end && along(side, &stitch->vertices[edge.first]) < along(side, &tile->vertices[a]))
        edge.first++;
    while (edge.first + edge.count < end &&
           along(side, &stitch->vertices[edge.first + edge.count]) < along(side, &tile->vertices[c]))
        edge.count++;
    if (edge.reversed) edge.from = c, edge.to = a;
    return edge;
}

static void add_triangle(struct scree_stitch *stitch, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *corners = &stitch->indices[3 * (size_t)stitch->count.triangles++];
    corners[0] = a, corners[1] = b, corners[2] = c;
}

/* Triangles from the edge's beginning to its last further vertex, which is returned. */
static uint32_t fan_out(struct scree_stitch *stitch, const struct edge *edge, uint32_t first_vertex, uint32_t apex) {
    uint32_t before = edge->from;
    for (uint32_t k = 0; k < edge->count; k++) {
        uint32_t vertex = first_vertex + edge->first + (edge->reversed ? edge->count - 1 - k : k);
        add_triangle(stitch, before, vertex, apex);
        before = vertex;
    }
    return before;
}

static void replace_triangle(struct scree_stitch *stitch, const struct edge *edge, uint32_t first_vertex) {
    stitch->replaced[stitch->count.replaced++] = edge->triangle;
    add_triangle(stitch, fan_out(stitch, edge, first_vertex, edge->third), edge->to, edge->third);
}

/* A triangle in a corner of the tile may have two edges on the border, one on each side: the vertices of the first are
 * joined to the far end of the second, and those of the second to the last of the first. */
static void replace_corner(struct scree_stitch *stitch, const struct edge *first, const struct edge *second,
                           uint32_t first_vertex) {
    stitch->replaced[stitch->count.replaced++] = first->triangle;
    uint32_t apex = fan_out(stitch, first, first_vertex, second->to);
    add_triangle(stitch, fan_out(stitch, second, first_vertex, apex), second->to, apex);
}

/* Edges whose triangles have been dealt with in the corners, as numbers from the start and from the end of a side. */
struct done {
    bool first[SCREE_SIDES], last[SCREE_SIDES];
};

static void stitch_corners(const struct scree_stitch_tile *tile, const uint32_t ends[SCREE_SIDES + 1],
                           uint32_t first_vertex, struct scree_stitch *stitch, struct done *done) {
    for (int s = 0; s < SCREE_SIDES; s++) { /* the corner at the counter-clockwise end of each side */
        enum scree_side side = (enum scree_side)s, next = (enum scree_side)((s + 1) % SCREE_SIDES);
        bool *into = side == SCREE_SOUTH || side == SCREE_EAST ? &done->last[s] : &done->first[s];
        bool *out_of = next == SCREE_SOUTH || next == SCREE_EAST ? &done->first[next] : &done->last[next];
        uint32_t i = into == &done->last[s] ? tile->borders[s].vertex_count - 2 : 0;
        uint32_t j = out_of == &done->last[next] ? tile->borders[next].vertex_count - 2 : 0;
        if (tile->borders[side].apexes[i] / 3 != tile->borders[next].apexes[j] / 3) continue;
        struct edge first = edge_at(tile, stitch, side, i, ends[side], ends[side + 1]);
        struct edge second = edge_at(tile, stitch, next, j, ends[next], ends[next + 1]);
        *into = *out_of = true;
        if (first.count + second.count > 0) replace_corner(stitch, &first, &second, first_vertex);
    }
}

static void stitch_side(const struct scree_stitch_tile *tile, enum scree_side side, uint32_t first, uint32_t end,
                        uint32_t first_vertex, const struct done *done, struct scree_stitch *stitch) {
    uint32_t edges = tile->borders[side].vertex_count - 1;
    for (uint32_t i = 0; i < edges && first < end; i++) {
        struct edge edge = edge_at(tile, stitch, side, i, first, end);
        first = edge.first + edge.count;
        if (edge.count == 0 || (i == 0 && done->first[side]) || (i == edges - 1 && done->last[side])) continue;
        replace_triangle(stitch, &edge, first_vertex);
    }
}

enum scree_status scree_stitch_borders(const struct scree_stitch_tile *tile,
                                       const struct scree_stitch_neighbour *neighbours, uint32_t count,
                                       uint32_t first_vertex, struct scree_stitch *stitch, struct scree_error *error) {
    struct scree_stitch_size bound = scree_stitch_bound(tile, neighbours, count);
    uint32_t ends[SCREE_SIDES + 1] = {0}; /* further vertices of side s: ends[s] .. ends[s + 1] */
    struct done done = {{false}, {false}};
    stitch->count = (struct scree_stitch_size){0};
    for (int side = 0; side < SCREE_SIDES; side++)
        if (tile->borders[side].vertex_count < 2)
            return scree_fail(error, SCREE_E_ARGUMENT, "a tile without a mesh cannot be stitched");
    if (stitch->capacity.replaced < bound.replaced || stitch->capacity.vertices < bound.vertices ||
        stitch->capacity.triangles < bound.triangles)
        return scree_fail(error, SCREE_E_LIMIT, "stitching a tile takes room for %u vertices, not %u", bound.vertices,
                          stitch->capacity.vertices);
    for (int side = 0; side < SCREE_SIDES; side++) {
        struct merge merge = {
            .tile = tile,
            .side = (enum scree_side)side,
            .length = is_upright((enum scree_side)side) ? tile->header->rows : tile->header->columns,
            .last = -1,
            .stitch = stitch,
        };
        for (uint32_t n = 0; n < count; n++) {
            if (neighbours[n].side != merge.side) continue;
            enum scree_status status = merge_neighbour(&merge, &neighbours[n], n, error);
            if (status == SCREE_OK) continue;
            stitch->count = (struct scree_stitch_size){0};
            return status;
        }
        ends[side + 1] = stitch->count.vertices;
    }
    stitch_corners(tile, ends, first_vertex, stitch, &done);
    for (int side = 0; side < SCREE_SIDES; side++)
        stitch_side(tile, (enum scree_side)side, ends[side], ends[side + 1], first_vertex, &done, stitch);
    return SCREE_OK;
}
