#include "lod/ahead.h"

/* Moves a border vertex that the rung drops to the nearer one of the two that it keeps around it; true when it did. */
static bool move(const struct ahead *ahead, const struct ahead_rung *rung, struct sample *at) {
    int32_t position;
    enum tile_side side = border_side(ahead->columns, ahead->rows, at, &position);
    if (side == SIDE_COUNT) return false;
    const struct border_line *line = &rung->lines[side];
    const struct border_sample *before = &line->vertices[border_before(line, position)], *after = before + 1;
    if (before->position == position) return false;
    const struct border_sample *kept = position - before->position <= after->position - position ? before : after;
    if (side == SIDE_SOUTH || side == SIDE_NORTH)
        at->x = kept->position;
    else
        at->y = kept->position;
    at->height_m = kept->height_m;
    return true;
}

static bool on_border(const struct ahead *ahead, const struct sample *at) {
    return at->x == 0 || at->y == 0 || at->x == ahead->columns || at->y == ahead->rows;
}

/* A triangle that no rung moves: its error is that of the rung at hand, so the next one will do. */
static bool inner_admitted(const struct ahead *ahead, const struct sample *a, const struct sample *b,
                           const struct sample *c, float error_m) {
    if (error_m > ahead->rungs[ahead->next].tolerance_m) return false;
    for (int i = ahead->next; i < ahead->count; i++)
        if (ahead->rungs[i].codes.span != 0 && !codes_positive(&ahead->rungs[i].codes, a, b, c)) return false;
    return true;
}

static bool same_place(const struct sample *a, const struct sample *b) {
    return a->x == b->x && a->y == b->y;
}

bool ahead_admits(const struct ahead *ahead, const struct sample *a, const struct sample *b, const struct sample *c,
                  float error_m) {
    if (ahead == NULL) return true;
    if (!on_border(ahead, a) && !on_border(ahead, b) && !on_border(ahead, c))
        return inner_admitted(ahead, a, b, c, error_m);
    struct sample at[3] = {*a, *b, *c};
    for (int i = ahead->next; i < ahead->count; i++) {
        const struct ahead_rung *rung = &ahead->rungs[i];
        bool moved = false;
        for (int corner = 0; corner < 3; corner++) moved = move(ahead, rung, &at[corner]) || moved;
        if (moved && (same_place(&at[0], &at[1]) || same_place(&at[1], &at[2]) || same_place(&at[2], &at[0])))
            return true;
        if ((moved || rung->codes.span != 0) && !codes_positive(&rung->codes, &at[0], &at[1], &at[2])) return false;
        if (moved) error_m = samples_triangle_error(&rung->samples, &at[0], &at[1], &at[2]).max_m;
        if (error_m > rung->tolerance_m) return false;
    }
    return true;
}
