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

static enum scree_status make_grid(struct scree_memory *memory, const struct method_tile *tile,
                                   struct method_mesh *grid, struct scree_error *error) {
    uint32_t across = (uint32_t)tile->columns + 1, up = (uint32_t)tile->rows + 1, at = 0;
    *grid = (struct method_mesh){.vertex_count = across * up, .triangle_count = 2 * (across - 1) * (up - 1)};
    grid->vertices = scree_allocate(memory, grid->vertex_count, sizeof *grid->vertices, "the posts", error);
    grid->corners = scree_allocate(memory, 3 * (size_t)grid->triangle_count, sizeof *grid->corners, "the posts", error);
    if (grid->vertices == NULL || grid->corners == NULL) return SCREE_E_MEMORY;
    for (uint32_t i = 0; i < grid->vertex_count; i++) {
        int32_t column = (int32_t)(i % across), row = (int32_t)(i / across);
        grid->vertices[i] = (struct method_vertex){(double)column * tile->cell_span, (double)row * tile->cell_span,
                                                   (double)method_post_m(tile, column, row)};
        if (column == tile->columns || row == tile->rows) continue;
        const uint32_t cell[6] = {i, i + 1, i + across + 1, i, i + across + 1, i + across};
        for (int k = 0; k < 6; k++) grid->corners[at++] = cell[k];
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
        status = scree_fail(error, SCREE_E_CORRUPT,
                            "its mesh does not cover the tile: %u triangles without area, %lld posts outside of all",
                            (unsigned)vertical.triangles_without_area,
                            (long long)(subject->grid.vertex_count - vertical.posts_covered));
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
