#include "viewer/stopwatch_io.h"

#include <ctime>

static double now_ms() {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

Stopwatch::Stopwatch() : last_ms(now_ms()) {}

double Stopwatch::lap_ms() {
    double before_ms = last_ms;
    last_ms = now_ms();
    return last_ms - before_ms;
}
