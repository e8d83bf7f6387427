/* Running methods for scree compare: see the header. */
#include "src/compare_run_io.h"

#include <math.h>
#include <string.h>
#include <time.h>

#define CLOSE_ENOUGH 0.01
#define MOST_RUNS    40
#define FIRST_FACTOR 2.0
#define LEAST_VALUE  1e-3 /* where a search that begins at 0 goes first */

static double cpu_clock_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum scree_status run_once(struct scree_memory *memory, const struct compare_task *task,
                                  const struct method_tile *tile, struct compare_outcome *outcome,
                                  struct scree_error *error) {
    const struct method *method = task->choice->method;
    const char *wrong = method->contradiction != NULL ? method->contradiction(outcome->values) : NULL;
    if (wrong != NULL)
        return scree_fail(error, SCREE_E_ARGUMENT, "method %s at zoom %d: %s", method->name, task->zoom, wrong);
    double started_s = cpu_clock_s();
    enum scree_status status = method->run(memory, tile, outcome->values, &outcome->mesh, error);
    outcome->cpu_s = cpu_clock_s() - started_s;
    return status;
}

/* ---- looking for a number of triangles ---- */

/* A value of the option, and the logarithm of its triangles over those wanted. */
struct trial {
    double value, off;
};

struct search {
    struct scree_memory *memory;
    const struct compare_task *task;
    const struct method_tile *tile;
    const struct method_option *option;
    struct trial low, high; /* the ends of what was looked at, by value */
    bool is_bracket;        /* the wanted number lies between them */
    double factor;          /* of the next step outwards */
    int runs;
    struct compare_outcome *best;
    double best_off;
};

static double bounded(const struct method_option *option, double value) {
    if (option->is_whole) value = floor(value + 0.5);
    return fmin(fmax(value, option->least), option->most);
}

static enum scree_status try_value(struct search *search, double value, struct trial *trial,
                                   struct scree_error *error) {
    struct compare_outcome outcome = *search->best;
    outcome.mesh = (struct method_mesh){0};
    outcome.values[search->task->main_option] = value;
    enum scree_status status = run_once(search->memory, search->task, search->tile, &outcome, error);
    if (status != SCREE_OK) return status;
    search->runs++;
    *trial = (struct trial){value, log(fmax(outcome.mesh.triangle_count, 1) / search->task->wanted_triangles)};
    bool is_better = fabs(trial->off) < search->best_off;
    method_mesh_release(search->memory, is_better ? &search->best->mesh : &outcome.mesh);
    if (!is_better) return SCREE_OK;
    *search->best = outcome;
    search->best_off = fabs(trial->off);
    return SCREE_OK;
}

/* The next value beyond an end; the end itself at the option's bound. */
static double beyond(struct search *search, bool upwards) {
    double from = upwards ? search->high.value : search->low.value;
    double further = from == 0               ? (upwards ? LEAST_VALUE : -LEAST_VALUE)
                     : upwards == (from > 0) ? from * search->factor
                                             : from / search->factor;
    if (search->option->is_whole && fabs(further - from) < 1) further = upwards ? from + 1 : from - 1;
    return bounded(search->option, further);
}

/* Steps outwards, ever longer ones, towards the wanted number; first to both sides, until they differ. */
static enum scree_status widen(struct search *search, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (bool upwards = true; search->runs < MOST_RUNS && search->best_off > CLOSE_ENOUGH && !search->is_bracket;) {
        bool is_level = search->low.off == search->high.off;
        if (!is_level) upwards = (search->high.off > search->low.off) == (search->high.off < 0);
        double next = beyond(search, upwards), other = is_level ? beyond(search, !upwards) : next;
        if (next == (upwards ? search->high.value : search->low.value)) {
            if (next == other || other == (upwards ? search->low.value : search->high.value)) return SCREE_OK;
            upwards = !upwards; /* this bound is reached; the other side is open */
            next = other;
        }
        struct trial trial, *near = upwards ? &search->high : &search->low,
                            *far = upwards ? &search->low : &search->high;
        status = try_value(search, next, &trial, error);
        if (status != SCREE_OK) return status;
        if (!is_level) *far = *near;
        *near = trial;
        search->is_bracket = (search->low.off < 0) != (search->high.off < 0);
        search->factor *= search->factor < 100 ? 1.5 : 1;
        if (is_level) upwards = !upwards;
    }
    return SCREE_OK;
}

/* Every other time the middle, else where a straight line between the ends meets the wanted number. */
static double between(const struct search *search) {
    double low = search->low.value, high = search->high.value;
    double share = search->runs % 2 == 0 ? 0.5 : search->low.off / (search->low.off - search->high.off);
    share = fmin(fmax(share, 0.05), 0.95);
    double value = low > 0 ? low * pow(high / low, share) : low + share * (high - low);
    return bounded(search->option, value);
}

static enum scree_status narrow(struct search *search, struct scree_error *error) {
    while (search->runs < MOST_RUNS && search->best_off > CLOSE_ENOUGH) {
        struct trial trial;
        double value = between(search);
        if (value == search->low.value && search->option->is_whole) value++;
        if (value == search->high.value && search->option->is_whole) value--;
        if (value <= search->low.value || value >= search->high.value) return SCREE_OK; /* nothing lies between */
        enum scree_status status = try_value(search, value, &trial, error);
        if (status != SCREE_OK) return status;
        if ((trial.off < 0) == (search->low.off < 0))
            search->low = trial;
        else
            search->high = trial;
    }
    return SCREE_OK;
}

static enum scree_status find_triangles(struct scree_memory *memory, const struct compare_task *task,
                                        const struct method_tile *tile, struct compare_outcome *outcome,
                                        struct scree_error *error) {
    const struct method_option *option = &task->choice->method->options[task->main_option];
    struct search search = {.memory = memory,
                            .task = task,
                            .tile = tile,
                            .option = option,
                            .factor = FIRST_FACTOR,
                            .best = outcome,
                            .best_off = HUGE_VAL};
    double start = outcome->values[task->main_option];
    enum scree_status status = try_value(&search, bounded(option, start), &search.low, error);
    search.high = search.low;
    if (status == SCREE_OK) status = widen(&search, error);
    if (status == SCREE_OK && search.is_bracket) status = narrow(&search, error);
    return status;
}

enum scree_status compare_values_at(const struct compare_task *task, double values[METHOD_MAX_OPTIONS],
                                    struct scree_error *error) {
    struct method_choice choice = *task->choice;
    if (task->wanted_triangles != 0 && choice.method->option_count > 0) {
        const struct method_option *option = &choice.method->options[task->main_option];
        struct method_setting *setting = &choice.settings[task->main_option];
        if (setting->count == 0 && isnan(option->standard) && option->tolerance_part == 0) {
            *setting = (struct method_setting){.count = 1, .growth = 1};
            setting->list[0].value = bounded(option, task->wanted_triangles);
        }
    }
    return method_values_at(&choice, task->zoom, task->tolerance_m, values, error);
}

enum scree_status compare_run(struct scree_memory *memory, const struct compare_task *task,
                              const struct method_tile *tile, struct compare_outcome *outcome,
                              struct scree_error *error) {
    memset(outcome, 0, sizeof *outcome);
    enum scree_status status = compare_values_at(task, outcome->values, error);
    if (status == SCREE_OK) status = method_tile_check(tile, error);
    if (status != SCREE_OK) return status;
    bool is_searched = task->wanted_triangles != 0 && task->choice->method->option_count > 0;
    status =
        is_searched ? find_triangles(memory, task, tile, outcome, error) : run_once(memory, task, tile, outcome, error);
    if (status != SCREE_OK) method_mesh_release(memory, &outcome->mesh);
    return status;
}
