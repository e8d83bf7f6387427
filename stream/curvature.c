#include "stream/curvature.h"

#include <math.h>
#include <stdbool.h>

/* Along one axis: where the differences about a post reach. */
struct stencil {
    int32_t at[3];          /* the posts before and after, and the post itself */
    int32_t from[3], to[3]; /* ends of the gradient at each of these */
    double per_m[3];        /* one over the distance of those ends */
    double along, across;   /* what brings a difference of gradients along the axis, and across it, to two posts */
};

static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

static struct stencil stencil_at(int32_t i, int32_t count, double spacing_m) {
    struct stencil stencil = {.at = {i > 0 ? i - 1 : 0, least(i + 1, count - 1), i}};
    for (int k = 0; k < 3; k++) {
        stencil.from[k] = stencil.at[k] > 0 ? stencil.at[k] - 1 : 0;
        stencil.to[k] = least(stencil.at[k] + 1, count - 1);
        stencil.per_m[k] = 1 / (spacing_m * (stencil.to[k] - stencil.from[k]));
    }
    int32_t twice_apart = stencil.from[1] + stencil.to[1] - stencil.from[0] - stencil.to[0];
    stencil.along = twice_apart > 0 ? 4.0 / twice_apart : 0; /* 0: two posts, which bend nowhere */
    stencil.across = 2.0 / (stencil.at[1] - stencil.at[0]);
    return stencil;
}

static double height_at(const struct curvature_posts *posts, int32_t x, int32_t y) {
    double height_m = posts->heights_m[(int64_t)y * posts->stride + x];
    return height_m - posts->east_drop_m * x * x - posts->north_drop_m * y * y;
}

/* Gradients to the east at the posts `i` of the one stencil and `j` of the other, and to the north. */
static double slope_east(const struct curvature_posts *posts, const struct stencil *x, const struct stencil *y, int i,
                         int j) {
    return (height_at(posts, x->to[i], y->at[j]) - height_at(posts, x->from[i], y->at[j])) * x->per_m[i];
}

static double slope_north(const struct curvature_posts *posts, const struct stencil *x, const struct stencil *y, int i,
                          int j) {
    return (height_at(posts, x->at[i], y->to[j]) - height_at(posts, x->at[i], y->from[j])) * y->per_m[j];
}

void curvature_row(const struct curvature_posts *posts, int32_t y_post, float *curvature) {
    const struct stencil y = stencil_at(y_post, posts->rows, posts->north_m);
    for (int32_t x_post = 0; x_post < posts->columns; x_post++) {
        const struct stencil x = stencil_at(x_post, posts->columns, posts->east_m);
        double xx = x.along * (slope_east(posts, &x, &y, 1, 2) - slope_east(posts, &x, &y, 0, 2));
        double yx = x.across * (slope_north(posts, &x, &y, 1, 2) - slope_north(posts, &x, &y, 0, 2));
        double xy = y.across * (slope_east(posts, &x, &y, 2, 1) - slope_east(posts, &x, &y, 2, 0));
        double yy = y.along * (slope_north(posts, &x, &y, 2, 1) - slope_north(posts, &x, &y, 2, 0));
        curvature[x_post] = (float)sqrt(xx * xx + yx * yx + xy * xy + yy * yy);
    }
}

/* ---- the pyramid ---- */

static enum scree_status check(const struct curvature_posts *posts, struct scree_error *error) {
    if (posts->columns < 2 || posts->rows < 2 || posts->columns > CURVATURE_MAX_POSTS ||
        posts->rows > CURVATURE_MAX_POSTS || posts->stride < posts->columns)
        return scree_fail(error, SCREE_E_ARGUMENT, "%d x %d posts: a quadtree takes 2 to %d a side",
                          (int)posts->columns, (int)posts->rows, CURVATURE_MAX_POSTS);
    if (!(posts->east_m > 0) || !(posts->north_m > 0) || !isfinite(posts->east_m) || !isfinite(posts->north_m) ||
        !isfinite(posts->east_drop_m) || !isfinite(posts->north_drop_m))
        return scree_fail(error, SCREE_E_ARGUMENT, "the distance between posts makes no sense");
    for (int32_t y = 0; y < posts->rows; y++)
        for (int32_t x = 0; x < posts->columns; x++)
            if (!isfinite(posts->heights_m[(int64_t)y * posts->stride + x]))
                return scree_fail(error, SCREE_E_ARGUMENT, "the height of post %d, %d is no finite number", (int)x,
                                  (int)y);
    return SCREE_OK;
}

static enum scree_status allocate(struct scree_memory *memory, const struct curvature_posts *posts,
                                  struct curvature_pyramid *pyramid, struct scree_error *error) {
    int32_t columns = posts->columns - 1, rows = posts->rows - 1;
    do {
        struct curvature_level *level = &pyramid->level[++pyramid->top];
        level->columns = columns = (columns + 1) / 2;
        level->rows = rows = (rows + 1) / 2;
        level->nodes = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *level->nodes,
                                      "the nodes of a quadtree", error);
        if (level->nodes == NULL) return SCREE_E_MEMORY;
    } while (columns > 1 || rows > 1);
    return SCREE_OK;
}

/* A node of level 1: up to four cells, from three rows of curvatures. */
static struct curvature_node smallest(const struct curvature_posts *posts, float *const curvature[3], int32_t x0,
                                      int32_t y0) {
    int32_t width = least(2, posts->columns - 1 - x0), height = least(2, posts->rows - 1 - y0);
    struct curvature_node node = {0, INFINITY, -INFINITY};
    double sum = 0;
    for (int32_t y = 0; y <= height; y++)
        for (int32_t x = 0; x <= width; x++) {
            double weight = (x == 0 || x == width ? 0.5 : 1) * (y == 0 || y == height ? 0.5 : 1);
            float height_m = posts->heights_m[(int64_t)(y0 + y) * posts->stride + x0 + x];
            sum += weight * curvature[y][x0 + x];
            node.low_m = fminf(node.low_m, height_m);
            node.high_m = fmaxf(node.high_m, height_m);
        }
    node.sum = (float)sum;
    return node;
}

static enum scree_status fill_smallest(struct scree_memory *memory, const struct curvature_posts *posts,
                                       struct curvature_level *level, struct scree_error *error) {
    float *curvature[3] = {NULL, NULL, NULL};
    enum scree_status status = SCREE_OK;
    for (int k = 0; k < 3; k++) {
        curvature[k] = scree_allocate(memory, (size_t)posts->columns, sizeof **curvature, "a row's curvature", error);
        if (curvature[k] == NULL) status = SCREE_E_MEMORY;
    }
    if (status != SCREE_OK) goto cleanup;
    curvature_row(posts, 0, curvature[2]);
    for (int32_t row = 0; row < level->rows; row++) {
        float *above = curvature[0];
        curvature[0] = curvature[2]; /* the border with the row of nodes below */
        curvature[2] = above;
        for (int32_t k = 1; k < 3; k++)
            if (2 * row + k < posts->rows) curvature_row(posts, 2 * row + k, curvature[k]);
        for (int32_t column = 0; column < level->columns; column++)
            level->nodes[(int64_t)row * level->columns + column] = smallest(posts, curvature, 2 * column, 2 * row);
    }
cleanup:
    for (int k = 0; k < 3; k++) scree_release(memory, curvature[k]);
    return status;
}

static void fill_parents(const struct curvature_level *children, struct curvature_level *parents) {
    for (int32_t row = 0; row < parents->rows; row++)
        for (int32_t column = 0; column < parents->columns; column++) {
            struct curvature_node node = {0, INFINITY, -INFINITY};
            double sum = 0;
            for (int32_t y = 2 * row; y < least(2 * row + 2, children->rows); y++)
                for (int32_t x = 2 * column; x < least(2 * column + 2, children->columns); x++) {
                    const struct curvature_node *child = &children->nodes[(int64_t)y * children->columns + x];
                    sum += child->sum;
                    node.low_m = fminf(node.low_m, child->low_m);
                    node.high_m = fmaxf(node.high_m, child->high_m);
                }
            node.sum = (float)sum; /* rounding keeps it at least as large as each child's */
            parents->nodes[(int64_t)row * parents->columns + column] = node;
        }
}

enum scree_status curvature_pyramid_make(struct scree_memory *memory, const struct curvature_posts *posts,
                                         struct curvature_pyramid *pyramid, struct scree_error *error) {
    *pyramid = (struct curvature_pyramid){0};
    enum scree_status status = check(posts, error);
    if (status == SCREE_OK) status = allocate(memory, posts, pyramid, error);
    if (status == SCREE_OK) status = fill_smallest(memory, posts, &pyramid->level[1], error);
    if (status != SCREE_OK) {
        curvature_pyramid_release(memory, pyramid);
        return status;
    }
    for (int32_t k = 2; k <= pyramid->top; k++) fill_parents(&pyramid->level[k - 1], &pyramid->level[k]);
    return SCREE_OK;
}

void curvature_pyramid_release(struct scree_memory *memory, struct curvature_pyramid *pyramid) {
    for (int32_t k = 1; k <= pyramid->top; k++) scree_release(memory, pyramid->level[k].nodes);
    *pyramid = (struct curvature_pyramid){0};
}
