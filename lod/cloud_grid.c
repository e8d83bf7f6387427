#include "lod/cloud_grid.h"

#include "lod/delaunay.h"

#include <math.h>
#include <stdlib.h>

#define POSITION_BITS 24
#define MARGIN        (31 << POSITION_BITS) /* around the points: far corners hardly disturb the hull */
#define HILBERT_BITS  (POSITION_BITS + 1)
#define BOX_CORNERS   4
#define CLOSE         1e-6 /* of a post's spacing: so far outside of a triangle still counts as on its edge */
#define THINNEST      1e-9 /* of the points' bounds: less is a line */
#define MOST_POSTS    2147483647.0

/* ---- where posts lie ---- */

static double usual_spacing(double spacing) {
    double power = pow(10, floor(log10(spacing)));
    double times = spacing / power;
    return power * (times >= 5 ? 5 : times >= 2 ? 2 : 1);
}

enum scree_status cloud_posts_choose(const struct cloud *cloud, double spacing, struct cloud_posts *posts,
                                     struct scree_error *error) {
    double bounds[4];
    cloud_bounds(cloud, bounds);
    double width = bounds[2] - bounds[0], height = bounds[3] - bounds[1];
    if (!(width > THINNEST && height > THINNEST))
        return scree_fail(error, SCREE_E_ARGUMENT, "its points lie on one line, which is no surface");
    if (spacing == 0) spacing = usual_spacing(sqrt(width * height / cloud->count));
    double first_x = ceil(bounds[0] / spacing - CLOSE), last_x = floor(bounds[2] / spacing + CLOSE);
    double first_y = ceil(bounds[1] / spacing - CLOSE), last_y = floor(bounds[3] / spacing + CLOSE);
    double columns = last_x - first_x + 1, rows = last_y - first_y + 1;
    if (!(columns >= 2 && rows >= 2))
        return scree_fail(error, SCREE_E_ARGUMENT, "its points span %g x %g, too little for posts %g apart (--grid)",
                          width, height, spacing);
    if (!(columns * rows <= MOST_POSTS))
        return scree_fail(error, SCREE_E_LIMIT, "posts %g apart would be %.0f x %.0f", spacing, columns, rows);
    *posts = (struct cloud_posts){first_x * spacing, first_y * spacing, spacing, (int32_t)columns, (int32_t)rows};
    return SCREE_OK;
}

/* ---- triangles ---- */

struct ordered_point {
    uint64_t key; /* along the Hilbert curve */
    double z;
    uint32_t index;
};

static int compare_ordered(const void *first, const void *second) {
    const struct ordered_point *a = first, *b = second;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    if (a->z != b->z) return a->z < b->z ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

static uint64_t hilbert(uint32_t x, uint32_t y) {
    uint64_t key = 0;
    for (uint32_t side = 1u << (HILBERT_BITS - 1); side > 0; side /= 2) {
        uint32_t right = (x & side) != 0, up = (y & side) != 0;
        key = 4 * key + ((3 * right) ^ up);
        if (up) continue;
        if (right) {
            x = ~x;
            y = ~y;
        }
        uint32_t swapped = x;
        x = y;
        y = swapped;
    }
    return key;
}

struct triangulation {
    struct delaunay mesh;
    uint32_t *source; /* of every point of the mesh behind the box's corners: its number in the cloud */
};

/* From coordinates to whole steps, a power of two each, so that what is round stays what it is. */
struct rounding {
    double west, south, step;
};

static struct delaunay_point rounded(const struct rounding *rounding, const struct cloud_point *point) {
    return (struct delaunay_point){(int32_t)lrint((point->x - rounding->west) / rounding->step) + MARGIN,
                                   (int32_t)lrint((point->y - rounding->south) / rounding->step) + MARGIN};
}

static enum scree_status insert_points(const struct cloud *cloud, const struct rounding *rounding,
                                       const struct ordered_point *order, struct triangulation *result,
                                       struct scree_error *error) {
    struct delaunay *mesh = &result->mesh;
    enum scree_status status = delaunay_reserve(mesh, cloud->count + BOX_CORNERS, error);
    uint32_t triangle = 0;
    for (uint32_t i = 0; i < cloud->count && status == SCREE_OK; i++) {
        if (i > 0 && order[i].key == order[i - 1].key) continue; /* the lowest of a place comes first */
        struct delaunay_point place = rounded(rounding, &cloud->points[order[i].index]);
        triangle = delaunay_find(mesh, triangle, place);
        result->source[mesh->point_count] = order[i].index;
        triangle = delaunay_insert(mesh, triangle, place);
    }
    return status;
}

static enum scree_status triangulate(const struct cloud *cloud, struct triangulation *result,
                                     struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    double bounds[4];
    cloud_bounds(cloud, bounds);
    double width = bounds[2] - bounds[0], height = bounds[3] - bounds[1];
    int exponent;
    frexp(fmax(width, height), &exponent); /* below 2^exponent */
    struct rounding rounding = {bounds[0], bounds[1], ldexp(1, exponent - POSITION_BITS)};
    struct ordered_point *order =
        scree_allocate(cloud->memory, cloud->count, sizeof *order, "the order of a cloud's points", error);
    result->source = scree_allocate(cloud->memory, (size_t)cloud->count + BOX_CORNERS, sizeof *result->source,
                                    "the sources of a triangulation's points", error);
    if (order == NULL || result->source == NULL) {
        status = error->status;
        goto cleanup;
    }
    for (uint32_t i = 0; i < cloud->count; i++) {
        struct delaunay_point place = rounded(&rounding, &cloud->points[i]);
        uint64_t key = hilbert((uint32_t)(place.x - MARGIN), (uint32_t)(place.y - MARGIN));
        order[i] = (struct ordered_point){key, cloud->points[i].z, i};
    }
    qsort(order, cloud->count, sizeof *order, compare_ordered);
    status = delaunay_start(cloud->memory, (int32_t)lrint(width / rounding.step) + 2 * MARGIN,
                            (int32_t)lrint(height / rounding.step) + 2 * MARGIN, &result->mesh, error);
    if (status == SCREE_OK) status = insert_points(cloud, &rounding, order, result, error);
cleanup:
    scree_release(cloud->memory, order);
    return status;
}

/* ---- heights ---- */

struct corner {
    double x, y, z; /* x and y in posts from the first one */
};

/* Where a line of posts enters and leaves the closed triangle; from > to: it does not. */
static void cross_row(const struct corner corners[3], double y, double *from, double *to) {
    *from = INFINITY;
    *to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const struct corner *a = &corners[k], *b = &corners[(k + 1) % 3];
        if (y < fmin(a->y, b->y) - CLOSE || y > fmax(a->y, b->y) + CLOSE) continue;
        double share = a->y == b->y ? 0 : fmin(fmax((y - a->y) / (b->y - a->y), 0), 1);
        double x = a->x + share * (b->x - a->x);
        *from = fmin(*from, x);
        *to = fmax(*to, x);
        if (a->y != b->y) continue;
        *from = fmin(*from, b->x);
        *to = fmax(*to, b->x);
    }
}

static uint64_t sample_triangle(const struct corner corners[3], const struct cloud_posts *posts, float *heights) {
    const struct corner *a = &corners[0], *b = &corners[1], *c = &corners[2];
    double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y, area = bx * cy - by * cx;
    uint64_t covered = 0;
    if (!(area > 0)) return 0; /* thinner than positions are rounded: others cover it */
    double slope_x = ((b->z - a->z) * cy - (c->z - a->z) * by) / area;
    double slope_y = ((c->z - a->z) * bx - (b->z - a->z) * cx) / area;
    double south = fmin(a->y, fmin(b->y, c->y)), north = fmax(a->y, fmax(b->y, c->y));
    double low = fmin(a->z, fmin(b->z, c->z)), high = fmax(a->z, fmax(b->z, c->z));
    int32_t first = (int32_t)fmax(ceil(south - CLOSE), 0), last = (int32_t)fmin(floor(north + CLOSE), posts->rows - 1);
    for (int32_t row = first; row <= last; row++) {
        double from, to;
        cross_row(corners, row, &from, &to);
        int32_t left = (int32_t)fmax(ceil(from - CLOSE), 0);
        int32_t right = (int32_t)fmin(floor(to + CLOSE), posts->columns - 1);
        for (int32_t column = left; column <= right; column++) {
            float *height = &heights[(size_t)row * (size_t)posts->columns + (size_t)column];
            covered += isnan(*height);
            *height = (float)fmin(fmax(a->z + slope_x * (column - a->x) + slope_y * (row - a->y), low), high);
        }
    }
    return covered;
}

static bool is_short(const struct cloud_point *a, const struct cloud_point *b, double longest) {
    double dx = a->x - b->x, dy = a->y - b->y;
    return dx * dx + dy * dy <= longest * longest;
}

enum scree_status cloud_sample(const struct cloud *cloud, const struct cloud_posts *posts, double longest_edge,
                               float *heights, uint64_t *covered, struct scree_error *error) {
    struct triangulation found = {.mesh = {.memory = cloud->memory}};
    enum scree_status status = triangulate(cloud, &found, error);
    size_t count = (size_t)posts->columns * (size_t)posts->rows;
    for (size_t i = 0; i < count; i++) heights[i] = NAN;
    *covered = 0;
    for (uint32_t t = 0; t < found.mesh.triangle_count && status == SCREE_OK; t++) {
        const uint32_t *corner = found.mesh.triangles[t].corner;
        if (corner[0] < BOX_CORNERS || corner[1] < BOX_CORNERS || corner[2] < BOX_CORNERS) continue;
        const struct cloud_point *p[3];
        struct corner corners[3];
        for (int k = 0; k < 3; k++) {
            p[k] = &cloud->points[found.source[corner[k]]];
            corners[k] = (struct corner){(p[k]->x - posts->west) / posts->spacing,
                                         (p[k]->y - posts->south) / posts->spacing, p[k]->z};
        }
        if (is_short(p[0], p[1], longest_edge) && is_short(p[1], p[2], longest_edge) &&
            is_short(p[2], p[0], longest_edge))
            *covered += sample_triangle(corners, posts, heights);
    }
    delaunay_release(&found.mesh);
    scree_release(cloud->memory, found.source);
    return status;
}
