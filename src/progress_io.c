#include "src/progress_io.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#define BAR_WIDTH   30
#define BAR_EVERY_S 0.1

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void progress_start(struct progress *progress, const char *what, double posts_a_unit, bool quiet) {
    *progress = (struct progress){.what = what,
                                  .posts_a_unit = posts_a_unit,
                                  .quiet = quiet,
                                  .terminal = isatty(STDERR_FILENO) != 0,
                                  .started_s = now_s()};
}

static void show_bar(const struct progress *progress, double share, double elapsed_s, uint32_t done) {
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++) bar[i] = i < (int)(share * BAR_WIDTH) ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    double left_s = share > 0 ? elapsed_s * (1 / share - 1) : 0;
    double rate = elapsed_s > 0 ? done * progress->posts_a_unit / elapsed_s : 0;
    fprintf(stderr, "\r[%s] %3d %%  %.2f million posts/s  %d:%02d left ", bar, (int)(100 * share), rate * 1e-6,
            (int)left_s / 60, (int)left_s % 60);
    fflush(stderr);
}

void progress_tell(struct progress *progress, uint32_t done, uint32_t in_all) {
    if (progress->quiet || in_all == 0) return;
    double now = now_s(), share = (double)done / in_all;
    if (progress->terminal) {
        if (now - progress->shown_s < BAR_EVERY_S && done < in_all) return;
        progress->shown_s = now;
        show_bar(progress, share, now - progress->started_s, done);
    } else if ((int)(10 * share) > progress->shown_tenths) {
        progress->shown_tenths = (int)(10 * share);
        fprintf(stderr, "%3d %%: %u of %u %s, %.1f s\n", 10 * progress->shown_tenths, done, in_all, progress->what,
                now - progress->started_s);
    }
}

double progress_end(struct progress *progress) {
    if (!progress->quiet && progress->terminal && progress->shown_s > 0) fputc('\n', stderr);
    return now_s() - progress->started_s;
}
