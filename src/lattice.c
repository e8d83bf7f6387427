/* How tiles cover the plane: the arithmetic of profiles, zooms and posts (src/lattice.h). */
#include "src/lattice.h"

#include <math.h>

#define ROOT_DEG           180.0                  /* side of a geodetic root tile */
#define WGS84_A_M          6378137.0              /* EPSG:7030 */
#define WGS84_E2           6.69437999014131705e-3 /* f (2 - f), f = 1 / 298.257223563 */
#define RADIANS_PER_DEGREE 0.017453292519943295
#define SPACING_SLACK      1.1 /* posts may lie this much farther apart than the source's pixels */

static int64_t tile_span(int finest_zoom, int zoom) {
    return (int64_t)TILE_CELLS << (finest_zoom - zoom);
}

struct lattice lattice_geodetic(int finest_zoom) {
    int64_t root_span = tile_span(finest_zoom, 0);
    double spacing_deg = ROOT_DEG / (double)root_span; /* 45 / 2^n: exact, and so are all posts' coordinates */
    return (struct lattice){
        .profile = PROFILE_GEODETIC,
        .finest_zoom = finest_zoom,
        .columns = 2 * root_span + 1,
        .rows = root_span + 1,
        .west = -ROOT_DEG,
        .south = -ROOT_DEG / 2,
        .spacing_x = spacing_deg,
        .spacing_y = spacing_deg,
    };
}

enum scree_status lattice_local(int64_t columns, int64_t rows, double west, double south, double spacing_x,
                                double spacing_y, double metres_per_unit, struct lattice *lattice,
                                struct scree_error *error) {
    if (columns < 2 || rows < 2)
        return scree_fail(error, SCREE_E_ARGUMENT, "a terrain needs at least 2 x 2 posts, this one has %lld x %lld",
                          (long long)columns, (long long)rows);
    if (!isfinite(west) || !isfinite(south) || !(spacing_x > 0) || !(spacing_y > 0) || !isfinite(spacing_x) ||
        !isfinite(spacing_y) || !(metres_per_unit > 0) || !isfinite(metres_per_unit))
        return scree_fail(error, SCREE_E_ARGUMENT, "the raster's position or pixel size makes no sense");
    int64_t longest = columns > rows ? columns : rows;
    int finest_zoom = 0;
    while (finest_zoom < MAX_ZOOM && tile_span(finest_zoom, 0) < longest - 1) finest_zoom++;
    if (tile_span(finest_zoom, 0) < longest - 1)
        return scree_fail(error, SCREE_E_LIMIT, "%lld x %lld posts are more than %d zooms can hold; crop with --te",
                          (long long)columns, (long long)rows, MAX_ZOOM);
    *lattice = (struct lattice){
        .profile = PROFILE_LOCAL,
        .finest_zoom = finest_zoom,
        .columns = columns,
        .rows = rows,
        .west = west,
        .south = south,
        .spacing_x = spacing_x,
        .spacing_y = spacing_y,
        .metres_x = spacing_x * metres_per_unit,
        .metres_y = spacing_y * metres_per_unit,
    };
    return SCREE_OK;
}

int lattice_zoom_for_spacing(double spacing_deg) {
    int zoom = 0;
    while (zoom < MAX_ZOOM && ROOT_DEG / (double)tile_span(zoom, 0) > SPACING_SLACK * spacing_deg) zoom++;
    return zoom;
}

int64_t lattice_tile_span(const struct lattice *lattice, int zoom) {
    return tile_span(lattice->finest_zoom, zoom);
}

struct lattice_window lattice_tile_window(const struct lattice *lattice, struct tile_id tile) {
    int64_t span = lattice_tile_span(lattice, tile.zoom);
    int64_t x = tile.x * span, y = tile.y * span;
    int64_t columns = lattice->columns - 1 - x, rows = lattice->rows - 1 - y;
    if (columns > span) columns = span;
    if (rows > span) rows = span;
    if (columns <= 0 || rows <= 0) return (struct lattice_window){.x = x, .y = y};
    return (struct lattice_window){.x = x, .y = y, .columns = (int32_t)columns, .rows = (int32_t)rows};
}

static uint32_t tiles_along(int64_t posts, int64_t span) {
    return (uint32_t)((posts - 1 + span - 1) / span);
}

uint32_t lattice_tiles_x(const struct lattice *lattice, int zoom) {
    return tiles_along(lattice->columns, lattice_tile_span(lattice, zoom));
}

uint32_t lattice_tiles_y(const struct lattice *lattice, int zoom) {
    return tiles_along(lattice->rows, lattice_tile_span(lattice, zoom));
}

void lattice_tile_bounds(const struct lattice *lattice, struct tile_id tile, double bounds[4]) {
    double span = (double)lattice_tile_span(lattice, tile.zoom);
    bounds[0] = lattice_x(lattice, tile.x * span);
    bounds[1] = lattice_y(lattice, tile.y * span);
    bounds[2] = lattice_x(lattice, (tile.x + 1.0) * span);
    bounds[3] = lattice_y(lattice, (tile.y + 1.0) * span);
}

double lattice_x(const struct lattice *lattice, double x) {
    return lattice->west + x * lattice->spacing_x;
}

double lattice_y(const struct lattice *lattice, double y) {
    return lattice->south + y * lattice->spacing_y;
}

void lattice_steps_m(const struct lattice *lattice, double y, double *east_m, double *north_m) {
    if (lattice->profile == PROFILE_LOCAL) {
        *east_m = lattice->metres_x;
        *north_m = lattice->metres_y;
        return;
    }
    double lat_deg = fmin(fmax(lattice_y(lattice, y), -90.0), 90.0);
    double lat_rad = lat_deg * RADIANS_PER_DEGREE;
    double sine = sin(lat_rad);
    double w2 = 1 - WGS84_E2 * sine * sine;
    double prime_vertical_m = WGS84_A_M / sqrt(w2);
    double meridian_m = prime_vertical_m * (1 - WGS84_E2) / w2;
    *east_m = prime_vertical_m * cos(lat_rad) * lattice->spacing_x * RADIANS_PER_DEGREE;
    *north_m = meridian_m * lattice->spacing_y * RADIANS_PER_DEGREE;
}

/* First and last of `tiles` closed intervals of `span` steps that touch the closed interval [low, high]. */
static void touching(int64_t low, int64_t high, int64_t span, uint32_t tiles, uint32_t *first, uint32_t *last) {
    int64_t from = low <= 0 ? 0 : (low + span - 1) / span - 1;
    int64_t to = high < 0 ? 0 : high / span;
    *first = (uint32_t)(from < tiles ? from : (int64_t)tiles - 1);
    *last = (uint32_t)(to < tiles ? to : (int64_t)tiles - 1);
}

struct tile_range lattice_tiles_touching(const struct lattice *lattice, int zoom, struct lattice_window window) {
    int64_t span = lattice_tile_span(lattice, zoom);
    struct tile_range range;
    touching(window.x, window.x + window.columns, span, lattice_tiles_x(lattice, zoom), &range.x_first, &range.x_last);
    touching(window.y, window.y + window.rows, span, lattice_tiles_y(lattice, zoom), &range.y_first, &range.y_last);
    return range;
}

#define MEAN_RADIUS_M 6371008.8

double lattice_parallel_drop_m(const struct lattice *lattice, double y) {
    double east_m, north_m;
    if (lattice->profile == PROFILE_LOCAL) return 0;
    lattice_steps_m(lattice, y, &east_m, &north_m);
    return east_m * east_m / (2 * MEAN_RADIUS_M);
}

double lattice_meridian_drop_m(const struct lattice *lattice) {
    if (lattice->profile == PROFILE_LOCAL) return 0;
    double radians = lattice->spacing_y * (acos(-1.0) / 180);
    return radians * radians * MEAN_RADIUS_M / 2;
}
