#include "lod/method_hierarchy.h"

#include "lod/covariance.h"
#include "lod/method_place.h"

#include <math.h>

/* Clusters that wait to be split. The smaller part of a cluster is always looked at first, so each that waits is at
 * least as large as all that were put on top of it: 32 would do for 2^32 posts. */
#define MOST_WAITING 40

struct site {
    struct vector3 place_m;
    uint32_t post;
};

struct cluster {
    uint32_t first, count; /* of the sites */
};

static struct vector3 mean_place(const struct site *sites, uint32_t count) {
    struct vector3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) sum = vector3_plus_scaled(sum, 1, sites[i].place_m);
    return (struct vector3){sum.x / count, sum.y / count, sum.z / count};
}

static struct covariance gather(const struct site *sites, uint32_t count, struct vector3 mean) {
    struct covariance sum = {0};
    for (uint32_t i = 0; i < count; i++) {
        struct vector3 off = vector3_minus(sites[i].place_m, mean);
        sum.xx += off.x * off.x;
        sum.xy += off.x * off.y;
        sum.xz += off.x * off.z;
        sum.yy += off.y * off.y;
        sum.yz += off.y * off.z;
        sum.zz += off.z * off.z;
    }
    return sum;
}

/* The post nearest to the mean, the first in the grid of several. */
static uint32_t stand_in(const struct site *sites, uint32_t count, struct vector3 mean) {
    double least = INFINITY;
    uint32_t post = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++) {
        struct vector3 off = vector3_minus(sites[i].place_m, mean);
        double distance2 = vector3_dot(off, off);
        if (distance2 > least || (distance2 == least && sites[i].post > post)) continue;
        least = distance2;
        post = sites[i].post;
    }
    return post;
}

/* Sites on the far side of the plane through the mean go to the end; how many are on the near side comes back. */
static uint32_t partition(struct site *sites, uint32_t count, struct vector3 mean, struct vector3 normal) {
    uint32_t near = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (vector3_dot(vector3_minus(sites[i].place_m, mean), normal) >= 0) continue;
        struct site other = sites[near];
        sites[near++] = sites[i];
        sites[i] = other;
    }
    return near;
}

/* Splits a cluster, or gives the post that stands for it. A plane through the mean leaves points on both sides, but for
 * rounding where all are all but in one place: such a cluster stays whole. Returns the sites on the near side. */
static uint32_t split(struct site *sites, uint32_t count, const struct method_hierarchy_options *options,
                      uint32_t *post) {
    struct vector3 mean = mean_place(sites, count);
    struct covariance covariance = gather(sites, count, mean);
    struct principal_axes axes = covariance_axes(&covariance);
    double sum = axes.variance[0] + axes.variance[1] + axes.variance[2];
    if (count > 1 && (count > options->most_posts || axes.variance[0] > options->most_variation * sum)) {
        uint32_t near = partition(sites, count, mean, axes.longest);
        if (near > 0 && near < count) return near;
    }
    *post = stand_in(sites, count, mean);
    return 0;
}

static enum scree_status add_clusters(struct point_set *set, struct site *sites,
                                      const struct method_hierarchy_options *options, struct scree_error *error) {
    struct cluster waiting[MOST_WAITING];
    int count = 0;
    if (set->post_count > 0) waiting[count++] = (struct cluster){0, set->post_count};
    while (count > 0) {
        struct cluster cluster = waiting[--count];
        uint32_t post, near = split(sites + cluster.first, cluster.count, options, &post);
        if (near == 0) {
            enum scree_status status = point_set_add_post(set, set->posts[post], error);
            if (status != SCREE_OK) return status;
            continue;
        }
        struct cluster parts[2] = {{cluster.first, near}, {cluster.first + near, cluster.count - near}};
        bool first_is_smaller = parts[0].count <= parts[1].count;
        waiting[count++] = parts[first_is_smaller ? 1 : 0];
        waiting[count++] = parts[first_is_smaller ? 0 : 1];
    }
    return SCREE_OK;
}

enum scree_status method_hierarchy(struct scree_memory *memory, const struct method_tile *tile,
                                   const struct method_hierarchy_options *options, struct method_mesh *mesh,
                                   struct scree_error *error) {
    struct point_set set = {0};
    struct site *sites = NULL;
    *mesh = (struct method_mesh){0};
    if (options->most_posts < 1 || !(options->most_variation >= 0 && options->most_variation <= 1.0 / 3))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "hierarchy: clusters of %u posts with a variation of %g; it takes 1 or more, and 0 to 1/3",
                          (unsigned)options->most_posts, options->most_variation);
    enum scree_status status = point_set_begin(memory, tile, &options->points, &set, error);
    if (status != SCREE_OK) goto cleanup;
    sites = scree_allocate(memory, set.post_count, sizeof *sites, "posts by clusters", error);
    if (sites == NULL) status = SCREE_E_MEMORY;
    for (uint32_t i = 0; i < set.post_count && sites != NULL; i++)
        sites[i] = (struct site){method_post_place_m(tile, set.posts[i].column, set.posts[i].row), i};
    if (status == SCREE_OK) status = add_clusters(&set, sites, options, error);
    if (status == SCREE_OK) status = point_set_finish(&set, mesh, error);
cleanup:
    scree_release(memory, sites);
    point_set_release(&set);
    return status;
}
