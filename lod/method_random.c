#include "lod/method_random.h"

#include "lod/counter_random.h"

#include <math.h>

enum scree_status method_random(struct scree_memory *memory, const struct method_tile *tile,
                                const struct method_random_options *options, struct method_mesh *mesh,
                                struct scree_error *error) {
    struct point_set set = {0};
    *mesh = (struct method_mesh){0};
    if (!(options->removed_percent >= 0 && options->removed_percent <= 100))
        return scree_fail(error, SCREE_E_ARGUMENT, "random: %g percent to remove; it takes 0 to 100",
                          options->removed_percent);
    enum scree_status status = point_set_begin(memory, tile, &options->points, &set, error);
    uint32_t kept = (uint32_t)floor((1 - options->removed_percent / 100) * set.post_count + 0.5);
    for (uint32_t i = 0; i < set.post_count && status == SCREE_OK; i++) {
        /* Of those that are left, so many are still to be kept (Knuth, volume 2, 3.4.2, algorithm S). */
        if (counter_random_below(options->points.seed, i, set.post_count - i) >= kept) continue;
        kept--;
        status = point_set_add_post(&set, set.posts[i], error);
    }
    if (status == SCREE_OK) status = point_set_finish(&set, mesh, error);
    point_set_release(&set);
    return status;
}
