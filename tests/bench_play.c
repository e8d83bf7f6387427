/* How fast a tile plays: splits a second on one core, up and down, merged and split by split, in small seeks, and what
 * looking costs. On a stream of fractal terrain as a viewer has it, and on tiles made by chance, whose fix-ups lie
 * anywhere: a harder case than terrain. */
#include "stream/player.h"
#include "stream/player_arrays.h"
#include "tests/mesh_maker.h"
#include "tests/progressive_maker.h"
#include "tests/stream_maker.h"

#include <stdio.h>
#include <time.h>

enum { REPEATS = 5 };

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* From one end to the other in seeks of `step` splits; seconds. */
static double walk_s(struct playback *playback, uint32_t to, uint32_t step) {
    double start_s = now_s();
    while (playback->splits != to) {
        uint32_t at = playback->splits, left = to > at ? to - at : at - to, by = step < left ? step : left;
        playback_seek(playback, to > at ? at + by : at - by);
    }
    return now_s() - start_s;
}

static void print_walks(struct playback *playback, const char *name, uint32_t step) {
    uint32_t splits = playback->splits_ready;
    double up_s = 1e9, down_s = 1e9;
    for (int i = 0; i < REPEATS; i++) {
        double s = walk_s(playback, splits, step);
        if (s < up_s) up_s = s;
        s = walk_s(playback, 0, step);
        if (s < down_s) down_s = s;
    }
    printf("  %-34s %7.1f up %7.1f down   million splits a second\n", name, 1e-6 * splits / up_s,
           1e-6 * splits / down_s);
}

static double seeks_to_and_fro(struct playback *playback, uint32_t span, uint64_t *chance) {
    uint32_t passed = 0;
    double start_s = now_s();
    while (passed < 4000000) {
        uint32_t to = (uint32_t)any_number(chance, (int32_t)playback->splits_ready + 1), at = playback->splits;
        if (to > at + span) to = at + span;
        if (at > to + span) to = at - span;
        playback_seek(playback, to);
        passed += to > at ? to - at : at - to;
    }
    return 1e-6 * passed / (now_s() - start_s);
}

static void play(uint32_t splits) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct progressive progressive;
    const struct progressive_wish wish = {1, 1 << 15, 1 << 15, 500, splits, false};
    make_progressive(&memory, &wish, &progressive);
    struct scree_stream_header header = {.profile = SCREE_LOCAL,
                                         .columns = wish.columns,
                                         .rows = wish.rows,
                                         .metres_x = 1,
                                         .metres_y = 1,
                                         .spacing_x = 1,
                                         .spacing_y = 1};
    struct playback playback = {.memory = &memory, .progressive = &progressive};
    struct player_border border = {
        .memory = &memory, .progressive = &progressive, .columns = wish.columns, .rows = wish.rows};
    struct player_arrays arrays = {.memory = &memory,
                                   .header = &header,
                                   .progressive = &progressive,
                                   .with_positions = true,
                                   .with_normals = true,
                                   .with_origins = true};
    if (!playback_extend(&playback, &error) || !player_border_extend(&border, &error) ||
        !player_arrays_extend(&arrays, &border, 0, &error)) {
        fprintf(stderr, "bench_play: %s\n", error.text);
        return;
    }
    printf("a tile made by chance: %u splits, %.2f fix-ups a split\n", progressive.split_count,
           (double)progressive.fixup_count / progressive.split_count);
    print_walks(&playback, "all at once (merged)", UINT32_MAX);
    print_walks(&playback, "1000 splits at a time", 1000);
    print_walks(&playback, "10 splits at a time", 10);
    print_walks(&playback, "split by split", 1);
    uint64_t chance = 1;
    printf("  %-34s %7.1f              million splits a second\n", "to and fro, at most 200 at a time",
           seeks_to_and_fro(&playback, 200, &chance));
    playback_seek(&playback, playback.splits_ready);
    double start_s = now_s();
    player_arrays_update(&arrays, &playback);
    double normals_s = now_s() - start_s;
    start_s = now_s();
    player_border_update(&border, &playback);
    printf("  looking at the finest mesh: normals %.2f ms, borders %.2f ms\n", 1e3 * normals_s,
           1e3 * (now_s() - start_s));
    player_arrays_release(&arrays);
    player_border_release(&border);
    playback_release(&playback);
    release_progressive(&memory, &progressive);
}

/* Seconds for the whole way from one end to the other, rung by rung. */
static double rungs_s(struct scree_player *player, bool up) {
    uint32_t rungs = scree_player_rungs_ready(player);
    double start_s = now_s();
    for (uint32_t i = 0; i < rungs; i++) scree_player_seek_rung(player, up ? i : rungs - 1 - i);
    return now_s() - start_s;
}

static void play_stream(struct scree_player *player, const unsigned char *bytes, size_t size_bytes) {
    struct scree_error error = {0};
    double start_s = now_s();
    if (scree_player_push(player, bytes, size_bytes, &error) != SCREE_OK) {
        fprintf(stderr, "bench_play: %s\n", error.text);
        return;
    }
    double push_s = now_s() - start_s;
    const struct playback *playback = player_playback(player);
    uint32_t vertices = playback->progressive->vertex_count, splits = playback->splits_ready;
    printf("a stream of fractal terrain: %u vertices, %.2f fix-ups a split\n", vertices,
           (double)playback->progressive->fixup_count / splits);
    printf("  %-34s %7.2f million vertices a second, from bytes to positions\n", "pushed", 1e-6 * vertices / push_s);
    double up_s = 1e9, down_s = 1e9;
    for (int i = 0; i < REPEATS; i++) {
        double s = rungs_s(player, true);
        if (s < up_s) up_s = s;
        s = rungs_s(player, false);
        if (s < down_s) down_s = s;
    }
    printf("  %-34s %7.1f up %7.1f down   million splits a second\n", "rung by rung (merged)", 1e-6 * splits / up_s,
           1e-6 * splits / down_s);
    start_s = now_s();
    for (uint32_t i = 0; i <= splits; i++) scree_player_seek_splits(player, i);
    up_s = now_s() - start_s;
    start_s = now_s();
    for (uint32_t i = splits + 1; i-- > 0;) scree_player_seek_splits(player, i);
    printf("  %-34s %7.1f up %7.1f down   million splits a second\n", "split by split", 1e-6 * splits / up_s,
           1e-6 * splits / (now_s() - start_s));
    printf("  memory: %.0f bytes a vertex\n", (double)player_memory(player)->peak_bytes / vertices);
}

static void play_terrain(void) {
    const struct stream_wish wish = {
        .seed = 1, .columns = 512, .rows = 512, .height_exponent = -2, .finest_m = 0.5, .base_vertices = 500};
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    unsigned char *bytes = NULL;
    size_t size_bytes;
    struct scree_player *player = NULL;
    if (stream_make(&memory, &wish, NULL, &bytes, &size_bytes, &error) == SCREE_OK &&
        scree_player_new(NULL, &player, &error) == SCREE_OK)
        play_stream(player, bytes, size_bytes);
    else
        fprintf(stderr, "bench_play: %s\n", error.text);
    scree_player_free(player);
    scree_release(&memory, bytes);
}

int main(void) {
    play_terrain();
    play(60000);   /* a tile */
    play(1000000); /* more than a cache holds */
    return 0;
}
