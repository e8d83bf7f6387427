#include "tests/seam_check.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static struct seam_point point_of(struct seam_check *check, const struct scree_stitch_tile *tile,
                                  const struct scree_stitch *stitch, uint32_t first_vertex, uint32_t index) {
    bool further = stitch != NULL && index >= first_vertex;
    if (further && index - first_vertex >= stitch->count.vertices) {
        check->corners_beyond++;
        return (struct seam_point){0, 0, 0};
    }
    const struct scree_vertex *at = further ? &stitch->vertices[index - first_vertex] : &tile->vertices[index];
    if (at->x < 0 || at->y < 0 || at->x > tile->header->columns || at->y > tile->header->rows) check->corners_beyond++;
    return (struct seam_point){at->x, at->y, at->height};
}

/* Room for `more` items; stops the program when there is none. */
static void *make_room(void *items, size_t count, size_t more, size_t *room, size_t size_bytes) {
    if (count + more <= *room) return items;
    *room = 2 * *room + 1024;
    items = realloc(items, *room * size_bytes);
    if (items == NULL) {
        fprintf(stderr, "no memory for seams\n");
        exit(2);
    }
    return items;
}

static void add_triangle(struct seam_check *check, const struct seam_point corners[3], int64_t x, int64_t y) {
    int64_t area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                   (corners[2].x - corners[0].x) * (corners[1].y - corners[0].y);
    check->doubled_area += area;
    check->turned += area <= 0;
    check->edges = make_room(check->edges, check->edge_count, 3, &check->edge_room, sizeof *check->edges);
    for (int i = 0; i < 3; i++) {
        struct seam_edge edge = {corners[i], corners[(i + 1) % 3], 0};
        edge.steps_east = edge.to.x - edge.from.x;
        edge.from.x += x, edge.from.y += y, edge.to.x += x, edge.to.y += y;
        if (check->period > 0) edge.from.x %= check->period, edge.to.x %= check->period;
        check->edges[check->edge_count++] = edge;
    }
}

void seam_add(struct seam_check *check, const struct scree_stitch_tile *tile, uint32_t triangle_count,
              const struct scree_stitch *stitch, uint32_t first_vertex, int64_t x, int64_t y) {
    struct seam_point corners[3];
    bool *replaced = calloc(triangle_count + 1, sizeof *replaced);
    if (replaced == NULL) exit(2);
    check->tiles = make_room(check->tiles, check->tile_count, 1, &check->tile_room, sizeof *check->tiles);
    check->tiles[check->tile_count++] = (struct seam_tile){x, y, tile->header->columns, tile->header->rows};
    check->doubled_area -= 2 * (int64_t)tile->header->columns * tile->header->rows;
    for (uint32_t r = 0; stitch != NULL && r < stitch->count.replaced; r++) replaced[stitch->replaced[r]] = true;
    for (uint32_t t = 0; t < triangle_count; t++) {
        if (replaced[t]) continue;
        for (int i = 0; i < 3; i++)
            corners[i] = point_of(check, tile, NULL, first_vertex, tile->indices[3 * (size_t)t + i]);
        add_triangle(check, corners, x, y);
    }
    for (uint32_t t = 0; stitch != NULL && t < stitch->count.triangles; t++) {
        for (int i = 0; i < 3; i++)
            corners[i] = point_of(check, tile, stitch, first_vertex, stitch->indices[3 * (size_t)t + i]);
        add_triangle(check, corners, x, y);
    }
    free(replaced);
}

static int compare_points(const struct seam_point *a, const struct seam_point *b) {
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return (a->height > b->height) - (a->height < b->height);
}

static bool is_turned(const struct seam_edge *edge) {
    return compare_points(&edge->from, &edge->to) > 0;
}

/* Edges that join the same two points come together; equal ones cannot be told apart. */
static int compare_edges(const void *left, const void *right) {
    const struct seam_edge *a = left, *b = right;
    int order = compare_points(is_turned(a) ? &a->to : &a->from, is_turned(b) ? &b->to : &b->from);
    if (order == 0) order = compare_points(is_turned(a) ? &a->from : &a->to, is_turned(b) ? &b->from : &b->to);
    if (order != 0) return order;
    int64_t east = is_turned(a) ? -a->steps_east : a->steps_east;
    int64_t other = is_turned(b) ? -b->steps_east : b->steps_east;
    return east != other ? (east > other) - (east < other) : is_turned(a) - is_turned(b);
}

static bool joins_the_same(const struct seam_edge *a, const struct seam_edge *b) {
    return compare_points(&a->from, &b->to) == 0 && compare_points(&a->to, &b->from) == 0 &&
           a->steps_east == -b->steps_east;
}

/* Whether an edge lies on the side of a tile beyond which there is none at that place. */
static bool is_outline(const struct seam_check *check, const struct seam_edge *edge) {
    bool upright = edge->steps_east == 0;
    int64_t middle_x = 2 * edge->from.x + edge->steps_east, middle_y = edge->from.y + edge->to.y; /* doubled */
    int around = 0;
    if (!upright && edge->from.y != edge->to.y) return false;
    for (int way = -1; way <= 1; way += 2) {
        int64_t x = middle_x + (upright ? way : 0), y = middle_y + (upright ? 0 : way);
        if (check->period > 0) x = (x + 2 * check->period) % (2 * check->period);
        for (size_t t = 0; t < check->tile_count; t++) {
            const struct seam_tile *tile = &check->tiles[t];
            around += x > 2 * tile->x && x < 2 * (tile->x + tile->columns) && y > 2 * tile->y &&
                      y < 2 * (tile->y + tile->rows);
        }
    }
    return around == 1;
}

size_t seam_cracks(struct seam_check *check) {
    size_t cracks = 0;
    if (check->edge_count > 0) qsort(check->edges, check->edge_count, sizeof *check->edges, compare_edges);
    for (size_t i = 0; i < check->edge_count; i++) {
        if (i + 1 < check->edge_count && joins_the_same(&check->edges[i], &check->edges[i + 1]))
            i++;
        else
            cracks += !is_outline(check, &check->edges[i]);
    }
    return cracks;
}

void seam_free(struct seam_check *check) {
    free(check->edges);
    free(check->tiles);
    *check = (struct seam_check){0};
}
