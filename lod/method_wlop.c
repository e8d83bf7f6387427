#include "lod/method_wlop.h"

#include "lod/counter_random.h"
#include "lod/method_place.h"

#include <math.h>
#include <string.h>

#define REPULSION    0.45 /* mu */
#define TABLE_STEPS  1024
#define TABLE_FACTOR 0.98449643700540845 /* exp(-16 / TABLE_STEPS) */

/* Samples by squares of the plane: those of square s are order[starts[s]] and on, up to order[starts[s + 1]]. */
struct squares {
    double side_m;
    int32_t columns, rows;
    uint32_t *starts, *order;
};

struct wlop {
    const struct method_tile *tile;
    double cell_x_m, cell_y_m, radius2_m2;
    double steps_a_m2;        /* of the table of weights */
    int32_t reach_x, reach_y; /* posts */
    double weights[TABLE_STEPS + 2];
    struct vector3 *posts_m;   /* of the whole grid */
    double *post_weights;      /* the same: 1 / v; 0: the post is on the border or on a feature */
    struct vector3 *samples_m; /* and where they go */
    struct vector3 *moved_m;
    double *sample_weights; /* w */
    uint32_t sample_count;
    struct squares squares;
};

/* ---- weights ---- */

static void make_weights(struct wlop *w) {
    w->weights[0] = 1;
    for (int i = 1; i <= TABLE_STEPS + 1; i++) w->weights[i] = w->weights[i - 1] * TABLE_FACTOR;
}

/* exp(-16 d2 / radius^2) to about 3e-5 of itself, by a table: faster than exp, and the same bits everywhere. */
static double weight_at(const struct wlop *w, double distance2) {
    double at = distance2 * w->steps_a_m2;
    int32_t step = (int32_t)at;
    return w->weights[step] + (at - step) * (w->weights[step + 1] - w->weights[step]);
}

static double distance2(struct vector3 a, struct vector3 b) {
    struct vector3 off = vector3_minus(a, b);
    return vector3_dot(off, off);
}

/* ---- neighbours among the posts ---- */

static size_t post_index(const struct wlop *w, int32_t column, int32_t row) {
    return (size_t)row * (size_t)(w->tile->columns + 1) + (size_t)column;
}

/* The posts of the grid that may be within reach of a place. */
struct box {
    int32_t first_column, last_column, first_row, last_row;
};

static struct box box_around(const struct wlop *w, struct vector3 at) {
    const struct method_tile *tile = w->tile;
    double column = fmin(fmax(at.x / w->cell_x_m + 0.5 * tile->columns, 0), tile->columns);
    double row = fmin(fmax(at.y / w->cell_y_m + 0.5 * tile->rows, 0), tile->rows);
    return (struct box){(int32_t)fmax(ceil(column - w->reach_x), 0),
                        (int32_t)fmin(floor(column + w->reach_x), tile->columns),
                        (int32_t)fmax(ceil(row - w->reach_y), 0), (int32_t)fmin(floor(row + w->reach_y), tile->rows)};
}

/* 1 / v of a post: v is 1 and the weights of the other posts around it. */
static double post_weight(const struct wlop *w, size_t post, const unsigned char *is_free) {
    struct box box = box_around(w, w->posts_m[post]);
    double density = 1;
    for (int32_t row = box.first_row; row <= box.last_row; row++)
        for (int32_t column = box.first_column; column <= box.last_column; column++) {
            size_t other = post_index(w, column, row);
            double d2 = distance2(w->posts_m[post], w->posts_m[other]);
            if (is_free[other] && other != post && d2 <= w->radius2_m2) density += weight_at(w, d2);
        }
    return 1 / density;
}

/* The mean of the posts around a place; the place itself where there are none. */
static struct vector3 attraction(const struct wlop *w, struct vector3 at) {
    struct box box = box_around(w, at);
    struct vector3 sum = {0, 0, 0};
    double weights = 0, least2 = 1e-12 * w->radius2_m2; /* a post in the very place has no way to pull */
    for (int32_t row = box.first_row; row <= box.last_row; row++)
        for (int32_t column = box.first_column; column <= box.last_column; column++) {
            size_t post = post_index(w, column, row);
            double d2 = distance2(at, w->posts_m[post]);
            if (d2 > w->radius2_m2 || d2 < least2) continue;
            double weight = w->post_weights[post] * weight_at(w, d2) / sqrt(d2);
            sum = vector3_plus_scaled(sum, weight, vector3_minus(w->posts_m[post], at));
            weights += weight;
        }
    return weights > 0 ? vector3_plus_scaled(at, 1 / weights, sum) : at;
}

/* ---- neighbours among the samples ---- */

static int32_t square_of(double at, double half, double side_m, int32_t count) {
    double square = floor((at + half) / side_m);
    return square < 0 ? 0 : square >= count ? count - 1 : (int32_t)square;
}

static int32_t square_column(const struct wlop *w, double x) {
    return square_of(x, 0.5 * w->tile->columns * w->cell_x_m, w->squares.side_m, w->squares.columns);
}

static int32_t square_row(const struct wlop *w, double y) {
    return square_of(y, 0.5 * w->tile->rows * w->cell_y_m, w->squares.side_m, w->squares.rows);
}

static uint32_t square_at(const struct wlop *w, struct vector3 at) {
    return (uint32_t)square_row(w, at.y) * (uint32_t)w->squares.columns + (uint32_t)square_column(w, at.x);
}

static void sort_samples(struct wlop *w) {
    struct squares *squares = &w->squares;
    uint32_t count = (uint32_t)squares->columns * (uint32_t)squares->rows;
    memset(squares->starts, 0, (count + 2) * sizeof *squares->starts);
    for (uint32_t i = 0; i < w->sample_count; i++) squares->starts[square_at(w, w->samples_m[i]) + 2]++;
    for (uint32_t s = 2; s < count + 2; s++) squares->starts[s] += squares->starts[s - 1];
    for (uint32_t i = 0; i < w->sample_count; i++)
        squares->order[squares->starts[square_at(w, w->samples_m[i]) + 1]++] = i;
}

/* What a sample gets from the samples around it, itself included. */
struct crowd {
    double density;      /* of weights */
    struct vector3 away; /* the sum of the ways from them, weighted */
    double away_weights;
};

static struct crowd look_around(const struct wlop *w, struct vector3 at) {
    const struct squares *squares = &w->squares;
    int32_t column = square_column(w, at.x), row = square_row(w, at.y);
    int32_t first = column > 0 ? column - 1 : 0, last = column + 1 < squares->columns ? column + 1 : column;
    struct crowd crowd = {0};
    for (int32_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r < squares->rows; r++) {
        uint32_t from = squares->starts[r * squares->columns + first];
        uint32_t to = squares->starts[r * squares->columns + last + 1];
        for (uint32_t i = from; i < to; i++) {
            uint32_t other = squares->order[i];
            double d2 = distance2(at, w->samples_m[other]);
            if (d2 > w->radius2_m2) continue;
            double weight = weight_at(w, d2);
            crowd.density += weight;
            if (d2 < 1e-12 * w->radius2_m2) continue; /* itself */
            weight *= w->sample_weights[other] / sqrt(d2);
            crowd.away = vector3_plus_scaled(crowd.away, weight, vector3_minus(at, w->samples_m[other]));
            crowd.away_weights += weight;
        }
    }
    return crowd;
}

static void iterate(struct wlop *w) {
    sort_samples(w);
    for (uint32_t i = 0; i < w->sample_count; i++) w->sample_weights[i] = 0;
    for (uint32_t i = 0; i < w->sample_count; i++) w->moved_m[i].x = look_around(w, w->samples_m[i]).density;
    for (uint32_t i = 0; i < w->sample_count; i++) w->sample_weights[i] = w->moved_m[i].x;
    for (uint32_t i = 0; i < w->sample_count; i++) {
        struct crowd crowd = look_around(w, w->samples_m[i]);
        double push = crowd.away_weights > 0 ? REPULSION / crowd.away_weights : 0;
        w->moved_m[i] = vector3_plus_scaled(attraction(w, w->samples_m[i]), push, crowd.away);
    }
    struct vector3 *other = w->samples_m;
    w->samples_m = w->moved_m;
    w->moved_m = other;
}

/* ---- the whole ---- */

static void set_radius(struct wlop *w, double radius_m) {
    w->cell_x_m = w->tile->cell_span * w->tile->east_m;
    w->cell_y_m = w->tile->cell_span * w->tile->north_m;
    double widest_m = WLOP_REACH_CELLS * fmax(w->cell_x_m, w->cell_y_m);
    if (radius_m == 0) radius_m = WLOP_RADIUS_CELLS * 0.5 * (w->cell_x_m + w->cell_y_m);
    radius_m = fmax(fmin(radius_m, widest_m), 1e-6 * widest_m);
    w->radius2_m2 = radius_m * radius_m;
    w->steps_a_m2 = TABLE_STEPS / w->radius2_m2;
    w->reach_x = (int32_t)fmin(ceil(radius_m / w->cell_x_m), WLOP_REACH_CELLS);
    w->reach_y = (int32_t)fmin(ceil(radius_m / w->cell_y_m), WLOP_REACH_CELLS);
    w->squares.side_m = fmax(radius_m, fmax(w->cell_x_m, w->cell_y_m));
    w->squares.columns = (int32_t)ceil(w->tile->columns * w->cell_x_m / w->squares.side_m);
    w->squares.rows = (int32_t)ceil(w->tile->rows * w->cell_y_m / w->squares.side_m);
}

static enum scree_status allocate(struct wlop *w, struct scree_memory *memory, struct scree_error *error) {
    const char *what = "the samples of a projection";
    size_t posts = post_index(w, w->tile->columns, w->tile->rows) + 1, samples = w->sample_count;
    size_t squares = (size_t)w->squares.columns * (size_t)w->squares.rows;
    w->posts_m = scree_allocate(memory, posts, sizeof *w->posts_m, what, error);
    w->post_weights = scree_allocate(memory, posts, sizeof *w->post_weights, what, error);
    w->samples_m = scree_allocate(memory, samples, sizeof *w->samples_m, what, error);
    w->moved_m = scree_allocate(memory, samples, sizeof *w->moved_m, what, error);
    w->sample_weights = scree_allocate(memory, samples, sizeof *w->sample_weights, what, error);
    w->squares.starts = scree_allocate(memory, squares + 2, sizeof *w->squares.starts, what, error);
    w->squares.order = scree_allocate(memory, samples, sizeof *w->squares.order, what, error);
    bool done = w->posts_m != NULL && w->post_weights != NULL && w->samples_m != NULL && w->moved_m != NULL &&
                w->sample_weights != NULL && w->squares.starts != NULL && w->squares.order != NULL;
    return done ? SCREE_OK : SCREE_E_MEMORY;
}

static void release(struct wlop *w, struct scree_memory *memory) {
    scree_release(memory, w->squares.order);
    scree_release(memory, w->squares.starts);
    scree_release(memory, w->sample_weights);
    scree_release(memory, w->moved_m);
    scree_release(memory, w->samples_m);
    scree_release(memory, w->post_weights);
    scree_release(memory, w->posts_m);
}

static enum scree_status weigh_posts(struct wlop *w, const struct point_set *set, struct scree_memory *memory,
                                     struct scree_error *error) {
    size_t posts = post_index(w, w->tile->columns, w->tile->rows) + 1;
    unsigned char *is_free = scree_allocate(memory, posts, 1, "marks of posts", error);
    if (is_free == NULL) return SCREE_E_MEMORY;
    for (int32_t row = 0; row <= w->tile->rows; row++)
        for (int32_t column = 0; column <= w->tile->columns; column++)
            w->posts_m[post_index(w, column, row)] = method_post_place_m(w->tile, column, row);
    for (uint32_t i = 0; i < set->post_count; i++) is_free[post_index(w, set->posts[i].column, set->posts[i].row)] = 1;
    for (size_t post = 0; post < posts; post++)
        if (is_free[post]) w->post_weights[post] = post_weight(w, post, is_free);
    scree_release(memory, is_free);
    return SCREE_OK;
}

static void draw_samples(struct wlop *w, const struct point_set *set, uint64_t seed) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->post_count; i++)
        if (counter_random_below(seed, i, set->post_count - i) < w->sample_count - count)
            w->samples_m[count++] = method_post_place_m(w->tile, set->posts[i].column, set->posts[i].row);
}

enum scree_status method_wlop(struct scree_memory *memory, const struct method_tile *tile,
                              const struct method_wlop_options *options, struct method_mesh *mesh,
                              struct scree_error *error) {
    struct point_set set = {0};
    struct wlop wlop = {.tile = tile};
    *mesh = (struct method_mesh){0};
    if (!(options->kept_percent >= 0 && options->kept_percent <= 100) || !(options->radius_m >= 0) ||
        options->iterations < 0)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "wlop: %g percent, a radius of %g m, %d iterations; it takes 0 to 100, and 0 or more",
                          options->kept_percent, options->radius_m, (int)options->iterations);
    enum scree_status status = point_set_begin(memory, tile, &options->points, &set, error);
    if (status != SCREE_OK) goto cleanup;
    wlop.sample_count = (uint32_t)floor(options->kept_percent / 100 * set.post_count + 0.5);
    set_radius(&wlop, options->radius_m);
    make_weights(&wlop);
    status = allocate(&wlop, memory, error);
    if (status == SCREE_OK) status = weigh_posts(&wlop, &set, memory, error);
    if (status != SCREE_OK) goto cleanup;
    draw_samples(&wlop, &set, options->points.seed);
    int32_t iterations = options->iterations != 0 ? options->iterations : WLOP_ITERATIONS;
    for (int32_t i = 0; i < iterations; i++) iterate(&wlop);
    for (uint32_t i = 0; i < wlop.sample_count && status == SCREE_OK; i++)
        status = point_set_add_place(&set, wlop.samples_m[i], error);
    if (status == SCREE_OK) status = point_set_finish(&set, mesh, error);
cleanup:
    release(&wlop, memory);
    point_set_release(&set);
    return status;
}
