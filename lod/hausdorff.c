/* The symmetric Hausdorff distance: see the header. */
#include "lod/hausdorff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- chance ---- */

/* SplitMix64 (Steele, Lea and Flood 2014). */
static uint64_t next_number(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

/* In [0, 1). */
static double next_share(uint64_t *state) {
    return (double)(next_number(state) >> 11) * 0x1p-53;
}

/* Which of `count` things a share of the whole falls on; sums[i] is the size of all things up to and with i. Where all
 * are of no size, each is as likely as the other. */
static uint32_t pick(const double *sums, uint32_t count, double share) {
    double whole = sums[count - 1];
    if (!(whole > 0)) return (uint32_t)(share * count);
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (sums[middle] > share * whole)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* ---- samples ---- */

static double length_m(struct vector3 a, struct vector3 b) {
    struct vector3 d = vector3_minus(b, a);
    return sqrt(vector3_dot(d, d));
}

static double area_m2(struct vector3 a, struct vector3 b, struct vector3 c) {
    struct vector3 ab = vector3_minus(b, a), ac = vector3_minus(c, a);
    double bc = vector3_dot(ab, ac);
    return sqrt(fmax(0, vector3_dot(ab, ab) * vector3_dot(ac, ac) - bc * bc)) / 2;
}

static struct vector3 corner(const struct space_mesh *mesh, uint32_t triangle, int k) {
    return mesh->vertices_m[mesh->corners[3 * (size_t)triangle + (size_t)k]];
}

static void scatter_on_faces(const struct space_mesh *mesh, double *sums, uint32_t count, uint64_t *chance,
                             struct vector3 *points_m) {
    double sum = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        sum += area_m2(corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
        sums[t] = sum;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = pick(sums, mesh->triangle_count, next_share(chance));
        struct vector3 a = corner(mesh, t, 0);
        double root = sqrt(next_share(chance)), share = next_share(chance); /* evenly over the triangle */
        struct vector3 ab = vector3_minus(corner(mesh, t, 1), a), ac = vector3_minus(corner(mesh, t, 2), a);
        points_m[i] = vector3_plus_scaled(vector3_plus_scaled(a, root * (1 - share), ab), root * share, ac);
    }
}

static int by_number(const void *left, const void *right) {
    const uint64_t *a = left, *b = right;
    return *a < *b ? -1 : *a > *b; /* equal ones are the same edge */
}

/* Every edge once, as its lower vertex number times 2^32 and the higher one. */
static uint32_t list_edges(const struct space_mesh *mesh, uint64_t *edges) {
    size_t count = 3 * (size_t)mesh->triangle_count;
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t a = mesh->corners[i], b = mesh->corners[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = a < b ? a << 32 | b : b << 32 | a;
    }
    qsort(edges, count, sizeof *edges, by_number);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || edges[i] != edges[i - 1]) edges[kept++] = edges[i];
    return kept;
}

static void scatter_on_edges(const struct space_mesh *mesh, uint64_t *edges, double *sums, uint32_t count,
                             uint64_t *chance, struct vector3 *points_m) {
    uint32_t edge_count = list_edges(mesh, edges);
    double sum = 0;
    for (uint32_t i = 0; i < edge_count; i++) {
        sum += length_m(mesh->vertices_m[edges[i] >> 32], mesh->vertices_m[edges[i] & UINT32_MAX]);
        sums[i] = sum;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint64_t edge = edges[pick(sums, edge_count, next_share(chance))];
        struct vector3 a = mesh->vertices_m[edge >> 32], b = mesh->vertices_m[edge & UINT32_MAX];
        points_m[i] = vector3_plus_scaled(a, next_share(chance), vector3_minus(b, a));
    }
}

enum scree_status hausdorff_prepare(struct scree_memory *memory, const struct space_mesh *mesh,
                                    const struct hausdorff_options *options, struct hausdorff_surface *prepared,
                                    struct scree_error *error) {
    uint64_t *edges = NULL, chance = options->seed, count = mesh->vertex_count;
    double *sums = NULL;
    memset(prepared, 0, sizeof *prepared);
    enum scree_status status = distance_index_make(memory, mesh, &prepared->index, error);
    if (status != SCREE_OK) return status;
    count += (uint64_t)options->face_points + options->edge_points;
    if (count > UINT32_MAX || mesh->triangle_count > UINT32_MAX / 3) {
        status = scree_fail(error, SCREE_E_LIMIT, "there are too many points to compare");
        goto cleanup;
    }
    status = SCREE_E_MEMORY;
    size_t edge_room = 3 * (size_t)mesh->triangle_count;
    prepared->samples_m = scree_allocate(memory, (size_t)count, sizeof *prepared->samples_m, "sample points", error);
    edges = scree_allocate(memory, edge_room, sizeof *edges, "edges", error);
    sums = scree_allocate(memory, edge_room, sizeof *sums, "areas of faces", error);
    if (prepared->samples_m == NULL || edges == NULL || sums == NULL) goto cleanup;
    prepared->sample_count = (uint32_t)count;
    struct vector3 *faces = prepared->samples_m + mesh->vertex_count;
    memcpy(prepared->samples_m, mesh->vertices_m, mesh->vertex_count * sizeof *mesh->vertices_m);
    scatter_on_faces(mesh, sums, options->face_points, &chance, faces);
    scatter_on_edges(mesh, edges, sums, options->edge_points, &chance, faces + options->face_points);
    status = SCREE_OK;
cleanup:
    scree_release(memory, sums);
    scree_release(memory, edges);
    if (status != SCREE_OK) hausdorff_release(memory, prepared);
    return status;
}

void hausdorff_release(struct scree_memory *memory, struct hausdorff_surface *prepared) {
    scree_release(memory, prepared->samples_m);
    distance_index_release(memory, &prepared->index);
    prepared->samples_m = NULL;
    prepared->sample_count = 0;
}

/* ---- the distance ---- */

static double ask(const struct hausdorff_surface *from, struct hausdorff_surface *to, double *sum_m,
                  double *distances_m) {
    double farthest_m = 0;
    for (uint32_t i = 0; i < from->sample_count; i++) {
        double distance_m = mesh_distance_m(&to->index, from->samples_m[i]);
        farthest_m = fmax(farthest_m, distance_m);
        *sum_m += distance_m;
        if (distances_m != NULL) distances_m[i] = distance_m;
    }
    return farthest_m;
}

static int by_distance(const void *left, const void *right) {
    const double *a = left, *b = right;
    return *a < *b ? -1 : *a > *b; /* equal distances are alike */
}

struct hausdorff hausdorff_measure(struct hausdorff_surface *first, struct hausdorff_surface *second,
                                   double *distances_m) {
    struct hausdorff result = {.sample_count = first->sample_count + second->sample_count};
    double sum_m = 0;
    result.from_first_m = ask(first, second, &sum_m, distances_m);
    result.from_second_m = ask(second, first, &sum_m, distances_m != NULL ? distances_m + first->sample_count : NULL);
    result.max_m = fmax(result.from_first_m, result.from_second_m);
    result.mean_m = sum_m / result.sample_count;
    if (distances_m != NULL) qsort(distances_m, result.sample_count, sizeof *distances_m, by_distance);
    return result;
}
