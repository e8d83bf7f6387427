/* Greedy insertion: see the header. Two parts: the search for a triangle's worst post, and a heap of triangles by that
 * error. */
#include "lod/insertion.h"

#include <math.h>
#include <string.h>

enum { CANDIDATE, HEAP_SLOT }; /* marks of a triangle */

static float height_at(const struct insertion_posts *posts, int32_t column, int32_t row) {
    return posts->heights_m[(size_t)row * (size_t)posts->stride + (size_t)column];
}

/* ---- the worst post of a triangle ---- */

/* A triangle's side as it is walked down the rows of posts: `column` is the first (left sides) or last (right sides)
 * post of the row inside of it, kept exact by carrying the remainder of the division. */
struct side {
    int32_t column, step;             /* whole posts a row */
    int64_t rest, rest_step, divisor; /* numerators over `divisor` */
};

static int32_t floor_div(int32_t a, int32_t b) {
    int32_t q = a / b;
    return q - (a % b != 0 && a < 0);
}

static int64_t floor_div_wide(int64_t a, int64_t b) {
    int64_t q = a / b;
    return q - (a % b != 0 && a < 0);
}

/* The side from `low` to `high`, low.y < high.y, from row `row` on, which it meets. `ceiling`: round inwards from the
 * left. */
static struct side side_new(struct delaunay_point low, struct delaunay_point high, int32_t span, int32_t row,
                            bool ceiling) {
    int32_t dx = high.x - low.x, dy = high.y - low.y;
    struct side side = {.step = floor_div(dx, dy)};
    side.divisor = (int64_t)dy * span;
    side.rest_step = ((int64_t)dx - (int64_t)side.step * dy) * span;
    /* A ceiling is the floor of a value that is larger by (divisor - 1) / divisor. */
    side.rest = ceiling ? side.divisor - 1 : 0;
    if (span == 1 && row == low.y) {
        side.column = low.x;
        return side;
    }
    int64_t numerator = (int64_t)low.x * dy + ((int64_t)row * span - low.y) * dx + side.rest;
    side.column = (int32_t)floor_div_wide(numerator, side.divisor);
    side.rest = numerator - side.column * side.divisor;
    return side;
}

static void side_advance(struct side *side) {
    side->column += side->step;
    side->rest += side->rest_step;
    if (side->rest >= side->divisor) {
        side->rest -= side->divisor;
        side->column++;
    }
}

/* A triangle's plane over the posts: the error times twice the area is area2 * z - (base + step_x * x + step_y * y), x
 * and y counted in cells from a corner. Whole heights and posts make every term a whole number below 2^53, hence
 * exact. */
struct plane {
    double origin_x, origin_y; /* cells */
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

static struct plane plane_through(const struct insertion *insertion, const uint32_t corner[3]) {
    const struct delaunay_point *points = insertion->mesh.points;
    struct delaunay_point a = points[corner[0]], b = points[corner[1]], c = points[corner[2]];
    double scale = insertion->cells_a_step, za = insertion->heights_m[corner[0]];
    double bx = (b.x - a.x) * scale, by = (b.y - a.y) * scale, cx = (c.x - a.x) * scale, cy = (c.y - a.y) * scale;
    double bz = insertion->heights_m[corner[1]] - za, cz = insertion->heights_m[corner[2]] - za;
    struct plane plane = {a.x * scale, a.y * scale, bx * cy - by * cx, 0, bz * cy - cz * by, cz * bx - bz * cx};
    plane.base = za * plane.area2;
    return plane;
}

static void swap_points(struct delaunay_point *a, struct delaunay_point *b) {
    struct delaunay_point other = *a;
    *a = *b;
    *b = other;
}

static int32_t at_least(int32_t a, int32_t b) {
    return a > b ? a : b;
}

static int32_t at_most(int32_t a, int32_t b) {
    return a < b ? a : b;
}

/* The first row of posts at or above a height. */
static int32_t row_above(int32_t y, int32_t span) {
    return span == 1 ? y : (y + span - 1) / span;
}

/* Visits every post of the closed triangle (a, b, c), given from south to north. */
static struct peak scan_triangle(const struct insertion_posts *posts, const struct plane *plane,
                                 struct delaunay_point a, struct delaunay_point b, struct delaunay_point c) {
    const int32_t span = posts->span, most = posts->columns - 1 - posts->margin;
    const bool middle_is_right = delaunay_area2(a, c, b) < 0;
    int32_t row = at_least(row_above(a.y, span), posts->margin);
    int32_t last_row = at_most(span == 1 ? c.y : c.y / span, posts->rows - 1 - posts->margin);
    int32_t turn = row_above(b.y, span); /* the first row beyond the lower short side */
    struct peak peak = {0, 0};
    if (row > last_row) return peak;
    struct side long_side = side_new(a, c, span, row, middle_is_right);
    struct side short_side = {0};
    if (row < turn) short_side = side_new(a, b, span, row, !middle_is_right);
    if (row > turn) turn = row;
    for (;; row++) {
        if (row == turn) {
            if (b.y < c.y)
                short_side = side_new(b, c, span, row, !middle_is_right);
            else /* level with c: a single row, that of both */
                short_side.column = middle_is_right ? floor_div(b.x, span) : row_above(b.x, span);
        }
        int32_t first = at_least(middle_is_right ? long_side.column : short_side.column, posts->margin);
        int32_t last = at_most(middle_is_right ? short_side.column : long_side.column, most);
        if (first <= last) {
            double offset =
                plane->base + plane->step_y * (row - plane->origin_y) + plane->step_x * (first - plane->origin_x);
            scan_row(posts->heights_m + (size_t)row * (size_t)posts->stride + (size_t)first, last - first + 1, plane,
                     offset, (uint32_t)row * (uint32_t)posts->columns + (uint32_t)first, &peak);
        }
        if (row == last_row) return peak;
        side_advance(&long_side);
        side_advance(&short_side);
    }
}

/* The largest error of a triangle's posts; `candidate` is the post. */
static double worst_post(const struct insertion *insertion, const uint32_t corner[3], uint32_t *candidate) {
    const struct delaunay_point *points = insertion->mesh.points;
    struct plane plane = plane_through(insertion, corner);
    struct delaunay_point a = points[corner[0]], b = points[corner[1]], c = points[corner[2]];
    if (b.y < a.y) swap_points(&a, &b);
    if (c.y < a.y) swap_points(&a, &c);
    if (c.y < b.y) swap_points(&b, &c);
    struct peak peak = scan_triangle(&insertion->posts, &plane, a, b, c);
    *candidate = peak.post;
    if (insertion->rounding == 0) return peak.error_area2 / plane.area2;
    int32_t west = at_most(a.x, at_most(b.x, c.x)), east = at_least(a.x, at_least(b.x, c.x));
    double scale = insertion->cells_a_step;
    double rounding_area2 = insertion->rounding * ((east - west) * scale) * ((c.y - a.y) * scale);
    return peak.error_area2 <= rounding_area2 ? 0 : (peak.error_area2 + rounding_area2) / plane.area2;
}

/* ---- the heap: the largest error on top, four children a node, ties by triangle ---- */

static bool goes_before(struct insertion_entry a, struct insertion_entry b) {
    return a.error_m > b.error_m || (a.error_m == b.error_m && a.triangle < b.triangle);
}

static void heap_put(struct insertion *insertion, uint32_t slot, struct insertion_entry entry) {
    insertion->heap[slot] = entry;
    insertion->mesh.triangles[entry.triangle].mark[HEAP_SLOT] = slot + 1; /* 0: not in the heap */
}

/* Lets `entry` sink or rise from a free slot to where it belongs. */
static void heap_settle(struct insertion *insertion, uint32_t slot, struct insertion_entry entry) {
    const struct insertion_entry *heap = insertion->heap;
    while (slot > 0 && goes_before(entry, heap[(slot - 1) / 4])) {
        heap_put(insertion, slot, heap[(slot - 1) / 4]);
        slot = (slot - 1) / 4;
    }
    for (;;) {
        uint32_t first = 4 * slot + 1, best = first;
        if (first >= insertion->heap_count) break;
        uint32_t end = first + 4 < insertion->heap_count ? first + 4 : insertion->heap_count;
        for (uint32_t child = first + 1; child < end; child++)
            if (goes_before(heap[child], heap[best])) best = child;
        if (!goes_before(heap[best], entry)) break;
        heap_put(insertion, slot, heap[best]);
        slot = best;
    }
    heap_put(insertion, slot, entry);
}

static void heap_remove(struct insertion *insertion, uint32_t triangle) {
    uint32_t *mark = &insertion->mesh.triangles[triangle].mark[HEAP_SLOT], slot = *mark - 1;
    if (*mark == 0) return;
    *mark = 0;
    struct insertion_entry last = insertion->heap[--insertion->heap_count];
    if (last.triangle != triangle) heap_settle(insertion, slot, last);
}

/* Scans a triangle that is new or has changed and files it by its error. */
static void rank_triangle(struct insertion *insertion, uint32_t t) {
    struct delaunay_triangle *triangle = &insertion->mesh.triangles[t];
    double error_m = worst_post(insertion, triangle->corner, &triangle->mark[CANDIDATE]);
    if (error_m <= insertion->tolerance_m) {
        heap_remove(insertion, t);
        return;
    }
    uint32_t slot = triangle->mark[HEAP_SLOT] != 0 ? triangle->mark[HEAP_SLOT] - 1 : insertion->heap_count++;
    heap_settle(insertion, slot, (struct insertion_entry){error_m, t});
}

/* ---- the whole ---- */

/* Looks over the heights: all finite? Whole numbers, so that every error comes out exact? */
static enum scree_status survey_heights(struct insertion *insertion, double largest_m, bool whole,
                                        struct scree_error *error) {
    const struct insertion_posts *posts = &insertion->posts;
    for (int32_t row = 0; row < posts->rows; row++)
        for (int32_t column = 0; column < posts->columns; column++) {
            double z = (double)height_at(posts, column, row);
            if (!isfinite(z))
                return scree_fail(error, SCREE_E_ARGUMENT, "greedy insertion: the height of post %d, %d is not finite",
                                  (int)column, (int)row);
            largest_m = larger(largest_m, fabs(z));
            whole = whole && z == floor(z);
        }
    bool exact = whole && largest_m < 0x1p22 && posts->span == 1 && !insertion->mesh.is_wide;
    insertion->rounding = exact ? 0 : largest_m * 0x1p-47; /* 64 roundings of 2^-53 over the bounding rectangle */
    return SCREE_OK;
}

/* Room for points, their heights and the heap. */
static enum scree_status reserve(struct insertion *insertion, uint32_t point_count, struct scree_error *error) {
    enum scree_status status = delaunay_reserve(&insertion->mesh, point_count, error);
    if (status != SCREE_OK) return status;
    double *heights_m = scree_reallocate(insertion->memory, insertion->heights_m, point_count, sizeof *heights_m,
                                         "the heights of a triangulation", error);
    if (heights_m == NULL) return error->status;
    insertion->heights_m = heights_m;
    struct insertion_entry *heap = scree_reallocate(insertion->memory, insertion->heap, 2 * (size_t)point_count,
                                                    sizeof *heap, "the heap of a triangulation", error);
    if (heap == NULL) return error->status;
    insertion->heap = heap;
    insertion->capacity = point_count;
    return SCREE_OK;
}

enum scree_status insertion_start(struct scree_memory *memory, const struct insertion_posts *posts,
                                  double largest_vertex_m, bool whole, struct insertion *insertion,
                                  struct scree_error *error) {
    *insertion = (struct insertion){.memory = memory, .posts = *posts, .cells_a_step = 1.0 / posts->span};
    int32_t east = posts->columns - 1, north = posts->rows - 1;
    enum scree_status status = delaunay_start(memory, east * posts->span, north * posts->span, &insertion->mesh, error);
    if (status == SCREE_OK) status = survey_heights(insertion, largest_vertex_m, whole, error);
    if (status == SCREE_OK) status = reserve(insertion, insertion->mesh.capacity, error);
    if (status != SCREE_OK) return status;
    insertion->heights_m[0] = (double)height_at(posts, 0, 0);
    insertion->heights_m[1] = (double)height_at(posts, east, 0);
    insertion->heights_m[2] = (double)height_at(posts, 0, north);
    insertion->heights_m[3] = (double)height_at(posts, east, north);
    return SCREE_OK;
}

void insertion_release(struct insertion *insertion) {
    scree_release(insertion->memory, insertion->heap);
    scree_release(insertion->memory, insertion->heights_m);
    delaunay_release(&insertion->mesh);
    insertion->heap = NULL;
    insertion->heights_m = NULL;
}

static enum scree_status make_room(struct insertion *insertion, struct scree_error *error) {
    if (insertion->mesh.point_count < insertion->capacity) return SCREE_OK;
    return reserve(insertion, 2 * insertion->capacity, error);
}

enum scree_status insertion_place(struct insertion *insertion, struct delaunay_point point, double height_m,
                                  struct scree_error *error) {
    struct delaunay *mesh = &insertion->mesh;
    enum scree_status status = make_room(insertion, error);
    if (status != SCREE_OK) return status;
    uint32_t triangle = delaunay_find(mesh, mesh->triangle_count - 1, point);
    for (int k = 0; k < 3; k++) {
        uint32_t corner = mesh->triangles[triangle].corner[k];
        if (mesh->points[corner].x != point.x || mesh->points[corner].y != point.y) continue;
        insertion->heights_m[corner] = height_m;
        return SCREE_OK;
    }
    insertion->heights_m[mesh->point_count] = height_m;
    delaunay_insert(mesh, triangle, point);
    return SCREE_OK;
}

static void insert_candidate(struct insertion *insertion, uint32_t triangle) {
    struct delaunay *mesh = &insertion->mesh;
    const struct insertion_posts *posts = &insertion->posts;
    uint32_t candidate = mesh->triangles[triangle].mark[CANDIDATE];
    int32_t column = (int32_t)(candidate % (uint32_t)posts->columns);
    int32_t row = (int32_t)(candidate / (uint32_t)posts->columns);
    insertion->heights_m[mesh->point_count] = (double)height_at(posts, column, row);
    uint32_t first = delaunay_insert(mesh, triangle, (struct delaunay_point){column * posts->span, row * posts->span});
    for (uint32_t t = first; t != DELAUNAY_NONE; t = delaunay_around(mesh, t, first)) rank_triangle(insertion, t);
}

enum scree_status insertion_run(struct insertion *insertion, double tolerance_m, uint32_t most_points,
                                struct scree_error *error) {
    insertion->tolerance_m = tolerance_m;
    for (uint32_t t = 0; t < insertion->mesh.triangle_count; t++) rank_triangle(insertion, t);
    while (insertion->heap_count > 0 && insertion->mesh.point_count < most_points) {
        enum scree_status status = make_room(insertion, error);
        if (status != SCREE_OK) return status;
        insert_candidate(insertion, insertion->heap[0].triangle);
    }
    return SCREE_OK;
}

/* Triangles within the tolerance are not in the heap, so they are scanned once more. */
double insertion_error_m(const struct insertion *insertion) {
    double error_m = 0;
    for (uint32_t t = 0; t < insertion->mesh.triangle_count; t++) {
        uint32_t candidate;
        error_m = larger(error_m, worst_post(insertion, insertion->mesh.triangles[t].corner, &candidate));
    }
    return error_m;
}
