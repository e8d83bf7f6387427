/* How tiles cover the plane: profiles, zooms, tiles and the lattice of posts on which every vertex lies. Pure.
 *
 * The lattice is the grid of all posts of the finest zoom, counted from the south-west corner of the root. A tile is a
 * square of TILE_CELLS * 2^(finest_zoom - zoom) lattice steps; its posts lie on its borders, so neighbours share them.
 * Tiles are numbered as in TMS: y from the south. */
#ifndef SCREE_LATTICE_H
#define SCREE_LATTICE_H

#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

#define TILE_CELLS 256
#define MAX_ZOOM   22 /* a tile at zoom 0 spans 2^30 lattice steps then: positions in a tile fit int32_t */

enum profile {
    PROFILE_GEODETIC, /* EPSG:4326, two root tiles of 180 degrees: Cesium's default */
    PROFILE_LOCAL     /* one root over the raster; its own pixels are the finest posts */
};

struct tile_id {
    int zoom;
    uint32_t x; /* from the west */
    uint32_t y; /* from the south */
};

struct lattice {
    enum profile profile;
    int finest_zoom;
    int64_t columns, rows;       /* posts: the whole globe (the last column is the first one again), or the raster's */
    double west, south;          /* coordinate of post (0, 0): degrees, or units of the raster's CRS */
    double spacing_x, spacing_y; /* from post to post, positive: degrees, or units of the raster's CRS */
    double metres_x, metres_y;   /* local profile: metres of one step; geodetic: 0, see lattice_steps_m */
};

/* A rectangle of posts, borders included. */
struct lattice_window {
    int64_t x, y;          /* south-western post */
    int32_t columns, rows; /* steps, not posts: columns + 1 posts a row */
};

/* The geodetic lattice whose finest zoom is `finest_zoom`. */
struct lattice lattice_geodetic(int finest_zoom);

/* The local lattice of a raster of `columns` x `rows` pixels (both at least 2); finest_zoom is the least whose root
 * covers them. `west, south` is the centre of the south-western pixel. */
enum scree_status lattice_local(int64_t columns, int64_t rows, double west, double south, double spacing_x,
                                double spacing_y, double metres_per_unit, struct lattice *lattice,
                                struct scree_error *error);

/* The first zoom whose posts are no farther apart than 1.1 x `spacing_deg` (the source's resolution), at most MAX_ZOOM.
 */
int lattice_zoom_for_spacing(double spacing_deg);

/* Lattice steps along the side of a whole tile of this zoom. */
int64_t lattice_tile_span(const struct lattice *lattice, int zoom);

/* What a tile covers: its square, cut to the lattice (only the local profile cuts). Outside of it: columns == 0. */
struct lattice_window lattice_tile_window(const struct lattice *lattice, struct tile_id tile);

/* Number of tiles of a zoom in x and y. */
uint32_t lattice_tiles_x(const struct lattice *lattice, int zoom);
uint32_t lattice_tiles_y(const struct lattice *lattice, int zoom);

/* The tile's rectangle as west, south, east, north in degrees or CRS units. */
void lattice_tile_bounds(const struct lattice *lattice, struct tile_id tile, double bounds[4]);

/* Coordinate of a post (fractions are fine). */
double lattice_x(const struct lattice *lattice, double x);
double lattice_y(const struct lattice *lattice, double y);

/* Metres of one lattice step to the east and to the north at row `y` (geodetic: on the WGS84 ellipsoid; rows beyond a
 * pole count as the pole, where east_m is next to nothing but never 0). */
void lattice_steps_m(const struct lattice *lattice, double y, double *east_m, double *north_m);

/* How far the ellipsoid falls below the flat triangles of a globe: a chord that passes a post at `before` and `after`
 * steps from its ends lies drop * before * after metres below the surface there. Along the parallel of row `y` and
 * along any meridian; 0 in the local profile. The Earth's mean radius is used. */
double lattice_parallel_drop_m(const struct lattice *lattice, double y);
double lattice_meridian_drop_m(const struct lattice *lattice);

/* The tiles of a zoom whose closed squares touch a closed window of posts. */
struct tile_range {
    uint32_t x_first, y_first, x_last, y_last; /* inclusive */
};
struct tile_range lattice_tiles_touching(const struct lattice *lattice, int zoom, struct lattice_window window);

#endif
