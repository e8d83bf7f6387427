#include "src/stream_place.h"

#include <math.h>

int32_t stream_height_exponent(const struct ladder *ladder) {
    int exponent;
    frexp(ladder->height_unit_m, &exponent);
    return exponent - 1;
}

void stream_place(const struct lattice *lattice, const struct ladder *ladder, struct tile_id id,
                  struct scree_stream_header *place) {
    struct lattice_window window = lattice_tile_window(lattice, id);
    *place =
        (struct scree_stream_header){.version = SCREE_STREAM_VERSION,
                                     .profile = lattice->profile == PROFILE_GEODETIC ? SCREE_GEODETIC : SCREE_LOCAL,
                                     .zoom = id.zoom,
                                     .tile_x = id.x,
                                     .tile_y = id.y,
                                     .columns = window.columns,
                                     .rows = window.rows,
                                     .west = lattice_x(lattice, (double)window.x),
                                     .south = lattice_y(lattice, (double)window.y),
                                     .spacing_x = lattice->spacing_x,
                                     .spacing_y = lattice->spacing_y,
                                     .metres_x = lattice->metres_x,
                                     .metres_y = lattice->metres_y,
                                     .height_exponent = stream_height_exponent(ladder)};
}
