/* Which power of ten numbers are whole multiples of: coordinates and heights are seldom as fine as a double. Pure. */
#ifndef SCREE_SRC_TIN_STEP_H
#define SCREE_SRC_TIN_STEP_H

#include <stdbool.h>
#include <stddef.h>

/* Whether all `count` numbers, `stride` doubles apart, are multiples of `step`: within a millionth of it and what
 * arithmetic rounds; numbers that are floats may miss by what a float rounds, up to a twentieth of the step. */
bool tin_step_divides(double step, const double *numbers, size_t count, size_t stride);

/* The largest power of ten from 10^least to 10^most that divides all; 0: none. */
double tin_step_find(int least, int most, const double *numbers, size_t count, size_t stride);

#endif
