#include "lod/point_set.h"

#include "lod/method_place.h"
#include "lod/polyline.h"

#include <math.h>
#include <string.h>

#define UNITS_A_CELL    32
#define CLEARANCE_CELLS 0.25

/* ---- points of the triangulation, with their heights ---- */

/* Inserts a point; one that is there already keeps its height. */
static enum scree_status insert(struct point_set *set, int32_t x, int32_t y, double height_m, uint32_t *point,
                                struct scree_error *error) {
    uint32_t before = set->triangulation.point_count;
    enum scree_status status = constrained_insert(&set->triangulation, x, y, point, error);
    if (status != SCREE_OK || *point < before) return status;
    if (*point >= set->height_capacity) {
        uint32_t capacity = 2 * *point;
        double *heights_m =
            scree_reallocate(set->memory, set->heights_m, capacity, sizeof *heights_m, "heights of points", error);
        if (heights_m == NULL) return SCREE_E_MEMORY;
        set->heights_m = heights_m;
        set->height_capacity = capacity;
    }
    set->heights_m[*point] = height_m;
    return SCREE_OK;
}

static int32_t post_units(const struct point_set *set, int32_t cells) {
    return cells * set->tile->cell_span * set->units;
}

static enum scree_status insert_post(struct point_set *set, struct feature_post post, uint32_t *point,
                                     struct scree_error *error) {
    return insert(set, post_units(set, post.column), post_units(set, post.row),
                  (double)method_post_m(set->tile, post.column, post.row), point, error);
}

/* ---- the border ---- */

static enum scree_status insert_border(struct point_set *set, struct scree_error *error) {
    struct method_vertex *ring = NULL;
    uint32_t count, corners[4], point;
    enum scree_status status = method_ring_new(set->memory, set->tile, &ring, &count, corners, error);
    for (int side = 0; side < 4 && status == SCREE_OK; side++)
        set->heights_m[side] = ring[corners[side]].height_m; /* the first points, in the same order */
    for (uint32_t i = 0; i < count && status == SCREE_OK; i++)
        status = insert(set, (int32_t)ring[i].x * set->units, (int32_t)ring[i].y * set->units, ring[i].height_m, &point,
                        error);
    scree_release(set->memory, ring);
    return status;
}

/* ---- features ---- */

/* Inserts the posts of the lines and joins neighbours; `points` gets their numbers. */
static enum scree_status insert_lines(struct point_set *set, const struct feature_lines *lines, uint32_t *points,
                                      struct scree_error *error) {
    for (uint32_t line = 0; line < lines->line_count; line++)
        for (uint32_t i = lines->starts[line]; i < lines->starts[line + 1]; i++) {
            enum scree_status status = insert_post(set, lines->posts[i], &points[i], error);
            if (status == SCREE_OK && i > lines->starts[line])
                status = constrained_fix(&set->triangulation, points[i - 1], points[i], error);
            if (status != SCREE_OK) return status;
        }
    return SCREE_OK;
}

static enum scree_status simplify_lines(struct point_set *set, const struct feature_lines *lines, uint32_t *points,
                                        double tolerance_m, struct scree_error *error) {
    const struct constrained *triangulation = &set->triangulation;
    struct polylines polylines = {lines->line_count, lines->starts, points};
    struct vector3 *places_m =
        scree_allocate(set->memory, triangulation->point_count, sizeof *places_m, "places of points", error);
    if (places_m == NULL) return SCREE_E_MEMORY;
    for (uint32_t i = 0; i < triangulation->point_count; i++)
        places_m[i] = method_place_m(set->tile, (double)triangulation->points[i].x / set->units,
                                     (double)triangulation->points[i].y / set->units, set->heights_m[i]);
    enum scree_status status =
        polylines_simplify(set->memory, places_m, tolerance_m, &set->triangulation, &polylines, error);
    scree_release(set->memory, places_m);
    return status;
}

/* Marks the posts of the features, whether simplification keeps them or not. */
static enum scree_status add_features(struct point_set *set, const struct point_set_options *options,
                                      unsigned char *is_taken, struct scree_error *error) {
    struct feature_lines lines = {0};
    uint32_t *points = NULL;
    enum scree_status status = features_find(set->memory, set->tile, &options->features, &lines, error);
    if (status != SCREE_OK || lines.line_count == 0) goto cleanup;
    uint32_t count = lines.starts[lines.line_count];
    points = scree_allocate(set->memory, count, sizeof *points, "points of features", error);
    status = points != NULL ? insert_lines(set, &lines, points, error) : SCREE_E_MEMORY;
    if (status == SCREE_OK) status = simplify_lines(set, &lines, points, options->line_tolerance_m, error);
    for (uint32_t i = 0; i < count; i++)
        is_taken[(size_t)lines.posts[i].row * (size_t)(set->tile->columns + 1) + (size_t)lines.posts[i].column] = 1;
cleanup:
    scree_release(set->memory, points);
    feature_lines_release(set->memory, &lines);
    return status;
}

/* ---- the whole ---- */

static void list_posts(struct point_set *set, const unsigned char *is_taken) {
    const struct method_tile *tile = set->tile;
    for (int32_t row = 1; row < tile->rows; row++)
        for (int32_t column = 1; column < tile->columns; column++)
            if (!is_taken[(size_t)row * (size_t)(tile->columns + 1) + (size_t)column])
                set->posts[set->post_count++] = (struct feature_post){column, row};
}

/* As many units a lattice step as make UNITS_A_CELL, fewer where the triangulation would get too wide. */
static int32_t choose_units(const struct method_tile *tile) {
    int32_t longer = method_width(tile) > method_height(tile) ? method_width(tile) : method_height(tile);
    int32_t units = tile->cell_span < UNITS_A_CELL ? UNITS_A_CELL / tile->cell_span : 1;
    int32_t most = CONSTRAINED_LARGEST_SIDE / longer;
    return units < most ? units : most;
}

enum scree_status point_set_begin(struct scree_memory *memory, const struct method_tile *tile,
                                  const struct point_set_options *options, struct point_set *set,
                                  struct scree_error *error) {
    *set = (struct point_set){.memory = memory, .tile = tile, .units = choose_units(tile), .height_capacity = 1024};
    size_t post_count = (size_t)(tile->columns + 1) * (size_t)(tile->rows + 1);
    if (!(options->line_tolerance_m >= 0))
        return scree_fail(error, SCREE_E_ARGUMENT, "feature lines within %g m: it takes 0 or more",
                          options->line_tolerance_m);
    unsigned char *is_taken = scree_allocate(memory, post_count, 1, "marks of posts", error);
    set->heights_m = scree_allocate(memory, set->height_capacity, sizeof *set->heights_m, "heights of points", error);
    set->posts = scree_allocate(memory, post_count, sizeof *set->posts, "posts between features", error);
    enum scree_status status = SCREE_E_MEMORY;
    if (is_taken == NULL || set->heights_m == NULL || set->posts == NULL) goto cleanup;
    status = constrained_begin(memory, method_width(tile) * set->units, method_height(tile) * set->units,
                               &set->triangulation, error);
    if (status == SCREE_OK) status = insert_border(set, error);
    if (status == SCREE_OK && !options->without_features) status = add_features(set, options, is_taken, error);
    if (status == SCREE_OK) list_posts(set, is_taken);
cleanup:
    scree_release(memory, is_taken);
    return status;
}

void point_set_release(struct point_set *set) {
    constrained_release(&set->triangulation);
    scree_release(set->memory, set->posts);
    scree_release(set->memory, set->heights_m);
    *set = (struct point_set){0};
}

static bool is_clear(struct point_set *set, int32_t x, int32_t y) {
    return constrained_is_clear(&set->triangulation, x, y,
                                CLEARANCE_CELLS * (double)set->tile->cell_span * (double)set->units);
}

enum scree_status point_set_add_post(struct point_set *set, struct feature_post post, struct scree_error *error) {
    uint32_t point;
    if (!is_clear(set, post_units(set, post.column), post_units(set, post.row))) return SCREE_OK;
    return insert_post(set, post, &point, error);
}

enum scree_status point_set_add_place(struct point_set *set, struct vector3 place_m, struct scree_error *error) {
    const struct method_tile *tile = set->tile;
    double x = floor((place_m.x / tile->east_m + 0.5 * method_width(tile)) * set->units + 0.5);
    double y = floor((place_m.y / tile->north_m + 0.5 * method_height(tile)) * set->units + 0.5);
    uint32_t point;
    if (!(x > 0 && y > 0 && x < set->triangulation.width && y < set->triangulation.height)) return SCREE_OK;
    if (!is_clear(set, (int32_t)x, (int32_t)y)) return SCREE_OK;
    return insert(set, (int32_t)x, (int32_t)y, place_m.z + method_drop_m(tile, x / set->units, y / set->units), &point,
                  error);
}

enum scree_status point_set_finish(const struct point_set *set, struct method_mesh *mesh, struct scree_error *error) {
    const struct constrained *triangulation = &set->triangulation;
    enum scree_status status = SCREE_E_MEMORY;
    uint32_t vertices = 0, triangles = 0;
    *mesh = (struct method_mesh){0};
    for (uint32_t i = 0; i < triangulation->point_count; i++) vertices += triangulation->leaving[i] != CONSTRAINED_NONE;
    for (uint32_t t = 0; t < triangulation->triangle_count; t++)
        triangles += triangulation->triangles[t].corner[0] != CONSTRAINED_NONE;
    uint32_t *numbers =
        scree_allocate(set->memory, triangulation->point_count, sizeof *numbers, "numbers of vertices", error);
    mesh->vertices = scree_allocate(set->memory, vertices, sizeof *mesh->vertices, "the vertices of a mesh", error);
    mesh->corners =
        scree_allocate(set->memory, 3 * (size_t)triangles, sizeof *mesh->corners, "the triangles of a mesh", error);
    if (numbers == NULL || mesh->vertices == NULL || mesh->corners == NULL) goto cleanup;
    for (uint32_t i = 0; i < triangulation->point_count; i++) {
        if (triangulation->leaving[i] == CONSTRAINED_NONE) continue;
        numbers[i] = mesh->vertex_count;
        mesh->vertices[mesh->vertex_count++] =
            (struct method_vertex){(double)triangulation->points[i].x / set->units,
                                   (double)triangulation->points[i].y / set->units, set->heights_m[i]};
    }
    for (uint32_t t = 0; t < triangulation->triangle_count; t++) {
        const uint32_t *corner = triangulation->triangles[t].corner;
        if (corner[0] == CONSTRAINED_NONE) continue;
        uint32_t *to = &mesh->corners[3 * (size_t)mesh->triangle_count++];
        for (int k = 0; k < 3; k++) to[k] = numbers[corner[k]];
    }
    status = SCREE_OK;
cleanup:
    if (status != SCREE_OK) method_mesh_release(set->memory, mesh);
    scree_release(set->memory, numbers);
    return status;
}
