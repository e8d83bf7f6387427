/* A tile out of a TIN: its piece of the TIN as mesh, border lines, samples and slopes. */
#include "lod/tile_parts.h"
#include "lod/tile_samples.h"

#include <math.h>

/* ---- the mesh ---- */

static enum scree_status use_mesh(struct tile *tile, const struct tin_piece *piece, struct scree_error *error) {
    const struct constrained *source = &piece->mesh;
    int32_t triangles = 0;
    for (uint32_t t = 0; t < source->triangle_count; t++)
        triangles += source->triangles[t].corner[0] != CONSTRAINED_NONE;
    enum scree_status status = mesh_allocate(tile->memory, (int32_t)source->point_count, triangles, &tile->mesh, error);
    if (status != SCREE_OK) return status;
    struct mesh *mesh = &tile->mesh;
    for (uint32_t p = 0; p < source->point_count; p++) {
        mesh->vertices[p].at = (struct sample){source->points[p].x, source->points[p].y, 0};
        mesh->heights[p] = tile_height_units(tile, piece->posts[p].height_m);
    }
    mesh->vertex_count = (int32_t)source->point_count;
    for (uint32_t t = 0; t < source->triangle_count; t++) {
        const uint32_t *corner = source->triangles[t].corner;
        if (corner[0] == CONSTRAINED_NONE) continue;
        for (int k = 0; k < 3; k++) mesh->triangles[mesh->triangle_count].vertex[k] = (int32_t)corner[k];
        mesh->triangle_count++;
    }
    tile_place_vertices(tile);
    return mesh_connect(tile->memory, mesh, error);
}

/* ---- border lines ---- */

static int32_t position_on(enum tile_side side, const struct tin_post *post) {
    return side == SIDE_SOUTH || side == SIDE_NORTH ? post->x : post->y;
}

static void add_sample(struct border_line *line, enum tile_side side, const struct tin_post *post) {
    line->samples[line->sample_count++] = (struct border_sample){position_on(side, post), post->height_m};
}

/* The lowest and the highest post of each cell, where all of them are too many. */
static void sample_extremes(struct border_line *line, enum tile_side side, const struct tin_side *posts,
                            int32_t cell_span) {
    for (uint32_t from = 0, to; from < posts->count; from = to) {
        uint32_t low = from, high = from;
        int32_t cell = position_on(side, &posts->posts[from]) / cell_span;
        for (to = from + 1; to < posts->count && position_on(side, &posts->posts[to]) / cell_span == cell; to++) {
            if (posts->posts[to].height_m < posts->posts[low].height_m) low = to;
            if (posts->posts[to].height_m > posts->posts[high].height_m) high = to;
        }
        add_sample(line, side, &posts->posts[low < high ? low : high]);
        if (low != high) add_sample(line, side, &posts->posts[low < high ? high : low]);
    }
}

static void use_side(struct tile *tile, enum tile_side side, const struct tin_side *posts) {
    struct border_line *line = &tile->lines[side];
    line->curvature_m = tile->geometry.side_drop_m[side];
    line->vertex_count = (int32_t)posts->count;
    line->sample_count = 0;
    for (uint32_t i = 0; i < posts->count; i++) {
        const struct tin_post *post = &posts->posts[i];
        int32_t units = tile_height_units(tile, post->height_m);
        line->vertices[i] =
            (struct border_sample){position_on(side, post), (float)(units * tile->geometry.height_unit_m)};
        if (posts->count <= BORDER_MAX_SAMPLES) add_sample(line, side, post);
    }
    if (posts->count > BORDER_MAX_SAMPLES) sample_extremes(line, side, posts, tile->geometry.cell_span);
}

/* ---- heights and slopes at regular places ---- */

/* Places `span` steps apart; the last ones no farther than the tile's end. */
struct places {
    int32_t first, span;
    int32_t columns, rows;
    int32_t right, top;
};

static int32_t place(int32_t first, int32_t span, int32_t index, int32_t end) {
    int64_t at = first + (int64_t)span * index;
    return (int32_t)(at < end ? at : end);
}

/* A triangle of the piece while its places are visited. */
struct facet {
    const struct tin_post *corners[3];
    double area;
};

static int64_t area2(const struct tin_post *a, const struct tin_post *b, int32_t x, int32_t y) {
    return ((int64_t)b->x - a->x) * ((int64_t)y - a->y) - ((int64_t)b->y - a->y) * ((int64_t)x - a->x);
}

/* The corners' weights at a place; false when it is outside. */
static bool weigh(const struct facet *facet, int32_t x, int32_t y, double weights[3]) {
    for (int k = 0; k < 3; k++) {
        int64_t share = area2(facet->corners[(k + 1) % 3], facet->corners[(k + 2) % 3], x, y);
        if (share < 0) return false;
        weights[k] = (double)share / facet->area;
    }
    return true;
}

static int32_t index_from(int32_t position, const struct places *places) {
    return position <= places->first ? 0 : (int32_t)(((int64_t)position - places->first) / places->span);
}

/* Visits all places in or on the triangle. */
static void visit(const struct facet *facet, const struct places *places,
                  void (*take)(void *context, int64_t index, const struct facet *facet, const double weights[3]),
                  void *context) {
    const struct tin_post *a = facet->corners[0], *b = facet->corners[1], *c = facet->corners[2];
    int32_t west = a->x < b->x ? a->x : b->x, east = a->x > b->x ? a->x : b->x;
    int32_t south = a->y < b->y ? a->y : b->y, north = a->y > b->y ? a->y : b->y;
    if (c->x < west) west = c->x;
    if (c->x > east) east = c->x;
    if (c->y < south) south = c->y;
    if (c->y > north) north = c->y;
    for (int32_t row = index_from(south, places); row < places->rows; row++) {
        int32_t y = place(places->first, places->span, row, places->top);
        if (y > north) break;
        for (int32_t column = index_from(west, places); column < places->columns; column++) {
            int32_t x = place(places->first, places->span, column, places->right);
            double weights[3];
            if (x > east) break;
            if (weigh(facet, x, y, weights)) take(context, (int64_t)row * places->columns + column, facet, weights);
        }
    }
}

static void visit_all(const struct tin_piece *piece, const struct places *places,
                      void (*take)(void *context, int64_t index, const struct facet *facet, const double weights[3]),
                      void *context) {
    for (uint32_t t = 0; t < piece->mesh.triangle_count; t++) {
        const uint32_t *corner = piece->mesh.triangles[t].corner;
        if (corner[0] == CONSTRAINED_NONE) continue;
        struct facet facet = {{&piece->posts[corner[0]], &piece->posts[corner[1]], &piece->posts[corner[2]]}, 0};
        facet.area = (double)area2(facet.corners[0], facet.corners[1], facet.corners[2]->x, facet.corners[2]->y);
        visit(&facet, places, take, context);
    }
}

/* ---- samples ---- */

static int64_t cell_of(const struct samples *samples, int32_t x, int32_t y) {
    int32_t column = x / samples->cell_span, row = y / samples->cell_span;
    if (column == samples->columns) column--;
    if (row == samples->rows) row--;
    return (int64_t)row * samples->columns + column;
}

struct centres {
    const uint32_t *counts; /* points in each cell */
    struct sample *heights; /* of each cell's centre */
    struct places places;
};

static void take_centre(void *context, int64_t index, const struct facet *facet, const double weights[3]) {
    struct centres *centres = context;
    if (centres->counts[index] > 0) return;
    const struct places *places = &centres->places;
    double height_m = 0;
    for (int k = 0; k < 3; k++) height_m += weights[k] * facet->corners[k]->height_m;
    centres->heights[index] = (struct sample){
        place(places->first, places->span, (int32_t)(index % places->columns), places->right),
        place(places->first, places->span, (int32_t)(index / places->columns), places->top), (float)height_m};
}

/* All points of the piece, and the centre of each cell that has none. */
static enum scree_status use_samples(struct tile *tile, const struct tin_piece *piece, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    tile->samples = tile_own_samples(tile);
    int64_t cells = (int64_t)tile->samples.columns * tile->samples.rows;
    uint32_t *counts = scree_allocate(tile->memory, (size_t)cells, sizeof *counts, "a tile's samples", error);
    struct sample *centre = scree_allocate(tile->memory, (size_t)cells, sizeof *centre, "a tile's samples", error);
    tile->cell_first =
        scree_allocate(tile->memory, (size_t)cells + 1, sizeof *tile->cell_first, "a tile's samples", error);
    tile->extremes = scree_allocate(tile->memory, (size_t)cells + piece->mesh.point_count, sizeof *tile->extremes,
                                    "a tile's samples", error);
    enum scree_status status = SCREE_E_MEMORY;
    if (counts == NULL || centre == NULL || tile->cell_first == NULL || tile->extremes == NULL) goto cleanup;
    for (uint32_t p = 0; p < piece->mesh.point_count; p++)
        counts[cell_of(&tile->samples, piece->posts[p].x, piece->posts[p].y)]++;
    struct centres centres = {.counts = counts,
                              .heights = centre,
                              .places = {geometry->cell_span / 2, geometry->cell_span, tile->samples.columns,
                                         tile->samples.rows, geometry->columns, geometry->rows}};
    visit_all(piece, &centres.places, take_centre, &centres);
    uint32_t at = 0;
    for (int64_t cell = 0; cell < cells; cell++) {
        tile->cell_first[cell] = at;
        if (counts[cell] == 0) tile->extremes[at] = centre[cell];
        at += counts[cell] > 0 ? counts[cell] : 1;
        counts[cell] = tile->cell_first[cell]; /* where its next point goes */
    }
    tile->cell_first[cells] = at;
    for (uint32_t p = 0; p < piece->mesh.point_count; p++) {
        const struct tin_post *post = &piece->posts[p];
        tile->extremes[counts[cell_of(&tile->samples, post->x, post->y)]++] =
            (struct sample){post->x, post->y, post->height_m};
    }
    tile->samples.extremes = tile->extremes;
    tile->samples.cell_first = tile->cell_first;
    status = SCREE_OK;
cleanup:
    scree_release(tile->memory, centre);
    scree_release(tile->memory, counts);
    return status;
}

/* ---- slopes ---- */

static void take_slope(void *context, int64_t index, const struct facet *facet, const double weights[3]) {
    struct slope_grid *grid = context;
    double east = 0, north = 0;
    for (int k = 0; k < 3; k++) {
        east += weights[k] * facet->corners[k]->slope.east;
        north += weights[k] * facet->corners[k]->slope.north;
    }
    grid->nodes[index] = (struct slope){(float)east, (float)north};
}

/* Along a side by its posts alone, so that both of its tiles have the same. */
static void take_side(struct slope_grid *grid, enum tile_side side, const struct tin_side *posts, int32_t far) {
    bool is_level = side == SIDE_SOUTH || side == SIDE_NORTH;
    int32_t nodes = is_level ? grid->columns : grid->rows, last = is_level ? grid->rows - 1 : grid->columns - 1;
    if (far > 0 && far != last * grid->node_span) return; /* the lattice ends between two nodes */
    int32_t other = far > 0 ? last : 0;
    uint32_t before = 0;
    for (int32_t node = 0; node < nodes; node++) {
        int32_t at = node * grid->node_span;
        while (before + 2 < posts->count && position_on(side, &posts->posts[before + 1]) <= at) before++;
        const struct tin_post *a = &posts->posts[before], *b = a + 1;
        double length = (double)position_on(side, b) - position_on(side, a);
        double share = ((double)at - position_on(side, a)) / length;
        grid->nodes[is_level ? (int64_t)other * grid->columns + node : (int64_t)node * grid->columns + other] =
            (struct slope){(float)(a->slope.east + share * ((double)b->slope.east - a->slope.east)),
                           (float)(a->slope.north + share * ((double)b->slope.north - a->slope.north))};
    }
}

static enum scree_status use_slopes(struct tile *tile, const struct tin_piece *piece, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    struct slope_grid *grid = &tile->slopes;
    enum scree_status status =
        slope_grid_allocate(tile->memory, geometry->columns / geometry->cell_span + 1,
                            geometry->rows / geometry->cell_span + 1, geometry->cell_span, grid, error);
    if (status != SCREE_OK) return status;
    const struct places nodes = {0, geometry->cell_span, grid->columns, grid->rows, geometry->columns, geometry->rows};
    visit_all(piece, &nodes, take_slope, grid);
    take_side(grid, SIDE_SOUTH, &piece->sides[SIDE_SOUTH], 0);
    take_side(grid, SIDE_WEST, &piece->sides[SIDE_WEST], 0);
    take_side(grid, SIDE_NORTH, &piece->sides[SIDE_NORTH], geometry->rows);
    take_side(grid, SIDE_EAST, &piece->sides[SIDE_EAST], geometry->columns);
    return SCREE_OK;
}

enum scree_status tile_from_tin(struct scree_memory *memory, const struct tile_geometry *geometry,
                                const struct tin_piece *piece, struct tile *tile, struct scree_error *error) {
    enum scree_status status;
    if ((status = tile_begin(memory, geometry, tile, error)) != SCREE_OK) return status;
    if ((status = use_mesh(tile, piece, error)) != SCREE_OK) goto failed;
    for (int side = 0; side < SIDE_COUNT; side++) use_side(tile, (enum tile_side)side, &piece->sides[side]);
    if ((status = use_samples(tile, piece, error)) != SCREE_OK) goto failed;
    if ((status = use_slopes(tile, piece, error)) != SCREE_OK) goto failed;
    if ((status = tile_begin_rest(tile, error)) != SCREE_OK) goto failed;
    if (!geometry->keeps_cells) tile_samples_leave_pairs(tile);
    tile_hand_up_slopes(tile);
    mesh_measure(&tile->mesh, &tile->samples);
    if ((status = tile_begin_simplifier(tile, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    tile_release(tile);
    return status;
}
