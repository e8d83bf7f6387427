/* Greedy insertion: see the header. Three parts: the search for a triangle's worst post, a heap of triangles by that
 * error, and the Delaunay triangulation that grows by one post at a time. */
#include "lod/greedy.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define NONE UINT32_MAX /* no neighbour, not in the heap */

/* Edge k of a triangle leads from corner k to corner k + 1. Half-edge 3 * t + k is edge k of triangle t. */
struct triangle {
    uint32_t corner[3];
    uint32_t twin[3];   /* the half-edge on the other side, NONE on the border */
    uint32_t candidate; /* post of the largest error: y * columns + x */
    uint32_t heap_slot; /* NONE while the error is within the tolerance */
};

struct heap_entry {
    double error_m;
    uint32_t triangle;
};

struct point {
    int32_t x, y;
};

struct greedy {
    const float *heights_m;
    int columns, rows, stride;
    double tolerance_m;
    double rounding; /* relative to the extent of a triangle: 0 where the heights are whole numbers */
    struct point *points;
    struct triangle *triangles;
    struct heap_entry *heap;
    uint32_t point_count, triangle_count, heap_count;
    uint32_t point_capacity;
    struct scree_memory *memory;
};

static float height_at(const struct greedy *g, int32_t x, int32_t y) {
    return g->heights_m[(size_t)y * (size_t)g->stride + (size_t)x];
}

/* ---- the worst post of a triangle ---- */

/* A triangle's side as it is walked down the rows: `x` is the first (left sides) or last (right sides) post of the row
 * inside of it, kept exact by carrying the remainder of the division. */
struct side {
    int32_t x, step;             /* whole posts a row */
    int32_t rest, rest_step, dy; /* numerators over dy */
};

static int32_t floor_div(int32_t a, int32_t b) {
    int32_t q = a / b;
    return q - (a % b != 0 && a < 0);
}

/* The side from `low` to `high`, low.y < high.y. `ceiling`: round inwards from the left. */
static struct side side_new(struct point low, struct point high, bool ceiling) {
    struct side side = {.dy = high.y - low.y};
    int32_t dx = high.x - low.x;
    side.x = low.x;
    side.step = floor_div(dx, side.dy);
    side.rest_step = dx - side.step * side.dy;
    /* A ceiling is the floor of a value that is larger by (dy - 1) / dy. */
    side.rest = ceiling ? side.dy - 1 : 0;
    return side;
}

static void side_advance(struct side *side) {
    side->x += side->step;
    side->rest += side->rest_step;
    if (side->rest >= side->dy) {
        side->rest -= side->dy;
        side->x++;
    }
}

/* A triangle's plane over its own rows: the error times twice the area is area2 * z - (base + step_x * x + step_y * y)
 * with x, y from the lowest corner. Whole heights make every term a whole number below 2^53, hence exact. */
struct plane {
    double area2, base, step_x, step_y;
};

struct peak {
    double error_area2; /* error in metres times twice the area */
    uint32_t post;
};

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* Looks for a post of a row that beats the peak; `offset` is the plane's value at the row's first post. */
static void scan_row(const float *z, int32_t count, const struct plane *plane, double offset, uint32_t first_post,
                     struct peak *peak) {
    const double area2 = plane->area2, step_x = plane->step_x;
    double row_peak = 0;
    int32_t i = 0;
    if (count >= 8) { /* independent lanes; a maximum does not depend on the order of its parts */
        double high[4] = {0}, low[4] = {0};
        for (; i + 4 <= count; i += 4)
            for (int lane = 0; lane < 4; lane++) {
                double r = area2 * (double)z[i + lane] - (offset + step_x * (double)(i + lane));
                high[lane] = larger(r, high[lane]);
                low[lane] = larger(-r, low[lane]);
            }
        for (int lane = 0; lane < 4; lane++) row_peak = larger(row_peak, larger(high[lane], low[lane]));
    }
    for (; i < count; i++) row_peak = larger(row_peak, fabs(area2 * (double)z[i] - (offset + step_x * (double)i)));
    if (row_peak <= peak->error_area2) return;
    i = 0;
    while (fabs(area2 * (double)z[i] - (offset + step_x * (double)i)) != row_peak) i++;
    peak->error_area2 = row_peak;
    peak->post = first_post + (uint32_t)i;
}

static struct plane plane_through(const struct greedy *g, struct point a, struct point b, struct point c) {
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double za = (double)height_at(g, a.x, a.y);
    double bz = (double)height_at(g, b.x, b.y) - za, cz = (double)height_at(g, c.x, c.y) - za;
    struct plane plane = {.area2 = bx * cy - by * cx, .step_x = bz * cy - cz * by, .step_y = cz * bx - bz * cx};
    plane.base = za * plane.area2;
    return plane;
}

static void swap_points(struct point *a, struct point *b) {
    struct point other = *a;
    *a = *b;
    *b = other;
}

/* Visits every post of the closed triangle a b c (counter-clockwise) and returns its error; `candidate` is the post. */
static double worst_post(const struct greedy *g, struct point a, struct point b, struct point c, uint32_t *candidate) {
    struct plane plane = plane_through(g, a, b, c);
    struct point origin = a;
    if (b.y < a.y) swap_points(&a, &b);
    if (c.y < a.y) swap_points(&a, &c);
    if (c.y < b.y) swap_points(&b, &c);
    bool middle_is_right = (int64_t)(b.x - a.x) * (c.y - a.y) > (int64_t)(b.y - a.y) * (c.x - a.x);

    struct side long_side = side_new(a, c, middle_is_right);
    struct side short_side = a.y < b.y ? side_new(a, b, !middle_is_right) : (struct side){.x = b.x};
    struct peak peak = {0, 0};
    for (int32_t y = a.y;;) {
        int32_t first = middle_is_right ? long_side.x : short_side.x;
        int32_t last = middle_is_right ? short_side.x : long_side.x;
        if (first <= last) {
            double offset =
                plane.base + plane.step_y * (double)(y - origin.y) + plane.step_x * (double)(first - origin.x);
            scan_row(g->heights_m + (size_t)y * (size_t)g->stride + (size_t)first, last - first + 1, &plane, offset,
                     (uint32_t)y * (uint32_t)g->columns + (uint32_t)first, &peak);
        }
        if (y == c.y) break;
        if (y == b.y) short_side = side_new(b, c, !middle_is_right);
        side_advance(&long_side);
        side_advance(&short_side);
        y++;
    }

    *candidate = peak.post;
    if (g->rounding == 0) return peak.error_area2 / plane.area2;
    int32_t west = a.x < b.x ? a.x : b.x, east = a.x > b.x ? a.x : b.x;
    west = west < c.x ? west : c.x;
    east = east > c.x ? east : c.x;
    double rounding_area2 = g->rounding * (double)(east - west) * (double)(c.y - a.y);
    return peak.error_area2 <= rounding_area2 ? 0 : (peak.error_area2 + rounding_area2) / plane.area2;
}

/* ---- the heap: the largest error on top, four children a node, ties by triangle ---- */

static bool goes_before(struct heap_entry a, struct heap_entry b) {
    return a.error_m > b.error_m || (a.error_m == b.error_m && a.triangle < b.triangle);
}

static void heap_put(struct greedy *g, uint32_t slot, struct heap_entry entry) {
    g->heap[slot] = entry;
    g->triangles[entry.triangle].heap_slot = slot;
}

/* Lets `entry` sink or rise from a free slot to where it belongs. */
static void heap_settle(struct greedy *g, uint32_t slot, struct heap_entry entry) {
    while (slot > 0 && goes_before(entry, g->heap[(slot - 1) / 4])) {
        heap_put(g, slot, g->heap[(slot - 1) / 4]);
        slot = (slot - 1) / 4;
    }
    for (;;) {
        uint32_t first = 4 * slot + 1, best = first;
        if (first >= g->heap_count) break;
        uint32_t end = first + 4 < g->heap_count ? first + 4 : g->heap_count;
        for (uint32_t child = first + 1; child < end; child++)
            if (goes_before(g->heap[child], g->heap[best])) best = child;
        if (!goes_before(g->heap[best], entry)) break;
        heap_put(g, slot, g->heap[best]);
        slot = best;
    }
    heap_put(g, slot, entry);
}

static void heap_remove(struct greedy *g, uint32_t triangle) {
    uint32_t slot = g->triangles[triangle].heap_slot;
    if (slot == NONE) return;
    g->triangles[triangle].heap_slot = NONE;
    struct heap_entry last = g->heap[--g->heap_count];
    if (last.triangle != triangle) heap_settle(g, slot, last);
}

/* Scans a triangle that is new or has changed and files it by its error. */
static void rank_triangle(struct greedy *g, uint32_t t) {
    struct triangle *triangle = &g->triangles[t];
    double error_m = worst_post(g, g->points[triangle->corner[0]], g->points[triangle->corner[1]],
                                g->points[triangle->corner[2]], &triangle->candidate);
    if (error_m <= g->tolerance_m) {
        heap_remove(g, t);
        return;
    }
    uint32_t slot = triangle->heap_slot;
    if (slot == NONE) slot = g->heap_count++;
    heap_settle(g, slot, (struct heap_entry){error_m, t});
}

/* ---- the Delaunay triangulation ---- */

static uint32_t next_edge(uint32_t edge) {
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

static void link_edges(struct greedy *g, uint32_t edge, uint32_t twin) {
    g->triangles[edge / 3].twin[edge % 3] = twin;
    if (twin != NONE) g->triangles[twin / 3].twin[twin % 3] = edge;
}

static uint32_t twin_of(const struct greedy *g, uint32_t edge) {
    return g->triangles[edge / 3].twin[edge % 3];
}

static uint32_t origin_of(const struct greedy *g, uint32_t edge) {
    return g->triangles[edge / 3].corner[edge % 3];
}

static void set_corners(struct greedy *g, uint32_t t, uint32_t a, uint32_t b, uint32_t c) {
    g->triangles[t].corner[0] = a;
    g->triangles[t].corner[1] = b;
    g->triangles[t].corner[2] = c;
}

static uint32_t add_triangle(struct greedy *g) {
    g->triangles[g->triangle_count].heap_slot = NONE;
    return g->triangle_count++;
}

/* Twice the area of a b p: positive when p is on the left of a -> b. */
static int64_t area2(struct point a, struct point b, struct point p) {
    return (int64_t)(b.x - a.x) * (p.y - a.y) - (int64_t)(b.y - a.y) * (p.x - a.x);
}

/* Whether d is strictly inside the circle through a, b, c (counter-clockwise). Differences are below 2^13, squares of
 * lengths at most 2^27, the sum below 2^56. */
static bool in_circle(struct point a, struct point b, struct point c, struct point d) {
    int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    int64_t aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx) > 0;
}

/* The triangles around a new point p all have p as corner 2, so edge 0 lies opposite. Starting at triangle t, goes
 * around p counter-clockwise, flips edge 0 wherever the circle says so, and ranks what has come to rest. */
static void legalize_around(struct greedy *g, uint32_t t) {
    const uint32_t p = g->triangles[t].corner[2], start = g->triangles[t].corner[0];
    for (;;) {
        struct triangle *near = &g->triangles[t];
        uint32_t across = near->twin[0];
        uint32_t d = across == NONE ? NONE : origin_of(g, next_edge(next_edge(across)));
        if (d != NONE &&
            in_circle(g->points[near->corner[0]], g->points[near->corner[1]], g->points[p], g->points[d])) {
            /* t = (a, b, p) and u = (b, a, d) become t = (a, d, p) and u = (d, b, p). */
            uint32_t u = across / 3, a = near->corner[0], b = near->corner[1];
            uint32_t ad = twin_of(g, next_edge(across)), db = twin_of(g, next_edge(next_edge(across)));
            uint32_t bp = near->twin[1];
            set_corners(g, t, a, d, p);
            set_corners(g, u, d, b, p);
            link_edges(g, 3 * t, ad);
            link_edges(g, 3 * u, db);
            link_edges(g, 3 * u + 1, bp);
            link_edges(g, 3 * t + 1, 3 * u + 2);
            continue;
        }
        rank_triangle(g, t);
        if (near->twin[1] == NONE || near->corner[1] == start) return;
        t = near->twin[1] / 3;
    }
}

/* Splits triangle t into three by a point strictly inside. */
static void split_triangle(struct greedy *g, uint32_t t, uint32_t p) {
    struct triangle old = g->triangles[t];
    uint32_t t1 = add_triangle(g), t2 = add_triangle(g);
    set_corners(g, t, old.corner[0], old.corner[1], p);
    set_corners(g, t1, old.corner[1], old.corner[2], p);
    set_corners(g, t2, old.corner[2], old.corner[0], p);
    link_edges(g, 3 * t1, old.twin[1]);
    link_edges(g, 3 * t2, old.twin[2]);
    link_edges(g, 3 * t + 1, 3 * t1 + 2);
    link_edges(g, 3 * t1 + 1, 3 * t2 + 2);
    link_edges(g, 3 * t2 + 1, 3 * t + 2);
    legalize_around(g, t);
}

/* Splits edge a -> b of triangle (a, b, c), and the triangle on its other side if there is one, by a point on it. */
static void split_edge(struct greedy *g, uint32_t edge, uint32_t p) {
    uint32_t t = edge / 3, across = twin_of(g, edge);
    uint32_t a = origin_of(g, edge), b = origin_of(g, next_edge(edge)), c = origin_of(g, next_edge(next_edge(edge)));
    uint32_t bc = twin_of(g, next_edge(edge)), ca = twin_of(g, next_edge(next_edge(edge)));
    uint32_t t1 = add_triangle(g);
    if (across == NONE) {
        set_corners(g, t, b, c, p);
        set_corners(g, t1, c, a, p);
        link_edges(g, 3 * t, bc);
        link_edges(g, 3 * t1, ca);
        link_edges(g, 3 * t + 1, 3 * t1 + 2);
        link_edges(g, 3 * t + 2, NONE);
        link_edges(g, 3 * t1 + 1, NONE);
        legalize_around(g, t);
        return;
    }
    uint32_t u = across / 3, u1 = add_triangle(g), d = origin_of(g, next_edge(next_edge(across)));
    uint32_t ad = twin_of(g, next_edge(across)), db = twin_of(g, next_edge(next_edge(across)));
    set_corners(g, t, b, c, p);
    set_corners(g, t1, c, a, p);
    set_corners(g, u, a, d, p);
    set_corners(g, u1, d, b, p);
    link_edges(g, 3 * t, bc);
    link_edges(g, 3 * t1, ca);
    link_edges(g, 3 * u, ad);
    link_edges(g, 3 * u1, db);
    link_edges(g, 3 * t + 1, 3 * t1 + 2);
    link_edges(g, 3 * t1 + 1, 3 * u + 2);
    link_edges(g, 3 * u + 1, 3 * u1 + 2);
    link_edges(g, 3 * u1 + 1, 3 * t + 2);
    legalize_around(g, t);
}

static void insert_candidate(struct greedy *g, uint32_t t) {
    const struct triangle *triangle = &g->triangles[t];
    struct point point = {(int32_t)(triangle->candidate % (uint32_t)g->columns),
                          (int32_t)(triangle->candidate / (uint32_t)g->columns)};
    uint32_t p = g->point_count++;
    g->points[p] = point;
    for (uint32_t k = 0; k < 3; k++)
        if (area2(g->points[triangle->corner[k]], g->points[triangle->corner[(k + 1) % 3]], point) == 0) {
            split_edge(g, 3 * t + k, p);
            return;
        }
    split_triangle(g, t, p);
}

/* ---- the whole ---- */

static enum scree_status check_arguments(const float *heights_m, int columns, int rows, int stride,
                                         const struct greedy_options *options, struct scree_error *error) {
    if (heights_m == NULL || columns < 2 || rows < 2 || columns > GREEDY_MAX_POSTS || rows > GREEDY_MAX_POSTS ||
        stride < columns)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "greedy insertion: %d x %d posts with a stride of %d; it takes 2 to %d a side", columns, rows,
                          stride, GREEDY_MAX_POSTS);
    if (!(options->tolerance_m >= 0))
        return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: the tolerance of %g m is not 0 or more",
                          options->tolerance_m);
    if (options->max_vertices != 0 && options->max_vertices < 4)
        return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: a rectangle takes at least 4 vertices, not %u",
                          (unsigned)options->max_vertices);
    return SCREE_OK;
}

/* Looks over the heights: all finite? Whole numbers, so that every error comes out exact? */
static enum scree_status survey_heights(struct greedy *g, struct scree_error *error) {
    double largest_m = 0;
    bool whole = true;
    for (int32_t y = 0; y < g->rows; y++)
        for (int32_t x = 0; x < g->columns; x++) {
            double z = (double)height_at(g, x, y);
            if (!isfinite(z))
                return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: the height of post %d, %d is not finite",
                                  (int)x, (int)y);
            largest_m = larger(largest_m, fabs(z));
            whole = whole && z == floor(z);
        }
    bool exact = whole && largest_m < 0x1p22;
    g->rounding = exact ? 0 : largest_m * 0x1p-47; /* 64 roundings of 2^-53 over the bounding rectangle */
    return SCREE_OK;
}

/* Room for `point_count` points, and the triangles and heap that go with them (Euler: fewer than two a point). */
static enum scree_status reserve(struct greedy *g, uint32_t point_count, struct scree_error *error) {
    size_t triangle_count = 2 * (size_t)point_count;
    struct point *points =
        scree_reallocate(g->memory, g->points, point_count, sizeof *points, "the points of a triangulation", error);
    if (points == NULL) return error->status;
    g->points = points;
    struct triangle *triangles = scree_reallocate(g->memory, g->triangles, triangle_count, sizeof *triangles,
                                                  "the triangles of a triangulation", error);
    if (triangles == NULL) return error->status;
    g->triangles = triangles;
    struct heap_entry *heap =
        scree_reallocate(g->memory, g->heap, triangle_count, sizeof *heap, "the heap of a triangulation", error);
    if (heap == NULL) return error->status;
    g->heap = heap;
    g->point_capacity = point_count;
    return SCREE_OK;
}

/* The rectangle as two triangles. */
static void begin(struct greedy *g) {
    int32_t east = g->columns - 1, north = g->rows - 1;
    const struct point corners[4] = {{0, 0}, {east, 0}, {0, north}, {east, north}};
    memcpy(g->points, corners, sizeof corners);
    g->point_count = 4;
    uint32_t t0 = add_triangle(g), t1 = add_triangle(g);
    set_corners(g, t0, 0, 1, 3);
    set_corners(g, t1, 0, 3, 2);
    for (uint32_t edge = 0; edge < 6; edge++) link_edges(g, edge, NONE);
    link_edges(g, 3 * t0 + 2, 3 * t1);
    rank_triangle(g, t0);
    rank_triangle(g, t1);
}

/* Copies points and triangles into a mesh of their exact size. */
static enum scree_status hand_out(const struct greedy *g, struct scree_mesh *mesh, struct scree_error *error) {
    struct scree_mesh out = {.vertex_count = g->point_count, .triangle_count = g->triangle_count};
    out.vertices =
        scree_allocate(g->memory, out.vertex_count, sizeof *out.vertices, "the vertices of a triangulation", error);
    out.corners = scree_allocate(g->memory, 3 * (size_t)out.triangle_count, sizeof *out.corners,
                                 "the corners of a triangulation", error);
    if (out.vertices == NULL || out.corners == NULL) {
        greedy_free(&out, g->memory);
        return error->status;
    }
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        out.vertices[i].x = g->points[i].x;
        out.vertices[i].y = g->points[i].y;
    }
    for (uint32_t t = 0; t < out.triangle_count; t++)
        memcpy(out.corners + 3 * (size_t)t, g->triangles[t].corner, sizeof g->triangles[t].corner);
    *mesh = out;
    return SCREE_OK;
}

/* Triangles within the tolerance are not in the heap, so they are scanned once more. */
static double largest_error(const struct greedy *g) {
    double error_m = 0;
    for (uint32_t t = 0; t < g->triangle_count; t++) {
        const uint32_t *corner = g->triangles[t].corner;
        uint32_t candidate;
        error_m = larger(error_m,
                         worst_post(g, g->points[corner[0]], g->points[corner[1]], g->points[corner[2]], &candidate));
    }
    return error_m;
}

enum scree_status greedy_triangulate(const float *heights_m, int columns, int rows, int stride,
                                     const struct greedy_options *options, struct scree_memory *memory,
                                     struct scree_mesh *mesh, double *max_error_m, struct scree_error *error) {
    struct scree_error own_error = {0};
    if (error == NULL) error = &own_error;
    enum scree_status status = check_arguments(heights_m, columns, rows, stride, options, error);
    if (status != SCREE_OK) return status;
    struct greedy g = {.heights_m = heights_m, .columns = columns, .rows = rows, .stride = stride, .memory = memory};
    g.tolerance_m = options->tolerance_m;
    uint32_t post_count = (uint32_t)columns * (uint32_t)rows;
    uint32_t most =
        options->max_vertices != 0 && options->max_vertices < post_count ? options->max_vertices : post_count;

    status = survey_heights(&g, error);
    if (status != SCREE_OK) goto cleanup;
    status = reserve(&g, most < 1024 ? most : 1024, error);
    if (status != SCREE_OK) goto cleanup;
    begin(&g);
    while (g.heap_count > 0 && g.point_count < most) {
        if (g.point_count == g.point_capacity) {
            status = reserve(&g, most / 2 < g.point_capacity ? most : 2 * g.point_capacity, error);
            if (status != SCREE_OK) goto cleanup;
        }
        insert_candidate(&g, g.heap[0].triangle);
    }
    status = hand_out(&g, mesh, error);
    if (status == SCREE_OK && max_error_m != NULL) *max_error_m = largest_error(&g);
cleanup:
    scree_release(memory, g.heap);
    scree_release(memory, g.triangles);
    scree_release(memory, g.points);
    return status;
}

void greedy_free(struct scree_mesh *mesh, struct scree_memory *memory) {
    scree_release(memory, mesh->corners);
    scree_release(memory, mesh->vertices);
    *mesh = (struct scree_mesh){0};
}
