/* The coder of increments: bits come back, every post is of one triangle, and what was recorded is decoded again,
 * triangle by triangle at every rung, from posts and from merged children, with flips at the borders. */
#include "lod/recorder.h"
#include "lod/tile.h"
#include "stream/decode.h"
#include "stream/encode.h"
#include "stream/places.h"
#include "stream/stream_header.h"
#include "tests/fractal.h"
#include "tests/mesh_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the range coder ---- */

#define SYMBOLS 20000

static uint64_t large_count(uint64_t i) {
    return 1 + (UINT64_C(0x9E3779B97F4A7C15) * (i + 1) >> (2 + i % 62));
}

/* A mixture of everything that can be coded; returns how many symbols came back wrong. */
static int code_mixture(struct range_coder *coder, uint64_t seed, int32_t sure) {
    struct bit_model models[3] = {bit_model(50), bit_model(1), bit_model(90)};
    uint64_t state = seed;
    int wrong = 0;
    for (uint64_t i = 0; i < SYMBOLS; i++) {
        int32_t any = any_number(&state, 1 << 30);
        bool bit = any % 1000 < sure;
        wrong += code_bit(coder, &models[i % 3], coder->writing && bit) != bit;
        if (i % 7 != 0) continue;
        uint32_t count = 1 + (uint32_t)any % UNIFORM_MOST, value = (uint32_t)any_number(&state, (int32_t)count);
        wrong += code_uniform(coder, count, coder->writing ? value : 0) != value;
        uint64_t large = large_count(i), large_value = (uint64_t)any % large;
        wrong += code_large_uniform(coder, large, coder->writing ? large_value : 0) != large_value;
        wrong += code_large_uniform(coder, large, coder->writing ? large - 1 : 0) != large - 1;
        uint32_t start = value / 2, width = value - start + 1, total = count + 1;
        if (total > UNIFORM_MOST) continue;
        uint32_t part = coder->writing ? start : code_ask(coder, total);
        wrong += part < start || part >= start + width;
        code_take(coder, total, start, width);
    }
    return wrong;
}

static void symbols_come_back(void) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct scree_memory memory = {0};
        struct range_coder writer, reader;
        int32_t sure = (int32_t)(seed % 5) * 250; /* from never to always */
        range_coder_write(&memory, &writer);
        code_mixture(&writer, seed, sure);
        CU_ASSERT_EQUAL_FATAL(range_coder_finish(&writer, NULL), SCREE_OK);
        range_coder_read(writer.written, writer.written_bytes, &reader);
        CU_ASSERT_EQUAL(code_mixture(&reader, seed, sure), 0);
        CU_ASSERT(range_coder_is_spent(&reader));
        range_coder_read(writer.written, writer.written_bytes - 6, &reader);
        code_mixture(&reader, seed, sure);
        CU_ASSERT_FALSE(range_coder_is_spent(&reader));
        scree_release(&memory, writer.written);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
}

static void sure_bits_are_nearly_free(void) {
    struct scree_memory memory = {0};
    struct range_coder writer;
    struct bit_model model = bit_model(50);
    double cost_bits = 0;
    range_coder_write(&memory, &writer);
    writer.cost_bits = &cost_bits;
    for (int i = 0; i < SYMBOLS; i++) code_bit(&writer, &model, i % 1000 == 0);
    CU_ASSERT_EQUAL(range_coder_finish(&writer, NULL), SCREE_OK);
    CU_ASSERT(writer.written_bytes < SYMBOLS / 8 / 25);
    CU_ASSERT_DOUBLE_EQUAL(cost_bits, 8.0 * (double)writer.written_bytes, 40);
    scree_release(&memory, writer.written);
}

/* ---- posts ---- */

#define POST_SIDE 24

/* Inserts a chance vertex with no more than the triangles that it must open. */
static void insert_somewhere(struct surface *surface, struct cavity *cavity, uint64_t *state) {
    uint32_t t = 0;
    int32_t x = any_number(state, POST_SIDE + 1), y = any_number(state, POST_SIDE + 1);
    while (t < surface->triangle_count && !surface_has_post(surface, t, x, y)) t++;
    if (t == surface->triangle_count) return; /* a vertex is there */
    const struct scree_vertex at = {x, y, 0};
    memset(cavity, 0, sizeof *cavity);
    cavity->triangles[cavity->triangle_count++] = t;
    uint32_t under = SURFACE_NONE;
    for (uint32_t e = 4 * t; e < 4 * t + 3; e++)
        if (surface_area2(&surface->vertices[surface_origin(surface, e)],
                          &surface->vertices[surface_origin(surface, surface_next(e))], &at) == 0)
            under = e;
    uint32_t first = under == SURFACE_NONE ? 4 * t : under, beyond = surface_twin(surface, first);
    if (under == SURFACE_NONE) cavity->edges[cavity->edge_count++] = first;
    cavity->edges[cavity->edge_count++] = surface_next(first);
    cavity->edges[cavity->edge_count++] = surface_previous(first);
    cavity->open = under != SURFACE_NONE && beyond == SURFACE_NONE;
    if (under != SURFACE_NONE && beyond != SURFACE_NONE) {
        cavity->triangles[cavity->triangle_count++] = beyond >> 2;
        cavity->edges[cavity->edge_count++] = surface_next(beyond);
        cavity->edges[cavity->edge_count++] = surface_previous(beyond);
    }
    surface->vertices[surface->vertex_count] = at;
    surface_insert(surface, cavity, NULL);
}

/* How many posts that are no vertices belong to one triangle, to none or to several, or are counted wrongly. */
static int misplaced_posts(const struct surface *surface) {
    int32_t owners[POST_SIDE + 1][POST_SIDE + 1] = {{0}};
    int wrong = 0;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        int count = 0;
        for (int32_t y = 0; y <= POST_SIDE; y++)
            for (int32_t x = 0; x <= POST_SIDE; x++)
                if (surface_has_post(surface, t, x, y)) {
                    owners[y][x]++;
                    count++;
                }
        wrong += count != surface->triangles[t].posts;
    }
    for (uint32_t v = 0; v < surface->vertex_count; v++) owners[surface->vertices[v].y][surface->vertices[v].x]++;
    for (int32_t y = 0; y <= POST_SIDE; y++)
        for (int32_t x = 0; x <= POST_SIDE; x++) wrong += owners[y][x] != 1;
    return wrong;
}

static void every_post_is_of_one_triangle(void) {
    struct scree_memory memory = {0};
    struct surface surface;
    static struct cavity cavity;
    uint64_t state = 5;
    for (int rising = 0; rising < 2; rising++) {
        CU_ASSERT_EQUAL_FATAL(surface_start(&memory, 1000, 2000, &surface, NULL), SCREE_OK);
        surface_rectangle(&surface, POST_SIDE, POST_SIDE, rising != 0);
        for (int i = 0; i < 300; i++) {
            if (i % 10 == 0) CU_ASSERT_EQUAL(misplaced_posts(&surface), 0);
            insert_somewhere(&surface, &cavity, &state);
        }
        CU_ASSERT(surface.vertex_count > 200);
        surface_release(&memory, &surface);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* Sets of posts of every size, in triangles that are looked through and in ones that are too large for that. */
static void sets_of_posts_come_back(void) {
    struct scree_memory memory = {0};
    struct surface surface;
    for (int32_t side = 3; side < 70000; side = side * 5 / 3) {
        CU_ASSERT_EQUAL_FATAL(surface_start(&memory, 4, 2, &surface, NULL), SCREE_OK);
        surface_rectangle(&surface, side, side + 1, true);
        uint32_t posts = surface.triangles[1].posts;
        for (uint32_t count = 1; count <= posts && count < 8; count++) {
            struct pending places[8] = {{0}}, coded[8];
            struct range_coder coder;
            struct place_models models;
            uint32_t found = 0, skip = posts / (count + 1);
            for (int32_t y = 0; y <= side + 1 && found < count; y++)
                for (int32_t x = 0, skipped = 0; x <= side && found < count && skipped < 100; x++)
                    if (surface_has_post(&surface, 1, x, y) && skipped++ >= (int32_t)(skip % 7))
                        places[found++] = (struct pending){x, y, 1, 0};
            if (found < count) continue;
            memcpy(coded, places, sizeof coded);
            range_coder_write(&memory, &coder);
            place_models_start(&models);
            CU_ASSERT(places_code(&coder, &models, &surface, 1, count, coded));
            CU_ASSERT_EQUAL_FATAL(range_coder_finish(&coder, NULL), SCREE_OK);
            unsigned char *written = coder.written;
            range_coder_read(written, coder.written_bytes, &coder);
            place_models_start(&models);
            memset(coded, 0, sizeof coded);
            CU_ASSERT(places_code(&coder, &models, &surface, 1, count, coded));
            for (uint32_t i = 0; i < count; i++) CU_ASSERT(coded[i].x == places[i].x && coded[i].y == places[i].y);
            scree_release(&memory, written);
        }
        surface_release(&memory, &surface);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- recordings ---- */

#define SIDE      128
#define MOST_MARK 40

struct journey {
    struct scree_memory memory;
    struct tile tile;
    struct recorder recorder;
    struct scree_mesh marks[MOST_MARK]; /* the mesh at each rung, fine to coarse */
    uint32_t mark_count;
};

static float post_height(int32_t relief, int32_t x, int32_t y) {
    const struct fractal fractal = {21, true};
    float height_m = 0;
    if (relief == 0) return 0;
    fractal_window(&fractal, x, y, 1, 1, &height_m, 1);
    return height_m;
}

static void start_tile(struct journey *journey, int32_t x, int32_t y, int32_t side, int32_t relief) {
    static float heights_m[(2 * SIDE + 3) * (2 * SIDE + 3)];
    double metres[2 * SIDE + 1];
    const struct tile_geometry geometry = {
        .columns = side, .rows = side, .cell_span = 1, .height_unit_m = 0.25, .east_m = 30, .north_m = 30};
    for (int32_t row = 0; row < side + 3; row++)
        for (int32_t column = 0; column < side + 3; column++)
            heights_m[row * (side + 3) + column] = post_height(relief, x + column - 1, y + row - 1);
    for (int32_t row = 0; row <= side; row++) metres[row] = 30;
    struct tile_posts posts = {heights_m + side + 3 + 1, side + 3, metres, metres};
    CU_ASSERT_EQUAL_FATAL(tile_from_posts(&journey->memory, &geometry, &posts, &journey->tile, NULL), SCREE_OK);
}

static void mark(struct journey *journey) {
    struct scree_error error = {0};
    uint32_t i = journey->mark_count++;
    const struct recording_rung rung = {
        .rung = -(int32_t)i, .mmqe_m2 = (float)tile_mmqe_m2(&journey->tile), .max_error_m = 1};
    CU_ASSERT_EQUAL_FATAL(recorder_mark(&journey->recorder, &rung, &error), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(mesh_export_new(&journey->memory, &journey->tile.mesh, &journey->marks[i], NULL), SCREE_OK);
}

/* Records the tile as it is, and then at tolerances that grow by a quarter octave. */
static void travel(struct journey *journey, double tolerance_m, uint32_t rungs) {
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(recorder_start(&journey->memory, &journey->tile.mesh, &journey->recorder, NULL), SCREE_OK);
    journey->tile.simplifier.options.observer = &journey->recorder.observer;
    mark(journey);
    for (uint32_t i = 1; i < rungs; i++) {
        CU_ASSERT_EQUAL_FATAL(tile_advance(&journey->tile, tolerance_m * exp2((i - 1) / 4.0), &error), SCREE_OK);
        mark(journey);
    }
    CU_ASSERT_EQUAL_FATAL(recorder_finish(&journey->recorder, &error), SCREE_OK);
}

static void end(struct journey *journey) {
    for (uint32_t i = 0; i < journey->mark_count; i++) {
        scree_release(&journey->memory, journey->marks[i].corners);
        scree_release(&journey->memory, journey->marks[i].vertices);
    }
    recorder_release(&journey->recorder);
    tile_release(&journey->tile);
    CU_ASSERT_EQUAL(journey->memory.used_bytes, 0);
    memset(journey, 0, sizeof *journey);
}

static int compare_triangles(const void *left, const void *right) {
    return memcmp(left, right, 3 * sizeof(struct scree_vertex));
}

static bool comes_first(const struct scree_vertex *a, const struct scree_vertex *b) {
    return a->y < b->y || (a->y == b->y && a->x < b->x);
}

/* The triangles as places, each from its lowest corner on, in order; malloc'd. */
static struct scree_vertex *places_of(const struct scree_vertex *vertices, const uint32_t *corners, uint32_t count) {
    struct scree_vertex *places = malloc((size_t)count * 3 * sizeof *places);
    CU_ASSERT_PTR_NOT_NULL_FATAL(places);
    for (uint32_t t = 0; t < count; t++) {
        uint32_t first = 0;
        for (uint32_t i = 1; i < 3; i++)
            if (comes_first(&vertices[corners[3 * t + i]], &vertices[corners[3 * t + first]])) first = i;
        for (uint32_t i = 0; i < 3; i++) places[3 * t + i] = vertices[corners[3 * t + (first + i) % 3]];
    }
    qsort(places, count, 3 * sizeof *places, compare_triangles);
    return places;
}

static bool same_surface(const struct scree_mesh *mesh, const struct scree_vertex *vertices, const uint32_t *corners,
                         uint32_t count) {
    if (mesh->triangle_count != count) return false;
    struct scree_vertex *a = places_of(mesh->vertices, mesh->corners, count), *b = places_of(vertices, corners, count);
    bool same = memcmp(a, b, (size_t)count * 3 * sizeof *a) == 0;
    free(b);
    free(a);
    return same;
}

/* Corners after all splits so far; false when a fix-up does not find what it says. */
static bool apply(const struct progressive *decoded, uint32_t *corners) {
    bool fits = true;
    memcpy(corners, decoded->corners, (size_t)decoded->triangle_count * 3 * sizeof *corners);
    for (uint32_t i = 0; i < decoded->fixup_count; i++) {
        const struct progressive_fixup *fixup = &decoded->fixups[i];
        fits = fits && corners[fixup->slot] == fixup->coarse;
        corners[fixup->slot] = fixup->fine;
    }
    return fits;
}

/* Encodes and decodes; every rung must be the mesh that was marked. Returns the bytes. */
static size_t go_and_return(struct journey *journey, uint32_t rungs_per_increment) {
    static struct scree_stream_header header;
    const struct scree_stream_header place = {.profile = SCREE_LOCAL,
                                              .columns = journey->tile.geometry.columns,
                                              .rows = journey->tile.geometry.rows,
                                              .spacing_x = 30,
                                              .spacing_y = 30,
                                              .metres_x = 30,
                                              .metres_y = 30,
                                              .height_exponent = -2};
    const struct encode_options options = {rungs_per_increment, NULL};
    struct scree_error error = {0};
    struct stream_decoder *decoder = NULL;
    unsigned char *bytes = NULL;
    size_t size_bytes = 0, used_bytes = journey->memory.used_bytes;
    enum scree_status status = stream_encode_new(&journey->memory, &place, &journey->recorder.recording, &options,
                                                 &bytes, &size_bytes, &error);
    if (status == SCREE_OK) status = stream_header_read(bytes, size_bytes, &header, &error);
    if (status == SCREE_OK) status = stream_decoder_new(&journey->memory, &header, &decoder, &error);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    uint32_t blocks = (journey->mark_count - 1 + rungs_per_increment - 1) / rungs_per_increment + 1;
    CU_ASSERT_EQUAL_FATAL(header.rung_count, blocks);
    uint32_t *corners = malloc((size_t)header.rungs[blocks - 1].triangle_count * 3 * sizeof *corners);
    CU_ASSERT_PTR_NOT_NULL_FATAL(corners);
    for (uint32_t i = 0; i < blocks; i++) {
        const struct scree_rung *rung = &header.rungs[i];
        status = stream_decode_block(decoder, bytes + rung->offset_bytes, rung->size_bytes, &error);
        if (status != SCREE_OK) printf("\n    block %u: %s\n", i, error.text);
        CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
        const struct progressive *decoded = stream_decoded(decoder);
        CU_ASSERT(apply(decoded, corners));
        CU_ASSERT(same_surface(&journey->marks[-rung->rung], decoded->vertices, corners, decoded->triangle_count));
    }
    free(corners);
    stream_decoder_free(decoder);
    scree_release(&journey->memory, bytes);
    CU_ASSERT_EQUAL(journey->memory.used_bytes, used_bytes);
    return size_bytes;
}

static void a_tile_comes_back_at_every_rung(void) {
    static struct journey journey;
    start_tile(&journey, 700, 200, SIDE, 1);
    CU_ASSERT_EQUAL_FATAL(tile_advance(&journey.tile, 4, NULL), SCREE_OK);
    travel(&journey, 4 * exp2(0.25), 24);
    size_t single_bytes = go_and_return(&journey, 1);
    CU_ASSERT_EQUAL(go_and_return(&journey, 1), single_bytes);
    CU_ASSERT(go_and_return(&journey, 3) < single_bytes);
    CU_ASSERT(go_and_return(&journey, 100) < single_bytes);
    end(&journey);
}

/* Every post from the first rung on: relief, and a level sea on which all of them go at once. */
static void a_full_grid_comes_back(void) {
    static struct journey journey;
    for (int32_t relief = 0; relief < 2; relief++) {
        start_tile(&journey, 0, 0, SIDE, relief);
        travel(&journey, 0.5, 16);
        size_t size_bytes = go_and_return(&journey, 1);
        if (relief == 0) CU_ASSERT(size_bytes * 8 < 6 * (SIDE + 1) * (SIDE + 1));
        end(&journey);
    }
}

/* A merged tile, whose border vertices have large stars and want flips. */
static void a_merged_tile_comes_back(void) {
    static struct journey children[4], parent;
    struct coarse_tile *coarse[4];
    const struct coarse_tile *views[4];
    const struct tile_geometry geometry = {
        .columns = SIDE, .rows = SIDE, .cell_span = 2, .height_unit_m = 0.25, .east_m = 30, .north_m = 30};
    for (int32_t i = 0; i < 4; i++) {
        start_tile(&children[i], 700 + i % 2 * SIDE / 2, 200 + i / 2 * SIDE / 2, SIDE / 2, 1);
        CU_ASSERT_EQUAL_FATAL(tile_advance(&children[i].tile, 12, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(&children[i].tile, &coarse[i], NULL), SCREE_OK);
        tile_release(&children[i].tile);
        views[i] = coarse[i];
    }
    CU_ASSERT_EQUAL_FATAL(tile_from_children(&parent.memory, &geometry, views, &parent.tile, NULL), SCREE_OK);
    travel(&parent, 14, 24);
    go_and_return(&parent, 1);
    end(&parent);
    for (int i = 0; i < 4; i++) {
        coarse_tile_free(&children[i].memory, coarse[i]);
        CU_ASSERT_EQUAL(children[i].memory.used_bytes, 0);
        memset(&children[i], 0, sizeof children[i]);
    }
}

static void a_recording_that_does_not_fit_is_refused(void) {
    static struct journey journey;
    const struct scree_stream_header place = {.profile = SCREE_LOCAL, .columns = SIDE, .rows = SIDE};
    const struct encode_options options = {0};
    struct scree_error error = {0};
    unsigned char *bytes;
    size_t size_bytes;
    start_tile(&journey, 0, 0, SIDE, 1);
    travel(&journey, 3, 8);
    struct recording_removal *removal = &journey.recorder.removals[journey.recorder.recording.removal_count / 2];
    journey.recorder.ring[removal->ring_first] = removal->vertex; /* waits for itself */
    CU_ASSERT(stream_encode_new(&journey.memory, &place, &journey.recorder.recording, &options, &bytes, &size_bytes,
                                &error) < 0);
    CU_ASSERT_PTR_NULL(bytes);
    CU_ASSERT(strlen(error.text) > 0);
    end(&journey);
}

static void lack_of_memory_leaves_nothing(void) {
    static struct journey journey;
    const struct scree_stream_header place = {.profile = SCREE_LOCAL,
                                              .columns = 32,
                                              .rows = 32,
                                              .spacing_x = 1,
                                              .spacing_y = 1,
                                              .metres_x = 1,
                                              .metres_y = 1};
    const struct encode_options options = {0};
    unsigned char *bytes;
    size_t size_bytes;
    start_tile(&journey, 0, 0, 32, 1);
    travel(&journey, 3, 8);
    size_t used_bytes = journey.memory.used_bytes;
    enum scree_status status = SCREE_E_MEMORY;
    for (uint64_t n = 1; status != SCREE_OK; n++) {
        journey.memory.requests = 0;
        journey.memory.fail_request = n;
        status = stream_encode_new(&journey.memory, &place, &journey.recorder.recording, &options, &bytes, &size_bytes,
                                   NULL);
        CU_ASSERT_FATAL(status == SCREE_OK || (status == SCREE_E_MEMORY && journey.memory.used_bytes == used_bytes));
        CU_ASSERT_FATAL(n < 1000);
    }
    scree_release(&journey.memory, bytes);
    end(&journey);
}

int suite_codec(void) {
    CU_pSuite suite = CU_add_suite("codec", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, symbols_come_back);
    CU_ADD_TEST(suite, sure_bits_are_nearly_free);
    CU_ADD_TEST(suite, every_post_is_of_one_triangle);
    CU_ADD_TEST(suite, sets_of_posts_come_back);
    CU_ADD_TEST(suite, a_tile_comes_back_at_every_rung);
    CU_ADD_TEST(suite, a_full_grid_comes_back);
    CU_ADD_TEST(suite, a_merged_tile_comes_back);
    CU_ADD_TEST(suite, a_recording_that_does_not_fit_is_refused);
    CU_ADD_TEST(suite, lack_of_memory_leaves_nothing);
    return 0;
}
