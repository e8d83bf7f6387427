#include "lod/tin_side.h"

#include <stdbool.h>
#include <stdlib.h>

#define CORNER_SLACK 1 /* step: rounding may put a corner beside the surface that it is on */

/* A side as a line: `at` is where it lies across, positions along it are 0 to `length`. */
struct line {
    bool is_upright;
    int32_t at, length;
};

static struct line line_of(const struct tin_tile *tile, enum tile_side which) {
    bool is_upright = which == SIDE_WEST || which == SIDE_EAST;
    int32_t at = which == SIDE_EAST ? tile->columns : which == SIDE_NORTH ? tile->rows : 0;
    return (struct line){is_upright, at, is_upright ? tile->rows : tile->columns};
}

static int32_t across(const struct line *line, const struct tin_post *post) {
    return line->is_upright ? post->x : post->y;
}
static int32_t along(const struct line *line, const struct tin_post *post) {
    return line->is_upright ? post->y : post->x;
}

static struct tin_post post_at(const struct line *line, int32_t position, float height_m) {
    return (struct tin_post){
        line->is_upright ? line->at : position, line->is_upright ? position : line->at, height_m, {0, 0}};
}

/* ---- posts ---- */

static enum scree_status add(struct scree_memory *memory, struct tin_side *side, struct tin_post post,
                             struct scree_error *error) {
    if (side->count == side->capacity) {
        uint32_t capacity = side->capacity > 0 ? 2 * side->capacity : 64;
        void *posts = scree_reallocate(memory, side->posts, capacity, sizeof *side->posts, "a tile's side", error);
        if (posts == NULL) return error->status;
        side->posts = posts;
        side->capacity = capacity;
    }
    side->posts[side->count++] = post;
    return SCREE_OK;
}

void tin_side_release(struct scree_memory *memory, struct tin_side *side) {
    scree_release(memory, side->posts);
    *side = (struct tin_side){0};
}

/* Along either axis: the other coordinates of a side's posts are equal. Of posts in one place the lowest comes first,
 * and then the one of the lowest slopes. */
static int by_place(const void *left, const void *right) {
    const struct tin_post *a = left, *b = right;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    if (a->height_m != b->height_m) return a->height_m < b->height_m ? -1 : 1;
    if (a->slope.east != b->slope.east) return a->slope.east < b->slope.east ? -1 : 1;
    return (a->slope.north > b->slope.north) - (a->slope.north < b->slope.north);
}

static void sort_out(struct tin_side *side) {
    uint32_t kept = 0;
    if (side->count > 0) qsort(side->posts, side->count, sizeof *side->posts, by_place);
    for (uint32_t i = 0; i < side->count; i++)
        if (kept == 0 || side->posts[i].x != side->posts[kept - 1].x || side->posts[i].y != side->posts[kept - 1].y)
            side->posts[kept++] = side->posts[i];
    side->count = kept;
}

/* A point keeps its height, whatever crosses the line so near to it that rounding puts it there. Both are sorted out.
 */
static enum scree_status put_points(struct scree_memory *memory, const struct tin_side *points, struct tin_side *side,
                                    struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    uint32_t at = 0, crossings = side->count;
    for (uint32_t i = 0; i < points->count && status == SCREE_OK; i++) {
        const struct tin_post *point = &points->posts[i];
        while (at < crossings && (side->posts[at].x < point->x || side->posts[at].y < point->y)) at++;
        bool is_there = at < crossings && side->posts[at].x == point->x && side->posts[at].y == point->y;
        if (is_there)
            side->posts[at] = *point;
        else
            status = add(memory, side, *point, error);
    }
    if (status == SCREE_OK) sort_out(side);
    return status;
}

/* ---- where the surface meets the line ---- */

/* What a side is made of. */
struct findings {
    struct tin_side *crossings, *points;
};

struct span {
    int32_t from, to;
};

struct spans {
    struct span *items;
    uint32_t count;
};

static int by_beginning(const void *left, const void *right) {
    const struct span *a = left, *b = right;
    if (a->from != b->from) return a->from < b->from ? -1 : 1;
    return (a->to > b->to) - (a->to < b->to);
}

static void stretch(struct span *span, int32_t position) {
    if (position < span->from) span->from = position;
    if (position > span->to) span->to = position;
}

/* The part of the line in a triangle, and the posts that its edges leave there but for the line's ends. */
static enum scree_status meet(const struct tin_patch *patch, const struct line *line, uint32_t triangle,
                              struct span *span, struct findings found, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    *span = (struct span){INT32_MAX, INT32_MIN};
    for (uint32_t edge = 3 * triangle; edge < 3 * triangle + 3 && status == SCREE_OK; edge++) {
        uint32_t a = tin_patch_origin(patch, edge), b = tin_patch_target(patch, edge);
        int32_t from = across(line, &patch->points[a]), to = across(line, &patch->points[b]);
        struct tin_post post = patch->points[a];
        if (from != line->at) {
            if (to == line->at || (from < line->at) == (to < line->at)) continue;
            post = tin_patch_cross(patch, a, b, line->is_upright, line->at);
        }
        int32_t position = along(line, &post);
        stretch(span, position);
        bool is_first = a < b || patch->twins[edge] == TIN_PATCH_NONE || from == line->at; /* of two half-edges one */
        if (is_first && position > 0 && position < line->length)
            status = add(patch->memory, from == line->at ? found.points : found.crossings, post, error);
    }
    return status;
}

static enum scree_status meet_all(const struct tin_patch *patch, const struct line *line, struct spans *spans,
                                  struct findings found, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    spans->items = scree_allocate(patch->memory, (size_t)patch->triangle_count + 2, sizeof *spans->items,
                                  "what lies along a tile's side", error);
    if (spans->items == NULL) return error->status;
    for (uint32_t t = 0; t < patch->triangle_count && status == SCREE_OK; t++) {
        struct span *span = &spans->items[spans->count];
        status = meet(patch, line, t, span, found, error);
        if (span->from <= line->length && span->to >= 0) spans->count++;
    }
    return status;
}

/* ---- where it does not ---- */

struct gap {
    int32_t from, to;
    bool has_wall_before, has_wall_behind; /* else it ends at a corner that the surface does not reach */
};

/* Posts on the ground outside of the surface. */
static enum scree_status fill_gap(struct scree_memory *memory, const struct line *line, const struct tin_tile *tile,
                                  struct gap gap, struct tin_side *side, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    int32_t feet = gap.has_wall_before + gap.has_wall_behind, wall = tile->wall_steps;
    int64_t width = (int64_t)gap.to - gap.from;
    if (feet == 2 && width <= 2 * (int64_t)wall) { /* too narrow for two */
        if (width < 2) return SCREE_OK;
        return add(memory, side, post_at(line, (int32_t)(gap.from + width / 2), tile->outside_m), error);
    }
    if (feet == 1 && width <= wall) return SCREE_OK;
    int32_t first = gap.has_wall_before ? gap.from + wall : gap.from,
            last = gap.has_wall_behind ? gap.to - wall : gap.to;
    if (gap.has_wall_before) status = add(memory, side, post_at(line, first, tile->outside_m), error);
    if (gap.has_wall_behind && status == SCREE_OK)
        status = add(memory, side, post_at(line, last, tile->outside_m), error);
    for (int64_t at = (first / tile->level_step + 1) * (int64_t)tile->level_step; at < last && status == SCREE_OK;
         at += tile->level_step)
        status = add(memory, side, post_at(line, (int32_t)at, tile->outside_m), error);
    return status;
}

/* `ends`: whether the surface reaches the corners. */
static enum scree_status fill_gaps(const struct tin_patch *patch, const struct line *line, const struct tin_tile *tile,
                                   const bool ends[2], struct spans *spans, struct tin_side *side,
                                   struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct gap gap = {.from = 0, .has_wall_before = ends[0]};
    qsort(spans->items, spans->count, sizeof *spans->items, by_beginning);
    for (uint32_t i = 0; i <= spans->count && status == SCREE_OK; i++) {
        bool is_last = i == spans->count;
        gap.to = is_last ? line->length : spans->items[i].from;
        gap.has_wall_behind = is_last ? ends[1] : gap.to > 0;
        if (gap.to > gap.from) status = fill_gap(patch->memory, line, tile, gap, side, error);
        if (is_last || spans->items[i].to <= gap.from) continue;
        gap.from = spans->items[i].to;
        gap.has_wall_before = true;
    }
    return status;
}

enum scree_status tin_side_make(const struct tin_patch *patch, const struct tin_tile *tile, enum tile_side which,
                                struct tin_side *side, struct scree_error *error) {
    struct line line = line_of(tile, which);
    struct spans spans = {0};
    struct tin_side points = {0};
    struct tin_post corners[2] = {post_at(&line, 0, tile->outside_m), post_at(&line, line.length, tile->outside_m)};
    bool ends[2];
    enum scree_status status = SCREE_OK;
    *side = (struct tin_side){0};
    for (int i = 0; i < 2 && status == SCREE_OK; i++) {
        ends[i] = tin_patch_covers(patch, CORNER_SLACK, &corners[i]);
        status = add(patch->memory, side, corners[i], error);
    }
    if (status == SCREE_OK) status = meet_all(patch, &line, &spans, (struct findings){side, &points}, error);
    if (status == SCREE_OK) status = fill_gaps(patch, &line, tile, ends, &spans, side, error);
    sort_out(side);
    sort_out(&points);
    if (status == SCREE_OK) status = put_points(patch->memory, &points, side, error);
    if (status == SCREE_OK && side->count > BORDER_MAX_VERTICES)
        status = scree_fail(error, SCREE_E_LIMIT, "%u edges cross a side of a tile, %d can; name a smaller --block",
                            (unsigned)side->count, BORDER_MAX_VERTICES);
    scree_release(patch->memory, spans.items);
    tin_side_release(patch->memory, &points);
    if (status != SCREE_OK) tin_side_release(patch->memory, side);
    return status;
}
