#include "lod/mesh.h"

#include <string.h>

bool mesh_star(const struct mesh *mesh, int32_t vertex, struct star *star) {
    int32_t first = mesh->vertices[vertex].edge, edge = first, count = 0;
    star->vertex = vertex;
    star->open = mesh_twin(mesh, first) == MESH_NONE;
    for (;;) {
        if (count == MESH_MAX_DEGREE) return false;
        int32_t previous = mesh_previous(edge);
        star->edge[count] = edge;
        star->ring[count] = mesh_origin(mesh, mesh_next(edge));
        star->at[count] = mesh->vertices[star->ring[count]].at;
        count++;
        edge = mesh_twin(mesh, previous);
        if (edge == first || edge == MESH_NONE) {
            star->degree = count;
            star->ring[count] = mesh_origin(mesh, previous);
            star->at[count] = mesh->vertices[star->ring[count]].at;
            return true;
        }
    }
}

static inline void join(struct mesh *mesh, int32_t edge, int32_t other) {
    if (edge != MESH_NONE) mesh->triangles[edge >> 2].twin[edge & 3] = other;
    if (other != MESH_NONE) mesh->triangles[other >> 2].twin[other & 3] = edge;
}

static inline void replace_edge(struct mesh *mesh, int32_t vertex, int32_t old_edge, int32_t new_edge) {
    if (mesh->vertices[vertex].edge == old_edge) mesh->vertices[vertex].edge = new_edge;
}

static inline void remove_triangle(struct mesh *mesh, int32_t edge) {
    mesh->triangles[edge >> 2].vertex[0] = MESH_NONE;
    mesh->live_triangles--;
}

void mesh_collapse(struct mesh *mesh, const struct star *star, int32_t target) {
    int32_t degree = star->degree, into = star->ring[target];
    for (int32_t i = 0; i < degree; i++) mesh->triangles[star->edge[i] >> 2].vertex[star->edge[i] & 3] = into;
    if (target < degree) { /* the triangle to the left of the collapsed edge folds onto its next neighbour */
        int32_t outer = mesh_next(star->edge[target]), inner = mesh_next(outer);
        int32_t outer_twin = mesh_twin(mesh, outer), inner_twin = mesh_twin(mesh, inner);
        join(mesh, outer_twin, inner_twin);
        replace_edge(mesh, into, outer, inner_twin);
        replace_edge(mesh, star->ring[target + 1], inner, outer_twin);
        remove_triangle(mesh, outer);
    }
    if (!star->open || target == degree) { /* and the one to its right */
        int32_t before = target > 0 ? target - 1 : degree - 1;
        int32_t inner = star->edge[before], outer = mesh_next(inner), collapsed = mesh_next(outer);
        int32_t outer_twin = mesh_twin(mesh, outer), inner_twin = mesh_twin(mesh, inner);
        join(mesh, outer_twin, inner_twin);
        replace_edge(mesh, star->ring[before], outer, inner_twin);
        replace_edge(mesh, into, collapsed, star->open ? star->edge[0] : outer_twin);
        remove_triangle(mesh, inner);
    }
    mesh->vertices[star->vertex].edge = MESH_NONE;
    mesh->live_vertices--;
}

void mesh_flip(struct mesh *mesh, int32_t edge) {
    int32_t twin = mesh_twin(mesh, edge);
    int32_t a = mesh_origin(mesh, edge), b = mesh_origin(mesh, twin);
    int32_t edge_next = mesh_next(edge), edge_last = mesh_previous(edge);
    int32_t twin_next = mesh_next(twin), twin_last = mesh_previous(twin);
    int32_t c = mesh_origin(mesh, edge_last), d = mesh_origin(mesh, twin_last);
    int32_t bc = mesh_twin(mesh, edge_next), ad = mesh_twin(mesh, twin_next);
    /* (a, b, c) becomes (d, c, a) and (b, a, d) becomes (c, d, b): each keeps one of its outer edges in place */
    mesh->triangles[edge >> 2].vertex[edge & 3] = d;
    mesh->triangles[edge >> 2].vertex[edge_next & 3] = c;
    mesh->triangles[edge >> 2].vertex[edge_last & 3] = a;
    mesh->triangles[twin >> 2].vertex[twin & 3] = c;
    mesh->triangles[twin >> 2].vertex[twin_next & 3] = d;
    mesh->triangles[twin >> 2].vertex[twin_last & 3] = b;
    int32_t ca = mesh_twin(mesh, edge_last), db = mesh_twin(mesh, twin_last);
    join(mesh, edge_next, ca);
    join(mesh, edge_last, ad);
    join(mesh, twin_next, db);
    join(mesh, twin_last, bc);
    replace_edge(mesh, a, edge, edge_last);
    replace_edge(mesh, a, twin_next, edge_last);
    replace_edge(mesh, b, twin, twin_last);
    replace_edge(mesh, b, edge_next, twin_last);
    replace_edge(mesh, c, edge_last, edge_next);
    replace_edge(mesh, d, twin_last, twin_next);
}

enum scree_status mesh_allocate(struct scree_memory *memory, int32_t vertex_capacity, int32_t triangle_capacity,
                                struct mesh *mesh, struct scree_error *error) {
    memset(mesh, 0, sizeof *mesh);
    mesh->vertex_capacity = vertex_capacity;
    mesh->triangle_capacity = triangle_capacity;
    mesh->vertices =
        scree_allocate(memory, (size_t)vertex_capacity, sizeof *mesh->vertices, "the mesh's vertices", error);
    mesh->heights = scree_allocate(memory, (size_t)vertex_capacity, sizeof *mesh->heights, "the mesh's heights", error);
    mesh->triangles =
        scree_allocate(memory, (size_t)triangle_capacity, sizeof *mesh->triangles, "the mesh's triangles", error);
    if (mesh->vertices != NULL && mesh->heights != NULL && mesh->triangles != NULL) return SCREE_OK;
    mesh_release(memory, mesh);
    return SCREE_E_MEMORY;
}

void mesh_release(struct scree_memory *memory, struct mesh *mesh) {
    scree_release(memory, mesh->triangles);
    scree_release(memory, mesh->heights);
    scree_release(memory, mesh->vertices);
    memset(mesh, 0, sizeof *mesh);
}

enum scree_status mesh_copy(struct scree_memory *memory, const struct mesh *mesh, struct mesh *copy,
                            struct scree_error *error) {
    enum scree_status status = mesh_allocate(memory, mesh->vertex_count, mesh->triangle_count, copy, error);
    if (status != SCREE_OK) return status;
    copy->vertex_count = mesh->vertex_count;
    copy->triangle_count = mesh->triangle_count;
    copy->live_vertices = mesh->live_vertices;
    copy->live_triangles = mesh->live_triangles;
    memcpy(copy->vertices, mesh->vertices, (size_t)mesh->vertex_count * sizeof *mesh->vertices);
    memcpy(copy->heights, mesh->heights, (size_t)mesh->vertex_count * sizeof *mesh->heights);
    memcpy(copy->triangles, mesh->triangles, (size_t)mesh->triangle_count * sizeof *mesh->triangles);
    return SCREE_OK;
}

/* Finds the half-edge from `from` to `to` among the outgoing ones of `from`. */
static int32_t find_edge(const struct mesh *mesh, const int32_t *first, const int32_t *next, int32_t from, int32_t to,
                         int32_t *matches) {
    int32_t found = MESH_NONE;
    *matches = 0;
    for (int32_t edge = first[from]; edge != MESH_NONE; edge = next[edge]) {
        if (mesh_origin(mesh, mesh_next(edge)) != to) continue;
        found = edge;
        ++*matches;
    }
    return found;
}

enum scree_status mesh_connect(struct scree_memory *memory, struct mesh *mesh, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    int32_t *first = scree_allocate(memory, (size_t)mesh->vertex_count, sizeof *first, "edge lists", error);
    int32_t *next = scree_allocate(memory, (size_t)mesh->triangle_count * 4, sizeof *next, "edge lists", error);
    if (first == NULL || next == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) first[v] = mesh->vertices[v].edge = MESH_NONE;
    for (int32_t edge = mesh->triangle_count * 4 - 1; edge >= 0; edge--) {
        if ((edge & 3) == 3) continue;
        int32_t origin = mesh_origin(mesh, edge);
        next[edge] = first[origin];
        first[origin] = edge;
    }
    for (int32_t edge = 0; edge < mesh->triangle_count * 4; edge++) {
        if ((edge & 3) == 3) continue;
        int32_t a = mesh_origin(mesh, edge), b = mesh_origin(mesh, mesh_next(edge)), same, opposite;
        find_edge(mesh, first, next, a, b, &same);
        int32_t twin = find_edge(mesh, first, next, b, a, &opposite);
        bool second_border = twin == MESH_NONE && mesh->vertices[a].edge != MESH_NONE &&
                             mesh_twin(mesh, mesh->vertices[a].edge) == MESH_NONE;
        if (same != 1 || opposite > 1 || second_border) {
            status = scree_fail(error, SCREE_E_CORRUPT, "the mesh is not a surface at vertex %d", (int)a);
            goto cleanup;
        }
        mesh->triangles[edge >> 2].twin[edge & 3] = twin;
        if (mesh->vertices[a].edge == MESH_NONE || twin == MESH_NONE) mesh->vertices[a].edge = edge;
    }
    mesh->live_vertices = mesh->vertex_count;
    mesh->live_triangles = mesh->triangle_count;
cleanup:
    scree_release(memory, next);
    scree_release(memory, first);
    return status;
}

enum scree_status mesh_export_new(struct scree_memory *memory, const struct mesh *mesh, struct scree_mesh *copy,
                                  struct scree_error *error) {
    enum scree_status status = SCREE_E_MEMORY;
    memset(copy, 0, sizeof *copy);
    int32_t *rank = scree_allocate(memory, (size_t)mesh->vertex_count, sizeof *rank, "vertex numbers", error);
    copy->vertices =
        scree_allocate(memory, (size_t)mesh->live_vertices, sizeof *copy->vertices, "a tile's vertices", error);
    copy->corners =
        scree_allocate(memory, (size_t)mesh->live_triangles * 3, sizeof *copy->corners, "a tile's triangles", error);
    if (rank == NULL || copy->vertices == NULL || copy->corners == NULL) goto cleanup;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertices[v].edge == MESH_NONE) continue;
        rank[v] = (int32_t)copy->vertex_count;
        copy->vertices[copy->vertex_count++] =
            (struct scree_vertex){mesh->vertices[v].at.x, mesh->vertices[v].at.y, mesh->heights[v]};
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->triangles[t].vertex[0] == MESH_NONE) continue;
        uint32_t *corner = copy->corners + 3 * (size_t)copy->triangle_count++;
        for (int i = 0; i < 3; i++) corner[i] = (uint32_t)rank[mesh->triangles[t].vertex[i]];
    }
    status = SCREE_OK;
cleanup:
    if (status != SCREE_OK) {
        scree_release(memory, copy->corners);
        scree_release(memory, copy->vertices);
        memset(copy, 0, sizeof *copy);
    }
    scree_release(memory, rank);
    return status;
}
