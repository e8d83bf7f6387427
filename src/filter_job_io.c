/* One raster filtered: see the header. */
#include "src/filter_job_io.h"

#include "src/filter_arguments.h"

#include <math.h>

#define DEFAULT_MEMORY_MB 4000
#define BYTES_A_MB        1000000

static enum scree_status read_all(const struct raster_options *options, struct filter_job *job,
                                  struct scree_error *error) {
    const struct filter_options *wanted = &options->filter;
    const struct filter_raster *raster = &job->raster;
    struct raster_options plain = *options;
    plain.profile = PROFILE_LOCAL;
    plain.filter = (struct filter_options){0};
    enum scree_status status = filter_raster_read(&job->memory, &plain, &job->raster, error);
    if (status == SCREE_OK && wanted->landuse != NULL)
        status = landuse_read(&job->memory, wanted->landuse, wanted->rules, raster, &job->landuse, error);
    if (status != SCREE_OK) return status;
    job->posts = (struct context_posts){.heights_m = raster->heights_m,
                                        .columns = raster->columns,
                                        .rows = raster->rows,
                                        .uses = job->landuse.uses,
                                        .waters = job->landuse.waters,
                                        .water_count = job->landuse.water_count};
    job->filtered_m = scree_allocate(&job->memory, (size_t)raster->columns * (size_t)raster->rows,
                                     sizeof *job->filtered_m, "the filtered heights", error);
    return job->filtered_m != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

enum scree_status filter_job_run(const struct raster_options *options, struct filter_job *job,
                                 struct scree_error *error) {
    const struct context_options context = filter_context(&options->filter);
    const int megabytes = options->filter.memory_mb > 0 ? options->filter.memory_mb : DEFAULT_MEMORY_MB;
    *job = (struct filter_job){.memory = {.limit_bytes = (size_t)megabytes * BYTES_A_MB}};
    enum scree_status status = read_all(options, job, error);
    if (status == SCREE_OK)
        status = context_filter(&job->memory, &job->posts, &context, job->filtered_m, &job->counts, error);
    return status;
}

void filter_job_free(struct filter_job *job) {
    scree_release(&job->memory, job->filtered_m);
    job->filtered_m = NULL;
    landuse_free(&job->memory, &job->landuse);
    filter_raster_free(&job->memory, &job->raster);
}

/* ---- words ---- */

static void add_landuse(const char *path, const struct landuse_posts *landuse, struct text *text) {
    text_add(text, "%s: ", path);
    for (int use = 0; use < LANDUSE_COUNT; use++)
        text_add(text, "%s%u %s", use > 0 ? ", " : "", (unsigned)landuse->features[use],
                 landuse_name((enum landuse)use));
    text_add(text, "; %u roads meet a bridge\n", (unsigned)landuse->ramps);
    if (landuse->outside > 0) text_add(text, "%s: %u lie outside of the raster\n", path, (unsigned)landuse->outside);
    if (landuse->repaired > 0)
        text_add(text, "%s: %u are invalid and were repaired\n", path, (unsigned)landuse->repaired);
    if (landuse->empty > 0) text_add(text, "%s: %u have no usable geometry\n", path, (unsigned)landuse->empty);
}

static void add_classes(const struct context_counts *counts, size_t count, struct text *text) {
    text_add(text, "of the posts");
    for (int class = 0; class < CONTEXT_REST; class ++)
        text_add(text, "%s %.3g %% are %s", class > 0 ? "," : "", 100 * (double)counts->posts[class] / (double)count,
                 context_class_name((enum context_class) class));
    text_add(text, "; %.3g %% keep detail, %.3g %% are levelled\n", 100 * (double)counts->detailed / (double)count,
             100 * (double)counts->levelled / (double)count);
}

void filter_job_describe(const struct filter_job *job, const struct filter_options *options, struct text *text) {
    const size_t count = (size_t)job->posts.columns * (size_t)job->posts.rows;
    double max_m = 0, sum_m2 = 0;
    for (size_t post = 0; post < count; post++) {
        const double away_m = fabs((double)job->filtered_m[post] - job->posts.heights_m[post]);
        max_m = fmax(max_m, away_m);
        sum_m2 += away_m * away_m;
    }
    text_add(text, "%d x %d posts; heights changed by RMS %.4g m, at most %.4g m\n", (int)job->posts.columns,
             (int)job->posts.rows, sqrt(sum_m2 / (double)count), max_m);
    if (options->landuse != NULL) add_landuse(options->landuse, &job->landuse, text);
    add_classes(&job->counts, count, text);
}
