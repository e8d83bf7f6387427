/* The player as a viewer has it: streams in pieces, seeks of all kinds, damaged and cut streams, memory. */
#include "stream/player.h"
#include "tests/fractal.h"
#include "tests/mesh_maker.h"
#include "tests/progressive_maker.h"
#include "tests/stream_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 64, ROWS = 48 };

struct stream {
    struct scree_memory memory;
    unsigned char *bytes;
    size_t size_bytes;
};

static void make(struct stream *stream, enum scree_profile profile) {
    const struct stream_wish wish = {.seed = 3,
                                     .columns = COLUMNS,
                                     .rows = ROWS,
                                     .height_exponent = -2,
                                     .profile = profile,
                                     .finest_m = 2,
                                     .base_vertices = 40};
    struct scree_error error = {0};
    *stream = (struct stream){.bytes = NULL};
    CU_ASSERT_EQUAL_FATAL(stream_make(&stream->memory, &wish, NULL, &stream->bytes, &stream->size_bytes, &error),
                          SCREE_OK);
}

static void release(struct stream *stream) {
    scree_release(&stream->memory, stream->bytes);
}

static struct scree_player *new_player(void) {
    struct scree_player *player = NULL;
    CU_ASSERT_EQUAL_FATAL(scree_player_new(NULL, &player, NULL), SCREE_OK);
    return player;
}

static struct scree_player *full_player(const struct stream *stream) {
    struct scree_player *player = new_player();
    CU_ASSERT_EQUAL_FATAL(scree_player_push(player, stream->bytes, stream->size_bytes, NULL), SCREE_OK);
    return player;
}

/* Pushes in pieces of 1 to `most_bytes`, until the end or a failure. */
static enum scree_status push_pieces(struct scree_player *player, const unsigned char *bytes, size_t size_bytes,
                                     int32_t most_bytes, uint64_t chance, struct scree_error *error) {
    enum scree_status status = SCREE_MORE;
    for (size_t at = 0; at < size_bytes && status >= 0;) {
        size_t piece_bytes = 1 + (size_t)any_number(&chance, most_bytes);
        if (piece_bytes > size_bytes - at) piece_bytes = size_bytes - at;
        status = scree_player_push(player, bytes + at, piece_bytes, error);
        at += piece_bytes;
    }
    return status;
}

static bool same_floats(const float *a, const float *b, uint32_t vertex_count) {
    return memcmp(a, b, 3 * sizeof *a * vertex_count) == 0;
}

static bool same_arrays(struct scree_player *player, struct scree_player *other) {
    struct scree_arrays a, b;
    scree_player_look(player, &a);
    scree_player_look(other, &b);
    if (a.vertex_count != b.vertex_count || a.triangle_count != b.triangle_count || a.splits != b.splits) return false;
    if (a.vertex_count == 0) return true;
    return memcmp(a.indices, b.indices, 3 * sizeof *a.indices * a.triangle_count) == 0 &&
           memcmp(a.vertices, b.vertices, sizeof *a.vertices * a.vertex_count) == 0 &&
           memcmp(a.increments, b.increments, sizeof *a.increments * a.vertex_count) == 0 &&
           same_floats(a.positions, b.positions, a.vertex_count) && same_floats(a.normals, b.normals, a.vertex_count) &&
           same_floats(a.origins, b.origins, a.vertex_count) && a.level == b.level;
}

static void pieces_make_no_difference(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *whole = full_player(&stream);
    scree_player_seek_rung(whole, UINT32_MAX);
    static const int32_t most_bytes[] = {1, 7, 200, 3000};
    for (unsigned i = 0; i < 4; i++) {
        struct scree_player *player = new_player();
        CU_ASSERT_EQUAL(push_pieces(player, stream.bytes, stream.size_bytes, most_bytes[i], i, NULL), SCREE_OK);
        scree_player_seek_rung(player, UINT32_MAX);
        CU_ASSERT_TRUE(same_arrays(player, whole));
        CU_ASSERT_EQUAL(player_memory(player)->peak_bytes, player_memory(whole)->peak_bytes);
        scree_player_free(player);
    }
    scree_player_free(whole);
    release(&stream);
}

static void rungs_are_ready_when_their_bytes_are_there(void) {
    struct stream stream;
    make(&stream, SCREE_GEODETIC);
    struct scree_stream_header header;
    CU_ASSERT_EQUAL_FATAL(scree_stream_header_read(stream.bytes, stream.size_bytes, &header, NULL), SCREE_OK);
    CU_ASSERT_TRUE(header.rung_count > 4);
    struct scree_player *player = new_player();
    struct scree_arrays arrays;
    for (size_t at = 0; at < stream.size_bytes; at++) {
        uint32_t ready = 0;
        while (ready < header.rung_count && header.rungs[ready].offset_bytes + header.rungs[ready].size_bytes <= at)
            ready++;
        CU_ASSERT_EQUAL(scree_player_rungs_ready(player), ready);
        CU_ASSERT_EQUAL(scree_player_header(player) != NULL, at >= header.size_bytes);
        scree_player_look(player, &arrays);
        CU_ASSERT_EQUAL(arrays.vertex_count, ready == 0 ? 0 : header.rungs[0].vertex_count);
        CU_ASSERT_EQUAL(scree_player_push(player, stream.bytes + at, 1, NULL),
                        at + 1 == stream.size_bytes ? SCREE_OK : SCREE_MORE);
    }
    CU_ASSERT_EQUAL(scree_player_push(player, NULL, 0, NULL), SCREE_OK);
    scree_player_free(player);
    release(&stream);
}

/* One of all the ways to a scale. */
static enum scree_status seek_any(struct scree_player *player, uint64_t *chance) {
    const struct scree_stream_header *header = scree_player_header(player);
    const struct scree_rung *rungs = header->rungs, *finest = &rungs[header->rung_count - 1];
    int32_t rung = any_number(chance, (int32_t)header->rung_count);
    switch (any_number(chance, 5)) {
    case 0: return scree_player_seek_rung(player, (uint32_t)rung);
    case 1: return scree_player_seek_level(player, rung - any_number(chance, 100) / 100.0);
    case 2: return scree_player_seek_svo(player, rungs[rung].svo_m * 1.01);
    case 3: return scree_player_seek_error(player, rungs[rung].max_error_m * 1.01);
    default:
        return scree_player_seek_splits(
            player, (uint32_t)any_number(chance, (int32_t)(finest->vertex_count - rungs[0].vertex_count) + 1));
    }
}

static void any_way_leads_to_the_same_arrays(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *wanderer = full_player(&stream);
    uint64_t chance = 21;
    for (int i = 0; i < 100; i++) {
        struct scree_player *fresh = full_player(&stream);
        uint64_t requests = player_memory(wanderer)->requests, same = chance;
        CU_ASSERT_EQUAL(seek_any(wanderer, &chance), SCREE_OK);
        CU_ASSERT_EQUAL(seek_any(fresh, &same), SCREE_OK);
        CU_ASSERT_TRUE(same_arrays(wanderer, fresh));
        struct scree_border border;
        scree_player_border(wanderer, SCREE_NORTH, &border);
        CU_ASSERT_TRUE(border.vertex_count >= 2);
        CU_ASSERT_EQUAL(player_memory(wanderer)->requests, requests); /* nothing is allocated */
        scree_player_free(fresh);
    }
    scree_player_free(wanderer);
    release(&stream);
}

static void the_way_back_ends_in_the_same_coarse_mesh(void) {
    struct stream stream;
    make(&stream, SCREE_GEODETIC);
    struct scree_player *player = full_player(&stream), *untouched = full_player(&stream);
    const struct scree_stream_header *header = scree_player_header(player);
    struct scree_arrays arrays;
    for (uint32_t i = 0; i < header->rung_count; i++) {
        CU_ASSERT_EQUAL(scree_player_seek_rung(player, i), SCREE_OK);
        scree_player_look(player, &arrays);
        CU_ASSERT_EQUAL(arrays.vertex_count, header->rungs[i].vertex_count);
        CU_ASSERT_EQUAL(arrays.triangle_count, header->rungs[i].triangle_count);
    }
    for (uint32_t i = header->rung_count; i-- > 0;) scree_player_seek_rung(player, i);
    CU_ASSERT_TRUE(same_arrays(player, untouched));
    scree_player_free(untouched);
    scree_player_free(player);
    release(&stream);
}

static void every_split_is_a_mesh(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *player = full_player(&stream);
    const struct scree_stream_header *header = scree_player_header(player);
    uint32_t base = header->rungs[0].vertex_count, splits = header->rungs[header->rung_count - 1].vertex_count - base;
    struct scree_arrays arrays;
    for (uint32_t i = 0; i <= splits; i++) {
        CU_ASSERT_EQUAL(scree_player_seek_splits(player, i), SCREE_OK);
        scree_player_look(player, &arrays);
        CU_ASSERT_EQUAL(arrays.splits, i);
        CU_ASSERT_EQUAL(arrays.vertex_count, base + i);
        for (uint32_t k = 0; k < arrays.vertex_count; k += 7)
            CU_ASSERT_EQUAL(scree_morph_weight(arrays.level, arrays.increments[k]), 1);
        const char *fault = triangles_fault(&stream.memory, arrays.vertices, arrays.vertex_count, arrays.indices,
                                            arrays.triangle_count, COLUMNS, ROWS);
        CU_ASSERT_PTR_NULL(fault);
    }
    scree_player_free(player);
    release(&stream);
}

static void levels_lie_between_rungs(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *player = full_player(&stream);
    const struct scree_stream_header *header = scree_player_header(player);
    struct scree_arrays arrays;
    CU_ASSERT_EQUAL(scree_player_seek_level(player, 1.25), SCREE_OK);
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL(arrays.vertex_count, header->rungs[2].vertex_count);
    for (uint32_t i = 0; i < arrays.vertex_count; i++) {
        CU_ASSERT_EQUAL(scree_morph_weight(arrays.level, arrays.increments[i]), arrays.increments[i] == 2 ? 0.25 : 1);
        bool moves = !same_floats(&arrays.origins[3 * (size_t)i], &arrays.positions[3 * (size_t)i], 1);
        if (arrays.increments[i] == 0) CU_ASSERT_FALSE(moves);
    }
    CU_ASSERT_EQUAL(scree_player_seek_level(player, -3), SCREE_OK);
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL(arrays.vertex_count, header->rungs[0].vertex_count);
    CU_ASSERT_EQUAL(scree_player_seek_level(player, 1e9), SCREE_OK);
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL(arrays.vertex_count, header->rungs[header->rung_count - 1].vertex_count);
    scree_player_free(player);
    release(&stream);
}

/* Where the border's vertices are drawn, morphing. */
static uint32_t drawn_border(struct scree_player *player, enum scree_side side, float drawn[][3], uint32_t capacity) {
    struct scree_border border;
    struct scree_arrays arrays;
    scree_player_border(player, side, &border);
    scree_player_look(player, &arrays);
    CU_ASSERT_TRUE_FATAL(border.vertex_count <= capacity);
    for (uint32_t i = 0; i < border.vertex_count; i++) {
        uint32_t vertex = border.vertices[i];
        float weight = (float)scree_morph_weight(arrays.level, arrays.increments[vertex]);
        for (uint32_t k = 0; k < 3; k++) {
            float from = arrays.origins[3 * vertex + k], to = arrays.positions[3 * vertex + k];
            drawn[i][k] = from + weight * (to - from);
        }
    }
    return border.vertex_count;
}

static void neighbours_meet_while_they_morph(void) {
    enum { SIZE = 64, STRIDE = 2 * SIZE + 3, RUNGS = 14 };
    static float heights_m[(SIZE + 3) * STRIDE];
    const struct fractal mountains = {.seed = 5};
    fractal_window(&mountains, -1, -1, STRIDE, SIZE + 3, heights_m, STRIDE);
    struct stream streams[2] = {0};
    struct scree_player *players[2];
    for (int i = 0; i < 2; i++) {
        const struct stream_wish wish = {.heights_m = &heights_m[STRIDE + 1 + i * SIZE],
                                         .stride = STRIDE,
                                         .columns = SIZE,
                                         .rows = SIZE,
                                         .height_exponent = -2,
                                         .profile = SCREE_LOCAL,
                                         .finest_m = 3,
                                         .rungs = RUNGS};
        CU_ASSERT_EQUAL_FATAL(
            stream_make(&streams[i].memory, &wish, NULL, &streams[i].bytes, &streams[i].size_bytes, NULL), SCREE_OK);
        players[i] = full_player(&streams[i]);
    }
    uint32_t moving = 0;
    for (int step = 0; step <= 4 * (RUNGS - 1); step++) {
        float eastern[SIZE + 1][3], western[SIZE + 1][3];
        scree_player_seek_level(players[0], step / 4.0);
        scree_player_seek_level(players[1], step / 4.0);
        uint32_t count = drawn_border(players[0], SCREE_EAST, eastern, SIZE + 1);
        CU_ASSERT_EQUAL_FATAL(drawn_border(players[1], SCREE_WEST, western, SIZE + 1), count);
        for (uint32_t i = 0; i < count; i++) {
            CU_ASSERT_EQUAL(eastern[i][0], -western[i][0]); /* the middles are one tile apart */
            CU_ASSERT_EQUAL(eastern[i][1], western[i][1]);
            CU_ASSERT_EQUAL(eastern[i][2], western[i][2]);
            moving += eastern[i][2] * 4 != floorf(eastern[i][2] * 4); /* between height steps */
        }
    }
    CU_ASSERT_TRUE(moving > 10);
    for (int i = 0; i < 2; i++) {
        scree_player_free(players[i]);
        release(&streams[i]);
    }
}

static void seeks_find_the_coarsest_that_will_do(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *player = full_player(&stream);
    const struct scree_stream_header *header = scree_player_header(player);
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rungs = header->rungs;
        uint32_t by_svo = scree_stream_rung_of_svo(header, rungs[i].svo_m);
        CU_ASSERT_TRUE(by_svo <= i && rungs[by_svo].svo_m <= rungs[i].svo_m);
        CU_ASSERT_TRUE(by_svo == 0 || rungs[by_svo - 1].svo_m > rungs[i].svo_m);
        uint32_t by_error = scree_stream_rung_of_error(header, rungs[i].max_error_m);
        CU_ASSERT_TRUE(by_error <= i && rungs[by_error].max_error_m <= rungs[i].max_error_m);
        CU_ASSERT_TRUE(by_error == 0 || rungs[by_error - 1].max_error_m > rungs[i].max_error_m);
        CU_ASSERT_EQUAL(scree_stream_rung_of_ladder(header, rungs[i].rung), i);
    }
    CU_ASSERT_EQUAL(scree_stream_rung_of_svo(header, 1e9), 0);
    CU_ASSERT_EQUAL(scree_stream_rung_of_svo(header, 0), header->rung_count - 1);
    CU_ASSERT_EQUAL(scree_stream_rung_of_error(header, NAN), header->rung_count - 1);
    CU_ASSERT_EQUAL(scree_stream_rung_of_ladder(header, INT32_MAX), header->rung_count - 1);
    CU_ASSERT_EQUAL(scree_player_seek_level(player, NAN), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(scree_player_seek_svo(player, NAN), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(scree_player_seek_error(player, NAN), SCREE_E_ARGUMENT);
    scree_player_free(player);
    release(&stream);
}

static void more_than_has_arrived_is_wanted(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *player = new_player();
    CU_ASSERT_EQUAL(scree_player_seek_rung(player, 0), SCREE_MORE);
    CU_ASSERT_EQUAL(scree_player_seek_splits(player, 5), SCREE_MORE);
    CU_ASSERT_EQUAL(scree_player_seek_svo(player, 5), SCREE_MORE);
    struct scree_border border;
    scree_player_border(player, SCREE_WEST, &border);
    CU_ASSERT_EQUAL(border.vertex_count, 0);
    struct scree_range range;
    CU_ASSERT_FALSE(scree_player_dirty_slots(player, &range));
    struct scree_stream_header header;
    scree_stream_header_read(stream.bytes, stream.size_bytes, &header, NULL);
    CU_ASSERT_EQUAL(scree_player_push(player, stream.bytes, header.rungs[3].offset_bytes, NULL), SCREE_MORE);
    CU_ASSERT_EQUAL(scree_player_seek_rung(player, 2), SCREE_OK);
    CU_ASSERT_EQUAL(scree_player_seek_level(player, 2.5), SCREE_MORE);
    CU_ASSERT_EQUAL(scree_player_seek_error(player, 0), SCREE_MORE);
    CU_ASSERT_EQUAL(scree_player_seek_splits(player, UINT32_MAX), SCREE_MORE);
    struct scree_arrays arrays;
    scree_player_look(player, &arrays);
    CU_ASSERT_EQUAL(arrays.vertex_count, header.rungs[2].vertex_count);
    scree_player_free(player);
    release(&stream);
}

/* The same line, byte and status whatever the pieces; what had arrived goes on playing. */
static void damage_is_told_and_survived(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_stream_header header;
    scree_stream_header_read(stream.bytes, stream.size_bytes, &header, NULL);
    const size_t places[] = {3, header.size_bytes / 2, header.rungs[0].offset_bytes, header.rungs[2].offset_bytes + 5,
                             stream.size_bytes - 1};
    for (unsigned i = 0; i < 5; i++) {
        stream.bytes[places[i]] ^= 0x40;
        struct scree_player *player = new_player(), *other = new_player();
        struct scree_error error = {0}, again = {0}, in_pieces = {0};
        enum scree_status status = scree_player_push(player, stream.bytes, stream.size_bytes, &error);
        CU_ASSERT_EQUAL(status, SCREE_E_CORRUPT);
        CU_ASSERT_EQUAL(scree_player_push(player, "", 0, &again), status);
        CU_ASSERT_EQUAL(push_pieces(other, stream.bytes, stream.size_bytes, 60, i, &in_pieces), status);
        CU_ASSERT_STRING_EQUAL(error.text, again.text);
        CU_ASSERT_STRING_EQUAL(error.text, in_pieces.text);
        CU_ASSERT_EQUAL(error.offset_bytes, in_pieces.offset_bytes);
        static const uint32_t left[] = {0, 0, 0, 2};
        CU_ASSERT_EQUAL(scree_player_rungs_ready(player), i < 4 ? left[i] : header.rung_count - 1);
        if (i >= 3) CU_ASSERT_EQUAL(scree_player_seek_rung(player, 1), SCREE_OK);
        CU_ASSERT_EQUAL(scree_player_seek_rung(player, UINT32_MAX), SCREE_MORE);
        scree_player_seek_rung(other, UINT32_MAX);
        CU_ASSERT_TRUE(same_arrays(player, other));
        scree_player_free(other);
        scree_player_free(player);
        stream.bytes[places[i]] ^= 0x40;
    }
    release(&stream);
}

static void bytes_behind_the_end_are_corrupt(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *player = full_player(&stream);
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(scree_player_push(player, "x", 1, &error), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(error.offset_bytes, (int64_t)stream.size_bytes);
    CU_ASSERT_EQUAL(scree_player_seek_rung(player, UINT32_MAX), SCREE_OK);
    scree_player_free(player);
    release(&stream);
}

static void memory_has_a_limit(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    struct scree_player *unlimited = full_player(&stream);
    size_t peak_bytes = player_memory(unlimited)->peak_bytes;
    scree_player_free(unlimited);
    for (size_t limit_bytes = peak_bytes; limit_bytes > peak_bytes / 50; limit_bytes -= limit_bytes / 20 + 1) {
        const struct scree_player_options options = {.memory_limit_bytes = limit_bytes};
        struct scree_player *player, *other;
        struct scree_error error = {0};
        enum scree_status made = scree_player_new(&options, &player, &error);
        if (made != SCREE_OK) {
            CU_ASSERT_EQUAL(made, SCREE_E_LIMIT);
            CU_ASSERT_PTR_NULL(player);
            continue;
        }
        enum scree_status status = scree_player_push(player, stream.bytes, stream.size_bytes, &error);
        CU_ASSERT_EQUAL(status, limit_bytes == peak_bytes ? SCREE_OK : SCREE_E_LIMIT);
        CU_ASSERT_EQUAL(error.status, status);
        CU_ASSERT_TRUE(player_memory(player)->peak_bytes <= limit_bytes);
        CU_ASSERT_EQUAL_FATAL(scree_player_new(&options, &other, NULL), SCREE_OK);
        CU_ASSERT_EQUAL(push_pieces(other, stream.bytes, stream.size_bytes, 50, limit_bytes, NULL), status);
        CU_ASSERT_EQUAL(scree_player_rungs_ready(other), scree_player_rungs_ready(player));
        scree_player_free(other);
        scree_player_free(player);
    }
    release(&stream);
}

/* The n-th request fails, for every n: a clean error, and the player plays what it has and can be freed. */
static void failed_requests_are_survived(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    enum scree_status status = SCREE_E_MEMORY;
    for (uint64_t n = 1; status != SCREE_OK; n++) {
        const struct scree_memory memory = {.fail_request = n};
        struct scree_player *player;
        struct scree_error error = {0};
        status = player_new_in(&memory, NULL, &player, &error);
        if (status == SCREE_OK) {
            status = scree_player_push(player, stream.bytes, stream.size_bytes, &error);
            uint32_t ready = scree_player_rungs_ready(player);
            struct scree_arrays arrays;
            CU_ASSERT_EQUAL(scree_player_seek_rung(player, UINT32_MAX), status == SCREE_OK ? SCREE_OK : SCREE_MORE);
            scree_player_look(player, &arrays);
            if (ready > 0) {
                CU_ASSERT_EQUAL(arrays.vertex_count, scree_player_header(player)->rungs[ready - 1].vertex_count);
                const char *fault = triangles_fault(&stream.memory, arrays.vertices, arrays.vertex_count,
                                                    arrays.indices, arrays.triangle_count, COLUMNS, ROWS);
                CU_ASSERT_PTR_NULL(fault);
            }
        }
        CU_ASSERT_EQUAL(error.status, status == SCREE_OK ? SCREE_OK : SCREE_E_MEMORY);
        scree_player_free(player);
        CU_ASSERT_TRUE_FATAL(n < 10000);
    }
    release(&stream);
}

static void arrays_may_be_left_out(void) {
    struct stream stream;
    make(&stream, SCREE_LOCAL);
    static const struct scree_player_options wishes[] = {
        {.without_normals = true}, {.without_origins = true}, {.without_positions = true}};
    for (unsigned i = 0; i < 3; i++) {
        struct scree_player *player;
        struct scree_arrays arrays;
        CU_ASSERT_EQUAL_FATAL(scree_player_new(&wishes[i], &player, NULL), SCREE_OK);
        CU_ASSERT_EQUAL(scree_player_push(player, stream.bytes, stream.size_bytes, NULL), SCREE_OK);
        scree_player_seek_rung(player, UINT32_MAX);
        scree_player_look(player, &arrays);
        CU_ASSERT_EQUAL(arrays.positions == NULL, wishes[i].without_positions);
        CU_ASSERT_EQUAL(arrays.normals == NULL, wishes[i].without_positions || wishes[i].without_normals);
        CU_ASSERT_EQUAL(arrays.origins == NULL, wishes[i].without_positions || wishes[i].without_origins);
        CU_ASSERT_PTR_NOT_NULL(arrays.increments);
        scree_player_free(player);
    }
    scree_player_free(NULL);
    release(&stream);
}

int suite_player(void) {
    CU_pSuite suite = CU_add_suite("player", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, pieces_make_no_difference);
    CU_ADD_TEST(suite, rungs_are_ready_when_their_bytes_are_there);
    CU_ADD_TEST(suite, any_way_leads_to_the_same_arrays);
    CU_ADD_TEST(suite, the_way_back_ends_in_the_same_coarse_mesh);
    CU_ADD_TEST(suite, every_split_is_a_mesh);
    CU_ADD_TEST(suite, levels_lie_between_rungs);
    CU_ADD_TEST(suite, neighbours_meet_while_they_morph);
    CU_ADD_TEST(suite, seeks_find_the_coarsest_that_will_do);
    CU_ADD_TEST(suite, more_than_has_arrived_is_wanted);
    CU_ADD_TEST(suite, damage_is_told_and_survived);
    CU_ADD_TEST(suite, bytes_behind_the_end_are_corrupt);
    CU_ADD_TEST(suite, memory_has_a_limit);
    CU_ADD_TEST(suite, failed_requests_are_survived);
    CU_ADD_TEST(suite, arrays_may_be_left_out);
    return 0;
}
