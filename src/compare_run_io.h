/* Running a method against the clock, with the options that it was given or with those that give a number of triangles.
 */
#ifndef SCREE_COMPARE_RUN_IO_H
#define SCREE_COMPARE_RUN_IO_H

#include "src/methods.h"

struct compare_task {
    const struct method_choice *choice;
    int zoom;
    double tolerance_m;        /* of the zoom */
    uint32_t wanted_triangles; /* 0: as many as the options give */
    int main_option;           /* for wanted triangles: which option is looked for */
};

struct compare_outcome {
    struct method_mesh mesh; /* to be released */
    double cpu_s;            /* of this thread, in the run that made the mesh */
    double values[METHOD_MAX_OPTIONS];
};

/* The options that a task begins with, as method_values_at; an option that is looked for and has no value of its own
 * begins at the number of triangles. */
enum scree_status compare_values_at(const struct compare_task *task, double values[METHOD_MAX_OPTIONS],
                                    struct scree_error *error);

/* Runs a method on a tile. For a number of triangles the main option is looked for between its bounds until the number
 * is met to 1 %; where no value does so, the nearest found counts. */
enum scree_status compare_run(struct scree_memory *memory, const struct compare_task *task,
                              const struct method_tile *tile, struct compare_outcome *outcome,
                              struct scree_error *error);

#endif
