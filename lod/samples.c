#include "lod/samples.h"

#include <math.h>
#include <stddef.h>

/* struct triangle_error while it is summed up. */
struct sums {
    double max_m, sum_squares_m2;
};

/* The plane through a triangle's drawn heights, relative to corner a. */
struct plane {
    double height_m, gradient_x, gradient_y;
    struct drop drop;
};

static struct plane plane_through(const struct samples *samples, const struct sample *a, const struct sample *b,
                                  const struct sample *c) {
    struct drop drop = samples_drop(samples, ((double)a->y + b->y + c->y) / 3);
    double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y;
    double bz = sample_drawn_m(b, a, drop), cz = sample_drawn_m(c, a, drop);
    double scale = 1.0 / (bx * cy - cx * by);
    return (struct plane){a->height_m, (bz * cy - cz * by) * scale, (cz * bx - bz * cx) * scale, drop};
}

static inline void swap(const struct sample **p, const struct sample **q) {
    const struct sample *t = *p;
    *p = *q;
    *q = t;
}

/* Rows of posts between two edges. The ends are computed in doubles: the fractions met are at least 2^-20 apart from
 * whole numbers or equal to them, far more than the guard. */
#define ROW_GUARD 1e-7

static inline void scan_rows(const struct samples *samples, const struct plane *plane, const struct sample *origin,
                             int32_t y_first, int32_t y_last, double left, double left_step, double right,
                             double right_step, struct sums *error) {
    double max_m = error->max_m, sum = error->sum_squares_m2;
    for (int32_t y = y_first; y <= y_last; y++) {
        int32_t x_first = (int32_t)(left + (1 - ROW_GUARD)), x_last = (int32_t)(right + ROW_GUARD);
        const float *row = samples->posts + (int64_t)y * samples->stride;
        double dy = y - origin->y;
        double base = plane->height_m + dy * (plane->gradient_y + dy * plane->drop.north_m);
        for (int32_t x = x_first; x <= x_last; x++) {
            double dx = x - origin->x;
            double distance = row[x] - (base + dx * (plane->gradient_x + dx * plane->drop.east_m));
            double size = fabs(distance);
            max_m = size > max_m ? size : max_m;
            sum += distance * distance;
        }
        left += left_step;
        right += right_step;
    }
    error->max_m = max_m;
    error->sum_squares_m2 = sum;
}

static struct sums over_posts(const struct samples *samples, const struct plane *plane, const struct sample *a,
                              const struct sample *b, const struct sample *c) {
    const struct sample *origin = a;
    struct sums error = {0, 0};
    if (b->y < a->y) swap(&a, &b);
    if (c->y < a->y) swap(&a, &c);
    if (c->y < b->y) swap(&b, &c);
    /* a is the lowest, c the highest; the long edge a-c is on the left when b lies on its right */
    double long_step = c->y > a->y ? (double)(c->x - a->x) / (c->y - a->y) : 0;
    bool b_right = sample_area2(a, c, b) < 0;
    if (b->y > a->y) {
        double step = (double)(b->x - a->x) / (b->y - a->y);
        int32_t y_last = b->y - (c->y > b->y); /* b's own row belongs to the upper half when there is one */
        if (b_right)
            scan_rows(samples, plane, origin, a->y, y_last, a->x, long_step, a->x, step, &error);
        else
            scan_rows(samples, plane, origin, a->y, y_last, a->x, step, a->x, long_step, &error);
    }
    if (c->y > b->y) {
        double step = (double)(c->x - b->x) / (c->y - b->y), at = a->x + (b->y - a->y) * long_step;
        if (b_right)
            scan_rows(samples, plane, origin, b->y, c->y, at, long_step, b->x, step, &error);
        else
            scan_rows(samples, plane, origin, b->y, c->y, b->x, step, at, long_step, &error);
    }
    return error;
}

/* Where a row crosses a triangle; left > right when it misses it. */
struct crossing {
    double left, right;
};

static struct crossing cross_row(const struct sample *const corner[3], int32_t y) {
    struct crossing at = {INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        const struct sample *p = corner[i], *q = corner[(i + 1) % 3];
        if (p->y > q->y) swap(&p, &q);
        if (y < p->y || y > q->y || p->y == q->y) continue; /* the ends of a level edge belong to the others too */
        double x = p->x + (double)(q->x - p->x) * (y - p->y) / (q->y - p->y);
        if (x < at.left) at.left = x;
        if (x > at.right) at.right = x;
    }
    return at;
}

/* The cells of a row that may have a part in the triangle, and those among them that lie wholly inside. */
struct cell_range {
    int32_t first, last, inner_first, inner_last;
};

static inline int32_t clamp_cell(double position, int32_t span, int32_t cells) {
    int32_t cell = (int32_t)(position / span);
    return cell < 0 ? 0 : cell >= cells ? cells - 1 : cell;
}

/* `low` and `high` are where the row's lower and upper ends cross the triangle. */
static bool range_of_row(const struct samples *samples, const struct sample *const corner[3], int32_t row,
                         const struct crossing *low, const struct crossing *high, struct cell_range *range) {
    int32_t span = samples->cell_span, y_low = row * span, y_high = y_low + span;
    double least_x = low->left < high->left ? low->left : high->left;
    double largest_x = low->right > high->right ? low->right : high->right;
    for (int i = 0; i < 3; i++) {
        if (corner[i]->y < y_low || corner[i]->y > y_high) continue;
        if (corner[i]->x < least_x) least_x = corner[i]->x;
        if (corner[i]->x > largest_x) largest_x = corner[i]->x;
    }
    if (least_x > largest_x) return false;
    /* a sample on the border of its cell may be in a triangle that only touches it: one step more on the low side */
    range->first = clamp_cell(least_x - 1 - ROW_GUARD, span, samples->columns);
    range->last = clamp_cell(largest_x + ROW_GUARD, span, samples->columns);
    range->inner_first = range->last + 1;
    range->inner_last = range->last;
    double left = low->left > high->left ? low->left : high->left;
    double right = low->right < high->right ? low->right : high->right;
    if (!(right - left >= span)) return true;
    int32_t from = (int32_t)(left / span) + 1, to = (int32_t)(right / span) - 1;
    if (from > to || to > range->last) return true;
    range->inner_first = from;
    range->inner_last = to;
    return true;
}

static inline void add_sample(const struct sample *sample, const struct plane *plane, const struct sample *a,
                              struct sums *error) {
    double dx = sample->x - a->x, dy = sample->y - a->y;
    double distance = sample->height_m - (plane->height_m + dx * (plane->gradient_x + dx * plane->drop.east_m) +
                                          dy * (plane->gradient_y + dy * plane->drop.north_m));
    double size = fabs(distance);
    error->max_m = size > error->max_m ? size : error->max_m;
    error->sum_squares_m2 += distance * distance;
}

/* Samples of some cells that lie in the triangle: exact, by whole numbers. */
static void scan_cells(const struct sample *sample, const struct sample *end, const struct plane *plane,
                       const struct sample *const corner[3], struct sums *error) {
    const struct sample *a = corner[0], *b = corner[1], *c = corner[2];
    for (; sample < end; sample++)
        if (sample_area2(a, b, sample) >= 0 && sample_area2(b, c, sample) >= 0 && sample_area2(c, a, sample) >= 0)
            add_sample(sample, plane, a, error);
}

static inline const struct sample *first_in(const struct samples *samples, int64_t cell) {
    return samples->extremes + (samples->cell_first != NULL ? samples->cell_first[cell] : 2 * cell);
}

#define FEW_CELLS 20 /* looked through one by one before it pays to find out which of them a triangle misses */

static struct sums over_extremes(const struct samples *samples, const struct plane *plane, const struct sample *a,
                                 const struct sample *b, const struct sample *c) {
    const struct sample *const corner[3] = {a, b, c};
    struct sums error = {0, 0};
    struct cell_range range;
    int32_t y_least = a->y, y_largest = a->y, x_least = a->x, x_largest = a->x;
    for (int i = 1; i < 3; i++) {
        if (corner[i]->y < y_least) y_least = corner[i]->y;
        if (corner[i]->y > y_largest) y_largest = corner[i]->y;
        if (corner[i]->x < x_least) x_least = corner[i]->x;
        if (corner[i]->x > x_largest) x_largest = corner[i]->x;
    }
    int32_t row = clamp_cell(y_least - 1, samples->cell_span, samples->rows);
    int32_t row_last = clamp_cell(y_largest, samples->cell_span, samples->rows);
    int32_t column = clamp_cell(x_least - 1, samples->cell_span, samples->columns);
    int32_t column_last = clamp_cell(x_largest, samples->cell_span, samples->columns);
    if ((int64_t)(row_last - row + 1) * (column_last - column + 1) <= FEW_CELLS) {
        for (; row <= row_last; row++) {
            int64_t cells = (int64_t)row * samples->columns;
            scan_cells(first_in(samples, cells + column), first_in(samples, cells + column_last + 1), plane, corner,
                       &error);
        }
        return error;
    }
    struct crossing low, high = cross_row(corner, row * samples->cell_span);
    for (; row <= row_last; row++) {
        low = high;
        high = cross_row(corner, (row + 1) * samples->cell_span);
        if (!range_of_row(samples, corner, row, &low, &high, &range)) continue;
        int64_t cells = (int64_t)row * samples->columns;
        const struct sample *inner = first_in(samples, cells + range.inner_first);
        const struct sample *inner_end = first_in(samples, cells + range.inner_last + 1);
        scan_cells(first_in(samples, cells + range.first), inner, plane, corner, &error);
        for (const struct sample *sample = inner; sample < inner_end; sample++) add_sample(sample, plane, a, &error);
        scan_cells(inner_end, first_in(samples, cells + range.last + 1), plane, corner, &error);
    }
    return error;
}

struct triangle_error samples_triangle_error(const struct samples *samples, const struct sample *a,
                                             const struct sample *b, const struct sample *c) {
    struct plane plane = plane_through(samples, a, b, c);
    struct sums error = {0, 0};
    if (samples->posts == NULL)
        error = over_extremes(samples, &plane, a, b, c);
    else if (sample_area2(a, b, c) > 1) /* by Pick's theorem, a triangle of area 1/2 holds no post but its corners */
        error = over_posts(samples, &plane, a, b, c);
    double rounding_m = samples->rounding_steps * (fabs(plane.gradient_x) + fabs(plane.gradient_y));
    error.max_m += rounding_m < samples->rounding_limit_m ? rounding_m : samples->rounding_limit_m;
    return (struct triangle_error){(float)error.max_m, (float)error.sum_squares_m2};
}
