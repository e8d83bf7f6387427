/* What `scree remesh` does between reading and writing: posts with their distances in metres, the mesh in the space of
 * its file, and how far it is from the posts, by height and as an observer sees it. Pure. */
#ifndef SCREE_REMESH_H
#define SCREE_REMESH_H

#include "src/extract_mesh.h"
#include "src/lattice.h"
#include "stream/quadtree.h"

/* The raster's lattice of the local profile, as one that knows where on Earth it lies when its coordinates are angles:
 * then in degrees and of the geodetic profile. `metres_per_unit` is that of raster_summary. */
struct lattice remesh_lattice(const struct lattice *local, double metres_per_unit);

/* All posts of the lattice; distances are those in its middle. */
struct curvature_posts remesh_posts(const struct lattice *lattice, const float *heights_m);

/* The mesh in metres: east, north and up of `middle` (degrees) in the geodetic profile, else height over x and y of the
 * CRS. `placed` is to be freed with extract_mesh_free. */
enum scree_status remesh_place(struct scree_memory *memory, const struct lattice *lattice,
                               const struct curvature_posts *posts, const struct scree_mesh *mesh,
                               struct extract_mesh *placed, double middle[2], struct scree_error *error);

struct remesh_error {
    double max_m, rms_m;     /* vertical distance from posts to the mesh */
    double max_rad, rms_rad; /* the angle that it takes up for an observer, at the most; 0 without one */
};

/* Looks at every post of a mesh that covers them all, each once. */
enum scree_status remesh_measure(struct scree_memory *memory, const struct curvature_posts *posts,
                                 const struct scree_mesh *mesh, const struct quadtree_view *view,
                                 struct remesh_error *measured, struct scree_error *error);

#endif
