#include "src/filter_arguments.h"

#include "lod/spline_filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_MEMORY_MB 100000000

struct context_options filter_context(const struct filter_options *options) {
    return options->context.spline_steps > 0 ? options->context : context_defaults();
}

/* CLASS=T0,...,T8 */
static bool take_thresholds(const char *text, struct context_options *context) {
    const char *equals = strchr(text, '=');
    int class = 0;
    if (equals == NULL) return false;
    const size_t length = (size_t)(equals - text);
    while (class < CONTEXT_REST && (strlen(context_class_name((enum context_class) class)) != length ||
                                    strncmp(context_class_name((enum context_class) class), text, length) != 0))
        class ++;
    if (class == CONTEXT_REST) return false;
    const char *at = equals + 1;
    for (int i = 0; i < HAAR_LEVELS; i++) {
        char *end;
        const double threshold_m = strtod(at, &end);
        if (end == at || !isfinite(threshold_m) || threshold_m < 0) return false;
        if (*end != (i + 1 < HAAR_LEVELS ? ',' : '\0')) return false;
        context->thresholds_m[class][i] = threshold_m;
        at = end + 1;
    }
    return true;
}

static bool take_metres(const char *text, double *metres) {
    return argument_number(text, metres) && *metres >= 0;
}

static bool take_variant(const char *text, enum haar_variant *variant) {
    int number;
    if (!argument_integer(text, 1, 2, &number)) return false;
    *variant = number == 1 ? HAAR_EACH : HAAR_TAIL;
    return true;
}

enum argument_result filter_argument_take(int argc, char **argv, int *at, struct filter_options *options,
                                          struct scree_error *error) {
    static const struct {
        const char *name, *wanted;
    } known[] = {
        {"landuse", "a vector source"},
        {"rules", "a file of rules"},
        {"spline-steps", "1 to 9"},
        {"delta", "metres from 0"},
        {"least", "metres from 0"},
        {"variant", "1 or 2"},
        {"thresholds", "CLASS=T0,...,T8 of a class"},
        {"filter-memory", "megabytes from 1"},
    };
    enum { COUNT = sizeof known / sizeof *known };
    int which = 0;
    while (which < COUNT && !argument_is(argv[*at], known[which].name)) which++;
    if (which == COUNT) return ARGUMENT_OTHER;
    const char *name = argv[*at], *value = *at + 1 < argc ? argv[*at + 1] : NULL;
    struct context_options *context = &options->context;
    bool is_fine = value != NULL;
    options->named = name;
    *context = filter_context(options);
    if (!is_fine) {
        scree_fail(error, SCREE_E_ARGUMENT, "%s wants %s", name, known[which].wanted);
        return ARGUMENT_WRONG;
    }
    switch (which) {
    case 0: options->landuse = value; break;
    case 1: options->rules = value; break;
    case 2: is_fine = argument_integer(value, 1, SPLINE_MAX_STEPS, &context->spline_steps); break;
    case 3: is_fine = take_metres(value, &context->delta_m); break;
    case 4: is_fine = take_metres(value, &context->least_m); break;
    case 5: is_fine = take_variant(value, &context->variant); break;
    case 6: is_fine = take_thresholds(value, context); break;
    default: is_fine = argument_integer(value, 1, MOST_MEMORY_MB, &options->memory_mb); break;
    }
    if (!is_fine) {
        scree_fail(error, SCREE_E_ARGUMENT, "%s wants %s, not %s", name, known[which].wanted, value);
        return ARGUMENT_WRONG;
    }
    *at += 2;
    return ARGUMENT_TAKEN;
}
