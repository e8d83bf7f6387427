#include "src/tin_twins.h"

#include <math.h>
#include <stdbool.h>

#define NOBODY UINT32_MAX

/* Open addressing over the numbers of points, each place's first one. */
struct places {
    uint32_t *first;
    size_t mask;
};

static size_t mix(const struct tin_post *post) {
    uint64_t key = ((uint64_t)(uint32_t)post->y << 32 | (uint32_t)post->x) * 0x9E3779B97F4A7C15u;
    return (size_t)(key ^ key >> 29);
}

/* The first point in the place of `number`, which becomes that where there is none yet. */
static uint32_t first_there(struct places *places, const struct tin_post *posts, uint32_t number) {
    size_t at = mix(&posts[number]) & places->mask;
    while (places->first[at] != NOBODY &&
           (posts[places->first[at]].x != posts[number].x || posts[places->first[at]].y != posts[number].y))
        at = (at + 1) & places->mask;
    if (places->first[at] == NOBODY) places->first[at] = number;
    return places->first[at];
}

enum scree_status tin_twins_level(struct scree_memory *memory, struct tin_post *posts, uint32_t count,
                                  struct scree_error *error) {
    struct places places = {.mask = 1};
    bool has_twins = false;
    while (places.mask / 2 <= count) places.mask = 2 * places.mask + 1;
    places.first = scree_allocate(memory, places.mask + 1, sizeof *places.first, "the places of points", error);
    if (places.first == NULL) return error->status;
    for (size_t i = 0; i <= places.mask; i++) places.first[i] = NOBODY;
    for (uint32_t i = 0; i < count; i++) {
        struct tin_post *first = &posts[first_there(&places, posts, i)];
        has_twins = has_twins || first != &posts[i];
        first->height_m = fminf(first->height_m, posts[i].height_m);
    }
    for (uint32_t i = 0; i < count && has_twins; i++)
        posts[i].height_m = posts[first_there(&places, posts, i)].height_m;
    scree_release(memory, places.first);
    return SCREE_OK;
}
