/* TINs cut into tiles: nothing lost, nothing overlapping, both sides of a border the same, and so down all rungs. */
#include "lod/counter_random.h"
#include "lod/tile.h"
#include "lod/tin.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>

enum { TILES = 3 };

/* An island of points in a frame of 3 x 3 tiles, on a lattice of `span` steps a tile. */
struct island {
    struct scree_memory memory;
    struct tin tin;
    struct tin_lattice lattice;
    struct tin_tile tile;
    struct tin_piece pieces[TILES][TILES];
};

static void unit_steps(const void *context, int32_t y, double *east_m, double *north_m) {
    (void)context;
    (void)y;
    *east_m = *north_m = 1;
}

static double height_of(double x, double y) {
    return 30 * sin(6 * x) * cos(5 * y) + 5 * sin(40 * x + 30 * y);
}

/* A point of the unit square around which the island lies, off its corners and with a bay and a lake. */
static bool is_land(double x, double y) {
    double dx = x - 0.5, dy = y - 0.5;
    bool in_lake = hypot(x - 0.42, y - 0.55)<0.05, in_bay = y> 0.75 && fabs(x - 0.5) < 0.06;
    return hypot(dx, dy) < 0.46 && !in_lake && !in_bay;
}

static void scatter(struct island *island, uint32_t count, double longest) {
    struct cloud cloud = {.memory = &island->memory};
    for (uint32_t i = 0, found = 0; found < count; i++) {
        double x = (double)counter_random_below(7, 2 * i, 1U << 30) / (1 << 30);
        double y = (double)counter_random_below(7, 2 * i + 1, 1U << 30) / (1 << 30);
        if (!is_land(x, y)) continue;
        found++;
        CU_ASSERT_EQUAL_FATAL(cloud_add(&cloud, (struct cloud_point){x, y, height_of(x, y)}, NULL), SCREE_OK);
    }
    island->tin.memory = &island->memory;
    CU_ASSERT_EQUAL_FATAL(tin_from_cloud(&cloud, longest, &island->tin, NULL), SCREE_OK);
    cloud_release(&cloud);
}

static struct island *island_new(uint32_t count, int32_t span, double longest) {
    struct island *island = calloc(1, sizeof *island);
    CU_ASSERT_PTR_NOT_NULL_FATAL(island);
    scatter(island, count, longest);
    struct tin_lattice *lattice = &island->lattice;
    *lattice = (struct tin_lattice){.memory = &island->memory,
                                    .point_count = island->tin.point_count,
                                    .triangle_count = island->tin.triangle_count,
                                    .tile_span = span,
                                    .tiles_x = TILES,
                                    .tiles_y = TILES,
                                    .wall_steps = span / 64 > 0 ? span / 64 : 1};
    lattice->points = scree_allocate(&island->memory, lattice->point_count, sizeof *lattice->points, "points", NULL);
    lattice->corners = scree_allocate(&island->memory, 3 * (size_t)lattice->triangle_count, 4, "corners", NULL);
    CU_ASSERT_TRUE_FATAL(lattice->points != NULL && lattice->corners != NULL);
    for (uint32_t p = 0; p < lattice->point_count; p++)
        lattice->points[p] = (struct tin_post){.x = (int32_t)lrint(island->tin.points[p].x * TILES * span),
                                               .y = (int32_t)lrint(island->tin.points[p].y * TILES * span),
                                               .height_m = (float)island->tin.points[p].z};
    for (size_t i = 0; i < 3 * (size_t)lattice->triangle_count; i++) lattice->corners[i] = island->tin.corners[i];
    CU_ASSERT_EQUAL_FATAL(tin_lattice_finish(lattice, unit_steps, NULL, NULL), SCREE_OK);
    island->tile = (struct tin_tile){
        .columns = span, .rows = span, .level_step = span / 4, .wall_steps = lattice->wall_steps, .outside_m = -50};
    for (int32_t row = 0; row < TILES; row++)
        for (int32_t column = 0; column < TILES; column++) {
            struct tin_tile tile = island->tile;
            tile.column = column;
            tile.row = row;
            CU_ASSERT_EQUAL_FATAL(tin_piece_make(&island->memory, lattice, &tile, &island->pieces[row][column], NULL),
                                  SCREE_OK);
        }
    return island;
}

static void island_free(struct island *island) {
    for (int i = 0; i < TILES * TILES; i++) tin_piece_release(&island->memory, &island->pieces[i / TILES][i % TILES]);
    tin_lattice_release(&island->lattice);
    tin_release(&island->tin);
    CU_ASSERT_EQUAL(island->memory.used_bytes, 0);
    free(island);
}

/* ---- the cut ---- */

static int64_t area2_of(const struct tin_piece *piece, uint32_t triangle) {
    const uint32_t *corner = piece->mesh.triangles[triangle].corner;
    return constrained_area2(piece->mesh.points[corner[0]], piece->mesh.points[corner[1]],
                             piece->mesh.points[corner[2]]);
}

static void covers_its_tile(const struct tin_piece *piece, int32_t span) {
    int64_t sum = 0;
    for (uint32_t t = 0; t < piece->mesh.triangle_count; t++) {
        if (piece->mesh.triangles[t].corner[0] == CONSTRAINED_NONE) continue;
        int64_t area = area2_of(piece, t);
        CU_ASSERT(area > 0);
        sum += area;
    }
    CU_ASSERT_EQUAL(sum, 2 * (int64_t)span * span);
}

static void same_side(const struct tin_side *a, const struct tin_side *b, bool is_upright) {
    CU_ASSERT_EQUAL_FATAL(a->count, b->count);
    for (uint32_t i = 0; i < a->count; i++) {
        const struct tin_post *p = &a->posts[i], *q = &b->posts[i];
        CU_ASSERT(is_upright ? p->y == q->y : p->x == q->x);
        CU_ASSERT(p->height_m == q->height_m && p->slope.east == q->slope.east && p->slope.north == q->slope.north);
    }
}

static void pieces_fit(const struct island *island) {
    for (int row = 0; row < TILES; row++)
        for (int column = 0; column < TILES; column++) {
            const struct tin_piece *piece = &island->pieces[row][column];
            covers_its_tile(piece, island->lattice.tile_span);
            if (column + 1 < TILES)
                same_side(&piece->sides[SIDE_EAST], &island->pieces[row][column + 1].sides[SIDE_WEST], true);
            if (row + 1 < TILES)
                same_side(&piece->sides[SIDE_NORTH], &island->pieces[row + 1][column].sides[SIDE_SOUTH], false);
        }
}

/* The number of the mesh's point at a place of the frame; CONSTRAINED_NONE: there is none. */
static uint32_t point_at(const struct tin_piece *piece, int32_t x, int32_t y) {
    for (uint32_t p = 0; p < piece->mesh.point_count; p++)
        if (piece->mesh.points[p].x == x && piece->mesh.points[p].y == y) return p;
    return CONSTRAINED_NONE;
}

static bool has_triangle(const struct tin_piece *piece, const uint32_t wanted[3]) {
    for (uint32_t t = 0; t < piece->mesh.triangle_count; t++)
        for (int turn = 0; turn < 3; turn++) {
            const uint32_t *corner = piece->mesh.triangles[t].corner;
            if (corner[turn] == wanted[0] && corner[(turn + 1) % 3] == wanted[1] && corner[(turn + 2) % 3] == wanted[2])
                return true;
        }
    return false;
}

/* All triangles of the TIN that lie in one tile are there as they are, heights and all; returns how many do. */
static uint32_t triangles_kept(const struct island *island) {
    const struct tin_lattice *lattice = &island->lattice;
    uint32_t inside = 0;
    for (uint32_t t = 0; t < lattice->triangle_count; t++) {
        const struct tin_post *at[3];
        for (int k = 0; k < 3; k++) at[k] = &lattice->points[lattice->corners[3 * (size_t)t + (size_t)k]];
        int32_t column = at[0]->x / lattice->tile_span, row = at[0]->y / lattice->tile_span;
        const struct tin_piece *piece = &island->pieces[row][column];
        uint32_t corner[3];
        bool is_inside = true;
        for (int k = 0; k < 3; k++)
            is_inside = is_inside && at[k]->x / lattice->tile_span == column && at[k]->y / lattice->tile_span == row;
        if (!is_inside) continue;
        inside++;
        for (int k = 0; k < 3; k++) {
            corner[k] = point_at(piece, at[k]->x - column * lattice->tile_span, at[k]->y - row * lattice->tile_span);
            CU_ASSERT_NOT_EQUAL_FATAL(corner[k], CONSTRAINED_NONE);
            CU_ASSERT_EQUAL(piece->posts[corner[k]].height_m, at[k]->height_m);
        }
        CU_ASSERT(has_triangle(piece, corner));
    }
    return inside;
}

static void triangles_are_kept_and_borders_agree(void) {
    struct island *island = island_new(1500, 1 << 20, 0.1);
    pieces_fit(island);
    CU_ASSERT(triangles_kept(island) > island->lattice.triangle_count * 2 / 3);
    island_free(island);
}

/* Rounding so coarse that points meet and triangles turn over: still every tile is covered once. */
static void any_rounding_gives_a_surface(void) {
    for (int32_t span = 16; span <= 256; span *= 2) {
        struct island *island = island_new(1500, span, 0.1);
        pieces_fit(island);
        island_free(island);
    }
}

/* Where the surface ends the ground falls at once: no triangle between it and the level ground is wider than walls. */
static void walls_are_steep(void) {
    struct island *island = island_new(4000, 1 << 20, 0.05);
    double widest = 0;
    for (int i = 0; i < TILES * TILES; i++) {
        const struct tin_piece *piece = &island->pieces[i / TILES][i % TILES];
        for (uint32_t t = 0; t < piece->mesh.triangle_count; t++) {
            const uint32_t *corner = piece->mesh.triangles[t].corner;
            double low = INFINITY, high = -INFINITY, longest = 0;
            for (int k = 0; k < 3; k++) {
                const struct tin_post *a = &piece->posts[corner[k]], *b = &piece->posts[corner[(k + 1) % 3]];
                low = fmin(low, a->height_m);
                high = fmax(high, a->height_m);
                longest = fmax(longest, hypot((double)a->x - b->x, (double)a->y - b->y));
            }
            /* a triangle's least height: how wide the wall is there */
            if (low == -50 && high > -49) widest = fmax(widest, (double)area2_of(piece, t) / longest);
        }
    }
    /* where the outline is ragged feet do not fit so near */
    CU_ASSERT(widest > 0 && widest < 3 * island->lattice.wall_steps);
    island_free(island);
}

/* A tile's corner half a step beside the surface, where rounding may have put it, is on the surface for all four of its
 * tiles: else the ground would rise from there to the next point far away. */
static void corners_beside_the_surface_are_on_it(void) {
    struct scree_memory memory = {0};
    struct tin_lattice lattice = {.memory = &memory,
                                  .point_count = 3,
                                  .triangle_count = 1,
                                  .tile_span = 1024,
                                  .tiles_x = 2,
                                  .tiles_y = 2,
                                  .wall_steps = 16};
    const struct tin_post places[3] = {{.x = 100, .y = 100, .height_m = 50},
                                       {.x = 1948, .y = 100, .height_m = 50},
                                       {.x = 1948, .y = 1947, .height_m = 50}};
    lattice.points = scree_allocate(&memory, 3, sizeof *lattice.points, "points", NULL);
    lattice.corners = scree_allocate(&memory, 3, sizeof *lattice.corners, "corners", NULL);
    CU_ASSERT_TRUE_FATAL(lattice.points != NULL && lattice.corners != NULL);
    for (uint32_t p = 0; p < 3; p++) {
        lattice.points[p] = places[p];
        lattice.corners[p] = p;
    }
    CU_ASSERT_EQUAL_FATAL(tin_lattice_finish(&lattice, unit_steps, NULL, NULL), SCREE_OK);
    for (int32_t i = 0; i < 4; i++) {
        struct tin_tile tile = {i % 2, i / 2, 1024, 1024, 256, 16, -50};
        struct tin_piece piece;
        CU_ASSERT_EQUAL_FATAL(tin_piece_make(&memory, &lattice, &tile, &piece, NULL), SCREE_OK);
        covers_its_tile(&piece, 1024);
        /* the corners of a mesh are numbered counter-clockwise from the south-western one */
        const uint32_t common[4] = {2, 3, 1, 0};
        CU_ASSERT_EQUAL(piece.posts[common[i]].height_m, 50);
        tin_piece_release(&memory, &piece);
    }
    tin_lattice_release(&lattice);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* A point on a side keeps its height, though an edge crosses the side so near that rounding puts it there too. */
static void points_on_sides_keep_their_heights(void) {
    struct scree_memory memory = {0};
    struct tin_lattice lattice = {.memory = &memory, .point_count = 4, .triangle_count = 2, .tile_span = 1024};
    const struct tin_post places[4] = {
        {.x = 0, .y = 0}, {.x = 1024, .y = 500, .height_m = 10}, {.x = 2048, .y = 1001}, {.x = 0, .y = 1001}};
    const uint32_t corners[6] = {0, 2, 3, 0, 1, 2};
    lattice.tiles_x = lattice.tiles_y = 2;
    lattice.wall_steps = 16;
    lattice.points = scree_allocate(&memory, 4, sizeof *lattice.points, "points", NULL);
    lattice.corners = scree_allocate(&memory, 6, sizeof *lattice.corners, "corners", NULL);
    CU_ASSERT_TRUE_FATAL(lattice.points != NULL && lattice.corners != NULL);
    for (int i = 0; i < 4; i++) lattice.points[i] = places[i];
    for (int i = 0; i < 6; i++) lattice.corners[i] = corners[i];
    CU_ASSERT_EQUAL_FATAL(tin_lattice_finish(&lattice, unit_steps, NULL, NULL), SCREE_OK);
    for (int32_t column = 0; column < 2; column++) {
        struct tin_tile tile = {column, 0, 1024, 1024, 256, 16, -50};
        struct tin_piece piece;
        bool is_there = false;
        CU_ASSERT_EQUAL_FATAL(tin_piece_make(&memory, &lattice, &tile, &piece, NULL), SCREE_OK);
        const struct tin_side *side = &piece.sides[column == 0 ? SIDE_EAST : SIDE_WEST];
        for (uint32_t i = 0; i < side->count; i++)
            is_there = is_there || (side->posts[i].y == 500 && side->posts[i].height_m == 10);
        CU_ASSERT(is_there);
        tin_piece_release(&memory, &piece);
    }
    tin_lattice_release(&lattice);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* ---- down the rungs ---- */

static struct tile_geometry geometry_of(int32_t span) {
    return (struct tile_geometry){.columns = span,
                                  .rows = span,
                                  .cell_span = span / 16,
                                  .height_unit_m = 0x1p-8,
                                  .east_m = 0.01,
                                  .north_m = 0.01};
}

/* Both tiles keep the same border at every rung, no error is larger than told, and SVO grows. */
static void tiles_go_down_the_rungs(void) {
    const int32_t span = 1 << 14;
    struct island *island = island_new(2500, span, 0.1);
    struct tile_geometry geometry = geometry_of(span);
    struct tile *tiles = calloc(2, sizeof *tiles);
    CU_ASSERT_PTR_NOT_NULL_FATAL(tiles);
    for (int i = 0; i < 2; i++) {
        CU_ASSERT_EQUAL_FATAL(tile_from_tin(&island->memory, &geometry, &island->pieces[1][i], &tiles[i], NULL),
                              SCREE_OK);
        CU_ASSERT(tile_max_error_m(&tiles[i]) <= 0x1p-9);
        tile_set_codes(&tiles[i], (struct code_frame){span, 0, 0});
    }
    int32_t before = tiles[0].mesh.live_vertices + tiles[1].mesh.live_vertices;
    for (double tolerance_m = 0.05; tolerance_m < 20; tolerance_m *= 1.4142) {
        for (int i = 0; i < 2; i++) {
            CU_ASSERT_EQUAL_FATAL(tile_advance(&tiles[i], tolerance_m, NULL), SCREE_OK);
            CU_ASSERT(tile_max_error_m(&tiles[i]) <= 1.25 * tolerance_m);
        }
        const struct border_line *east = &tiles[0].lines[SIDE_EAST], *west = &tiles[1].lines[SIDE_WEST];
        CU_ASSERT_EQUAL_FATAL(east->vertex_count, west->vertex_count);
        for (int32_t v = 0; v < east->vertex_count; v++) {
            CU_ASSERT_EQUAL(east->vertices[v].position, west->vertices[v].position);
            CU_ASSERT_EQUAL(east->vertices[v].height_m, west->vertices[v].height_m);
        }
        int32_t now = tiles[0].mesh.live_vertices + tiles[1].mesh.live_vertices;
        CU_ASSERT(now <= before);
        before = now;
    }
    CU_ASSERT(before < 200);
    for (int i = 0; i < 2; i++) tile_release(&tiles[i]);
    free(tiles);
    island_free(island);
}

/* ---- up the zooms ---- */

static bool has_sample(const struct samples *samples, int32_t x, int32_t y, float height_m) {
    int64_t cell = (int64_t)(y / samples->cell_span) * samples->columns + x / samples->cell_span;
    for (uint32_t i = samples->cell_first[cell]; i < samples->cell_first[cell + 1]; i++)
        if (samples->extremes[i].x == x && samples->extremes[i].y == y && samples->extremes[i].height_m == height_m)
            return true;
    return false;
}

/* The parent of four tiles is measured at each of their points, and what it leaves depends on how many cells there are
 * above it. */
static void parents_are_measured_at_all_points(void) {
    const int32_t span = 1 << 12;
    struct island *island = island_new(2500, span, 0.1);
    struct tile_geometry geometry = geometry_of(span), above = geometry_of(2 * span);
    struct coarse_tile *children[4], *handed;
    struct tile *tile = calloc(1, sizeof *tile);
    CU_ASSERT_PTR_NOT_NULL_FATAL(tile);
    geometry.keeps_cells = true;
    above.cell_span = geometry.cell_span;
    for (int i = 0; i < 4; i++) {
        const struct tin_piece *piece = &island->pieces[i / 2][i % 2];
        CU_ASSERT_EQUAL_FATAL(tile_from_tin(&island->memory, &geometry, piece, tile, NULL), SCREE_OK);
        tile_set_codes(tile, (struct code_frame){span, 0, 0});
        CU_ASSERT_EQUAL_FATAL(tile_advance(tile, 2, NULL), SCREE_OK);
        CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(tile, &children[i], NULL), SCREE_OK);
        tile_release(tile);
    }
    const struct coarse_tile *const views[4] = {children[0], children[1], children[2], children[3]};
    CU_ASSERT_EQUAL_FATAL(tile_from_children(&island->memory, &above, views, tile, NULL), SCREE_OK);
    CU_ASSERT_PTR_NOT_NULL_FATAL(tile->samples.cell_first);
    for (uint32_t p = 0; p < island->lattice.point_count; p++) {
        const struct tin_post *post = &island->lattice.points[p];
        bool is_inside = post->x < 2 * span && post->y < 2 * span && post->x % span != 0 && post->y % span != 0;
        CU_ASSERT(!is_inside || has_sample(&tile->samples, post->x, post->y, post->height_m));
    }
    CU_ASSERT(tile_max_error_m(tile) <= 2.5);
    tile_set_codes(tile, (struct code_frame){2 * span, 0, 0});
    CU_ASSERT_EQUAL_FATAL(tile_advance(tile, 4, NULL), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(tile_hand_up_new(tile, &handed, NULL), SCREE_OK);
    CU_ASSERT_PTR_NULL(handed->cell_first);
    for (int32_t i = 0; i < handed->cell_columns * handed->cell_rows; i++)
        CU_ASSERT(handed->extremes[2 * i].height_m <= handed->extremes[2 * i + 1].height_m);
    tile_release(tile);
    free(tile);
    coarse_tile_free(&island->memory, handed);
    for (int i = 0; i < 4; i++) coarse_tile_free(&island->memory, children[i]);
    island_free(island);
}

int suite_tin_tiles(void) {
    CU_pSuite suite = CU_add_suite("tiles of TINs", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, triangles_are_kept_and_borders_agree);
    CU_ADD_TEST(suite, any_rounding_gives_a_surface);
    CU_ADD_TEST(suite, walls_are_steep);
    CU_ADD_TEST(suite, corners_beside_the_surface_are_on_it);
    CU_ADD_TEST(suite, points_on_sides_keep_their_heights);
    CU_ADD_TEST(suite, tiles_go_down_the_rungs);
    CU_ADD_TEST(suite, parents_are_measured_at_all_points);
    return 0;
}
