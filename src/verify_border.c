#include "src/verify_border.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_on_side(const struct decoded_tile *tile, const struct tile_frame *frame, uint32_t vertex,
                       enum edge_side side, uint16_t *at) {
    *at = side == EDGE_WEST || side == EDGE_EAST ? tile->v[vertex] : tile->u[vertex];
    if (side == EDGE_WEST) return tile->u[vertex] == 0;
    if (side == EDGE_SOUTH) return tile->v[vertex] == 0;
    if (side == EDGE_EAST) return tile->u[vertex] == frame->right;
    return tile->v[vertex] == frame->top;
}

/* By place, then height, then normal: of several vertices at a place any would do, but always the same one. */
static int compare_vertices(const void *left, const void *right) {
    const struct border_vertex *a = left, *b = right;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    if (a->height_m != b->height_m) return a->height_m < b->height_m ? -1 : 1;
    return memcmp(a->normal, b->normal, sizeof a->normal);
}

enum scree_status tile_border_new(struct scree_memory *memory, const struct decoded_tile *tile,
                                  const struct tile_frame *frame, enum edge_side side, struct tile_border *border,
                                  struct scree_error *error) {
    uint32_t count = 0, kept = 0;
    uint16_t at;
    *border = (struct tile_border){.has_normals = tile->normals != NULL};
    for (uint32_t i = 0; i < tile->vertex_count; i++) count += is_on_side(tile, frame, i, side, &at);
    border->vertices = scree_allocate(memory, count, sizeof *border->vertices, "a border", error);
    if (border->vertices == NULL) return error->status;
    count = 0;
    for (uint32_t i = 0; i < tile->vertex_count; i++) {
        if (!is_on_side(tile, frame, i, side, &at)) continue;
        struct border_vertex *vertex = &border->vertices[count++];
        vertex->at = at;
        vertex->height_m = decoded_height_m(tile, i);
        if (tile->normals != NULL) memcpy(vertex->normal, tile->normals + 2 * (size_t)i, 2);
    }
    qsort(border->vertices, count, sizeof *border->vertices, compare_vertices);
    for (uint32_t i = 0; i < count; i++)
        if (kept == 0 || border->vertices[kept - 1].at != border->vertices[i].at)
            border->vertices[kept++] = border->vertices[i];
    border->count = kept;
    return SCREE_OK;
}

void tile_border_free(struct scree_memory *memory, struct tile_border *border) {
    scree_release(memory, border->vertices);
    *border = (struct tile_border){0};
}

/* Height at a place that is not before the vertex *cursor; moves the cursor there. Beyond the ends: the end's. */
static double height_at(const struct tile_border *border, uint32_t *cursor, uint16_t at) {
    const struct border_vertex *vertices = border->vertices;
    while (*cursor + 1 < border->count && vertices[*cursor + 1].at <= at) ++*cursor;
    const struct border_vertex *low = &vertices[*cursor];
    if (low->at >= at || *cursor + 1 == border->count) return low->height_m;
    const struct border_vertex *high = low + 1;
    double share = (double)(at - low->at) / (high->at - low->at);
    return low->height_m + share * (high->height_m - low->height_m);
}

struct border_difference tile_border_compare(const struct tile_border *one, const struct tile_border *other) {
    struct border_difference difference = {0};
    uint32_t i = 0, j = 0, i_cursor = 0, j_cursor = 0;
    if (one->count == 0 || other->count == 0) {
        difference.lone_vertices = one->count + other->count;
        if (difference.lone_vertices != 0) difference.largest_m = INFINITY;
        return difference;
    }
    while (i < one->count || j < other->count) {
        bool take_one = j == other->count || (i < one->count && one->vertices[i].at <= other->vertices[j].at);
        bool take_other = i == one->count || (j < other->count && other->vertices[j].at <= one->vertices[i].at);
        uint16_t at = take_one ? one->vertices[i].at : other->vertices[j].at;
        double apart_m = fabs(height_at(one, &i_cursor, at) - height_at(other, &j_cursor, at));
        difference.largest_m = fmax(difference.largest_m, apart_m);
        difference.lone_vertices += take_one != take_other;
        if (take_one && take_other && one->has_normals && other->has_normals &&
            memcmp(one->vertices[i].normal, other->vertices[j].normal, 2) != 0) {
            if (difference.normals == 0) difference.normal_at = at;
            difference.normals++;
        }
        i += take_one;
        j += take_other;
    }
    return difference;
}
