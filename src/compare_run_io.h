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
};

struct compare_outcome {
    struct method_mesh mesh; /* to be released */
    double cpu_s;            /* of this thread, in the run that made the mesh */
    double values[METHOD_MAX_OPTIONS];
};

/* Runs a method on a tile. For a number of triangles its first option, which decides how many there are, is looked for
 * between its bounds until the number is met to 1 %; where no value does so, the nearest found counts. */
enum scree_status compare_run(struct scree_memory *memory, const struct compare_task *task,
                              const struct method_tile *tile, struct compare_outcome *outcome,
                              struct scree_error *error);

#endif
