/* The work of scree compare: every method on every full tile, and the report with its charts and pictures. */
#ifndef SCREE_COMPARE_JOB_IO_H
#define SCREE_COMPARE_JOB_IO_H

#include "src/build.h"
#include "src/compare_report.h"
#include "src/methods.h"

#define COMPARE_MOST_METHODS 32
#define COMPARE_MOST_COUNTS  16

struct compare_options {
    struct build_options build; /* rasters, lattice, ladder; its `out` is the folder of the report */
    int method_count;
    struct method_choice methods[COMPARE_MOST_METHODS];
    char names[COMPARE_MOST_METHODS][64];   /* what they are called in the report */
    int main_options[COMPARE_MOST_METHODS]; /* what is looked for where triangles are wanted: of each the index */
    int count_count; /* how many numbers of triangles are wanted; 0: as many as the options give */
    uint32_t counts[COMPARE_MOST_COUNTS];
    bool zooms_are_named;
    bool zooms[MAX_ZOOM + 1]; /* those named */
    uint64_t seed;
    uint32_t picture_px; /* of a view; 0: no pictures */
};

struct compare_job;

/* Compares and writes the folder; its files are replaced one by one, each as a whole, the report last. On success
 * `*job` holds the report, until compare_job_free. `progress` may be NULL. */
enum scree_status compare_job_run(const struct compare_options *options,
                                  void (*progress)(void *context, uint32_t tiles_done, uint32_t tiles_in_all),
                                  void *context, struct compare_job **job, struct scree_error *error);
const struct compare_report *compare_job_report(const struct compare_job *job);
void compare_job_free(struct compare_job *job);

#endif
