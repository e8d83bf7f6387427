#include "stream/places.h"

#include <string.h>

#define SMALL_BOX 256 /* posts of a bounding box that are looked at one by one */

/* A triangle as three edges: edge i runs from corner i, and a point lies left of it by (dx * (y - y0) - dy * (x - x0)),
 * twice the area of the triangle that they make. */
struct edges {
    int64_t x[3], y[3], dx[3], dy[3];
    bool owned[3];
};

static void edges_of(const struct surface *surface, uint32_t t, struct edges *edges) {
    const struct surface_triangle *triangle = &surface->triangles[t];
    for (int i = 0; i < 3; i++) {
        const struct scree_vertex *a = &surface->vertices[triangle->vertex[i]];
        const struct scree_vertex *b = &surface->vertices[triangle->vertex[i == 2 ? 0 : i + 1]];
        edges->x[i] = a->x;
        edges->y[i] = a->y;
        edges->dx[i] = (int64_t)b->x - a->x;
        edges->dy[i] = (int64_t)b->y - a->y;
        edges->owned[i] = surface_owns(a, b, triangle->twin[i]);
    }
}

static inline int64_t left_of(const struct edges *edges, int i, int64_t x, int64_t y) {
    return edges->dx[i] * (y - edges->y[i]) - edges->dy[i] * (x - edges->x[i]);
}

/* ---- small triangles: the posts are counted through ---- */

struct box {
    int64_t x_first, y_first, x_last, y_last;
};

static struct box box_of(const struct edges *edges) {
    struct box box = {edges->x[0], edges->y[0], edges->x[0], edges->y[0]};
    for (int i = 1; i < 3; i++) {
        if (edges->x[i] < box.x_first) box.x_first = edges->x[i];
        if (edges->x[i] > box.x_last) box.x_last = edges->x[i];
        if (edges->y[i] < box.y_first) box.y_first = edges->y[i];
        if (edges->y[i] > box.y_last) box.y_last = edges->y[i];
    }
    return box;
}

static bool is_corner(const struct edges *edges, int64_t x, int64_t y) {
    return (x == edges->x[0] && y == edges->y[0]) || (x == edges->x[1] && y == edges->y[1]) ||
           (x == edges->x[2] && y == edges->y[2]);
}

/* A walk through a small box, row by row, from one post of the triangle to the next. */
struct walk {
    int32_t x, y; /* the present one; nothing before the first step */
    int32_t x_first, x_last, y_last;
    int32_t left[3], row[3], dx[3], dy[3]; /* how far left of each edge: here, and where the row begins */
};

static struct walk walk_start(const struct edges *edges, const struct box *box) {
    struct walk walk = {.x = (int32_t)box->x_first - 1,
                        .y = (int32_t)box->y_first,
                        .x_first = (int32_t)box->x_first,
                        .x_last = (int32_t)box->x_last,
                        .y_last = (int32_t)box->y_last};
    for (int i = 0; i < 3; i++) {
        walk.dx[i] = (int32_t)edges->dx[i];
        walk.dy[i] = (int32_t)edges->dy[i];
        walk.row[i] = (int32_t)left_of(edges, i, box->x_first, box->y_first) - (edges->owned[i] ? 0 : 1);
        walk.left[i] = walk.row[i] + walk.dy[i];
    }
    return walk;
}

static bool walk_on(struct walk *walk, const struct edges *edges) {
    for (;;) {
        if (walk->x < walk->x_last) {
            walk->x++;
            for (int i = 0; i < 3; i++) walk->left[i] -= walk->dy[i];
        } else {
            if (walk->y == walk->y_last) return false;
            walk->y++;
            walk->x = walk->x_first;
            for (int i = 0; i < 3; i++) walk->left[i] = walk->row[i] += walk->dx[i];
        }
        if ((walk->left[0] | walk->left[1] | walk->left[2]) >= 0 && !is_corner(edges, walk->x, walk->y)) return true;
    }
}

/* One of `posts` posts, all alike. */
static void code_one(struct range_coder *coder, const struct edges *edges, const struct box *box, uint32_t posts,
                     struct pending *place) {
    struct walk walk = walk_start(edges, box);
    uint32_t index = 0;
    if (coder->writing) {
        while (walk_on(&walk, edges) && (walk.x != place->x || walk.y != place->y)) index++;
        code_uniform(coder, posts, index);
        return;
    }
    index = code_uniform(coder, posts, 0);
    for (uint32_t i = 0; i <= index; i++) walk_on(&walk, edges);
    place->x = walk.x;
    place->y = walk.y;
}

/* A set of posts, all sets of that size alike: of each post, whether it is one of those that are left. */
static void code_set(struct range_coder *coder, const struct edges *edges, const struct box *box, uint32_t posts,
                     uint32_t count, struct pending *places) {
    struct walk walk = walk_start(edges, box);
    for (uint32_t chosen = 0; chosen < count && walk_on(&walk, edges); posts--) {
        uint32_t share = count - chosen;
        bool is_one =
            coder->writing ? places[chosen].x == walk.x && places[chosen].y == walk.y : code_ask(coder, posts) < share;
        code_take(coder, posts, is_one ? 0 : share, is_one ? share : posts - share);
        if (!is_one) continue;
        places[chosen].x = walk.x;
        places[chosen++].y = walk.y;
    }
}

/* ---- large ones: a row, then a post of it ---- */

static int64_t floor_quotient(int64_t a, int64_t b) { /* b > 0 */
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/* The posts of a row that belong to the triangle; empty when first > last. */
static void row_range(const struct edges *edges, int64_t y, int64_t *first, int64_t *last) {
    *first = INT32_MIN;
    *last = INT32_MAX;
    for (int i = 0; i < 3; i++) {
        int64_t dx = edges->dx[i], dy = edges->dy[i], up = y - edges->y[i];
        int64_t strict = edges->owned[i] ? 0 : 1;
        if (dy == 0) { /* the row is on one side as a whole */
            if (dx * up < strict) *last = *first - 1;
        } else if (dy > 0) { /* dy * (x - x0) <= dx * up - strict */
            int64_t most = edges->x[i] + floor_quotient(dx * up - strict, dy);
            if (most < *last) *last = most;
        } else { /* -dy * (x - x0) >= -(dx * up) + strict */
            int64_t least = edges->x[i] - floor_quotient(dx * up - strict, -dy);
            if (least > *first) *first = least;
        }
    }
    for (int i = 0; i < 3; i++) { /* corners are vertices */
        if (y == edges->y[i] && *first <= *last && *first == edges->x[i]) ++*first;
        if (y == edges->y[i] && *first <= *last && *last == edges->x[i]) --*last;
    }
}

/* A place on a scale of `count`: which eighth of it, learned, and then where in there. */
static uint64_t code_place(struct range_coder *coder, struct bit_model models[8], uint64_t count, uint64_t value) {
    if (count < 8) return code_uniform(coder, (uint32_t)count, (uint32_t)value);
    uint32_t eighth = 0, node = 1;
    while (eighth < 7 && value >= (eighth + 1) * count / 8) eighth++;
    for (int bit = 2; bit >= 0; bit--) node = 2 * node + code_bit(coder, &models[node], (eighth >> bit & 1) != 0);
    eighth = node - 8;
    uint64_t start = eighth * count / 8;
    return start + code_large_uniform(coder, (eighth + 1) * count / 8 - start, value - start);
}

static bool code_far(struct range_coder *coder, struct place_models *models, const struct edges *edges,
                     const struct box *box, struct pending *place) {
    int64_t first, last, rows = box->y_last - box->y_first + 1;
    int64_t row =
        box->y_first + (int64_t)code_place(coder, models->row, (uint64_t)rows, (uint64_t)(place->y - box->y_first));
    row_range(edges, row, &first, &last);
    if (first > last) return false;
    int64_t column =
        first + (int64_t)code_place(coder, models->column, (uint64_t)(last - first + 1), (uint64_t)(place->x - first));
    place->x = (int32_t)column;
    place->y = (int32_t)row;
    return true;
}

static bool is_after(const struct pending *place, const struct pending *last) {
    return place->y > last->y || (place->y == last->y && place->x > last->x);
}

void place_models_start(struct place_models *models) {
    for (int i = 0; i < 8; i++) models->row[i] = models->column[i] = bit_model(50);
}

bool places_code(struct range_coder *coder, struct place_models *models, const struct surface *surface,
                 uint32_t triangle, uint32_t count, struct pending *places) {
    struct edges edges;
    edges_of(surface, triangle, &edges);
    struct box box = box_of(&edges);
    int64_t width = box.x_last - box.x_first + 1, height = box.y_last - box.y_first + 1;
    if (width <= SMALL_BOX && height <= SMALL_BOX && width * height <= SMALL_BOX) {
        if (count == 1)
            code_one(coder, &edges, &box, surface->triangles[triangle].posts, places);
        else
            code_set(coder, &edges, &box, surface->triangles[triangle].posts, count, places);
        return true;
    }
    for (uint32_t i = 0; i < count; i++)
        if (!code_far(coder, models, &edges, &box, &places[i]) || (i > 0 && !is_after(&places[i], &places[i - 1])))
            return false;
    return true;
}
