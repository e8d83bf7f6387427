#include "src/remesh.h"

#include <math.h>
#include <string.h>

#define EQUATOR_M      6378137.0 /* raster_summary counts angles along it */
#define LONGEST_UNIT_M 50000.0   /* no unit of length is so long, all angles are longer */

static bool has_angles(double metres_per_unit) {
    return metres_per_unit > LONGEST_UNIT_M;
}

struct lattice remesh_lattice(const struct lattice *local, double metres_per_unit) {
    struct lattice lattice = *local;
    if (!has_angles(metres_per_unit)) return lattice;
    double degrees = metres_per_unit / EQUATOR_M * 180 / acos(-1.0);
    if (fabs(degrees - 1) < 1e-9) degrees = 1;
    lattice.profile = PROFILE_GEODETIC;
    lattice.west *= degrees;
    lattice.south *= degrees;
    lattice.spacing_x *= degrees;
    lattice.spacing_y *= degrees;
    return lattice;
}

struct curvature_posts remesh_posts(const struct lattice *lattice, const float *heights_m) {
    const double middle = (double)(lattice->rows - 1) / 2;
    struct curvature_posts posts = {.heights_m = heights_m,
                                    .columns = (int32_t)lattice->columns,
                                    .rows = (int32_t)lattice->rows,
                                    .stride = (int32_t)lattice->columns,
                                    .east_drop_m = lattice_parallel_drop_m(lattice, middle),
                                    .north_drop_m = lattice_meridian_drop_m(lattice)};
    lattice_steps_m(lattice, middle, &posts.east_m, &posts.north_m);
    return posts;
}

enum scree_status remesh_place(struct scree_memory *memory, const struct lattice *lattice,
                               const struct curvature_posts *posts, const struct scree_mesh *mesh,
                               struct extract_mesh *placed, double middle[2], struct scree_error *error) {
    *placed = (struct extract_mesh){.lattice = lattice, .in_posts = true};
    enum scree_status status = extract_mesh_reserve(memory, placed, mesh->vertex_count, mesh->triangle_count, error);
    if (status != SCREE_OK) return status;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct scree_vertex *at = &mesh->vertices[i];
        double height_m = posts->heights_m[(int64_t)at->y * posts->stride + at->x];
        placed->vertices[i] = (struct extract_vertex){at->x, at->y, height_m};
    }
    memcpy(placed->corners, mesh->corners, 3 * (size_t)mesh->triangle_count * sizeof *mesh->corners);
    placed->vertex_count = mesh->vertex_count;
    placed->triangle_count = mesh->triangle_count;
    middle[0] = lattice_x(lattice, (double)(lattice->columns - 1) / 2);
    middle[1] = lattice_y(lattice, (double)(lattice->rows - 1) / 2);
    const struct horizon_frame frame = place_horizon(middle[0], middle[1]);
    return extract_mesh_place(memory, placed, lattice->profile == PROFILE_GEODETIC ? &frame : NULL, error);
}

/* ---- how good it is ---- */

struct survey {
    const struct curvature_posts *posts;
    const struct quadtree_view *view;
    uint8_t *seen; /* a bit for each post */
    struct remesh_error *measured;
    double count;
};

static void note(struct survey *survey, int32_t x, int32_t y, double error_m) {
    const struct quadtree_view *view = survey->view;
    const struct curvature_posts *posts = survey->posts;
    size_t bit = (size_t)y * (size_t)posts->columns + (size_t)x;
    if (survey->seen[bit / 8] & 1U << bit % 8) return;
    survey->seen[bit / 8] |= (uint8_t)(1U << bit % 8);
    struct remesh_error *sum = survey->measured;
    sum->max_m = fmax(sum->max_m, error_m);
    sum->rms_m += error_m * error_m;
    survey->count++;
    if (!view->has_observer) return;
    double east_m = (x - view->x) * posts->east_m, north_m = (y - view->y) * posts->north_m;
    double up_m = (double)posts->heights_m[(int64_t)y * posts->stride + x] - view->height_m;
    double angle_rad = atan2(error_m, sqrt(east_m * east_m + north_m * north_m + up_m * up_m));
    sum->max_rad = fmax(sum->max_rad, angle_rad);
    sum->rms_rad += angle_rad * angle_rad;
}

static int64_t twice_area(const struct scree_vertex *a, const struct scree_vertex *b, int32_t x, int32_t y) {
    return (int64_t)(b->x - a->x) * (y - a->y) - (int64_t)(b->y - a->y) * (x - a->x);
}

static void survey_triangle(struct survey *survey, const struct scree_vertex *const corner[3]) {
    const struct curvature_posts *posts = survey->posts;
    int32_t west = corner[0]->x, east = west, south = corner[0]->y, north = south;
    double height_m[3], whole = (double)twice_area(corner[0], corner[1], corner[2]->x, corner[2]->y);
    for (int k = 0; k < 3; k++) {
        west = corner[k]->x < west ? corner[k]->x : west;
        east = corner[k]->x > east ? corner[k]->x : east;
        south = corner[k]->y < south ? corner[k]->y : south;
        north = corner[k]->y > north ? corner[k]->y : north;
        height_m[k] = posts->heights_m[(int64_t)corner[k]->y * posts->stride + corner[k]->x];
    }
    for (int32_t y = south; y <= north; y++)
        for (int32_t x = west; x <= east; x++) {
            int64_t part[3];
            double sum = 0, post_m = posts->heights_m[(int64_t)y * posts->stride + x];
            for (int k = 0; k < 3; k++) {
                part[k] = twice_area(corner[(k + 1) % 3], corner[(k + 2) % 3], x, y);
                sum += (double)part[k] * (height_m[k] - post_m);
            }
            if (part[0] >= 0 && part[1] >= 0 && part[2] >= 0) note(survey, x, y, fabs(sum) / whole);
        }
}

enum scree_status remesh_measure(struct scree_memory *memory, const struct curvature_posts *posts,
                                 const struct scree_mesh *mesh, const struct quadtree_view *view,
                                 struct remesh_error *measured, struct scree_error *error) {
    struct survey survey = {posts, view, NULL, measured, 0};
    *measured = (struct remesh_error){0};
    survey.seen = scree_allocate(memory, (size_t)posts->columns * (size_t)posts->rows / 8 + 1, 1,
                                 "the marks of posts looked at", error);
    if (survey.seen == NULL) return SCREE_E_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->corners + 3 * (size_t)t;
        survey_triangle(&survey,
                        (const struct scree_vertex *[3]){&mesh->vertices[corner[0]], &mesh->vertices[corner[1]],
                                                         &mesh->vertices[corner[2]]});
    }
    scree_release(memory, survey.seen);
    measured->rms_m = sqrt(measured->rms_m / survey.count);
    measured->rms_rad = sqrt(measured->rms_rad / survey.count);
    return SCREE_OK;
}
