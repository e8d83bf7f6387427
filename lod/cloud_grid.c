#include "lod/cloud_grid.h"

#include <math.h>
#include <stdlib.h>

#define CLOSE      1e-6 /* of a post's spacing: so far outside of a triangle still counts as on its edge */
#define THINNEST   1e-9 /* of the points' bounds: less is a line */
#define MOST_POSTS 2147483647.0

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
    if (area == 0) return 0; /* its neighbours cover it */
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
            double z = fmin(fmax(a->z + slope_x * (column - a->x) + slope_y * (row - a->y), low), high);
            covered += isnan(*height);
            *height = fmaxf(*height, (float)z); /* which takes a number before NaN */
        }
    }
    return covered;
}

uint64_t tin_sample(const struct tin *tin, const struct cloud_posts *posts, float *heights) {
    size_t count = (size_t)posts->columns * (size_t)posts->rows;
    uint64_t covered = 0;
    for (size_t i = 0; i < count; i++) heights[i] = NAN;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        struct corner corners[3];
        for (int k = 0; k < 3; k++) {
            const struct cloud_point *point = &tin->points[tin->corners[3 * t + (size_t)k]];
            corners[k] = (struct corner){(point->x - posts->west) / posts->spacing,
                                         (point->y - posts->south) / posts->spacing, point->z};
        }
        covered += sample_triangle(corners, posts, heights);
    }
    return covered;
}
