/* Streams as a product: a set passes verify and each promise broken on purpose is found; meshes come out at the scale
 * that was asked for, and tiles of different scales are made to meet. */
#include "src/extract_stitch.h"
#include "src/extract_stream_io.h"
#include "src/stream_cover.h"
#include "src/verify_stream_border.h"
#include "src/verify_stream_family.h"
#include "src/verify_stream_io.h"
#include "tests/small_stream.h"
#include "tests/terrain_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define STEPS SMALL_STREAM_STEPS

/* ---- a set of one tile ---- */

struct made_set {
    struct made_terrain place; /* its folder */
    struct scree_memory memory;
    unsigned char *bytes;
    size_t size_bytes;
    struct scree_stream_header header;
    struct lattice lattice;
    struct stream_manifest manifest;
    struct tile_id root;
    struct stream_zoom zoom;
    double tolerance_m[SCREE_MAX_RUNGS];
};

static void write_bytes(const struct made_set *made, const char *name, const void *bytes, size_t size_bytes) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", made->place.folder, name);
    FILE *file = fopen(path, "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(file);
    CU_ASSERT_EQUAL(fwrite(bytes, 1, size_bytes, file), size_bytes);
    CU_ASSERT_EQUAL(fclose(file), 0);
}

static void write_manifest(const struct made_set *made) {
    char *text = scree_json_new(&made->manifest, NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(text);
    made_terrain_text(&made->place, "scree.json", text);
    free(text);
}

static void read_header(struct made_set *made) {
    struct scree_player *player;
    CU_ASSERT_EQUAL_FATAL(scree_player_new(NULL, &player, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(scree_player_push(player, made->bytes, made->size_bytes, NULL), SCREE_OK);
    made->header = *scree_player_header(player);
    scree_player_free(player);
}

static struct made_set *made_set_new(void) {
    struct made_set *made = calloc(1, sizeof *made);
    made->place = made_terrain_globe(false); /* tiles of the other kind beside it are no matter */
    made->bytes = small_stream_new(&made->memory, &made->size_bytes);
    read_header(made);
    const struct scree_stream_header *header = &made->header;
    CU_ASSERT_EQUAL_FATAL(lattice_local(STEPS + 1, STEPS + 1, header->west, header->south, header->spacing_x,
                                        header->spacing_y, 1, &made->lattice, NULL),
                          SCREE_OK);
    for (uint32_t i = 0; i < header->rung_count; i++) made->tolerance_m[i] = exp2((header->rung_count - 1 - i) / 4.0);
    const struct stream_tile_figures figures = stream_tile_figures_of(header, made->size_bytes);
    stream_zoom_add(&made->zoom, &figures);
    made->zoom.tiles = &made->root;
    made->manifest = (struct stream_manifest){.lattice = &made->lattice,
                                              .height_exponent = header->height_exponent,
                                              .rungs_per_increment = 1,
                                              .first_rung = header->rungs[0].rung,
                                              .rung_count = header->rung_count,
                                              .tolerance_m = made->tolerance_m,
                                              .zooms = &made->zoom};
    write_bytes(made, "0/0/0.scree", made->bytes, made->size_bytes);
    write_manifest(made);
    return made;
}

static void made_set_free(struct made_set *made) {
    made_terrain_remove(&made->place);
    scree_release(&made->memory, made->bytes);
    free(made);
}

/* ---- verify ---- */

/* The promises that the set breaks, as bits. */
static unsigned broken_in(const struct made_set *made, struct verify_report *result) {
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct stream_set *set = calloc(1, sizeof *set);
    struct verify_report *report = calloc(1, sizeof *report);
    unsigned broken = 0;
    enum scree_status status = stream_set_open(&memory, made->place.folder, set, &error);
    if (status == SCREE_OK) status = verify_streams(&memory, set, NULL, NULL, report, &error);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    if (status != SCREE_OK) printf("\n    %s\n", error.text);
    for (int p = 0; p < PROMISE_COUNT; p++) broken |= (unsigned)(report->promises[p].broken != 0) << p;
    if (result != NULL) *result = *report;
    stream_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(report);
    free(set);
    return broken;
}

#define BROKEN(p) (1u << PROMISE_##p)

static void a_good_set_passes(void) {
    struct made_set *made = made_set_new();
    struct verify_report *report = calloc(1, sizeof *report);
    CU_ASSERT_EQUAL(broken_in(made, report), 0);
    CU_ASSERT(made->header.rung_count > 10);
    CU_ASSERT_EQUAL(report->promises[PROMISE_ORIENTATION].checked, made->header.rung_count);
    CU_ASSERT_EQUAL(report->promises[PROMISE_COVER].checked, made->header.rung_count + 2);
    CU_ASSERT_EQUAL(report->promises[PROMISE_STREAM_LISTED].checked, 1);
    CU_ASSERT_EQUAL(report->promises[PROMISE_STREAM_COUNTS].checked, 1);
    CU_ASSERT_EQUAL(report->zooms[0].bytes, made->size_bytes);
    free(report);
    made_set_free(made);
}

static void spoilt_streams_are_found(void) {
    struct made_set *made = made_set_new();
    struct verify_report *report = calloc(1, sizeof *report);
    for (size_t at = 0; at < made->size_bytes; at += 1 + made->size_bytes / 23) {
        made->bytes[at] ^= 0x10;
        write_bytes(made, "0/0/0.scree", made->bytes, made->size_bytes);
        CU_ASSERT_EQUAL(broken_in(made, report), BROKEN(STREAM_FORMAT) | BROKEN(STREAM_COUNTS));
        CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[PROMISE_STREAM_FORMAT].notes[0], "/0/0/0.scree: "));
        made->bytes[at] ^= 0x10;
    }
    for (size_t size = 0; size < made->size_bytes; size += 1 + made->size_bytes / 23) {
        write_bytes(made, "0/0/0.scree", made->bytes, size);
        CU_ASSERT_EQUAL(broken_in(made, report), BROKEN(STREAM_FORMAT) | BROKEN(STREAM_COUNTS));
        CU_ASSERT_PTR_NOT_NULL(strstr(report->promises[PROMISE_STREAM_FORMAT].notes[0], " ends "));
    }
    free(report);
    made_set_free(made);
}

static void wrong_manifests_are_found(void) {
    struct made_set *made = made_set_new();
    const struct made_set good = *made;
    made->manifest.height_exponent++;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_PLACE));
    *made = good;
    made->lattice.west += made->lattice.spacing_x / 2;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_PLACE));
    *made = good;
    made->manifest.first_rung++;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_SCALES));
    *made = good;
    made->zoom.bytes++;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_COUNTS));
    *made = good;
    made->zoom.finest.error_max_m += 1;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_COUNTS));
    *made = good;
    made->zoom.tile_count = 0;
    write_manifest(made);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_LISTED) | BROKEN(STREAM_COUNTS));
    made_set_free(made);
}

static void files_in_wrong_places_are_found(void) {
    struct made_set *made = made_set_new();
    write_bytes(made, "1/0/0.scree", made->bytes, made->size_bytes);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_LISTED) | BROKEN(STREAM_COUNTS));
    made_set_free(made);
    made = made_set_new();
    char path[400];
    snprintf(path, sizeof path, "%s/0/0/0.scree", made->place.folder);
    CU_ASSERT_EQUAL(remove(path), 0);
    CU_ASSERT_EQUAL(broken_in(made, NULL), BROKEN(STREAM_LISTED) | BROKEN(ANCESTORS) | BROKEN(STREAM_COUNTS));
    made_set_free(made);
}

/* ---- borders and families ---- */

static void borders_are_compared_at_common_rungs(void) {
    struct stream_border_vertex vertices[] = {{0, 5, 0}, {4, 6, 2}, {8, 7, 1}, {16, 8, 0}};
    struct stream_border_vertex others[] = {{0, 5, 0}, {4, 6, 2}, {8, 7, 2}, {16, 8, 0}};
    int32_t rungs[] = {0, 1, 2}, few[] = {0, 2, 3};
    struct stream_border one = {4, 3, vertices, rungs}, other = {4, 3, others, rungs};
    struct stream_border_difference difference = stream_border_compare(&one, &one);
    CU_ASSERT_EQUAL(difference.rungs, 3);
    CU_ASSERT_EQUAL(difference.lone_vertices, 0);
    difference = stream_border_compare(&one, &other); /* the vertex at 8 comes later in one of them */
    CU_ASSERT_EQUAL(difference.lone_vertices, 1);
    CU_ASSERT_EQUAL(difference.rung, 1);
    other.rungs = few; /* which is no matter where rung 1 is not there */
    difference = stream_border_compare(&one, &other);
    CU_ASSERT_EQUAL(difference.rungs, 2);
    CU_ASSERT_EQUAL(difference.lone_vertices, 0);
    others[3].height++;
    difference = stream_border_compare(&other, &one);
    CU_ASSERT_EQUAL(difference.lone_vertices, 1);
    CU_ASSERT_EQUAL(difference.rung, 0);
}

static void families_are_compared_as_sets(void) {
    struct scree_memory memory = {0};
    struct scree_vertex vertices[] = {{0, 0, 1}, {4, 0, 2}, {0, 4, 3}, {4, 4, 4}, {8, 4, 5}};
    struct scree_vertex moved[] = {{4, 4, 4}, {0, 4, 3}, {4, 0, 2}, {0, 0, 1}};
    const uint32_t indices[] = {0, 1, 2, 2, 1, 3, 1, 4, 3}, turned[] = {0, 1, 2, 2, 1, 3};
    const struct scree_arrays whole = {
        .vertex_count = 5, .triangle_count = 3, .indices = indices, .vertices = vertices};
    struct scree_arrays part = {.vertex_count = 4, .triangle_count = 2, .indices = turned, .vertices = moved};
    const struct lattice_window left = {0, 0, 4, 4}, narrow = {0, 0, 3, 4};
    struct family_part one, other;
    CU_ASSERT_EQUAL_FATAL(family_part_new(&memory, &whole, 0, 0, &left, &one, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(one.count, 2);
    CU_ASSERT_EQUAL(one.crossing, 0);
    CU_ASSERT_EQUAL_FATAL(family_part_new(&memory, &part, 0, 0, &left, &other, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(family_part_compare(&one, &other), 0); /* other numbers, other order, the same triangles */
    family_part_free(&memory, &other);
    moved[1].height++; /* a corner of both triangles */
    CU_ASSERT_EQUAL_FATAL(family_part_new(&memory, &part, 0, 0, &left, &other, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(family_part_compare(&one, &other), 4);
    family_part_free(&memory, &other);
    family_part_free(&memory, &one);
    CU_ASSERT_EQUAL_FATAL(family_part_new(&memory, &whole, 0, 0, &narrow, &one, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(one.count, 0);
    CU_ASSERT_EQUAL(one.crossing, 2);
    family_part_free(&memory, &one);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- extract ---- */

static void meshes_come_at_the_scale_that_was_asked_for(void) {
    struct made_set *made = made_set_new();
    struct scree_memory memory = {0};
    struct stream_set *set = calloc(1, sizeof *set);
    CU_ASSERT_EQUAL_FATAL(stream_set_open(&memory, made->place.folder, set, NULL), SCREE_OK);
    for (uint32_t i = 0; i < made->header.rung_count; i++) {
        const struct scree_rung *rung = &made->header.rungs[i];
        const struct scale_wish wishes[] = {{.kind = SCALE_RUNG, .rung = rung->rung},
                                            {.kind = SCALE_SVO, .bound_m = rung->svo_m},
                                            {.kind = SCALE_ERROR, .bound_m = rung->max_error_m}};
        for (int k = 0; k < 3; k++) {
            struct stream_extract extract = {0};
            CU_ASSERT_EQUAL_FATAL(extract_stream_set(&memory, set, &wishes[k], NULL, &extract, NULL), SCREE_OK);
            if (k == 0) CU_ASSERT_EQUAL(extract.rung, rung->rung);
            CU_ASSERT(extract.rung <= rung->rung); /* a coarser one may be as good */
            CU_ASSERT(k != 1 || extract.svo_m <= rung->svo_m);
            CU_ASSERT(k != 2 || extract.max_error_m <= rung->max_error_m);
            const struct scree_rung *got = &made->header.rungs[extract.rung - made->header.rungs[0].rung];
            CU_ASSERT_EQUAL(extract.mesh.vertex_count, got->vertex_count);
            CU_ASSERT_EQUAL(extract.mesh.triangle_count, got->triangle_count);
            CU_ASSERT_EQUAL(extract.middle[0], made->header.west + STEPS / 2 * made->header.spacing_x);
            stream_extract_free(&memory, &extract);
        }
    }
    stream_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(set);
    made_set_free(made);
}

static void a_file_by_itself_is_the_same(void) {
    struct made_set *made = made_set_new();
    struct scree_memory memory = {0};
    const struct scale_wish finest = {.kind = SCALE_FINEST};
    struct stream_extract of_set = {0}, of_file = {0};
    struct stream_set *set = calloc(1, sizeof *set);
    char path[400];
    snprintf(path, sizeof path, "%s/0/0/0.scree", made->place.folder);
    CU_ASSERT_EQUAL_FATAL(stream_set_open(&memory, made->place.folder, set, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(extract_stream_set(&memory, set, &finest, &made->root, &of_set, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(extract_stream_file(&memory, path, &finest, &of_file, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(extract_mesh_place(&memory, &of_set.mesh, NULL, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(extract_mesh_place(&memory, &of_file.mesh, NULL, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(of_set.mesh.vertex_count, of_file.mesh.vertex_count);
    CU_ASSERT_EQUAL(memcmp(of_set.mesh.xyz, of_file.mesh.xyz, 24 * (size_t)of_set.mesh.vertex_count), 0);
    CU_ASSERT_EQUAL(of_set.middle[1], of_file.middle[1]);
    stream_extract_free(&memory, &of_file);
    stream_extract_free(&memory, &of_set);
    stream_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(set);
    made_set_free(made);
}

static void what_is_not_there_is_refused(void) {
    struct made_set *made = made_set_new();
    struct scree_memory memory = {0};
    struct stream_set *set = calloc(1, sizeof *set);
    const struct scale_wish wishes[] = {{.kind = SCALE_RUNG, .rung = 1}, {.kind = SCALE_SVO}, {.kind = SCALE_ERROR}};
    const struct scale_wish finest = {.kind = SCALE_FINEST};
    const struct tile_id elsewhere = {.zoom = 0, .x = 1};
    CU_ASSERT_EQUAL_FATAL(stream_set_open(&memory, made->place.folder, set, NULL), SCREE_OK);
    for (int k = 0; k < 3; k++)
        for (int alone = 0; alone < 2; alone++) {
            struct stream_extract extract = {0};
            struct scree_error error = {0};
            CU_ASSERT_EQUAL(
                extract_stream_set(&memory, set, &wishes[k], alone == 0 ? NULL : &made->root, &extract, &error),
                SCREE_E_ARGUMENT);
            CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "no rung"));
            stream_extract_free(&memory, &extract);
        }
    struct stream_extract extract = {0};
    CU_ASSERT_EQUAL(extract_stream_set(&memory, set, &finest, &elsewhere, &extract, NULL), SCREE_E_ARGUMENT);
    stream_extract_free(&memory, &extract);
    stream_set_free(&memory, set);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    free(set);
    made_set_free(made);
}

/* ---- covers and stitches ---- */

static void covers_show_each_place_once(void) {
    struct scree_memory memory = {0};
    struct lattice lattice = lattice_geodetic(2);
    struct tile_list tiles[MAX_ZOOM + 1] = {{0}};
    struct stream_cover cover;
    const struct tile_id ids[] = {{0, 0, 0}, {0, 1, 0}, {1, 2, 0}, {1, 3, 1}, {2, 5, 1}, {2, 7, 3}};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        CU_ASSERT_EQUAL_FATAL(tile_list_add(&memory, &tiles[ids[i].zoom], ids[i], NULL), SCREE_OK);
    for (int zoom = 0; zoom <= 2; zoom++) {
        int64_t area = 0;
        CU_ASSERT_EQUAL_FATAL(stream_cover_new(&memory, &lattice, tiles, 0, zoom, &cover, NULL), SCREE_OK);
        for (uint32_t i = 0; i < cover.count; i++) {
            const struct lattice_window *a = &cover.pieces[i].window;
            area += (int64_t)a->columns * a->rows;
            for (uint32_t j = 0; j < i; j++) {
                const struct lattice_window *b = &cover.pieces[j].window;
                CU_ASSERT(a->x >= b->x + b->columns || b->x >= a->x + a->columns || a->y >= b->y + b->rows ||
                          b->y >= a->y + a->rows);
            }
        }
        CU_ASSERT_EQUAL(area, 2048 * 1024);
        stream_cover_free(&memory, &cover);
    }
    for (int zoom = 0; zoom <= 2; zoom++) tile_list_free(&memory, &tiles[zoom]);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* A square of `side` steps at (x, y) as a grid of `cells` x `cells`. */
static void add_grid(struct scree_memory *memory, struct extract_mesh *mesh, int64_t x, int64_t y, int32_t side,
                     int32_t cells) {
    struct scree_vertex vertices[81];
    uint32_t corners[6 * 64], triangles = 0;
    for (int32_t i = 0; i <= cells; i++)
        for (int32_t j = 0; j <= cells; j++)
            vertices[i * (cells + 1) + j] = (struct scree_vertex){j * side / cells, i * side / cells, 3};
    for (int32_t i = 0; i < cells; i++)
        for (int32_t j = 0; j < cells; j++) {
            uint32_t a = (uint32_t)(i * (cells + 1) + j), b = a + 1, c = a + (uint32_t)cells + 1, d = c + 1;
            memcpy(&corners[3 * triangles], (uint32_t[]){a, b, d, a, d, c}, 6 * sizeof *corners);
            triangles += 2;
        }
    const struct extract_posts posts = {.x = x,
                                        .y = y,
                                        .vertex_count = (uint32_t)((cells + 1) * (cells + 1)),
                                        .triangle_count = triangles,
                                        .vertices = vertices,
                                        .corners = corners,
                                        .height_unit_m = 0.5};
    CU_ASSERT_EQUAL(extract_mesh_add_posts(memory, mesh, &posts, NULL), SCREE_OK);
}

/* Open edges of the mesh, and twice its area, which no triangle takes away from. */
static uint32_t open_edges(const struct extract_mesh *mesh, int64_t around, int64_t *area) {
    uint32_t open = 0, count = 3 * mesh->triangle_count;
    *area = 0;
    for (uint32_t e = 0; e < count; e++) {
        uint32_t a = mesh->corners[e], b = mesh->corners[e % 3 == 2 ? e - 2 : e + 1], opposites = 0;
        for (uint32_t f = 0; f < count; f++)
            opposites += mesh->corners[f] == b && mesh->corners[f % 3 == 2 ? f - 2 : f + 1] == a;
        open += opposites == 0;
        CU_ASSERT(opposites < 2);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        int64_t x[3], y[3];
        bool is_far = false;
        for (int k = 0; k < 3; k++) {
            x[k] = mesh->vertices[mesh->corners[3 * t + (uint32_t)k]].x;
            y[k] = mesh->vertices[mesh->corners[3 * t + (uint32_t)k]].y;
            is_far = is_far || x[k] > around / 2;
        }
        for (int k = 0; k < 3; k++)
            if (around != 0 && is_far && x[k] == 0) x[k] = around;
        int64_t part = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        CU_ASSERT(part > 0);
        *area += part;
    }
    return open;
}

/* Squares of 8 steps at all kinds of scales, side by side. */
static void tiles_of_different_scales_are_made_to_meet(void) {
    static const int32_t cells[3][3] = {{1, 8, 2}, {4, 1, 1}, {8, 2, 8}};
    struct lattice lattice;
    struct scree_memory memory = {0};
    uint32_t stitched;
    int64_t area;
    CU_ASSERT_EQUAL_FATAL(lattice_local(25, 25, 0, 0, 1, 1, 1, &lattice, NULL), SCREE_OK);
    struct extract_mesh mesh = {.lattice = &lattice, .in_posts = true};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) add_grid(&memory, &mesh, 8 * j, 8 * i, 8, cells[i][j]);
    CU_ASSERT_EQUAL(extract_mesh_stitch(&memory, &mesh, &stitched, NULL), SCREE_OK);
    CU_ASSERT(stitched >= 10);
    CU_ASSERT_EQUAL(open_edges(&mesh, 0, &area), 1 + 8 + 2 + 2 + 1 + 8 + 8 + 2 + 8 + 8 + 4 + 1); /* around the whole */
    CU_ASSERT_EQUAL(area, 2 * 24 * 24);
    extract_mesh_free(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void and_around_the_globe(void) {
    struct lattice lattice = lattice_geodetic(0);
    struct scree_memory memory = {0};
    struct extract_mesh mesh = {.lattice = &lattice, .in_posts = true};
    uint32_t stitched;
    int64_t area;
    for (int x = 0; x < 64; x++) add_grid(&memory, &mesh, 8 * x, 64, 8, x == 0 ? 8 : 1);
    CU_ASSERT_EQUAL(extract_mesh_stitch(&memory, &mesh, &stitched, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(stitched, 2);
    CU_ASSERT_EQUAL(open_edges(&mesh, 512, &area), 2 * (63 + 8));
    CU_ASSERT_EQUAL(area, 2 * 512 * 8);
    extract_mesh_free(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void stitching_tells_of_want_of_memory(void) {
    struct lattice lattice = lattice_geodetic(0);
    bool done = false;
    for (uint64_t request = 1; !done && request < 20; request++) {
        struct scree_memory memory = {0};
        struct extract_mesh mesh = {.lattice = &lattice, .in_posts = true};
        uint32_t stitched;
        for (int x = 0; x < 2; x++) add_grid(&memory, &mesh, 8 * x, 64, 8, x == 0 ? 8 : 1);
        memory.fail_request = memory.requests + request;
        enum scree_status status = extract_mesh_stitch(&memory, &mesh, &stitched, NULL);
        done = status == SCREE_OK;
        CU_ASSERT(done || status == SCREE_E_MEMORY);
        CU_ASSERT(done || request < 10);
        extract_mesh_free(&memory, &mesh);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_TRUE(done);
}

int suite_stream_product(void) {
    CU_pSuite suite = CU_add_suite("stream_product", NULL, NULL);
    if (suite == NULL) return 1;
    static const struct {
        const char *name;
        CU_TestFunc run;
    } tests[] = {
        {"a good set passes", a_good_set_passes},
        {"spoilt streams are found", spoilt_streams_are_found},
        {"wrong manifests are found", wrong_manifests_are_found},
        {"files in wrong places are found", files_in_wrong_places_are_found},
        {"borders are compared at common rungs", borders_are_compared_at_common_rungs},
        {"families are compared as sets", families_are_compared_as_sets},
        {"meshes come at the scale that was asked for", meshes_come_at_the_scale_that_was_asked_for},
        {"a file by itself is the same", a_file_by_itself_is_the_same},
        {"what is not there is refused", what_is_not_there_is_refused},
        {"covers show each place once", covers_show_each_place_once},
        {"tiles of different scales are made to meet", tiles_of_different_scales_are_made_to_meet},
        {"and around the globe", and_around_the_globe},
        {"stitching tells of want of memory", stitching_tells_of_want_of_memory},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (CU_add_test(suite, tests[i].name, tests[i].run) == NULL) return 1;
    return 0;
}
