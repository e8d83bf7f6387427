#include "lod/compact.h"

/* The new number of each slot that lives; of the others that of the next one that does. */
static void rank_vertices(const struct mesh *mesh, int32_t *rank) {
    int32_t count = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        rank[v] = count;
        count += mesh->vertices[v].edge != MESH_NONE;
    }
}

static void rank_triangles(const struct mesh *mesh, int32_t *rank) {
    int32_t count = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        rank[t] = count;
        count += mesh->triangles[t].vertex[0] != MESH_NONE;
    }
}

static int32_t new_edge(int32_t edge, const int32_t *triangle_rank) {
    return edge == MESH_NONE ? MESH_NONE : 4 * triangle_rank[edge >> 2] + (edge & 3);
}

static void move_vertices(struct simplifier *simplifier, const int32_t *rank, const int32_t *triangle_rank) {
    struct mesh *mesh = simplifier->mesh;
    int32_t kept = 0;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        int32_t v = simplifier->order[i];
        if (mesh->vertices[v].edge != MESH_NONE) simplifier->order[kept++] = rank[v];
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertices[v].edge == MESH_NONE) continue;
        mesh->vertices[rank[v]] = mesh->vertices[v];
        mesh->vertices[rank[v]].edge = new_edge(mesh->vertices[v].edge, triangle_rank);
        mesh->heights[rank[v]] = mesh->heights[v];
        simplifier->state[rank[v]] = simplifier->state[v];
        simplifier->refused_m[rank[v]] = simplifier->refused_m[v];
    }
    mesh->vertex_count = kept;
}

static void move_triangles(struct mesh *mesh, const int32_t *rank, const int32_t *vertex_rank) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->triangles[t].vertex[0] == MESH_NONE) continue;
        struct mesh_triangle moved = mesh->triangles[t];
        for (int i = 0; i < 3; i++) {
            moved.vertex[i] = vertex_rank[moved.vertex[i]];
            moved.twin[i] = new_edge(moved.twin[i], rank);
        }
        mesh->triangles[rank[t]] = moved;
    }
    mesh->triangle_count = mesh->live_triangles;
}

enum scree_status simplifier_compact(struct simplifier *simplifier, struct scree_error *error) {
    struct mesh *mesh = simplifier->mesh;
    struct scree_memory *memory = simplifier->memory;
    enum scree_status status = SCREE_E_MEMORY;
    int32_t *vertex_rank =
        scree_allocate(memory, (size_t)mesh->vertex_count, sizeof *vertex_rank, "vertex numbers", error);
    int32_t *triangle_rank =
        scree_allocate(memory, (size_t)mesh->triangle_count, sizeof *triangle_rank, "triangle numbers", error);
    if (vertex_rank == NULL || triangle_rank == NULL) goto cleanup;
    rank_vertices(mesh, vertex_rank);
    rank_triangles(mesh, triangle_rank);
    move_vertices(simplifier, vertex_rank, triangle_rank);
    move_triangles(mesh, triangle_rank, vertex_rank);
    status = SCREE_OK;
cleanup:
    scree_release(memory, triangle_rank);
    scree_release(memory, vertex_rank);
    return status;
}
