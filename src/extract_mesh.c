#include "src/extract_mesh.h"

#include <math.h>
#include <string.h>

#define LARGE_FOR_FLOATS 16384.0 /* from here on floats are more than a millimetre apart */
#define MOST_VERTICES    (UINT32_C(1) << 30)

static uint64_t hash(const struct extract_vertex *vertex) {
    uint64_t bits;
    memcpy(&bits, &vertex->height_m, sizeof bits);
    uint64_t value = (uint64_t)vertex->x * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)vertex->y;
    value = (value ^ value >> 29) * UINT64_C(0xbf58476d1ce4e5b9) ^ bits;
    value = (value ^ value >> 32) * UINT64_C(0x94d049bb133111eb);
    return value ^ value >> 31;
}

static bool is_same(const struct extract_vertex *a, const struct extract_vertex *b) {
    return a->x == b->x && a->y == b->y && a->height_m == b->height_m;
}

/* Slot of the vertex in the table, or the empty slot where it belongs. */
static size_t find_slot(const struct extract_mesh *mesh, const struct extract_vertex *vertex) {
    size_t mask = 2 * (size_t)mesh->vertex_room - 1, slot = (size_t)hash(vertex) & mask;
    while (mesh->table[slot] != 0 && !is_same(&mesh->vertices[mesh->table[slot] - 1], vertex)) slot = (slot + 1) & mask;
    return slot;
}

/* Room for `more` vertices; the table is made anew when it grows. */
static enum scree_status reserve_vertices(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t more,
                                          struct scree_error *error) {
    uint64_t wanted = (uint64_t)mesh->vertex_count + more, room = mesh->vertex_room == 0 ? 1024 : mesh->vertex_room;
    if (wanted <= mesh->vertex_room) return SCREE_OK;
    while (room < wanted) room *= 2;
    if (room > MOST_VERTICES)
        return scree_fail(error, SCREE_E_LIMIT, "the mesh has more than %u vertices; choose a coarser zoom or a tile",
                          (unsigned)MOST_VERTICES);
    struct extract_vertex *vertices =
        scree_reallocate(memory, mesh->vertices, (size_t)room, sizeof *vertices, "the mesh's vertices", error);
    if (vertices == NULL) return SCREE_E_MEMORY;
    mesh->vertices = vertices;
    uint32_t *table = scree_allocate(memory, 2 * (size_t)room, sizeof *table, "the table of vertices", error);
    if (table == NULL) return SCREE_E_MEMORY;
    scree_release(memory, mesh->table);
    mesh->table = table;
    mesh->vertex_room = (uint32_t)room;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) mesh->table[find_slot(mesh, &mesh->vertices[i])] = i + 1;
    return SCREE_OK;
}

static enum scree_status reserve_triangles(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t more,
                                           struct scree_error *error) {
    uint64_t wanted = (uint64_t)mesh->triangle_count + more;
    uint64_t room = mesh->triangle_room == 0 ? 1024 : mesh->triangle_room;
    if (wanted <= mesh->triangle_room) return SCREE_OK;
    while (room < wanted) room *= 2;
    if (room > MOST_VERTICES)
        return scree_fail(error, SCREE_E_LIMIT, "the mesh has more than %u triangles; choose a coarser zoom or a tile",
                          (unsigned)MOST_VERTICES);
    uint32_t *corners =
        scree_reallocate(memory, mesh->corners, (size_t)room, 3 * sizeof *corners, "the mesh's triangles", error);
    if (corners == NULL) return SCREE_E_MEMORY;
    mesh->corners = corners;
    mesh->triangle_room = (uint32_t)room;
    return SCREE_OK;
}

enum scree_status extract_mesh_reserve(struct scree_memory *memory, struct extract_mesh *mesh, uint32_t vertices,
                                       uint32_t triangles, struct scree_error *error) {
    enum scree_status status = reserve_vertices(memory, mesh, vertices, error);
    return status == SCREE_OK ? reserve_triangles(memory, mesh, triangles, error) : status;
}

int64_t extract_mesh_around(const struct extract_mesh *mesh) {
    if (mesh->lattice->profile != PROFILE_GEODETIC) return 0;
    int zoom = mesh->in_posts ? 0 : mesh->zoom;
    int64_t tile = mesh->in_posts ? lattice_tile_span(mesh->lattice, zoom) : DECODED_TOP;
    return (int64_t)lattice_tiles_x(mesh->lattice, zoom) * tile;
}

/* Its number in the mesh. Each place on the globe has one name: 0 is 360 degrees, and a pole is one place. */
static uint32_t number_of(struct extract_mesh *mesh, struct extract_vertex vertex) {
    int64_t around = extract_mesh_around(mesh), pole = around / 2;
    if (around != 0 && (vertex.x == around || vertex.y == 0 || vertex.y == pole)) vertex.x = 0;
    size_t slot = find_slot(mesh, &vertex);
    if (mesh->table[slot] == 0) {
        mesh->vertices[mesh->vertex_count++] = vertex;
        mesh->table[slot] = mesh->vertex_count;
    }
    return mesh->table[slot] - 1;
}

/* A triangle without an area on the globe is left out. */
static void add_triangle(struct extract_mesh *mesh, uint32_t a, uint32_t b, uint32_t c) {
    if (a == b || b == c || c == a) return;
    memcpy(mesh->corners + 3 * (size_t)mesh->triangle_count++, (uint32_t[3]){a, b, c}, 3 * sizeof *mesh->corners);
}

enum scree_status extract_mesh_add(struct scree_memory *memory, struct extract_mesh *mesh, struct tile_id id,
                                   const struct decoded_tile *tile, struct scree_error *error) {
    uint32_t *number = scree_allocate(memory, tile->vertex_count, sizeof *number, "vertex numbers", error);
    enum scree_status status = number == NULL ? SCREE_E_MEMORY : SCREE_OK;
    if (status == SCREE_OK)
        status = extract_mesh_reserve(memory, mesh, tile->vertex_count, tile->triangle_count, error);
    if (status != SCREE_OK) goto cleanup;
    for (uint32_t i = 0; i < tile->vertex_count; i++)
        number[i] = number_of(mesh, (struct extract_vertex){.x = (int64_t)id.x * DECODED_TOP + tile->u[i],
                                                            .y = (int64_t)id.y * DECODED_TOP + tile->v[i],
                                                            .height_m = decoded_height_m(tile, i)});
    for (uint32_t t = 0; t < tile->triangle_count; t++) {
        const uint32_t *corners = tile->corners + 3 * (size_t)t;
        add_triangle(mesh, number[corners[0]], number[corners[1]], number[corners[2]]);
    }
cleanup:
    scree_release(memory, number);
    return status;
}

static bool is_within(const struct extract_posts *posts, uint32_t i) {
    const struct lattice_window *only = posts->only;
    int64_t x = posts->x + posts->vertices[i].x, y = posts->y + posts->vertices[i].y;
    return only == NULL || (x >= only->x && x <= only->x + only->columns && y >= only->y && y <= only->y + only->rows);
}

enum scree_status extract_mesh_add_posts(struct scree_memory *memory, struct extract_mesh *mesh,
                                         const struct extract_posts *posts, struct scree_error *error) {
    uint32_t *number = scree_allocate(memory, posts->vertex_count, sizeof *number, "vertex numbers", error);
    enum scree_status status = number == NULL ? SCREE_E_MEMORY : SCREE_OK;
    if (status == SCREE_OK)
        status = extract_mesh_reserve(memory, mesh, posts->vertex_count, posts->triangle_count, error);
    if (status != SCREE_OK) goto cleanup;
    memset(number, 0xff, posts->vertex_count * sizeof *number); /* UINT32_MAX: none yet */
    for (uint32_t t = 0; t < posts->triangle_count; t++) {
        const uint32_t *corners = posts->corners + 3 * (size_t)t;
        if (!is_within(posts, corners[0]) || !is_within(posts, corners[1]) || !is_within(posts, corners[2])) continue;
        for (int k = 0; k < 3; k++) {
            const struct scree_vertex *vertex = &posts->vertices[corners[k]];
            if (number[corners[k]] != UINT32_MAX) continue;
            number[corners[k]] =
                number_of(mesh, (struct extract_vertex){.x = posts->x + vertex->x,
                                                        .y = posts->y + vertex->y,
                                                        .height_m = vertex->height * posts->height_unit_m});
        }
        add_triangle(mesh, number[corners[0]], number[corners[1]], number[corners[2]]);
    }
cleanup:
    scree_release(memory, number);
    return status;
}

/* Whole metres off each axis on which floats would be too coarse. */
static void take_origin_off(struct extract_mesh *mesh) {
    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < mesh->vertex_count; i++) {
            low = fmin(low, mesh->xyz[3 * (size_t)i + (size_t)axis]);
            high = fmax(high, mesh->xyz[3 * (size_t)i + (size_t)axis]);
        }
        mesh->origin[axis] = 0;
        double largest = fmax(-low, high);
        if (mesh->vertex_count == 0 || largest < LARGE_FOR_FLOATS || largest <= high - low) continue; /* no help */
        mesh->origin[axis] = floor(low / 2 + high / 2);
        for (uint32_t i = 0; i < mesh->vertex_count; i++) mesh->xyz[3 * (size_t)i + (size_t)axis] -= mesh->origin[axis];
    }
}

enum scree_status extract_mesh_place(struct scree_memory *memory, struct extract_mesh *mesh,
                                     const struct horizon_frame *frame, struct scree_error *error) {
    const struct lattice *lattice = mesh->lattice;
    double step = mesh->in_posts ? 1 : (double)lattice_tile_span(lattice, mesh->zoom) / DECODED_TOP; /* of a code */
    scree_release(memory, mesh->xyz);
    mesh->xyz = scree_allocate(memory, mesh->vertex_count, 3 * sizeof *mesh->xyz, "the mesh's coordinates", error);
    if (mesh->xyz == NULL) return SCREE_E_MEMORY;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct extract_vertex *vertex = &mesh->vertices[i];
        double x = lattice_x(lattice, (double)vertex->x * step), y = lattice_y(lattice, (double)vertex->y * step);
        struct vec3 point = {x, y, vertex->height_m};
        if (lattice->profile == PROFILE_GEODETIC) point = place_ecef_m(x, y, vertex->height_m);
        if (lattice->profile == PROFILE_GEODETIC && frame != NULL) point = place_in_horizon_m(frame, point);
        memcpy(mesh->xyz + 3 * (size_t)i, (double[3]){point.x, point.y, point.z}, 3 * sizeof *mesh->xyz);
    }
    take_origin_off(mesh);
    return SCREE_OK;
}

void extract_mesh_free(struct scree_memory *memory, struct extract_mesh *mesh) {
    scree_release(memory, mesh->xyz);
    scree_release(memory, mesh->table);
    scree_release(memory, mesh->corners);
    scree_release(memory, mesh->vertices);
    *mesh = (struct extract_mesh){0};
}
