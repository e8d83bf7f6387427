/* The list of methods: options of each, in the order in which `run` finds their values, and a line in the table. */
#include "src/methods.h"

#include <math.h>
#include <stddef.h>

const struct method method_table[] = {
    /* name, what it is, its options, contradictions, run */
    {NULL, NULL, 0, NULL, NULL, NULL},
};
