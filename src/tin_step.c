#include "src/tin_step.h"

#include <math.h>

#define CLOSE       1e-6    /* of a step */
#define ROUNDED     1e-15   /* of a number: some of a double's last bits */
#define FLOAT_ROUND 0x1p-24 /* of a number: half of a float's last bit */
#define MOST_FLOAT  0.05    /* of a step: floats coarser than that tell nothing of it */

static bool is_multiple(double step, double number) {
    double times = number / step, rest = fabs(times - nearbyint(times));
    if (rest <= CLOSE + fabs(times) * ROUNDED) return true;
    double slack = fabs(times) * FLOAT_ROUND;
    return rest <= slack && slack <= MOST_FLOAT && number == (float)number;
}

bool tin_step_divides(double step, const double *numbers, size_t count, size_t stride) {
    for (size_t i = 0; i < count; i++)
        if (!is_multiple(step, numbers[i * stride])) return false;
    return true;
}

/* Exact for both signs, as far as doubles are. */
static double power_of_ten(int exponent) {
    double power = 1;
    for (int i = 0; i < (exponent < 0 ? -exponent : exponent); i++) power *= 10;
    return exponent < 0 ? 1 / power : power;
}

double tin_step_find(int least, int most, const double *numbers, size_t count, size_t stride) {
    for (int exponent = most; exponent >= least; exponent--)
        if (tin_step_divides(power_of_ten(exponent), numbers, count, stride)) return power_of_ten(exponent);
    return 0;
}
