#include "src/tin_points_io.h"

#include "src/tin_georef_io.h"
#include "src/tin_place.h"
#include "src/tin_read_io.h"
#include "src/tin_twins.h"

#include <math.h>
#include <stdlib.h>

#define SAME_STEPS  1e-3  /* of bounds that are the same */
#define SAME_DOUBLE 1e-12 /* of a coordinate: what a manifest's text and another PROJ may round */

static enum scree_status check_bounds(const char *name, const struct lattice *lattice, const double bounds[4],
                                      const double built[4], struct scree_error *error) {
    bool is_same = true;
    for (int side = 0; side < 4; side++) {
        double step = side % 2 == 0 ? lattice->spacing_x : lattice->spacing_y;
        is_same = is_same && fabs(bounds[side] - built[side]) <= SAME_STEPS * step + SAME_DOUBLE * fabs(built[side]);
    }
    if (is_same) return SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT,
                      "%s: its points lie within %.10g %.10g %.10g %.10g, but the terrain was built within %.10g %.10g "
                      "%.10g %.10g; use the same inputs and options as for the build",
                      name, bounds[0], bounds[1], bounds[2], bounds[3], built[0], built[1], built[2], built[3]);
}

/* Triangles that rounding has made flat are not there, and points that have no others are not either. */
static enum scree_status drop_flattened(const struct tin *tin, struct tin_points *points, struct scree_error *error) {
    bool *is_there = scree_allocate(&points->memory, points->count, sizeof *is_there, "the points of a TIN", error);
    if (is_there == NULL) return error->status;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        const uint32_t *corner = tin->corners + 3 * t;
        const struct tin_post *a = &points->points[corner[0]], *b = &points->points[corner[1]];
        const struct tin_post *c = &points->points[corner[2]];
        int64_t area2 = (int64_t)(b->x - a->x) * (c->y - a->y) - (int64_t)(c->x - a->x) * (b->y - a->y);
        for (int k = 0; k < 3 && area2 > 0; k++) is_there[corner[k]] = true;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < points->count; i++)
        if (is_there[i]) points->points[kept++] = points->points[i];
    points->count = kept;
    scree_release(&points->memory, is_there);
    return SCREE_OK;
}

static enum scree_status put_on_lattice(const char *name, const struct tin *tin, const struct lattice *lattice,
                                        const double bounds[4], struct tin_points *points, struct scree_error *error) {
    struct tin_place place = {.lattice = *lattice};
    place.x = points->x = tin_place_x(lattice, bounds[0]);
    place.y = points->y = tin_place_y(lattice, bounds[1]);
    points->count = tin->point_count;
    if (tin_place_x(lattice, bounds[2]) - place.x > TIN_LATTICE_MOST_STEPS ||
        tin_place_y(lattice, bounds[3]) - place.y > TIN_LATTICE_MOST_STEPS)
        return scree_fail(error, SCREE_E_LIMIT, "%s: reaches over more of the lattice's steps than can be counted",
                          name);
    points->points = scree_allocate(&points->memory, tin->point_count, sizeof *points->points,
                                    "the points of a TIN on its lattice", error);
    if (points->points == NULL) return error->status;
    tin_place_points(tin, &place, points->points);
    enum scree_status status = tin_twins_level(&points->memory, points->points, points->count, error);
    return status == SCREE_OK ? drop_flattened(tin, points, error) : status;
}

enum scree_status tin_points_open(const struct raster_options *options, const struct lattice *lattice,
                                  const double built_bounds[4], struct tin_points *points, struct scree_error *error) {
    enum tin_kind kind;
    struct cloud_meaning meaning = {0};
    struct tin_mended mended;
    struct raster_summary summary = {0};
    double unit_m;
    *points = (struct tin_points){.memory.limit_bytes = cloud_memory_bytes(&options->cloud)};
    struct tin tin = {.memory = &points->memory};
    enum scree_status status = tin_kind_find(options, &kind, error);
    const char *name = options->inputs[0];
    if (status == SCREE_OK) status = tin_read(options, kind, &tin, &mended, &meaning, error);
    if (status == SCREE_OK) status = tin_georeference(options, name, &meaning, &tin, &summary, &unit_m, error);
    if (status == SCREE_OK) status = check_bounds(name, lattice, summary.bounds, built_bounds, error);
    if (status == SCREE_OK) status = put_on_lattice(name, &tin, lattice, summary.bounds, points, error);
    raster_summary_free(&summary);
    cloud_meaning_free(&meaning);
    tin_release(&tin);
    return status;
}

void tin_points_release(struct tin_points *points) {
    scree_release(&points->memory, points->points);
    *points = (struct tin_points){0};
}
