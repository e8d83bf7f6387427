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

static void add_triangle(struct seam_check *check, const struct seam_point corners[3], int64_t x, int64_t y) {
    int64_t area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                   (corners[2].x - corners[0].x) * (corners[1].y - corners[0].y);
    check->doubled_area += area;
    check->turned_triangles += area <= 0;
    if (check->count + 3 > check->room) {
        check->room = 2 * check->room + 1024;
        check->edges = realloc(check->edges, check->room * sizeof *check->edges);
        if (check->edges == NULL) {
            fprintf(stderr, "no memory for edges\n");
            exit(2);
        }
    }
    for (int i = 0; i < 3; i++) {
        struct seam_edge edge = {corners[i], corners[(i + 1) % 3], 0};
        edge.steps_east = edge.to.x - edge.from.x;
        edge.from.x += x, edge.from.y += y, edge.to.x += x, edge.to.y += y;
        if (check->period > 0) edge.from.x %= check->period, edge.to.x %= check->period;
        check->edges[check->count++] = edge;
    }
}

void seam_add(struct seam_check *check, const struct scree_stitch_tile *tile, uint32_t triangle_count,
              const struct scree_stitch *stitch, uint32_t first_vertex, int64_t x, int64_t y) {
    struct seam_point corners[3];
    for (uint32_t t = 0; t < triangle_count; t++) {
        bool replaced = false;
        for (uint32_t r = 0; stitch != NULL && r < stitch->count.replaced; r++)
            if (stitch->replaced[r] == t) replaced = true;
        if (replaced) continue;
        for (int i = 0; i < 3; i++)
            corners[i] = point_of(check, tile, NULL, first_vertex, tile->indices[3 * (size_t)t + i]);
        add_triangle(check, corners, x, y);
    }
    for (uint32_t t = 0; stitch != NULL && t < stitch->count.triangles; t++) {
        for (int i = 0; i < 3; i++)
            corners[i] = point_of(check, tile, stitch, first_vertex, stitch->indices[3 * (size_t)t + i]);
        add_triangle(check, corners, x, y);
    }
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

size_t seam_open_edges(struct seam_check *check) {
    size_t open = 0;
    if (check->count > 0) qsort(check->edges, check->count, sizeof *check->edges, compare_edges);
    for (size_t i = 0; i < check->count; i++) {
        if (i + 1 < check->count && joins_the_same(&check->edges[i], &check->edges[i + 1]))
            i++;
        else
            check->edges[open++] = check->edges[i];
    }
    return open;
}

void seam_free(struct seam_check *check) {
    free(check->edges);
    *check = (struct seam_check){0};
}
