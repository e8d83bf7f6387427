#include "stream/player_arrays.h"

#include <math.h>
#include <string.h>

static void put_position(struct player_arrays *arrays, const struct scree_vertex *vertex, float to[3]) {
    double position_m[3];
    scree_stream_position(arrays->header, &arrays->frame, vertex->x, vertex->y,
                          ldexp(vertex->height, arrays->header->height_exponent), position_m);
    for (int i = 0; i < 3; i++) to[i] = (float)position_m[i];
}

/* The new vertices between two of a side that the rung before has rise from the straight edge between these. Always
 * from the lower place to the higher, so that both tiles of a border compute the same. */
static void put_edge_origins(struct player_arrays *arrays, const struct player_side *side, uint32_t before,
                             uint32_t after) {
    const float *from = &arrays->positions[3 * (size_t)player_border_vertex(side->places[before])];
    const float *to = &arrays->positions[3 * (size_t)player_border_vertex(side->places[after])];
    double place = player_border_place(side->places[before]);
    double length = player_border_place(side->places[after]) - place;
    for (uint32_t i = before + 1; i < after; i++) {
        float *origin = &arrays->origins[3 * (size_t)player_border_vertex(side->places[i])];
        double share = (player_border_place(side->places[i]) - place) / length;
        for (int k = 0; k < 3; k++) origin[k] = (float)(from[k] + share * ((double)to[k] - from[k]));
    }
}

/* Origins of the new vertices of the border. */
static void put_border_origins(struct player_arrays *arrays, const struct player_border *border, uint32_t first) {
    for (unsigned side = 0; side < SCREE_SIDES; side++) {
        const struct player_side *list = &border->sides[side];
        uint32_t before = 0;
        for (uint32_t i = 0; i < list->count; i++)
            if (player_border_vertex(list->places[i]) < first) {
                put_edge_origins(arrays, list, before, i);
                before = i;
            }
    }
}

/* Where the vertices of an increment come from. Those inside: out of their parent, or out of what it came out of
 * itself if it is as new. */
static void put_origins(struct player_arrays *arrays, const struct player_border *border, uint32_t rung, uint32_t first,
                        uint32_t end) {
    const struct progressive *progressive = arrays->progressive;
    const size_t size_bytes = 3 * sizeof(float);
    memcpy(&arrays->origins[3 * (size_t)first], &arrays->positions[3 * (size_t)first], (end - first) * size_bytes);
    if (rung == 0) return;
    put_border_origins(arrays, border, first);
    for (uint32_t i = first; i < end; i++) {
        uint32_t parent = progressive->splits[i - progressive->base_vertices].parent;
        if (border->on_sides[i] != 0) continue;
        const float *from = parent < first ? arrays->positions : arrays->origins;
        memcpy(&arrays->origins[3 * (size_t)i], &from[3 * (size_t)parent], size_bytes);
    }
}

static bool grow(struct player_arrays *arrays, float **array, bool wanted, struct scree_error *error) {
    if (!wanted) return true;
    float *grown = scree_reallocate(arrays->memory, *array, arrays->progressive->vertex_count, 3 * sizeof **array,
                                    "the vertices' positions", error);
    if (grown != NULL) *array = grown;
    return grown != NULL;
}

bool player_arrays_extend(struct player_arrays *arrays, const struct player_border *border, uint32_t rung,
                          struct scree_error *error) {
    const struct progressive *progressive = arrays->progressive;
    uint32_t first = arrays->vertices_known, end = progressive->vertex_count;
    uint16_t *increments = scree_reallocate(arrays->memory, arrays->increments, end, sizeof *increments,
                                            "the vertices' increments", error);
    if (increments == NULL) return false;
    arrays->increments = increments;
    if (!grow(arrays, &arrays->positions, arrays->with_positions, error) ||
        !grow(arrays, &arrays->normals, arrays->with_normals, error) ||
        !grow(arrays, &arrays->origins, arrays->with_origins, error))
        return false;
    if (first == 0) scree_stream_frame(arrays->header, &arrays->frame);
    for (uint32_t i = first; i < end; i++) {
        increments[i] = (uint16_t)rung;
        if (arrays->with_positions) put_position(arrays, &progressive->vertices[i], &arrays->positions[3 * (size_t)i]);
    }
    if (arrays->with_origins) put_origins(arrays, border, rung, first, end);
    arrays->vertices_known = end;
    arrays->current = false;
    return true;
}

/* Twice the area along the normal. */
static void add_triangle(const float *positions, float *normals, const uint32_t corners[3]) {
    const float *a = &positions[3 * (size_t)corners[0]];
    const float *b = &positions[3 * (size_t)corners[1]];
    const float *c = &positions[3 * (size_t)corners[2]];
    float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    float v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    float normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    for (int corner = 0; corner < 3; corner++) {
        float *sum = &normals[3 * (size_t)corners[corner]];
        for (int i = 0; i < 3; i++) sum[i] += normal[i];
    }
}

/* A vertex whose triangles have no area has what is up as its normal: all of a pole's posts are one point. */
static void put_upward(const struct player_arrays *arrays, uint32_t vertex, float normal[3]) {
    const struct scree_vertex *at = &arrays->progressive->vertices[vertex];
    double low[3], high[3];
    scree_stream_position(arrays->header, &arrays->frame, at->x, at->y, 0, low);
    scree_stream_position(arrays->header, &arrays->frame, at->x, at->y, 1, high);
    for (int i = 0; i < 3; i++) normal[i] = (float)(high[i] - low[i]);
}

void player_arrays_update(struct player_arrays *arrays, const struct playback *playback) {
    if (arrays->current || !arrays->with_normals) return;
    arrays->current = true;
    uint32_t vertex_count = playback_vertices(playback), slot_count = 3 * playback_triangles(playback);
    float *normals = arrays->normals;
    if (vertex_count > 0) memset(normals, 0, 3 * (size_t)vertex_count * sizeof *normals);
    for (uint32_t slot = 0; slot < slot_count; slot += 3)
        add_triangle(arrays->positions, normals, &playback->corners[slot]);
    for (uint32_t i = 0; i < vertex_count; i++) {
        float *normal = &normals[3 * (size_t)i];
        float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        if (length > 0)
            for (int k = 0; k < 3; k++) normal[k] /= length;
        else
            put_upward(arrays, i, normal);
    }
}

void player_arrays_release(struct player_arrays *arrays) {
    scree_release(arrays->memory, arrays->origins);
    scree_release(arrays->memory, arrays->normals);
    scree_release(arrays->memory, arrays->positions);
    scree_release(arrays->memory, arrays->increments);
    *arrays = (struct player_arrays){0};
}
