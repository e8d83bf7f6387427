/* Stitched borders: whatever the scales of the tiles of a cut, they make one surface. */
#include "tests/cut_maker.h"
#include "tests/seam_check.h"

#include <CUnit/CUnit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RANDOM_CUTS 1000 /* SCREE_TEST_CUTS asks for another number */
#define MOST_BESIDE (4 * CUT_MOST_TILES)

/* Large: the one that a test works on. */
static struct cut cut;

/* Room for any stitch of the tests. */
static uint32_t replaced[1 << 13], indices[3 << 13];
static struct scree_vertex further[1 << 13];
static struct scree_stitch_source sources[1 << 13];

static struct scree_stitch roomy(void) {
    return (struct scree_stitch){.capacity = {1 << 13, 1 << 13, 1 << 13},
                                 .replaced = replaced,
                                 .vertices = further,
                                 .sources = sources,
                                 .indices = indices};
}

static uint32_t find_neighbours(const struct cut *of, uint32_t tile, struct scree_stitch_neighbour *neighbours) {
    uint32_t found[CUT_MOST_TILES], count = 0;
    for (int side = 0; side < SCREE_SIDES; side++) {
        uint32_t beside = scree_cut_neighbours(of->ids, of->count, of->profile, &of->ids[tile], (enum scree_side)side,
                                               found, CUT_MOST_TILES);
        CU_ASSERT(beside <= CUT_MOST_TILES);
        for (uint32_t n = 0; n < beside; n++)
            neighbours[count++] = (struct scree_stitch_neighbour){&of->tiles[found[n]].view, (enum scree_side)side};
    }
    return count;
}

static void add_stitched(const struct cut *of, uint32_t tile, struct seam_check *check) {
    struct scree_stitch_neighbour neighbours[MOST_BESIDE];
    struct scree_error error = {0};
    uint32_t count = find_neighbours(of, tile, neighbours);
    const struct cut_tile *at = &of->tiles[tile];
    struct scree_stitch stitch = roomy();
    struct scree_stitch_size bound = scree_stitch_bound(&at->view, neighbours, count);
    CU_ASSERT_FATAL(bound.vertices <= stitch.capacity.vertices && bound.triangles <= stitch.capacity.triangles);
    stitch.capacity = bound;
    if (scree_stitch_borders(&at->view, neighbours, count, at->vertex_count, &stitch, &error) != SCREE_OK)
        CU_FAIL(error.text);
    for (uint32_t v = 0; v < stitch.count.vertices; v++) {
        const struct scree_stitch_tile *from = neighbours[sources[v].neighbour].tile;
        CU_ASSERT_EQUAL(from->vertices[sources[v].vertex].height, further[v].height);
        bool inner_x = further[v].x > 0 && further[v].x < at->header.columns;
        bool inner_y = further[v].y > 0 && further[v].y < at->header.rows;
        CU_ASSERT(inner_x != inner_y); /* on a side, between corners */
    }
    seam_add(check, &at->view, at->triangle_count, &stitch, at->vertex_count, at->x, at->y);
}

static long long cuts_wanted(void) {
    const char *wanted = getenv("SCREE_TEST_CUTS");
    return wanted != NULL ? strtoll(wanted, NULL, 10) : RANDOM_CUTS;
}

static void any_cut_at_any_scales_is_watertight(void) {
    uint64_t state = 1;
    long long cuts = cuts_wanted(), tiles = 0, triangles = 0, unstitched = 0;
    for (long long n = 0; n < cuts; n++) {
        struct seam_check check = {0}, plain = {0};
        cut_make_ids(&state, false, &cut);
        cut_make_meshes(&state, &cut);
        plain.period = check.period = cut.profile == SCREE_GEODETIC ? cut.columns : 0;
        for (uint32_t tile = 0; tile < cut.count; tile++) {
            const struct cut_tile *at = &cut.tiles[tile];
            add_stitched(&cut, tile, &check);
            seam_add(&plain, &at->view, at->triangle_count, NULL, 0, at->x, at->y);
        }
        CU_ASSERT(plain.turned == 0 && plain.corners_beyond == 0 && plain.doubled_area == 0);
        CU_ASSERT(check.turned == 0 && check.corners_beyond == 0 && check.doubled_area == 0);
        tiles += cut.count;
        triangles += (long long)check.edge_count / 3;
        unstitched += (long long)seam_cracks(&plain);
        CU_ASSERT_EQUAL(seam_cracks(&check), 0);
        seam_free(&check);
        seam_free(&plain);
    }
    printf("%lld cuts, %lld tiles, %lld triangles, %lld cracks without stitches ... ", cuts, tiles, triangles,
           unstitched);
    CU_ASSERT(unstitched > 100 * cuts); /* there was something to stitch */
}

static void holes_stay_holes(void) {
    uint64_t state = 7;
    for (int n = 0; n < 200; n++) {
        struct seam_check check = {0};
        cut_make_ids(&state, true, &cut);
        cut_make_meshes(&state, &cut);
        check.period = cut.profile == SCREE_GEODETIC ? cut.columns : 0;
        for (uint32_t tile = 0; tile < cut.count; tile++) add_stitched(&cut, tile, &check);
        CU_ASSERT(check.turned == 0 && check.corners_beyond == 0 && check.doubled_area == 0);
        CU_ASSERT_EQUAL(seam_cracks(&check), 0);
        seam_free(&check);
    }
}

/* Cells of the finest zoom along the outside of a side, looked up one by one. */
static void neighbours_are_those_that_touch(void) {
    uint64_t state = 3;
    for (int n = 0; n < 300; n++) {
        cut_make_ids(&state, n % 2 == 0, &cut);
        int64_t columns = cut.profile == SCREE_GEODETIC ? 2 << CUT_FINEST : 1 << CUT_FINEST, rows = 1 << CUT_FINEST;
        for (uint32_t i = 0; i < cut.count; i++) {
            if (i > 0) CU_ASSERT(scree_tile_compare(&cut.ids[i - 1], &cut.ids[i]) < 0);
            for (int side = 0; side < SCREE_SIDES; side++) {
                uint32_t found[CUT_MOST_TILES], expected = 0;
                uint32_t count = scree_cut_neighbours(cut.ids, cut.count, cut.profile, &cut.ids[i],
                                                      (enum scree_side)side, found, CUT_MOST_TILES);
                int64_t span = 1 << (CUT_FINEST - cut.ids[i].zoom), last = -1;
                for (int64_t along = 0; along < span; along++) {
                    int64_t x = cut.ids[i].x * span, y = cut.ids[i].y * span;
                    if (side == SCREE_EAST || side == SCREE_WEST)
                        x += side == SCREE_EAST ? span : -1, y += along;
                    else
                        y += side == SCREE_NORTH ? span : -1, x += along;
                    if (cut.profile == SCREE_GEODETIC) x = (x + columns) % columns;
                    if (x < 0 || y < 0 || x >= columns || y >= rows) continue;
                    for (uint32_t t = 0; t < cut.count; t++) {
                        int levels = CUT_FINEST - cut.ids[t].zoom;
                        if (x >> levels != cut.ids[t].x || y >> levels != cut.ids[t].y || t == last) continue;
                        CU_ASSERT_FATAL(expected < count);
                        CU_ASSERT_EQUAL(found[expected], t);
                        expected++;
                        last = t;
                    }
                }
                CU_ASSERT_EQUAL(expected, count);
                if (count > 1) { /* less room than there are neighbours */
                    uint32_t first[2] = {0, UINT32_MAX};
                    CU_ASSERT_EQUAL(scree_cut_neighbours(cut.ids, cut.count, cut.profile, &cut.ids[i],
                                                         (enum scree_side)side, first, 1),
                                    count);
                    CU_ASSERT(first[0] == found[0] && first[1] == UINT32_MAX);
                }
            }
        }
    }
}

/* Tiles as deep as can be named, on both sides of the antimeridian. */
static void neighbours_at_the_deepest_zoom(void) {
    uint32_t last_x = (uint32_t)(((uint64_t)2 << SCREE_MAX_ZOOM) - 1), last_y = (1u << SCREE_MAX_ZOOM) - 1, found = 9;
    struct scree_tile_id tiles[3] = {{SCREE_MAX_ZOOM, 0, last_y}, {0, 1, 0}, {SCREE_MAX_ZOOM, last_x, last_y}};
    CU_ASSERT(scree_tile_compare(&tiles[0], &tiles[1]) < 0 && scree_tile_compare(&tiles[1], &tiles[2]) < 0);
    CU_ASSERT(scree_tile_compare(&tiles[2], &tiles[0]) > 0 && scree_tile_compare(&tiles[1], &tiles[1]) == 0);
    CU_ASSERT_EQUAL(scree_cut_neighbours(tiles, 2, SCREE_GEODETIC, &tiles[0], SCREE_WEST, &found, 1), 1);
    CU_ASSERT_EQUAL(found, 1);
    CU_ASSERT_EQUAL(scree_cut_neighbours(tiles, 2, SCREE_GEODETIC, &tiles[1], SCREE_EAST, &found, 1), 1);
    CU_ASSERT_EQUAL(found, 0);
    CU_ASSERT_EQUAL(scree_cut_neighbours(tiles, 1, SCREE_GEODETIC, &tiles[2], SCREE_EAST, &found, 1), 1);
    CU_ASSERT_EQUAL(found, 0);
    CU_ASSERT_EQUAL(scree_cut_neighbours(tiles, 1, SCREE_LOCAL, &tiles[0], SCREE_WEST, &found, 1), 0);
    CU_ASSERT_EQUAL(scree_cut_neighbours(tiles, 3, SCREE_GEODETIC, &tiles[0], SCREE_NORTH, &found, 1), 0);
    CU_ASSERT_EQUAL(scree_cut_neighbours(NULL, 0, SCREE_GEODETIC, &tiles[1], SCREE_WEST, &found, 1), 0);
}

/* Two local tiles of 8 x 8 steps side by side, of two triangles each, with the given vertices on the common side, and
 * one on the northern side of the first. */
static void make_pair(uint32_t first, uint32_t second) {
    static struct cut_tile pair[2];
    for (int i = 0; i < 2; i++) {
        struct cut_tile *tile = &pair[i];
        *tile = (struct cut_tile){.vertex_count = 4, .triangle_count = 2};
        tile->header = (struct scree_stream_header){.profile = SCREE_LOCAL,
                                                    .zoom = 1,
                                                    .columns = 8,
                                                    .rows = 8,
                                                    .west = 100 + 16 * i,
                                                    .south = 50,
                                                    .spacing_x = 2,
                                                    .spacing_y = 3,
                                                    .tile_x = (uint32_t)i};
        for (int corner = 0; corner < 4; corner++)
            tile->vertices[corner] = (struct scree_vertex){corner % 2 * 8, corner / 2 * 8, 5};
        memcpy(tile->indices, (uint32_t[]){0, 1, 3, 0, 3, 2}, 6 * sizeof *tile->indices);
    }
    /* the first's (0, 1, 3) has its edges (0, 1) and (1, 3) on the border, the second's (0, 3, 2) its (2, 0) */
    for (uint32_t i = 0; i < first; i++) { /* (0, b, 3), then (0, 1, b) goes on being split */
        uint32_t number = pair[0].vertex_count++, t = pair[0].triangle_count++;
        uint32_t before = i == 0 ? 3 : number - 1;
        pair[0].vertices[number] = (struct scree_vertex){8, (int32_t)(6 - 2 * i), 7};
        pair[0].indices[2] = number;
        memcpy(&pair[0].indices[3 * t], (uint32_t[]){0, number, before}, 3 * sizeof *pair[0].indices);
    }
    for (uint32_t i = 0; i < second; i++) { /* likewise of (0, 3, 2) */
        uint32_t number = pair[1].vertex_count++, t = pair[1].triangle_count++;
        uint32_t before = i == 0 ? 2 : number - 1;
        pair[1].vertices[number] = (struct scree_vertex){0, (int32_t)(6 - 2 * i), 7};
        pair[1].indices[5] = number;
        memcpy(&pair[1].indices[3 * t], (uint32_t[]){number, 3, before}, 3 * sizeof *pair[1].indices);
    }
    for (int i = 0; i < 2; i++) {
        cut.tiles[i] = pair[i];
        cut_tile_finish(&cut.tiles[i]);
    }
}

static enum scree_status stitch_first(struct scree_stitch *stitch, struct scree_error *error) {
    struct scree_stitch_neighbour beside = {&cut.tiles[1].view, SCREE_EAST};
    return scree_stitch_borders(&cut.tiles[0].view, &beside, 1, 100, stitch, error);
}

static void a_fan_by_hand(void) {
    struct scree_stitch stitch = roomy();
    make_pair(0, 2);
    CU_ASSERT_EQUAL_FATAL(stitch_first(&stitch, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stitch.count.replaced, 1);
    CU_ASSERT_EQUAL(replaced[0], 0);
    CU_ASSERT_EQUAL(stitch.count.vertices, 2);
    CU_ASSERT(further[0].x == 8 && further[0].y == 4 && further[0].height == 7);
    CU_ASSERT(further[1].x == 8 && further[1].y == 6 && further[1].height == 7);
    CU_ASSERT(sources[0].neighbour == 0 && sources[0].vertex == 5 && sources[1].vertex == 4);
    CU_ASSERT_EQUAL(stitch.count.triangles, 3);
    static const uint32_t expected[] = {1, 100, 0, 100, 101, 0, 101, 3, 0};
    for (int i = 0; i < 9; i++) CU_ASSERT_EQUAL(indices[i], expected[i]);
    /* the other way round nothing is missing */
    struct scree_stitch_neighbour beside = {&cut.tiles[0].view, SCREE_WEST};
    CU_ASSERT_EQUAL(scree_stitch_borders(&cut.tiles[1].view, &beside, 1, 100, &stitch, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stitch.count.replaced + stitch.count.vertices + stitch.count.triangles, 0);
}

static void both_draw_what_the_other_has_more(void) {
    struct scree_stitch stitch = roomy();
    make_pair(1, 2);
    cut.tiles[0].vertices[4].y = 2;
    CU_ASSERT_EQUAL_FATAL(stitch_first(&stitch, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stitch.count.vertices, 2);
    CU_ASSERT_EQUAL(stitch.count.triangles, 3);
    struct scree_stitch_neighbour beside = {&cut.tiles[0].view, SCREE_WEST};
    CU_ASSERT_EQUAL(scree_stitch_borders(&cut.tiles[1].view, &beside, 1, 100, &stitch, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stitch.count.vertices, 1);
    CU_ASSERT(further[0].x == 0 && further[0].y == 2);
}

static void tiles_that_do_not_belong_together_are_refused(void) {
    struct scree_stitch stitch = roomy();
    struct scree_error error = {0};
    make_pair(1, 2);
    cut.tiles[1].vertices[4].height = 8;
    CU_ASSERT_EQUAL(stitch_first(&stitch, &error), SCREE_E_CORRUPT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "eastern border of tile 1/0/0"));
    CU_ASSERT_EQUAL(stitch.count.vertices + stitch.count.triangles + stitch.count.replaced, 0);
    for (int fault = 0; fault < 6; fault++) {
        make_pair(1, 2);
        struct scree_stream_header *header = &cut.tiles[1].header;
        switch (fault) {
        case 0: header->west += 2; break;   /* a gap of a step */
        case 1: header->south += 24; break; /* beyond the end of the side */
        case 2: header->spacing_y = 4; break;
        case 3: header->height_exponent = 1; break;
        case 4: header->west += 0.9; break; /* between the lattices */
        default: header->profile = SCREE_GEODETIC; break;
        }
        error = (struct scree_error){0};
        CU_ASSERT_EQUAL(stitch_first(&stitch, &error), SCREE_E_ARGUMENT);
        CU_ASSERT(error.text[0] != '\0');
    }
    make_pair(1, 2);
    cut.tiles[0].view.borders[SCREE_NORTH].vertex_count = 0;
    CU_ASSERT_EQUAL(stitch_first(&stitch, NULL), SCREE_E_ARGUMENT);
}

/* Two neighbours on a side of a third, which has no vertex where they meet. */
static void neighbours_that_differ_where_they_meet_are_refused(void) {
    uint64_t state = 9;
    int refused = 0;
    for (int n = 0; n < 100; n++) {
        struct scree_stitch_neighbour neighbours[MOST_BESIDE];
        cut_make_ids(&state, false, &cut);
        cut_make_meshes(&state, &cut);
        for (uint32_t tile = 0; tile < cut.count; tile++) {
            uint32_t count = find_neighbours(&cut, tile, neighbours), first = 0;
            struct scree_stitch stitch = roomy();
            while (first + 1 < count && neighbours[first].side != neighbours[first + 1].side) first++;
            if (first + 1 >= count || neighbours[first].side != SCREE_EAST) continue;
            struct cut_tile *lower = NULL;
            for (uint32_t t = 0; t < cut.count; t++)
                if (&cut.tiles[t].view == neighbours[first].tile) lower = &cut.tiles[t];
            CU_ASSERT_PTR_NOT_NULL_FATAL(lower);
            lower->vertices[2].height++; /* its north-western corner */
            CU_ASSERT_EQUAL(scree_stitch_borders(&cut.tiles[tile].view, neighbours, count, 1000, &stitch, NULL),
                            SCREE_E_CORRUPT);
            lower->vertices[2].height--;
            CU_ASSERT_EQUAL(scree_stitch_borders(&cut.tiles[tile].view, neighbours, count, 1000, &stitch, NULL),
                            SCREE_OK);
            refused++;
        }
    }
    CU_ASSERT(refused > 20);
}

static void too_little_room_is_refused(void) {
    struct scree_stitch_neighbour beside = {&cut.tiles[1].view, SCREE_EAST};
    make_pair(0, 2);
    struct scree_stitch_size bound = scree_stitch_bound(&cut.tiles[0].view, &beside, 1);
    for (int i = 0; i < 4; i++) {
        struct scree_stitch stitch = roomy();
        stitch.capacity = bound;
        if (i == 0) stitch.capacity.vertices--;
        if (i == 1) stitch.capacity.triangles--;
        if (i == 2) stitch.capacity.replaced--;
        CU_ASSERT_EQUAL(stitch_first(&stitch, NULL), i < 3 ? SCREE_E_LIMIT : SCREE_OK);
    }
}

static void neighbours_out_of_order_are_refused(void) {
    uint64_t state = 5;
    struct scree_stitch_neighbour neighbours[MOST_BESIDE], swapped;
    int refused = 0;
    for (int n = 0; n < 50; n++) {
        cut_make_ids(&state, false, &cut);
        cut_make_meshes(&state, &cut);
        for (uint32_t tile = 0; tile < cut.count; tile++) {
            uint32_t count = find_neighbours(&cut, tile, neighbours), first = 0;
            while (first + 1 < count && neighbours[first].side != neighbours[first + 1].side) first++;
            if (first + 1 >= count) continue;
            swapped = neighbours[first];
            neighbours[first] = neighbours[first + 1];
            neighbours[first + 1] = swapped;
            struct scree_stitch stitch = roomy();
            CU_ASSERT_EQUAL(scree_stitch_borders(&cut.tiles[tile].view, neighbours, count, 1000, &stitch, NULL),
                            SCREE_E_ARGUMENT);
            refused++;
        }
    }
    CU_ASSERT(refused > 50);
}

int suite_stitch(void) {
    CU_pSuite suite = CU_add_suite("stitch", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_fan_by_hand);
    CU_ADD_TEST(suite, both_draw_what_the_other_has_more);
    CU_ADD_TEST(suite, any_cut_at_any_scales_is_watertight);
    CU_ADD_TEST(suite, holes_stay_holes);
    CU_ADD_TEST(suite, neighbours_are_those_that_touch);
    CU_ADD_TEST(suite, neighbours_at_the_deepest_zoom);
    CU_ADD_TEST(suite, tiles_that_do_not_belong_together_are_refused);
    CU_ADD_TEST(suite, neighbours_that_differ_where_they_meet_are_refused);
    CU_ADD_TEST(suite, too_little_room_is_refused);
    CU_ADD_TEST(suite, neighbours_out_of_order_are_refused);
    return 0;
}
