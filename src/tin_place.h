/* Where a TIN lies: the lattice whose steps its points keep or are rounded to, and the tiles that it is cut into. Pure.
 *
 * Local profile: steps are a whole part of the largest power of ten that all coordinates are multiples of, so that
 * points keep their places; else a 128th of the points' mean distance or less. They are chosen so that the TIN fills
 * the root's square well: halving it gives sub-blocks of about one size (Ai et al. 2019, section 2.1). Geodetic
 * profile: steps are those of zoom 22, 2 cm at the equator. */
#ifndef SCREE_SRC_TIN_PLACE_H
#define SCREE_SRC_TIN_PLACE_H

#include "lod/tin.h"
#include "lod/tin_lattice.h"
#include "src/lattice.h"

struct tin_place_options {
    enum profile profile;
    double metres_per_unit; /* local profile */
    uint32_t block_points;  /* the most of a leaf tile, from 1 */
};

struct tin_place {
    struct lattice lattice;
    int leaf_zoom;
    int32_t cells;                /* along a leaf tile's side, see struct tin_source */
    int32_t wall_steps;           /* a quarter of a cell, at least 1 */
    struct lattice_window window; /* of the points and margins of two walls or more, inside the lattice */
    int64_t x, y;                 /* of the frame's south-western corner; it is made of whole leaf tiles */
    int32_t tile_span, tiles_x, tiles_y;
};

/* West, south, east, north of at least one point. */
void tin_bounds(const struct tin *tin, double bounds[4]);

/* Root of the triangles' area by the number of points; 0: they have no area. */
double tin_mean_distance(const struct tin *tin);

/* Chooses for a TIN of at least one triangle. In the geodetic profile, coordinates are degrees on the globe.
 *
 * The leaf zoom is the least that leaves no tile more than block_points points, and in the geodetic profile no tile
 * wider than the longer side of the TIN; but tiles are never more than 64 and 64 a block of points, however unevenly
 * points lie. A side of the TIN's bounding box that its outline goes along has no margin in the local profile. */
enum scree_status tin_place_choose(const struct tin *tin, const struct tin_place_options *options,
                                   struct tin_place *place, struct scree_error *error);

/* The post that a place is rounded to; in the local profile the lattice begins at a multiple of its step. */
int64_t tin_place_x(const struct lattice *lattice, double x);
int64_t tin_place_y(const struct lattice *lattice, double y);

/* The points on the lattice, from place->x and place->y on, heights as floats; slopes stay 0. `posts` has room for all.
 */
void tin_place_points(const struct tin *tin, const struct tin_place *place, struct tin_post *posts);

#endif
