#include "src/verify_stream_family.h"

#include <stdlib.h>

static int by_place(const struct scree_vertex *a, const struct scree_vertex *b) {
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->height != b->height) return a->height < b->height ? -1 : 1;
    return 0;
}

static int by_corners(const void *left, const void *right) {
    const struct family_triangle *a = left, *b = right;
    for (int k = 0; k < 3; k++) {
        int order = by_place(&a->corners[k], &b->corners[k]);
        if (order != 0) return order;
    }
    return 0;
}

static struct family_triangle triangle_of(const struct scree_arrays *arrays, uint32_t triangle, int32_t dx,
                                          int32_t dy) {
    struct scree_vertex corners[3];
    int least = 0;
    for (int k = 0; k < 3; k++) {
        corners[k] = arrays->vertices[arrays->indices[3 * (size_t)triangle + (size_t)k]];
        corners[k].x += dx;
        corners[k].y += dy;
        if (by_place(&corners[k], &corners[least]) < 0) least = k;
    }
    return (struct family_triangle){{corners[least], corners[(least + 1) % 3], corners[(least + 2) % 3]}};
}

/* Does the triangle lie in the window, borders included; or else all of it outside? */
static bool is_inside(const struct family_triangle *triangle, const struct lattice_window *window, bool *is_outside) {
    int64_t low_x = INT64_MAX, high_x = INT64_MIN, low_y = INT64_MAX, high_y = INT64_MIN;
    for (int k = 0; k < 3; k++) {
        const struct scree_vertex *corner = &triangle->corners[k];
        if (corner->x < low_x) low_x = corner->x;
        if (corner->x > high_x) high_x = corner->x;
        if (corner->y < low_y) low_y = corner->y;
        if (corner->y > high_y) high_y = corner->y;
    }
    int64_t east = window->x + window->columns, north = window->y + window->rows;
    *is_outside = high_x <= window->x || low_x >= east || high_y <= window->y || low_y >= north;
    return low_x >= window->x && high_x <= east && low_y >= window->y && high_y <= north;
}

enum scree_status family_part_new(struct scree_memory *memory, const struct scree_arrays *arrays, int32_t dx,
                                  int32_t dy, const struct lattice_window *window, struct family_part *part,
                                  struct scree_error *error) {
    *part = (struct family_part){0};
    part->triangles =
        scree_allocate(memory, arrays->triangle_count, sizeof *part->triangles, "triangles to compare", error);
    if (part->triangles == NULL) return SCREE_E_MEMORY;
    for (uint32_t t = 0; t < arrays->triangle_count; t++) {
        bool is_outside;
        struct family_triangle triangle = triangle_of(arrays, t, dx, dy);
        if (is_inside(&triangle, window, &is_outside)) {
            part->triangles[part->count++] = triangle;
        } else {
            part->crossing += !is_outside;
        }
    }
    qsort(part->triangles, part->count, sizeof *part->triangles, by_corners);
    return SCREE_OK;
}

void family_part_free(struct scree_memory *memory, struct family_part *part) {
    scree_release(memory, part->triangles);
    *part = (struct family_part){0};
}

uint32_t family_part_compare(const struct family_part *one, const struct family_part *other) {
    uint32_t i = 0, j = 0, lone = 0;
    while (i < one->count && j < other->count) {
        int order = by_corners(&one->triangles[i], &other->triangles[j]);
        i += order <= 0;
        j += order >= 0;
        lone += order != 0;
    }
    return lone + (one->count - i) + (other->count - j);
}
