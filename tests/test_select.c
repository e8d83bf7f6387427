/* Selection: what is drawn is exact enough, covers what is seen, keeps budgets, and comes closer to what is wanted with
 * every tile that arrives. */
#include "stream/tile_box.h"
#include "tests/cut_maker.h"
#include "tests/scene_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Large: the one that a test works on, and one to compare with. */
static struct scene scene, other;

static double any(uint64_t *state, double low, double high) {
    return low + (high - low) * cut_number(state, 1 << 30) / (1 << 30);
}

/* Terrain that is deep around a random place (which is told), on the globe or not. */
static void any_scene(uint64_t *state, double place[2]) {
    enum scree_profile profile = cut_number(state, 2) == 0 ? SCREE_GEODETIC : SCREE_LOCAL;
    place[0] = any(state, 0, profile == SCREE_GEODETIC ? 2 : 0.95);
    place[1] = any(state, 0.02, profile == SCREE_GEODETIC ? 0.98 : 0.74);
    scene_make(&scene, profile, 2 + cut_number(state, 2), 9, place[0], place[1], any(state, 0, 9000));
}

/* A camera somewhere above the deep place, looking somewhere near. */
static struct scene_camera any_camera(uint64_t *state, const double place[2]) {
    bool geodetic = scene.terrain.profile == SCREE_GEODETIC;
    double height_m = exp2(any(state, 4, geodetic ? 25 : 20)), reach = height_m / (geodetic ? 2e7 : 4e6);
    struct scene_camera camera = {.orthogonal = cut_number(state, 3) == 0,
                                  .height = exp2(any(state, -7, 1)),
                                  .width_px = any(state, 100, 2000),
                                  .height_px = any(state, 100, 1200),
                                  .shift = cut_number(state, 3) == 0 ? any(state, -0.7, 0.7) : 0,
                                  .stretch = cut_number(state, 2) * any(state, -0.5, 1),
                                  .depth = (enum scree_depth)cut_number(state, 3)};
    if (camera.orthogonal) camera.height = 2 * height_m;
    scene_place(&scene, place[0], place[1], height_m, camera.eye);
    scene_place(&scene, place[0] + any(state, -reach, reach), place[1] + any(state, -reach, reach) / 2,
                any(state, 0, scene.terrain.highest_m), camera.target);
    return camera;
}

static struct scree_view view_of(const struct scene_camera *camera, double matrix[16]) {
    struct scree_view view;
    struct scree_error error = {0};
    scene_matrix(camera, matrix);
    if (scree_view_of_matrix(matrix, camera->depth, camera->width_px, camera->height_px, &view, &error) != SCREE_OK)
        CU_FAIL(error.text);
    return view;
}

static void link_scene(struct scene *of) {
    struct scree_error error = {0};
    if (scree_select_link(&of->terrain, of->tiles, of->tile_count, &error) != SCREE_OK) CU_FAIL(error.text);
}

static void choose(struct scene *of, const struct scree_view *view, const struct scree_select_options *options) {
    CU_ASSERT_EQUAL(scree_select(&of->terrain, of->tiles, of->tile_count, view, options, &of->selection, NULL),
                    SCREE_OK);
}

/* Whether the lowered globe stands between the eye and a place: in a world scaled to make it a ball. */
static bool is_hidden(const double eye[3], const double place[3]) {
    static const double radius_m[3] = {6378137.0, 6378137.0, 6356752.314245179};
    double ray[3], from[3], rr = 0, rf = 0;
    for (int i = 0; i < 3; i++) {
        from[i] = eye[i] / radius_m[i];
        ray[i] = place[i] / radius_m[i] - from[i];
        rr += ray[i] * ray[i];
        rf -= ray[i] * from[i];
    }
    double share = fmin(fmax(rf / rr, 0), 1), nearest = 0;
    for (int i = 0; i < 3; i++) nearest += (from[i] + share * ray[i]) * (from[i] + share * ray[i]);
    return nearest < 1;
}

/* A place of the terrain, most often near the deep one, at a height of the finest tile there. */
static void any_place(uint64_t *state, const double deep[2], double at[2], double place[3]) {
    double reach = exp2(-cut_number(state, 14)), high_m = scene.terrain.highest_m, low_m = 0;
    double steps = ldexp(256, scene.terrain.finest_zoom);
    bool geodetic = scene.terrain.profile == SCREE_GEODETIC;
    double right = geodetic ? 2 : (double)scene.terrain.columns / steps,
           top = geodetic ? 1 : (double)scene.terrain.rows / steps;
    at[0] = fmin(fmax(deep[0] + any(state, -reach, reach), 0), right * (1 - 1e-9));
    at[1] = fmin(fmax(deep[1] + any(state, -reach, reach), 0), top * (1 - 1e-9));
    for (uint32_t t = 0; t < scene.tile_count; t++) {
        const struct scree_select_tile *tile = &scene.tiles[t];
        if (floor(ldexp(at[0], tile->id.zoom)) != tile->id.x || floor(ldexp(at[1], tile->id.zoom)) != tile->id.y)
            continue;
        low_m = fmax(low_m, tile->lowest_m);
        high_m = fmin(high_m, tile->highest_m);
    }
    scene_place(&scene, at[0], at[1], any(state, low_m, high_m), place);
}

/* Nothing on the screen is left out, and what is drawn there is as exact as was asked for. */
static void what_is_seen_is_drawn_and_exact(void) {
    uint64_t state = 11;
    long seen_places = 0, refined = 0;
    for (int n = 0; n < 400; n++) {
        double deep[2], matrix[16];
        any_scene(&state, deep);
        link_scene(&scene);
        struct scene_camera camera = any_camera(&state, deep);
        struct scree_view view = view_of(&camera, matrix);
        struct scree_select_options options = {.measure = (enum scree_measure)cut_number(&state, 2),
                                               .tolerance_px = exp2(any(&state, -1, 5))};
        choose(&scene, &view, &options);
        CU_ASSERT_EQUAL(scene.selection.wanted_count, 0);
        CU_ASSERT_EQUAL(scene.selection.tolerance_px, options.tolerance_px);
        for (int i = 0; i < 200; i++) {
            double at[2], place[3], pixels[2], moved_to[2], moved[3];
            any_place(&state, deep, at, place);
            if (!scene_project(&camera, matrix, place, pixels) || fabs(pixels[0]) > camera.width_px / 2 ||
                fabs(pixels[1]) > camera.height_px / 2)
                continue;
            if (scene.terrain.profile == SCREE_GEODETIC && !camera.orthogonal && is_hidden(camera.eye, place)) continue;
            uint32_t found = scene_drawn_at(&scene, at[0], at[1]);
            CU_ASSERT_NOT_EQUAL_FATAL(found, UINT32_MAX);
            seen_places++;
            const struct scree_select_tile *tile = &scene.tiles[scene.drawn[found].tile];
            const struct scree_rung *rung = &tile->header->rungs[scene.drawn[found].rung];
            bool as_fine_as_there_is =
                tile->child_count == 0 && scene.drawn[found].rung + 1 == tile->header->rung_count;
            if (as_fine_as_there_is) continue;
            refined += scene.drawn[found].error_px > options.tolerance_px / 1.2;
            CU_ASSERT(scene.drawn[found].error_px <= options.tolerance_px);
            if (options.measure == SCREE_BY_SVO) continue;
            double length = 0, share = 1e-4; /* of the error, in any direction */
            for (int k = 0; k < 3; k++) {
                moved[k] = any(&state, -1, 1);
                length += moved[k] * moved[k];
            }
            for (int k = 0; k < 3; k++) moved[k] = place[k] + moved[k] / sqrt(length) * share * rung->max_error_m;
            scene_project(&camera, matrix, moved, moved_to);
            CU_ASSERT(hypot(moved_to[0] - pixels[0], moved_to[1] - pixels[1]) <=
                      1.001 * share * options.tolerance_px + 1e-6);
        }
    }
    CU_ASSERT(seen_places > 10000);
    CU_ASSERT(refined > 1000); /* and not more exact than that */
}

/* Places of tiles of all sizes lie in their boxes, and come close to each of the six sides. */
static void boxes_hold_their_tiles(void) {
    uint64_t state = 17;
    scene_make(&scene, SCREE_GEODETIC, 0, 0, 0, 0, 0);
    for (int n = 0; n < 300; n++) {
        struct scree_tile_id id = {.zoom = n % 15};
        id.x = (uint32_t)cut_number(&state, 2 << id.zoom);
        id.y = (uint32_t)cut_number(&state, 1 << id.zoom);
        double low_m = any(&state, -9000, 3000), high_m = any(&state, low_m, 9000), closest[2][3] = {{0}};
        struct tile_box box = tile_box_of(&scene.terrain, &id, low_m, high_m);
        for (int i = 0; i < 3 * 3 * 3 + 100; i++) { /* corners and middles, then any places */
            double share[3], place[3];
            for (int k = 0; k < 3; k++) share[k] = i < 27 ? (i / (int[]){1, 3, 9}[k]) % 3 / 2.0 : any(&state, 0, 1);
            scene_place(&scene, ldexp(id.x + share[0], -id.zoom), ldexp(id.y + share[1], -id.zoom),
                        low_m + share[2] * (high_m - low_m), place);
            struct vector3 from = vector3_minus((struct vector3){place[0], place[1], place[2]}, box.centre);
            for (int k = 0; k < 3; k++) {
                double along = vector3_dot(from, box.axes[k]) / box.half_m[k];
                CU_ASSERT(fabs(along) <= 1);
                closest[0][k] = fmin(closest[0][k], along);
                closest[1][k] = fmax(closest[1][k], along);
            }
        }
        for (int k = 0; k < 3; k++) CU_ASSERT(closest[0][k] < -0.999 && closest[1][k] > 0.999);
    }
}

/* What the globe hides and what lies beyond the planes of the view is not drawn. */
static void what_cannot_be_seen_is_left_out(void) {
    struct scene_camera camera = {.height = 1, .width_px = 1000, .height_px = 1000};
    struct scree_select_options options = {.tolerance_px = 1e-3};
    double matrix[16];
    struct scree_view view;
    scene_make(&scene, SCREE_GEODETIC, 4, 4, 0.3, 0.4, 9000);
    link_scene(&scene);
    scene_place(&scene, 0.3, 0.6, 2e7, camera.eye);
    view = view_of(&camera, matrix); /* to the middle of the Earth */
    choose(&scene, &view, &options);
    CU_ASSERT_NOT_EQUAL(scene_drawn_at(&scene, 0.3, 0.6), UINT32_MAX);
    CU_ASSERT_EQUAL(scene_drawn_at(&scene, 1.3, 0.4), UINT32_MAX); /* the antipodes */
    CU_ASSERT(scene.selection.drawn_count < 300);                  /* of 512 */
    scene_make(&scene, SCREE_LOCAL, 2, 2, 0.3, 0.4, 100);
    link_scene(&scene);
    for (int orthogonal = 0; orthogonal < 2; orthogonal++)
        for (int depth = 0; depth < 3; depth++)
            for (int far = 0; far < 3; far++) { /* behind the far plane, between both, before the near plane */
                camera.orthogonal = orthogonal;
                camera.height = orthogonal ? 1e5 : 1e-3;
                camera.depth = (enum scree_depth)depth;
                scene_place(&scene, 0.3, 0.4, (double[]){2e8, 5e7, -1000}[far], camera.eye);
                scene_place(&scene, 0.3, 0.4, (double[]){0, 0, -2000}[far], camera.target);
                view = view_of(&camera, matrix);
                choose(&scene, &view, NULL);
                bool seen = far == 1 || (far == 0 && depth == SCREE_DEPTH_ZERO && !orthogonal) ||
                            (depth == SCREE_DEPTH_ANY && (far == 0 || orthogonal));
                CU_ASSERT_EQUAL(scene.selection.drawn_count > 0, seen);
            }
}

/* From far away through a narrow angle up to orthogonal, at the same metres a pixel. */
static void orthogonal_views_choose_what_perspective_ones_do(void) {
    static const double angles[] = {0.5, 0.2, 0.05, 1e-3, 1e-6};
    uint64_t state = 5;
    scene_make(&scene, SCREE_LOCAL, 3, 9, 0.4, 0.3, 300);
    scene_make(&other, SCREE_LOCAL, 3, 9, 0.4, 0.3, 300);
    link_scene(&scene);
    link_scene(&other);
    int compared = 0;
    for (int n = 0; n < 200; n++) {
        double matrix[16], height_m = exp2(any(&state, 14, 22)), angle = angles[n % 5], place[3], pixels[2];
        struct scree_select_options options = {.measure = (enum scree_measure)(n % 2), .tolerance_px = 2};
        struct scene_camera camera = {.orthogonal = true, .height = height_m, .width_px = 800, .height_px = 800};
        scene_place(&scene, 0.4, 0.3, 1e5, camera.eye);
        scene_place(&scene, 0.4, 0.3, 0, camera.target);
        struct scree_view view = view_of(&camera, matrix);
        choose(&scene, &view, &options);
        camera.orthogonal = false;
        camera.height = angle;
        scene_place(&scene, 0.4, 0.3, height_m / 2 / tan(angle / 2), camera.eye);
        view = view_of(&camera, matrix);
        choose(&other, &view, &options);
        for (int i = 0; i < 30; i++) {
            double x = 0.4 + any(&state, -1, 1) * exp2(-cut_number(&state, 12)), y = any(&state, 0.2, 0.4);
            scene_place(&scene, x, y, 0, place);
            uint32_t here = scene_drawn_at(&scene, x, y), there = scene_drawn_at(&other, x, y);
            if (!scene_project(&camera, matrix, place, pixels) || here == UINT32_MAX || there == UINT32_MAX) continue;
            if (fabs(pixels[0]) > 400 || fabs(pixels[1]) > 400) continue;
            int32_t rung = scene.tiles[scene.drawn[here].tile].header->rungs[scene.drawn[here].rung].rung;
            int32_t rung_there = other.tiles[other.drawn[there].tile].header->rungs[other.drawn[there].rung].rung;
            CU_ASSERT(abs(rung - rung_there) <= 1);
            compared++;
        }
    }
    CU_ASSERT(compared > 1000);
}

/* The ladder's rung of what is drawn at the deep place, as a continuous scale. */
static double scale_at(const struct scene *of, double x, double y) {
    uint32_t found = scene_drawn_at(of, x, y);
    CU_ASSERT_NOT_EQUAL_FATAL(found, UINT32_MAX);
    const struct scree_select_drawn *drawn = &of->drawn[found];
    CU_ASSERT(drawn->level > (double)drawn->rung - 1 && drawn->level <= drawn->rung);
    return of->tiles[drawn->tile].header->rungs[0].rung + drawn->level;
}

static void scale_falls_with_tolerance_and_distance(void) {
    uint64_t state = 3;
    for (int n = 0; n < 100; n++) {
        double deep[2], matrix[16], eye[3], scale = INFINITY;
        uint64_t triangles = UINT64_MAX;
        any_scene(&state, deep);
        link_scene(&scene);
        struct scene_camera camera = any_camera(&state, deep);
        struct scree_view view = view_of(&camera, matrix);
        for (double tolerance_px = 0.1; tolerance_px < 1e4; tolerance_px *= 1.13) {
            struct scree_select_options options = {.tolerance_px = tolerance_px};
            choose(&scene, &view, &options);
            if (scene_drawn_at(&scene, deep[0], deep[1]) == UINT32_MAX)
                continue; /* the deep place may be out of sight */
            CU_ASSERT(scale_at(&scene, deep[0], deep[1]) <= scale);
            scale = scale_at(&scene, deep[0], deep[1]);
        }
        scene_place(&scene, deep[0], deep[1], 500, eye); /* all around nothing is culled */
        CU_ASSERT_EQUAL(scree_view_of_eye(eye, 1, 1000, &view, NULL), SCREE_OK);
        for (double tolerance_px = 0.1; tolerance_px < 1e4; tolerance_px *= 1.13) {
            struct scree_select_options options = {.tolerance_px = tolerance_px};
            choose(&scene, &view, &options);
            CU_ASSERT(scene.terrain.profile == SCREE_LOCAL || scene.selection.triangles <= triangles); /* cut tiles */
            triangles = scene.selection.triangles;
        }
        scale = INFINITY;
        for (double height_m = 10; height_m < 3e7; height_m *= 1.13) {
            scene_place(&scene, deep[0], deep[1], scene.terrain.highest_m + height_m, eye);
            CU_ASSERT_EQUAL(scree_view_of_eye(eye, 1, 1000, &view, NULL), SCREE_OK);
            choose(&scene, &view, NULL);
            CU_ASSERT(scale_at(&scene, deep[0], deep[1]) <= scale);
            scale = scale_at(&scene, deep[0], deep[1]);
        }
        CU_ASSERT_EQUAL(scale, -4); /* the base of a root */
    }
}

static uint64_t bytes_drawn(void) {
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene.selection.drawn_count; i++) {
        const struct scree_rung *rung = &scene.tiles[scene.drawn[i].tile].header->rungs[scene.drawn[i].rung];
        bytes += rung->offset_bytes + rung->size_bytes;
    }
    return bytes;
}

static void budgets_hold_and_are_used(void) {
    uint64_t state = 8;
    int raised = 0;
    for (int n = 0; n < 200; n++) {
        double deep[2], matrix[16];
        any_scene(&state, deep);
        link_scene(&scene);
        struct scene_camera camera = any_camera(&state, deep);
        struct scree_view view = view_of(&camera, matrix);
        struct scree_select_options free = {.measure = (enum scree_measure)(n % 2)}, bound = free, least = free;
        choose(&scene, &view, &free);
        uint64_t triangles = scene.selection.triangles, bytes = bytes_drawn();
        least.triangle_budget = 1;
        choose(&scene, &view, &least); /* cannot be kept: the roots' base meshes */
        CU_ASSERT(scene.selection.drawn_count <= 2);
        for (uint32_t i = 0; i < scene.selection.drawn_count; i++) CU_ASSERT_EQUAL(scene.drawn[i].level, 0);
        if (n % 4 < 2)
            bound.triangle_budget = 600 + (uint64_t)any(&state, 0, (double)triangles);
        else
            bound.byte_budget = 2 * 400 + 600 * 3 + (uint64_t)any(&state, 0, (double)bytes);
        choose(&scene, &view, &bound);
        CU_ASSERT(bound.triangle_budget == 0 || scene.selection.triangles <= bound.triangle_budget);
        CU_ASSERT(bound.byte_budget == 0 || bytes_drawn() <= bound.byte_budget);
        double raised_px = scene.selection.tolerance_px;
        for (uint32_t t = 0; t < scene.tile_count; t++) scene.tiles[t].rungs_ready = 0;
        choose(&scene, &view, &bound); /* what is wanted keeps the budget just so */
        CU_ASSERT_EQUAL(scene.selection.triangles, 0);
        if (n % 4 < 2) CU_ASSERT_EQUAL(scene.selection.tolerance_px, raised_px);
        for (uint32_t t = 0; t < scene.tile_count; t++) scene.tiles[t].rungs_ready = scene.tiles[t].header->rung_count;
        choose(&scene, &view, &bound);
        CU_ASSERT(scene.selection.tolerance_px >= 1);
        if (scene.selection.tolerance_px == 1) continue;
        raised++;
        if (n % 4 < 2) { /* a tolerance of a step less would not do */
            free.tolerance_px = scene.selection.tolerance_px / exp2(1.0 / 64);
            choose(&scene, &view, &free);
            CU_ASSERT(scene.selection.triangles > bound.triangle_budget);
        }
    }
    CU_ASSERT(raised > 50);
}

static bool is_within(const struct scree_tile_id *inner, const struct scree_tile_id *outer) {
    int levels = inner->zoom - outer->zoom;
    return levels >= 0 && inner->x >> levels == outer->x && inner->y >> levels == outer->y;
}

/* Loads the most urgent tile over and over: nothing that has not arrived is drawn, the scene has no holes once its
 * roots are there, and in the end it is what it would have been with everything there. */
static void loading_comes_to_an_end(void) {
    uint64_t state = 21;
    static bool ready[SCENE_MOST_TILES];
    for (int n = 0; n < 60; n++) {
        double deep[2], matrix[16];
        any_scene(&state, deep);
        link_scene(&scene);
        struct scene_camera camera = any_camera(&state, deep);
        struct scree_view view = view_of(&camera, matrix);
        struct scree_select_options options = {.measure = (enum scree_measure)(n % 2), .tolerance_px = 3};
        choose(&scene, &view, &options);
        uint32_t final_count = scene.selection.drawn_count, steps = 0;
        memcpy(other.drawn, scene.drawn, final_count * sizeof *scene.drawn);
        memset(ready, 0, sizeof ready);
        for (uint32_t t = 0; t < scene.tile_count; t++) {
            scene.tiles[t].rungs_ready = 0;
            scene.tiles[t].header = NULL;
        }
        for (choose(&scene, &view, &options); scene.selection.wanted_count > 0; steps++) {
            CU_ASSERT_FATAL(steps < 8 * SCENE_MOST_TILES);
            for (uint32_t i = 1; i < scene.selection.wanted_count; i++) {
                const struct scree_select_wanted *a = &scene.wanted[i - 1], *b = &scene.wanted[i];
                CU_ASSERT(a->error_px > b->error_px || (a->error_px == b->error_px && a->distance_m <= b->distance_m));
            }
            struct scree_select_tile *tile = &scene.tiles[scene.wanted[0].tile];
            CU_ASSERT_EQUAL(scene.wanted[0].first_rung, tile->rungs_ready);
            CU_ASSERT(scene.wanted[0].end_rung > scene.wanted[0].first_rung);
            if (tile->header == NULL) CU_ASSERT_EQUAL(scene.wanted[0].end_rung, 1);
            tile->header = &scene.headers[tile->id.zoom];
            tile->rungs_ready = scene.wanted[0].first_rung + 1;
            choose(&scene, &view, &options);
            for (uint32_t i = 0; i < scene.selection.drawn_count; i++) {
                const struct scree_select_drawn *drawn = &scene.drawn[i];
                CU_ASSERT(drawn->rung < scene.tiles[drawn->tile].rungs_ready);
                if (i > 0)
                    CU_ASSERT(
                        scree_tile_compare(&scene.tiles[scene.drawn[i - 1].tile].id, &scene.tiles[drawn->tile].id) < 0);
            }
            bool roots = true;
            for (uint32_t t = 0; t < scene.tile_count && scene.tiles[t].id.zoom == 0; t++)
                for (uint32_t i = 0; i < final_count; i++)
                    if (is_within(&scene.tiles[other.drawn[i].tile].id, &scene.tiles[t].id) &&
                        scene.tiles[t].header == NULL)
                        roots = false;
            for (uint32_t i = 0; i < final_count && roots && steps % 16 == 0;
                 i++) { /* each final tile has a stand-in */
                int covering = 0;
                for (uint32_t k = 0; k < scene.selection.drawn_count; k++)
                    covering += is_within(&scene.tiles[other.drawn[i].tile].id, &scene.tiles[scene.drawn[k].tile].id);
                CU_ASSERT_EQUAL(covering, 1);
            }
        }
        CU_ASSERT_EQUAL_FATAL(scene.selection.drawn_count, final_count);
        for (uint32_t i = 0; i < final_count; i++) {
            CU_ASSERT_EQUAL(scene.drawn[i].tile, other.drawn[i].tile);
            CU_ASSERT_EQUAL(scene.drawn[i].level, other.drawn[i].level);
        }
    }
}

/* By hand: two of four children are there. */
static void a_tile_waits_for_all_of_its_children(void) {
    double eye[3];
    struct scree_view view;
    scene_make(&scene, SCREE_GEODETIC, 1, 1, 0.2, 0.2, 0);
    link_scene(&scene);
    CU_ASSERT_EQUAL_FATAL(scene.tile_count, 10);
    for (uint32_t t = 2; t < 10; t++) scene.tiles[t].rungs_ready = 0;
    scene.tiles[scene.tiles[0].first_child].rungs_ready = scene.tiles[scene.tiles[0].first_child + 2].rungs_ready = 1;
    scene.tiles[0].rungs_ready = 3;
    scene_place(&scene, 0.3, 0.4, 2e5, eye);
    CU_ASSERT_EQUAL(scree_view_of_eye(eye, 1, 1000, &view, NULL), SCREE_OK);
    choose(&scene, &view, NULL);
    CU_ASSERT_EQUAL(scene.selection.drawn_count, 2);
    CU_ASSERT(scene.drawn[0].tile == 0 && scene.drawn[0].rung == 2 && scene.drawn[0].level == 2);
    CU_ASSERT(scene.drawn[1].tile == 1);
    CU_ASSERT(scene.wanted[0].tile == 0 && scene.wanted[0].first_rung == 3 && scene.wanted[0].end_rung == 5);
    scene.tiles[scene.tiles[0].first_child + 1].rungs_ready = scene.tiles[scene.tiles[0].first_child + 3].rungs_ready =
        1;
    choose(&scene, &view, NULL);
    CU_ASSERT_EQUAL(scene.selection.drawn_count, 5);
    for (int i = 0; i < 4; i++) CU_ASSERT_EQUAL(scene.drawn[i].tile, scene.tiles[0].first_child + (uint32_t)i);
    for (uint32_t i = 0; i < scene.selection.wanted_count; i++) CU_ASSERT_NOT_EQUAL(scene.wanted[i].tile, 0);
}

static int from_behind(const void *left, const void *right) {
    return -scree_tile_compare(&((const struct scree_select_tile *)left)->id,
                               &((const struct scree_select_tile *)right)->id);
}

static void order_of_tiles_makes_no_difference(void) {
    double deep[2], matrix[16];
    uint64_t state = 77;
    any_scene(&state, deep);
    memcpy(other.tiles, scene.tiles, sizeof scene.tiles);
    qsort(other.tiles, scene.tile_count, sizeof *other.tiles, from_behind);
    CU_ASSERT_NOT_EQUAL(memcmp(other.tiles, scene.tiles, scene.tile_count * sizeof *scene.tiles), 0);
    link_scene(&scene);
    CU_ASSERT_EQUAL(scree_select_link(&scene.terrain, other.tiles, scene.tile_count, NULL), SCREE_OK);
    for (uint32_t t = 0; t < scene.tile_count; t++) {
        CU_ASSERT_EQUAL(scree_tile_compare(&scene.tiles[t].id, &other.tiles[t].id), 0);
        CU_ASSERT_EQUAL(scene.tiles[t].first_child, other.tiles[t].first_child);
        CU_ASSERT_EQUAL(scene.tiles[t].child_count, other.tiles[t].child_count);
    }
    struct scene_camera camera = any_camera(&state, deep);
    struct scree_view view = view_of(&camera, matrix);
    choose(&scene, &view, NULL);
    memcpy(other.drawn, scene.drawn, sizeof scene.drawn);
    uint32_t count = scene.selection.drawn_count;
    choose(&scene, &view, NULL); /* and nothing is remembered */
    CU_ASSERT_EQUAL(scene.selection.drawn_count, count);
    CU_ASSERT_EQUAL(memcmp(other.drawn, scene.drawn, count * sizeof *scene.drawn), 0);
}

static void tiles_that_are_no_tree_are_refused(void) {
    struct scree_terrain terrain = {.profile = SCREE_LOCAL};
    struct scree_error error = {0};
    struct scree_select_tile twice[] = {{.id = {1, 0, 0}}, {.id = {1, 1, 0}}, {.id = {1, 0, 0}}};
    CU_ASSERT_EQUAL(scree_select_link(&terrain, twice, 3, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_STRING_EQUAL(error.text, "tile 1/0/0 is listed twice");
    error = (struct scree_error){0};
    struct scree_select_tile orphan[] = {{.id = {2, 3, 3}}, {.id = {0, 0, 0}}, {.id = {1, 0, 1}}};
    CU_ASSERT_EQUAL(scree_select_link(&terrain, orphan, 3, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_STRING_EQUAL(error.text, "tile 2/3/3 is listed without its parent");
    static const struct scree_tile_id outside[] = {{0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {31, 0, 0}, {3, 8, 0}};
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
        struct scree_select_tile tile = {.id = outside[i]};
        CU_ASSERT_EQUAL(scree_select_link(&terrain, &tile, 1, NULL), SCREE_E_ARGUMENT);
    }
    struct scree_select_tile deep[] = {{.id = {30, UINT32_C(0x7fffffff), 5}}, {.id = {30, 7, 5}}};
    terrain.profile = SCREE_GEODETIC; /* roots are those of the lowest zoom, whichever it is */
    CU_ASSERT_EQUAL(scree_select_link(&terrain, deep, 2, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(deep[0].id.x, 7);
}

static void cameras_that_make_no_sense_are_refused(void) {
    struct scene_camera camera = {.eye = {0, 0, 10}, .height = 1, .width_px = 10, .height_px = 10};
    struct scree_view view;
    double matrix[16], spoilt[16];
    for (int orthogonal = 0; orthogonal < 2; orthogonal++) {
        camera.orthogonal = orthogonal;
        scene_matrix(&camera, matrix);
        CU_ASSERT_EQUAL(scree_view_of_matrix(matrix, SCREE_DEPTH_ANY, 10, 10, &view, NULL), SCREE_OK);
        static const double bad[] = {NAN, INFINITY, -INFINITY};
        for (int i = 0; i < 48; i++) {
            memcpy(spoilt, matrix, sizeof spoilt);
            spoilt[i % 16] = bad[i / 16];
            CU_ASSERT_EQUAL(scree_view_of_matrix(spoilt, SCREE_DEPTH_ANY, 10, 10, &view, NULL), SCREE_E_ARGUMENT);
        }
        for (int row = 0; row < 2; row++) { /* what is left is a line */
            memcpy(spoilt, matrix, sizeof spoilt);
            for (int i = 0; i < 4; i++) spoilt[4 * i + row] = 0;
            CU_ASSERT_EQUAL(scree_view_of_matrix(spoilt, SCREE_DEPTH_ANY, 10, 10, &view, NULL), SCREE_E_ARGUMENT);
            for (int i = 0; i < 4; i++) spoilt[4 * i + row] = 3 * matrix[4 * i + 1 - row];
            CU_ASSERT_EQUAL(scree_view_of_matrix(spoilt, SCREE_DEPTH_ANY, 10, 10, &view, NULL), SCREE_E_ARGUMENT);
        }
        static const double sizes[][2] = {{0, 10}, {10, 0}, {-1, 10}, {NAN, 10}, {10, INFINITY}};
        for (int i = 0; i < 5; i++)
            CU_ASSERT_EQUAL(scree_view_of_matrix(matrix, SCREE_DEPTH_ANY, sizes[i][0], sizes[i][1], &view, NULL),
                            SCREE_E_ARGUMENT);
    }
    memset(spoilt, 0, sizeof spoilt);
    CU_ASSERT_EQUAL(scree_view_of_matrix(spoilt, SCREE_DEPTH_ANY, 10, 10, &view, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(scree_view_of_eye((double[]){0, NAN, 0}, 1, 10, &view, NULL), SCREE_E_ARGUMENT);
    static const double angles[] = {0, -1, 3.2, NAN};
    for (int i = 0; i < 4; i++)
        CU_ASSERT_EQUAL(scree_view_of_eye(camera.eye, angles[i], 10, &view, NULL), SCREE_E_ARGUMENT);
    CU_ASSERT_EQUAL(scree_view_of_eye(camera.eye, 1, 0, &view, NULL), SCREE_E_ARGUMENT);
}

static void options_that_make_no_sense_are_refused(void) {
    struct scree_view view;
    double eye[3] = {0, 0, 0};
    static const double tolerances_px[] = {-1, NAN, INFINITY};
    scene_make(&scene, SCREE_GEODETIC, 1, 1, 0.5, 0.5, 100);
    link_scene(&scene);
    CU_ASSERT_EQUAL(scree_view_of_eye(eye, 1, 1000, &view, NULL), SCREE_OK);
    for (int i = 0; i < 3; i++) {
        struct scree_select_options options = {.tolerance_px = tolerances_px[i]};
        CU_ASSERT_EQUAL(
            scree_select(&scene.terrain, scene.tiles, scene.tile_count, &view, &options, &scene.selection, NULL),
            SCREE_E_ARGUMENT);
    }
    scene.selection.capacity = scene.tile_count - 1;
    CU_ASSERT_EQUAL(scree_select(&scene.terrain, scene.tiles, scene.tile_count, &view, NULL, &scene.selection, NULL),
                    SCREE_E_LIMIT);
    scene.selection.capacity++;
    scene.selection.workspace_bytes = scree_select_workspace(scene.tile_count) - 1;
    CU_ASSERT_EQUAL(scree_select(&scene.terrain, scene.tiles, scene.tile_count, &view, NULL, &scene.selection, NULL),
                    SCREE_E_LIMIT);
    scene.selection.workspace_bytes++;
    CU_ASSERT_EQUAL(scree_select(&scene.terrain, scene.tiles, scene.tile_count, &view, NULL, &scene.selection, NULL),
                    SCREE_OK);
    CU_ASSERT_EQUAL(scree_select(&scene.terrain, NULL, 0, &view, NULL, &scene.selection, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(scene.selection.drawn_count + scene.selection.wanted_count, 0);
}

/* A projection is the same whatever its matrix is multiplied by; orthogonal ones with all signs turned as well. */
static void multiples_of_a_matrix_are_one_camera(void) {
    uint64_t state = 41;
    for (int n = 0; n < 60; n++) {
        double deep[2], matrix[16];
        any_scene(&state, deep);
        link_scene(&scene);
        struct scene_camera camera = any_camera(&state, deep);
        struct scree_view view = view_of(&camera, matrix);
        choose(&scene, &view, NULL);
        uint32_t count = scene.selection.drawn_count;
        memcpy(other.drawn, scene.drawn, count * sizeof *scene.drawn);
        for (int i = 0; i < 16; i++) matrix[i] *= camera.orthogonal ? -8 : 8; /* exact */
        CU_ASSERT_EQUAL(scree_view_of_matrix(matrix, camera.depth, camera.width_px, camera.height_px, &view, NULL),
                        SCREE_OK);
        choose(&scene, &view, NULL);
        CU_ASSERT_EQUAL_FATAL(scene.selection.drawn_count, count);
        for (uint32_t i = 0; i < count; i++) {
            CU_ASSERT_EQUAL(scene.drawn[i].tile, other.drawn[i].tile);
            CU_ASSERT_EQUAL(scene.drawn[i].rung, other.drawn[i].rung);
        }
        for (int i = 0; i < 16; i++) matrix[i] *= 1e300;
        CU_ASSERT_EQUAL(scree_view_of_matrix(matrix, camera.depth, camera.width_px, camera.height_px, &view, NULL),
                        SCREE_E_ARGUMENT);
    }
}

/* The farthest corner of the screen, wherever the middle is: a right angle up and across, shifted either way. */
static void corners_of_oblique_views(void) {
    static const double shifts[] = {0, 0.5, -0.5};
    for (int i = 0; i < 3; i++) {
        struct scene_camera camera = {
            .eye = {0, 0, 10}, .height = acos(0), .width_px = 10, .height_px = 10, .shift = shifts[i]};
        double matrix[16], reach = 1 + fabs(shifts[i]);
        struct scree_view view = view_of(&camera, matrix);
        CU_ASSERT_DOUBLE_EQUAL(view.corner_cosine, 1 / sqrt(1 + 1 + reach * reach), 1e-12);
        CU_ASSERT_DOUBLE_EQUAL(view.pixels, 5, 1e-12);
        CU_ASSERT_DOUBLE_EQUAL(view.slope, 1, 1e-12);
        for (int k = 0; k < 3; k++) CU_ASSERT_DOUBLE_EQUAL(view.eye[k], camera.eye[k], 1e-9);
    }
}

/* A camera inside of the box of a tile, and looking from below it. */
static void cameras_anywhere_get_something(void) {
    struct scree_view view;
    double matrix[16];
    for (int inside = 0; inside < 2; inside++) {
        scene_make(&scene, SCREE_LOCAL, 2, 6, 0.4, 0.3, 3000);
        link_scene(&scene);
        struct scene_camera camera = {.height = 1, .width_px = 1000, .height_px = 700, .depth = SCREE_DEPTH_MINUS_ONE};
        scene_place(&scene, 0.4, 0.3, inside ? 1500 : -5000, camera.eye);
        scene_place(&scene, 0.41, 0.31, 1500, camera.target);
        view = view_of(&camera, matrix);
        struct scree_select_options options = {.triangle_budget = 20000};
        choose(&scene, &view, &options);
        CU_ASSERT(scene.selection.drawn_count > 4);
        CU_ASSERT(scene.selection.triangles <= 20000);
        for (uint32_t i = 0; i < scene.selection.drawn_count; i++) CU_ASSERT(isfinite(scene.drawn[i].error_px));
    }
}

static void heights_are_bounds(void) {
    struct scree_terrain terrain = {.profile = SCREE_LOCAL, .lowest_m = -500, .highest_m = 9000};
    struct scree_stream_header header = {.profile = SCREE_LOCAL, .height_exponent = -3, .rung_count = 1};
    struct scree_vertex vertices[3] = {{0, 0, 801}, {1, 0, -80}, {0, 1, 8000}};
    float lowest_m, highest_m;
    header.rungs[0] = (struct scree_rung){.vertex_count = 3, .max_error_m = 20};
    scree_select_heights(&terrain, &header, 0, vertices, &lowest_m, &highest_m);
    CU_ASSERT_DOUBLE_EQUAL(lowest_m, -30, 1e-4);
    CU_ASSERT_DOUBLE_EQUAL(highest_m, 1020, 1e-3);
    terrain.lowest_m = -12;
    scree_select_heights(&terrain, &header, 0, vertices, &lowest_m, &highest_m);
    CU_ASSERT(lowest_m <= -12 && lowest_m > -12.001);
    header.profile = SCREE_GEODETIC; /* a diagonal of a degree is 111 km, and 242 m high */
    header.columns = header.rows = 256;
    header.spacing_x = header.spacing_y = sqrt(0.5) / 256;
    terrain.lowest_m = -500;
    scree_select_heights(&terrain, &header, 0, vertices, &lowest_m, &highest_m);
    CU_ASSERT_DOUBLE_EQUAL(lowest_m, -272.9, 0.5);
    CU_ASSERT_DOUBLE_EQUAL(highest_m, 1020, 1e-3);
}

int suite_select(void) {
    CU_pSuite suite = CU_add_suite("select", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, what_is_seen_is_drawn_and_exact);
    CU_ADD_TEST(suite, boxes_hold_their_tiles);
    CU_ADD_TEST(suite, what_cannot_be_seen_is_left_out);
    CU_ADD_TEST(suite, orthogonal_views_choose_what_perspective_ones_do);
    CU_ADD_TEST(suite, scale_falls_with_tolerance_and_distance);
    CU_ADD_TEST(suite, budgets_hold_and_are_used);
    CU_ADD_TEST(suite, loading_comes_to_an_end);
    CU_ADD_TEST(suite, a_tile_waits_for_all_of_its_children);
    CU_ADD_TEST(suite, order_of_tiles_makes_no_difference);
    CU_ADD_TEST(suite, tiles_that_are_no_tree_are_refused);
    CU_ADD_TEST(suite, cameras_that_make_no_sense_are_refused);
    CU_ADD_TEST(suite, options_that_make_no_sense_are_refused);
    CU_ADD_TEST(suite, multiples_of_a_matrix_are_one_camera);
    CU_ADD_TEST(suite, corners_of_oblique_views);
    CU_ADD_TEST(suite, cameras_anywhere_get_something);
    CU_ADD_TEST(suite, heights_are_bounds);
    return 0;
}
