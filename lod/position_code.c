#include "lod/position_code.h"

#include <stdlib.h>

static struct sample code_of(const struct code_frame *frame, const struct sample *at) {
    return (struct sample){position_code((int64_t)at->x + frame->x, frame->span),
                           position_code((int64_t)at->y + frame->y, frame->span), 0};
}

/* Whether the triangle, of twice that area, is so thick that rounding to codes cannot turn it over: each difference of
 * coordinates is off by span / POSITION_TOP steps at the most. Codes finer than the lattice do turn thin ones over. */
static bool is_thick_in_codes(const struct code_frame *frame, const struct sample *a, const struct sample *b,
                              const struct sample *c, int64_t area2) {
    if (frame->span > POSITION_TOP) return false;
    int64_t reach = llabs((int64_t)b->x - a->x) + llabs((int64_t)b->y - a->y) + llabs((int64_t)c->x - a->x) +
                    llabs((int64_t)c->y - a->y);
    return area2 * POSITION_TOP > frame->span * (reach + 2);
}

bool codes_positive(const struct code_frame *codes, const struct sample *a, const struct sample *b,
                    const struct sample *c) {
    int64_t area2 = sample_area2(a, b, c);
    if (area2 <= 0) return false;
    if (codes->span == 0 || is_thick_in_codes(codes, a, b, c, area2)) return true;
    struct sample coded[3] = {code_of(codes, a), code_of(codes, b), code_of(codes, c)};
    return sample_area2(&coded[0], &coded[1], &coded[2]) > 0;
}
