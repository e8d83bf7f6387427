#include "src/point_residual.h"

#include "lod/position_code.h"

#include <math.h>
#include <stdbool.h>

#define POINTS_A_CELL 2
#define MOST_CELLS    30000   /* of a side */
#define OUTSIDE       (-1e-6) /* share of a triangle's area by which a point may lie outside of it: rounding */

static int64_t larger(int64_t a, int64_t b) {
    return a > b ? a : b;
}

/* ---- cells ---- */

static size_t cell_of(const struct residual_points *points, const struct tin_post *post) {
    return (size_t)(post->y / points->cell) * (size_t)points->columns + (size_t)(post->x / points->cell);
}

static void choose_cells(struct residual_points *points) {
    int64_t width = 1, height = 1;
    for (uint32_t i = 0; i < points->count; i++) {
        width = larger(width, (int64_t)points->points[i].x + 1);
        height = larger(height, (int64_t)points->points[i].y + 1);
    }
    double side = sqrt((double)width * (double)height * POINTS_A_CELL / fmax(points->count, 1));
    points->cell = larger((int64_t)fmax(side, 1), larger(width, height) / MOST_CELLS + 1);
    points->columns = (int32_t)((width - 1) / points->cell + 1);
    points->rows = (int32_t)((height - 1) / points->cell + 1);
}

static void sort_into_cells(struct residual_points *points) {
    size_t cells = (size_t)points->columns * (size_t)points->rows;
    uint32_t begin = 0;
    for (uint32_t i = 0; i < points->count; i++) points->first[cell_of(points, &points->points[i])]++;
    for (size_t c = 0; c <= cells; c++) {
        uint32_t here = c < cells ? points->first[c] : 0;
        points->first[c] = begin;
        begin += here;
    }
    for (uint32_t i = 0; i < points->count; i++)
        points->members[points->first[cell_of(points, &points->points[i])]++] = i;
    for (size_t c = cells; c > 0; c--) points->first[c] = points->first[c - 1];
    points->first[0] = 0;
}

enum scree_status residual_points_begin(struct scree_memory *memory, const struct tin_post *posts, uint32_t count,
                                        int64_t x, int64_t y, struct residual_points *points,
                                        struct scree_error *error) {
    static const char what[] = "points to measure at";
    *points = (struct residual_points){.memory = memory, .points = posts, .count = count, .x = x, .y = y};
    choose_cells(points);
    size_t cells = (size_t)points->columns * (size_t)points->rows;
    points->first = scree_allocate(memory, cells + 1, sizeof *points->first, what, error);
    points->members = scree_allocate(memory, count, sizeof *points->members, what, error);
    points->height_m = scree_allocate(memory, count, sizeof *points->height_m, what, error);
    points->drawn_m = scree_allocate(memory, count, sizeof *points->drawn_m, what, error);
    points->rank = scree_allocate(memory, count, sizeof *points->rank, what, error);
    if (points->first == NULL || points->members == NULL || points->height_m == NULL || points->drawn_m == NULL ||
        points->rank == NULL)
        return error->status;
    sort_into_cells(points);
    return SCREE_OK;
}

void residual_points_release(struct residual_points *points) {
    if (points->memory == NULL) return;
    scree_release(points->memory, points->first);
    scree_release(points->memory, points->members);
    scree_release(points->memory, points->height_m);
    scree_release(points->memory, points->drawn_m);
    scree_release(points->memory, points->rank);
    *points = (struct residual_points){0};
}

/* Cells from first to last, inclusive, that a closed rectangle touches; none: first > last. */
struct cells {
    int32_t x_first, y_first, x_last, y_last;
};

static struct cells cells_touching(const struct residual_points *points, double west, double south, double east,
                                   double north) {
    double cell = (double)points->cell;
    return (struct cells){(int32_t)fmax(floor(fmin(west / cell, points->columns)), 0),
                          (int32_t)fmax(floor(fmin(south / cell, points->rows)), 0),
                          (int32_t)fmin(floor(fmax(east / cell, -1)), points->columns - 1),
                          (int32_t)fmin(floor(fmax(north / cell, -1)), points->rows - 1)};
}

static struct cells cells_of(const struct residual_points *points, const struct lattice_window *window) {
    double x = (double)(window->x - points->x), y = (double)(window->y - points->y);
    return cells_touching(points, x, y, x + window->columns, y + window->rows);
}

bool residual_points_touch(const struct residual_points *points, const struct lattice_window *window) {
    struct cells cells = cells_of(points, window);
    return cells.x_first <= cells.x_last && cells.y_first <= cells.y_last;
}

/* ---- one mesh ---- */

/* The tile as its points see it. */
struct tile_view {
    const struct lattice *lattice;
    struct residual_points *points;
    struct lattice_window window;
    struct cells cells;
    double half_code; /* steps; 0: vertices are where their codes say */
};

static struct tile_view view_of(const struct lattice *lattice, struct tile_id id, double half_code,
                                struct residual_points *points) {
    struct tile_view view = {
        .lattice = lattice, .points = points, .window = lattice_tile_window(lattice, id), .half_code = half_code};
    view.cells = cells_of(points, &view.window);
    for (int32_t row = view.cells.y_first; row <= view.cells.y_last; row++)
        for (int32_t column = view.cells.x_first; column <= view.cells.x_last; column++) {
            size_t cell = (size_t)row * (size_t)points->columns + (size_t)column;
            for (uint32_t m = points->first[cell]; m < points->first[cell + 1]; m++)
                points->rank[points->members[m]] = -1;
        }
    return view;
}

/* What all points of a triangle share. Positions are steps from the tile's corner. */
struct seen_triangle {
    struct residual_corner corners[3];
    bool is_rounded;    /* a vertex is where its codes say, and not where it was when the mesh was made */
    double slack_m;     /* what that may do to a height */
    double reach_steps; /* how far off a place may be where vertices of the tile are rounded; 0: none are */
    double lengths[3];  /* of the edges opposite of the corners */
    double centre_x, centre_y, drop_x, drop_y, lifted_m[3];
};

static double less(double difference_m, double slack_m) {
    return copysign(fmax(fabs(difference_m) - slack_m, 0), difference_m);
}

static double cross(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

/* How much speaks for measuring a point in a triangle, of which `shares` of the area lie opposite of its corners: to be
 * inside; where the tile is rounded, to be inside of one that is not itself, and then the smallest of all differences
 * in triangles that the point may be in. Below 0: it is in another one. */
static double rank_of(const struct seen_triangle *triangle, const double shares[3], double area, double drawn_m) {
    double inside = fmin(shares[0], fmin(shares[1], shares[2])) / area;
    if (triangle->reach_steps == 0) return inside >= OUTSIDE ? fmax(inside, 0) : -1;
    if (inside >= OUTSIDE && !triangle->is_rounded) return 2 + inside;
    for (int k = 0; k < 3; k++)
        if (shares[k] < -triangle->reach_steps * triangle->lengths[k]) return -1;
    return 1 / (1 + fabs(drawn_m));
}

/* Shares of the triangle's area opposite of its corners weigh their heights. */
static void look_at_point(const struct seen_triangle *triangle, double x, double y, uint32_t number,
                          struct residual_points *points) {
    const struct residual_corner *a = &triangle->corners[0], *b = &triangle->corners[1], *c = &triangle->corners[2];
    double ax = a->x - x, ay = a->y - y, bx = b->x - x, by = b->y - y, cx = c->x - x, cy = c->y - y;
    const double shares[3] = {cross(bx, by, cx, cy), cross(cx, cy, ax, ay), cross(ax, ay, bx, by)};
    double east = x - triangle->centre_x, north = y - triangle->centre_y, post_m = points->points[number].height_m;
    double sag_m = triangle->drop_x * east * east + triangle->drop_y * north * north;
    const double *lifted_m = triangle->lifted_m;
    double area = shares[0] + shares[1] + shares[2];
    double height_m = (shares[0] * a->height_m + shares[1] * b->height_m + shares[2] * c->height_m) / area;
    double drawn_m = (shares[0] * lifted_m[0] + shares[1] * lifted_m[1] + shares[2] * lifted_m[2]) / area;
    double difference_m = less(post_m - sag_m - drawn_m, triangle->slack_m);
    double rank = rank_of(triangle, shares, area, difference_m);
    if (!(rank > points->rank[number])) return;
    points->rank[number] = rank;
    points->height_m[number] = less(post_m - height_m, triangle->slack_m);
    points->drawn_m[number] = difference_m;
}

static void look_at_triangle(const struct tile_view *view, const struct residual_corner corners[3], bool is_rounded) {
    struct residual_points *points = view->points;
    const struct residual_corner *a = &corners[0], *b = &corners[1], *c = &corners[2];
    double bx = b->x - a->x, by = b->y - a->y, bz = b->height_m - a->height_m;
    double cx = c->x - a->x, cy = c->y - a->y, cz = c->height_m - a->height_m, area = cross(bx, by, cx, cy);
    if (!(area > 0)) return; /* lies over no point */
    double tile_x = (double)(view->window.x - points->x), tile_y = (double)(view->window.y - points->y);
    double reach = 1.5 * view->half_code; /* more than its root, across */
    struct cells cells = cells_touching(
        points, tile_x + fmin(a->x, fmin(b->x, c->x)) - reach, tile_y + fmin(a->y, fmin(b->y, c->y)) - reach,
        tile_x + fmax(a->x, fmax(b->x, c->x)) + reach, tile_y + fmax(a->y, fmax(b->y, c->y)) + reach);
    double rounding_steps = is_rounded ? view->half_code : 0;
    struct seen_triangle triangle = {.corners = {*a, *b, *c},
                                     .is_rounded = is_rounded,
                                     .reach_steps = reach,
                                     .lengths = {hypot(cx - bx, cy - by), hypot(cx, cy), hypot(bx, by)},
                                     .slack_m =
                                         rounding_steps * (fabs(bz * cy - cz * by) + fabs(cz * bx - bz * cx)) / area,
                                     .centre_x = (a->x + b->x + c->x) / 3,
                                     .centre_y = (a->y + b->y + c->y) / 3,
                                     .drop_y = lattice_meridian_drop_m(view->lattice)};
    triangle.drop_x = lattice_parallel_drop_m(view->lattice, (double)view->window.y + triangle.centre_y);
    for (int k = 0; k < 3; k++) {
        double x = corners[k].x - triangle.centre_x, y = corners[k].y - triangle.centre_y;
        triangle.lifted_m[k] = corners[k].height_m - triangle.drop_x * x * x - triangle.drop_y * y * y;
    }
    cells.x_first = cells.x_first > view->cells.x_first ? cells.x_first : view->cells.x_first;
    cells.y_first = cells.y_first > view->cells.y_first ? cells.y_first : view->cells.y_first;
    cells.x_last = cells.x_last < view->cells.x_last ? cells.x_last : view->cells.x_last;
    cells.y_last = cells.y_last < view->cells.y_last ? cells.y_last : view->cells.y_last;
    for (int32_t row = cells.y_first; row <= cells.y_last; row++)
        for (int32_t column = cells.x_first; column <= cells.x_last; column++) {
            size_t cell = (size_t)row * (size_t)points->columns + (size_t)column;
            for (uint32_t m = points->first[cell]; m < points->first[cell + 1]; m++) {
                const struct tin_post *post = &points->points[points->members[m]];
                look_at_point(&triangle, post->x - tile_x, post->y - tile_y, points->members[m], points);
            }
        }
}

/* Points on the eastern and northern border belong to a neighbour, unless there is none to count them. */
static void book(const struct tile_view *view, bool with_east, bool with_north, struct residuals *residuals) {
    const struct residual_points *points = view->points;
    const struct lattice_window *window = &view->window;
    for (int32_t row = view->cells.y_first; row <= view->cells.y_last; row++)
        for (int32_t column = view->cells.x_first; column <= view->cells.x_last; column++) {
            size_t cell = (size_t)row * (size_t)points->columns + (size_t)column;
            for (uint32_t m = points->first[cell]; m < points->first[cell + 1]; m++) {
                uint32_t number = points->members[m];
                int64_t x = points->x + points->points[number].x, y = points->y + points->points[number].y;
                int64_t east = window->x + window->columns - (with_east ? 0 : 1);
                int64_t north = window->y + window->rows - (with_north ? 0 : 1);
                if (points->rank[number] < 0 || x < window->x || x > east || y < window->y || y > north) continue;
                residuals->posts++;
                residual_add(&residuals->height, points->height_m[number], x, y);
                residual_add(&residuals->drawn, points->drawn_m[number], x, y);
            }
        }
}

/* Codes are exact at both ends. */
static bool is_corner(const struct tile_view *view, const struct residual_corner *place) {
    return (place->x == 0 || place->x == view->window.columns) && (place->y == 0 || place->y == view->window.rows);
}

/* Where a tile has more steps than codes, a vertex stands at the point that its codes name; of several at the one whose
 * height is nearest. False: they name none. */
static bool snap(const struct tile_view *view, int64_t span, uint32_t u, uint32_t v, struct residual_corner *corner) {
    const struct residual_points *points = view->points;
    double tile_x = (double)(view->window.x - points->x), tile_y = (double)(view->window.y - points->y);
    double reach = (double)span / DECODED_TOP, nearest_m = INFINITY;
    const struct residual_corner coded = *corner;
    struct cells cells = cells_touching(points, tile_x + coded.x - reach, tile_y + coded.y - reach,
                                        tile_x + coded.x + reach, tile_y + coded.y + reach);
    for (int32_t row = cells.y_first; row <= cells.y_last; row++)
        for (int32_t column = cells.x_first; column <= cells.x_last; column++) {
            size_t cell = (size_t)row * (size_t)points->columns + (size_t)column;
            for (uint32_t m = points->first[cell]; m < points->first[cell + 1]; m++) {
                const struct tin_post *post = &points->points[points->members[m]];
                int64_t x = post->x + points->x - view->window.x, y = post->y + points->y - view->window.y;
                double distance_m = fabs(post->height_m - coded.height_m);
                bool is_named = x >= 0 && x <= span && y >= 0 && y <= span && position_code(x, span) == (int32_t)u &&
                                position_code(y, span) == (int32_t)v;
                if (!is_named || !(distance_m < nearest_m)) continue;
                nearest_m = distance_m;
                corner->x = (double)x;
                corner->y = (double)y;
            }
        }
    return nearest_m < INFINITY;
}

enum scree_status residual_points_add(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                                      bool with_east, bool with_north, struct residual_points *points,
                                      struct residuals *residuals, struct scree_error *error) {
    int64_t span = lattice_tile_span(lattice, id.zoom);
    double half_code = span > DECODED_TOP ? (double)span / DECODED_TOP / 2 : 0;
    struct tile_view view = view_of(lattice, id, half_code, points);
    struct residual_corner *places =
        scree_allocate(points->memory, tile->vertex_count, sizeof *places, "the places of a tile's vertices", error);
    bool *is_rounded = scree_allocate(points->memory, tile->vertex_count, sizeof *is_rounded,
                                      "the places of a tile's vertices", error);
    enum scree_status status = places == NULL || is_rounded == NULL ? error->status : SCREE_OK;
    if (status != SCREE_OK) goto cleanup;
    residual_tile_places(lattice, id, tile, places);
    for (uint32_t i = 0; i < tile->vertex_count && half_code > 0; i++)
        is_rounded[i] = !is_corner(&view, &places[i]) && !snap(&view, span, tile->u[i], tile->v[i], &places[i]);
    for (uint32_t t = 0; t < tile->triangle_count; t++) {
        const uint32_t *corner = tile->corners + 3 * (size_t)t;
        const struct residual_corner corners[3] = {places[corner[0]], places[corner[1]], places[corner[2]]};
        bool any = is_rounded[corner[0]] || is_rounded[corner[1]] || is_rounded[corner[2]];
        look_at_triangle(&view, corners, any);
    }
    book(&view, with_east, with_north, residuals);
cleanup:
    scree_release(points->memory, places);
    scree_release(points->memory, is_rounded);
    return status;
}

void residual_points_add_mesh(const struct lattice *lattice, struct tile_id id, const struct post_mesh *mesh,
                              bool with_east, bool with_north, struct residual_points *points,
                              struct residuals *residuals) {
    struct tile_view view = view_of(lattice, id, 0, points);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        struct residual_corner corners[3];
        residual_mesh_corners(mesh, t, corners);
        look_at_triangle(&view, corners, false);
    }
    book(&view, with_east, with_north, residuals);
}
