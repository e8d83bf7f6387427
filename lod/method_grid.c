#include "lod/method_grid.h"

#include "lod/counter_random.h"
#include "lod/method_place.h"

#include <math.h>
#include <stdlib.h>

/* A post, the cube that it is in, and its lot. */
struct entry {
    double x, y, z; /* whole numbers */
    uint64_t lot;
    uint32_t post;
};

static int compare_cubes(const struct entry *a, const struct entry *b) {
    if (a->y != b->y) return a->y < b->y ? -1 : 1;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    if (a->z != b->z) return a->z < b->z ? -1 : 1;
    return 0;
}

static int compare_entries(const void *left, const void *right) {
    const struct entry *a = left, *b = right;
    int cubes = compare_cubes(a, b);
    if (cubes != 0) return cubes;
    if (a->lot != b->lot) return a->lot < b->lot ? -1 : 1;
    return a->post < b->post ? -1 : 1;
}

/* The posts in the order of their cubes, which begin with the post that is chosen. */
static void sort_posts(const struct point_set *set, double cell_m, uint64_t seed, struct entry *entries) {
    for (uint32_t i = 0; i < set->post_count; i++) {
        struct vector3 place = method_post_place_m(set->tile, set->posts[i].column, set->posts[i].row);
        entries[i] = (struct entry){floor(place.x / cell_m), floor(place.y / cell_m), floor(place.z / cell_m),
                                    counter_random(seed, i), i};
    }
    qsort(entries, set->post_count, sizeof *entries, compare_entries);
}

enum scree_status method_grid(struct scree_memory *memory, const struct method_tile *tile,
                              const struct method_grid_options *options, struct method_mesh *mesh,
                              struct scree_error *error) {
    struct point_set set = {0};
    struct entry *entries = NULL;
    *mesh = (struct method_mesh){0};
    if (!(options->cell_m > 0 && isfinite(options->cell_m)))
        return scree_fail(error, SCREE_E_ARGUMENT, "grid: cells of %g m; it takes more than 0", options->cell_m);
    enum scree_status status = point_set_begin(memory, tile, &options->points, &set, error);
    if (status != SCREE_OK) goto cleanup;
    entries = scree_allocate(memory, set.post_count, sizeof *entries, "posts by the cells of a grid", error);
    if (entries == NULL) status = SCREE_E_MEMORY;
    if (entries != NULL) sort_posts(&set, options->cell_m, options->points.seed, entries);
    for (uint32_t i = 0; i < set.post_count && status == SCREE_OK; i++)
        if (i == 0 || compare_cubes(&entries[i - 1], &entries[i]) != 0)
            status = point_set_add_post(&set, set.posts[entries[i].post], error);
    if (status == SCREE_OK) status = point_set_finish(&set, mesh, error);
cleanup:
    scree_release(memory, entries);
    point_set_release(&set);
    return status;
}
