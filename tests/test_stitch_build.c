/* Stitched borders on builds: any cut of the tiles that a build writes, each at any scale, is watertight, and so is
 * what any camera chooses. */
#include "src/build.h"
#include "src/stream_set_io.h"
#include "tests/cut_maker.h"
#include "tests/fractal.h"
#include "tests/raster_maker.h"
#include "tests/seam_check.h"
#include <scree/select.h>

#include <CUnit/CUnit.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define RANDOM_CUTS 100 /* of each build; SCREE_TEST_CUTS asks for another number */
#define MOST_TILES  256

/* What a build wrote, all of it decoded. */
static struct {
    struct lattice lattice;
    uint32_t count;
    struct scree_tile_id ids[MOST_TILES]; /* by zoom */
    struct scree_player *players[MOST_TILES];
    struct scree_terrain terrain;
    struct scree_select_tile tiles[MOST_TILES]; /* own: where the tile's number is in `numbers` */
    uint32_t numbers[MOST_TILES];
} built;

static double globe_m(double x, double y) {
    const struct fractal fractal = {14, false};
    float height_m;
    fractal_window(&fractal, llround(x * 20), llround(y * 20), 1, 1, &height_m, 1);
    return height_m;
}

static double local_m(double x, double y) {
    const struct fractal fractal = {15, true};
    float height_m;
    fractal_window(&fractal, llround(x / 30), llround(y / 30), 1, 1, &height_m, 1);
    return height_m;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static enum scree_status build_in(const char *folder, enum profile profile, double root_error_m,
                                  struct scree_error *error) {
    static const char *const inputs[] = {"/vsimem/stitch.tif"};
    const struct pyramid_options nobody = {0};
    struct build build = {0};
    const struct build_options options = {.raster = {.inputs = inputs, .input_count = 1, .profile = profile},
                                          .out = folder,
                                          .max_zoom = ZOOM_FROM_SOURCE,
                                          .ladder = {.root_error_m = root_error_m, .finest_octaves = 1},
                                          .no_terrain = true,
                                          .threads = 2};
    enum scree_status status = build_prepare(&options, &build, error);
    if (status == SCREE_OK) status = build_run(&options, &nobody, &build, error);
    build_release(&build);
    return status;
}

static void load(struct scree_memory *memory, const char *folder, struct scree_error *error) {
    struct stream_set *set = calloc(1, sizeof *set);
    CU_ASSERT_PTR_NOT_NULL_FATAL(set);
    enum scree_status status = stream_set_open(memory, folder, set, error);
    built.lattice = set->info.lattice;
    built.count = 0;
    for (int zoom = 0; zoom <= set->info.max_zoom && status == SCREE_OK; zoom++)
        for (uint32_t i = 0; i < set->tiles[zoom].count && status == SCREE_OK; i++) {
            struct tile_id id = set->tiles[zoom].ids[i];
            uint64_t file_bytes;
            CU_ASSERT_FATAL(built.count < MOST_TILES);
            built.ids[built.count] = (struct scree_tile_id){id.zoom, id.x, id.y};
            status = stream_set_play(memory, set, id, &built.players[built.count], &file_bytes, error);
            if (status == SCREE_OK) built.count++;
        }
    stream_set_free(memory, set);
    free(set);
}

/* Builds, and plays every tile of it. */
static void make_built(const struct raster_fixture *fixture, enum profile profile, double root_error_m) {
    char folder[256];
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    const char *place = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/scree-stitch-XXXXXX", place == NULL ? P_tmpdir : place);
    CU_ASSERT_PTR_NOT_NULL_FATAL(mkdtemp(folder));
    make_raster(fixture);
    if (build_in(folder, profile, root_error_m, &error) == SCREE_OK) load(&memory, folder, &error);
    if (error.status != SCREE_OK) CU_FAIL(error.text);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

/* What scree_select chooses from. */
static void link_built(void) {
    const struct lattice *lattice = &built.lattice;
    built.terrain = (struct scree_terrain){.profile = SCREE_GEODETIC, .lowest_m = -1000, .highest_m = 9000};
    if (lattice->profile == PROFILE_LOCAL)
        built.terrain = (struct scree_terrain){.profile = SCREE_LOCAL,
                                               .lowest_m = -1000,
                                               .highest_m = 9000,
                                               .finest_zoom = lattice->finest_zoom,
                                               .columns = lattice->columns - 1,
                                               .rows = lattice->rows - 1,
                                               .west = lattice->west,
                                               .south = lattice->south,
                                               .spacing_x = lattice->spacing_x,
                                               .spacing_y = lattice->spacing_y,
                                               .metres_x = lattice->metres_x,
                                               .metres_y = lattice->metres_y};
    for (uint32_t t = 0; t < built.count; t++) {
        struct scree_arrays arrays;
        const struct scree_stream_header *header = scree_player_header(built.players[t]);
        struct scree_select_tile *tile = &built.tiles[t];
        *tile = (struct scree_select_tile){
            .id = built.ids[t], .header = header, .rungs_ready = header->rung_count, .own = &built.numbers[t]};
        built.numbers[t] = t;
        CU_ASSERT_EQUAL(scree_player_seek_rung(built.players[t], 0), SCREE_OK);
        scree_player_look(built.players[t], &arrays);
        scree_select_heights(&built.terrain, header, 0, arrays.vertices, &tile->lowest_m, &tile->highest_m);
    }
    CU_ASSERT_EQUAL(scree_select_link(&built.terrain, built.tiles, built.count, NULL), SCREE_OK);
}

static void release_built(void) {
    for (uint32_t t = 0; t < built.count; t++) scree_player_free(built.players[t]);
    built.count = 0;
}

static uint32_t find(struct scree_tile_id id) {
    uint32_t t = 0;
    while (t < built.count && scree_tile_compare(&built.ids[t], &id) != 0) t++;
    return t;
}

/* Goes down from a tile at random; what has no children there stays a hole. */
static uint32_t divide(uint64_t *state, uint32_t tile, uint32_t *cut, uint32_t count) {
    const struct scree_tile_id *id = &built.ids[tile];
    uint32_t children[4], child_count = 0;
    for (uint32_t i = 0; i < 4; i++) {
        children[child_count] = find((struct scree_tile_id){id->zoom + 1, 2 * id->x + i % 2, 2 * id->y + i / 2});
        if (children[child_count] < built.count) child_count++;
    }
    if (child_count == 0 || cut_number(state, 100) < 15) {
        cut[count++] = tile;
        return count;
    }
    for (uint32_t i = 0; i < child_count; i++) count = divide(state, children[i], cut, count);
    return count;
}

/* Any rung, or any number of splits between two of them. */
static void seek_anywhere(uint64_t *state, struct scree_player *player) {
    const struct scree_stream_header *header = scree_player_header(player);
    uint32_t rung = (uint32_t)cut_number(state, (int32_t)header->rung_count);
    if (rung + 1 < header->rung_count && cut_number(state, 2) == 0) {
        uint32_t from = header->rungs[rung].vertex_count - header->rungs[0].vertex_count;
        int32_t more = (int32_t)(header->rungs[rung + 1].vertex_count - header->rungs[rung].vertex_count);
        CU_ASSERT_EQUAL(scree_player_seek_splits(player, from + (uint32_t)cut_number(state, more + 1)), SCREE_OK);
    } else {
        CU_ASSERT_EQUAL(scree_player_seek_rung(player, rung), SCREE_OK);
    }
}

/* What a camera above a random tile chooses, at the levels that it asks for. */
static uint32_t choose_by_view(uint64_t *state, uint32_t *chosen) {
    static struct scree_select_drawn drawn[MOST_TILES];
    static struct scree_select_wanted wanted[MOST_TILES];
    static double workspace[8 * MOST_TILES];
    struct scree_selection selection = {.capacity = MOST_TILES,
                                        .drawn = drawn,
                                        .wanted = wanted,
                                        .workspace = workspace,
                                        .workspace_bytes = sizeof workspace};
    struct scree_frame frame;
    struct scree_view view;
    struct scree_select_options options = {.measure = (enum scree_measure)cut_number(state, 2)};
    double eye[3], height_m = exp2(10 + cut_number(state, 1300) / 100.0);
    scree_stream_frame(scree_player_header(built.players[cut_number(state, (int32_t)built.count)]), &frame);
    for (int k = 0; k < 3; k++) eye[k] = frame.origin[k] + height_m * frame.axes[2][k];
    options.tolerance_px = exp2(cut_number(state, 800) / 100.0 - 4);
    CU_ASSERT_EQUAL(scree_view_of_eye(eye, 1, 1000, &view, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(scree_select(&built.terrain, built.tiles, built.count, &view, &options, &selection, NULL),
                    SCREE_OK);
    CU_ASSERT_EQUAL(selection.wanted_count, 0);
    for (uint32_t i = 0; i < selection.drawn_count; i++) {
        chosen[i] = *(const uint32_t *)built.tiles[drawn[i].tile].own;
        CU_ASSERT_EQUAL(scree_player_seek_level(built.players[chosen[i]], drawn[i].level), SCREE_OK);
    }
    return selection.drawn_count;
}

/* A stitch in arrays of the heap. */
static struct scree_stitch new_stitch(struct scree_stitch_size bound) {
    struct scree_stitch stitch = {.capacity = bound};
    stitch.replaced = calloc(bound.replaced + (size_t)1, sizeof *stitch.replaced);
    stitch.vertices = calloc(bound.vertices + (size_t)1, sizeof *stitch.vertices);
    stitch.indices = calloc(bound.triangles + (size_t)1, 3 * sizeof *stitch.indices);
    CU_ASSERT_FATAL(stitch.replaced != NULL && stitch.vertices != NULL && stitch.indices != NULL);
    return stitch;
}

struct drawn_cut {
    uint32_t count;
    struct scree_tile_id ids[MOST_TILES];
    struct scree_stitch_tile tiles[MOST_TILES];
    uint32_t vertex_counts[MOST_TILES], triangle_counts[MOST_TILES];
};

static void add_stitched(const struct drawn_cut *cut, uint32_t tile, struct seam_check *check) {
    struct scree_stitch_neighbour neighbours[4 * MOST_TILES];
    uint32_t found[MOST_TILES], count = 0;
    struct scree_error error = {0};
    const struct scree_tile_id *id = &cut->ids[tile];
    int64_t span = lattice_tile_span(&built.lattice, id->zoom);
    for (int side = 0; side < SCREE_SIDES; side++) {
        uint32_t beside = scree_cut_neighbours(cut->ids, cut->count, cut->tiles[tile].header->profile, id,
                                               (enum scree_side)side, found, MOST_TILES);
        for (uint32_t n = 0; n < beside; n++)
            neighbours[count++] = (struct scree_stitch_neighbour){&cut->tiles[found[n]], (enum scree_side)side};
    }
    struct scree_stitch stitch = new_stitch(scree_stitch_bound(&cut->tiles[tile], neighbours, count));
    if (scree_stitch_borders(&cut->tiles[tile], neighbours, count, cut->vertex_counts[tile], &stitch, &error) !=
        SCREE_OK)
        CU_FAIL(error.text);
    seam_add(check, &cut->tiles[tile], cut->triangle_counts[tile], &stitch, cut->vertex_counts[tile], id->x * span,
             id->y * span);
    free(stitch.replaced);
    free(stitch.vertices);
    free(stitch.indices);
}

static void check_cuts(uint64_t seed) {
    static struct drawn_cut cut;
    const char *wanted = getenv("SCREE_TEST_CUTS");
    long long cuts = wanted != NULL ? strtoll(wanted, NULL, 10) : RANDOM_CUTS;
    uint64_t state = seed, tiles = 0, triangles = 0, cracks = 0, largest = 0;
    for (long long n = 0; n < cuts; n++) {
        uint32_t chosen[MOST_TILES];
        struct seam_check check = {0}, plain = {0};
        if (built.lattice.profile == PROFILE_GEODETIC) plain.period = check.period = built.lattice.columns - 1;
        cut.count = 0;
        bool by_view = cut_number(&state, 2) == 0;
        if (by_view) cut.count = choose_by_view(&state, chosen);
        for (uint32_t root = 0; root < built.count && built.ids[root].zoom == 0 && !by_view; root++)
            cut.count = divide(&state, root, chosen, cut.count);
        for (uint32_t i = 0; i < cut.count; i++) {
            struct scree_player *player = built.players[chosen[i]];
            struct scree_arrays arrays;
            if (!by_view) seek_anywhere(&state, player);
            scree_player_look(player, &arrays);
            cut.ids[i] = built.ids[chosen[i]];
            cut.vertex_counts[i] = arrays.vertex_count;
            cut.triangle_counts[i] = arrays.triangle_count;
            CU_ASSERT_EQUAL(scree_stitch_look(player, &cut.tiles[i], NULL), SCREE_OK);
        }
        for (uint32_t i = 0; i < cut.count; i++) {
            int64_t span = lattice_tile_span(&built.lattice, cut.ids[i].zoom);
            add_stitched(&cut, i, &check);
            seam_add(&plain, &cut.tiles[i], cut.triangle_counts[i], NULL, 0, cut.ids[i].x * span, cut.ids[i].y * span);
        }
        CU_ASSERT(check.turned == 0 && check.corners_beyond == 0 && check.doubled_area == 0);
        tiles += cut.count;
        triangles += check.edge_count / 3;
        if (cut.count > largest) largest = cut.count;
        cracks += seam_cracks(&plain);
        CU_ASSERT_EQUAL(seam_cracks(&check), 0);
        seam_free(&check);
        seam_free(&plain);
    }
    printf("\n    %u tiles: %lld cuts of up to %llu, %llu triangles, %llu cracks without stitches ... ", built.count,
           cuts, (unsigned long long)largest, (unsigned long long)triangles, (unsigned long long)cracks);
    CU_ASSERT(tiles > 2 * (uint64_t)cuts && cracks > (uint64_t)cuts);
}

/* 3 x 2 tiles of the finest zoom, and the tiles of the globe above them. */
static void cuts_across_the_antimeridian(void) {
    const struct raster_fixture fixture = {.path = "/vsimem/stitch.tif",
                                           .columns = 400,
                                           .rows = 200,
                                           .west = 165,
                                           .north = 9,
                                           .pixel_x = 0.1,
                                           .pixel_y = 0.1,
                                           .srs = "EPSG:4326",
                                           .height = globe_m};
    make_built(&fixture, PROFILE_GEODETIC, 0);
    link_built();
    check_cuts(31);
    release_built();
}

/* 3 x 2 tiles that are cut to the raster. */
static void cuts_of_a_local_raster(void) {
    const struct raster_fixture fixture = {.path = "/vsimem/stitch.tif",
                                           .columns = 601,
                                           .rows = 400,
                                           .west = 400000,
                                           .north = 3800000,
                                           .pixel_x = 30,
                                           .pixel_y = 30,
                                           .srs = "EPSG:32611",
                                           .height = local_m};
    make_built(&fixture, PROFILE_LOCAL, 200);
    link_built();
    check_cuts(32);
    release_built();
}

static void a_tile_without_a_mesh_is_refused(void) {
    struct scree_player *player;
    struct scree_stitch_tile tile;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(scree_player_new(NULL, &player, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(scree_stitch_look(player, &tile, &error), SCREE_E_ARGUMENT);
    CU_ASSERT(error.text[0] != '\0');
    scree_player_free(player);
}

int suite_stitch_build(void) {
    CU_pSuite suite = CU_add_suite("stitch_build", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_tile_without_a_mesh_is_refused);
    CU_ADD_TEST(suite, cuts_across_the_antimeridian);
    CU_ADD_TEST(suite, cuts_of_a_local_raster);
    return 0;
}
