/* Where groups of rasters lie among the posts of a lattice, the crop of --te taken into account. */
#include "src/raster_parts_io.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#define SNAP            1e-6 /* steps: a border so near to a post lies on it */
#define LARGEST_REDUCED 4    /* source pixels a post that are left to the warp to average */
#define MAX_REDUCTION   1024

struct arc {
    int64_t first, count; /* posts; first is unwrapped */
};

static int64_t turn_of(const struct lattice *lattice) {
    return lattice->columns - 1;
}

static int64_t wrapped(int64_t x, int64_t turn) {
    int64_t rest = x % turn;
    return rest < 0 ? rest + turn : rest;
}

static struct arc arc_of(const struct lattice *lattice, double west_deg, double east_deg) {
    int64_t first = (int64_t)floor((west_deg - lattice->west) / lattice->spacing_x + SNAP);
    int64_t last = (int64_t)ceil((east_deg - lattice->west) / lattice->spacing_x - SNAP);
    int64_t count = last - first + 1, turn = turn_of(lattice);
    return (struct arc){first, count < turn ? count : turn};
}

static enum scree_status place_layer(const struct raster_group *group, const struct lattice *lattice,
                                     struct raster_layer *layer, struct scree_error *error) {
    struct arc arc = arc_of(lattice, group->west_deg, group->east_deg);
    if (group->is_around) { /* the group's mosaic holds two turns: take the middle */
        arc.first += group->geotransform[1] > 0 ? turn_of(lattice) / 2 : -turn_of(lattice) / 2;
        arc.count = turn_of(lattice);
    }
    int64_t south = (int64_t)floor((group->south_deg - lattice->south) / lattice->spacing_y + SNAP);
    int64_t north = (int64_t)ceil((group->north_deg - lattice->south) / lattice->spacing_y - SNAP);
    if (south < 0) south = 0;
    if (north > lattice->rows - 1) north = lattice->rows - 1;
    if (arc.count > INT_MAX || north - south >= INT_MAX)
        return scree_fail(error, SCREE_E_LIMIT, "zoom %d is too fine for data of this extent; lower --max-zoom",
                          lattice->finest_zoom);
    layer->x = arc.first;
    layer->y = south;
    layer->columns = (int)arc.count;
    layer->rows = north < south ? 0 : (int)(north - south + 1);
    if (layer->rows == 0) layer->columns = 0;
    double pixels = fmin(lattice->spacing_x, lattice->spacing_y) / group->spacing_deg;
    int reduction = (int)floor(fmin(pixels / (LARGEST_REDUCED / 2.0), MAX_REDUCTION));
    int shorter = group->columns < group->rows ? group->columns : group->rows;
    if (reduction > shorter) reduction = shorter;
    layer->reduction = reduction < 2 ? 1 : reduction;
    return SCREE_OK;
}

static int compare_arcs(const void *a, const void *b) {
    const struct arc *left = a, *right = b;
    if (left->first != right->first) return left->first < right->first ? -1 : 1;
    if (left->count != right->count) return left->count > right->count ? -1 : 1;
    return a < b ? -1 : 1;
}

/* The least arc of the globe that holds all layers, beginning in 0 .. turn - 1: what the largest gap leaves. */
static enum scree_status unite_columns(const struct raster *raster, struct raster_placement *placement,
                                       struct arc *united, struct scree_error *error) {
    int64_t turn = turn_of(&placement->lattice);
    struct arc *arcs = malloc((size_t)raster->group_count * sizeof *arcs);
    if (arcs == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory to place %d rasters", raster->group_count);
    int count = 0;
    for (int i = 0; i < raster->group_count; i++)
        if (placement->layers[i].columns > 0)
            arcs[count++] = (struct arc){wrapped(placement->layers[i].x, turn), placement->layers[i].columns};
    qsort(arcs, (size_t)count, sizeof *arcs, compare_arcs);
    *united = (struct arc){0, count > 0 ? turn : 0};
    int64_t reached = INT64_MIN, largest_gap = 0; /* the turn before leaves off where the last arc ends */
    for (int i = 0; i < count; i++)
        if (arcs[i].first + arcs[i].count - turn > reached) reached = arcs[i].first + arcs[i].count - turn;
    for (int i = 0; i < count; i++) {
        if (arcs[i].first - reached > largest_gap) {
            largest_gap = arcs[i].first - reached;
            *united = (struct arc){arcs[i].first, turn - largest_gap};
        }
        if (arcs[i].first + arcs[i].count > reached) reached = arcs[i].first + arcs[i].count;
    }
    free(arcs);
    return SCREE_OK;
}

/* Cuts columns to --te, which may itself pass the antimeridian. */
static struct arc crop_columns(const struct lattice *lattice, struct arc data, const double extent[4]) {
    int64_t turn = turn_of(lattice);
    double east_deg = extent[2] < extent[0] ? extent[2] + 360 : extent[2];
    int64_t first = (int64_t)ceil((extent[0] - lattice->west) / lattice->spacing_x - SNAP);
    int64_t last = (int64_t)floor((east_deg - lattice->west) / lattice->spacing_x + SNAP);
    struct arc crop = {wrapped(first, turn), last - first + 1};
    if (crop.count <= 0) return (struct arc){0, 0};
    if (crop.count >= turn) return data;
    if (data.count >= turn) return crop;
    struct arc pieces[2];
    int count = 0;
    for (int64_t shift = -turn; shift <= turn; shift += turn) {
        int64_t from = data.first > crop.first + shift ? data.first : crop.first + shift;
        int64_t to = data.first + data.count;
        if (crop.first + shift + crop.count < to) to = crop.first + shift + crop.count;
        if (from < to && count < 2) pieces[count++] = (struct arc){wrapped(from, turn), to - from};
    }
    if (count == 0) return (struct arc){0, 0};
    return count == 1 ? pieces[0] : crop; /* both ends of the crop meet data: between them lie voids */
}

static void crop_rows(const struct lattice *lattice, const double extent[4], int64_t *south, int64_t *north) {
    int64_t low = (int64_t)ceil((extent[1] - lattice->south) / lattice->spacing_y - SNAP);
    int64_t high = (int64_t)floor((extent[3] - lattice->south) / lattice->spacing_y + SNAP);
    if (low > *south) *south = low;
    if (high < *north) *north = high;
}

enum scree_status raster_placement_make(const struct raster *raster, const struct lattice *lattice,
                                        struct raster_placement *placement, struct scree_error *error) {
    *placement = (struct raster_placement){.lattice = *lattice};
    placement->layers = calloc((size_t)raster->group_count, sizeof *placement->layers);
    if (placement->layers == NULL)
        return scree_fail(error, SCREE_E_MEMORY, "no memory to place %d rasters", raster->group_count);
    if (lattice->profile == PROFILE_LOCAL) {
        placement->columns = (int)lattice->columns;
        placement->rows = (int)lattice->rows;
        placement->layers[0] = (struct raster_layer){0, 0, placement->columns, placement->rows, 1};
        return SCREE_OK;
    }
    int64_t south = INT64_MAX, north = INT64_MIN;
    for (int i = 0; i < raster->group_count; i++) {
        struct raster_layer *layer = &placement->layers[i];
        enum scree_status status = place_layer(&raster->groups[i], lattice, layer, error);
        if (status != SCREE_OK) return status;
        if (layer->columns == 0) continue;
        if (layer->y < south) south = layer->y;
        if (layer->y + layer->rows - 1 > north) north = layer->y + layer->rows - 1;
    }
    struct arc columns;
    enum scree_status status = unite_columns(raster, placement, &columns, error);
    if (status != SCREE_OK) return status;
    if (raster->options.has_extent && columns.count > 0) {
        columns = crop_columns(lattice, columns, raster->options.extent);
        crop_rows(lattice, raster->options.extent, &south, &north);
    }
    if (columns.count == 0 || north < south) return SCREE_OK;
    if (columns.count > INT_MAX)
        return scree_fail(error, SCREE_E_LIMIT, "zoom %d is too fine for data of this extent; lower --max-zoom",
                          lattice->finest_zoom);
    placement->x = columns.first;
    placement->y = south;
    placement->columns = (int)columns.count;
    placement->rows = (int)(north - south + 1);
    return SCREE_OK;
}
