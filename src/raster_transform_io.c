/* From lattice posts to pixels: the transformer that warped virtual rasters use.
 *
 * GDAL's own would do but for four things: longitudes beyond 180 degrees, posts that lie on the very edge of the
 * raster and must not fall off it by rounding, latitudes beyond a pole (the corner of the pole's posts), and
 * PROJ's operations chosen once, for the whole area. */
#include "src/raster_parts_io.h"

#include <math.h>
#include <string.h>

#define EDGE_SLACK 0.01 /* pixels: a post so little beyond the raster's edge lies on it */
#define EDGE_INSET 1e-6 /* pixels: how far inside the edge it is put */

bool raster_transform_make(struct raster_transform *transform, const double geotransform[6], int columns, int rows,
                           bool is_geographic, PJ *to_lonlat) {
    memset(transform, 0, sizeof *transform);
    memcpy(transform->info.abySignature, GDAL_GTI2_SIGNATURE, sizeof transform->info.abySignature);
    transform->info.pszClassName = "ScreeTransform";
    transform->info.pfnTransform = raster_transform_points;
    memcpy(transform->to_world, geotransform, sizeof transform->to_world);
    transform->columns = columns;
    transform->rows = rows;
    transform->is_geographic = is_geographic;
    transform->to_lonlat = to_lonlat;
    return GDALInvGeoTransform(transform->to_world, transform->to_pixel);
}

static double snapped(double pixel, double size) {
    if (pixel < EDGE_INSET && pixel > -EDGE_SLACK) return EDGE_INSET;
    if (pixel > size - EDGE_INSET && pixel < size + EDGE_SLACK) return size - EDGE_INSET;
    return pixel;
}

static void project(PJ *to_lonlat, PJ_DIRECTION direction, int count, double *x, double *y) {
    if (to_lonlat == NULL || count <= 0) return;
    size_t n = (size_t)count;
    proj_trans_generic(to_lonlat, direction, x, sizeof *x, n, y, sizeof *y, n, NULL, 0, 0, NULL, 0, 0);
}

static void to_source(const struct raster_transform *t, int count, double *x, double *y, int *success) {
    for (int i = 0; i < count; i++) {
        x[i] = t->west + x[i] * t->spacing_x;
        y[i] = t->south + y[i] * t->spacing_y;
        if (t->to_lonlat != NULL) y[i] = fmin(fmax(y[i], -90.0), 90.0);
    }
    enum { CHUNK = 256 };
    for (int start = 0; start < count; start += CHUNK) {
        int n = count - start < CHUNK ? count - start : CHUNK;
        double longitude[CHUNK];
        memcpy(longitude, x + start, (size_t)n * sizeof *longitude);
        project(t->to_lonlat, PJ_INV, n, x + start, y + start);
        for (int i = 0; i < n; i++) {
            double *u = x + start + i, *v = y + start + i;
            success[start + i] = isfinite(*u) && isfinite(*v);
            if (!success[start + i]) {
                *u = *v = HUGE_VAL;
                continue;
            }
            /* PROJ brings longitudes into one turn; the source goes on counting where the lattice does. */
            if (t->is_geographic) *u += 360.0 * round((longitude[i] - *u) / 360.0);
            double column = t->to_pixel[0] + *u * t->to_pixel[1] + *v * t->to_pixel[2];
            double row = t->to_pixel[3] + *u * t->to_pixel[4] + *v * t->to_pixel[5];
            *u = snapped(column, t->columns);
            *v = snapped(row, t->rows);
        }
    }
}

static void from_source(const struct raster_transform *t, int count, double *x, double *y, int *success) {
    for (int i = 0; i < count; i++) {
        double column = x[i], row = y[i];
        x[i] = t->to_world[0] + column * t->to_world[1] + row * t->to_world[2];
        y[i] = t->to_world[3] + column * t->to_world[4] + row * t->to_world[5];
    }
    enum { CHUNK = 256 };
    for (int start = 0; start < count; start += CHUNK) {
        int n = count - start < CHUNK ? count - start : CHUNK;
        double before[CHUNK];
        memcpy(before, x + start, (size_t)n * sizeof *before);
        project(t->to_lonlat, PJ_FWD, n, x + start, y + start);
        for (int i = 0; i < n; i++) {
            double *u = x + start + i, *v = y + start + i;
            success[start + i] = isfinite(*u) && isfinite(*v);
            if (!success[start + i]) {
                *u = *v = HUGE_VAL;
                continue;
            }
            /* A geographic source counts on where its own longitudes do; others are put into the lattice's turn. */
            double middle = t->is_geographic ? before[i] : t->west + 180.0;
            *u += 360.0 * round((middle - *u) / 360.0);
            *u = (*u - t->west) / t->spacing_x;
            *v = (*v - t->south) / t->spacing_y;
        }
    }
}

int raster_transform_points(void *argument, int is_to_source, int count, double *x, double *y, double *z,
                            int *success) {
    (void)z;
    const struct raster_transform *transform = argument;
    if (is_to_source)
        to_source(transform, count, x, y, success);
    else
        from_source(transform, count, x, y, success);
    return TRUE;
}
