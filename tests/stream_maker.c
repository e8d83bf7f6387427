#include "tests/stream_maker.h"

#include "tests/fractal.h"

#include <math.h>
#include <string.h>

enum { RUNGS_AN_OCTAVE = 4, MAX_STEPS = 1024 };

static enum scree_status start_tile(const struct stream_wish *wish, struct made_recording *made,
                                    struct scree_error *error) {
    double steps_m[MAX_STEPS + 1];
    if (wish->columns > MAX_STEPS || wish->rows > MAX_STEPS)
        return scree_fail(error, SCREE_E_ARGUMENT, "a made tile has at most %d steps a side", MAX_STEPS);
    for (int32_t i = 0; i <= wish->rows; i++) steps_m[i] = wish->spacing_m;
    const struct tile_geometry geometry = {.columns = wish->columns,
                                           .rows = wish->rows,
                                           .cell_span = 1,
                                           .height_unit_m = ldexp(1, wish->height_exponent),
                                           .east_m = wish->spacing_m,
                                           .north_m = wish->spacing_m};
    const struct tile_posts posts = {wish->heights_m, wish->stride, steps_m, steps_m};
    enum scree_status status = tile_from_posts(made->memory, &geometry, &posts, &made->tile, error);
    return status == SCREE_OK ? tile_advance(&made->tile, wish->finest_m, error) : status;
}

static enum scree_status mark(struct made_recording *made, int32_t rung, struct scree_error *error) {
    const struct recording_rung at = {
        .rung = rung, .mmqe_m2 = (float)tile_mmqe_m2(&made->tile), .max_error_m = (float)tile_max_error_m(&made->tile)};
    return recorder_mark(&made->recorder, &at, error);
}

/* Down the ladder, whose finest rung is number 0. */
static enum scree_status descend(const struct stream_wish *wish, struct made_recording *made,
                                 struct scree_error *error) {
    enum scree_status status = mark(made, 0, error);
    for (uint32_t i = 1; status == SCREE_OK && i < SCREE_MAX_RUNGS; i++) {
        if (wish->rungs != 0 ? i >= wish->rungs : made->tile.mesh.live_vertices <= (int32_t)wish->base_vertices) break;
        status = tile_advance(&made->tile, wish->finest_m * exp2((double)i / RUNGS_AN_OCTAVE), error);
        if (status == SCREE_OK) status = mark(made, -(int32_t)i, error);
    }
    return status;
}

static struct scree_stream_header place_of(const struct stream_wish *wish) {
    struct scree_stream_header place = {.profile = wish->profile,
                                        .zoom = 14,
                                        .tile_x = 17000,
                                        .tile_y = 12300,
                                        .columns = wish->columns,
                                        .rows = wish->rows,
                                        .height_exponent = wish->height_exponent};
    if (wish->profile == SCREE_GEODETIC) {
        place.spacing_x = place.spacing_y = ldexp(180.0 / 256, -place.zoom);
        place.west = -180 + place.tile_x * 256 * place.spacing_x;
        place.south = -90 + place.tile_y * 256 * place.spacing_y;
    } else {
        place.zoom = place.tile_x = place.tile_y = 0;
        place.west = 377000;
        place.south = 3790000;
        place.spacing_x = place.spacing_y = place.metres_x = place.metres_y = wish->spacing_m;
    }
    return place;
}

enum scree_status stream_make_recording(struct scree_memory *memory, const struct stream_wish *wish,
                                        struct made_recording *made, struct scree_error *error) {
    struct stream_wish spaced = *wish;
    if (spaced.spacing_m == 0) spaced.spacing_m = 30;
    memset(made, 0, sizeof *made);
    made->memory = memory;
    made->place = place_of(&spaced);
    enum scree_status status = start_tile(&spaced, made, error);
    if (status == SCREE_OK) status = mesh_export_new(memory, &made->tile.mesh, &made->finest, error);
    if (status == SCREE_OK) status = recorder_start(memory, &made->tile.mesh, &made->recorder, error);
    if (status != SCREE_OK) return status;
    made->tile.simplifier.options.observer = &made->recorder.observer;
    status = descend(&spaced, made, error);
    return status == SCREE_OK ? recorder_finish(&made->recorder, error) : status;
}

void stream_release_recording(struct made_recording *made) {
    recorder_release(&made->recorder);
    scree_release(made->memory, made->finest.corners);
    scree_release(made->memory, made->finest.vertices);
    tile_release(&made->tile);
}

enum scree_status stream_make(struct scree_memory *memory, const struct stream_wish *wish,
                              const struct encode_options *options, unsigned char **bytes, size_t *size_bytes,
                              struct scree_error *error) {
    struct stream_wish whole = *wish;
    const struct fractal fractal = {.seed = wish->seed, .whole_metres = true};
    const struct encode_options plain = {0};
    float *heights_m = NULL;
    enum scree_status status = SCREE_E_MEMORY;
    struct made_recording *made = scree_allocate(memory, 1, sizeof *made, "a recording", error);
    if (made == NULL) return status;
    if (wish->heights_m == NULL) {
        int32_t columns = wish->columns + 3, rows = wish->rows + 3;
        heights_m = scree_allocate(memory, (size_t)columns * (size_t)rows, sizeof *heights_m, "posts", error);
        if (heights_m == NULL) goto cleanup;
        fractal_window(&fractal, 4900, -4900, columns, rows, heights_m, columns);
        whole.heights_m = heights_m + columns + 1;
        whole.stride = columns;
    }
    status = stream_make_recording(memory, &whole, made, error);
    if (status == SCREE_OK)
        status = stream_encode_new(memory, &made->place, &made->recorder.recording, options != NULL ? options : &plain,
                                   bytes, size_bytes, error);
    stream_release_recording(made);
cleanup:
    scree_release(memory, heights_m);
    scree_release(memory, made);
    return status;
}
