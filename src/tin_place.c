#include "src/tin_place.h"

#include "src/tin_step.h"

#include <math.h>
#include <stdbool.h>

#define LEAST_POWER    (-6) /* of the steps that coordinates may be multiples of */
#define MOST_POWER     3
#define COARSEST_SHARE 8.0     /* steps of a mean distance, at least */
#define FINEST_SHARE   65536.0 /* and at most, for the sake of places: what is finer is noise */
#define ROUNDED_SHARE  128.0   /* where places are rounded */
#define MOST_PARTS     8       /* of a power of ten that become steps */
#define WELL_FILLED    0.8     /* of the root's side */
#define ROUNDED_FILLS  0.92    /* leaves room for margins of half a cell of a sixteenth of the root */
#define MOST_STEPS     ((double)TIN_LATTICE_MOST_STEPS)
#define LEAST_CELLS    16
#define MOST_CELLS     256
#define TILES_ALWAYS   64
#define TILES_A_BLOCK  64
#define MOST_PASSES    8
enum { WEST, SOUTH, EAST, NORTH };

void tin_bounds(const struct tin *tin, double bounds[4]) {
    struct cloud cloud = {.points = tin->points, .count = tin->point_count};
    cloud_bounds(&cloud, bounds);
}

double tin_mean_distance(const struct tin *tin) {
    double area2 = 0;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        const struct cloud_point *a = &tin->points[tin->corners[3 * t]], *b = &tin->points[tin->corners[3 * t + 1]];
        const struct cloud_point *c = &tin->points[tin->corners[3 * t + 2]];
        area2 += fabs((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x));
    }
    return tin->point_count > 0 ? sqrt(area2 / 2 / tin->point_count) : 0;
}

/* ---- steps and margins ---- */

/* A TIN as it is looked at while its place is chosen. */
struct placing {
    const struct tin *tin;
    const struct tin_place_options *options;
    double bounds[4];
    bool has_margin[4]; /* on each side */
    uint32_t *counts;   /* of points by tile; room for `most_tiles` */
    uint32_t most_tiles;
};

static int64_t steps_from(double coordinate, double origin, double spacing) {
    return (int64_t)nearbyint((coordinate - origin) / spacing);
}

/* The lattice's steps are counted from its origin's multiple of them, so that no place is rounded twice. */
int64_t tin_place_x(const struct lattice *lattice, double x) {
    if (lattice->profile == PROFILE_GEODETIC) return steps_from(x, lattice->west, lattice->spacing_x);
    return steps_from(x, 0, lattice->spacing_x) - steps_from(lattice->west, 0, lattice->spacing_x);
}

int64_t tin_place_y(const struct lattice *lattice, double y) {
    if (lattice->profile == PROFILE_GEODETIC) return steps_from(y, lattice->south, lattice->spacing_y);
    return steps_from(y, 0, lattice->spacing_y) - steps_from(lattice->south, 0, lattice->spacing_y);
}

/* Whether triangles' edges cover a side of the bounding box: nothing lies beyond them, so each counts once. */
static void find_margins(struct placing *placing) {
    const struct tin *tin = placing->tin;
    double covered[4] = {0, 0, 0, 0};
    for (size_t t = 0; t < tin->triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            const struct cloud_point *a = &tin->points[tin->corners[3 * t + k]];
            const struct cloud_point *b = &tin->points[tin->corners[3 * t + (k + 1) % 3]];
            if (a->x == b->x && a->x == placing->bounds[WEST]) covered[WEST] += fabs(a->y - b->y);
            if (a->x == b->x && a->x == placing->bounds[EAST]) covered[EAST] += fabs(a->y - b->y);
            if (a->y == b->y && a->y == placing->bounds[SOUTH]) covered[SOUTH] += fabs(a->x - b->x);
            if (a->y == b->y && a->y == placing->bounds[NORTH]) covered[NORTH] += fabs(a->x - b->x);
        }
    double width = placing->bounds[EAST] - placing->bounds[WEST];
    double height = placing->bounds[NORTH] - placing->bounds[SOUTH];
    for (int side = 0; side < 4; side++) {
        double whole = side % 2 == 0 ? height : width; /* sums of many lengths are not exact */
        placing->has_margin[side] = placing->options->profile == PROFILE_GEODETIC || covered[side] < whole * (1 - 1e-9);
    }
}

static enum scree_status begin(const struct tin *tin, const struct tin_place_options *options, struct placing *placing,
                               struct scree_error *error) {
    *placing = (struct placing){.tin = tin, .options = options};
    uint64_t most = TILES_ALWAYS + (uint64_t)TILES_A_BLOCK * tin->point_count / options->block_points;
    placing->most_tiles = (uint32_t)(most < UINT32_MAX / 2 ? most : UINT32_MAX / 2);
    placing->counts =
        scree_allocate(tin->memory, placing->most_tiles, sizeof *placing->counts, "the tiles of a TIN", error);
    if (placing->counts == NULL) return error->status;
    tin_bounds(tin, placing->bounds);
    find_margins(placing);
    return SCREE_OK;
}

/* ---- tiles ---- */

static uint64_t tiles_of(const struct tile_range *range) {
    return ((uint64_t)range->x_last - range->x_first + 1) * ((uint64_t)range->y_last - range->y_first + 1);
}

static void count_points(const struct placing *placing, const struct lattice *lattice, int zoom,
                         const struct tile_range *range) {
    const struct tin *tin = placing->tin;
    int64_t span = lattice_tile_span(lattice, zoom);
    uint32_t columns = range->x_last - range->x_first + 1;
    for (uint32_t i = 0; i < placing->most_tiles; i++) placing->counts[i] = 0;
    for (uint32_t i = 0; i < tin->point_count; i++) {
        uint32_t x = (uint32_t)(tin_place_x(lattice, tin->points[i].x) / span);
        uint32_t y = (uint32_t)(tin_place_y(lattice, tin->points[i].y) / span);
        x = (x < range->x_last ? x : range->x_last) - range->x_first;
        y = (y < range->y_last ? y : range->y_last) - range->y_first;
        placing->counts[y * columns + x]++;
    }
}

/* Adds up four tiles each, in place: what is written lies before what is still to be read. */
static void reduce_counts(uint32_t *counts, const struct tile_range *fine, const struct tile_range *coarse) {
    uint32_t columns = fine->x_last - fine->x_first + 1, rows = fine->y_last - fine->y_first + 1;
    uint32_t coarse_columns = coarse->x_last - coarse->x_first + 1;
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++) {
            uint32_t count = counts[y * columns + x];
            counts[y * columns + x] = 0;
            counts[((fine->y_first + y) / 2 - coarse->y_first) * coarse_columns + (fine->x_first + x) / 2 -
                   coarse->x_first] += count;
        }
}

struct crowding {
    uint32_t largest, filled; /* points of the fullest tile; tiles that have any */
};

static struct crowding look_at_counts(const uint32_t *counts, uint64_t tiles) {
    struct crowding crowding = {0, 0};
    for (uint64_t i = 0; i < tiles; i++) {
        if (counts[i] > crowding.largest) crowding.largest = counts[i];
        crowding.filled += counts[i] > 0;
    }
    return crowding;
}

/* The power of two nearest to the root of the mean number of points of a tile that has any. */
static int32_t cells_for(const struct placing *placing, const struct crowding *crowding) {
    double side = sqrt((double)placing->tin->point_count / crowding->filled);
    int32_t cells = LEAST_CELLS;
    while (cells < MOST_CELLS && side > cells * sqrt(2)) cells *= 2;
    return cells;
}

/* A zoom of tiles that are no wider than the longer side of the TIN. */
static int first_zoom(const struct placing *placing, const struct lattice *lattice) {
    const double *bounds = placing->bounds;
    double longer = fmax(bounds[EAST] - bounds[WEST], bounds[NORTH] - bounds[SOUTH]);
    int zoom = 0;
    if (lattice->profile == PROFILE_LOCAL) return 0;
    while (zoom < lattice->finest_zoom && (double)lattice_tile_span(lattice, zoom) * lattice->spacing_x > longer)
        zoom++;
    return zoom;
}

/* Points are counted once, at the deepest zoom whose tiles are not too many, and added up from there. */
static void choose_leaf(const struct placing *placing, struct tin_place *place) {
    const struct lattice *lattice = &place->lattice;
    int first = first_zoom(placing, lattice), zoom = first;
    struct tile_range range = lattice_tiles_touching(lattice, zoom, place->window);
    while (zoom < lattice->finest_zoom) {
        struct tile_range finer = lattice_tiles_touching(lattice, zoom + 1, place->window);
        if (tiles_of(&finer) > placing->most_tiles) break;
        range = finer;
        zoom++;
    }
    count_points(placing, lattice, zoom, &range);
    struct crowding crowding = look_at_counts(placing->counts, tiles_of(&range));
    place->leaf_zoom = zoom;
    place->cells = cells_for(placing, &crowding);
    while (zoom > first) {
        struct tile_range coarser = lattice_tiles_touching(lattice, zoom - 1, place->window);
        reduce_counts(placing->counts, &range, &coarser);
        range = coarser;
        zoom--;
        crowding = look_at_counts(placing->counts, tiles_of(&range));
        if (crowding.largest > placing->options->block_points) break;
        place->leaf_zoom = zoom;
        place->cells = cells_for(placing, &crowding);
    }
    place->tile_span = (int32_t)lattice_tile_span(lattice, place->leaf_zoom);
    place->wall_steps = place->tile_span / place->cells / 4;
    if (place->wall_steps < 1) place->wall_steps = 1;
}

/* ---- lattices ---- */

/* Chooses tiles, then margins that their walls need, for which `set` makes the lattice and its window; wider margins
 * may have other tiles. */
static enum scree_status settle(const struct placing *placing, const int64_t box[4],
                                enum scree_status (*set)(const struct placing *placing, const int64_t box[4],
                                                         struct tin_place *place, struct scree_error *error),
                                struct tin_place *place, struct scree_error *error) {
    int64_t margin = 0;
    for (int pass = 0; pass < MOST_PASSES; pass++) {
        int64_t wider[4];
        for (int side = 0; side < 4; side++) {
            int64_t own = placing->has_margin[side] ? margin : 0;
            wider[side] = side == WEST || side == SOUTH ? box[side] - own : box[side] + own;
        }
        enum scree_status status = set(placing, wider, place, error);
        if (status != SCREE_OK) return status;
        choose_leaf(placing, place);
        if (margin >= 2 * (int64_t)place->wall_steps) break;
        if (pass + 1 == MOST_PASSES)
            place->wall_steps = (int32_t)(margin / 2);
        else
            margin = 2 * (int64_t)place->wall_steps;
    }
    return SCREE_OK;
}

/* place->lattice has its spacing. */
static enum scree_status set_local(const struct placing *placing, const int64_t box[4], struct tin_place *place,
                                   struct scree_error *error) {
    double step = place->lattice.spacing_x;
    enum scree_status status =
        lattice_local(box[EAST] - box[WEST] + 1, box[NORTH] - box[SOUTH] + 1, (double)box[WEST] * step,
                      (double)box[SOUTH] * step, step, step, placing->options->metres_per_unit, &place->lattice, error);
    if (status == SCREE_OK)
        place->window = (struct lattice_window){.columns = (int32_t)(place->lattice.columns - 1),
                                                .rows = (int32_t)(place->lattice.rows - 1)};
    return status;
}

static enum scree_status place_local(const struct placing *placing, double step, struct tin_place *place,
                                     struct scree_error *error) {
    int64_t box[4];
    for (int side = 0; side < 4; side++) box[side] = steps_from(placing->bounds[side], 0, step);
    box[EAST] += box[EAST] == box[WEST]; /* rounding has made a line of it */
    box[NORTH] += box[NORTH] == box[SOUTH];
    *place = (struct tin_place){.lattice = {.spacing_x = step}};
    return settle(placing, box, set_local, place, error);
}

static double longer_side(const struct placing *placing) {
    return fmax(placing->bounds[EAST] - placing->bounds[WEST], placing->bounds[NORTH] - placing->bounds[SOUTH]);
}

static double root_steps(double steps) {
    double root = TILE_CELLS;
    while (root < steps) root *= 2;
    return root;
}

/* The largest power of ten that all coordinates are multiples of, and that is fine enough; 0: places are rounded. */
static double find_power(const struct placing *placing, double distance) {
    const struct tin *tin = placing->tin;
    int most = (int)fmin(MOST_POWER, fmax(LEAST_POWER - 1, floor(log10(distance / COARSEST_SHARE))));
    size_t stride = sizeof *tin->points / sizeof tin->points->x;
    double x = tin_step_find(LEAST_POWER, most, &tin->points->x, tin->point_count, stride);
    double y = x > 0 ? tin_step_find(LEAST_POWER, most, &tin->points->y, tin->point_count, stride) : 0;
    double power = fmin(x, y);
    if (!(power > 0) || distance > FINEST_SHARE * power) return 0;
    return longer_side(placing) / power <= ROUNDED_FILLS * MOST_STEPS ? power : 0;
}

/* Steps that are the fewest parts of the power with which the root is well filled. */
static enum scree_status place_on_power(const struct placing *placing, double power, struct tin_place *place,
                                        struct scree_error *error) {
    double best_step = power, best_fills = 0;
    for (int parts = 1; parts <= MOST_PARTS; parts++) {
        double step = power / parts, steps = longer_side(placing) / step;
        if (steps > ROUNDED_FILLS * MOST_STEPS) break;
        if (steps < (WELL_FILLED - 1.0 / LEAST_CELLS) * root_steps(steps)) continue; /* no margins make up for it */
        enum scree_status status = place_local(placing, step, place, error);
        if (status != SCREE_OK) return status;
        double fills = fmax(place->window.columns, place->window.rows) / (double)lattice_tile_span(&place->lattice, 0);
        if (fills >= WELL_FILLED) return SCREE_OK;
        if (fills <= best_fills) continue;
        best_step = step;
        best_fills = fills;
    }
    return place_local(placing, best_step, place, error);
}

static enum scree_status choose_local(const struct placing *placing, struct tin_place *place,
                                      struct scree_error *error) {
    double distance = tin_mean_distance(placing->tin), power = find_power(placing, distance), root = TILE_CELLS;
    if (power > 0) return place_on_power(placing, power, place, error);
    while (root < MOST_STEPS && longer_side(placing) / (ROUNDED_FILLS * root) > distance / ROUNDED_SHARE) root *= 2;
    return place_local(placing, longer_side(placing) / (ROUNDED_FILLS * root), place, error);
}

static int64_t within(int64_t value, int64_t most) {
    return value < 0 ? 0 : value > most ? most : value;
}

/* place->lattice is whole. */
static enum scree_status set_geodetic(const struct placing *placing, const int64_t box[4], struct tin_place *place,
                                      struct scree_error *error) {
    int64_t last_column = place->lattice.columns - 1, last_row = place->lattice.rows - 1;
    int64_t west = within(box[WEST], last_column), south = within(box[SOUTH], last_row);
    (void)placing;
    (void)error;
    place->window = (struct lattice_window){.x = west,
                                            .y = south,
                                            .columns = (int32_t)(within(box[EAST], last_column) - west),
                                            .rows = (int32_t)(within(box[NORTH], last_row) - south)};
    return SCREE_OK;
}

/* Whole leaf tiles around the window; false: they have too many steps a side. */
static bool make_frame(struct tin_place *place) {
    struct tile_range range = lattice_tiles_touching(&place->lattice, place->leaf_zoom, place->window);
    int64_t span = place->tile_span;
    place->x = range.x_first * span;
    place->y = range.y_first * span;
    place->tiles_x = (int32_t)(range.x_last - range.x_first + 1);
    place->tiles_y = (int32_t)(range.y_last - range.y_first + 1);
    return place->tiles_x * span <= TIN_LATTICE_MOST_STEPS && place->tiles_y * span <= TIN_LATTICE_MOST_STEPS;
}

static enum scree_status choose_geodetic(const struct placing *placing, struct tin_place *place,
                                         struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    bool fits = false;
    for (int finest = MAX_ZOOM; !fits && status == SCREE_OK; finest--) {
        *place = (struct tin_place){.lattice = lattice_geodetic(finest)};
        const struct lattice *lattice = &place->lattice;
        if (longer_side(placing) / lattice->spacing_x > MOST_STEPS) continue;
        const int64_t box[4] = {
            tin_place_x(lattice, placing->bounds[WEST]), tin_place_y(lattice, placing->bounds[SOUTH]),
            tin_place_x(lattice, placing->bounds[EAST]), tin_place_y(lattice, placing->bounds[NORTH])};
        status = settle(placing, box, set_geodetic, place, error);
        fits = make_frame(place);
    }
    return status;
}

enum scree_status tin_place_choose(const struct tin *tin, const struct tin_place_options *options,
                                   struct tin_place *place, struct scree_error *error) {
    struct placing placing;
    enum scree_status status = begin(tin, options, &placing, error);
    if (status != SCREE_OK) return status;
    if (options->profile == PROFILE_GEODETIC) {
        status = choose_geodetic(&placing, place, error);
    } else {
        status = choose_local(&placing, place, error);
        if (status == SCREE_OK) make_frame(place); /* the root, whose sides have few enough steps */
    }
    scree_release(tin->memory, placing.counts);
    return status;
}

void tin_place_points(const struct tin *tin, const struct tin_place *place, struct tin_post *posts) {
    for (uint32_t i = 0; i < tin->point_count; i++)
        posts[i] = (struct tin_post){.x = (int32_t)(tin_place_x(&place->lattice, tin->points[i].x) - place->x),
                                     .y = (int32_t)(tin_place_y(&place->lattice, tin->points[i].y) - place->y),
                                     .height_m = (float)tin->points[i].z};
}
