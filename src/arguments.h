/* Words of a command line: what those have in common that take options. Pure. */
#ifndef SCREE_SRC_ARGUMENTS_H
#define SCREE_SRC_ARGUMENTS_H

#include <stdbool.h>

enum argument_result {
    ARGUMENT_OTHER, /* not one of these: the caller's */
    ARGUMENT_TAKEN, /* it, and the values behind it */
    ARGUMENT_WRONG  /* `error` says why */
};

/* Is it the option of this name, written with one dash or two? */
bool argument_is(const char *argument, const char *name);

/* The whole text as a finite number, or false. */
bool argument_number(const char *text, double *number);

/* The whole text as a whole number within low..high, or false. */
bool argument_integer(const char *text, long low, long high, int *number);

#endif
