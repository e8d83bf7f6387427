#include "lod/fit_sums.h"

#include <math.h>

#define GUARD 1e-7 /* crossings are whole numbers or at least 2^-30 apart from them where it matters: see samples.c */

/* The drawn plane through a triangle and the weight of its corner, from the corner on. */
struct facet {
    double slope_x, slope_y, weight_x, weight_y;
    double height_m;
    int32_t x, y;
    struct drop drop;
};

static struct facet facet_of(const struct samples *samples, const struct sample *corner, const struct sample *b,
                             const struct sample *c) {
    struct drop drop = samples_drop(samples, ((double)corner->y + b->y + c->y) / 3);
    double bx = b->x - corner->x, by = b->y - corner->y, cx = c->x - corner->x, cy = c->y - corner->y;
    double bz = sample_drawn_m(b, corner, drop), cz = sample_drawn_m(c, corner, drop), scale = 1 / (bx * cy - cx * by);
    return (struct facet){.slope_x = (bz * cy - cz * by) * scale,
                          .slope_y = (cz * bx - bz * cx) * scale,
                          .weight_x = (by - cy) * scale,
                          .weight_y = (cx - bx) * scale,
                          .height_m = corner->height_m,
                          .x = corner->x,
                          .y = corner->y,
                          .drop = drop};
}

/* Not those of the library, which look for NaN. */
static inline double smaller(double a, double b) {
    return a < b ? a : b;
}
static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* What is done with a sample. */
enum purpose { PURPOSE_SUM, PURPOSE_NARROW };

struct task {
    enum purpose purpose;
    struct fit_sums sums;
    double limit_m, low_m, high_m;
};

static inline void take(struct task *task, double residual_m, double weight) {
    if (task->purpose == PURPOSE_SUM) {
        double size_m = fabs(residual_m);
        task->sums.ww += weight * weight;
        task->sums.wr += weight * residual_m;
        task->sums.rr_m2 += residual_m * residual_m;
        task->sums.max_m = size_m > task->sums.max_m ? size_m : task->sums.max_m;
    } else if (weight > 0) {
        task->low_m = larger(task->low_m, (residual_m - task->limit_m) / weight);
        task->high_m = smaller(task->high_m, (residual_m + task->limit_m) / weight);
    }
}

static inline void take_sample(struct task *task, const struct facet *facet, const struct sample *at) {
    double dx = at->x - facet->x, dy = at->y - facet->y;
    double plane_m = facet->height_m + dx * (facet->slope_x + dx * facet->drop.east_m) +
                     dy * (facet->slope_y + dy * facet->drop.north_m);
    take(task, at->height_m - plane_m, 1 + dx * facet->weight_x + dy * facet->weight_y);
}

/* ---- posts ---- */

/* The same as take_sample for all posts of a row from `x` up to `end`; sums stay in registers. */
static inline void take_run(struct task *task, const struct facet *facet, const float *row, int32_t x, int32_t end,
                            double base_m, double weight) {
    struct task own = *task;
    double dx = x - facet->x;
    for (; x < end; x++, dx += 1)
        take(&own, row[x] - (base_m + dx * (facet->slope_x + dx * facet->drop.east_m)), weight + dx * facet->weight_x);
    *task = own;
}

static inline void take_row(const struct samples *samples, struct task *task, const struct facet *facet, int32_t y,
                            double left, double right) {
    double dy = y - facet->y, base_m = facet->height_m + dy * (facet->slope_y + dy * facet->drop.north_m);
    int32_t first = (int32_t)(left + (1 - GUARD)), end = (int32_t)(right + (1 - GUARD));
    take_run(task, facet, samples->posts + (int64_t)y * samples->stride, first, end, base_m, 1 + dy * facet->weight_y);
}

/* Rows from p's up to q's, without it, between the edges p-q and low-high. */
static inline void take_rows(const struct samples *samples, struct task *task, const struct facet *facet,
                             const struct sample *p, const struct sample *q, const struct sample *low, double long_step,
                             bool long_on_left) {
    double step = (double)(q->x - p->x) / (q->y - p->y);
    for (int32_t y = p->y; y < q->y; y++) {
        double at_long = low->x + long_step * (y - low->y), at = p->x + step * (y - p->y);
        take_row(samples, task, facet, y, long_on_left ? at_long : at, long_on_left ? at : at_long);
    }
}

static inline void take_posts(const struct samples *samples, struct task *task, const struct facet *facet,
                              const struct sample *low, const struct sample *middle, const struct sample *high) {
    const struct sample *other;
    if (middle->y < low->y) other = low, low = middle, middle = other;
    if (high->y < low->y) other = low, low = high, high = other;
    if (high->y < middle->y) other = middle, middle = high, high = other;
    double long_step = (double)(high->x - low->x) / (high->y - low->y);
    bool long_on_left = sample_area2(low, high, middle) < 0;
    if (middle->y > low->y) take_rows(samples, task, facet, low, middle, low, long_step, long_on_left);
    if (high->y > middle->y) take_rows(samples, task, facet, middle, high, low, long_step, long_on_left);
}

/* ---- extremes ---- */

/* Whether a point is on the inner side of a -> b, or on it where that is a left or a lower side. */
static inline bool owns(const struct sample *a, const struct sample *b, const struct sample *point) {
    int64_t area2 = sample_area2(a, b, point);
    return area2 > 0 || (area2 == 0 && (b->y < a->y || (b->y == a->y && b->x > a->x)));
}

static inline int32_t clamp_cell(int64_t position, int32_t span, int32_t cells) {
    int64_t cell = position / span;
    return cell < 0 ? 0 : cell >= cells ? cells - 1 : (int32_t)cell;
}

/* Where the part of an edge between two heights reaches, widened to whole steps. */
static inline void reach(const struct sample *a, const struct sample *b, double low, double high, double *left,
                         double *right) {
    double bottom = larger(smaller(a->y, b->y), low), top = smaller(larger(a->y, b->y), high);
    if (bottom > top) return;
    double slope = a->y == b->y ? 0 : (double)(b->x - a->x) / (b->y - a->y);
    double from = a->y == b->y ? a->x : a->x + slope * (bottom - a->y);
    double to = a->y == b->y ? b->x : a->x + slope * (top - a->y);
    *left = smaller(*left, smaller(from, to));
    *right = larger(*right, larger(from, to));
}

static inline void take_extremes(const struct samples *samples, struct task *task, const struct facet *facet,
                                 const struct sample *a, const struct sample *b, const struct sample *c) {
    int32_t span = samples->cell_span;
    int32_t south = a->y < b->y ? a->y : b->y, north = a->y > b->y ? a->y : b->y;
    if (c->y < south) south = c->y;
    if (c->y > north) north = c->y;
    /* a sample on a cell's upper or right side is a step beyond it */
    int32_t last_row = clamp_cell(north, span, samples->rows);
    for (int32_t row = clamp_cell((int64_t)south - 1, span, samples->rows); row <= last_row; row++) {
        double low = (double)row * span, high = low + span, left = INFINITY, right = -INFINITY;
        reach(a, b, low, high, &left, &right);
        reach(b, c, low, high, &left, &right);
        reach(c, a, low, high, &left, &right);
        if (left > right) continue;
        int32_t last = clamp_cell((int64_t)right + 1, span, samples->columns);
        for (int32_t column = clamp_cell((int64_t)left - 1, span, samples->columns); column <= last; column++) {
            const struct sample *pair = samples->extremes + 2 * ((int64_t)row * samples->columns + column);
            for (int i = 0; i < 2; i++)
                if (owns(a, b, &pair[i]) && owns(b, c, &pair[i]) && owns(c, a, &pair[i]))
                    take_sample(task, facet, &pair[i]);
        }
    }
}

/* ---- */

static inline void take_all(const struct samples *samples, const struct facet *facet, const struct sample *corner,
                            const struct sample *b, const struct sample *c, struct task *task) {
    if (samples->posts != NULL)
        take_posts(samples, task, facet, corner, b, c);
    else
        take_extremes(samples, task, facet, corner, b, c);
}

void fit_add_triangle(const struct samples *samples, const struct sample *corner, const struct sample *b,
                      const struct sample *c, struct fit_sums *sums) {
    struct facet facet = facet_of(samples, corner, b, c);
    struct task task = {.purpose = PURPOSE_SUM, .sums = *sums};
    take_all(samples, &facet, corner, b, c, &task);
    *sums = task.sums;
    double rounding_m =
        fmin(samples->rounding_steps * (fabs(facet.slope_x) + fabs(facet.slope_y)), samples->rounding_limit_m);
    if (rounding_m > sums->rounding_m) sums->rounding_m = rounding_m;
}

void fit_narrow(const struct samples *samples, const struct sample *corner, const struct sample *b,
                const struct sample *c, double limit_m, double *low_m, double *high_m) {
    struct facet facet = facet_of(samples, corner, b, c);
    struct task task = {.purpose = PURPOSE_NARROW, .limit_m = limit_m, .low_m = *low_m, .high_m = *high_m};
    take_all(samples, &facet, corner, b, c, &task);
    *low_m = task.low_m;
    *high_m = task.high_m;
}
