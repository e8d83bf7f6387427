#include "lod/tin_lattice.h"

#include <stdbool.h>

void tin_lattice_release(struct tin_lattice *lattice) {
    if (lattice->memory == NULL) return;
    scree_release(lattice->memory, lattice->points);
    scree_release(lattice->memory, lattice->corners);
    scree_release(lattice->memory, lattice->first);
    scree_release(lattice->memory, lattice->triangles);
    *lattice = (struct tin_lattice){0};
}

/* ---- slopes ---- */

/* Twice the triangle's area in steps, and twice its volume's growth along x and y: area times slope. */
struct leaning {
    double area, along_x, along_y;
};

static struct leaning lean(const struct tin_post *a, const struct tin_post *b, const struct tin_post *c) {
    double bx = (double)b->x - a->x, by = (double)b->y - a->y, bz = (double)b->height_m - a->height_m;
    double cx = (double)c->x - a->x, cy = (double)c->y - a->y, cz = (double)c->height_m - a->height_m;
    return (struct leaning){bx * cy - by * cx, bz * cy - cz * by, cz * bx - bz * cx};
}

static enum scree_status give_slopes(struct tin_lattice *lattice,
                                     void (*steps_m)(const void *context, int32_t y, double *east_m, double *north_m),
                                     const void *context, struct scree_error *error) {
    struct leaning *sums =
        scree_allocate(lattice->memory, lattice->point_count, sizeof *sums, "the slopes of a TIN", error);
    if (sums == NULL) return error->status;
    for (uint32_t t = 0; t < lattice->triangle_count; t++) {
        const uint32_t *corner = lattice->corners + 3 * (size_t)t;
        struct leaning own =
            lean(&lattice->points[corner[0]], &lattice->points[corner[1]], &lattice->points[corner[2]]);
        for (int k = 0; k < 3 && own.area > 0; k++) {
            sums[corner[k]].area += own.area;
            sums[corner[k]].along_x += own.along_x;
            sums[corner[k]].along_y += own.along_y;
        }
    }
    for (uint32_t p = 0; p < lattice->point_count; p++) {
        double east_m, north_m;
        if (!(sums[p].area > 0)) continue;
        steps_m(context, lattice->points[p].y, &east_m, &north_m);
        lattice->points[p].slope = (struct slope){(float)(sums[p].along_x / (sums[p].area * east_m)),
                                                  (float)(sums[p].along_y / (sums[p].area * north_m))};
    }
    scree_release(lattice->memory, sums);
    return SCREE_OK;
}

/* ---- tiles ---- */

struct tile_range {
    int32_t x_first, y_first, x_last, y_last;
};

/* The tile of a position on a tile's west or south side counts, and the one before it, which it touches too. */
static int32_t tile_at(int64_t position, int32_t span, int32_t tiles) {
    int64_t tile = position < 0 ? 0 : position / span;
    return (int32_t)(tile < tiles ? tile : tiles - 1);
}

static struct tile_range tiles_of(const struct tin_lattice *lattice, uint32_t triangle) {
    const struct tin_post *first = &lattice->points[lattice->corners[3 * (size_t)triangle]];
    int64_t west = first->x, east = first->x, south = first->y, north = first->y;
    int64_t margin = 2 * (int64_t)lattice->wall_steps;
    for (size_t k = 1; k < 3; k++) {
        const struct tin_post *corner = &lattice->points[lattice->corners[3 * (size_t)triangle + k]];
        if (corner->x < west) west = corner->x;
        if (corner->x > east) east = corner->x;
        if (corner->y < south) south = corner->y;
        if (corner->y > north) north = corner->y;
    }
    return (struct tile_range){tile_at(west - margin - 1, lattice->tile_span, lattice->tiles_x),
                               tile_at(south - margin - 1, lattice->tile_span, lattice->tiles_y),
                               tile_at(east + margin, lattice->tile_span, lattice->tiles_x),
                               tile_at(north + margin, lattice->tile_span, lattice->tiles_y)};
}

/* Counts, or once `first` tells where tiles begin, puts the triangles in; `first` moves on by what was put in. */
static uint64_t visit_tiles(struct tin_lattice *lattice, bool puts) {
    uint64_t count = 0;
    for (uint32_t t = 0; t < lattice->triangle_count; t++) {
        struct tile_range range = tiles_of(lattice, t);
        for (int32_t y = range.y_first; y <= range.y_last; y++)
            for (int32_t x = range.x_first; x <= range.x_last; x++, count++) {
                uint32_t *next = &lattice->first[(size_t)y * (size_t)lattice->tiles_x + (size_t)x];
                if (puts) lattice->triangles[*next] = t;
                ++*next;
            }
    }
    return count;
}

static enum scree_status sort_into_tiles(struct tin_lattice *lattice, struct scree_error *error) {
    size_t tiles = (size_t)lattice->tiles_x * (size_t)lattice->tiles_y;
    lattice->first = scree_allocate(lattice->memory, tiles + 1, sizeof *lattice->first, "a TIN's tiles", error);
    if (lattice->first == NULL) return error->status;
    uint64_t members = visit_tiles(lattice, false);
    if (members > UINT32_MAX)
        return scree_fail(error, SCREE_E_LIMIT, "its triangles reach over too many tiles; name a larger --block");
    lattice->triangles =
        scree_allocate(lattice->memory, (size_t)members, sizeof *lattice->triangles, "the triangles of tiles", error);
    if (lattice->triangles == NULL) return error->status;
    uint32_t begin = 0;
    for (size_t tile = 0; tile < tiles; tile++) {
        uint32_t count = lattice->first[tile];
        lattice->first[tile] = begin;
        begin += count;
    }
    visit_tiles(lattice, true);
    for (size_t tile = tiles; tile > 0; tile--) lattice->first[tile] = lattice->first[tile - 1];
    lattice->first[0] = 0;
    return SCREE_OK;
}

enum scree_status tin_lattice_finish(struct tin_lattice *lattice,
                                     void (*steps_m)(const void *context, int32_t y, double *east_m, double *north_m),
                                     const void *context, struct scree_error *error) {
    enum scree_status status = give_slopes(lattice, steps_m, context, error);
    return status == SCREE_OK ? sort_into_tiles(lattice, error) : status;
}
