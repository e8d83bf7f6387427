#include "tests/mesh_maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void need(enum scree_status status, const struct scree_error *error) {
    if (status == SCREE_OK) return;
    fprintf(stderr, "fixture: %s\n", error->text);
    exit(99);
}

int32_t any_number(uint64_t *state, int32_t limit) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int32_t)((*state >> 33) % (uint64_t)limit);
}

static void add_triangle(struct mesh *mesh, int32_t a, int32_t b, int32_t c) {
    struct mesh_triangle *triangle = &mesh->triangles[mesh->triangle_count++];
    triangle->vertex[0] = a;
    triangle->vertex[1] = b;
    triangle->vertex[2] = c;
}

void make_grid_mesh(struct scree_memory *memory, int32_t columns, int32_t rows, int32_t step, const float *posts,
                    int32_t stride, struct mesh *mesh) {
    struct scree_error error = {0};
    need(mesh_allocate(memory, (columns + 1) * (rows + 1), 2 * columns * rows, mesh, &error), &error);
    for (int32_t y = 0; y <= rows; y++)
        for (int32_t x = 0; x <= columns; x++) {
            float height_m = posts != NULL ? posts[(int64_t)y * step * stride + x * step] : 0;
            mesh->heights[mesh->vertex_count] = (int32_t)lroundf(height_m);
            mesh->vertices[mesh->vertex_count++].at = (struct sample){x * step, y * step, roundf(height_m)};
        }
    for (int32_t y = 0; y < rows; y++)
        for (int32_t x = 0; x < columns; x++) {
            int32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
            bool rising = (x + y) % 2 == 0;
            add_triangle(mesh, a, b, rising ? d : c);
            add_triangle(mesh, d, c, rising ? a : b);
        }
    need(mesh_connect(memory, mesh, &error), &error);
}

void copy_mesh(struct scree_memory *memory, const struct mesh *mesh, struct mesh *copy) {
    struct scree_error error = {0};
    struct mesh made;
    need(mesh_allocate(memory, mesh->vertex_capacity, mesh->triangle_capacity, &made, &error), &error);
    *copy = *mesh;
    copy->vertices = made.vertices;
    copy->heights = made.heights;
    copy->triangles = made.triangles;
    memcpy(copy->vertices, mesh->vertices, (size_t)mesh->vertex_count * sizeof *mesh->vertices);
    memcpy(copy->heights, mesh->heights, (size_t)mesh->vertex_count * sizeof *mesh->heights);
    memcpy(copy->triangles, mesh->triangles, (size_t)mesh->triangle_count * sizeof *mesh->triangles);
}

static bool is_live(const struct mesh *mesh, int32_t triangle) {
    return triangle >= 0 && triangle < mesh->triangle_count && mesh->triangles[triangle].vertex[0] != MESH_NONE;
}

static const char *edge_fault(const struct mesh *mesh, int32_t edge) {
    int32_t twin = mesh_twin(mesh, edge), origin = mesh_origin(mesh, edge), end = mesh_origin(mesh, mesh_next(edge));
    if (origin < 0 || origin >= mesh->vertex_count) return "a corner is no vertex";
    if (mesh->vertices[origin].edge == MESH_NONE) return "a corner is dead";
    if (twin == MESH_NONE) return mesh->vertices[origin].edge == edge ? NULL : "a border vertex has another edge";
    if (twin < 0 || (twin & 3) == 3 || !is_live(mesh, twin >> 2)) return "a twin is no half-edge";
    if (mesh_twin(mesh, twin) != edge) return "twins are not mutual";
    if (mesh_origin(mesh, twin) != end || mesh_origin(mesh, mesh_next(twin)) != origin) return "twins join other ends";
    return NULL;
}

static const char *vertex_fault(const struct mesh *mesh, int32_t vertex, int32_t triangles) {
    struct star star;
    int32_t edge = mesh->vertices[vertex].edge;
    if (edge < 0 || (edge & 3) == 3 || !is_live(mesh, edge >> 2)) return "a vertex's edge is no half-edge";
    if (mesh_origin(mesh, edge) != vertex) return "a vertex's edge starts elsewhere";
    if (!mesh_star(mesh, vertex, &star)) return "a star is too large";
    if (star.degree != triangles) return "a star lacks triangles of its vertex";
    for (int32_t i = 0; i <= star.degree; i++) {
        const struct sample *at = &mesh->vertices[star.ring[i]].at;
        if (star.at[i].x != at->x || star.at[i].y != at->y) return "a star's positions are not its ring's";
        if (i < star.degree && mesh_origin(mesh, star.edge[i]) != vertex) return "a star's edge starts elsewhere";
    }
    if (!star.open && star.ring[star.degree] != star.ring[0]) return "a closed star's ring is open";
    return NULL;
}

const char *mesh_fault(const struct mesh *mesh, int32_t columns, int32_t rows) {
    const char *fault = NULL;
    int64_t area2 = 0, edges2 = 0;
    int32_t live_vertices = 0, live_triangles = 0;
    int32_t *triangles = calloc((size_t)mesh->vertex_count, sizeof *triangles);
    if (triangles == NULL) return "no memory for the check";
    for (int32_t t = 0; t < mesh->triangle_count && fault == NULL; t++) {
        if (!is_live(mesh, t)) continue;
        live_triangles++;
        for (int i = 0; i < 3 && fault == NULL; i++) {
            if ((fault = edge_fault(mesh, 4 * t + i)) != NULL) break;
            edges2 += mesh->triangles[t].twin[i] == MESH_NONE ? 2 : 1;
            triangles[mesh->triangles[t].vertex[i]]++;
        }
        if (fault != NULL) break;
        const int32_t *corner = mesh->triangles[t].vertex;
        int64_t own =
            sample_area2(&mesh->vertices[corner[0]].at, &mesh->vertices[corner[1]].at, &mesh->vertices[corner[2]].at);
        if (own <= 0) fault = "a triangle has no positive area";
        area2 += own;
    }
    for (int32_t v = 0; v < mesh->vertex_count && fault == NULL; v++) {
        if (mesh->vertices[v].edge == MESH_NONE) continue;
        live_vertices++;
        fault = vertex_fault(mesh, v, triangles[v]);
    }
    free(triangles);
    if (fault != NULL) return fault;
    if (live_vertices != mesh->live_vertices || live_triangles != mesh->live_triangles) return "the counts are wrong";
    if (area2 != 2 * (int64_t)columns * rows) return "the areas do not add up";
    return live_vertices - edges2 / 2 + live_triangles == 1 ? NULL : "Euler's sum is not 1";
}

bool same_meshes(const struct mesh *mesh, const struct mesh *other) {
    if (mesh->vertex_count != other->vertex_count || mesh->triangle_count != other->triangle_count ||
        mesh->live_vertices != other->live_vertices || mesh->live_triangles != other->live_triangles)
        return false;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        const struct sample *at = &mesh->vertices[v].at, *other_at = &other->vertices[v].at;
        if (mesh->vertices[v].edge != other->vertices[v].edge || mesh->heights[v] != other->heights[v]) return false;
        if (at->x != other_at->x || at->y != other_at->y || at->height_m != other_at->height_m) return false;
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (is_live(mesh, t) != is_live(other, t)) return false;
        if (!is_live(mesh, t)) continue;
        const struct mesh_triangle *a = &mesh->triangles[t], *b = &other->triangles[t];
        if (memcmp(a->vertex, b->vertex, sizeof a->vertex) != 0 || memcmp(a->twin, b->twin, sizeof a->twin) != 0)
            return false;
    }
    return true;
}
