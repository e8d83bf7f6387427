/* What the four methods that simplify point sets have in common (Campos et al., "3D Simplification Methods and Large
 * Scale Terrain Tiling", 2020, section 4.3): feature lines are found and simplified, the method chooses points between
 * them, and the points go into the constrained Delaunay triangulation of border and features. Pure.
 *
 *     struct point_set set;
 *     point_set_begin(memory, tile, &options, &set, error);
 *     ... point_set_add_post or point_set_add_place for each chosen point of set.posts ...
 *     point_set_finish(&set, mesh, error);
 *     point_set_release(&set);
 *
 * Places are rounded to 1/32 of a cell, or to lattice steps where these are larger. Points that are nearer than a
 * quarter of a cell to the border or to a feature line would make needles there, and are left out. */
#ifndef SCREE_LOD_POINT_SET_H
#define SCREE_LOD_POINT_SET_H

#include "lod/constrained.h"
#include "lod/features.h"
#include "lod/method.h"
#include "stream/ellipsoid.h"

struct point_set_options {
    struct feature_options features;
    bool without_features;
    double line_tolerance_m; /* how far, in space, a simplified feature line may be from its points; p_e; at least 0 */
    uint64_t seed;           /* of what is random */
};

struct point_set {
    struct scree_memory *memory;
    const struct method_tile *tile;
    struct feature_post *posts; /* those that are neither on the border nor on a feature line, row by row */
    uint32_t post_count;
    struct constrained triangulation;
    double *heights_m; /* one a point of the triangulation */
    uint32_t height_capacity;
    int32_t units; /* of the triangulation a lattice step */
};

/* The tile is one that method_tile_check accepts, and must outlive the set. To be released in any case. */
enum scree_status point_set_begin(struct scree_memory *memory, const struct method_tile *tile,
                                  const struct point_set_options *options, struct point_set *set,
                                  struct scree_error *error);

/* Adds a point: a post, or any place (lod/method_place.h), which is left out beyond the border. */
enum scree_status point_set_add_post(struct point_set *set, struct feature_post post, struct scree_error *error);
enum scree_status point_set_add_place(struct point_set *set, struct vector3 place_m, struct scree_error *error);

/* The mesh of all that was added. Vertices of the border come first, then those of the features, then the points. */
enum scree_status point_set_finish(const struct point_set *set, struct method_mesh *mesh, struct scree_error *error);

void point_set_release(struct point_set *set);

#endif
