#include "lod/tin_patch.h"

#include <math.h>
#include <stdlib.h>

#define NONE TIN_PATCH_NONE

void tin_patch_release(struct tin_patch *patch) {
    if (patch->memory == NULL) return;
    scree_release(patch->memory, patch->points);
    scree_release(patch->memory, patch->corners);
    scree_release(patch->memory, patch->twins);
    *patch = (struct tin_patch){0};
}

/* ---- numbers ---- */

static int by_number(const void *left, const void *right) {
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

static uint32_t place_of(const uint32_t *numbers, uint32_t count, uint32_t number) {
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (numbers[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Each point of the triangles once, ascending. */
static uint32_t *numbers_new(struct tin_patch *patch, const struct tin_lattice *lattice, const uint32_t *triangles,
                             struct scree_error *error) {
    size_t corners = 3 * (size_t)patch->triangle_count;
    uint32_t *numbers = scree_allocate(patch->memory, corners, sizeof *numbers, "the points of a tile", error);
    if (numbers == NULL) return NULL;
    for (size_t i = 0; i < corners; i++) numbers[i] = lattice->corners[3 * (size_t)triangles[i / 3] + i % 3];
    qsort(numbers, corners, sizeof *numbers, by_number);
    for (size_t i = 0; i < corners; i++)
        if (i == 0 || numbers[i] != numbers[i - 1]) numbers[patch->point_count++] = numbers[i];
    return numbers;
}

/* ---- half-edges ---- */

/* Joins half-edges that lead to and fro between two points. */
static enum scree_status join(struct tin_patch *patch, struct scree_error *error) {
    uint32_t edges = 3 * patch->triangle_count;
    enum scree_status status = SCREE_OK;
    uint32_t *first = scree_allocate(patch->memory, patch->point_count, sizeof *first, "edges of a tile", error);
    uint32_t *next = scree_allocate(patch->memory, edges, sizeof *next, "edges of a tile", error);
    patch->twins = scree_allocate(patch->memory, edges, sizeof *patch->twins, "edges of a tile", error);
    if (first == NULL || next == NULL || patch->twins == NULL) {
        status = error->status;
        goto cleanup;
    }
    for (uint32_t p = 0; p < patch->point_count; p++) first[p] = NONE;
    for (uint32_t edge = edges; edge-- > 0;) {
        next[edge] = first[patch->corners[edge]];
        first[patch->corners[edge]] = edge;
    }
    for (uint32_t edge = 0; edge < edges; edge++) {
        uint32_t twin = first[tin_patch_target(patch, edge)];
        while (twin != NONE && tin_patch_target(patch, twin) != patch->corners[edge]) twin = next[twin];
        patch->twins[edge] = twin;
    }
cleanup:
    scree_release(patch->memory, next);
    scree_release(patch->memory, first);
    return status;
}

enum scree_status tin_patch_make(struct scree_memory *memory, const struct tin_lattice *lattice, int32_t column,
                                 int32_t row, struct tin_patch *patch, struct scree_error *error) {
    size_t tile = (size_t)row * (size_t)lattice->tiles_x + (size_t)column;
    const uint32_t *triangles = lattice->triangles + lattice->first[tile];
    *patch = (struct tin_patch){.memory = memory, .triangle_count = lattice->first[tile + 1] - lattice->first[tile]};
    enum scree_status status = SCREE_OK;
    uint32_t *numbers = numbers_new(patch, lattice, triangles, error);
    patch->points = scree_allocate(memory, patch->point_count, sizeof *patch->points, "the points of a tile", error);
    patch->corners =
        scree_allocate(memory, 3 * (size_t)patch->triangle_count, sizeof *patch->corners, "a tile's triangles", error);
    if (numbers == NULL || patch->points == NULL || patch->corners == NULL) {
        status = error->status;
        goto cleanup;
    }
    for (uint32_t p = 0; p < patch->point_count; p++) {
        patch->points[p] = lattice->points[numbers[p]];
        patch->points[p].x -= column * lattice->tile_span;
        patch->points[p].y -= row * lattice->tile_span;
    }
    for (size_t i = 0; i < 3 * (size_t)patch->triangle_count; i++)
        patch->corners[i] =
            place_of(numbers, patch->point_count, lattice->corners[3 * (size_t)triangles[i / 3] + i % 3]);
    status = join(patch, error);
cleanup:
    scree_release(memory, numbers);
    if (status != SCREE_OK) tin_patch_release(patch);
    return status;
}

/* ---- places ---- */

static int64_t area2(const struct tin_post *a, const struct tin_post *b, const struct tin_post *p) {
    return ((int64_t)b->x - a->x) * ((int64_t)p->y - a->y) - ((int64_t)b->y - a->y) * ((int64_t)p->x - a->x);
}

/* How far p is to the right of the line from a to b. */
static double outside_by(const struct tin_post *a, const struct tin_post *b, const struct tin_post *p) {
    return -(double)area2(a, b, p) / hypot((double)b->x - a->x, (double)b->y - a->y);
}

static bool is_near(const struct tin_post *a, const struct tin_post *b, const struct tin_post *c,
                    const struct tin_post *p, int32_t slack) {
    if (p->x < a->x - slack && p->x < b->x - slack && p->x < c->x - slack) return false;
    if (p->x > a->x + slack && p->x > b->x + slack && p->x > c->x + slack) return false;
    if (p->y < a->y - slack && p->y < b->y - slack && p->y < c->y - slack) return false;
    return p->y <= a->y + slack || p->y <= b->y + slack || p->y <= c->y + slack;
}

static void interpolate(const struct tin_post *a, const struct tin_post *b, const struct tin_post *c,
                        struct tin_post *p) {
    double area = (double)area2(a, b, c);
    double of_a = (double)area2(b, c, p) / area, of_b = (double)area2(c, a, p) / area, of_c = 1 - of_a - of_b;
    p->height_m = (float)(of_a * a->height_m + of_b * b->height_m + of_c * c->height_m);
    p->slope = (struct slope){(float)(of_a * a->slope.east + of_b * b->slope.east + of_c * c->slope.east),
                              (float)(of_a * a->slope.north + of_b * b->slope.north + of_c * c->slope.north)};
}

/* The first triangle that counts, so that every patch which has the place tells the same. */
static bool find(const struct tin_patch *patch, int32_t slack, struct tin_post *post) {
    for (uint32_t t = 0; t < patch->triangle_count; t++) {
        const struct tin_post *a = &patch->points[patch->corners[3 * (size_t)t]];
        const struct tin_post *b = &patch->points[patch->corners[3 * (size_t)t + 1]];
        const struct tin_post *c = &patch->points[patch->corners[3 * (size_t)t + 2]];
        if (!is_near(a, b, c, post, slack) || area2(a, b, c) <= 0) continue;
        bool covers = area2(a, b, post) >= 0 && area2(b, c, post) >= 0 && area2(c, a, post) >= 0;
        if (!covers && slack > 0)
            covers =
                outside_by(a, b, post) <= slack && outside_by(b, c, post) <= slack && outside_by(c, a, post) <= slack;
        if (!covers) continue;
        interpolate(a, b, c, post);
        return true;
    }
    return false;
}

bool tin_patch_covers(const struct tin_patch *patch, int32_t slack, struct tin_post *post) {
    return find(patch, 0, post) || (slack > 0 && find(patch, slack, post));
}

struct tin_post tin_patch_cross(const struct tin_patch *patch, uint32_t a, uint32_t b, bool is_upright, int32_t at) {
    const struct tin_post *from = &patch->points[a < b ? a : b], *to = &patch->points[a < b ? b : a];
    double dx = (double)to->x - from->x, dy = (double)to->y - from->y;
    double share = is_upright ? ((double)at - from->x) / dx : ((double)at - from->y) / dy;
    /* from the point on, which is the same way in every tile */
    return (struct tin_post){is_upright ? at : from->x + (int32_t)lrint(share * dx),
                             is_upright ? from->y + (int32_t)lrint(share * dy) : at,
                             (float)(from->height_m + share * ((double)to->height_m - from->height_m)),
                             {(float)(from->slope.east + share * ((double)to->slope.east - from->slope.east)),
                              (float)(from->slope.north + share * ((double)to->slope.north - from->slope.north))}};
}
