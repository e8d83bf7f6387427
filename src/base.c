#include "src/base.h"

#include "src/arguments.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool base_parse(const char *text, struct base_choice *choice) {
    char number[64];
    size_t length = strlen(text);
    if (length == 0 || length >= sizeof number) return false;
    char last = text[length - 1];
    bool has_unit = last == '%' || last == 'm';
    snprintf(number, sizeof number, "%.*s", (int)(length - has_unit), text);
    if (!argument_number(number, &choice->value) || !(choice->value > 0)) return false;
    choice->kind = last == '%' ? BASE_SHARE : last == 'm' ? BASE_SVO : BASE_TRIANGLES;
    if (last != '%') return true;
    choice->value /= 100;
    return choice->value <= 1;
}

enum census base_census(const struct base_choice *choice) {
    return choice->kind == BASE_SVO ? CENSUS_OF_SVO : CENSUS_OF_TRIANGLES;
}

/* All tiles of a zoom at one of their rungs. */
struct total {
    int rung;
    uint64_t triangles;
    double vertices, mmqe_m2;
};

static bool sum_up(const struct pyramid_zoom *level, int index, struct total *total) {
    *total = (struct total){0};
    for (uint32_t i = 0; i < level->tiles.count; i++) {
        const struct rung_count *count = &level->counts[(size_t)i * TILE_MOST_RUNGS + (size_t)index];
        if (count->vertices == 0) continue;
        total->rung = count->rung;
        total->triangles += count->triangles;
        total->vertices += count->vertices;
        total->mmqe_m2 += count->mmqe_m2 * count->vertices;
    }
    return total->triangles > 0;
}

int base_rung(const struct base_choice *choice, const struct ladder *ladder, const struct pyramid *census) {
    struct total total;
    double most = choice->value;
    if (choice->kind == BASE_SHARE) {
        sum_up(&census->zooms[ladder->finest_zoom], 0, &total);
        most = (most > 0 ? most : DEFAULT_BASE_SHARE) * (double)total.triangles;
    }
    for (int zoom = ladder->finest_zoom; zoom >= 0; zoom--)
        for (int index = 0; index < TILE_MOST_RUNGS && sum_up(&census->zooms[zoom], index, &total); index++)
            if (choice->kind == BASE_SVO ? sqrt(total.mmqe_m2 / total.vertices) >= choice->value
                                         : (double)total.triangles <= most)
                return total.rung;
    return ladder->coarsest_rung;
}

int base_zoom(const struct ladder *ladder, int rung) {
    int zoom = 0;
    while (zoom < ladder->finest_zoom && RUNGS_A_ZOOM * zoom <= rung) zoom++;
    return zoom;
}
