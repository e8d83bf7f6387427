#include "lod/tin_piece.h"

#include <math.h>

#define CLEARANCE 0.5 /* walls: how near a foot may come to an edge */
#define LONGEST   4   /* walls: from foot to foot along an edge of the outline */
#define SHARPEST  0.5 /* cosine: at sharper corners the wall's foot is no farther away than at this one */

void tin_piece_release(struct scree_memory *memory, struct tin_piece *piece) {
    for (int side = 0; side < SIDE_COUNT; side++) tin_side_release(memory, &piece->sides[side]);
    scree_release(memory, piece->posts);
    constrained_release(&piece->mesh);
    *piece = (struct tin_piece){0};
}

/* ---- points ---- */

/* Adds a post, or finds the point that is there already, whose height stays. */
static enum scree_status put(struct scree_memory *memory, struct tin_piece *piece, const struct tin_post *post,
                             uint32_t *point, struct scree_error *error) {
    uint32_t before = piece->mesh.point_count;
    enum scree_status status = constrained_insert(&piece->mesh, post->x, post->y, point, error);
    if (status != SCREE_OK) return status;
    if (piece->mesh.point_count > piece->post_capacity) {
        uint32_t capacity = piece->mesh.point_capacity;
        void *posts = scree_reallocate(memory, piece->posts, capacity, sizeof *piece->posts, "a tile's posts", error);
        if (posts == NULL) return error->status;
        piece->posts = posts;
        piece->post_capacity = capacity;
    }
    if (piece->mesh.point_count > before) piece->posts[*point] = *post;
    return SCREE_OK;
}

static enum scree_status put_sides(struct scree_memory *memory, struct tin_piece *piece, struct scree_error *error) {
    uint32_t point;
    enum scree_status status = SCREE_OK;
    for (int which = 0; which < SIDE_COUNT; which++)
        for (uint32_t i = 0; i < piece->sides[which].count && status == SCREE_OK; i++) {
            status = put(memory, piece, &piece->sides[which].posts[i], &point, error);
            if (status == SCREE_OK && point < 4) piece->posts[point] = piece->sides[which].posts[i]; /* a corner */
        }
    return status;
}

static bool is_inside(const struct tin_tile *tile, const struct tin_post *post) {
    return post->x > 0 && post->y > 0 && post->x < tile->columns && post->y < tile->rows;
}

static bool is_in_or_on(const struct tin_tile *tile, const struct tin_post *post) {
    return post->x >= 0 && post->y >= 0 && post->x <= tile->columns && post->y <= tile->rows;
}

/* `points` gets the mesh's number of each point of the patch that lies in or on the tile. */
static enum scree_status put_points(const struct tin_patch *patch, const struct tin_tile *tile, struct tin_piece *piece,
                                    uint32_t *points, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (uint32_t p = 0; p < patch->point_count && status == SCREE_OK; p++) {
        points[p] = TIN_PATCH_NONE;
        if (is_in_or_on(tile, &patch->points[p]))
            status = put(patch->memory, piece, &patch->points[p], &points[p], error);
    }
    return status;
}

/* ---- edges ---- */

/* The ends of an edge's part in the tile: points of the mesh, two when it has a part. */
struct part {
    uint32_t ends[2];
    int count;
};

static void add_end(struct part *part, uint32_t point) {
    if (part->count > 0 && part->ends[0] == point) return;
    if (part->count < 2) part->ends[part->count++] = point;
}

static enum scree_status cross_side(const struct tin_patch *patch, const struct tin_tile *tile, enum tile_side which,
                                    uint32_t a, uint32_t b, struct tin_piece *piece, struct part *part,
                                    struct scree_error *error) {
    bool is_upright = which == SIDE_WEST || which == SIDE_EAST;
    int32_t at = which == SIDE_EAST ? tile->columns : which == SIDE_NORTH ? tile->rows : 0;
    int32_t from = is_upright ? patch->points[a].x : patch->points[a].y;
    int32_t to = is_upright ? patch->points[b].x : patch->points[b].y;
    if (from == at || to == at || (from < at) == (to < at)) return SCREE_OK;
    struct tin_post post = tin_patch_cross(patch, a, b, is_upright, at);
    if (!is_in_or_on(tile, &post)) return SCREE_OK;
    uint32_t point;
    enum scree_status status = put(patch->memory, piece, &post, &point, error); /* it is there */
    if (status == SCREE_OK) add_end(part, point);
    return status;
}

static enum scree_status fix_edge(const struct tin_patch *patch, const struct tin_tile *tile, const uint32_t *points,
                                  uint32_t edge, struct tin_piece *piece, struct scree_error *error) {
    uint32_t a = tin_patch_origin(patch, edge), b = tin_patch_target(patch, edge);
    struct part part = {.count = 0};
    enum scree_status status = SCREE_OK;
    if (points[a] != TIN_PATCH_NONE) add_end(&part, points[a]);
    if (points[b] != TIN_PATCH_NONE) add_end(&part, points[b]);
    for (int side = 0; side < SIDE_COUNT && status == SCREE_OK; side++)
        status = cross_side(patch, tile, (enum tile_side)side, a, b, piece, &part, error);
    if (status != SCREE_OK || part.count < 2) return status;
    struct scree_error crossed = {0};
    status = constrained_fix(&piece->mesh, part.ends[0], part.ends[1], &crossed);
    if (status == SCREE_OK || status == SCREE_E_ARGUMENT) return SCREE_OK;
    *error = crossed;
    return status;
}

static enum scree_status fix_edges(const struct tin_patch *patch, const struct tin_tile *tile, const uint32_t *points,
                                   struct tin_piece *piece, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (uint32_t edge = 0; edge < 3 * patch->triangle_count && status == SCREE_OK; edge++) {
        bool is_outline = patch->twins[edge] == TIN_PATCH_NONE;
        if (is_outline || patch->twins[edge] > edge) status = fix_edge(patch, tile, points, edge, piece, error);
    }
    return status;
}

/* ---- outside ---- */

/* A post on the ground, if it is inside of the tile, outside of the surface, and not too near to anything. */
static enum scree_status put_outside(const struct tin_patch *patch, const struct tin_tile *tile, struct tin_post post,
                                     double clearance, struct tin_piece *piece, struct scree_error *error) {
    uint32_t point;
    if (!is_inside(tile, &post) || !constrained_is_clear(&piece->mesh, post.x, post.y, clearance) ||
        tin_patch_covers(patch, 0, &post))
        return SCREE_OK;
    post.height_m = tile->outside_m;
    post.slope = (struct slope){0, 0};
    return put(patch->memory, piece, &post, &point, error);
}

struct outward {
    double x, y; /* the sum of the outline's normals at a point */
};

static enum scree_status put_foot(const struct tin_patch *patch, const struct tin_tile *tile, double x, double y,
                                  struct tin_piece *piece, struct scree_error *error) {
    if (!(x > 0 && y > 0 && x < tile->columns && y < tile->rows)) return SCREE_OK;
    struct tin_post foot = {.x = (int32_t)lrint(x), .y = (int32_t)lrint(y)};
    return put_outside(patch, tile, foot, CLEARANCE * tile->wall_steps, piece, error);
}

/* Feet along an edge of the outline, which count for its ends too. */
static enum scree_status put_feet_along(const struct tin_patch *patch, const struct tin_tile *tile, uint32_t edge,
                                        struct outward *outward, struct tin_piece *piece, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    uint32_t a = tin_patch_origin(patch, edge), b = tin_patch_target(patch, edge);
    const struct tin_post *from = &patch->points[a], *to = &patch->points[b];
    double dx = (double)to->x - from->x, dy = (double)to->y - from->y, length = sqrt(dx * dx + dy * dy);
    if (length == 0) return SCREE_OK;
    struct outward normal = {dy / length, -dx / length};
    struct outward *const ends[2] = {&outward[a], &outward[b]};
    for (int i = 0; i < 2; i++) {
        ends[i]->x += normal.x;
        ends[i]->y += normal.y;
    }
    double parts = ceil(length / (LONGEST * (double)tile->wall_steps));
    for (double part = 1; part < parts && status == SCREE_OK; part++)
        status = put_foot(patch, tile, from->x + part / parts * dx + tile->wall_steps * normal.x,
                          from->y + part / parts * dy + tile->wall_steps * normal.y, piece, error);
    return status;
}

/* The feet of the wall: one wall's width away from each point of the outline, and from long edges between them. */
static enum scree_status put_feet(const struct tin_patch *patch, const struct tin_tile *tile, struct tin_piece *piece,
                                  struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct outward *outward =
        scree_allocate(patch->memory, patch->point_count, sizeof *outward, "a tile's outline", error);
    if (outward == NULL) return error->status;
    for (uint32_t edge = 0; edge < 3 * patch->triangle_count && status == SCREE_OK; edge++)
        if (patch->twins[edge] == TIN_PATCH_NONE) status = put_feet_along(patch, tile, edge, outward, piece, error);
    for (uint32_t p = 0; p < patch->point_count && status == SCREE_OK; p++) {
        double squared = outward[p].x * outward[p].x + outward[p].y * outward[p].y;
        if (squared < SHARPEST) continue; /* inside, or at the tip of a needle */
        /* two normals whose sum is s: their mitre is 2 s / |s|^2 wide */
        double reach = 2 * tile->wall_steps / fmax(squared, 4 * SHARPEST * SHARPEST);
        status = put_foot(patch, tile, patch->points[p].x + reach * outward[p].x,
                          patch->points[p].y + reach * outward[p].y, piece, error);
    }
    scree_release(patch->memory, outward);
    return status;
}

/* The grid of a tile without data, where there are none. */
static enum scree_status put_level(const struct tin_patch *patch, const struct tin_tile *tile, struct tin_piece *piece,
                                   struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (int64_t y = tile->level_step; y < tile->rows; y += tile->level_step)
        for (int64_t x = tile->level_step; x < tile->columns && status == SCREE_OK; x += tile->level_step) {
            struct tin_post post = {.x = (int32_t)x, .y = (int32_t)y};
            status = put_outside(patch, tile, post, tile->wall_steps, piece, error);
        }
    return status;
}

enum scree_status tin_piece_make(struct scree_memory *memory, const struct tin_lattice *lattice,
                                 const struct tin_tile *tile, struct tin_piece *piece, struct scree_error *error) {
    struct tin_patch patch = {0};
    uint32_t *points = NULL;
    *piece = (struct tin_piece){0};
    enum scree_status status = tin_patch_make(memory, lattice, tile->column, tile->row, &patch, error);
    if (status == SCREE_OK) status = constrained_begin(memory, tile->columns, tile->rows, &piece->mesh, error);
    for (int side = 0; side < SIDE_COUNT && status == SCREE_OK; side++)
        status = tin_side_make(&patch, tile, (enum tile_side)side, &piece->sides[side], error);
    if (status == SCREE_OK) status = put_sides(memory, piece, error);
    if (status != SCREE_OK) goto cleanup;
    points = scree_allocate(memory, patch.point_count, sizeof *points, "the points of a tile", error);
    status = points == NULL ? error->status : put_points(&patch, tile, piece, points, error);
    if (status == SCREE_OK) status = fix_edges(&patch, tile, points, piece, error);
    if (status == SCREE_OK) status = put_feet(&patch, tile, piece, error);
    if (status == SCREE_OK) status = put_level(&patch, tile, piece, error);
cleanup:
    scree_release(memory, points);
    tin_patch_release(&patch);
    if (status != SCREE_OK) tin_piece_release(memory, piece);
    return status;
}
