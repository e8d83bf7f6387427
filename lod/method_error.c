/* The exhaustive comparison of a method's mesh with its posts: see the header. */
#include "lod/method_error.h"

#include <math.h>
#include <string.h>

#define NEAR 1e-9 /* cells */

struct survey {
    const struct method_tile *tile;
    uint8_t *seen; /* one bit a post: it has been counted */
    double sum_m;
    struct method_error *result;
};

/* In cells from the south-western corner, and metres less the drop. */
struct place {
    double x, y, drawn_m;
};

static double twice_area(const struct place *a, const struct place *b, const struct place *c) {
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static void count(struct survey *survey, int32_t column, int32_t row, double distance_m) {
    struct method_error *result = survey->result;
    if (!isfinite(distance_m)) distance_m = HUGE_VAL; /* a NaN would slip through every comparison */
    if (distance_m > result->max_m) {
        result->max_m = distance_m;
        result->max_column = column;
        result->max_row = row;
    }
    size_t bit = (size_t)row * ((size_t)survey->tile->columns + 1) + (size_t)column;
    if (survey->seen[bit / 8] & (1U << bit % 8)) return; /* on a border with a triangle that has been measured */
    survey->seen[bit / 8] |= (uint8_t)(1U << bit % 8);
    result->posts_covered++;
    survey->sum_m += distance_m;
    result->sum_squares_m2 += distance_m * distance_m;
}

/* A row of posts within the triangle: where it lies on the left of all edges, or next to nothing to the right. */
static void measure_row(struct survey *survey, const struct place corner[3], double area2, int32_t row) {
    double first = 0, last = survey->tile->columns;
    for (int k = 0; k < 3; k++) {
        const struct place *a = &corner[k], *b = &corner[(k + 1) % 3];
        double dx = b->x - a->x, dy = b->y - a->y, slack = NEAR * (fabs(dx) + fabs(dy));
        double side = dx * (row - a->y) + slack; /* side >= dy (x - a.x) */
        if (dy > 0)
            last = fmin(last, a->x + side / dy);
        else if (dy < 0)
            first = fmax(first, a->x + side / dy);
        else if (side < 0)
            return;
    }
    for (int32_t column = (int32_t)ceil(first); column <= last; column++) {
        struct place post = {column, row, (double)method_post_m(survey->tile, column, row)};
        post.drawn_m -= method_drop_m(survey->tile, post.x * survey->tile->cell_span, post.y * survey->tile->cell_span);
        double sum_m = 0;
        for (int k = 0; k < 3; k++)
            sum_m += twice_area(&corner[(k + 1) % 3], &corner[(k + 2) % 3], &post) * (corner[k].drawn_m - post.drawn_m);
        count(survey, column, row, fabs(sum_m) / area2);
    }
}

/* A triangle so thin that its weights mean nothing is left to its neighbours. */
static bool is_thin(const struct place corner[3], double area2) {
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        const struct place *a = &corner[k], *b = &corner[(k + 1) % 3];
        longest = fmax(longest, fmax(fabs(b->x - a->x), fabs(b->y - a->y)));
    }
    return area2 <= NEAR * longest;
}

static void measure_triangle(struct survey *survey, const struct place corner[3], double area2) {
    double south = fmin(corner[0].y, fmin(corner[1].y, corner[2].y)) - NEAR;
    double north = fmax(corner[0].y, fmax(corner[1].y, corner[2].y)) + NEAR;
    int32_t last = north < survey->tile->rows ? (int32_t)floor(north) : survey->tile->rows;
    for (int32_t row = south > 0 ? (int32_t)ceil(south) : 0; row <= last; row++)
        measure_row(survey, corner, area2, row);
}

static enum scree_status check(const struct method_tile *tile, const struct method_mesh *mesh,
                               struct scree_error *error) {
    double columns = method_width(tile), rows = method_height(tile);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct method_vertex *v = &mesh->vertices[i];
        if (!(v->x >= 0 && v->y >= 0 && v->x <= columns && v->y <= rows))
            return scree_fail(error, SCREE_E_ARGUMENT, "vertex %u of the mesh lies at %g, %g, outside of %g x %g steps",
                              (unsigned)i, v->x, v->y, columns, rows);
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        if (mesh->corners[i] >= mesh->vertex_count)
            return scree_fail(error, SCREE_E_ARGUMENT, "triangle %zu of the mesh names vertex %u of %u", i / 3,
                              (unsigned)mesh->corners[i], (unsigned)mesh->vertex_count);
    return SCREE_OK;
}

enum scree_status method_error_measure(struct scree_memory *memory, const struct method_tile *tile,
                                       const struct method_mesh *mesh, struct method_error *result,
                                       struct scree_error *error) {
    struct survey survey = {.tile = tile, .result = result};
    int64_t posts = ((int64_t)tile->columns + 1) * (tile->rows + 1);
    double area2_sum = 0, whole2 = 2.0 * tile->columns * tile->rows;
    memset(result, 0, sizeof *result);
    enum scree_status status = check(tile, mesh, error);
    if (status != SCREE_OK) return status;
    survey.seen = scree_allocate(memory, (size_t)(posts + 7) / 8, 1, "the posts that were seen", error);
    if (survey.seen == NULL) return SCREE_E_MEMORY;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        struct place corner[3];
        for (int k = 0; k < 3; k++) {
            const struct method_vertex *v = &mesh->vertices[mesh->corners[3 * t + (size_t)k]];
            corner[k] = (struct place){v->x / tile->cell_span, v->y / tile->cell_span,
                                       v->height_m - method_drop_m(tile, v->x, v->y)};
        }
        double area2 = twice_area(&corner[0], &corner[1], &corner[2]);
        area2_sum += area2;
        if (area2 <= 0)
            result->triangles_without_area++;
        else if (!is_thin(corner, area2))
            measure_triangle(&survey, corner, area2);
    }
    if (result->posts_covered > 0) {
        result->mean_m = survey.sum_m / (double)result->posts_covered;
        result->rms_m = sqrt(result->sum_squares_m2 / (double)result->posts_covered);
    }
    result->areas_add_up = fabs(area2_sum - whole2) <= NEAR * whole2;
    result->covers = result->areas_add_up && result->triangles_without_area == 0 && result->posts_covered == posts;
    scree_release(memory, survey.seen);
    return SCREE_OK;
}
