/* A player: pushed bytes become blocks, blocks splits, and splits what a viewer draws (scree/player.h). */
#include "stream/player.h"

#include "stream/decode.h"
#include "stream/player_arrays.h"
#include "stream/stream_header.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

#define FIRST_BYTES 4096 /* room for the header or a block, before more is asked for */

struct scree_player {
    struct scree_memory memory; /* of all below, and of this */
    struct scree_player_options options;
    struct scree_error failure; /* of a push, once and for all */
    unsigned char *bytes;       /* of the header or of the block that is arriving: */
    size_t size_bytes, capacity_bytes;
    uint64_t taken_bytes; /* of the stream, those included */
    bool has_header;
    struct scree_stream_header header;
    struct stream_decoder *decoder;
    uint32_t rungs_ready;
    double level;
    struct playback playback;
    struct player_border border;
    struct player_arrays arrays;
};

enum scree_status player_new_in(const struct scree_memory *memory, const struct scree_player_options *options,
                                struct scree_player **player, struct scree_error *error) {
    struct scree_memory budget = *memory;
    struct scree_error failure = {0};
    *player = NULL;
    struct scree_player *made = scree_allocate(&budget, 1, sizeof *made, "a player", &failure);
    if (made == NULL) return scree_fail(error, failure.status, "%s", failure.text);
    made->memory = budget;
    if (options != NULL) made->options = *options;
    bool with_positions = !made->options.without_positions;
    made->playback.memory = &made->memory;
    made->border.memory = &made->memory;
    made->arrays = (struct player_arrays){.memory = &made->memory,
                                          .header = &made->header,
                                          .with_positions = with_positions,
                                          .with_normals = with_positions && !made->options.without_normals,
                                          .with_origins = with_positions && !made->options.without_origins};
    *player = made;
    return SCREE_OK;
}

enum scree_status scree_player_new(const struct scree_player_options *options, struct scree_player **player,
                                   struct scree_error *error) {
    size_t limit_bytes = options == NULL ? 0 : options->memory_limit_bytes;
    struct scree_memory memory = {.limit_bytes = limit_bytes == 0 ? SCREE_PLAYER_MEMORY_BYTES : limit_bytes};
    return player_new_in(&memory, options, player, error);
}

void scree_player_free(struct scree_player *player) {
    if (player == NULL) return;
    player_arrays_release(&player->arrays);
    player_border_release(&player->border);
    playback_release(&player->playback);
    stream_decoder_free(player->decoder);
    scree_release(&player->memory, player->bytes);
    struct scree_memory memory = player->memory; /* the player's own block goes back to what it holds itself */
    scree_release(&memory, player);
}

const struct scree_memory *player_memory(const struct scree_player *player) {
    return &player->memory;
}

const struct playback *player_playback(const struct scree_player *player) {
    return &player->playback;
}

/* Takes bytes until `wanted_bytes` of the present piece are there; returns how many it took. Room is made as bytes
 * arrive, never for what is only promised, and by the same steps however the bytes are cut. */
static size_t collect(struct scree_player *player, const unsigned char *bytes, size_t size_bytes, size_t wanted_bytes) {
    size_t taken_bytes = wanted_bytes - player->size_bytes;
    if (taken_bytes > size_bytes) taken_bytes = size_bytes;
    size_t held_bytes = player->size_bytes + taken_bytes, capacity_bytes = player->capacity_bytes;
    while (capacity_bytes < held_bytes) capacity_bytes = capacity_bytes == 0 ? FIRST_BYTES : 2 * capacity_bytes;
    if (capacity_bytes != player->capacity_bytes) {
        unsigned char *grown = scree_reallocate(&player->memory, player->bytes, capacity_bytes, 1,
                                                "a block of the stream", &player->failure);
        if (grown == NULL) return 0;
        player->bytes = grown;
        player->capacity_bytes = capacity_bytes;
    }
    if (taken_bytes > 0) memcpy(player->bytes + player->size_bytes, bytes, taken_bytes);
    player->size_bytes = held_bytes;
    player->taken_bytes += taken_bytes;
    return taken_bytes;
}

static void start_decoding(struct scree_player *player) {
    player->has_header = true;
    enum scree_status status = stream_decoder_new(&player->memory, &player->header, &player->decoder, &player->failure);
    if (status != SCREE_OK) {
        scree_fail(&player->failure, status, "the stream's decoder cannot be made");
        return;
    }
    const struct progressive *progressive = stream_decoded(player->decoder);
    player->playback.progressive = progressive;
    player->border.progressive = progressive;
    player->border.columns = player->header.columns;
    player->border.rows = player->header.rows;
    player->arrays.progressive = progressive;
}

/* Looks for the header in the bytes that are there; those behind it are given back. Returns how many of the new bytes
 * are used up. */
static size_t push_header(struct scree_player *player, const unsigned char *bytes, size_t size_bytes) {
    size_t before_bytes = player->size_bytes, wanted_bytes = player->capacity_bytes;
    if (wanted_bytes == before_bytes) wanted_bytes = before_bytes == 0 ? FIRST_BYTES : 2 * before_bytes;
    size_t taken_bytes = collect(player, bytes, size_bytes, wanted_bytes);
    if (player->failure.status < 0) return 0;
    if (stream_header_read(player->bytes, player->size_bytes, &player->header, &player->failure) == SCREE_OK) {
        taken_bytes = player->header.size_bytes - before_bytes;
        player->taken_bytes = player->header.size_bytes;
        player->size_bytes = 0;
        start_decoding(player);
    }
    return taken_bytes;
}

static void finish_block(struct scree_player *player) {
    uint32_t rung = player->rungs_ready;
    const struct scree_rung *block = &player->header.rungs[rung];
    struct scree_error *failure = &player->failure;
    if (crc32(0, player->bytes, block->size_bytes) != block->checksum) {
        scree_fail_at(failure, SCREE_E_CORRUPT, (int64_t)block->offset_bytes,
                      "the stream is damaged: the checksum of block %u is not the one that its header states",
                      (unsigned)rung);
        return;
    }
    struct scree_error decoding = {.offset_bytes = SCREE_NO_OFFSET};
    enum scree_status status = stream_decode_block(player->decoder, player->bytes, block->size_bytes, &decoding);
    if (status != SCREE_OK) {
        scree_fail_at(failure, status, (int64_t)block->offset_bytes, "block %u of the stream: %s", (unsigned)rung,
                      decoding.text);
        return;
    }
    if (!playback_extend(&player->playback, failure) || !player_border_extend(&player->border, failure) ||
        !player_arrays_extend(&player->arrays, &player->border, rung, failure))
        return;
    player->size_bytes = 0;
    player->rungs_ready = rung + 1;
    if (rung == 0) scree_player_seek_rung(player, 0);
}

static bool is_complete(const struct scree_player *player) {
    return player->has_header && player->rungs_ready == player->header.rung_count;
}

enum scree_status scree_player_push(struct scree_player *player, const void *bytes, size_t size_bytes,
                                    struct scree_error *error) {
    const unsigned char *at = bytes == NULL ? (const unsigned char *)"" : bytes;
    struct scree_error *failure = &player->failure;
    while (failure->status >= 0 && !player->has_header && size_bytes > 0) {
        size_t used_bytes = push_header(player, at, size_bytes);
        at += used_bytes;
        size_bytes -= used_bytes;
    }
    while (failure->status >= 0 && player->has_header && !is_complete(player)) {
        size_t wanted_bytes = player->header.rungs[player->rungs_ready].size_bytes;
        size_t used_bytes = collect(player, at, size_bytes, wanted_bytes);
        at += used_bytes;
        size_bytes -= used_bytes;
        if (failure->status < 0 || player->size_bytes < wanted_bytes) break;
        finish_block(player);
    }
    if (failure->status >= 0 && is_complete(player) && size_bytes > 0)
        scree_fail_at(failure, SCREE_E_CORRUPT, (int64_t)player->taken_bytes,
                      "bytes follow the end of the stream, which its header sets at %llu",
                      (unsigned long long)player->taken_bytes);
    if (failure->status < 0) {
        if (error != NULL && error->status >= 0) *error = *failure;
        return failure->status;
    }
    return is_complete(player) ? SCREE_OK : SCREE_MORE;
}

const struct scree_stream_header *scree_player_header(const struct scree_player *player) {
    return player->has_header ? &player->header : NULL;
}

uint32_t scree_player_rungs_ready(const struct scree_player *player) {
    return player->rungs_ready;
}

/* To a number of vertices of a rung that is ready or of the increment that leads to it. */
static void seek_vertices(struct scree_player *player, uint32_t vertex_count, double level) {
    playback_seek(&player->playback, vertex_count - player->playback.progressive->base_vertices);
    player->level = level;
    player->border.current = false;
    player->arrays.current = false;
}

enum scree_status scree_player_seek_level(struct scree_player *player, double level) {
    if (isnan(level)) return SCREE_E_ARGUMENT;
    if (player->rungs_ready == 0) return SCREE_MORE;
    double finest = player->header.rung_count - 1.0, ready = player->rungs_ready - 1.0;
    level = level < 0 ? 0 : level > finest ? finest : level;
    double reached = level > ready ? ready : level;
    seek_vertices(player, player->header.rungs[(uint32_t)ceil(reached)].vertex_count, reached);
    return reached < level ? SCREE_MORE : SCREE_OK;
}

enum scree_status scree_player_seek_rung(struct scree_player *player, uint32_t rung) {
    return scree_player_seek_level(player, rung);
}

enum scree_status scree_player_seek_splits(struct scree_player *player, uint32_t splits) {
    if (player->rungs_ready == 0) return SCREE_MORE;
    const struct scree_rung *rungs = player->header.rungs;
    uint32_t base = rungs[0].vertex_count, finest = rungs[player->header.rung_count - 1].vertex_count - base;
    if (splits > finest) splits = finest;
    uint32_t rung = (uint32_t)player->level; /* small steps end near it */
    while (rung > 0 && rungs[rung - 1].vertex_count - base >= splits) rung--;
    while (rung + 1 < player->rungs_ready && rungs[rung].vertex_count - base < splits) rung++;
    uint32_t ready = rungs[rung].vertex_count - base, reached = splits < ready ? splits : ready;
    seek_vertices(player, base + reached, rung);
    return reached < splits ? SCREE_MORE : SCREE_OK;
}

enum scree_status scree_player_seek_svo(struct scree_player *player, double svo_m) {
    if (isnan(svo_m)) return SCREE_E_ARGUMENT;
    if (!player->has_header) return SCREE_MORE;
    return scree_player_seek_rung(player, scree_stream_rung_of_svo(&player->header, svo_m));
}

enum scree_status scree_player_seek_error(struct scree_player *player, double max_error_m) {
    if (isnan(max_error_m)) return SCREE_E_ARGUMENT;
    if (!player->has_header) return SCREE_MORE;
    return scree_player_seek_rung(player, scree_stream_rung_of_error(&player->header, max_error_m));
}

void scree_player_look(struct scree_player *player, struct scree_arrays *arrays) {
    *arrays = (struct scree_arrays){.vertex_count = 0};
    if (player->rungs_ready == 0) return;
    player_arrays_update(&player->arrays, &player->playback);
    arrays->vertex_count = playback_vertices(&player->playback);
    arrays->triangle_count = playback_triangles(&player->playback);
    arrays->splits = arrays->vertex_count - player->header.rungs[0].vertex_count;
    arrays->indices = player->playback.corners;
    arrays->vertices = player->playback.progressive->vertices;
    arrays->increments = player->arrays.increments;
    arrays->positions = player->arrays.positions;
    arrays->normals = player->arrays.normals;
    arrays->origins = player->arrays.origins;
    arrays->level = player->level;
}

struct scree_range scree_player_dirty_vertices(struct scree_player *player) {
    return playback_dirty_vertices(&player->playback);
}

bool scree_player_dirty_slots(struct scree_player *player, struct scree_range *slots) {
    return playback_dirty_slots(&player->playback, slots);
}

void scree_player_dirty_all(struct scree_player *player) {
    playback_dirty_all(&player->playback);
}

void scree_player_border(struct scree_player *player, enum scree_side side, struct scree_border *border) {
    *border = (struct scree_border){.vertex_count = 0};
    if (player->rungs_ready == 0 || (unsigned)side >= SCREE_SIDES) return;
    player_border_update(&player->border, &player->playback);
    const struct player_side *list = &player->border.sides[side];
    *border = (struct scree_border){list->present, list->vertices, list->apexes};
}
