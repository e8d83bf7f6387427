/* The symmetric Hausdorff distance of two surfaces in space, by samples. Pure.
 *
 * Every vertex of either surface, a number of points scattered over its faces and another number over its edges are
 * asked how far they are from the other surface, of which nothing is sampled (Campos et al. 2020, section 5.2). Faces
 * and edges are hit in proportion to their areas and lengths. The same seed gives the same points on every machine. */
#ifndef SCREE_LOD_HAUSDORFF_H
#define SCREE_LOD_HAUSDORFF_H

#include "lod/mesh_distance.h"

#define HAUSDORFF_POINTS 1000 /* on faces, and again on edges */

struct hausdorff_options {
    uint32_t face_points, edge_points;
    uint64_t seed;
};

/* A surface ready to be compared with any number of others. */
struct hausdorff_surface {
    struct distance_index index;
    uint32_t sample_count; /* vertices first, then points on faces, then on edges */
    struct vector3 *samples_m;
};

struct hausdorff {
    double max_m;          /* the distance: the larger of the two below */
    double from_first_m;   /* the farthest sample of the first surface */
    double from_second_m;  /* the farthest sample of the second one */
    double mean_m;         /* of all samples of both */
    uint32_t sample_count; /* of both */
};

/* Files a surface, whose arrays must outlive it, and scatters its samples. SCREE_E_ARGUMENT as space_mesh_check. On
 * failure nothing is left to release. */
enum scree_status hausdorff_prepare(struct scree_memory *memory, const struct space_mesh *mesh,
                                    const struct hausdorff_options *options, struct hausdorff_surface *prepared,
                                    struct scree_error *error);

/* Fine on a zeroed one, and twice. */
void hausdorff_release(struct scree_memory *memory, struct hausdorff_surface *prepared);

/* Compares two surfaces. `distances_m` is NULL, or has room for the samples of both and gets their distances, sorted
 * from near to far. */
struct hausdorff hausdorff_measure(struct hausdorff_surface *first, struct hausdorff_surface *second,
                                   double *distances_m);

#endif
