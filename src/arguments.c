#include "src/arguments.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool argument_number(const char *text, double *number) {
    char *end;
    *number = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*number);
}

bool argument_integer(const char *text, long low, long high, int *number) {
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || value < low || value > high) return false;
    *number = (int)value;
    return true;
}

bool argument_is(const char *argument, const char *name) {
    if (argument[0] != '-') return false;
    argument += argument[1] == '-' ? 2 : 1;
    return strcmp(argument, name) == 0;
}
