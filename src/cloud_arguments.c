#include "src/cloud_arguments.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static bool take_classes(const char *text, struct cloud_options *options) {
    options->has_classes = true;
    for (;;) {
        char *end;
        if (*text < '0' || *text > '9') return false;
        long number = strtol(text, &end, 10);
        if (number > 255) return false;
        options->classes[number] = true;
        if (*end == '\0') return true;
        if (*end != ',') return false;
        text = end + 1;
    }
}

static bool take_returns(const char *text, enum cloud_returns *returns) {
    static const char *const names[] = {"all", "first", "last", "only"}; /* as in enum cloud_returns */
    for (int i = 0; i < 4; i++)
        if (strcmp(text, names[i]) == 0) {
            *returns = (enum cloud_returns)i;
            return true;
        }
    return false;
}

static bool take_length(const char *text, double *length) {
    return argument_number(text, length) && *length > 0;
}

enum argument_result cloud_argument_take(int argc, char **argv, int *at, struct cloud_options *options,
                                         struct scree_error *error) {
    static const struct {
        const char *name, *wanted;
    } known[] = {
        {"class", "classes from 0 to 255 with commas between them"},
        {"returns", "all, first, last or only"},
        {"thin", "a length above 0"},
        {"outliers", "a height above 0"},
        {"grid", "a length above 0"},
        {"max-edge", "a length above 0"},
        {"memory", "megabytes from 1"},
    };
    enum { COUNT = sizeof known / sizeof *known };
    int which = 0;
    while (which < COUNT && !argument_is(argv[*at], known[which].name)) which++;
    if (which == COUNT) return ARGUMENT_OTHER;
    options->named = argv[*at];
    const char *value = *at + 1 < argc ? argv[*at + 1] : "";
    bool is_fine = false;
    switch (which) {
    case 0: is_fine = take_classes(value, options); break;
    case 1: is_fine = take_returns(value, &options->returns); break;
    case 2: is_fine = take_length(value, &options->thin); break;
    case 3: is_fine = take_length(value, &options->outliers); break;
    case 4: is_fine = take_length(value, &options->grid); break;
    case 5: is_fine = take_length(value, &options->longest_edge); break;
    default: is_fine = argument_integer(value, 1, INT_MAX, &options->memory_mb); break;
    }
    if (!is_fine) {
        scree_fail(error, SCREE_E_ARGUMENT, "%s wants %s", options->named, known[which].wanted);
        return ARGUMENT_WRONG;
    }
    *at += 2;
    return ARGUMENT_TAKEN;
}
