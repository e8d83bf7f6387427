#include "src/verify_cover.h"

#include <stdlib.h>

static int64_t double_area(const struct decoded_tile *tile, const uint32_t corners[3]) {
    int64_t u0 = tile->u[corners[0]], v0 = tile->v[corners[0]];
    return (tile->u[corners[1]] - u0) * (tile->v[corners[2]] - v0) -
           (tile->u[corners[2]] - u0) * (tile->v[corners[1]] - v0);
}

/* first[i]: the first vertex at the place of vertex i. A tile may have several (clients' limits, seams of normals);
 * for the topology they are one. */
static enum scree_status weld(struct scree_memory *memory, const struct decoded_tile *tile, uint32_t *first,
                              struct cover_result *result, struct scree_error *error) {
    size_t slots = 16;
    while (slots < 2 * (size_t)tile->vertex_count) slots *= 2;
    uint32_t *table = scree_allocate(memory, slots, sizeof *table, "a table of places", error); /* vertex + 1 */
    if (table == NULL) return error->status;
    for (uint32_t i = 0; i < tile->vertex_count; i++) {
        uint32_t place = (uint32_t)tile->u[i] << 16 | tile->v[i];
        size_t slot = (place * UINT32_C(2654435769) >> 7) & (slots - 1);
        first[i] = i;
        for (; table[slot] != 0; slot = (slot + 1) & (slots - 1)) {
            uint32_t other = table[slot] - 1;
            if (tile->u[other] != tile->u[i] || tile->v[other] != tile->v[i]) continue;
            first[i] = other;
            result->walls += tile->h[other] != tile->h[i];
            break;
        }
        if (first[i] == i) table[slot] = i + 1;
    }
    scree_release(memory, table);
    return SCREE_OK;
}

static int compare_numbers(const void *left, const void *right) {
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

/* Directed edges by the vertex that they leave: ends[starts[a]] .. ends[starts[a + 1] - 1], ascending. */
struct edge_table {
    uint32_t *starts, *ends;
};

static enum scree_status edge_table_new(struct scree_memory *memory, const struct decoded_tile *tile,
                                        const uint32_t *first, struct edge_table *edges, struct scree_error *error) {
    size_t edge_count = 3 * (size_t)tile->triangle_count;
    edges->starts = scree_allocate(memory, (size_t)tile->vertex_count + 2, sizeof *edges->starts, "edges", error);
    if (edges->starts == NULL) return error->status;
    edges->ends = scree_allocate(memory, edge_count, sizeof *edges->ends, "edges", error);
    if (edges->ends == NULL) return error->status;
    for (size_t e = 0; e < edge_count; e++) edges->starts[first[tile->corners[e]] + 2]++;
    for (uint32_t i = 0; i < tile->vertex_count; i++) edges->starts[i + 2] += edges->starts[i + 1];
    for (size_t t = 0; t < edge_count; t += 3)
        for (size_t k = 0; k < 3; k++) {
            uint32_t from = first[tile->corners[t + k]];
            edges->ends[edges->starts[from + 1]++] = first[tile->corners[t + (k + 1) % 3]];
        }
    for (uint32_t i = 0; i < tile->vertex_count; i++)
        qsort(edges->ends + edges->starts[i], edges->starts[i + 1] - edges->starts[i], sizeof *edges->ends,
              compare_numbers);
    return SCREE_OK;
}

static bool has_edge(const struct edge_table *edges, uint32_t from, uint32_t to) {
    return bsearch(&to, edges->ends + edges->starts[from], edges->starts[from + 1] - edges->starts[from],
                   sizeof *edges->ends, compare_numbers) != NULL;
}

/* Length of an edge that runs along the border with the window to its left; 0 for any other. */
static int64_t border_length(const struct decoded_tile *tile, uint16_t right, uint16_t top, uint32_t from,
                             uint32_t to) {
    int32_t u0 = tile->u[from], v0 = tile->v[from], u1 = tile->u[to], v1 = tile->v[to];
    if (v0 == 0 && v1 == 0 && u1 > u0) return u1 - u0;
    if (u0 == right && u1 == right && v1 > v0) return v1 - v0;
    if (v0 == top && v1 == top && u1 < u0) return u0 - u1;
    if (u0 == 0 && u1 == 0 && v1 < v0) return v0 - v1;
    return 0;
}

/* Books open and repeated edges; returns the length of the border that was found. */
static int64_t match_edges(const struct decoded_tile *tile, uint16_t right, uint16_t top,
                           const struct edge_table *edges, struct cover_result *result) {
    int64_t around = 0;
    for (uint32_t from = 0; from < tile->vertex_count; from++)
        for (uint32_t e = edges->starts[from]; e < edges->starts[from + 1]; e++) {
            uint32_t to = edges->ends[e];
            if (e > edges->starts[from] && edges->ends[e - 1] == to) result->repeated_edges++;
            if (has_edge(edges, to, from)) continue;
            int64_t length = border_length(tile, right, top, from, to);
            if (length == 0) result->open_edges++;
            around += length;
        }
    return around;
}

enum scree_status cover_check(struct scree_memory *memory, const struct decoded_tile *tile, uint16_t right,
                              uint16_t top, struct cover_result *result, struct scree_error *error) {
    struct edge_table edges = {NULL, NULL};
    *result = (struct cover_result){0};
    uint32_t *first = scree_allocate(memory, tile->vertex_count, sizeof *first, "places of vertices", error);
    enum scree_status status = first == NULL ? error->status : weld(memory, tile, first, result, error);
    if (status != SCREE_OK) goto cleanup;
    status = edge_table_new(memory, tile, first, &edges, error);
    if (status != SCREE_OK) goto cleanup;
    for (uint32_t i = 0; i < tile->vertex_count; i++)
        result->outside_vertices += tile->u[i] > right || tile->v[i] > top;
    for (uint32_t t = 0; t < tile->triangle_count; t++) {
        int64_t area = double_area(tile, tile->corners + 3 * (size_t)t);
        result->flat_triangles += area == 0;
        result->flipped_triangles += area < 0;
        result->double_area += area;
    }
    int64_t around = match_edges(tile, right, top, &edges, result);
    result->is_exact = result->flat_triangles == 0 && result->flipped_triangles == 0 && result->outside_vertices == 0 &&
                       result->walls == 0 && result->open_edges == 0 && result->repeated_edges == 0 &&
                       around == 2 * ((int64_t)right + top) && result->double_area == 2 * (int64_t)right * top;
cleanup:
    scree_release(memory, edges.ends);
    scree_release(memory, edges.starts);
    scree_release(memory, first);
    return status;
}
