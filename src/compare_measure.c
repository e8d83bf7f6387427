/* Measuring for scree compare: see the header. */
#include "src/compare_measure.h"

#include "lod/method_error.h"

#include <string.h>

/* ---- places ---- */

struct frame {
    struct vector3 origin;
    struct east_north_up axes;
};

static struct frame frame_of(const struct lattice *lattice, const struct lattice_window *window) {
    double middle_x = lattice_x(lattice, (double)window->x + window->columns / 2.0);
    double middle_y = lattice_y(lattice, (double)window->y + window->rows / 2.0);
    struct east_north_up axes = ellipsoid_frame(middle_x, middle_y);
    return (struct frame){ellipsoid_point(axes.up, 0), axes};
}

struct vector3 *compare_places_new(struct scree_memory *memory, const struct lattice *lattice, struct tile_id id,
                                   const struct method_mesh *mesh, struct scree_error *error) {
    struct lattice_window window = lattice_tile_window(lattice, id);
    struct frame frame = frame_of(lattice, &window);
    struct vector3 *places = scree_allocate(memory, mesh->vertex_count, sizeof *places, "a mesh in space", error);
    for (uint32_t i = 0; places != NULL && i < mesh->vertex_count; i++) {
        const struct method_vertex *v = &mesh->vertices[i];
        if (lattice->profile == PROFILE_LOCAL) {
            places[i] = (struct vector3){v->x * lattice->metres_x, v->y * lattice->metres_y, v->height_m};
            continue;
        }
        double lon_deg = lattice_x(lattice, (double)window.x + v->x);
        double lat_deg = lattice_y(lattice, (double)window.y + v->y);
        struct vector3 up = ellipsoid_frame(lon_deg, lat_deg).up;
        struct vector3 from_origin = vector3_minus(ellipsoid_point(up, v->height_m), frame.origin);
        places[i] =
            (struct vector3){vector3_dot(from_origin, frame.axes.east), vector3_dot(from_origin, frame.axes.north),
                             vector3_dot(from_origin, frame.axes.up)};
    }
    return places;
}

/* ---- the posts as a mesh ---- */

static void add_triangle(struct method_mesh *grid, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *corners = grid->corners + 3 * (size_t)grid->triangle_count++;
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
}

/* Border vertices lie between posts where the lattice is finer than the zoom; the methods have to take them. */
static bool lies_between(const struct method_tile *tile, const struct border_sample *vertex) {
    return vertex->position % tile->cell_span != 0;
}

/* A triangle whose edge a-b is on a border, from the line's post `cell` to the next one: a fan over the line's vertices
 * in between. `back`: a-b runs against the line. */
static void add_fan(const struct method_tile *tile, enum tile_side side, int32_t cell, uint32_t a, uint32_t b,
                    uint32_t apex, struct method_mesh *grid) {
    const struct border_line *line = tile->lines[side];
    bool back = side == SIDE_NORTH || side == SIDE_WEST;
    int32_t from = cell * tile->cell_span, to = from + tile->cell_span;
    int32_t first = border_before(line, from), last = border_before(line, to);
    for (int32_t i = back ? last : first; i >= first && i <= last; i += back ? -1 : 1) {
        const struct border_sample *vertex = &line->vertices[i];
        if (!lies_between(tile, vertex) || vertex->position < from || vertex->position > to) continue;
        double along = vertex->position;
        struct method_vertex *at = &grid->vertices[grid->vertex_count];
        *at = (struct method_vertex){along, along, (double)vertex->height_m};
        if (side == SIDE_SOUTH) at->y = 0;
        if (side == SIDE_NORTH) at->y = method_height(tile);
        if (side == SIDE_WEST) at->x = 0;
        if (side == SIDE_EAST) at->x = method_width(tile);
        add_triangle(grid, a, grid->vertex_count, apex);
        a = grid->vertex_count++;
    }
    add_triangle(grid, a, b, apex);
}

static bool is_on_border(const struct method_tile *tile, int32_t column, int32_t row, enum tile_side side) {
    return side == SIDE_SOUTH   ? row == 0
           : side == SIDE_EAST  ? column == tile->columns - 1
           : side == SIDE_NORTH ? row == tile->rows - 1
                                : column == 0;
}

/* The triangle of a cell that goes along its side `first` and then along the next one. */
static void add_half(const struct method_tile *tile, int32_t column, int32_t row, int first, struct method_mesh *grid) {
    uint32_t across = (uint32_t)tile->columns + 1, west = (uint32_t)row * across + (uint32_t)column;
    const uint32_t ring[SIDE_COUNT] = {west, west + 1, west + across + 1, west + across}; /* side i begins at i */
    for (int i = 0; i < 2; i++) {
        enum tile_side side = (enum tile_side)((first + i) % SIDE_COUNT);
        uint32_t a = ring[side], b = ring[(side + 1) % SIDE_COUNT],
                 apex = ring[(first + (i == 0 ? 2 : 0)) % SIDE_COUNT];
        if (!is_on_border(tile, column, row, side)) continue;
        add_fan(tile, side, side == SIDE_SOUTH || side == SIDE_NORTH ? column : row, a, b, apex, grid);
        return;
    }
    add_triangle(grid, ring[first], ring[(first + 1) % SIDE_COUNT], ring[(first + 2) % SIDE_COUNT]);
}

/* Two triangles a cell. The cells in the south-eastern and in the north-western corner are cut along the other
 * diagonal, so that no triangle has two sides on the border. */
static enum scree_status make_grid(struct scree_memory *memory, const struct method_tile *tile,
                                   struct method_mesh *grid, struct scree_error *error) {
    uint32_t across = (uint32_t)tile->columns + 1, up = (uint32_t)tile->rows + 1, between = 0;
    for (int side = 0; side < SIDE_COUNT; side++)
        for (int32_t i = 0; i < tile->lines[side]->vertex_count; i++)
            between += lies_between(tile, &tile->lines[side]->vertices[i]);
    size_t triangles = 2 * (size_t)tile->columns * (size_t)tile->rows + between;
    *grid = (struct method_mesh){.vertex_count = across * up};
    grid->vertices = scree_allocate(memory, (size_t)across * up + between, sizeof *grid->vertices, "the posts", error);
    grid->corners = scree_allocate(memory, 3 * triangles, sizeof *grid->corners, "the posts", error);
    if (grid->vertices == NULL || grid->corners == NULL) return SCREE_E_MEMORY;
    for (uint32_t i = 0; i < across * up; i++) {
        int32_t column = (int32_t)(i % across), row = (int32_t)(i / across);
        grid->vertices[i] = (struct method_vertex){(double)column * tile->cell_span, (double)row * tile->cell_span,
                                                   (double)method_post_m(tile, column, row)};
    }
    for (int32_t row = 0; row < tile->rows; row++)
        for (int32_t column = 0; column < tile->columns; column++) {
            bool is_east = column == tile->columns - 1, is_north = row == tile->rows - 1;
            int first = (is_east && row == 0) || (is_north && column == 0) ? SIDE_EAST : SIDE_SOUTH;
            add_half(tile, column, row, first, grid);
            add_half(tile, column, row, first + 2, grid);
        }
    return SCREE_OK;
}

static struct space_mesh in_space(const struct method_mesh *mesh, const struct vector3 *places) {
    return (struct space_mesh){mesh->vertex_count, mesh->triangle_count, places, mesh->corners};
}

enum scree_status compare_subject_make(struct scree_memory *memory, const struct lattice *lattice, struct tile_id id,
                                       const struct method_tile *tile, uint64_t seed, struct compare_subject *subject,
                                       struct scree_error *error) {
    *subject = (struct compare_subject){
        .lattice = lattice, .id = id, .tile = tile, .sampling = {HAUSDORFF_POINTS, HAUSDORFF_POINTS, seed}};
    enum scree_status status = make_grid(memory, tile, &subject->grid, error);
    if (status != SCREE_OK) goto cleanup;
    subject->grid_m = compare_places_new(memory, lattice, id, &subject->grid, error);
    if (subject->grid_m == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    struct space_mesh posts = in_space(&subject->grid, subject->grid_m);
    status = hausdorff_prepare(memory, &posts, &subject->sampling, &subject->posts, error);
cleanup:
    if (status != SCREE_OK) compare_subject_release(memory, subject);
    return status;
}

void compare_subject_release(struct scree_memory *memory, struct compare_subject *subject) {
    hausdorff_release(memory, &subject->posts);
    scree_release(memory, subject->grid_m);
    method_mesh_release(memory, &subject->grid);
    memset(subject, 0, sizeof *subject);
}

/* ---- a mesh ---- */

static enum scree_status measure_distance(struct scree_memory *memory, struct compare_subject *subject,
                                          const struct method_mesh *mesh, struct hausdorff *distance,
                                          struct scree_error *error) {
    struct hausdorff_surface surface = {0};
    enum scree_status status = SCREE_E_MEMORY;
    struct vector3 *places = compare_places_new(memory, subject->lattice, subject->id, mesh, error);
    if (places == NULL) goto cleanup;
    struct space_mesh placed = in_space(mesh, places);
    status = hausdorff_prepare(memory, &placed, &subject->sampling, &surface, error);
    if (status == SCREE_OK) *distance = hausdorff_measure(&subject->posts, &surface, NULL);
cleanup:
    hausdorff_release(memory, &surface);
    scree_release(memory, places);
    return status;
}

enum scree_status compare_measure(struct scree_memory *memory, struct compare_subject *subject,
                                  const struct method_mesh *mesh, struct compare_figures *figures,
                                  struct scree_error *error) {
    struct method_error vertical;
    enum scree_status status = method_error_measure(memory, subject->tile, mesh, &vertical, error);
    if (status == SCREE_OK && !vertical.covers)
        status = scree_fail(
            error, SCREE_E_CORRUPT,
            "its mesh does not cover the tile: %u triangles without area, %lld posts outside of all",
            (unsigned)vertical.triangles_without_area,
            (long long)((int64_t)(subject->tile->columns + 1) * (subject->tile->rows + 1) - vertical.posts_covered));
    if (status == SCREE_OK) status = measure_distance(memory, subject, mesh, &figures->distance, error);
    if (status != SCREE_OK) return status;
    figures->id = subject->id;
    figures->vertices = mesh->vertex_count;
    figures->triangles = mesh->triangle_count;
    figures->max_error_m = vertical.max_m;
    figures->sum_squares_m2 = vertical.sum_squares_m2;
    figures->posts = vertical.posts_covered;
    return SCREE_OK;
}
