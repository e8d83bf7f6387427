/* The constrained Delaunay triangulation: see the header. Points and constraints come in by splits and flips here;
 * points leave in constrained_shortcut.c. */
#include "lod/constrained.h"

#include "lod/constrained_flip.h"

#include <math.h>
#include <string.h>

#define NONE CONSTRAINED_NONE

/* ---- predicates ---- */

bool constrained_in_circle(struct constrained_point a, struct constrained_point b, struct constrained_point c,
                           struct constrained_point d) {
    const int64_t near = 1 << 14; /* 12 * near^4 < 2^63 */
    int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    int64_t aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    if (aa <= near * near && bb <= near * near && cc <= near * near)
        return ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx) > 0;
    __extension__ typedef __int128 wide;
    return ax * ((wide)by * cc - (wide)bb * cy) - ay * ((wide)bx * cc - (wide)bb * cx) +
               (wide)aa * (bx * cy - by * cx) >
           0;
}

/* ---- memory ---- */

/* Room for so many points, and what Euler says about triangles. */
static enum scree_status reserve(struct constrained *c, uint32_t point_count, struct scree_error *error) {
    const char *what = "a constrained triangulation";
    size_t triangle_count = 2 * (size_t)point_count;
    void *block = scree_reallocate(c->memory, c->points, point_count, sizeof *c->points, what, error);
    if (block == NULL) return SCREE_E_MEMORY;
    c->points = block;
    block = scree_reallocate(c->memory, c->leaving, point_count, sizeof *c->leaving, what, error);
    if (block == NULL) return SCREE_E_MEMORY;
    c->leaving = block;
    block = scree_reallocate(c->memory, c->triangles, triangle_count, sizeof *c->triangles, what, error);
    if (block == NULL) return SCREE_E_MEMORY;
    c->triangles = block;
    memset(c->triangles + c->triangle_count, 0, (triangle_count - c->triangle_count) * sizeof *c->triangles);
    block = scree_reallocate(c->memory, c->stack, 3 * triangle_count, sizeof *c->stack, what, error);
    if (block == NULL) return SCREE_E_MEMORY;
    c->stack = block;
    c->point_capacity = point_count;
    return SCREE_OK;
}

void constrained_release(struct constrained *c) {
    if (c->memory == NULL) return;
    scree_release(c->memory, c->stack);
    scree_release(c->memory, c->triangles);
    scree_release(c->memory, c->leaving);
    scree_release(c->memory, c->points);
    *c = (struct constrained){0};
}

enum scree_status constrained_begin(struct scree_memory *memory, int32_t width, int32_t height, struct constrained *c,
                                    struct scree_error *error) {
    *c = (struct constrained){.memory = memory, .width = width, .height = height, .free_triangle = NONE};
    if (width < 1 || height < 1 || width > CONSTRAINED_LARGEST_SIDE || height > CONSTRAINED_LARGEST_SIDE)
        return scree_fail(error, SCREE_E_ARGUMENT, "no triangulation of %d x %d units: sides are 1 to %d", (int)width,
                          (int)height, CONSTRAINED_LARGEST_SIDE);
    enum scree_status status = reserve(c, 256, error);
    if (status != SCREE_OK) {
        constrained_release(c);
        return status;
    }
    const struct constrained_point corners[4] = {{0, 0}, {width, 0}, {width, height}, {0, height}};
    memcpy(c->points, corners, sizeof corners);
    c->point_count = 4;
    uint32_t south = constrained_new_triangle(c), north = constrained_new_triangle(c);
    constrained_set(c, south, 0, 1, 2);
    constrained_set(c, north, 0, 2, 3);
    constrained_link(c, 3 * south, NONE, true);
    constrained_link(c, 3 * south + 1, NONE, true);
    constrained_link(c, 3 * north + 1, NONE, true);
    constrained_link(c, 3 * north + 2, NONE, true);
    constrained_link(c, 3 * south + 2, 3 * north, false);
    return SCREE_OK;
}

/* ---- points come in ---- */

/* The triangle whose closed area holds the place: a walk from the last one. Which edge is tried first changes from
 * step to step, as a walk through triangles that are not Delaunay could go round in circles. */
static uint32_t find_triangle(struct constrained *c, struct constrained_point at) {
    uint32_t t = c->hint, step = 0;
    for (;;) {
        uint32_t first = (++step * 2654435761U) >> 30, k = 0, across = NONE;
        for (; k < 3; k++) {
            uint32_t edge = 3 * t + (first + k) % 3;
            if (constrained_area2(c->points[constrained_origin(c, edge)], c->points[constrained_target(c, edge)], at) >=
                0)
                continue;
            across = constrained_twin(c, edge);
            break;
        }
        if (across == NONE) break;
        t = across / 3;
    }
    c->hint = t;
    return t;
}

static void split_triangle(struct constrained *c, uint32_t t, uint32_t p) {
    struct constrained_triangle old = c->triangles[t];
    uint32_t t1 = constrained_new_triangle(c), t2 = constrained_new_triangle(c);
    constrained_set(c, t, old.corner[0], old.corner[1], p);
    constrained_set(c, t1, old.corner[1], old.corner[2], p);
    constrained_set(c, t2, old.corner[2], old.corner[0], p);
    constrained_link(c, 3 * t, old.twin[0], old.fixed & 1);
    constrained_link(c, 3 * t1, old.twin[1], old.fixed & 2);
    constrained_link(c, 3 * t2, old.twin[2], old.fixed & 4);
    constrained_link(c, 3 * t + 1, 3 * t1 + 2, false);
    constrained_link(c, 3 * t1 + 1, 3 * t2 + 2, false);
    constrained_link(c, 3 * t2 + 1, 3 * t + 2, false);
    constrained_doubt(c, 3 * t);
    constrained_doubt(c, 3 * t1);
    constrained_doubt(c, 3 * t2);
}

/* One side of an edge that a point splits: triangle (a, b, apex) becomes (b, apex, p) and (apex, a, p). Returns the
 * second one. */
static uint32_t split_side(struct constrained *c, uint32_t edge, uint32_t p) {
    uint32_t next = constrained_next(edge), last = constrained_next(next), t = edge / 3;
    uint32_t a = constrained_origin(c, edge), b = constrained_origin(c, next), apex = constrained_origin(c, last);
    uint32_t ahead = constrained_twin(c, next), behind = constrained_twin(c, last);
    bool ahead_fixed = constrained_is_fixed(c, next), behind_fixed = constrained_is_fixed(c, last);
    uint32_t t1 = constrained_new_triangle(c);
    constrained_set(c, t, b, apex, p);
    constrained_set(c, t1, apex, a, p);
    constrained_link(c, 3 * t, ahead, ahead_fixed);
    constrained_link(c, 3 * t1, behind, behind_fixed);
    constrained_link(c, 3 * t + 1, 3 * t1 + 2, false);
    constrained_doubt(c, 3 * t);
    constrained_doubt(c, 3 * t1);
    return t1;
}

static void split_edge(struct constrained *c, uint32_t edge, uint32_t p) {
    uint32_t across = constrained_twin(c, edge), t = edge / 3;
    bool fixed = constrained_is_fixed(c, edge);
    uint32_t t1 = split_side(c, edge, p); /* t = (b, apex, p), t1 = (apex, a, p) */
    uint32_t pb = 3 * t + 2, ap = 3 * t1 + 1;
    if (across == NONE) {
        constrained_link(c, pb, NONE, fixed);
        constrained_link(c, ap, NONE, fixed);
        return;
    }
    uint32_t u = across / 3, u1 = split_side(c, across, p); /* u = (a, far apex, p), u1 = (far apex, b, p) */
    constrained_link(c, pb, 3 * u1 + 1, fixed);
    constrained_link(c, ap, 3 * u + 2, fixed);
}

enum scree_status constrained_insert(struct constrained *c, int32_t x, int32_t y, uint32_t *point,
                                     struct scree_error *error) {
    struct constrained_point at = {x, y};
    if (x < 0 || y < 0 || x > c->width || y > c->height)
        return scree_fail(error, SCREE_E_ARGUMENT, "point %d, %d is outside of the triangulation", (int)x, (int)y);
    uint32_t t = find_triangle(c, at), on_edge = NONE;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t edge = 3 * t + k, from = constrained_origin(c, edge), to = constrained_target(c, edge);
        if (c->points[from].x == x && c->points[from].y == y) {
            *point = from;
            return SCREE_OK;
        }
        if (constrained_area2(c->points[from], c->points[to], at) == 0) on_edge = edge;
    }
    if (c->point_count == c->point_capacity) {
        enum scree_status status = reserve(c, 2 * c->point_capacity, error);
        if (status != SCREE_OK) return status;
    }
    uint32_t p = c->point_count++;
    c->points[p] = at;
    if (on_edge == NONE)
        split_triangle(c, t, p);
    else
        split_edge(c, on_edge, p);
    constrained_settle(c);
    *point = p;
    return SCREE_OK;
}

/* ---- constraints come in ---- */

/* The segment from one point to another, and what it crosses next. */
struct crossing {
    uint32_t from, to; /* `to` becomes the first point that the segment meets */
    uint32_t count;    /* edges that it crosses on the way there */
    uint32_t (*edges)[2];
};

/* Whether `v` lies on the ray from a through b. */
static bool is_ahead(const struct constrained *c, uint32_t a, uint32_t b, uint32_t v) {
    struct constrained_point from = c->points[a], to = c->points[b], at = c->points[v];
    return constrained_area2(from, to, at) == 0 &&
           (int64_t)(to.x - from.x) * (at.x - from.x) + (int64_t)(to.y - from.y) * (at.y - from.y) > 0;
}

/* Looks round `from`: the half-edge between `from` and a point on the segment (returned, `*meets` is that point), or
 * the half-edge opposite `from` through which the segment leaves (`*meets` is CONSTRAINED_NONE). */
static uint32_t look_along(const struct constrained *c, uint32_t from, uint32_t to, uint32_t *meets) {
    uint32_t first = constrained_first_leaving(c, from), edge = first, through = NONE;
    do {
        uint32_t right = constrained_target(c, edge), last = constrained_previous(edge);
        uint32_t left = constrained_origin(c, last);
        *meets = right;
        if (is_ahead(c, from, to, right)) return edge;
        *meets = left;
        if (is_ahead(c, from, to, left)) return last;
        if (constrained_area2(c->points[from], c->points[to], c->points[right]) < 0 &&
            constrained_area2(c->points[from], c->points[to], c->points[left]) > 0)
            through = constrained_next(edge);
        edge = constrained_turn(c, edge);
    } while (edge != NONE && edge != first);
    *meets = NONE;
    return through;
}

/* Walks from the first crossed half-edge to the first point on the segment, which becomes `to`; fills `edges` if there
 * are any. False: a constraint is in the way. */
static bool walk_across(const struct constrained *c, uint32_t edge, struct crossing *crossing) {
    struct constrained_point from = c->points[crossing->from], to = c->points[crossing->to];
    for (crossing->count = 0;;) {
        if (constrained_is_fixed(c, edge)) return false;
        if (crossing->edges != NULL) {
            crossing->edges[crossing->count][0] = constrained_origin(c, edge);
            crossing->edges[crossing->count][1] = constrained_target(c, edge);
        }
        crossing->count++;
        uint32_t across = constrained_twin(c, edge), apex = constrained_apex(c, across);
        int64_t side = constrained_area2(from, to, c->points[apex]);
        if (side == 0) {
            crossing->to = apex;
            return true;
        }
        edge = side > 0 ? constrained_next(across) : constrained_previous(across);
    }
}

static bool strictly_crosses(const struct constrained *c, const struct crossing *crossing, uint32_t a, uint32_t b) {
    struct constrained_point from = c->points[crossing->from], to = c->points[crossing->to];
    int64_t side_a = constrained_area2(from, to, c->points[a]), side_b = constrained_area2(from, to, c->points[b]);
    return (side_a < 0 && side_b > 0) || (side_a > 0 && side_b < 0);
}

/* Flips the crossed edges away, first in, first out, those of a concave quadrilateral later (Sloan, "A fast algorithm
 * for generating constrained Delaunay triangulations", 1993). */
static void flip_crossed(struct constrained *c, struct crossing *crossing) {
    uint32_t room = crossing->count, first = 0;
    while (crossing->count > 0) {
        uint32_t a = crossing->edges[first][0], b = crossing->edges[first][1];
        uint32_t edge = constrained_between(c, a, b);
        first = (first + 1) % room;
        crossing->count--;
        if (constrained_is_convex(c, edge)) {
            a = constrained_apex(c, edge);
            b = constrained_apex(c, constrained_twin(c, edge));
            constrained_flip(c, edge);
            if (!strictly_crosses(c, crossing, a, b)) continue;
        }
        uint32_t *behind = crossing->edges[(first + crossing->count++) % room];
        behind[0] = a;
        behind[1] = b;
    }
}

enum scree_status constrained_fix(struct constrained *c, uint32_t from, uint32_t to, struct scree_error *error) {
    struct scree_error own_error = {0};
    if (error == NULL) error = &own_error;
    while (from != to) {
        struct crossing crossing = {.from = from, .to = to};
        uint32_t meets, edge = look_along(c, from, to, &meets);
        if (meets != NONE) {
            constrained_make_fixed(c, edge);
            from = meets;
            continue;
        }
        if (!walk_across(c, edge, &crossing))
            return scree_fail(error, SCREE_E_ARGUMENT, "an edge from %d, %d to %d, %d would cross another one",
                              (int)c->points[from].x, (int)c->points[from].y, (int)c->points[to].x,
                              (int)c->points[to].y);
        crossing.edges =
            scree_allocate(c->memory, crossing.count, sizeof *crossing.edges, "the edges in a constraint's way", error);
        if (crossing.edges == NULL) return error->status;
        crossing.to = to;
        walk_across(c, edge, &crossing);
        flip_crossed(c, &crossing);
        scree_release(c->memory, crossing.edges);
        constrained_make_fixed(c, constrained_between(c, from, crossing.to));
        constrained_settle(c);
        from = crossing.to;
    }
    return SCREE_OK;
}

/* ---- distances ---- */

static double segment_distance(struct constrained_point a, struct constrained_point b, struct constrained_point at) {
    double dx = b.x - a.x, dy = b.y - a.y, x = at.x - a.x, y = at.y - a.y;
    double share = (x * dx + y * dy) / (dx * dx + dy * dy);
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    return sqrt((x - share * dx) * (x - share * dx) + (y - share * dy) * (y - share * dy));
}

static bool triangle_is_clear(const struct constrained *c, uint32_t t, struct constrained_point at, double clearance) {
    for (uint32_t edge = 3 * t; edge < 3 * t + 3; edge++)
        if (constrained_is_fixed(c, edge) && segment_distance(c->points[constrained_origin(c, edge)],
                                                              c->points[constrained_target(c, edge)], at) < clearance)
            return false;
    return true;
}

bool constrained_is_clear(struct constrained *c, int32_t x, int32_t y, double clearance) {
    struct constrained_point at = {x, y};
    uint32_t t = find_triangle(c, at);
    if (!triangle_is_clear(c, t, at, clearance)) return false;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t across = c->triangles[t].twin[k];
        if (across != NONE && !triangle_is_clear(c, across / 3, at, clearance)) return false;
    }
    return true;
}
