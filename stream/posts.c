#include "stream/posts.h"

#include <string.h>

#define SMALL_BOX  256 /* posts of a bounding box that are looked at one by one */
#define MOST_POSTS 65535

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
        edges->owned[i] =
            edges->dy[i] > 0 || (edges->dy[i] == 0 && edges->dx[i] > 0) || triangle->twin[i] == SURFACE_NONE;
    }
}

static inline int64_t left_of(const struct edges *edges, int i, int64_t x, int64_t y) {
    return edges->dx[i] * (y - edges->y[i]) - edges->dy[i] * (x - edges->x[i]);
}

static inline bool belongs(const struct edges *edges, int64_t x, int64_t y) {
    int zeros = 0;
    for (int i = 0; i < 3; i++) {
        int64_t left = left_of(edges, i, x, y);
        if (left < 0 || (left == 0 && !edges->owned[i])) return false;
        zeros += left == 0;
    }
    return zeros < 2; /* two: a corner */
}

bool posts_belong(const struct surface *surface, uint32_t triangle, int32_t x, int32_t y) {
    struct edges edges;
    edges_of(surface, triangle, &edges);
    return belongs(&edges, x, y);
}

static uint32_t common_divisor(int64_t dx, int64_t dy) {
    uint32_t a = (uint32_t)(dx < 0 ? -dx : dx), b = (uint32_t)(dy < 0 ? -dy : dy);
    if (a == 1 || b == 1) return 1;
    while (b != 0) {
        uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Pick's theorem: twice the area is 2 * inside + on the edges - 2. */
uint16_t posts_count(const struct surface *surface, uint32_t triangle) {
    struct edges edges;
    edges_of(surface, triangle, &edges);
    int64_t area2 = edges.dx[0] * edges.dy[1] - edges.dx[1] * edges.dy[0], around = 0, owned = 0;
    if (area2 == 1) return 0;
    for (int i = 0; i < 3; i++) {
        int64_t steps = common_divisor(edges.dx[i], edges.dy[i]);
        around += steps;
        if (edges.owned[i]) owned += steps - 1;
    }
    int64_t count = (area2 - around + 2) / 2 + owned;
    return count < MOST_POSTS ? (uint16_t)count : MOST_POSTS;
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

/* Walks through the posts of the box, row by row, to post number `index` of the triangle or to (x, y), whichever comes
 * first; returns the number of the post where it stopped, which is in x and y then. */
static uint32_t walk_posts(const struct edges *edges, const struct box *box, uint32_t index, int32_t *x, int32_t *y) {
    int32_t row_left[3], left[3], dx[3], dy[3]; /* a small box: all of it fits */
    uint32_t passed = 0;
    for (int i = 0; i < 3; i++) {
        dx[i] = (int32_t)edges->dx[i];
        dy[i] = (int32_t)edges->dy[i];
        row_left[i] = (int32_t)left_of(edges, i, box->x_first, box->y_first) - (edges->owned[i] ? 0 : 1);
    }
    for (int32_t at_y = (int32_t)box->y_first; at_y <= box->y_last; at_y++) {
        memcpy(left, row_left, sizeof left);
        for (int32_t at_x = (int32_t)box->x_first; at_x <= box->x_last; at_x++) {
            if ((left[0] | left[1] | left[2]) >= 0 && !is_corner(edges, at_x, at_y)) {
                if (passed == index || (at_x == *x && at_y == *y)) {
                    *x = at_x;
                    *y = at_y;
                    return passed;
                }
                passed++;
            }
            for (int i = 0; i < 3; i++) left[i] -= dy[i];
        }
        for (int i = 0; i < 3; i++) row_left[i] += dx[i];
    }
    return passed;
}

static void code_small(struct range_coder *coder, const struct edges *edges, const struct box *box, uint16_t count,
                       int32_t *x, int32_t *y) {
    uint32_t index = 0;
    if (coder->writing)
        index = walk_posts(edges, box, UINT32_MAX, x, y);
    else
        *x = *y = INT32_MIN;
    index = code_uniform(coder, count, index);
    if (!coder->writing) walk_posts(edges, box, index, x, y);
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

static bool code_large(struct range_coder *coder, struct post_models *models, const struct edges *edges,
                       const struct box *box, int32_t *x, int32_t *y) {
    int64_t first, last, rows = box->y_last - box->y_first + 1;
    int64_t row = box->y_first + (int64_t)code_place(coder, models->row, (uint64_t)rows, (uint64_t)(*y - box->y_first));
    row_range(edges, row, &first, &last);
    if (first > last) return false;
    int64_t column =
        first + (int64_t)code_place(coder, models->column, (uint64_t)(last - first + 1), (uint64_t)(*x - first));
    *x = (int32_t)column;
    *y = (int32_t)row;
    return true;
}

void post_models_start(struct post_models *models) {
    for (int i = 0; i < 8; i++) models->row[i] = models->column[i] = bit_model(50);
}

bool posts_code(struct range_coder *coder, struct post_models *models, const struct surface *surface, uint32_t triangle,
                int32_t *x, int32_t *y) {
    struct edges edges;
    edges_of(surface, triangle, &edges);
    struct box box = box_of(&edges);
    int64_t width = box.x_last - box.x_first + 1, height = box.y_last - box.y_first + 1;
    if (width <= SMALL_BOX && height <= SMALL_BOX && width * height <= SMALL_BOX) {
        code_small(coder, &edges, &box, surface->triangles[triangle].posts, x, y);
        return true;
    }
    return code_large(coder, models, &edges, &box, x, y);
}
