/* Boxes around tiles, and how a camera sees them. Pure. */
#ifndef SCREE_STREAM_TILE_BOX_H
#define SCREE_STREAM_TILE_BOX_H

#include "stream/ellipsoid.h"
#include <scree/select.h>
#include <stdbool.h>

/* A right-angled box: the places centre + a axes[0] + b axes[1] + c axes[2] with |a| <= half[0] and so on. */
struct tile_box {
    struct vector3 centre, axes[3]; /* unit vectors */
    double half_m[3];
};

/* Holds every place of the tile's rectangle between two heights, and so every triangle between such places. */
struct tile_box tile_box_of(const struct scree_terrain *terrain, const struct scree_tile_id *tile, double lowest_m,
                            double highest_m);

/* How a box looks from a camera. */
struct tile_sight {
    bool seen;              /* false: no place of the box is on the screen, nor above the globe's horizon */
    double distance_m;      /* from the eye, or from the axis of an orthogonal view */
    double pixel_m;         /* a length parallel to the screen, anywhere seen, is at most a pixel a so many m */
    double pixel_any_way_m; /* the same for a length in any direction */
};

struct tile_sight tile_sight_of(const struct scree_terrain *terrain, const struct scree_view *view,
                                const struct tile_box *box);

#endif
