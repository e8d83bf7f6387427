#include "lod/merge.h"

#include <stdlib.h>

/* A vertex on the cross, in the parent's steps. */
struct cross_vertex {
    int32_t x, y, height;
    uint32_t number; /* over all children in a row */
};

static int by_place(const void *left, const void *right) {
    const struct cross_vertex *a = left, *b = right;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return a->number < b->number ? -1 : 1;
}

static struct scree_vertex in_parent(const struct scree_mesh *const children[4], int child, uint32_t v,
                                     int32_t child_span) {
    struct scree_vertex vertex = children[child]->vertices[v];
    vertex.x += child % 2 * child_span;
    vertex.y += child / 2 * child_span;
    return vertex;
}

/* Lists the vertices on the cross; `cross` may be NULL to count them. */
static size_t list_cross(const struct scree_mesh *const children[4], int32_t child_span, struct cross_vertex *cross) {
    size_t count = 0;
    uint32_t number = 0;
    for (int child = 0; child < 4; child++) {
        if (children[child] == NULL) continue;
        for (uint32_t v = 0; v < children[child]->vertex_count; v++, number++) {
            struct scree_vertex at = in_parent(children, child, v, child_span);
            if (at.x != child_span && at.y != child_span) continue;
            if (cross != NULL) cross[count] = (struct cross_vertex){at.x, at.y, at.height, number};
            count++;
        }
    }
    return count;
}

/* representative[number] of every later copy of a cross vertex is the number of the first. */
static enum scree_status pair_cross(const struct cross_vertex *cross, size_t count, uint32_t *representative,
                                    struct scree_error *error) {
    for (size_t i = 1; i < count; i++) {
        if (cross[i].x != cross[i - 1].x || cross[i].y != cross[i - 1].y) continue;
        if (cross[i].height != cross[i - 1].height)
            return scree_fail(error, SCREE_E_CORRUPT, "tiles disagree about the height of a common border vertex");
        representative[cross[i].number] = representative[cross[i - 1].number];
    }
    return SCREE_OK;
}

/* Copies vertices and triangles; representative[] becomes the vertex's index in the mesh. */
static void fill(const struct scree_mesh *const children[4], int32_t child_span, uint32_t *representative,
                 struct mesh *mesh) {
    uint32_t number = 0;
    for (int child = 0; child < 4; child++) {
        if (children[child] == NULL) continue;
        uint32_t base = number;
        for (uint32_t v = 0; v < children[child]->vertex_count; v++, number++) {
            if (representative[number] != number) { /* an earlier child brought it, its index is known */
                representative[number] = representative[representative[number]];
                continue;
            }
            struct scree_vertex at = in_parent(children, child, v, child_span);
            mesh->heights[mesh->vertex_count] = at.height;
            mesh->vertices[mesh->vertex_count].at = (struct sample){at.x, at.y, 0};
            representative[number] = (uint32_t)mesh->vertex_count++;
        }
        for (uint32_t t = 0; t < children[child]->triangle_count; t++, mesh->triangle_count++)
            for (int i = 0; i < 3; i++)
                mesh->triangles[mesh->triangle_count].vertex[i] =
                    (int32_t)representative[base + children[child]->corners[3 * t + (uint32_t)i]];
    }
}

enum scree_status mesh_merge(struct scree_memory *memory, const struct scree_mesh *const children[4],
                             int32_t child_span, struct mesh *mesh, struct scree_error *error) {
    enum scree_status status = SCREE_E_MEMORY;
    size_t vertices = 0, triangles = 0, cross_count = list_cross(children, child_span, NULL);
    for (int child = 0; child < 4; child++) {
        vertices += children[child] != NULL ? children[child]->vertex_count : 0;
        triangles += children[child] != NULL ? children[child]->triangle_count : 0;
    }
    if (vertices > INT32_MAX / 4 || triangles > INT32_MAX / 4)
        return scree_fail(error, SCREE_E_LIMIT, "four tiles of %zu vertices are more than one mesh holds", vertices);
    struct cross_vertex *cross = scree_allocate(memory, cross_count, sizeof *cross, "common borders", error);
    uint32_t *representative = scree_allocate(memory, vertices, sizeof *representative, "common borders", error);
    if (cross == NULL || representative == NULL ||
        mesh_allocate(memory, (int32_t)vertices, (int32_t)triangles, mesh, error) != SCREE_OK)
        goto cleanup;
    for (uint32_t i = 0; i < vertices; i++) representative[i] = i;
    list_cross(children, child_span, cross);
    if (cross_count > 0) qsort(cross, cross_count, sizeof *cross, by_place);
    status = pair_cross(cross, cross_count, representative, error);
    if (status == SCREE_OK) {
        fill(children, child_span, representative, mesh);
        status = mesh_connect(memory, mesh, error);
    }
    if (status != SCREE_OK) mesh_release(memory, mesh);
cleanup:
    scree_release(memory, representative);
    scree_release(memory, cross);
    return status;
}
