/* Where a point of a tile is in space: metres about the tile's middle, east, north and up, on the round Earth. Pure. */
#ifndef SCREE_LOD_METHOD_PLACE_H
#define SCREE_LOD_METHOD_PLACE_H

#include "lod/method.h"
#include "stream/ellipsoid.h"

static inline struct vector3 method_place_m(const struct method_tile *tile, double x, double y, double height_m) {
    return (struct vector3){(x - 0.5 * method_width(tile)) * tile->east_m,
                            (y - 0.5 * method_height(tile)) * tile->north_m, height_m - method_drop_m(tile, x, y)};
}

static inline struct vector3 method_post_place_m(const struct method_tile *tile, int32_t column, int32_t row) {
    return method_place_m(tile, (double)column * tile->cell_span, (double)row * tile->cell_span,
                          (double)method_post_m(tile, column, row));
}

#endif
