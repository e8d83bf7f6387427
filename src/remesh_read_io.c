#include "src/remesh_read_io.h"

#include "src/remesh.h"

#define ROWS_AT_ONCE       256
#define FARTHEST_NORTH_DEG 91 /* outer pixels of a globe may reach a little beyond the poles */

static enum scree_status lay_out(const struct raster_options *options, const struct raster_summary *summary,
                                 struct remesh_raster *raster, struct scree_error *error) {
    if (summary->columns > CURVATURE_MAX_POSTS || summary->rows > CURVATURE_MAX_POSTS)
        return scree_fail(error, SCREE_E_LIMIT,
                          "%s: %lld x %lld posts are more than the %d a side that fit a quadtree; crop with --te",
                          options->inputs[0], (long long)summary->columns, (long long)summary->rows,
                          CURVATURE_MAX_POSTS);
    enum scree_status status =
        lattice_local(summary->columns, summary->rows, summary->bounds[0], summary->bounds[1], summary->spacing_x,
                      summary->spacing_y, summary->metres_per_unit, &raster->local, error);
    if (status != SCREE_OK) return status;
    const struct lattice *lattice = &raster->lattice;
    raster->lattice = remesh_lattice(&raster->local, summary->metres_per_unit);
    const double south = lattice->south, north = lattice_y(lattice, (double)lattice->rows - 1);
    if (lattice->profile == PROFILE_GEODETIC && (south < -FARTHEST_NORTH_DEG || north > FARTHEST_NORTH_DEG))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: latitudes of %g to %g are not on Earth; name its CRS with --s_srs", options->inputs[0],
                          south, north);
    return SCREE_OK;
}

static enum scree_status read_heights(struct scree_memory *memory, const struct raster *from,
                                      struct remesh_raster *raster, struct scree_error *error) {
    const int32_t columns = (int32_t)raster->local.columns, rows = (int32_t)raster->local.rows;
    struct raster_reader *reader = NULL;
    enum scree_status status = raster_reader_new(from, &reader, error);
    if (status != SCREE_OK) return status;
    raster->heights_m = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *raster->heights_m,
                                       "the raster's heights", error);
    if (raster->heights_m == NULL) status = SCREE_E_MEMORY;
    for (int32_t y = 0; y < rows && status == SCREE_OK; y += ROWS_AT_ONCE) {
        int32_t here = rows - y < ROWS_AT_ONCE ? rows - y : ROWS_AT_ONCE;
        status = raster_read(reader, 0, y, columns, here, raster->heights_m + (int64_t)y * columns, columns, error);
    }
    raster_reader_free(reader);
    return status;
}

enum scree_status remesh_read(struct scree_memory *memory, const struct raster_options *options,
                              struct remesh_raster *raster, struct scree_error *error) {
    struct raster *from = NULL;
    *raster = (struct remesh_raster){.heights_m = NULL};
    enum scree_status status = raster_open(options, &from, error);
    if (status == SCREE_OK) status = lay_out(options, raster_summary(from), raster, error);
    if (status == SCREE_OK) status = raster_place(from, &raster->local, error);
    if (status == SCREE_OK) status = read_heights(memory, from, raster, error);
    if (status == SCREE_OK) raster->posts = remesh_posts(&raster->lattice, raster->heights_m);
    raster_free(from);
    return status;
}

void remesh_raster_free(struct scree_memory *memory, struct remesh_raster *raster) {
    scree_release(memory, raster->heights_m);
    raster->heights_m = NULL;
}
