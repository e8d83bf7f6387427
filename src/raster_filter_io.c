/* Inputs become one GeoTIFF in memory, filtered, and are read like any raster from there on. */
#include "src/filter_job_io.h"
#include "src/raster_parts_io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How pixels are read; where the result is to lie, and what is beyond, comes later. The file in memory is the one that
 * `scree filter` writes with these, but for the compression and the CRS, which is handed on as it is. */
static struct raster_options reading_options(const struct raster_options *options) {
    struct raster_options reading = *options;
    reading.has_extent = false;
    reading.nodata_height_m = FILTER_NO_HEIGHT_M;
    return reading;
}

static void forget_pixels(struct raster *raster) {
    free(raster->source_srs);
    raster->source_srs = NULL;
    raster->options.has_nodata = false;
    raster->options.band = 0;
}

static enum scree_status filter(struct raster *raster, const struct raster_options *options,
                                struct scree_error *error) {
    const struct raster_options reading = reading_options(options);
    struct filter_job job = {0};
    struct text text = {0};
    size_t length_bytes;
    char path[64];
    enum scree_status status = filter_job_run(&reading, &job, error);
    if (status != SCREE_OK) goto cleanup;
    filter_job_describe(&job, &options->filter, &text);
    snprintf(path, sizeof path, "/vsimem/scree-filter-%p", (void *)raster);
    raster->filter_path = strdup(path);
    raster->summary.filtered = text_take(&text, &length_bytes);
    raster->inputs[0].crs_wkt = strdup(job.raster.crs_wkt);
    if (raster->filter_path == NULL || raster->summary.filtered == NULL || raster->inputs[0].crs_wkt == NULL)
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for words");
    else
        status = filter_raster_keep(&job.raster, job.filtered_m, path, options->inputs[0], error);
cleanup:
    filter_job_free(&job);
    return status;
}

enum scree_status raster_filter_open(struct raster *raster, const struct raster_options *options,
                                     struct scree_error *error) {
    enum scree_status status = filter(raster, options, error);
    if (status != SCREE_OK) return status;
    forget_pixels(raster);
    raster->input_count = 1;
    return raster_input_open(raster, options->inputs[0], raster->filter_path, &raster->inputs[0], error);
}
