#include "src/quantized_mesh_decode.h"

#include "stream/cursor.h"

#include <string.h>

#define MOST_16_BIT_VERTICES 65536 /* with more, indices take 4 bytes */

enum { EXTENSION_NORMALS = 1, EXTENSION_WATER_MASK = 2, EXTENSION_METADATA = 4 };

static enum scree_status cut(const struct scree_reader *reader, const char *what, struct scree_error *error) {
    return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)reader->at_bytes, "the tile ends at byte %zu, within its %s",
                         reader->size_bytes, what);
}

static void read_point(struct scree_reader *reader, double point[3]) {
    for (int i = 0; i < 3; i++) point[i] = scree_read_f64(reader);
}

static enum scree_status read_header(struct scree_reader *reader, struct decoded_tile *tile,
                                     struct scree_error *error) {
    read_point(reader, tile->center_m);
    tile->height_min_m = scree_read_f32(reader);
    tile->height_max_m = scree_read_f32(reader);
    read_point(reader, tile->sphere_center_m);
    tile->sphere_radius_m = scree_read_f64(reader);
    read_point(reader, tile->occlusion);
    return reader->ran_out ? cut(reader, "header", error) : SCREE_OK;
}

/* Zigzag differences: 0, -1, 1, -2, 2 ... are written as 0, 1, 2, 3, 4 ... */
static enum scree_status read_codes(struct scree_reader *reader, uint32_t count, uint16_t *codes, const char *what,
                                    struct scree_error *error) {
    int32_t code = 0;
    for (uint32_t i = 0; i < count; i++) {
        int32_t zigzag = scree_read_u16(reader);
        code += (zigzag >> 1) ^ -(zigzag & 1);
        if (code < 0 || code > DECODED_TOP)
            return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)reader->at_bytes - 2,
                                 "the %s of vertex %u is %d, outside of 0..%d", what, (unsigned)i, (int)code,
                                 DECODED_TOP);
        codes[i] = (uint16_t)code;
    }
    return SCREE_OK;
}

static enum scree_status read_vertices(struct scree_memory *memory, struct scree_reader *reader,
                                       struct decoded_tile *tile, struct scree_error *error) {
    uint32_t count = scree_read_u32(reader);
    if (reader->ran_out || !scree_reader_holds(reader, count, 6)) return cut(reader, "vertices", error);
    tile->vertex_count = count;
    uint16_t **arrays[3] = {&tile->u, &tile->v, &tile->h};
    const char *names[3] = {"u", "v", "height"};
    for (int i = 0; i < 3; i++) {
        *arrays[i] = scree_allocate(memory, count, sizeof **arrays[i], "the tile's vertices", error);
        if (*arrays[i] == NULL) return SCREE_E_MEMORY;
        enum scree_status status = read_codes(reader, count, *arrays[i], names[i], error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}

static uint32_t read_index(struct scree_reader *reader, size_t index_bytes) {
    return index_bytes == 2 ? scree_read_u16(reader) : scree_read_u32(reader);
}

static enum scree_status read_triangles(struct scree_memory *memory, struct scree_reader *reader, size_t index_bytes,
                                        struct decoded_tile *tile, struct scree_error *error) {
    uint32_t count = scree_read_u32(reader);
    if (reader->ran_out || !scree_reader_holds(reader, count, 3 * index_bytes)) return cut(reader, "triangles", error);
    tile->triangle_count = count;
    tile->corners = scree_allocate(memory, count, 3 * sizeof *tile->corners, "the tile's triangles", error);
    if (tile->corners == NULL) return SCREE_E_MEMORY;
    uint32_t highest = 0; /* the high-water mark: a code counts down from the next vertex that was not named yet */
    for (size_t i = 0; i < 3 * (size_t)count; i++) {
        uint32_t code = read_index(reader, index_bytes);
        if (code > highest || highest - code >= tile->vertex_count)
            return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)(reader->at_bytes - index_bytes),
                                 "triangle %zu names a vertex that is not there", i / 3);
        tile->corners[i] = highest - code;
        if (code == 0) highest++;
    }
    tile->used_vertex_count = highest;
    return SCREE_OK;
}

static enum scree_status read_edges(struct scree_memory *memory, struct scree_reader *reader, size_t index_bytes,
                                    struct decoded_tile *tile, struct scree_error *error) {
    for (int side = 0; side < EDGE_COUNT; side++) {
        uint32_t count = scree_read_u32(reader);
        if (reader->ran_out || !scree_reader_holds(reader, count, index_bytes)) return cut(reader, "edge lists", error);
        tile->edge_count[side] = count;
        tile->edges[side] = scree_allocate(memory, count, sizeof *tile->edges[side], "the tile's edge lists", error);
        if (tile->edges[side] == NULL) return SCREE_E_MEMORY;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t vertex = read_index(reader, index_bytes);
            if (vertex >= tile->vertex_count)
                return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)(reader->at_bytes - index_bytes),
                                     "an edge list names vertex %u of %u", (unsigned)vertex,
                                     (unsigned)tile->vertex_count);
            tile->edges[side][i] = vertex;
        }
    }
    return SCREE_OK;
}

static enum scree_status read_normals(struct scree_memory *memory, struct scree_reader *reader, uint32_t size_bytes,
                                      struct decoded_tile *tile, struct scree_error *error) {
    if (tile->normals != NULL || size_bytes != 2 * (uint64_t)tile->vertex_count)
        return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)reader->at_bytes,
                             "the normals take %u bytes where %u vertices need 2 each, once", (unsigned)size_bytes,
                             (unsigned)tile->vertex_count);
    tile->normals = scree_allocate(memory, tile->vertex_count, 2, "the tile's normals", error);
    if (tile->normals == NULL) return SCREE_E_MEMORY;
    const unsigned char *normals = scree_read_bytes(reader, size_bytes);
    if (normals != NULL) memcpy(tile->normals, normals, size_bytes);
    return SCREE_OK;
}

static enum scree_status read_extensions(struct scree_memory *memory, struct scree_reader *reader,
                                         struct decoded_tile *tile, struct scree_error *error) {
    while (scree_reader_left(reader) > 0) {
        uint8_t id = scree_read_u8(reader);
        uint32_t size_bytes = scree_read_u32(reader);
        if (reader->ran_out || !scree_reader_holds(reader, size_bytes, 1)) return cut(reader, "extensions", error);
        if (id == EXTENSION_NORMALS) {
            enum scree_status status = read_normals(memory, reader, size_bytes, tile, error);
            if (status != SCREE_OK) return status;
            continue;
        }
        if (id == EXTENSION_WATER_MASK) {
            if (size_bytes != 1 && size_bytes != 256 * 256)
                return scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)reader->at_bytes,
                                     "the water mask takes %u bytes, not 1 or 65536", (unsigned)size_bytes);
            tile->has_water_mask = true;
        } else if (id == EXTENSION_METADATA) {
            tile->has_metadata = true;
        } else {
            tile->unknown_extensions++;
        }
        scree_read_bytes(reader, size_bytes);
    }
    return SCREE_OK;
}

enum scree_status decoded_tile_read(struct scree_memory *memory, const unsigned char *bytes, size_t size_bytes,
                                    struct decoded_tile *tile, struct scree_error *error) {
    struct scree_reader reader = scree_reader(bytes, size_bytes);
    struct scree_error own = {0};
    struct scree_error *context = error == NULL ? &own : error;
    size_t index_bytes = 0;
    *tile = (struct decoded_tile){0};
    if (read_header(&reader, tile, context) != SCREE_OK) goto cleanup;
    if (read_vertices(memory, &reader, tile, context) != SCREE_OK) goto cleanup;
    index_bytes = tile->vertex_count > MOST_16_BIT_VERTICES ? 4 : 2;
    scree_read_align(&reader, index_bytes);
    if (read_triangles(memory, &reader, index_bytes, tile, context) != SCREE_OK) goto cleanup;
    if (read_edges(memory, &reader, index_bytes, tile, context) != SCREE_OK) goto cleanup;
    if (read_extensions(memory, &reader, tile, context) != SCREE_OK) goto cleanup;
    return SCREE_OK;
cleanup:
    decoded_tile_free(memory, tile);
    return context->status;
}

void decoded_tile_free(struct scree_memory *memory, struct decoded_tile *tile) {
    scree_release(memory, tile->normals);
    for (int side = EDGE_COUNT - 1; side >= 0; side--) scree_release(memory, tile->edges[side]);
    scree_release(memory, tile->corners);
    scree_release(memory, tile->h);
    scree_release(memory, tile->v);
    scree_release(memory, tile->u);
    *tile = (struct decoded_tile){0};
}
