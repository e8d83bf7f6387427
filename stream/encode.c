#include "stream/encode.h"

#include "stream/layers.h"
#include "stream/stream_header.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define NOT_THERE UINT32_MAX

struct encoder {
    struct scree_memory *memory;
    const struct recording *recording;
    struct surface surface;
    struct increment increment;
    struct range_coder coder;
    struct scree_stream_header *header;
    /* one a vertex of the recording */
    uint32_t *removal; /* the one that takes it out */
    uint32_t *number;  /* in the surface; NOT_THERE before it is inserted */
    uint32_t *next;    /* in the list of its triangle */
    /* vertices still to come, by the triangle that they lie in */
    uint32_t *first;
    uint32_t layer_removals;  /* vertices of the present layer are taken out by removals from this one on */
    struct pending *places;   /* of one triangle */
    uint32_t taken;           /* the vertex at hand */
    uint32_t gathered;        /* vertices whose triangles make way, linked */
    uint32_t vertices_before; /* the present block */
    unsigned char *blocks;
    size_t blocks_bytes, blocks_capacity;
};

/* ---- what the increments ask ---- */

static int by_place(const void *left, const void *right) {
    const struct pending *a = left, *b = right;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return a->x < b->x ? -1 : 1; /* places differ */
}

static uint32_t places(void *context, uint32_t triangle, const struct pending **places) {
    struct encoder *encoder = context;
    uint32_t count = 0;
    for (uint32_t v = encoder->first[triangle]; v != NOT_THERE; v = encoder->next[v]) {
        if (encoder->removal[v] < encoder->layer_removals) continue;
        const struct scree_vertex *at = &encoder->recording->vertices[v];
        encoder->places[count++] = (struct pending){at->x, at->y, triangle, SURFACE_NONE};
    }
    if (count > 1) qsort(encoder->places, count, sizeof *encoder->places, by_place);
    *places = encoder->places;
    return count;
}

static bool ready(void *context, const struct pending *pending) {
    struct encoder *encoder = context;
    const struct recording *recording = encoder->recording;
    uint32_t v = encoder->first[pending->triangle];
    while (v != NOT_THERE && (recording->vertices[v].x != pending->x || recording->vertices[v].y != pending->y))
        v = encoder->next[v];
    encoder->taken = v;
    if (v == NOT_THERE) return false;
    const struct recording_removal *removal = &recording->removals[encoder->removal[v]];
    for (uint32_t i = 0; i < removal->ring_count; i++)
        if (encoder->number[recording->ring[removal->ring_first + i]] == NOT_THERE) return false;
    return true;
}

static int32_t height(void *context) {
    const struct encoder *encoder = context;
    return encoder->recording->vertices[encoder->taken].height;
}

static bool is_inside(void *context, uint32_t from, uint32_t to) {
    const struct encoder *encoder = context;
    const struct recording_removal *removal = &encoder->recording->removals[encoder->removal[encoder->taken]];
    const uint32_t *ring = encoder->recording->ring + removal->ring_first;
    for (uint32_t i = 0; i < removal->ring_count; i++) {
        if (encoder->number[ring[i]] != from) continue;
        uint32_t after = i + 1 < removal->ring_count ? i + 1 : 0;
        return encoder->number[ring[after]] != to;
    }
    return true;
}

static void inserting(void *context, const struct cavity *cavity) {
    struct encoder *encoder = context;
    encoder->gathered = NOT_THERE;
    encoder->number[encoder->taken] = encoder->surface.vertex_count;
    for (uint32_t i = 0; i < cavity->triangle_count; i++)
        for (uint32_t v = encoder->first[cavity->triangles[i]], next; v != NOT_THERE; v = next) {
            next = encoder->next[v];
            if (v == encoder->taken) continue;
            encoder->next[v] = encoder->gathered;
            encoder->gathered = v;
        }
}

static void put(struct encoder *encoder, uint32_t v, uint32_t triangle) {
    encoder->next[v] = encoder->first[triangle];
    encoder->first[triangle] = v;
}

static void inserted(void *context, const struct cavity *cavity) {
    struct encoder *encoder = context;
    for (uint32_t i = 0; i < cavity->edge_count; i++) encoder->first[cavity->slots[i]] = NOT_THERE;
    for (uint32_t v = encoder->gathered, next; v != NOT_THERE; v = next) {
        const struct scree_vertex *at = &encoder->recording->vertices[v];
        uint32_t i = 0;
        next = encoder->next[v];
        while (i + 1 < cavity->edge_count && !surface_has_post(&encoder->surface, cavity->slots[i], at->x, at->y)) i++;
        put(encoder, v, cavity->slots[i]);
    }
}

/* ---- blocks ---- */

/* Codes the layer of the removals from `first` to before `end`. */
static enum scree_status code_layer(struct encoder *encoder, uint32_t first, uint32_t end, struct scree_error *error) {
    uint32_t before = encoder->surface.vertex_count;
    encoder->layer_removals = first;
    enum scree_status status = increment_code(&encoder->increment, end - first, error);
    if (status == SCREE_OK && encoder->surface.vertex_count - before != end - first)
        status = scree_fail(error, SCREE_E_ARGUMENT, "a recording's polygons do not fit together");
    return status;
}

static void begin_block(struct encoder *encoder) {
    scree_release(encoder->memory, encoder->coder.written);
    range_coder_write(encoder->memory, &encoder->coder);
    encoder->vertices_before = encoder->surface.vertex_count;
    encoder->increment.coder = &encoder->coder;
}

/* Appends the block and enters it into the header. */
static enum scree_status end_block(struct encoder *encoder, const struct recording_rung *rung,
                                   struct scree_error *error) {
    enum scree_status status = range_coder_finish(&encoder->coder, error);
    if (status != SCREE_OK) return status;
    uint32_t added = encoder->surface.vertex_count - encoder->vertices_before;
    if (added > (uint64_t)STREAM_VERTICES_PER_BYTE * encoder->coder.written_bytes)
        return scree_fail(error, SCREE_E_LIMIT, "an increment of %u vertices takes fewer bytes than a reader believes",
                          added);
    size_t size_bytes = encoder->coder.written_bytes, wanted = encoder->blocks_bytes + size_bytes;
    if (wanted > encoder->blocks_capacity) {
        unsigned char *larger = scree_reallocate(encoder->memory, encoder->blocks, 2 * wanted, 1, "a stream", error);
        if (larger == NULL) return SCREE_E_MEMORY;
        encoder->blocks = larger;
        encoder->blocks_capacity = 2 * wanted;
    }
    memcpy(encoder->blocks + encoder->blocks_bytes, encoder->coder.written, size_bytes);
    encoder->blocks_bytes = wanted;
    struct scree_rung *entry = &encoder->header->rungs[encoder->header->rung_count++];
    *entry = (struct scree_rung){.rung = rung->rung,
                                 .vertex_count = encoder->surface.vertex_count,
                                 .triangle_count = encoder->surface.triangle_count,
                                 .mmqe_m2 = rung->mmqe_m2,
                                 .max_error_m = rung->max_error_m,
                                 .size_bytes = (uint32_t)size_bytes,
                                 .checksum = (uint32_t)crc32(0, encoder->coder.written, (uInt)size_bytes)};
    return SCREE_OK;
}

/* The largest power of two that divides all heights of vertices that are part of the mesh. */
static uint32_t common_step_bits(const struct encoder *encoder) {
    const struct recording *recording = encoder->recording;
    uint32_t any = 0, bits = 0;
    for (uint32_t i = 0; i < recording->removal_count; i++)
        any |= (uint32_t)recording->vertices[recording->removals[i].vertex].height;
    for (int i = 0; i < 4; i++) any |= (uint32_t)recording->vertices[recording->corners[i]].height;
    while (any != 0 && (any & 1) == 0 && bits < 30) {
        any >>= 1;
        bits++;
    }
    return bits;
}

static enum scree_status code_base(struct encoder *encoder, struct scree_error *error) {
    const struct recording *recording = encoder->recording;
    struct base_start start = {
        .step_bits = common_step_bits(encoder), .layers = recording->stage_count, .rising = recording->rising};
    if (recording->stage_count >= LAYERS_MOST)
        return scree_fail(error, SCREE_E_LIMIT, "a base mesh has more than %d layers", LAYERS_MOST - 1);
    for (int i = 0; i < 4; i++) start.heights[i] = recording->vertices[recording->corners[i]].height;
    base_start_code(&encoder->coder, &start);
    for (int i = 0; i < 4; i++) encoder->surface.vertices[i].height = start.heights[i];
    encoder->increment.height_step = 1 << start.step_bits;
    enum scree_status status = SCREE_OK;
    for (uint32_t stage = recording->stage_count; stage > 0 && status == SCREE_OK; stage--) {
        uint32_t first =
            stage > 1 ? recording->stage_removals[stage - 2] : recording->rungs[recording->rung_count - 1].removals;
        status = code_layer(encoder, first, recording->stage_removals[stage - 1], error);
    }
    return status;
}

/* An increment in its layers, the coarsest first. */
static enum scree_status code_increment(struct encoder *encoder, uint32_t first, uint32_t end,
                                        struct scree_error *error) {
    uint32_t there = encoder->surface.vertex_count, layers = 0, left = end - first;
    enum scree_status status = SCREE_OK;
    for (; left > 0 || layers == 0; layers++) {
        uint32_t most = layer_bound(there + (end - first - left));
        left -= left < most ? left : most;
    }
    if (layers > LAYERS_MOST) return scree_fail(error, SCREE_E_LIMIT, "an increment has too many layers");
    layer_count_code(&encoder->coder, layers);
    for (uint32_t layer = 0; layer < layers && status == SCREE_OK; layer++) {
        uint32_t most = layer_bound(encoder->surface.vertex_count);
        uint32_t coarsest = end - first < most ? first : end - most;
        status = code_layer(encoder, coarsest, end, error);
        end = coarsest;
    }
    return status;
}

static enum scree_status code_blocks(struct encoder *encoder, uint32_t rungs_a_block, struct scree_error *error) {
    const struct recording *recording = encoder->recording;
    uint32_t rung = recording->rung_count - 1;
    begin_block(encoder);
    enum scree_status status = code_base(encoder, error);
    if (status == SCREE_OK) status = end_block(encoder, &recording->rungs[rung], error);
    increment_forget(&encoder->increment);
    while (rung > 0 && status == SCREE_OK) {
        uint32_t end = recording->rungs[rung].removals;
        rung -= rungs_a_block < rung ? rungs_a_block : rung;
        begin_block(encoder);
        status = code_increment(encoder, recording->rungs[rung].removals, end, error);
        if (status == SCREE_OK) status = end_block(encoder, &recording->rungs[rung], error);
    }
    return status;
}

/* ---- the whole ---- */

static enum scree_status check_recording(const struct recording *recording, uint32_t rungs_a_block,
                                         struct scree_error *error) {
    if (recording->rung_count == 0 ||
        (recording->rung_count - 1 + rungs_a_block - 1) / rungs_a_block >= SCREE_MAX_RUNGS)
        return scree_fail(error, SCREE_E_LIMIT, "a stream has 1 to %d rungs, not %u", SCREE_MAX_RUNGS,
                          recording->rung_count);
    if (recording->removal_count >= SCREE_MAX_VERTICES - 4)
        return scree_fail(error, SCREE_E_LIMIT, "a tile has more than %d vertices", SCREE_MAX_VERTICES);
    return SCREE_OK;
}

static enum scree_status start(struct encoder *encoder, int32_t columns, int32_t rows, struct scree_error *error) {
    const struct recording *recording = encoder->recording;
    struct scree_memory *memory = encoder->memory;
    size_t vertices = recording->vertex_count, kept = (size_t)recording->removal_count + 4;
    encoder->removal = scree_allocate(memory, vertices, sizeof *encoder->removal, "an encoder's lists", error);
    encoder->number = scree_allocate(memory, vertices, sizeof *encoder->number, "an encoder's lists", error);
    encoder->next = scree_allocate(memory, vertices, sizeof *encoder->next, "an encoder's lists", error);
    encoder->first = scree_allocate(memory, 2 * kept, sizeof *encoder->first, "an encoder's lists", error);
    encoder->places = scree_allocate(memory, kept, sizeof *encoder->places, "an encoder's lists", error);
    encoder->header = scree_allocate(memory, 1, sizeof *encoder->header, "a stream's header", error);
    if (encoder->removal == NULL || encoder->number == NULL || encoder->next == NULL || encoder->first == NULL ||
        encoder->places == NULL || encoder->header == NULL)
        return SCREE_E_MEMORY;
    enum scree_status status = surface_start(memory, (uint32_t)kept, (uint32_t)(2 * kept), &encoder->surface, error);
    if (status == SCREE_OK)
        status = increment_start(memory, (uint32_t)kept, &encoder->surface, &encoder->increment, error);
    if (status != SCREE_OK) return status;
    surface_rectangle(&encoder->surface, columns, rows, recording->rising);
    for (size_t v = 0; v < vertices; v++) encoder->number[v] = NOT_THERE;
    for (uint32_t i = 0; i < 4; i++) encoder->number[recording->corners[i]] = i;
    encoder->first[0] = encoder->first[1] = NOT_THERE;
    for (uint32_t i = 0; i < recording->removal_count; i++) {
        uint32_t v = recording->removals[i].vertex;
        encoder->removal[v] = i;
        put(encoder, v,
            surface_has_post(&encoder->surface, 0, recording->vertices[v].x, recording->vertices[v].y) ? 0 : 1);
    }
    return SCREE_OK;
}

/* Header and blocks in one piece. SVO grows towards the base. */
static enum scree_status join(struct encoder *encoder, const struct scree_stream_header *place, unsigned char **bytes,
                              size_t *size_bytes, struct scree_error *error) {
    struct scree_stream_header *header = encoder->header;
    uint32_t rung_count = header->rung_count;
    double svo_m = 0;
    for (uint32_t i = rung_count; i-- > 0;) {
        svo_m = fmax(svo_m, sqrt(header->rungs[i].mmqe_m2));
        header->rungs[i].svo_m = (float)svo_m;
    }
    size_t header_bytes = stream_header_bound(rung_count);
    *bytes = scree_allocate(encoder->memory, header_bytes + encoder->blocks_bytes, 1, "a stream", error);
    if (*bytes == NULL) return SCREE_E_MEMORY;
    struct scree_rung *rungs = header->rungs;
    struct scree_rung *kept = scree_allocate(encoder->memory, rung_count, sizeof *kept, "a stream's header", error);
    if (kept == NULL) return SCREE_E_MEMORY;
    memcpy(kept, rungs, rung_count * sizeof *kept);
    *header = *place;
    header->version = SCREE_STREAM_VERSION;
    header->rung_count = rung_count;
    memcpy(rungs, kept, rung_count * sizeof *kept);
    scree_release(encoder->memory, kept);
    size_t written = stream_header_write(header, *bytes, header_bytes);
    memcpy(*bytes + written, encoder->blocks, encoder->blocks_bytes);
    *size_bytes = written + encoder->blocks_bytes;
    return SCREE_OK;
}

static void release(struct encoder *encoder) {
    struct scree_memory *memory = encoder->memory;
    scree_release(memory, encoder->coder.written);
    scree_release(memory, encoder->blocks);
    if (encoder->increment.memory != NULL) increment_release(&encoder->increment);
    surface_release(memory, &encoder->surface);
    scree_release(memory, encoder->header);
    scree_release(memory, encoder->places);
    scree_release(memory, encoder->first);
    scree_release(memory, encoder->next);
    scree_release(memory, encoder->number);
    scree_release(memory, encoder->removal);
}

enum scree_status stream_encode_new(struct scree_memory *memory, const struct scree_stream_header *place,
                                    const struct recording *recording, const struct encode_options *options,
                                    unsigned char **bytes, size_t *size_bytes, struct scree_error *error) {
    const struct increment_plan plan = {NULL, places, ready, height, is_inside, inserting, inserted};
    uint32_t rungs_a_block = options->rungs_per_increment > 0 ? options->rungs_per_increment : 1;
    struct encoder encoder = {.memory = memory, .recording = recording};
    struct increment_plan own = plan;
    *bytes = NULL;
    enum scree_status status = check_recording(recording, rungs_a_block, error);
    if (status == SCREE_OK) status = start(&encoder, place->columns, place->rows, error);
    if (status == SCREE_OK) {
        own.context = &encoder;
        encoder.increment.plan = &own;
        if (options->bits != NULL) {
            encoder.increment.position_bits = &options->bits->position;
            encoder.increment.connectivity_bits = &options->bits->connectivity;
            encoder.increment.height_bits = &options->bits->height;
        }
        status = code_blocks(&encoder, rungs_a_block, error);
    }
    if (status == SCREE_OK) status = join(&encoder, place, bytes, size_bytes, error);
    if (status != SCREE_OK) {
        scree_release(memory, *bytes);
        *bytes = NULL;
    }
    release(&encoder);
    return status;
}
