/* A point leaves its line and the triangulation: see lod/constrained.h. All of it is flips of the edges that end in the
 * point. A flip cuts off one corner of the point's star; the new constraint is there once the corners on its far side
 * are gone, and the point goes when three or four triangles are left around it. */
#include "lod/constrained.h"
#include "lod/constrained_flip.h"

#define NONE CONSTRAINED_NONE

/* The two constraints that end in the point, as half-edges that leave it. */
struct bend {
    uint32_t point;
    uint32_t spoke[2];
    int64_t side; /* twice the area of (first end, point, second end) */
};

static bool find_bend(const struct constrained *c, uint32_t point, struct bend *bend) {
    uint32_t first = c->leaving[point], edge = first;
    int count = 0;
    do {
        if (constrained_is_fixed(c, edge)) {
            if (count < 2) bend->spoke[count] = edge;
            count++;
        }
        edge = constrained_turn(c, edge);
    } while (edge != NONE && edge != first);
    if (edge == NONE || count != 2) return false;
    bend->point = point;
    bend->side = constrained_area2(c->points[constrained_target(c, bend->spoke[0])], c->points[point],
                                   c->points[constrained_target(c, bend->spoke[1])]);
    /* The triangle (first end, point, second end) turns clockwise when the way round from the first spoke to the second
     * one is the narrow one; else the other way round is. */
    if (bend->side > 0) {
        uint32_t other = bend->spoke[0];
        bend->spoke[0] = bend->spoke[1];
        bend->spoke[1] = other;
        bend->side = -bend->side;
    }
    return true;
}

/* Whether the segment from end to end is free: nothing between the spokes comes up to it. */
static bool may_go(const struct constrained *c, const struct bend *bend) {
    if (bend->side == 0) return true;
    struct constrained_point from = c->points[constrained_target(c, bend->spoke[0])];
    struct constrained_point to = c->points[constrained_target(c, bend->spoke[1])];
    uint32_t edge = constrained_turn(c, bend->spoke[0]);
    if (edge == bend->spoke[1]) return !constrained_is_fixed(c, constrained_next(bend->spoke[0]));
    for (; edge != bend->spoke[1]; edge = constrained_turn(c, edge))
        if (constrained_area2(from, to, c->points[constrained_target(c, edge)]) >= 0) return false;
    return true;
}

static uint32_t spoke_to(const struct constrained *c, uint32_t point, uint32_t end) {
    uint32_t edge = constrained_between(c, point, end);
    return constrained_origin(c, edge) == point ? edge : constrained_twin(c, edge);
}

/* Flips spokes between those to `from` and, counter-clockwise, to `to` until `left` of them are left. There is always
 * one that can go: the points between, with the segment from end to end, are a simple polygon, and that has an ear. */
static void clear_between(struct constrained *c, uint32_t point, uint32_t from, uint32_t to, uint32_t left) {
    for (;;) {
        uint32_t count = 0, convex = NONE;
        for (uint32_t edge = constrained_turn(c, spoke_to(c, point, from)); constrained_target(c, edge) != to;
             edge = constrained_turn(c, edge)) {
            if (convex == NONE && constrained_is_convex(c, edge)) convex = edge;
            count++;
        }
        if (count <= left) return;
        constrained_flip(c, convex);
    }
}

/* A star of three or four points, counter-clockwise, becomes one or two triangles; the first point and the third are
 * joined then. */
static void close_star(struct constrained *c, uint32_t spoke, uint32_t count) {
    uint32_t corner[4], twin[4], triangle[4], point = constrained_origin(c, spoke);
    bool fixed[4];
    for (uint32_t i = 0; i < count; i++, spoke = constrained_turn(c, spoke)) {
        uint32_t outer = constrained_next(spoke);
        corner[i] = constrained_origin(c, outer);
        twin[i] = constrained_twin(c, outer);
        fixed[i] = constrained_is_fixed(c, outer);
        triangle[i] = spoke / 3;
    }
    uint32_t t = triangle[0], u = triangle[1];
    constrained_set(c, t, corner[0], corner[1], corner[2]);
    constrained_link(c, 3 * t, twin[0], fixed[0]);
    constrained_link(c, 3 * t + 1, twin[1], fixed[1]);
    if (count == 3) {
        constrained_link(c, 3 * t + 2, twin[2], fixed[2]);
        constrained_free_triangle(c, u);
        constrained_free_triangle(c, triangle[2]);
    } else {
        constrained_set(c, u, corner[0], corner[2], corner[3]);
        constrained_link(c, 3 * u, 3 * t + 2, false);
        constrained_link(c, 3 * u + 1, twin[2], fixed[2]);
        constrained_link(c, 3 * u + 2, twin[3], fixed[3]);
        constrained_free_triangle(c, triangle[2]);
        constrained_free_triangle(c, triangle[3]);
        for (uint32_t k = 0; k < 3; k++) constrained_doubt(c, 3 * u + k);
    }
    for (uint32_t k = 0; k < 3; k++) constrained_doubt(c, 3 * t + k);
    c->leaving[point] = NONE;
    c->hint = t;
}

/* A point without constraints goes: flips until its star is small, which end at three triangles, or at four where the
 * point lies on a diagonal of the four points around it. */
static void take_out(struct constrained *c, uint32_t point) {
    for (;;) {
        uint32_t first = c->leaving[point], edge = first, count = 0, convex = NONE;
        do {
            if (convex == NONE && constrained_is_convex(c, edge)) convex = edge;
            count++;
            edge = constrained_turn(c, edge);
        } while (edge != first);
        if (count > 3 && convex != NONE) {
            constrained_flip(c, convex);
            continue;
        }
        if (count == 4) {
            uint32_t opposite = constrained_target(c, constrained_turn(c, constrained_turn(c, first)));
            struct constrained_point from = c->points[constrained_target(c, first)];
            if (constrained_area2(from, c->points[point], c->points[opposite]) != 0) first = constrained_turn(c, first);
        }
        close_star(c, first, count);
        return;
    }
}

bool constrained_shortcut(struct constrained *c, uint32_t point) {
    struct bend bend;
    if (point >= c->point_count || c->leaving[point] == NONE || !find_bend(c, point, &bend) || !may_go(c, &bend))
        return false;
    uint32_t from = constrained_target(c, bend.spoke[0]), to = constrained_target(c, bend.spoke[1]);
    constrained_make_free(c, bend.spoke[0]);
    constrained_make_free(c, bend.spoke[1]);
    if (bend.side != 0) {
        clear_between(c, point, from, to, 0);
        constrained_make_fixed(c, constrained_next(spoke_to(c, point, from)));
        take_out(c, point);
    } else {
        clear_between(c, point, from, to, 1);
        clear_between(c, point, to, from, 1);
        close_star(c, spoke_to(c, point, from), 4);
        constrained_make_fixed(c, constrained_between(c, from, to));
    }
    constrained_settle(c);
    return true;
}
