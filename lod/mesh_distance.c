/* Distances from a triangle mesh: see the header. */
#include "lod/mesh_distance.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define TRIANGLES_A_CELL 2
#define MOST_CELLS       1024 /* a side */
#define SLIVER           1e-6 /* squared sine of an angle below which the foot of a perpendicular is not well known */

/* ---- a point and a triangle ---- */

static double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

static double distance2(struct vector3 a, struct vector3 b) {
    struct vector3 d = vector3_minus(a, b);
    return vector3_dot(d, d);
}

static double segment_distance2(struct vector3 point, struct vector3 a, struct vector3 b) {
    struct vector3 along = vector3_minus(b, a);
    double length2 = vector3_dot(along, along);
    double share = length2 > 0 ? clamp(vector3_dot(vector3_minus(point, a), along) / length2, 0, 1) : 0;
    return distance2(point, vector3_plus_scaled(a, share, along));
}

/* Above the inside of the triangle the distance is that to its plane, elsewhere that to one of its edges. The weights
 * are those of the foot of the perpendicular (Ericson, Real-Time Collision Detection, section 3.4); those of a sliver
 * are uncertain, but it is hardly wider than its edges, which are asked as well. */
static double triangle_distance2(struct vector3 point, struct vector3 a, struct vector3 b, struct vector3 c) {
    struct vector3 ab = vector3_minus(b, a), ac = vector3_minus(c, a), ap = vector3_minus(point, a);
    double bb = vector3_dot(ab, ab), bc = vector3_dot(ab, ac), cc = vector3_dot(ac, ac);
    double pb = vector3_dot(ap, ab), pc = vector3_dot(ap, ac);
    double whole = bb * cc - bc * bc, of_b = cc * pb - bc * pc, of_c = bb * pc - bc * pb;
    double nearest2 = HUGE_VAL;
    if (whole > 0 && of_b >= 0 && of_c >= 0 && of_b + of_c <= whole) {
        struct vector3 foot = vector3_plus_scaled(vector3_plus_scaled(a, of_b / whole, ab), of_c / whole, ac);
        nearest2 = distance2(point, foot);
        if (whole > SLIVER * bb * cc) return nearest2;
    }
    nearest2 = fmin(nearest2, segment_distance2(point, a, b));
    nearest2 = fmin(nearest2, segment_distance2(point, b, c));
    return fmin(nearest2, segment_distance2(point, c, a));
}

double triangle_distance_m(struct vector3 point, struct vector3 a, struct vector3 b, struct vector3 c) {
    return sqrt(triangle_distance2(point, a, b, c));
}

/* ---- the grid ---- */

enum scree_status space_mesh_check(const struct space_mesh *mesh, struct scree_error *error) {
    if (mesh->triangle_count == 0) return scree_fail(error, SCREE_E_ARGUMENT, "the mesh has no triangles");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct vector3 v = mesh->vertices_m[i];
        if (!isfinite(v.x) || !isfinite(v.y) || !isfinite(v.z))
            return scree_fail(error, SCREE_E_ARGUMENT, "vertex %u of the mesh is nowhere", (unsigned)i);
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        if (mesh->corners[i] >= mesh->vertex_count)
            return scree_fail(error, SCREE_E_ARGUMENT, "triangle %zu of the mesh names vertex %u of %u", i / 3,
                              (unsigned)mesh->corners[i], (unsigned)mesh->vertex_count);
    return SCREE_OK;
}

/* Cells about as wide as high, a few triangles in each. */
static void lay_grid(struct distance_index *index) {
    const struct space_mesh *mesh = &index->mesh;
    struct vector3 low = mesh->vertices_m[mesh->corners[0]], high = low;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        struct vector3 v = mesh->vertices_m[mesh->corners[i]];
        low.x = fmin(low.x, v.x);
        low.y = fmin(low.y, v.y);
        high.x = fmax(high.x, v.x);
        high.y = fmax(high.y, v.y);
    }
    double wide_m = high.x - low.x, high_m = high.y - low.y;
    double cells = fmax(1, mesh->triangle_count / (double)TRIANGLES_A_CELL);
    double side_m = fmax(sqrt(wide_m * high_m / cells), fmax(wide_m, high_m) / MOST_CELLS);
    index->columns = side_m > 0 ? (uint32_t)clamp(ceil(wide_m / side_m), 1, MOST_CELLS) : 1;
    index->rows = side_m > 0 ? (uint32_t)clamp(ceil(high_m / side_m), 1, MOST_CELLS) : 1;
    index->x_m = low.x;
    index->y_m = low.y;
    index->cell_x_m = wide_m > 0 ? wide_m / index->columns : 1;
    index->cell_y_m = high_m > 0 ? high_m / index->rows : 1;
}

static uint32_t cell_of(double offset_m, double cell_m, uint32_t count) {
    return (uint32_t)clamp(floor(offset_m / cell_m), 0, count - 1);
}

struct cell_box {
    uint32_t x_first, x_last, y_first, y_last;
};

static struct cell_box box_of(const struct distance_index *index, const struct vector3 v[3]) {
    double left = fmin(v[0].x, fmin(v[1].x, v[2].x)), right = fmax(v[0].x, fmax(v[1].x, v[2].x));
    double south = fmin(v[0].y, fmin(v[1].y, v[2].y)), north = fmax(v[0].y, fmax(v[1].y, v[2].y));
    return (struct cell_box){cell_of(left - index->x_m, index->cell_x_m, index->columns),
                             cell_of(right - index->x_m, index->cell_x_m, index->columns),
                             cell_of(south - index->y_m, index->cell_y_m, index->rows),
                             cell_of(north - index->y_m, index->cell_y_m, index->rows)};
}

/* Whether the triangle, seen from above, reaches into a cell of its box: false when the whole cell is on the outer side
 * of an edge. A cell that a triangle only touches may go either way; the distance is then the same by its neighbour. */
static bool reaches(const struct distance_index *index, const struct vector3 v[3], uint32_t column, uint32_t row) {
    double turn = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[1].y - v[0].y) * (v[2].x - v[0].x);
    double middle_x = index->x_m + (column + 0.5) * index->cell_x_m;
    double middle_y = index->y_m + (row + 0.5) * index->cell_y_m;
    if (turn == 0) return true;
    for (int k = 0; k < 3; k++) {
        double dx = v[(k + 1) % 3].x - v[k].x, dy = v[(k + 1) % 3].y - v[k].y;
        double side = dx * (middle_y - v[k].y) - dy * (middle_x - v[k].x);
        double reach = (fabs(dx) * index->cell_y_m + fabs(dy) * index->cell_x_m) / 2;
        if ((turn > 0 ? side : -side) < -reach) return false;
    }
    return true;
}

static void corners_of(const struct space_mesh *mesh, uint32_t triangle, struct vector3 v[3]) {
    for (int k = 0; k < 3; k++) v[k] = mesh->vertices_m[mesh->corners[3 * (size_t)triangle + (size_t)k]];
}

/* Counts the triangles of every cell into starts[cell + 1], or files them where starts[cell] says. */
static uint64_t file_triangles(struct distance_index *index) {
    uint64_t entries = 0;
    for (uint32_t t = 0; t < index->mesh.triangle_count; t++) {
        struct vector3 v[3];
        corners_of(&index->mesh, t, v);
        struct cell_box box = box_of(index, v);
        for (uint32_t row = box.y_first; row <= box.y_last; row++)
            for (uint32_t column = box.x_first; column <= box.x_last; column++) {
                if (!reaches(index, v, column, row)) continue;
                size_t cell = (size_t)row * index->columns + column;
                if (index->triangles != NULL)
                    index->triangles[index->starts[cell]++] = t;
                else
                    index->starts[cell + 1]++;
                entries++;
            }
    }
    return entries;
}

enum scree_status distance_index_make(struct scree_memory *memory, const struct space_mesh *mesh,
                                      struct distance_index *index, struct scree_error *error) {
    memset(index, 0, sizeof *index);
    enum scree_status status = space_mesh_check(mesh, error);
    if (status != SCREE_OK) return status;
    index->mesh = *mesh;
    lay_grid(index);
    size_t cells = (size_t)index->columns * index->rows;
    index->starts = scree_allocate(memory, cells + 1, sizeof *index->starts, "a mesh's grid", error);
    index->asked = scree_allocate(memory, mesh->triangle_count, sizeof *index->asked, "a mesh's grid", error);
    status = SCREE_E_MEMORY;
    if (index->starts == NULL || index->asked == NULL) goto cleanup;
    uint64_t entries = file_triangles(index);
    if (entries >= UINT32_MAX) {
        status = scree_fail(error, SCREE_E_LIMIT, "the mesh has too many triangles across its grid");
        goto cleanup;
    }
    for (size_t i = 1; i <= cells; i++) index->starts[i] += index->starts[i - 1];
    index->triangles = scree_allocate(memory, (size_t)entries, sizeof *index->triangles, "a mesh's grid", error);
    if (index->triangles == NULL) goto cleanup;
    file_triangles(index);
    for (size_t i = cells; i > 0; i--) index->starts[i] = index->starts[i - 1]; /* filing moved each to its end */
    index->starts[0] = 0;
    status = SCREE_OK;
cleanup:
    if (status != SCREE_OK) distance_index_release(memory, index);
    return status;
}

void distance_index_release(struct scree_memory *memory, struct distance_index *index) {
    scree_release(memory, index->triangles);
    scree_release(memory, index->asked);
    scree_release(memory, index->starts);
    memset(index, 0, sizeof *index);
}

/* ---- the search ---- */

static void search_cell(struct distance_index *index, uint32_t column, uint32_t row, struct vector3 point,
                        double *nearest2) {
    size_t cell = (size_t)row * index->columns + column;
    for (uint32_t i = index->starts[cell]; i < index->starts[cell + 1]; i++) {
        uint32_t triangle = index->triangles[i];
        if (index->asked[triangle] == index->question) continue;
        index->asked[triangle] = index->question;
        struct vector3 v[3];
        corners_of(&index->mesh, triangle, v);
        *nearest2 = fmin(*nearest2, triangle_distance2(point, v[0], v[1], v[2]));
    }
}

/* How far it is, at least, to whatever lies outside of a block of cells around the point; HUGE_VAL: nothing does. */
static double way_out_m(const struct distance_index *index, const struct cell_box *block, struct vector3 point) {
    double x = point.x - index->x_m, y = point.y - index->y_m, way_m = HUGE_VAL;
    if (block->x_first > 0) way_m = fmin(way_m, x - block->x_first * index->cell_x_m);
    if (block->y_first > 0) way_m = fmin(way_m, y - block->y_first * index->cell_y_m);
    if (block->x_last + 1 < index->columns) way_m = fmin(way_m, (block->x_last + 1) * index->cell_x_m - x);
    if (block->y_last + 1 < index->rows) way_m = fmin(way_m, (block->y_last + 1) * index->cell_y_m - y);
    return fmax(way_m, 0);
}

static void search_ring(struct distance_index *index, uint32_t column, uint32_t row, uint32_t ring,
                        const struct cell_box *block, struct vector3 point, double *nearest2) {
    for (uint32_t y = block->y_first; y <= block->y_last; y++) {
        if (y + ring == row || y == row + ring) {
            for (uint32_t x = block->x_first; x <= block->x_last; x++) search_cell(index, x, y, point, nearest2);
            continue;
        }
        if (block->x_first + ring == column) search_cell(index, block->x_first, y, point, nearest2);
        if (block->x_last == column + ring) search_cell(index, block->x_last, y, point, nearest2);
    }
}

static void start_question(struct distance_index *index) {
    if (++index->question != 0) return;
    memset(index->asked, 0, index->mesh.triangle_count * sizeof *index->asked);
    index->question = 1;
}

double mesh_distance_m(struct distance_index *index, struct vector3 point) {
    uint32_t column = cell_of(point.x - index->x_m, index->cell_x_m, index->columns);
    uint32_t row = cell_of(point.y - index->y_m, index->cell_y_m, index->rows);
    double nearest2 = HUGE_VAL;
    start_question(index);
    for (uint32_t ring = 0;; ring++) {
        const struct cell_box block = {
            column > ring ? column - ring : 0, column + ring < index->columns ? column + ring : index->columns - 1,
            row > ring ? row - ring : 0, row + ring < index->rows ? row + ring : index->rows - 1};
        search_ring(index, column, row, ring, &block, point, &nearest2);
        double way_m = way_out_m(index, &block, point);
        if (way_m * way_m >= nearest2 || way_m == HUGE_VAL) return sqrt(nearest2);
    }
}
