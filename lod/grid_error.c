/* The exhaustive comparison of a triangulation with its posts: see the header. */
#include "lod/grid_error.h"

#include <math.h>

struct survey {
    const float *heights_m;
    int32_t columns, rows, stride;
    uint8_t *seen; /* one bit a post: it has been counted */
    double sum_m, sum_squares_m2;
    struct grid_error *result;
};

struct corner {
    int64_t x, y;
    double height_m;
};

static int64_t floor_div(int64_t a, int64_t b) {
    int64_t q = a / b;
    return q * b > a ? q - 1 : q; /* b > 0 */
}

static int64_t twice_area(const struct corner *a, const struct corner *b, const struct corner *c) {
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Narrows [first, last] to the posts of row y on the left of a -> b, the line included. */
static void clip_row(const struct corner *a, const struct corner *b, int64_t y, int64_t *first, int64_t *last) {
    /* (b.x - a.x)(y - a.y) - (b.y - a.y)(x - a.x) >= 0 */
    int64_t rise = b->y - a->y, side = (b->x - a->x) * (y - a->y) + rise * a->x;
    if (rise > 0) {
        int64_t limit = floor_div(side, rise); /* x <= side / rise */
        if (limit < *last) *last = limit;
    } else if (rise < 0) {
        int64_t limit = -floor_div(side, -rise); /* x >= side / rise */
        if (limit > *first) *first = limit;
    } else if (side < 0) {
        *last = *first - 1;
    }
}

static void measure_post(struct survey *survey, const struct corner corner[3], int64_t area2, int64_t x, int64_t y) {
    struct corner post = {x, y, (double)survey->heights_m[y * survey->stride + x]};
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        int64_t weight = twice_area(&corner[(k + 1) % 3], &corner[(k + 2) % 3], &post);
        sum += (double)weight * (corner[k].height_m - post.height_m);
    }
    double distance_m = fabs(sum) / (double)area2;
    if (!isfinite(distance_m)) distance_m = HUGE_VAL; /* a NaN would slip through every comparison */
    if (distance_m > survey->result->max_m) {
        survey->result->max_m = distance_m;
        survey->result->max_x = (int32_t)x;
        survey->result->max_y = (int32_t)y;
    }
    size_t bit = (size_t)y * (size_t)survey->columns + (size_t)x;
    if (survey->seen[bit / 8] & (1U << bit % 8)) return; /* on a border with a triangle that has been measured */
    survey->seen[bit / 8] |= (uint8_t)(1U << bit % 8);
    survey->result->posts_covered++;
    survey->sum_m += distance_m;
    survey->sum_squares_m2 += distance_m * distance_m;
}

static void measure_triangle(struct survey *survey, const struct corner corner[3], int64_t area2) {
    int64_t south = corner[0].y, north = corner[0].y, west = corner[0].x, east = corner[0].x;
    for (int k = 1; k < 3; k++) {
        if (corner[k].y < south) south = corner[k].y;
        if (corner[k].y > north) north = corner[k].y;
        if (corner[k].x < west) west = corner[k].x;
        if (corner[k].x > east) east = corner[k].x;
    }
    for (int64_t y = south; y <= north; y++) {
        int64_t first = west, last = east;
        for (int k = 0; k < 3; k++) clip_row(&corner[k], &corner[(k + 1) % 3], y, &first, &last);
        for (int64_t x = first; x <= last; x++) measure_post(survey, corner, area2, x, y);
    }
}

static enum scree_status check_mesh(const struct scree_mesh *mesh, int32_t columns, int32_t rows,
                                    struct scree_error *error) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct scree_vertex *v = &mesh->vertices[i];
        if (v->x < 0 || v->y < 0 || v->x >= columns || v->y >= rows)
            return scree_fail(error, SCREE_E_ARGUMENT, "vertex %u of the mesh is at post %d, %d, outside of %d x %d",
                              (unsigned)i, (int)v->x, (int)v->y, (int)columns, (int)rows);
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        if (mesh->corners[i] >= mesh->vertex_count)
            return scree_fail(error, SCREE_E_ARGUMENT, "triangle %zu of the mesh names vertex %u of %u", i / 3,
                              (unsigned)mesh->corners[i], (unsigned)mesh->vertex_count);
    return SCREE_OK;
}

enum scree_status grid_error_measure(const float *heights_m, int32_t columns, int32_t rows, int32_t stride,
                                     const struct scree_mesh *mesh, const double *vertex_heights_m,
                                     struct scree_memory *memory, struct grid_error *result,
                                     struct scree_error *error) {
    if (heights_m == NULL || columns < 1 || rows < 1 || columns > GRID_ERROR_MAX_POSTS || rows > GRID_ERROR_MAX_POSTS ||
        stride < columns)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "measuring a mesh: %d x %d posts with a stride of %d; at most %d a side", (int)columns,
                          (int)rows, (int)stride, GRID_ERROR_MAX_POSTS);
    enum scree_status status = check_mesh(mesh, columns, rows, error);
    if (status != SCREE_OK) return status;

    int64_t post_count = (int64_t)columns * rows, area2_sum = 0;
    *result = (struct grid_error){0};
    struct survey survey = {.heights_m = heights_m, .columns = columns, .rows = rows, .stride = stride};
    survey.result = result;
    struct scree_error own_error = {0};
    if (error == NULL) error = &own_error;
    survey.seen = scree_allocate(memory, ((size_t)post_count + 7) / 8, 1, "the map of measured posts", error);
    if (survey.seen == NULL) return error->status;

    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        struct corner corner[3];
        for (int k = 0; k < 3; k++) {
            uint32_t i = mesh->corners[3 * (size_t)t + (size_t)k];
            const struct scree_vertex *v = &mesh->vertices[i];
            corner[k].x = v->x;
            corner[k].y = v->y;
            corner[k].height_m = vertex_heights_m != NULL
                                     ? vertex_heights_m[i]
                                     : (double)heights_m[(size_t)v->y * (size_t)stride + (size_t)v->x];
        }
        int64_t area2 = twice_area(&corner[0], &corner[1], &corner[2]);
        area2_sum += area2;
        if (area2 > 0)
            measure_triangle(&survey, corner, area2);
        else if (area2 == 0)
            result->flat_triangles++;
        else
            result->turned_triangles++;
    }
    if (result->posts_covered > 0) {
        result->mean_m = survey.sum_m / (double)result->posts_covered;
        result->rms_m = sqrt(survey.sum_squares_m2 / (double)result->posts_covered);
    }
    result->areas_add_up = area2_sum == 2 * (int64_t)(columns - 1) * (rows - 1);
    result->covers = result->areas_add_up && result->flat_triangles == 0 && result->turned_triangles == 0 &&
                     result->posts_covered == post_count;
    scree_release(memory, survey.seen);
    return SCREE_OK;
}
