/* From rung to rung: the ladder, and builds of which every stream is decoded. A tile at its finest is its children at
 * their coarsest, triangle by triangle; every rung of the finest zoom is as exact as it says and as the ladder wants;
 * static tiles do not depend on what else is written; full grids come back post by post. */
#include "lod/samples.h"
#include "src/build.h"
#include "src/stream_set_io.h"
#include "src/tile_build.h"
#include "src/tile_place.h"
#include "tests/fractal.h"
#include "tests/raster_maker.h"

#include <CUnit/CUnit.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the ladder ---- */

static void rungs_lie_between_zooms(void) {
    struct lattice lattice = lattice_geodetic(4);
    struct ladder_options options = {
        .root_error_m = 160, .relief_m = 1000, .largest_height_m = 1000, .finest_octaves = 2};
    struct ladder ladder;
    options.error_at_m[3] = 16; /* not half of zoom 2's 40; zoom 4 has 10 */
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(ladder.finest_rung, 24);
    CU_ASSERT_EQUAL(ladder.coarsest_rung, -4);
    for (int zoom = 0; zoom <= 4; zoom++)
        CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 4 * zoom), ladder.tolerance_m[zoom]);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, 1), 160 * pow(2, -0.25), 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, 9), 40 * pow(0.4, 0.25), 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, 11), 40 * pow(0.4, 0.75), 1e-12);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, 19), 10 * pow(2, -0.75), 1e-12);
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 24), 2.5);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, -1), 160 * pow(2, 0.25), 1e-12);
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, -4), 320);
    for (int rung = -3; rung <= 24; rung++)
        CU_ASSERT(ladder_rung_tolerance_m(&ladder, rung) < ladder_rung_tolerance_m(&ladder, rung - 1));
    options.lossless = true;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(ladder.finest_rung, 25);
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 25), 2.5);
}

/* Heights are counted more finely than static tiles can say: the meshes of the finest zoom leave room for that. */
static void heights_are_fine_enough_for_the_finest_rung(void) {
    struct lattice lattice = lattice_geodetic(12);
    struct ladder_options options = {
        .root_error_m = 4096, .relief_m = 8000, .largest_height_m = 8000, .finest_octaves = 3};
    struct scree_error error = {0};
    struct ladder ladder;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK); /* 1 m at zoom 12 */
    CU_ASSERT(4 * ladder.height_unit_m <= ladder_rung_tolerance_m(&ladder, ladder.finest_rung));
    double step_m = ladder.height_unit_m * ladder.border_step[12];
    CU_ASSERT_EQUAL(step_m, 0.25); /* of 8000 m in 32767 */
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 48), 1 - step_m / 2);
    CU_ASSERT_DOUBLE_EQUAL(ladder_rung_tolerance_m(&ladder, 49), pow(2, -0.25), 1e-12);
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 44), 2);
    options.finest_octaves = 0;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(ladder.height_unit_m, 0.25);
    CU_ASSERT_EQUAL(ladder_rung_tolerance_m(&ladder, 48), 1);
    options.lossless = true;
    options.root_error_m = 409600; /* 100 m */
    CU_ASSERT_EQUAL_FATAL(ladder_make(&lattice, &options, &ladder, NULL), SCREE_OK);
    CU_ASSERT(ladder.height_unit_m <= 1);
    options = (struct ladder_options){
        .root_error_m = 8, .relief_m = 1, .largest_height_m = 8000, .finest_octaves = MAX_FINEST_OCTAVES};
    CU_ASSERT_EQUAL(ladder_make(&lattice, &options, &ladder, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "--finest-octaves"));
}

/* ---- builds ---- */

static const char *const inputs[] = {"/vsimem/rungs.tif"};

static double mountains_m(double x, double y) {
    const struct fractal fractal = {8, true};
    float height_m;
    fractal_window(&fractal, llround(x / 30), llround(y / 30), 1, 1, &height_m, 1);
    return height_m;
}

static double globe_mountains_m(double x, double y) {
    const struct fractal fractal = {9, false};
    float height_m;
    fractal_window(&fractal, llround(x * 120), llround(y * 120), 1, 1, &height_m, 1);
    return height_m;
}

static const struct raster_fixture local_fixture = {.path = "/vsimem/rungs.tif",
                                                    .columns = 530,
                                                    .rows = 300,
                                                    .west = 400000,
                                                    .north = 3800000,
                                                    .pixel_x = 30,
                                                    .pixel_y = 30,
                                                    .srs = "EPSG:32611",
                                                    .height = mountains_m};

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static void new_folder(char folder[256]) {
    const char *place = getenv("TMPDIR");
    snprintf(folder, 256, "%s/scree-rungs-XXXXXX", place == NULL ? P_tmpdir : place);
    CU_ASSERT_PTR_NOT_NULL_FATAL(mkdtemp(folder));
}

static void remove_folder(const char *folder) {
    nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static struct build_options options_for(enum profile profile, const char *out) {
    return (struct build_options){.raster = {.inputs = inputs, .input_count = 1, .profile = profile},
                                  .out = out,
                                  .max_zoom = ZOOM_FROM_SOURCE,
                                  .ladder = {.finest_octaves = DEFAULT_FINEST_OCTAVES},
                                  .threads = 2};
}

static void build(const struct build_options *options) {
    const struct pyramid_options nobody = {0};
    struct scree_error error = {0};
    struct build build = {0};
    enum scree_status status = build_prepare(options, &build, &error);
    if (status == SCREE_OK) status = build_run(options, &nobody, &build, &error);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    CU_ASSERT_EQUAL_FATAL(status, SCREE_OK);
    build_release(&build);
}

/* ---- families ---- */

/* Three corners in the parent's steps, the least first. */
struct corner_triple {
    struct scree_vertex at[3];
};

static int compare_vertices(const struct scree_vertex *a, const struct scree_vertex *b) {
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    return a->height < b->height ? -1 : a->height > b->height;
}

static int compare_triples(const void *left, const void *right) {
    const struct corner_triple *a = left, *b = right;
    for (int i = 0; i < 3; i++) {
        int order = compare_vertices(&a->at[i], &b->at[i]);
        if (order != 0) return order;
    }
    return 0;
}

/* The triangles as they are now, moved by (x, y), sorted; those outside of the window are left out. Returns how many.
 */
static uint32_t list_triangles(struct scree_player *player, int32_t x, int32_t y, const int32_t window[4],
                               struct corner_triple **list) {
    struct scree_arrays arrays;
    scree_player_look(player, &arrays);
    *list = malloc((arrays.triangle_count + 1) * sizeof **list);
    CU_ASSERT_PTR_NOT_NULL_FATAL(*list);
    uint32_t count = 0;
    for (uint32_t t = 0; t < arrays.triangle_count; t++) {
        struct corner_triple triple;
        int first = 0;
        bool inside = true;
        for (int i = 0; i < 3; i++) {
            struct scree_vertex at = arrays.vertices[arrays.indices[3 * t + (uint32_t)i]];
            at.x += x;
            at.y += y;
            inside = inside && at.x >= window[0] && at.y >= window[1] && at.x <= window[2] && at.y <= window[3];
            triple.at[i] = at;
            if (compare_vertices(&at, &triple.at[first]) < 0) first = i;
        }
        if (!inside) continue;
        for (int i = 0; i < 3; i++) (*list)[count].at[i] = triple.at[(first + i) % 3];
        count++;
    }
    qsort(*list, count, sizeof **list, compare_triples);
    return count;
}

/* Compares a parent at its finest with each of its children on the list; returns how many children there were. */
static int check_family(struct scree_memory *memory, const struct stream_set *set, struct tile_id id) {
    struct scree_player *parent = NULL, *child = NULL;
    struct scree_error error = {0};
    int children = 0;
    int32_t span = (int32_t)lattice_tile_span(&set->info.lattice, id.zoom + 1);
    CU_ASSERT_EQUAL_FATAL(stream_set_play(memory, set, id, &parent, NULL, &error), SCREE_OK);
    const struct scree_stream_header *header = scree_player_header(parent);
    CU_ASSERT_EQUAL(header->rungs[header->rung_count - 1].rung, 4 * id.zoom);
    CU_ASSERT_EQUAL(header->rungs[0].rung, 4 * (id.zoom - 1));
    int wanted = 0;
    for (uint32_t i = 0; i < 4; i++) {
        struct tile_id child_id = {id.zoom + 1, 2 * id.x + i % 2, 2 * id.y + i / 2};
        wanted += lattice_tile_window(&set->info.lattice, child_id).columns > 0;
        if (tile_list_find(&set->tiles[id.zoom + 1], child_id) == TILE_NOT_LISTED) continue;
        CU_ASSERT_EQUAL_FATAL(stream_set_play(memory, set, child_id, &child, NULL, &error), SCREE_OK);
        CU_ASSERT_EQUAL(scree_player_seek_rung(child, 0), SCREE_OK);
        int32_t x = (int32_t)(i % 2) * span, y = (int32_t)(i / 2) * span;
        const int32_t window[4] = {x, y, x + span, y + span};
        struct corner_triple *ours, *theirs;
        uint32_t our_count = list_triangles(parent, 0, 0, window, &ours);
        uint32_t their_count = list_triangles(child, x, y, window, &theirs);
        CU_ASSERT(their_count > 0);
        CU_ASSERT_EQUAL_FATAL(our_count, their_count);
        uint32_t differing = 0;
        for (uint32_t t = 0; t < our_count; t++) differing += compare_triples(&ours[t], &theirs[t]) != 0;
        CU_ASSERT_EQUAL(differing, 0);
        CU_ASSERT_EQUAL(header->height_exponent, scree_player_header(child)->height_exponent);
        free(theirs);
        free(ours);
        scree_player_free(child);
        children++;
    }
    CU_ASSERT(children == 0 || children == wanted); /* no quarter is left open */
    scree_player_free(parent);
    return children;
}

/* Every stream of a build. */
static void check_families(const char *out) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct stream_set *set = calloc(1, sizeof *set);
    CU_ASSERT_PTR_NOT_NULL_FATAL(set);
    CU_ASSERT_EQUAL_FATAL(stream_set_open(&memory, out, set, &error), SCREE_OK);
    int finest = set->info.lattice.finest_zoom;
    CU_ASSERT(finest >= 2);
    for (int zoom = 0; zoom < finest; zoom++) {
        int children = 0;
        for (uint32_t i = 0; i < set->tiles[zoom].count; i++)
            children += check_family(&memory, set, set->tiles[zoom].ids[i]);
        CU_ASSERT_EQUAL(children, (int)set->tiles[zoom + 1].count);
    }
    stream_set_free(&memory, set);
    free(set);
}

static void a_tile_is_its_children_at_their_coarsest(void) {
    const struct raster_fixture globe = {.path = inputs[0],
                                         .columns = 300,
                                         .rows = 200,
                                         .west = -100.3,
                                         .north = 34.2,
                                         .pixel_x = 0.08,
                                         .pixel_y = 0.08,
                                         .srs = "EPSG:4326",
                                         .height = globe_mountains_m};
    char out[256];
    new_folder(out);
    struct build_options options = options_for(PROFILE_LOCAL, out);
    make_raster(&local_fixture);
    build(&options);
    check_families(out);
    make_raster(&globe);
    options = options_for(PROFILE_GEODETIC, out);
    options.rungs_per_increment = 3;
    build(&options);
    check_families(out);
    remove_folder(out);
}

/* ---- what rungs say ---- */

/* The largest vertical distance of the posts of a local tile from the mesh as it is now. */
static float measure(struct scree_player *player, double unit_m) {
    const struct scree_stream_header *header = scree_player_header(player);
    int32_t across = header->columns + 1;
    float *posts = malloc((size_t)across * (size_t)(header->rows + 1) * sizeof *posts);
    CU_ASSERT_PTR_NOT_NULL_FATAL(posts);
    for (int32_t y = 0; y <= header->rows; y++)
        for (int32_t x = 0; x < across; x++)
            posts[y * across + x] =
                (float)mountains_m(header->west + x * header->spacing_x, header->south + y * header->spacing_y);
    const struct samples samples = {
        .columns = header->columns, .rows = header->rows, .cell_span = 1, .posts = posts, .stride = across};
    struct scree_arrays arrays;
    float largest_m = 0;
    scree_player_look(player, &arrays);
    for (uint32_t t = 0; t < arrays.triangle_count; t++) {
        struct sample corners[3];
        for (uint32_t i = 0; i < 3; i++) {
            const struct scree_vertex *vertex = &arrays.vertices[arrays.indices[3 * t + i]];
            corners[i] = (struct sample){vertex->x, vertex->y, (float)(vertex->height * unit_m)};
        }
        largest_m = fmaxf(largest_m, samples_triangle_error(&samples, &corners[0], &corners[1], &corners[2]).max_m);
    }
    free(posts);
    return largest_m;
}

static void check_rungs(const struct stream_set *set, struct scree_player *player) {
    const struct scree_stream_header *header = scree_player_header(player);
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        CU_ASSERT_EQUAL(scree_player_seek_rung(player, i), SCREE_OK);
        CU_ASSERT_EQUAL(measure(player, ldexp(1, header->height_exponent)), rung->max_error_m);
        CU_ASSERT(rung->max_error_m <= set->info.tolerance_m[rung->rung - set->info.first_rung]);
        CU_ASSERT(rung->svo_m >= sqrtf(rung->mmqe_m2) * (1 - 1e-6f));
        CU_ASSERT(i == 0 || rung->svo_m <= rung[-1].svo_m);
        CU_ASSERT(i == 0 || rung->rung == rung[-1].rung + 1);
    }
}

/* Lossless as well: then the finest rung has all posts, and nothing is off. */
static void every_rung_of_the_finest_zoom_is_as_exact_as_it_says(void) {
    char out[256];
    new_folder(out);
    make_raster(&local_fixture);
    for (int lossless = 0; lossless < 2; lossless++) {
        struct scree_memory memory = {0};
        struct scree_error error = {0};
        struct stream_set *set = calloc(1, sizeof *set);
        struct build_options options = options_for(PROFILE_LOCAL, out);
        options.ladder.lossless = lossless == 1;
        options.no_terrain = true;
        CU_ASSERT_PTR_NOT_NULL_FATAL(set);
        build(&options);
        CU_ASSERT_EQUAL_FATAL(stream_set_open(&memory, out, set, &error), SCREE_OK);
        int finest = set->info.lattice.finest_zoom;
        CU_ASSERT_EQUAL(set->tiles[finest].count, 6);
        for (uint32_t i = 0; i < set->tiles[finest].count; i++) {
            struct scree_player *player = NULL;
            CU_ASSERT_EQUAL_FATAL(stream_set_play(&memory, set, set->tiles[finest].ids[i], &player, NULL, &error),
                                  SCREE_OK);
            const struct scree_stream_header *header = scree_player_header(player);
            const struct scree_rung *last = &header->rungs[header->rung_count - 1];
            CU_ASSERT_EQUAL(last->rung, 4 * (finest + DEFAULT_FINEST_OCTAVES) + lossless);
            CU_ASSERT(!lossless || last->vertex_count == (uint32_t)((header->columns + 1) * (header->rows + 1)));
            CU_ASSERT(!lossless || last->max_error_m == 0);
            check_rungs(set, player);
            scree_player_free(player);
        }
        stream_set_free(&memory, set);
        free(set);
    }
    remove_folder(out);
}

/* ---- products ---- */

/* nftw hands no context on. */
static struct {
    const char *from, *to;
    int files, differing;
} compared;

static int compare_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    char other_path[1024], bytes[4096], other_bytes[4096];
    (void)status, (void)walk;
    if (kind != FTW_F) return 0;
    snprintf(other_path, sizeof other_path, "%s%s", compared.to, path + strlen(compared.from));
    FILE *file = fopen(path, "rb"), *other = fopen(other_path, "rb");
    bool same = file != NULL && other != NULL;
    for (size_t count = sizeof bytes; same && count == sizeof bytes;) {
        count = fread(bytes, 1, sizeof bytes, file);
        same = fread(other_bytes, 1, sizeof bytes, other) == count && memcmp(bytes, other_bytes, count) == 0;
    }
    if (file != NULL) fclose(file);
    if (other != NULL) fclose(other);
    compared.files++;
    compared.differing += !same;
    return 0;
}

static void each_product_is_the_same_without_the_other(void) {
    char both[256], terrain[256], stream[256], path[300];
    new_folder(both);
    new_folder(terrain);
    new_folder(stream);
    make_raster(&local_fixture);
    struct build_options options = options_for(PROFILE_LOCAL, both);
    build(&options);
    options.out = terrain;
    options.no_stream = true;
    build(&options);
    options.out = stream;
    options.no_stream = false;
    options.no_terrain = true;
    build(&options);
    snprintf(path, sizeof path, "%s/stream", terrain);
    CU_ASSERT_NOT_EQUAL(access(path, F_OK), 0);
    snprintf(path, sizeof path, "%s/terrain", stream);
    CU_ASSERT_NOT_EQUAL(access(path, F_OK), 0);
    const char *folders[2] = {terrain, stream};
    for (int i = 0; i < 2; i++) {
        memset(&compared, 0, sizeof compared);
        compared.from = folders[i];
        compared.to = both;
        nftw(folders[i], compare_entry, 16, FTW_PHYS);
        CU_ASSERT_EQUAL(compared.files, 10); /* 6, 2 and 1 tiles and the manifest */
        CU_ASSERT_EQUAL(compared.differing, 0);
    }
    remove_folder(stream);
    remove_folder(terrain);
    remove_folder(both);
}

/* ---- memory ---- */

/* One finest tile with its stream, and what it hands up. */
static enum scree_status one_life(const struct tile_plan *plan, struct raster_reader *reader, struct tile_store *store,
                                  struct scree_memory *memory) {
    static struct tile_walk walk;
    struct stream_tile_figures figures;
    struct coarse_tile *coarse = NULL;
    struct scree_error error = {0};
    enum scree_status status = tile_build_finest(plan, (struct tile_id){1, 1, 0}, reader, true, memory, &walk, &error);
    if (status != SCREE_OK) return status;
    status = tile_build_hand_up(plan, &walk, &coarse, &error);
    if (status == SCREE_OK) status = tile_build_write_stream(plan, &walk, store, &figures, &error);
    tile_walk_release(&walk);
    coarse_tile_free(memory, coarse);
    return status;
}

static void lack_of_memory_leaves_nothing_behind(void) {
    struct raster_fixture fixture = local_fixture;
    struct scree_memory memory = {0};
    struct tile_store *store = NULL;
    struct opened opened;
    char out[256];
    new_folder(out);
    fixture.columns = 270;
    fixture.rows = 12;
    make_raster(&fixture);
    const struct raster_options raster = {.inputs = inputs, .input_count = 1, .profile = PROFILE_LOCAL};
    CU_ASSERT_TRUE_FATAL(open_raster(&raster, -1, &opened));
    struct ladder_options ladder_options = {.relief_m = 3000, .largest_height_m = 3000, .finest_octaves = 2};
    struct ladder ladder;
    CU_ASSERT_EQUAL_FATAL(ladder_make(&opened.lattice, &ladder_options, &ladder, NULL), SCREE_OK);
    const struct tile_plan plan = {.lattice = &opened.lattice, .ladder = &ladder};
    CU_ASSERT_EQUAL_FATAL(tile_store_open(out, "stream", "scree", &store, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(one_life(&plan, opened.reader, store, &memory), SCREE_OK);
    CU_ASSERT(memory.requests > 40);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    for (uint64_t n = 1; n <= memory.requests; n++) {
        struct scree_memory failing = {.fail_request = n};
        CU_ASSERT_EQUAL(one_life(&plan, opened.reader, store, &failing), SCREE_E_MEMORY);
        CU_ASSERT_EQUAL(failing.used_bytes, 0);
    }
    tile_store_free(store);
    close_raster(&opened);
    remove_folder(out);
}

/* The width of a step is that of a tile's widest row: of the equator where it is crossed, else of the nearest border.
 */
static void a_tile_is_as_wide_as_its_widest_row(void) {
    struct lattice lattice = lattice_geodetic(3);
    struct ladder ladder = {.height_unit_m = 1};
    const struct tile_plan plan = {.lattice = &lattice, .ladder = &ladder};
    static const struct {
        struct tile_id id;
        double lat_deg;
    } cases[] = {{{0, 0, 0}, 0}, {{0, 1, 0}, 0}, {{1, 3, 1}, 0}, {{1, 0, 0}, 0}, {{2, 5, 3}, 45}, {{2, 5, 0}, -45}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tile_drops drops;
        struct tile_geometry geometry = tile_place_geometry(&plan, cases[i].id, &drops);
        double east_m, north_m;
        lattice_steps_m(&lattice, (cases[i].lat_deg + 90) / lattice.spacing_y, &east_m, &north_m);
        CU_ASSERT_DOUBLE_EQUAL(geometry.east_m, east_m, 1e-6 * east_m);
    }
}

int suite_rungs(void) {
    CU_pSuite suite = CU_add_suite("rungs", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, a_tile_is_as_wide_as_its_widest_row);
    CU_ADD_TEST(suite, rungs_lie_between_zooms);
    CU_ADD_TEST(suite, heights_are_fine_enough_for_the_finest_rung);
    CU_ADD_TEST(suite, a_tile_is_its_children_at_their_coarsest);
    CU_ADD_TEST(suite, every_rung_of_the_finest_zoom_is_as_exact_as_it_says);
    CU_ADD_TEST(suite, each_product_is_the_same_without_the_other);
    CU_ADD_TEST(suite, lack_of_memory_leaves_nothing_behind);
    return 0;
}
