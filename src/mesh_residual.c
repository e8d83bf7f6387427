#include "src/mesh_residual.h"

#include "lod/position_code.h"
#include "src/verify_tile.h"

#include <math.h>
#include <string.h>

#define MANTISSA_REST (52 - 6) /* bits of a double's mantissa that a bin does not look at: 2^6 bins an octave */
#define FIRST_BIN     ((1023 - 24) << 6) /* everything below 2^-24 m is in the first bin */

/* A linear function of lattice steps from the tile's south-western corner. */
struct linear {
    double constant, by_x, by_y;
};

/* What the scan of one tile needs. */
struct scan {
    const struct lattice *lattice;
    const struct post_block *block;
    struct residuals *residuals;
    int64_t tile_x, tile_y; /* lattice steps */
    double right, top;      /* of its window: lattice steps from its corner */
    bool with_east, with_north;
};

/* Through three values at the corners of a triangle of positive area. */
static struct linear through(const struct residual_corner corners[3], const double values[3]) {
    double x1 = corners[1].x - corners[0].x, y1 = corners[1].y - corners[0].y;
    double x2 = corners[2].x - corners[0].x, y2 = corners[2].y - corners[0].y;
    double d1 = values[1] - values[0], d2 = values[2] - values[0];
    double area = x1 * y2 - x2 * y1;
    struct linear linear = {.by_x = (d1 * y2 - d2 * y1) / area, .by_y = (d2 * x1 - d1 * x2) / area};
    linear.constant = values[0] - linear.by_x * corners[0].x - linear.by_y * corners[0].y;
    return linear;
}

/* An octave's bins are the first bits of a double: its exponent and as much of its mantissa as is wanted. */
static int bin_of(double size_m) {
    uint64_t bits;
    memcpy(&bits, &size_m, sizeof bits);
    int64_t bin = (int64_t)(bits >> MANTISSA_REST) - FIRST_BIN;
    return bin < 0 ? 0 : bin < RESIDUAL_BINS ? (int)bin : RESIDUAL_BINS - 1;
}

/* The upper end of a bin. */
static double bin_top(int bin) {
    uint64_t bits = (uint64_t)(bin + 1 + FIRST_BIN) << MANTISSA_REST;
    double size_m;
    memcpy(&size_m, &bits, sizeof size_m);
    return size_m;
}

void residual_add(struct residual *residual, double difference_m, int64_t x, int64_t y) {
    double size_m = fabs(difference_m);
    residual->sum_m += difference_m;
    residual->sum_squares_m2 += difference_m * difference_m;
    residual->bins[bin_of(size_m)]++;
    if (size_m > residual->max_m) {
        residual->max_m = size_m;
        residual->max_x = x;
        residual->max_y = y;
    }
}

/* Where an edge crosses a row. Always computed from its lower end, so that both of its triangles agree to the bit. */
static double crossing(const struct residual_corner *a, const struct residual_corner *b, double y) {
    const struct residual_corner *low = a->y < b->y ? a : b, *high = a->y < b->y ? b : a;
    if (y == high->y) return high->x;
    return low->x + (y - low->y) * (high->x - low->x) / (high->y - low->y);
}

/* The two crossings of a row with a triangle's edges; edges count from their lower end (inclusive) to their upper one
 * (exclusive), or the other way round for the northernmost row of all. `on_border`: one of them runs along the eastern
 * border. False: the row passes the triangle by. */
static bool cross(const struct residual_corner corners[3], double y, bool from_below, double border, double *left,
                  double *right, bool *on_border) {
    int found = 0;
    *on_border = false;
    double at[3];
    for (int k = 0; k < 3; k++) {
        const struct residual_corner *a = &corners[k], *b = &corners[(k + 1) % 3];
        double low = fmin(a->y, b->y), high = fmax(a->y, b->y);
        bool meets = from_below ? low < y && y <= high : low <= y && y < high;
        if (!meets) continue;
        at[found++] = crossing(a, b, y);
        if (a->x == border && b->x == border) *on_border = true;
    }
    if (found != 2) return false;
    *left = fmin(at[0], at[1]);
    *right = fmax(at[0], at[1]);
    return true;
}

/* The posts of one row from left (inclusive) to right (exclusive, unless `with_last`). */
static void scan_row(const struct scan *scan, int64_t row, double left, double right, bool with_last,
                     const struct linear *height, const struct linear *lifted, double east_factor, double centre_x,
                     double north_part) {
    const struct post_block *block = scan->block;
    int64_t first = (int64_t)ceil(left), end = (int64_t)ceil(right);
    if (with_last) end++;
    if (first < block->x - scan->tile_x) first = block->x - scan->tile_x;
    if (end > block->x - scan->tile_x + block->columns) end = block->x - scan->tile_x + block->columns;
    if (first >= end) return;
    int64_t lattice_y = scan->tile_y + row;
    const float *posts = block->heights_m + (lattice_y - block->y) * block->columns + (scan->tile_x - block->x);
    for (int64_t x = first; x < end; x++) {
        double post_m = posts[x], offset = (double)x - centre_x;
        double q = east_factor * offset * offset + north_part;
        double height_m = height->constant + height->by_y * (double)row + height->by_x * (double)x;
        double lifted_m = lifted->constant + lifted->by_y * (double)row + lifted->by_x * (double)x;
        residual_add(&scan->residuals->height, post_m - height_m, scan->tile_x + x, lattice_y);
        residual_add(&scan->residuals->drawn, post_m - q - lifted_m, scan->tile_x + x, lattice_y);
    }
    scan->residuals->posts += (uint64_t)(end - first);
}

static void scan_triangle(const struct scan *scan, const struct residual_corner corners[3]) {
    const struct post_block *block = scan->block;
    double low = fmin(corners[0].y, fmin(corners[1].y, corners[2].y));
    double high = fmax(corners[0].y, fmax(corners[1].y, corners[2].y));
    double west = fmin(corners[0].x, fmin(corners[1].x, corners[2].x));
    double east = fmax(corners[0].x, fmax(corners[1].x, corners[2].x));
    int64_t first = (int64_t)ceil(low), last = (int64_t)floor(high);
    int64_t block_x = block->x - scan->tile_x, block_y = block->y - scan->tile_y;
    if (east < (double)block_x || west > (double)(block_x + block->columns)) return;
    if (first < block_y) first = block_y;
    if (last > block_y + block->rows - 1) last = block_y + block->rows - 1;
    if (first > last) return;

    double centre_x = (corners[0].x + corners[1].x + corners[2].x) / 3;
    double centre_y = (corners[0].y + corners[1].y + corners[2].y) / 3;
    double factor_x = lattice_parallel_drop_m(scan->lattice, (double)scan->tile_y + centre_y);
    double factor_y = lattice_meridian_drop_m(scan->lattice);
    double heights[3], lifted[3];
    for (int k = 0; k < 3; k++) {
        double x = corners[k].x - centre_x, y = corners[k].y - centre_y;
        heights[k] = corners[k].height_m;
        lifted[k] = corners[k].height_m - factor_x * x * x - factor_y * y * y;
    }
    struct linear height_plane = through(corners, heights), lifted_plane = through(corners, lifted);
    for (int64_t row = first; row <= last; row++) {
        double left, right, offset = (double)row - centre_y;
        bool is_top = (double)row == scan->top, on_border;
        if (is_top && !scan->with_north) continue;
        if (!cross(corners, (double)row, is_top, scan->right, &left, &right, &on_border)) continue;
        scan_row(scan, row, left, right, scan->with_east && on_border, &height_plane, &lifted_plane, factor_x, centre_x,
                 factor_y * offset * offset);
    }
}

/* A code as lattice steps: the post that it names, if it names one and there are no more posts than codes. */
static double position_steps(uint32_t code, int64_t span) {
    double steps = code * (double)span / DECODED_TOP, post = floor(steps + 0.5);
    return span <= DECODED_TOP && position_code((int64_t)post, span) == (int32_t)code ? post : steps;
}

static struct scan scan_of(const struct lattice *lattice, struct tile_id id, const struct post_block *block,
                           bool with_east, bool with_north, struct residuals *residuals) {
    struct lattice_window window = lattice_tile_window(lattice, id);
    return (struct scan){.lattice = lattice,
                         .block = block,
                         .residuals = residuals,
                         .tile_x = window.x,
                         .tile_y = window.y,
                         .right = window.columns,
                         .top = window.rows,
                         .with_east = with_east,
                         .with_north = with_north};
}

/* Triangles without a positive area lie over no posts. */
static void scan_corners(const struct scan *scan, const struct residual_corner corners[3]) {
    double area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                  (corners[2].x - corners[0].x) * (corners[1].y - corners[0].y);
    if (area > 0) scan_triangle(scan, corners);
}

static struct residual_corner place_of(const struct tile_frame *frame, const struct lattice_window *window,
                                       int64_t span, const struct decoded_tile *tile, uint32_t vertex) {
    double x = position_steps(tile->u[vertex], span), y = position_steps(tile->v[vertex], span);
    if (tile->u[vertex] == frame->right) x = window->columns; /* where the lattice cuts a tile it ends at a post, */
    if (tile->v[vertex] == frame->top) y = window->rows;      /* whose code is rounded */
    return (struct residual_corner){x, y, decoded_height_m(tile, vertex)};
}

void residual_tile_places(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                          struct residual_corner *places) {
    struct tile_frame frame = tile_frame_of(lattice, id, true);
    struct lattice_window window = lattice_tile_window(lattice, id);
    for (uint32_t i = 0; i < tile->vertex_count; i++)
        places[i] = place_of(&frame, &window, lattice_tile_span(lattice, id.zoom), tile, i);
}

void residual_mesh_corners(const struct post_mesh *mesh, uint32_t triangle, struct residual_corner corners[3]) {
    for (int k = 0; k < 3; k++) {
        const struct scree_vertex *vertex = &mesh->vertices[mesh->corners[3 * (size_t)triangle + (size_t)k]];
        corners[k] = (struct residual_corner){vertex->x, vertex->y, vertex->height * mesh->height_unit_m};
    }
}

void residuals_add(const struct lattice *lattice, struct tile_id id, const struct decoded_tile *tile,
                   const struct post_block *block, bool with_east, bool with_north, struct residuals *residuals) {
    struct tile_frame frame = tile_frame_of(lattice, id, true);
    struct lattice_window window = lattice_tile_window(lattice, id);
    struct scan scan = scan_of(lattice, id, block, with_east, with_north, residuals);
    for (uint32_t t = 0; t < tile->triangle_count; t++) {
        struct residual_corner corners[3];
        for (size_t k = 0; k < 3; k++)
            corners[k] =
                place_of(&frame, &window, lattice_tile_span(lattice, id.zoom), tile, tile->corners[3 * (size_t)t + k]);
        scan_corners(&scan, corners);
    }
}

void residuals_add_posts(const struct lattice *lattice, struct tile_id id, const struct post_mesh *mesh,
                         const struct post_block *block, bool with_east, bool with_north, struct residuals *residuals) {
    struct scan scan = scan_of(lattice, id, block, with_east, with_north, residuals);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        struct residual_corner corners[3];
        residual_mesh_corners(mesh, t, corners);
        scan_corners(&scan, corners);
    }
}

double residual_mean_m(const struct residual *residual, uint64_t posts) {
    return posts == 0 ? 0 : residual->sum_m / (double)posts;
}

double residual_rms_m(const struct residual *residual, uint64_t posts) {
    return posts == 0 ? 0 : sqrt(residual->sum_squares_m2 / (double)posts);
}

double residual_quantile_m(const struct residual *residual, uint64_t posts, double share) {
    uint64_t wanted = (uint64_t)ceil(share * (double)posts), below = 0;
    for (int bin = 0; bin < RESIDUAL_BINS; bin++) {
        below += residual->bins[bin];
        if (below >= wanted) return fmin(bin_top(bin), residual->max_m);
    }
    return residual->max_m;
}
