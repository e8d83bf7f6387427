#include "stream/player_border.h"

#include <stdlib.h>

static unsigned sides_of(const struct player_border *border, const struct scree_vertex *vertex) {
    return (unsigned)(vertex->y == 0) << SCREE_SOUTH | (unsigned)(vertex->x == border->columns) << SCREE_EAST |
           (unsigned)(vertex->y == border->rows) << SCREE_NORTH | (unsigned)(vertex->x == 0) << SCREE_WEST;
}

/* Lattice steps from the western or southern end of a side. */
static uint32_t place_on(unsigned side, const struct scree_vertex *vertex) {
    return (uint32_t)(side == SCREE_SOUTH || side == SCREE_NORTH ? vertex->x : vertex->y);
}

static int by_place(const void *a, const void *b) {
    uint64_t first = *(const uint64_t *)a, second = *(const uint64_t *)b; /* no two have the same vertex */
    return first < second ? -1 : first > second;
}

static bool grow_side(struct scree_memory *memory, struct player_side *side, size_t count, struct scree_error *error) {
    static const char what[] = "the border's vertices";
    uint64_t *places = scree_reallocate(memory, side->places, count, sizeof *places, what, error);
    if (places == NULL) return false;
    side->places = places;
    uint32_t *vertices = scree_reallocate(memory, side->vertices, count, sizeof *vertices, what, error);
    if (vertices == NULL) return false;
    side->vertices = vertices;
    uint32_t *apexes = scree_reallocate(memory, side->apexes, count, sizeof *apexes, what, error);
    if (apexes == NULL) return false;
    side->apexes = apexes;
    return true;
}

bool player_border_extend(struct player_border *border, struct scree_error *error) {
    const struct progressive *progressive = border->progressive;
    uint32_t vertex_count = progressive->vertex_count;
    unsigned char *on_sides =
        scree_reallocate(border->memory, border->on_sides, vertex_count, 1, "the border's vertices", error);
    if (on_sides == NULL) return false;
    border->on_sides = on_sides;
    uint32_t added[SCREE_SIDES] = {0};
    for (uint32_t i = border->vertices_known; i < vertex_count; i++) {
        unsigned sides = sides_of(border, &progressive->vertices[i]);
        on_sides[i] = (unsigned char)sides;
        for (unsigned side = 0; side < SCREE_SIDES; side++) added[side] += sides >> side & 1;
    }
    for (unsigned side = 0; side < SCREE_SIDES; side++)
        if (!grow_side(border->memory, &border->sides[side], (size_t)border->sides[side].count + added[side], error))
            return false;
    for (uint32_t i = border->vertices_known; i < vertex_count; i++)
        for (unsigned side = 0; side < SCREE_SIDES; side++)
            if ((on_sides[i] >> side & 1) != 0) {
                struct player_side *list = &border->sides[side];
                list->places[list->count++] = (uint64_t)place_on(side, &progressive->vertices[i]) << 32 | i;
            }
    for (unsigned side = 0; side < SCREE_SIDES; side++)
        if (added[side] > 0) qsort(border->sides[side].places, border->sides[side].count, sizeof(uint64_t), by_place);
    border->vertices_known = vertex_count;
    border->current = false;
    return true;
}

/* Which of the present vertices of a side lies at this place; vertices at the place of another do not occur. */
static uint32_t index_at(const struct player_border *border, unsigned side, uint32_t place) {
    const struct player_side *list = &border->sides[side];
    uint32_t low = 0, high = list->present;
    while (low + 1 < high) {
        uint32_t middle = low + (high - low) / 2;
        if (place_on(side, &border->progressive->vertices[list->vertices[middle]]) <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* If the edge opposite of a corner lies on the border, this corner is its apex. */
static void note_apex(struct player_border *border, uint32_t apex, uint32_t a, uint32_t b) {
    unsigned common = border->on_sides[a] & border->on_sides[b];
    for (unsigned side = 0; common >> side != 0; side++) {
        if ((common >> side & 1) == 0) continue;
        uint32_t place_a = place_on(side, &border->progressive->vertices[a]);
        uint32_t place_b = place_on(side, &border->progressive->vertices[b]);
        border->sides[side].apexes[index_at(border, side, place_a < place_b ? place_a : place_b)] = apex;
    }
}

void player_border_update(struct player_border *border, const struct playback *playback) {
    if (border->current) return;
    border->current = true;
    uint32_t vertex_count = playback_vertices(playback), slot_count = 3 * playback_triangles(playback);
    for (unsigned side = 0; side < SCREE_SIDES; side++) {
        struct player_side *list = &border->sides[side];
        list->present = 0;
        for (uint32_t i = 0; i < list->count; i++)
            if (player_border_vertex(list->places[i]) < vertex_count) {
                list->apexes[list->present] = 0;
                list->vertices[list->present++] = player_border_vertex(list->places[i]);
            }
    }
    const uint32_t *corners = playback->corners;
    const unsigned char *on_sides = border->on_sides;
    for (uint32_t slot = 0; slot < slot_count; slot += 3) {
        uint32_t a = corners[slot], b = corners[slot + 1], c = corners[slot + 2];
        unsigned sides_a = on_sides[a], sides_b = on_sides[b], sides_c = on_sides[c];
        if (((sides_a & sides_b) | (sides_b & sides_c) | (sides_c & sides_a)) == 0) continue;
        note_apex(border, slot + 2, a, b);
        note_apex(border, slot, b, c);
        note_apex(border, slot + 1, c, a);
    }
}

void player_border_release(struct player_border *border) {
    for (unsigned side = SCREE_SIDES; side-- > 0;) {
        scree_release(border->memory, border->sides[side].apexes);
        scree_release(border->memory, border->sides[side].vertices);
        scree_release(border->memory, border->sides[side].places);
    }
    scree_release(border->memory, border->on_sides);
    *border = (struct player_border){0};
}
