/* The tables of triangles: see the header. */
#include "src/filter_report.h"

#include "lod/square_subdivision.h"

enum { FINE, MIDDLE, COARSE, EPSILONS, DELTAS = 4 };

static const double epsilon_m[EPSILONS] = {0.05, 0.1, 0.2};
static const double delta_share[DELTAS] = {0.25, 0.5, 1, 1.5};

struct report {
    struct scree_memory *memory;
    const struct context_posts *posts;
    float *room_m;
    struct text *text;
};

/* Triangles at each epsilon after filtering so. */
static enum scree_status count(const struct report *report, const struct context_options *options,
                               uint64_t triangles[EPSILONS], struct scree_error *error) {
    const struct context_posts *posts = report->posts;
    struct context_counts counts;
    enum scree_status status = context_filter(report->memory, posts, options, report->room_m, &counts, error);
    for (int e = 0; e < EPSILONS && status == SCREE_OK; e++)
        triangles[e] = subdivision_triangles(report->room_m, posts->columns, posts->rows, epsilon_m[e]);
    return status;
}

static unsigned long long printable(uint64_t number) {
    return (unsigned long long)number;
}

static enum scree_status add_gains(const struct report *report, struct context_options options,
                                   struct scree_error *error) {
    uint64_t unfiltered[EPSILONS], exact[EPSILONS], each[EPSILONS], tail[EPSILONS];
    const struct context_posts *posts = report->posts;
    for (int e = 0; e < EPSILONS; e++)
        unfiltered[e] = subdivision_triangles(posts->heights_m, posts->columns, posts->rows, epsilon_m[e]);
    options.detail = CONTEXT_UNFILTERED;
    enum scree_status status = count(report, &options, exact, error);
    options.detail = CONTEXT_FILTERED;
    options.variant = HAAR_EACH;
    if (status == SCREE_OK) status = count(report, &options, each, error);
    options.variant = HAAR_TAIL;
    if (status == SCREE_OK) status = count(report, &options, tail, error);
    if (status != SCREE_OK) return status;
    text_add(report->text, "triangles, delta %.4g m, %d spline steps\n", options.delta_m, (int)options.spline_steps);
    text_add(report->text, "epsilon m   unfiltered  detail unfiltered   variant 1   variant 2  unfiltered/variant 2\n");
    for (int e = EPSILONS - 1; e >= 0; e--)
        text_add(report->text, "%9.4g %12llu %18llu %11llu %11llu %21.2f\n", epsilon_m[e], printable(unfiltered[e]),
                 printable(exact[e]), printable(each[e]), printable(tail[e]), (double)unfiltered[e] / (double)tail[e]);
    return SCREE_OK;
}

static int least_of(const uint64_t *numbers) {
    int least = 0;
    for (int i = 1; i < REPORT_STEPS; i++)
        if (numbers[i] < numbers[least]) least = i;
    return least;
}

static enum scree_status add_steps(const struct report *report, struct context_options options,
                                   struct scree_error *error) {
    uint64_t spline[REPORT_STEPS][EPSILONS], detail[REPORT_STEPS][EPSILONS], fine[REPORT_STEPS], coarse[REPORT_STEPS];
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < REPORT_STEPS && status == SCREE_OK; i++) {
        options.spline_steps = i + 1;
        options.detail = CONTEXT_NONE;
        status = count(report, &options, spline[i], error);
        options.detail = CONTEXT_FILTERED;
        if (status == SCREE_OK) status = count(report, &options, detail[i], error);
        fine[i] = detail[i][FINE];
        coarse[i] = detail[i][COARSE];
    }
    if (status != SCREE_OK) return status;
    text_add(report->text, "\ntriangles, delta %.4g m, variant %d; * the fewest\n", options.delta_m,
             options.variant == HAAR_TAIL ? 2 : 1);
    text_add(report->text, "spline steps  %.4g m: spline      filtered   %.4g m: spline      filtered\n",
             epsilon_m[FINE], epsilon_m[COARSE]);
    for (int i = 0; i < REPORT_STEPS; i++)
        text_add(report->text, "%12d %15llu %13llu%c %15llu %13llu%c\n", i + 1, printable(spline[i][FINE]),
                 printable(fine[i]), i == least_of(fine) ? '*' : ' ', printable(spline[i][COARSE]),
                 printable(coarse[i]), i == least_of(coarse) ? '*' : ' ');
    return SCREE_OK;
}

static enum scree_status add_deltas(const struct report *report, struct context_options options,
                                    struct scree_error *error) {
    const double delta_m = options.delta_m;
    text_add(report->text, "\ntriangles, epsilon %.4g m, variant %d; * the fewest\ndelta m | spline steps",
             epsilon_m[COARSE], options.variant == HAAR_TAIL ? 2 : 1);
    for (int i = 0; i < REPORT_STEPS; i++) text_add(report->text, i == 0 ? "%3d " : "%11d ", i + 1);
    text_add(report->text, "\n");
    for (int d = 0; d < DELTAS; d++) {
        uint64_t coarse[REPORT_STEPS];
        options.delta_m = delta_m * delta_share[d];
        for (int i = 0; i < REPORT_STEPS; i++) {
            uint64_t triangles[EPSILONS];
            options.spline_steps = i + 1;
            enum scree_status status = count(report, &options, triangles, error);
            if (status != SCREE_OK) return status;
            coarse[i] = triangles[COARSE];
        }
        text_add(report->text, "%12.4g", options.delta_m);
        for (int i = 0; i < REPORT_STEPS; i++)
            text_add(report->text, " %10llu%c", printable(coarse[i]), i == least_of(coarse) ? '*' : ' ');
        text_add(report->text, "\n");
    }
    return SCREE_OK;
}

enum scree_status filter_report(struct scree_memory *memory, const struct context_posts *posts,
                                const struct context_options *options, float *room_m, struct text *text,
                                struct scree_error *error) {
    const struct report report = {memory, posts, room_m, text};
    enum scree_status status = add_gains(&report, *options, error);
    if (status == SCREE_OK) status = add_steps(&report, *options, error);
    if (status == SCREE_OK) status = add_deltas(&report, *options, error);
    return status;
}
