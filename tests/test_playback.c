/* Playback on tiles made by chance: any seeks, what they write and tell, positions, morphing, borders. */
#include "stream/playback.h"
#include "stream/player_arrays.h"
#include "stream/player_border.h"
#include "tests/mesh_maker.h"
#include "tests/progressive_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 96, ROWS = 64, BASE_SPLITS = 30, SPLITS = 900, BLOCKS = 4 };

/* A tile and everything that plays it, its blocks taken in one after the other. */
struct playing {
    struct scree_memory memory;
    struct progressive whole, decoded; /* decoded: its arrays, of which less and less is hidden */
    struct scree_stream_header header;
    uint32_t block_splits[BLOCKS + 1]; /* at the end of the base and of each increment */
    struct playback playback;
    struct player_border border;
    struct player_arrays arrays;
};

static void reveal(struct playing *playing, uint32_t block) {
    struct progressive *decoded = &playing->decoded;
    struct scree_error error = {0};
    decoded->split_count = playing->block_splits[block];
    decoded->vertex_count = decoded->base_vertices + decoded->split_count;
    decoded->triangle_count =
        decoded->split_count == 0 ? decoded->base_triangles : decoded->splits[decoded->split_count - 1].triangle_end;
    decoded->fixup_count = decoded->split_count == 0 ? 0 : decoded->splits[decoded->split_count - 1].fixup_end;
    CU_ASSERT_TRUE_FATAL(playback_extend(&playing->playback, &error));
    CU_ASSERT_TRUE_FATAL(player_border_extend(&playing->border, &error));
    CU_ASSERT_TRUE_FATAL(player_arrays_extend(&playing->arrays, &playing->border, block, &error));
}

static void start(struct playing *playing, uint64_t seed, bool half_edges) {
    memset(playing, 0, sizeof *playing);
    const struct progressive_wish wish = {seed, COLUMNS, ROWS, BASE_SPLITS, SPLITS, half_edges};
    make_progressive(&playing->memory, &wish, &playing->whole);
    playing->decoded = playing->whole;
    for (uint32_t i = 0; i <= BLOCKS; i++) playing->block_splits[i] = playing->whole.split_count * i / BLOCKS;
    playing->header = (struct scree_stream_header){.profile = SCREE_LOCAL,
                                                   .columns = COLUMNS,
                                                   .rows = ROWS,
                                                   .west = 500000,
                                                   .south = 4000000,
                                                   .spacing_x = 10,
                                                   .spacing_y = 10,
                                                   .metres_x = 10,
                                                   .metres_y = 10,
                                                   .height_exponent = -2};
    playing->playback = (struct playback){.memory = &playing->memory, .progressive = &playing->decoded};
    playing->border = (struct player_border){
        .memory = &playing->memory, .progressive = &playing->decoded, .columns = COLUMNS, .rows = ROWS};
    playing->arrays = (struct player_arrays){.memory = &playing->memory,
                                             .header = &playing->header,
                                             .progressive = &playing->decoded,
                                             .with_positions = true,
                                             .with_normals = true,
                                             .with_origins = true};
    reveal(playing, 0);
}

static void start_whole(struct playing *playing, uint64_t seed, bool half_edges) {
    start(playing, seed, half_edges);
    for (uint32_t i = 1; i <= BLOCKS; i++) reveal(playing, i);
}

static void stop(struct playing *playing) {
    player_arrays_release(&playing->arrays);
    player_border_release(&playing->border);
    playback_release(&playing->playback);
    release_progressive(&playing->memory, &playing->whole);
    CU_ASSERT_EQUAL(playing->memory.used_bytes, 0);
}

static void seek(struct playing *playing, uint32_t splits) {
    playback_seek(&playing->playback, splits);
    playing->border.current = false;
    playing->arrays.current = false;
}

static uint32_t any_splits(const struct playing *playing, uint64_t *chance) {
    return (uint32_t)any_number(chance, (int32_t)playing->playback.splits_ready + 1);
}

/* The corners at a number of splits, as the definition of a progressive tile has them. */
static uint32_t *corners_by_definition(struct playing *playing, uint32_t splits) {
    const struct progressive *whole = &playing->whole;
    uint32_t slot_count = 3 * whole->triangle_count, fixups = splits == 0 ? 0 : whole->splits[splits - 1].fixup_end;
    uint32_t *corners = scree_allocate(&playing->memory, slot_count, sizeof *corners, "corners", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(corners);
    memcpy(corners, whole->corners, slot_count * sizeof *corners);
    for (uint32_t i = 0; i < fixups; i++) {
        CU_ASSERT_EQUAL(corners[whole->fixups[i].slot], whole->fixups[i].coarse);
        corners[whole->fixups[i].slot] = whole->fixups[i].fine;
    }
    return corners;
}

static void check_corners(struct playing *playing) {
    uint32_t *expected = corners_by_definition(playing, playing->playback.splits);
    size_t size_bytes = 3 * sizeof *expected * (size_t)playback_triangles(&playing->playback);
    CU_ASSERT_EQUAL(memcmp(expected, playing->playback.corners, size_bytes), 0);
    scree_release(&playing->memory, expected);
}

static void every_number_of_splits_is_a_mesh(void) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct playing playing;
        start_whole(&playing, seed, seed % 2 == 0);
        CU_ASSERT_TRUE(playing.whole.split_count > SPLITS / 2);
        for (uint32_t i = 0; i <= 2 * playing.whole.split_count; i++) {
            uint32_t splits = i <= playing.whole.split_count ? i : 2 * playing.whole.split_count - i; /* up and down */
            seek(&playing, splits);
            const char *fault =
                triangles_fault(&playing.memory, playing.whole.vertices, playback_vertices(&playing.playback),
                                playing.playback.corners, playback_triangles(&playing.playback), COLUMNS, ROWS);
            CU_ASSERT_PTR_NULL(fault);
        }
        check_corners(&playing);
        CU_ASSERT_EQUAL(playing.playback.splits, 0);
        stop(&playing);
    }
}

static void any_way_leads_to_the_same(void) {
    struct playing playing;
    uint64_t chance = 11;
    start_whole(&playing, 5, false);
    uint64_t requests = playing.memory.requests;
    for (int i = 0; i < 400; i++) {
        seek(&playing, any_splits(&playing, &chance));
        player_border_update(&playing.border, &playing.playback);
        player_arrays_update(&playing.arrays, &playing.playback);
        CU_ASSERT_EQUAL(playing.memory.requests, requests); /* nothing is allocated */
        check_corners(&playing);
        requests = playing.memory.requests;
    }
    stop(&playing);
}

static void blocks_may_come_between_seeks(void) {
    struct playing playing;
    uint64_t chance = 12;
    start(&playing, 6, false);
    for (uint32_t block = 1; block <= BLOCKS; block++) {
        for (int i = 0; i < 20; i++) {
            seek(&playing, any_splits(&playing, &chance));
            check_corners(&playing);
        }
        reveal(&playing, block);
        check_corners(&playing);
    }
    seek(&playing, playing.whole.split_count);
    check_corners(&playing);
    stop(&playing);
}

/* Of the fix-ups between two scales, those that a seek writes: never two of one slot, and always one. */
static void no_slot_is_written_twice(void) {
    struct playing playing;
    uint64_t chance = 13;
    start_whole(&playing, 7, false);
    uint32_t slot_count = 3 * playing.whole.triangle_count, merged = 0;
    unsigned char *up = scree_allocate(&playing.memory, slot_count, 3, "counts", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(up);
    unsigned char *down = up + slot_count, *there = down + slot_count;
    for (int n = 0; n < 200; n++) {
        uint32_t a = (uint32_t)any_number(&chance, (int32_t)playing.whole.fixup_count + 1);
        uint32_t b = (uint32_t)any_number(&chance, (int32_t)playing.whole.fixup_count + 1);
        uint32_t first = a < b ? a : b, end = a < b ? b : a;
        memset(up, 0, 3 * (size_t)slot_count);
        for (uint32_t i = first; i < end; i++) {
            uint32_t slot = playing.whole.fixups[i].slot;
            merged += there[slot];
            there[slot] = 1;
            up[slot] = (unsigned char)(up[slot] + playback_is_last(&playing.playback, i, end));
            down[slot] = (unsigned char)(down[slot] + playback_is_first(&playing.playback, i, first));
        }
        CU_ASSERT_EQUAL(memcmp(up, there, slot_count), 0);
        CU_ASSERT_EQUAL(memcmp(down, there, slot_count), 0);
    }
    CU_ASSERT_TRUE(merged > 1000); /* there was something to merge */
    scree_release(&playing.memory, up);
    stop(&playing);
}

/* A viewer's buffers, which get nothing but what is told to be dirty. */
static void what_is_told_is_enough(void) {
    struct playing playing;
    uint64_t chance = 14;
    start(&playing, 8, false);
    uint32_t slot_count = 3 * playing.whole.triangle_count, block = 0, sent = 0, shown = 0;
    uint32_t *buffer = scree_allocate(&playing.memory, slot_count, sizeof *buffer, "a viewer's buffer", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(buffer);
    uint32_t vertices = 0;
    for (int n = 0; n < 600; n++) {
        uint32_t splits = any_splits(&playing, &chance);
        int32_t step = any_number(&chance, 9) - 4, near = (int32_t)playing.playback.splits + step;
        if (n % 3 != 0 && near >= 0 && near <= (int32_t)playing.playback.splits_ready) splits = (uint32_t)near;
        seek(&playing, splits);
        if (n % 50 == 0 && block < BLOCKS) reveal(&playing, ++block);
        if (n % 5 == 4) continue; /* not every seek is looked at */
        if (n == 300) {
            memset(buffer, 0, slot_count * sizeof *buffer);
            playback_dirty_all(&playing.playback);
            vertices = 0;
        }
        struct scree_range range = playback_dirty_vertices(&playing.playback), slots;
        if (range.first < range.end) {
            CU_ASSERT_EQUAL(range.first, vertices);
            vertices = range.end;
        }
        CU_ASSERT_TRUE(vertices >= playback_vertices(&playing.playback));
        uint32_t before = 0;
        while (playback_dirty_slots(&playing.playback, &slots)) {
            CU_ASSERT_TRUE(slots.first >= before && slots.end <= 3 * playback_triangles(&playing.playback));
            memcpy(&buffer[slots.first], &playing.playback.corners[slots.first],
                   (slots.end - slots.first) * sizeof *buffer);
            before = slots.end;
            sent += slots.end - slots.first;
        }
        shown += 3 * playback_triangles(&playing.playback);
        CU_ASSERT_EQUAL(memcmp(buffer, playing.playback.corners,
                               3 * sizeof *buffer * (size_t)playback_triangles(&playing.playback)),
                        0);
        CU_ASSERT_FALSE(playback_dirty_slots(&playing.playback, &slots));
    }
    CU_ASSERT_EQUAL(block, BLOCKS);
    CU_ASSERT_TRUE(sent < shown); /* small seeks send less than all */
    scree_release(&playing.memory, buffer);
    stop(&playing);
}

/* The vertex of the coarser mesh that a vertex comes out of, or UINT32_MAX where a new one of the border is on the way.
 */
static uint32_t ancestor(const struct playing *playing, uint32_t vertex, uint32_t first) {
    while (vertex >= first) {
        if (playing->border.on_sides[vertex] != 0) return UINT32_MAX;
        vertex = playing->whole.splits[vertex - playing->whole.base_vertices].parent;
    }
    return vertex;
}

static bool has_triangle(const uint32_t *corners, uint32_t triangle_count, const uint32_t triangle[3]) {
    for (uint32_t slot = 0; slot < 3 * triangle_count; slot += 3)
        for (int turn = 0; turn < 3; turn++)
            if (corners[slot] == triangle[turn] && corners[slot + 1] == triangle[(turn + 1) % 3] &&
                corners[slot + 2] == triangle[(turn + 2) % 3])
                return true;
    return false;
}

/* With every new vertex at its origin, triangles are those of the rung before, or have collapsed. */
static void morphs_start_from_the_coarser_mesh(void) {
    struct playing playing;
    start_whole(&playing, 9, true);
    uint32_t looked_at = 0;
    for (uint32_t block = 1; block <= BLOCKS; block++) {
        uint32_t coarse_splits = playing.block_splits[block - 1], first = playing.whole.base_vertices + coarse_splits;
        uint32_t *coarse = corners_by_definition(&playing, coarse_splits);
        uint32_t coarse_triangles =
            coarse_splits == 0 ? playing.whole.base_triangles : playing.whole.splits[coarse_splits - 1].triangle_end;
        seek(&playing, playing.block_splits[block]);
        const uint32_t *corners = playing.playback.corners;
        for (uint32_t slot = 0; slot < 3 * playback_triangles(&playing.playback); slot += 3) {
            uint32_t from[3];
            for (int i = 0; i < 3; i++) from[i] = ancestor(&playing, corners[slot + (unsigned)i], first);
            if (from[0] == UINT32_MAX || from[1] == UINT32_MAX || from[2] == UINT32_MAX) continue;
            if (from[0] == from[1] || from[1] == from[2] || from[2] == from[0]) continue;
            CU_ASSERT_TRUE(has_triangle(coarse, coarse_triangles, from));
            looked_at++;
        }
        for (uint32_t i = first; i < playback_vertices(&playing.playback); i++) {
            uint32_t from = ancestor(&playing, i, first);
            CU_ASSERT_EQUAL(playing.arrays.increments[i], block);
            if (from != UINT32_MAX)
                CU_ASSERT_EQUAL(memcmp(&playing.arrays.origins[3 * i], &playing.arrays.positions[3 * from], 12), 0);
        }
        scree_release(&playing.memory, coarse);
    }
    CU_ASSERT_TRUE(looked_at > 500);
    stop(&playing);
}

/* New vertices of the border start on the straight edges of the rung before, at their own place. */
static void borders_morph_on_their_edges(void) {
    struct playing playing;
    start_whole(&playing, 10, false);
    uint32_t looked_at = 0;
    for (uint32_t block = 1; block <= BLOCKS; block++) {
        uint32_t first = playing.whole.base_vertices + playing.block_splits[block - 1];
        seek(&playing, playing.block_splits[block - 1]);
        player_border_update(&playing.border, &playing.playback);
        for (uint32_t i = first; i < playing.whole.base_vertices + playing.block_splits[block]; i++) {
            if ((playing.border.on_sides[i] & 1 << SCREE_SOUTH) == 0) continue;
            const struct scree_vertex *at = &playing.whole.vertices[i], *west = at, *east = at;
            const struct player_side *side = &playing.border.sides[SCREE_SOUTH];
            for (uint32_t k = 0; k + 1 < side->present; k++) {
                west = &playing.whole.vertices[side->vertices[k]];
                east = &playing.whole.vertices[side->vertices[k + 1]];
                if (west->x < at->x && at->x < east->x) break;
            }
            double share = (at->x - west->x) / (double)(east->x - west->x);
            double height_m = 0.25 * (west->height + share * (east->height - west->height));
            const float *origin = &playing.arrays.origins[3 * i], *position = &playing.arrays.positions[3 * i];
            CU_ASSERT_DOUBLE_EQUAL(origin[0], position[0], 1e-3);
            CU_ASSERT_DOUBLE_EQUAL(origin[1], position[1], 1e-3);
            CU_ASSERT_DOUBLE_EQUAL(origin[2], height_m, 1e-3);
            looked_at++;
        }
    }
    CU_ASSERT_TRUE(looked_at > 5);
    stop(&playing);
}

static void borders_are_whole_and_known(void) {
    struct playing playing;
    uint64_t chance = 15;
    start_whole(&playing, 11, false);
    for (int n = 0; n < 100; n++) {
        seek(&playing, any_splits(&playing, &chance));
        player_border_update(&playing.border, &playing.playback);
        uint32_t expected[SCREE_SIDES] = {0};
        for (uint32_t i = 0; i < playback_vertices(&playing.playback); i++) {
            const struct scree_vertex *vertex = &playing.whole.vertices[i];
            expected[SCREE_SOUTH] += vertex->y == 0;
            expected[SCREE_EAST] += vertex->x == COLUMNS;
            expected[SCREE_NORTH] += vertex->y == ROWS;
            expected[SCREE_WEST] += vertex->x == 0;
        }
        for (unsigned side = 0; side < SCREE_SIDES; side++) {
            const struct player_side *list = &playing.border.sides[side];
            CU_ASSERT_EQUAL_FATAL(list->present, expected[side]);
            bool turned = side == SCREE_NORTH || side == SCREE_WEST; /* triangles walk these sides downwards */
            for (uint32_t i = 0; i + 1 < list->present; i++) {
                const struct scree_vertex *a = &playing.whole.vertices[list->vertices[i]];
                const struct scree_vertex *b = &playing.whole.vertices[list->vertices[i + 1]];
                CU_ASSERT_TRUE(side == SCREE_SOUTH || side == SCREE_NORTH ? a->x < b->x : a->y < b->y);
                uint32_t apex = list->apexes[i], base = apex - apex % 3;
                CU_ASSERT_TRUE_FATAL(apex < 3 * playback_triangles(&playing.playback));
                CU_ASSERT_EQUAL(playing.playback.corners[base + (apex + 1) % 3], list->vertices[turned ? i + 1 : i]);
                CU_ASSERT_EQUAL(playing.playback.corners[base + (apex + 2) % 3], list->vertices[turned ? i : i + 1]);
            }
        }
    }
    stop(&playing);
}

static void normals_stand_on_the_mesh(void) {
    struct playing playing;
    start_whole(&playing, 12, false);
    for (uint32_t i = 0; i < playing.whole.vertex_count; i++) /* a plane that rises by 1 in 2 to the east */
        playing.whole.vertices[i].height = playing.whole.vertices[i].x * 20;
    playing.arrays.vertices_known = playing.border.vertices_known = 0;
    for (unsigned side = 0; side < SCREE_SIDES; side++) playing.border.sides[side].count = 0;
    struct scree_error error = {0};
    CU_ASSERT_TRUE(player_border_extend(&playing.border, &error));
    CU_ASSERT_TRUE(player_arrays_extend(&playing.arrays, &playing.border, 0, &error));
    seek(&playing, playing.whole.split_count / 2);
    player_arrays_update(&playing.arrays, &playing.playback);
    for (uint32_t i = 0; i < playback_vertices(&playing.playback); i++) {
        CU_ASSERT_DOUBLE_EQUAL(playing.arrays.normals[3 * i], -1 / sqrt(5), 1e-5);
        CU_ASSERT_DOUBLE_EQUAL(playing.arrays.normals[3 * i + 1], 0, 1e-5);
        CU_ASSERT_DOUBLE_EQUAL(playing.arrays.normals[3 * i + 2], 2 / sqrt(5), 1e-5);
    }
    stop(&playing);
}

static void failed_growth_leaves_what_was(void) {
    for (uint64_t n = 1;; n++) {
        struct playing playing;
        start(&playing, 13, false);
        playing.decoded.split_count = playing.block_splits[1];
        playing.decoded.vertex_count = playing.decoded.base_vertices + playing.decoded.split_count;
        playing.decoded.triangle_count = playing.decoded.splits[playing.decoded.split_count - 1].triangle_end;
        playing.decoded.fixup_count = playing.decoded.splits[playing.decoded.split_count - 1].fixup_end;
        playing.memory.fail_request = playing.memory.requests + n;
        struct scree_error error = {0};
        bool grown = playback_extend(&playing.playback, &error) && player_border_extend(&playing.border, &error) &&
                     player_arrays_extend(&playing.arrays, &playing.border, 1, &error);
        CU_ASSERT_EQUAL(error.status, grown ? SCREE_OK : SCREE_E_MEMORY);
        playing.memory.fail_request = 0;
        seek(&playing, 0);
        player_border_update(&playing.border, &playing.playback);
        player_arrays_update(&playing.arrays, &playing.playback);
        check_corners(&playing);
        stop(&playing);
        if (grown) break;
        CU_ASSERT_TRUE_FATAL(n < 100);
    }
}

static double distance(const double a[3], const double b[3]) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static void to_world(const struct scree_frame *frame, const double position_m[3], double world[3]) {
    for (int i = 0; i < 3; i++) {
        world[i] = frame->origin[i];
        for (int axis = 0; axis < 3; axis++) world[i] += position_m[axis] * frame->axes[axis][i];
    }
}

/* WGS84 by the textbook. */
static void by_the_book(double lon_deg, double lat_deg, double height_m, double world[3]) {
    const double degree = acos(-1) / 180, flattening = 1 / 298.257223563, e2 = flattening * (2 - flattening);
    double lon = lon_deg * degree, lat = lat_deg * degree, n = 6378137 / sqrt(1 - e2 * sin(lat) * sin(lat));
    world[0] = (n + height_m) * cos(lat) * cos(lon);
    world[1] = (n + height_m) * cos(lat) * sin(lon);
    world[2] = (n * (1 - e2) + height_m) * sin(lat);
}

static void tiles_lie_on_the_globe(void) {
    static const double wests[] = {-180, 0, 8.4375, -118.125}, souths[] = {-90, -90, 46.40625, 33.75};
    static const double sizes[] = {180, 180, 0.17578125, 5.625};
    for (int tile = 0; tile < 4; tile++) {
        struct scree_stream_header header = {.profile = SCREE_GEODETIC,
                                             .columns = 256,
                                             .rows = 256,
                                             .west = wests[tile],
                                             .south = souths[tile],
                                             .spacing_x = sizes[tile] / 256,
                                             .spacing_y = sizes[tile] / 256};
        struct scree_frame frame;
        scree_stream_frame(&header, &frame);
        for (int n = 0; n < 81; n++) {
            double x = n % 9 * 32, y = n / 9 * 32.0, height_m = 100.0 * n, position_m[3], world[3], expected[3];
            scree_stream_position(&header, &frame, x, y, height_m, position_m);
            to_world(&frame, position_m, world);
            by_the_book(header.west + x * header.spacing_x, header.south + y * header.spacing_y, height_m, expected);
            CU_ASSERT_DOUBLE_EQUAL(distance(world, expected), 0, 1e-7);
        }
        double middle[3];
        scree_stream_position(&header, &frame, 128, 128, 12, middle);
        CU_ASSERT_DOUBLE_EQUAL(distance(middle, (double[3]){0, 0, 12}), 0, 1e-7);
    }
}

static void local_tiles_lie_in_their_crs(void) {
    const struct scree_stream_header header = {.profile = SCREE_LOCAL,
                                               .columns = 100,
                                               .rows = 50,
                                               .west = 1000,
                                               .south = 2000,
                                               .spacing_x = 100,
                                               .spacing_y = 200, /* feet */
                                               .metres_x = 30.48,
                                               .metres_y = 60.96};
    struct scree_frame frame;
    double position_m[3], world[3];
    scree_stream_frame(&header, &frame);
    scree_stream_position(&header, &frame, 100, 0, 7, position_m);
    CU_ASSERT_DOUBLE_EQUAL(distance(position_m, (double[3]){1524, -1524, 7}), 0, 1e-9);
    to_world(&frame, position_m, world);
    CU_ASSERT_DOUBLE_EQUAL(distance(world, (double[3]){11000, 2000, 7}), 0, 1e-9);
}

static void headers_cannot_break_a_frame(void) {
    struct scree_stream_header header = {.profile = SCREE_GEODETIC,
                                         .columns = SCREE_MAX_TILE_STEPS,
                                         .rows = SCREE_MAX_TILE_STEPS,
                                         .west = -1e300,
                                         .south = 1e308,
                                         .spacing_x = 1e200,
                                         .spacing_y = 1e290};
    struct scree_frame frame;
    double position_m[3];
    scree_stream_frame(&header, &frame);
    scree_stream_position(&header, &frame, NAN, INFINITY, 1e300, position_m);
    for (int i = 0; i < 3; i++) CU_ASSERT_TRUE(isfinite(frame.origin[i]));
}

int suite_playback(void) {
    CU_pSuite suite = CU_add_suite("playback", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, every_number_of_splits_is_a_mesh);
    CU_ADD_TEST(suite, any_way_leads_to_the_same);
    CU_ADD_TEST(suite, blocks_may_come_between_seeks);
    CU_ADD_TEST(suite, no_slot_is_written_twice);
    CU_ADD_TEST(suite, what_is_told_is_enough);
    CU_ADD_TEST(suite, morphs_start_from_the_coarser_mesh);
    CU_ADD_TEST(suite, borders_morph_on_their_edges);
    CU_ADD_TEST(suite, borders_are_whole_and_known);
    CU_ADD_TEST(suite, normals_stand_on_the_mesh);
    CU_ADD_TEST(suite, failed_growth_leaves_what_was);
    CU_ADD_TEST(suite, tiles_lie_on_the_globe);
    CU_ADD_TEST(suite, local_tiles_lie_in_their_crs);
    CU_ADD_TEST(suite, headers_cannot_break_a_frame);
    return 0;
}
