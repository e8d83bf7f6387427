#include "src/tin_source_io.h"

#include "src/tin_georef_io.h"
#include "src/tin_place.h"
#include "src/tin_read_io.h"
#include "src/tin_step.h"
#include "src/tin_twins.h"

#include <math.h>

#define LEAST_POWER (-4) /* of the quantum of heights, in their own unit */
#define MOST_POWER  1
#define RADIANS     0.017453292519943295

enum scree_status tin_source_is_wanted(const struct raster_options *options, bool *is_wanted,
                                       struct scree_error *error) {
    enum tin_kind kind;
    enum scree_status status = tin_kind_find(options, &kind, error);
    *is_wanted = status == SCREE_OK && kind != TIN_OF_NOTHING;
    return status;
}

/* A degree of longitude is shorter than one of latitude, in which spacings are told. */
static void tell_spacing(const struct tin *tin, enum profile profile, struct raster_summary *summary) {
    double spacing = tin_mean_distance(tin), middle_deg = (summary->bounds[1] + summary->bounds[3]) / 2;
    if (profile == PROFILE_GEODETIC) spacing *= sqrt(cos(middle_deg * RADIANS));
    summary->spacing_x = summary->spacing_y = spacing;
}

static void steps_of_row(const void *context, int32_t y, double *east_m, double *north_m) {
    const struct tin_source *source = context;
    lattice_steps_m(&source->lattice, (double)(source->y + y), east_m, north_m);
}

/* Takes points and triangles out of the TIN, and frees what is no longer needed as soon as that is so. */
static enum scree_status put_on_lattice(struct tin *tin, const struct tin_place *place, struct tin_source *source,
                                        struct scree_error *error) {
    source->lattice = place->lattice;
    source->leaf_zoom = place->leaf_zoom;
    source->cells = place->cells;
    source->x = place->x;
    source->y = place->y;
    source->window = place->window;
    source->placed = (struct tin_lattice){.memory = &source->memory,
                                          .corners = tin->corners,
                                          .point_count = tin->point_count,
                                          .triangle_count = tin->triangle_count,
                                          .tile_span = place->tile_span,
                                          .tiles_x = place->tiles_x,
                                          .tiles_y = place->tiles_y,
                                          .wall_steps = place->wall_steps};
    tin->corners = NULL;
    source->placed.points = scree_allocate(&source->memory, tin->point_count, sizeof *source->placed.points,
                                           "the points of a TIN on its lattice", error);
    if (source->placed.points == NULL) return error->status;
    tin_place_points(tin, place, source->placed.points);
    tin_release(tin);
    enum scree_status status =
        tin_twins_level(&source->memory, source->placed.points, source->placed.point_count, error);
    return status == SCREE_OK ? tin_lattice_finish(&source->placed, steps_of_row, source, error) : status;
}

static enum scree_status place(const struct raster_options *options, uint32_t block_points, struct tin *tin,
                               struct tin_source *source, struct scree_error *error) {
    struct raster_summary *summary = &source->summary;
    struct tin_place_options wanted = {.profile = options->profile,
                                       .metres_per_unit = summary->metres_per_unit,
                                       .block_points = block_points > 0 ? block_points : TIN_BLOCK_POINTS};
    struct tin_place chosen;
    struct scree_error why = {0};
    tell_spacing(tin, options->profile, summary);
    enum scree_status status = tin_place_choose(tin, &wanted, &chosen, &why);
    if (status == SCREE_OK) status = put_on_lattice(tin, &chosen, source, &why);
    if (status == SCREE_E_LIMIT || status == SCREE_E_MEMORY)
        return scree_fail(error, status, "%s: %s; name more --memory than %zu MB", options->inputs[0], why.text,
                          source->memory.limit_bytes >> 20);
    if (status != SCREE_OK) return scree_fail(error, status, "%s: %s", options->inputs[0], why.text);
    if (options->profile == PROFILE_LOCAL) {
        summary->columns = source->lattice.columns;
        summary->rows = source->lattice.rows;
    }
    return SCREE_OK;
}

enum scree_status tin_source_open(const struct raster_options *options, uint32_t block_points, bool has_outside,
                                  struct tin_source *source, struct scree_error *error) {
    enum tin_kind kind;
    struct cloud_meaning meaning = {0};
    *source = (struct tin_source){.memory.limit_bytes = cloud_memory_bytes(&options->cloud)};
    struct tin tin = {.memory = &source->memory};
    enum scree_status status = tin_kind_find(options, &kind, error);
    if (status == SCREE_OK && kind == TIN_OF_NOTHING)
        status = scree_fail(error, SCREE_E_ARGUMENT, "%s: is neither a mesh nor a point cloud",
                            options->input_count > 0 ? options->inputs[0] : "");
    if (status == SCREE_OK && !isfinite(options->nodata_height_m))
        status = scree_fail(error, SCREE_E_ARGUMENT, "the height outside of the data is not a number");
    if (status == SCREE_OK) status = tin_read(options, kind, &tin, &source->mended, &meaning, error);
    if (status != SCREE_OK) goto cleanup;
    double unit_m = 1, power = tin_step_find(LEAST_POWER, MOST_POWER, &tin.points->z, tin.point_count,
                                             sizeof *tin.points / sizeof tin.points->z);
    status = tin_georeference(options, options->inputs[0], &meaning, &tin, &source->summary, &unit_m, error);
    if (status != SCREE_OK) goto cleanup;
    source->quantum_m = power * fabs(unit_m);
    source->outside_m = has_outside                         ? options->nodata_height_m
                        : options->profile == PROFILE_LOCAL ? source->summary.height_min_m
                                                            : 0;
    status = place(options, block_points, &tin, source, error);
cleanup:
    cloud_meaning_free(&meaning);
    tin_release(&tin);
    return status;
}

void tin_source_release(struct tin_source *source) {
    tin_lattice_release(&source->placed);
    raster_summary_free(&source->summary);
    *source = (struct tin_source){0};
}
