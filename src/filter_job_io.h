/* One raster filtered: read, land use looked up, the filter run. What `scree filter` does, and --filter before other
 * work. */
#ifndef SCREE_FILTER_JOB_IO_H
#define SCREE_FILTER_JOB_IO_H

#include "src/filter_raster_io.h"
#include "src/landuse_io.h"
#include "src/text.h"

struct filter_job {
    struct scree_memory memory;
    struct filter_raster raster;
    struct landuse_posts landuse;
    struct context_posts posts; /* of both */
    struct context_counts counts;
    float *filtered_m; /* as many as the raster's heights */
};

/* Reads the inputs of `options` pixel by pixel, whatever its profile, and filters them as options->filter says. Memory
 * is limited as that says. `job` is zeroed first, and is to be freed in any case. */
enum scree_status filter_job_run(const struct raster_options *options, struct filter_job *job,
                                 struct scree_error *error);
void filter_job_free(struct filter_job *job);

/* Adds lines on what has changed, what land use there is, and how many posts are of which class. */
void filter_job_describe(const struct filter_job *job, const struct filter_options *options, struct text *text);

#endif
