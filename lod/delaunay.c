#include "lod/delaunay.h"

#define NONE         DELAUNAY_NONE
#define FIRST_POINTS 1024

__extension__ typedef __int128 wide_integer;

static uint32_t next_edge(uint32_t edge) {
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

static void link_edges(struct delaunay *mesh, uint32_t edge, uint32_t twin) {
    mesh->triangles[edge / 3].twin[edge % 3] = twin;
    if (twin != NONE) mesh->triangles[twin / 3].twin[twin % 3] = edge;
}

static uint32_t twin_of(const struct delaunay *mesh, uint32_t edge) {
    return mesh->triangles[edge / 3].twin[edge % 3];
}

static uint32_t origin_of(const struct delaunay *mesh, uint32_t edge) {
    return mesh->triangles[edge / 3].corner[edge % 3];
}

static void set_corners(struct delaunay *mesh, uint32_t t, uint32_t a, uint32_t b, uint32_t c) {
    mesh->triangles[t].corner[0] = a;
    mesh->triangles[t].corner[1] = b;
    mesh->triangles[t].corner[2] = c;
}

static uint32_t add_triangle(struct delaunay *mesh) {
    mesh->triangles[mesh->triangle_count].mark[0] = mesh->triangles[mesh->triangle_count].mark[1] = 0;
    return mesh->triangle_count++;
}

/* ---- room ---- */

enum scree_status delaunay_reserve(struct delaunay *mesh, uint32_t point_count, struct scree_error *error) {
    if (point_count <= mesh->capacity) return SCREE_OK;
    size_t triangle_count = 2 * (size_t)point_count; /* Euler: fewer than two a point */
    struct delaunay_point *points = scree_reallocate(mesh->memory, mesh->points, point_count, sizeof *points,
                                                     "the points of a triangulation", error);
    if (points == NULL) return error->status;
    mesh->points = points;
    struct delaunay_triangle *triangles = scree_reallocate(
        mesh->memory, mesh->triangles, triangle_count, sizeof *triangles, "the triangles of a triangulation", error);
    if (triangles == NULL) return error->status;
    mesh->triangles = triangles;
    mesh->capacity = point_count;
    return SCREE_OK;
}

enum scree_status delaunay_start(struct scree_memory *memory, int32_t width, int32_t height, struct delaunay *mesh,
                                 struct scree_error *error) {
    *mesh = (struct delaunay){.memory = memory};
    if (width < 1 || height < 1 || width > DELAUNAY_WIDEST_SIDE || height > DELAUNAY_WIDEST_SIDE)
        return scree_fail(error, SCREE_E_ARGUMENT, "a triangulation of a rectangle of %d x %d steps", (int)width,
                          (int)height);
    mesh->is_wide = width > DELAUNAY_NARROW_SIDE || height > DELAUNAY_NARROW_SIDE;
    enum scree_status status = delaunay_reserve(mesh, FIRST_POINTS, error);
    if (status != SCREE_OK) return status;
    const struct delaunay_point corners[4] = {{0, 0}, {width, 0}, {0, height}, {width, height}};
    for (int i = 0; i < 4; i++) mesh->points[mesh->point_count++] = corners[i];
    uint32_t t0 = add_triangle(mesh), t1 = add_triangle(mesh);
    set_corners(mesh, t0, 0, 1, 3);
    set_corners(mesh, t1, 0, 3, 2);
    for (uint32_t edge = 0; edge < 6; edge++) link_edges(mesh, edge, NONE);
    link_edges(mesh, 3 * t0 + 2, 3 * t1);
    return SCREE_OK;
}

void delaunay_release(struct delaunay *mesh) {
    scree_release(mesh->memory, mesh->triangles);
    scree_release(mesh->memory, mesh->points);
    *mesh = (struct delaunay){.memory = mesh->memory};
}

/* ---- where a point is ---- */

/* The visibility walk, which ends in a Delaunay triangulation. */
uint32_t delaunay_find(const struct delaunay *mesh, uint32_t start, struct delaunay_point point) {
    uint32_t t = start;
    for (uint32_t k = 0; k < 3;) {
        const struct delaunay_triangle *triangle = &mesh->triangles[t];
        uint32_t twin = triangle->twin[k];
        if (twin != NONE &&
            delaunay_area2(mesh->points[triangle->corner[k]], mesh->points[triangle->corner[(k + 1) % 3]], point) < 0) {
            t = twin / 3;
            k = 0;
        } else {
            k++;
        }
    }
    return t;
}

bool delaunay_is_corner(const struct delaunay *mesh, uint32_t triangle, struct delaunay_point point) {
    for (int k = 0; k < 3; k++) {
        struct delaunay_point corner = mesh->points[mesh->triangles[triangle].corner[k]];
        if (corner.x == point.x && corner.y == point.y) return true;
    }
    return false;
}

/* ---- insertion ---- */

/* Whether d is strictly inside the circle through a, b, c (counter-clockwise). */
static bool in_circle(struct delaunay_point a, struct delaunay_point b, struct delaunay_point c,
                      struct delaunay_point d) {
    int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    int64_t aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx) > 0;
}

static bool in_circle_wide(struct delaunay_point a, struct delaunay_point b, struct delaunay_point c,
                           struct delaunay_point d) {
    wide_integer ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    wide_integer aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx) > 0;
}

/* The triangles around a new point p all have p as corner 2, so edge 0 lies opposite. Starting at triangle t, goes
 * around p counter-clockwise and flips edge 0 wherever the circle says so. */
static void legalize_around(struct delaunay *mesh, uint32_t t) {
    const uint32_t p = mesh->triangles[t].corner[2], start = mesh->triangles[t].corner[0];
    const struct delaunay_point *points = mesh->points;
    for (;;) {
        struct delaunay_triangle *near = &mesh->triangles[t];
        uint32_t across = near->twin[0];
        if (across != NONE) {
            uint32_t a = near->corner[0], b = near->corner[1], d = origin_of(mesh, next_edge(next_edge(across)));
            if (mesh->is_wide ? in_circle_wide(points[a], points[b], points[p], points[d])
                              : in_circle(points[a], points[b], points[p], points[d])) {
                /* t = (a, b, p) and u = (b, a, d) become t = (a, d, p) and u = (d, b, p). */
                uint32_t u = across / 3, bp = near->twin[1];
                uint32_t ad = twin_of(mesh, next_edge(across)), db = twin_of(mesh, next_edge(next_edge(across)));
                set_corners(mesh, t, a, d, p);
                set_corners(mesh, u, d, b, p);
                link_edges(mesh, 3 * t, ad);
                link_edges(mesh, 3 * u, db);
                link_edges(mesh, 3 * u + 1, bp);
                link_edges(mesh, 3 * t + 1, 3 * u + 2);
                continue;
            }
        }
        if (near->twin[1] == NONE || near->corner[1] == start) return;
        t = near->twin[1] / 3;
    }
}

/* Splits triangle t into three by a point strictly inside. */
static void split_triangle(struct delaunay *mesh, uint32_t t, uint32_t p) {
    struct delaunay_triangle old = mesh->triangles[t];
    uint32_t t1 = add_triangle(mesh), t2 = add_triangle(mesh);
    set_corners(mesh, t, old.corner[0], old.corner[1], p);
    set_corners(mesh, t1, old.corner[1], old.corner[2], p);
    set_corners(mesh, t2, old.corner[2], old.corner[0], p);
    link_edges(mesh, 3 * t1, old.twin[1]);
    link_edges(mesh, 3 * t2, old.twin[2]);
    link_edges(mesh, 3 * t + 1, 3 * t1 + 2);
    link_edges(mesh, 3 * t1 + 1, 3 * t2 + 2);
    link_edges(mesh, 3 * t2 + 1, 3 * t + 2);
}

/* Splits edge a -> b of triangle (a, b, c), and the triangle on its other side if there is one, by a point on it. */
static void split_edge(struct delaunay *mesh, uint32_t edge, uint32_t p) {
    uint32_t t = edge / 3, across = twin_of(mesh, edge), after = next_edge(edge), before = next_edge(after);
    uint32_t a = origin_of(mesh, edge), b = origin_of(mesh, after), c = origin_of(mesh, before);
    uint32_t bc = twin_of(mesh, after), ca = twin_of(mesh, before);
    uint32_t t1 = add_triangle(mesh);
    set_corners(mesh, t, b, c, p);
    set_corners(mesh, t1, c, a, p);
    link_edges(mesh, 3 * t, bc);
    link_edges(mesh, 3 * t1, ca);
    link_edges(mesh, 3 * t + 1, 3 * t1 + 2);
    if (across == NONE) {
        link_edges(mesh, 3 * t + 2, NONE);
        link_edges(mesh, 3 * t1 + 1, NONE);
        return;
    }
    uint32_t u = across / 3, u1 = add_triangle(mesh), d = origin_of(mesh, next_edge(next_edge(across)));
    uint32_t ad = twin_of(mesh, next_edge(across)), db = twin_of(mesh, next_edge(next_edge(across)));
    set_corners(mesh, u, a, d, p);
    set_corners(mesh, u1, d, b, p);
    link_edges(mesh, 3 * u, ad);
    link_edges(mesh, 3 * u1, db);
    link_edges(mesh, 3 * t1 + 1, 3 * u + 2);
    link_edges(mesh, 3 * u + 1, 3 * u1 + 2);
    link_edges(mesh, 3 * u1 + 1, 3 * t + 2);
}

uint32_t delaunay_insert(struct delaunay *mesh, uint32_t triangle, struct delaunay_point point) {
    const uint32_t *corner = mesh->triangles[triangle].corner;
    uint32_t p = mesh->point_count++, k = 0;
    mesh->points[p] = point;
    while (k < 3 && delaunay_area2(mesh->points[corner[k]], mesh->points[corner[(k + 1) % 3]], point) != 0) k++;
    if (k < 3)
        split_edge(mesh, 3 * triangle + k, p);
    else
        split_triangle(mesh, triangle, p);
    legalize_around(mesh, triangle);
    return triangle;
}
