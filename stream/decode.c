#include "stream/decode.h"

#include "stream/layers.h"

#include <string.h>

struct stream_decoder {
    struct scree_memory *memory;
    const struct scree_stream_header *header;
    struct surface surface;
    struct increment increment;
    struct range_coder coder;
    struct progressive decoded;
    uint32_t blocks;          /* decoded */
    uint32_t vertex_capacity; /* of what is decoded */
    bool failed;
};

/* Makes room for the next block's vertices and triangles, and for half as many again as there were, as far as the
 * finest rung goes: memory follows the blocks that have come, not the header's promises. */
static uint32_t room_for(uint32_t wanted, uint32_t capacity, uint32_t most) {
    if (wanted <= capacity) return capacity;
    uint32_t larger = capacity + capacity / 2;
    if (larger < wanted) larger = wanted;
    return larger < most ? larger : most;
}

static bool make_room_for_vertices(struct stream_decoder *decoder, uint32_t count, struct scree_error *error) {
    struct scree_memory *memory = decoder->memory;
    struct progressive *decoded = &decoder->decoded;
    struct scree_vertex *vertices =
        scree_reallocate(memory, decoded->vertices, count, sizeof *vertices, "a stream's vertices", error);
    if (vertices == NULL) return false;
    decoded->vertices = vertices;
    struct progressive_split *splits =
        scree_reallocate(memory, decoded->splits, count, sizeof *splits, "a stream's splits", error);
    if (splits == NULL) return false;
    decoded->splits = splits;
    decoder->vertex_capacity = count;
    return true;
}

static bool make_room_for_triangles(struct stream_decoder *decoder, uint32_t count, struct scree_error *error) {
    uint32_t *corners = scree_reallocate(decoder->memory, decoder->decoded.corners, count, 3 * sizeof *corners,
                                         "a stream's triangles", error);
    if (corners != NULL) decoder->decoded.corners = corners;
    return corners != NULL;
}

static bool make_room(struct stream_decoder *decoder, struct scree_error *error) {
    const struct scree_rung *rung = &decoder->header->rungs[decoder->blocks];
    const struct scree_rung *finest = &decoder->header->rungs[decoder->header->rung_count - 1];
    struct surface *surface = &decoder->surface;
    uint32_t vertices = room_for(rung->vertex_count, decoder->vertex_capacity, finest->vertex_count);
    uint32_t triangles = room_for(rung->triangle_count, surface->triangle_capacity, finest->triangle_count);
    if (vertices != decoder->vertex_capacity && !make_room_for_vertices(decoder, vertices, error)) return false;
    if (triangles != surface->triangle_capacity && !make_room_for_triangles(decoder, triangles, error)) return false;
    return surface_reserve(decoder->memory, vertices, triangles, surface, error) &&
           increment_reserve(&decoder->increment, rung->vertex_count - surface->vertex_count, error);
}

enum scree_status stream_decoder_new(struct scree_memory *memory, const struct scree_stream_header *header,
                                     struct stream_decoder **decoder, struct scree_error *error) {
    struct scree_error failure = {0};
    struct stream_decoder *made = scree_allocate(memory, 1, sizeof *made, "a stream's decoder", &failure);
    *decoder = NULL;
    if (made != NULL) {
        made->memory = memory;
        made->header = header;
        increment_start(memory, 0, &made->surface, &made->increment, &failure);
    }
    if (failure.status != SCREE_OK) {
        stream_decoder_free(made);
        return scree_fail(error, failure.status, "%s", failure.text);
    }
    made->increment.coder = &made->coder;
    *decoder = made;
    return SCREE_OK;
}

void stream_decoder_free(struct stream_decoder *decoder) {
    if (decoder == NULL) return;
    struct scree_memory *memory = decoder->memory;
    if (decoder->increment.memory != NULL) increment_release(&decoder->increment);
    surface_release(memory, &decoder->surface);
    scree_release(memory, decoder->decoded.fixups);
    scree_release(memory, decoder->decoded.splits);
    scree_release(memory, decoder->decoded.corners);
    scree_release(memory, decoder->decoded.vertices);
    scree_release(memory, decoder);
}

/* The base becomes the beginning of the arrays. */
static void take_base(struct stream_decoder *decoder) {
    const struct surface *surface = &decoder->surface;
    struct progressive *decoded = &decoder->decoded;
    decoded->base_vertices = decoded->vertex_count = surface->vertex_count;
    decoded->base_triangles = decoded->triangle_count = surface->triangle_count;
    memcpy(decoded->vertices, surface->vertices, surface->vertex_count * sizeof *decoded->vertices);
    for (uint32_t t = 0; t < surface->triangle_count; t++)
        memcpy(decoded->corners + 3 * (size_t)t, surface->triangles[t].vertex, sizeof surface->triangles[t].vertex);
}

static enum scree_status decode_layers(struct stream_decoder *decoder, uint32_t layers, struct scree_error *error) {
    uint32_t most = decoder->header->rungs[decoder->blocks].vertex_count;
    enum scree_status status = SCREE_OK;
    for (uint32_t layer = 0; layer < layers && status == SCREE_OK; layer++) {
        uint32_t before = decoder->surface.vertex_count;
        status = increment_code(&decoder->increment, most - before, error);
        if (status == SCREE_OK && decoder->surface.vertex_count == before && most > before)
            status = scree_fail(error, SCREE_E_CORRUPT, "a layer of a block is empty");
    }
    return status;
}

static enum scree_status decode_base(struct stream_decoder *decoder, struct scree_error *error) {
    struct base_start start = {0};
    enum scree_status status = SCREE_OK;
    base_start_code(&decoder->coder, &start);
    surface_rectangle(&decoder->surface, decoder->header->columns, decoder->header->rows, start.rising);
    for (int i = 0; i < 4; i++) decoder->surface.vertices[i].height = start.heights[i];
    decoder->increment.height_step = 1 << start.step_bits;
    if (start.layers > 0) status = decode_layers(decoder, start.layers, error);
    increment_forget(&decoder->increment);
    return status;
}

static enum scree_status decode_increment(struct stream_decoder *decoder, struct scree_error *error) {
    decoder->increment.splits = &decoder->decoded;
    return decode_layers(decoder, layer_count_code(&decoder->coder, 1), error);
}

enum scree_status stream_decode_block(struct stream_decoder *decoder, const void *bytes, size_t size_bytes,
                                      struct scree_error *error) {
    if (decoder->failed || decoder->blocks == decoder->header->rung_count)
        return scree_fail(error, SCREE_E_ARGUMENT, "no block is left to decode");
    const struct scree_rung *rung = &decoder->header->rungs[decoder->blocks];
    struct scree_error failure = {0};
    if (!make_room(decoder, &failure)) {
        decoder->failed = true;
        return scree_fail(error, failure.status, "%s", failure.text);
    }
    const struct progressive before = decoder->decoded;
    struct progressive *decoded = &decoder->decoded;
    range_coder_read(bytes, size_bytes, &decoder->coder);
    enum scree_status status = decoder->blocks == 0 ? decode_base(decoder, error) : decode_increment(decoder, error);
    if (status == SCREE_OK && (decoder->surface.vertex_count != rung->vertex_count ||
                               decoder->surface.triangle_count != rung->triangle_count))
        status = scree_fail(error, SCREE_E_CORRUPT, "a block does not hold what the header says");
    if (status == SCREE_OK && !range_coder_is_spent(&decoder->coder))
        status = scree_fail(error, SCREE_E_CORRUPT, "a block is longer or shorter than what is in it");
    if (status != SCREE_OK) {
        struct progressive_fixup *fixups = decoded->fixups;
        uint32_t capacity = decoded->fixup_capacity;
        *decoded = before;
        decoded->fixups = fixups;
        decoded->fixup_capacity = capacity;
        decoder->failed = true;
        return status;
    }
    if (decoder->blocks == 0) take_base(decoder);
    decoder->blocks++;
    return SCREE_OK;
}

const struct progressive *stream_decoded(const struct stream_decoder *decoder) {
    return &decoder->decoded;
}
