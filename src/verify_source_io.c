#include "src/verify_source_io.h"

#include "src/tin_source_io.h"

static enum scree_status open_raster(const struct raster_options *options, const struct verify_built *built,
                                     struct verify_source *source, struct scree_error *error) {
    const struct lattice *lattice = built->lattice;
    if (lattice->profile == PROFILE_GEODETIC && built->max_zoom < lattice->finest_zoom)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: is a raster here, but the terrain was built from triangles; use the same inputs and "
                          "options as for the build",
                          options->inputs[0]);
    enum scree_status status = raster_open(options, &source->raster, error);
    if (status != SCREE_OK) return status;
    const struct raster_summary *summary = raster_summary(source->raster);
    if (lattice->profile == PROFILE_LOCAL && (summary->columns != lattice->columns || summary->rows != lattice->rows))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: has %lld x %lld pixels, but the terrain was built from %lld x %lld; use the same "
                          "inputs and options as for the build",
                          options->inputs[0], (long long)summary->columns, (long long)summary->rows,
                          (long long)lattice->columns, (long long)lattice->rows);
    status = raster_place(source->raster, lattice, error);
    return status == SCREE_OK ? raster_reader_new(source->raster, &source->reader, error) : status;
}

enum scree_status verify_source_open(struct scree_memory *memory, struct raster_options *options,
                                     const struct verify_built *built, struct verify_source *source,
                                     struct scree_error *error) {
    options->profile = built->lattice->profile;
    enum scree_status status = tin_source_is_wanted(options, &source->is_tin, error);
    if (status != SCREE_OK) return status;
    if (!source->is_tin) return open_raster(options, built, source, error);
    status = tin_points_open(options, built->lattice, built->bounds, &source->tin, error);
    return status == SCREE_OK ? residual_points_begin(memory, source->tin.points, source->tin.count, source->tin.x,
                                                      source->tin.y, &source->points, error)
                              : status;
}

void verify_source_close(struct verify_source *source) {
    raster_reader_free(source->reader);
    raster_free(source->raster);
    residual_points_release(&source->points);
    tin_points_release(&source->tin);
}

int verify_source_finest(const struct verify_source *source, const struct verify_built *built) {
    return source->is_tin ? built->max_zoom : built->lattice->finest_zoom;
}
