/* Unit vectors in two bytes (src/octahedral.h). */
#include "src/octahedral.h"

#include <math.h>

static unsigned char byte_of(double component) { /* -1..1 to 0..255, rounded to nearest */
    double scaled = (component * 0.5 + 0.5) * 255 + 0.5;
    return (unsigned char)(scaled <= 0 ? 0 : scaled >= 255 ? 255 : scaled);
}

void octahedral_encode(struct vector3 unit, unsigned char code[2]) {
    double shrink = 1 / (fabs(unit.x) + fabs(unit.y) + fabs(unit.z));
    double x = unit.x * shrink, y = unit.y * shrink;
    if (unit.z < 0) { /* the lower half is folded out over the corners of the square */
        double folded = (1 - fabs(y)) * (x < 0 ? -1 : 1);
        y = (1 - fabs(x)) * (y < 0 ? -1 : 1);
        x = folded;
    }
    code[0] = byte_of(x);
    code[1] = byte_of(y);
}
