/* fuzz_stream: any bytes, pushed in any pieces into a player that seeks up and down all the while. What it shows must
 * be a mesh: indices in range, triangles counter-clockwise, counts as the header states them.
 *
 * Input is a stream, without anything around it. It is tried as it is and, since hardly any change outlives a checksum,
 * once more with its checksums and sizes made to fit. How it is cut and where is sought follows from its own bytes.
 *
 * `make fuzz` links this with libFuzzer; `make check` with tests/fuzz_replay.c, which runs files. */
#include "tests/stream_forge.h"
#include <scree/player.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define MEMORY_LIMIT_BYTES ((size_t)2 << 20)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes);

/* Stops here, where a debugger and libFuzzer see it. */
#define DEMAND(condition)                                                                \
    do {                                                                                 \
        if (!(condition)) {                                                              \
            fprintf(stderr, "fuzz_stream: not so, line %d: %s\n", __LINE__, #condition); \
            abort();                                                                     \
        }                                                                                \
    } while (0)

/* Numbers that follow from a seed (xorshift). */
static uint32_t next_number(uint32_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static int64_t area2(const struct scree_vertex *a, const struct scree_vertex *b, const struct scree_vertex *c) {
    return ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)c->x - a->x) * ((int64_t)b->y - a->y);
}

static void check_vertices(const struct scree_stream_header *header, const struct scree_arrays *arrays) {
    for (uint32_t v = 0; v < arrays->vertex_count; v++) {
        const struct scree_vertex *vertex = &arrays->vertices[v];
        DEMAND(vertex->x >= 0 && vertex->x <= header->columns && vertex->y >= 0 && vertex->y <= header->rows);
        DEMAND(arrays->increments[v] < header->rung_count);
        for (int i = 0; i < 3; i++) {
            DEMAND(arrays->positions == NULL || !isnan(arrays->positions[3 * v + i]));
            DEMAND(arrays->origins == NULL || !isnan(arrays->origins[3 * v + i]));
            DEMAND(arrays->normals == NULL || !isnan(arrays->normals[3 * v + i]));
        }
    }
}

/* Areas add up to the tile's: together with positive triangles, nothing is covered twice or left out. */
static void check_triangles(const struct scree_stream_header *header, const struct scree_arrays *arrays) {
    uint64_t covered2 = 0;
    for (uint32_t t = 0; t < arrays->triangle_count; t++) {
        const uint32_t *corner = arrays->indices + 3 * (size_t)t;
        for (int i = 0; i < 3; i++) DEMAND(corner[i] < arrays->vertex_count);
        int64_t twice = area2(&arrays->vertices[corner[0]], &arrays->vertices[corner[1]], &arrays->vertices[corner[2]]);
        DEMAND(twice > 0);
        covered2 += (uint64_t)twice;
    }
    DEMAND(covered2 == 2 * (uint64_t)header->columns * (uint64_t)header->rows);
}

static void check_borders(struct scree_player *player, const struct scree_arrays *arrays) {
    for (int side = 0; side < SCREE_SIDES; side++) {
        struct scree_border border;
        scree_player_border(player, (enum scree_side)side, &border);
        DEMAND(border.vertex_count >= 2 && border.vertex_count <= arrays->vertex_count);
        for (uint32_t i = 0; i < border.vertex_count; i++) DEMAND(border.vertices[i] < arrays->vertex_count);
        for (uint32_t i = 0; i + 1 < border.vertex_count; i++) DEMAND(border.apexes[i] < 3 * arrays->triangle_count);
    }
}

static void check_dirty(struct scree_player *player, const struct scree_arrays *arrays) {
    struct scree_range range = scree_player_dirty_vertices(player);
    DEMAND(range.first <= range.end && range.end <= arrays->vertex_count);
    uint32_t end = 0;
    while (scree_player_dirty_slots(player, &range)) {
        DEMAND(range.first >= end && range.first < range.end && range.end <= 3 * arrays->triangle_count);
        end = range.end;
    }
}

static void check_player(struct scree_player *player, bool thoroughly) {
    struct scree_arrays arrays;
    const struct scree_stream_header *header = scree_player_header(player);
    uint32_t ready = scree_player_rungs_ready(player);
    if (ready == 0) return;
    DEMAND(header != NULL && ready <= header->rung_count);
    scree_player_look(player, &arrays);
    DEMAND(arrays.vertex_count >= header->rungs[0].vertex_count);
    DEMAND(arrays.vertex_count <= header->rungs[ready - 1].vertex_count);
    DEMAND(arrays.triangle_count <= header->rungs[ready - 1].triangle_count);
    DEMAND(arrays.vertex_count == header->rungs[0].vertex_count + arrays.splits);
    check_dirty(player, &arrays);
    if (!thoroughly) return;
    check_vertices(header, &arrays);
    check_triangles(header, &arrays);
    check_borders(player, &arrays);
}

/* One seek of any kind. */
static void seek(struct scree_player *player, uint32_t number) {
    const struct scree_stream_header *header = scree_player_header(player);
    uint32_t ready = scree_player_rungs_ready(player), kind = number % 5;
    if (ready == 0) return;
    uint32_t rung = number / 5 % (ready + 1);
    const struct scree_rung *last = &header->rungs[rung < ready ? rung : ready - 1];
    enum scree_status status;
    if (kind == 0)
        status = scree_player_seek_rung(player, rung);
    else if (kind == 1)
        status = scree_player_seek_level(player, (double)(number % 1000) / 100);
    else if (kind == 2)
        status = scree_player_seek_splits(player, number / 5 % (last->vertex_count + 1));
    else if (kind == 3)
        status = scree_player_seek_svo(player, last->svo_m);
    else
        status = scree_player_seek_error(player, last->max_error_m);
    DEMAND(status >= SCREE_OK);
    if (kind == 0 && rung < ready) {
        struct scree_arrays arrays;
        scree_player_look(player, &arrays);
        DEMAND(arrays.vertex_count == last->vertex_count && arrays.triangle_count == last->triangle_count);
    }
}

static void play(const uint8_t *data, size_t size_bytes, uint32_t seed) {
    struct scree_player *player;
    struct scree_error error = {0};
    const struct scree_player_options options = {.memory_limit_bytes = MEMORY_LIMIT_BYTES,
                                                 .without_normals = (seed & 1) != 0,
                                                 .without_positions = (seed & 6) == 6};
    DEMAND(scree_player_new(&options, &player, &error) == SCREE_OK);
    enum scree_status status = SCREE_MORE;
    uint32_t longest_bytes = 1u << (5 + next_number(&seed) % 9);
    for (size_t at_bytes = 0; at_bytes < size_bytes && status >= SCREE_OK;) {
        size_t piece_bytes = next_number(&seed) % longest_bytes + 1;
        if (piece_bytes > size_bytes - at_bytes) piece_bytes = size_bytes - at_bytes;
        uint32_t before = scree_player_rungs_ready(player);
        status = scree_player_push(player, data + at_bytes, piece_bytes, &error);
        DEMAND(error.status == (status < SCREE_OK ? status : SCREE_OK) && (status >= SCREE_OK || error.text[0] != 0));
        at_bytes += piece_bytes;
        if (scree_player_rungs_ready(player) == before) continue;
        check_player(player, true);
        seek(player, next_number(&seed));
        check_player(player, false);
    }
    if (status < SCREE_OK) DEMAND(scree_player_push(player, data, size_bytes, NULL) == status);
    for (int i = 0; i < 3; i++) {
        seek(player, next_number(&seed));
        check_player(player, i == 2);
    }
    scree_player_free(player);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes) {
    if (size_bytes > 1 << 20) return 0;
    uint32_t seed = (uint32_t)crc32(0, data, (uInt)size_bytes) | 1;
    play(data, size_bytes, seed);
    uint8_t *repaired = malloc(size_bytes + 1);
    if (repaired == NULL) return 0;
    if (size_bytes > 0) memcpy(repaired, data, size_bytes);
    forge_sizes(repaired, size_bytes);
    forge_checksums(repaired, size_bytes);
    if (size_bytes > 0 && memcmp(repaired, data, size_bytes) != 0) play(repaired, size_bytes, seed);
    free(repaired);
    return 0;
}
