#include "lod/delaunay.h"
#include "lod/tin.h"

#include <math.h>
#include <stdlib.h>

#define POSITION_BITS 24
#define MARGIN        (31 << POSITION_BITS) /* around the points: far corners hardly disturb the hull */
#define HILBERT_BITS  (POSITION_BITS + 1)
#define BOX_CORNERS   4

/* ---- points in order ---- */

struct ordered_point {
    uint64_t key; /* along the Hilbert curve */
    double z;
    uint32_t index;
};

static int compare_ordered(const void *first, const void *second) {
    const struct ordered_point *a = first, *b = second;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    if (a->z != b->z) return a->z < b->z ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

static uint64_t hilbert(uint32_t x, uint32_t y) {
    uint64_t key = 0;
    for (uint32_t side = 1u << (HILBERT_BITS - 1); side > 0; side /= 2) {
        uint32_t right = (x & side) != 0, up = (y & side) != 0;
        key = 4 * key + ((3 * right) ^ up);
        if (up) continue;
        if (right) {
            x = ~x;
            y = ~y;
        }
        uint32_t swapped = x;
        x = y;
        y = swapped;
    }
    return key;
}

struct triangulation {
    struct delaunay mesh;
    uint32_t *source; /* of every point of the mesh behind the box's corners: its number in the cloud */
};

/* From coordinates to whole steps, a power of two each, so that what is round stays what it is. */
struct rounding {
    double west, south, step;
};

static struct delaunay_point rounded(const struct rounding *rounding, const struct cloud_point *point) {
    return (struct delaunay_point){(int32_t)lrint((point->x - rounding->west) / rounding->step) + MARGIN,
                                   (int32_t)lrint((point->y - rounding->south) / rounding->step) + MARGIN};
}

static enum scree_status insert_points(const struct cloud *cloud, const struct rounding *rounding,
                                       const struct ordered_point *order, struct triangulation *result,
                                       struct scree_error *error) {
    struct delaunay *mesh = &result->mesh;
    enum scree_status status = delaunay_reserve(mesh, cloud->count + BOX_CORNERS, error);
    uint32_t triangle = 0;
    for (uint32_t i = 0; i < cloud->count && status == SCREE_OK; i++) {
        if (i > 0 && order[i].key == order[i - 1].key) continue; /* the lowest of a place comes first */
        struct delaunay_point place = rounded(rounding, &cloud->points[order[i].index]);
        triangle = delaunay_find(mesh, triangle, place);
        result->source[mesh->point_count] = order[i].index;
        triangle = delaunay_insert(mesh, triangle, place);
    }
    return status;
}

static enum scree_status triangulate(const struct cloud *cloud, struct triangulation *result,
                                     struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    double bounds[4];
    cloud_bounds(cloud, bounds);
    double width = bounds[2] - bounds[0], height = bounds[3] - bounds[1];
    int exponent;
    frexp(fmax(width, height), &exponent); /* below 2^exponent */
    struct rounding rounding = {bounds[0], bounds[1], ldexp(1, exponent - POSITION_BITS)};
    struct ordered_point *order =
        scree_allocate(cloud->memory, cloud->count, sizeof *order, "the order of a cloud's points", error);
    result->source = scree_allocate(cloud->memory, (size_t)cloud->count + BOX_CORNERS, sizeof *result->source,
                                    "the sources of a triangulation's points", error);
    if (order == NULL || result->source == NULL) {
        status = error->status;
        goto cleanup;
    }
    for (uint32_t i = 0; i < cloud->count; i++) {
        struct delaunay_point place = rounded(&rounding, &cloud->points[i]);
        uint64_t key = hilbert((uint32_t)(place.x - MARGIN), (uint32_t)(place.y - MARGIN));
        order[i] = (struct ordered_point){key, cloud->points[i].z, i};
    }
    qsort(order, cloud->count, sizeof *order, compare_ordered);
    status = delaunay_start(cloud->memory, (int32_t)lrint(width / rounding.step) + 2 * MARGIN,
                            (int32_t)lrint(height / rounding.step) + 2 * MARGIN, &result->mesh, error);
    if (status == SCREE_OK) status = insert_points(cloud, &rounding, order, result, error);
cleanup:
    scree_release(cloud->memory, order);
    return status;
}

/* ---- triangles ---- */

static bool is_short(const struct cloud_point *a, const struct cloud_point *b, double longest) {
    double dx = a->x - b->x, dy = a->y - b->y;
    return dx * dx + dy * dy <= longest * longest;
}

/* Between points of the cloud, with area where they are and not just where they were rounded to. */
static bool is_wanted(const struct cloud *cloud, const struct triangulation *from, const uint32_t corner[3],
                      double longest) {
    const struct cloud_point *p[3];
    for (int k = 0; k < 3; k++) {
        if (corner[k] < BOX_CORNERS) return false;
        p[k] = &cloud->points[from->source[corner[k]]];
    }
    return is_short(p[0], p[1], longest) && is_short(p[1], p[2], longest) && is_short(p[2], p[0], longest) &&
           (p[1]->x - p[0]->x) * (p[2]->y - p[0]->y) > (p[1]->y - p[0]->y) * (p[2]->x - p[0]->x);
}

/* Releases the triangulation between its triangles and the TIN's points, so that there is room for these. */
static enum scree_status take_triangles(const struct cloud *cloud, struct triangulation *from, double longest,
                                        struct tin *tin, struct scree_error *error) {
    struct delaunay *mesh = &from->mesh;
    uint32_t count = 0, point_count = mesh->point_count - BOX_CORNERS;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count += is_wanted(cloud, from, mesh->triangles[t].corner, longest);
    if (count == 0)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "its points make no triangle with edges of %g or less; name a longer --max-edge", longest);
    tin->corners = scree_allocate(tin->memory, count, 3 * sizeof *tin->corners, "the triangles of a TIN", error);
    if (tin->corners == NULL) return error->status;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->triangles[t].corner;
        if (!is_wanted(cloud, from, corner, longest)) continue;
        for (int k = 0; k < 3; k++) tin->corners[3 * (size_t)tin->triangle_count + (size_t)k] = corner[k] - BOX_CORNERS;
        tin->triangle_count++;
    }
    delaunay_release(mesh);
    tin->points = scree_allocate(tin->memory, point_count, sizeof *tin->points, "the points of a TIN", error);
    if (tin->points == NULL) return error->status;
    for (uint32_t i = 0; i < point_count; i++) tin->points[i] = cloud->points[from->source[i + BOX_CORNERS]];
    tin->point_count = point_count;
    return tin_drop_unused(tin, NULL, error);
}

enum scree_status tin_from_cloud(const struct cloud *cloud, double longest_edge, struct tin *tin,
                                 struct scree_error *error) {
    struct triangulation found = {.mesh = {.memory = cloud->memory}};
    if (cloud->count == 0) return scree_fail(error, SCREE_E_CORRUPT, "it has no points");
    enum scree_status status = triangulate(cloud, &found, error);
    if (status == SCREE_OK) status = take_triangles(cloud, &found, longest_edge, tin, error);
    delaunay_release(&found.mesh);
    scree_release(cloud->memory, found.source);
    return status;
}
