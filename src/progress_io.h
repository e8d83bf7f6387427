/* How far a long job is: a bar on a terminal, a line now and then elsewhere, on standard error. */
#ifndef SCREE_PROGRESS_IO_H
#define SCREE_PROGRESS_IO_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    const char *what;    /* "tiles" */
    double posts_a_unit; /* for the rate; 0: none is told */
    bool quiet, terminal;
    double started_s, shown_s;
    int shown_tenths;
};

void progress_start(struct progress *progress, const char *what, double posts_a_unit, bool quiet);

/* Tells that `done` of `in_all` units are done. Not thread-safe. */
void progress_tell(struct progress *progress, uint32_t done, uint32_t in_all);

/* Ends the bar's line. Returns the seconds since the start. */
double progress_end(struct progress *progress);

#endif
