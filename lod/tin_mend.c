#include "lod/tin_overlap.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define FARTHEST       1e15 /* as of clouds */
#define SAME_HEIGHT    1e-9 /* of the extent: so close, heights in one place are one */
#define NEEDLE         1e-9 /* of the longest edge, or of the extent: not higher is no triangle but a line */
#define LATTICE        0.02 /* of the mean longest edge: coarser decimals are no rounding, but places chosen so */
#define HIGH           0.25 /* of its length: no sliver on a terrain is */
#define MOST_TRIANGLES (UINT32_MAX / 3) /* half-edges have 32 bits */
#define MOST_DIGITS    9
#define DOUBLE_BITS    50 /* of a coordinate are sure, after its way through decimals */
#define SHORT_BUCKET   16
#define ROUNDING       4e-16 /* of the products in a plan area: below, its sign is not known (Shewchuk 1997: 3.4e-16) */
#define STEEP          10    /* times as high as apart in plan */

static const char advice[] = "a terrain has one height at a place (--grid takes the highest)";

/* What is measured of all points. */
struct scale {
    double extent;   /* the longest side, heights included */
    double rounding; /* of positions: their last decimal, or what floats or doubles hold */
};

static struct cloud_point *corner_of(const struct tin *tin, size_t triangle, int k) {
    return &tin->points[tin->corners[3 * triangle + (size_t)k]];
}

static bool is_gone(const struct tin *tin, size_t triangle) {
    return tin->corners[3 * triangle] == TIN_NONE;
}

static void drop(struct tin *tin, size_t triangle, struct tin_mended *mended) {
    tin->corners[3 * triangle] = TIN_NONE;
    mended->dropped++;
}

/* ---- what there is ---- */

static enum scree_status check_input(const struct tin *tin, struct scree_error *error) {
    if (tin->point_count == 0) return scree_fail(error, SCREE_E_CORRUPT, "has no points");
    if (tin->triangle_count > MOST_TRIANGLES)
        return scree_fail(error, SCREE_E_LIMIT, "has more than %u triangles", (unsigned)MOST_TRIANGLES);
    for (uint32_t i = 0; i < tin->point_count; i++) {
        const struct cloud_point *point = &tin->points[i];
        if (!(fabs(point->x) < FARTHEST && fabs(point->y) < FARTHEST && fabs(point->z) < FARTHEST))
            return scree_fail(error, SCREE_E_CORRUPT, "has a point at %g %g %g, which is no position on Earth",
                              point->x, point->y, point->z);
    }
    for (size_t i = 0; i < 3 * (size_t)tin->triangle_count; i++)
        if (tin->corners[i] >= tin->point_count)
            return scree_fail(error, SCREE_E_CORRUPT, "a triangle has a corner at point %" PRIu32 " of %" PRIu32,
                              tin->corners[i], tin->point_count);
    return SCREE_OK;
}

static bool has_digits(double value, double power) {
    const double scaled = value * power;
    return fabs(scaled - nearbyint(scaled)) <= fabs(scaled) * 0x1p-51;
}

/* From how the coordinates look: whole tens, hundreds, ... of a unit; else floats; else doubles. */
static double find_rounding(const struct tin *tin, double farthest) {
    static const double powers[MOST_DIGITS + 1] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    int digits = 0;
    bool are_floats = true;
    for (uint32_t i = 0; i < tin->point_count && (digits <= MOST_DIGITS || are_floats); i++) {
        const double x = tin->points[i].x, y = tin->points[i].y;
        are_floats = are_floats && (double)(float)x == x && (double)(float)y == y;
        while (digits <= MOST_DIGITS && !(has_digits(x, powers[digits]) && has_digits(y, powers[digits]))) digits++;
    }
    const double finest = ldexp(farthest, -DOUBLE_BITS);
    if (digits <= MOST_DIGITS) return fmax(1 / powers[digits], finest);
    return are_floats ? ldexp(farthest, -23) : finest;
}

static struct scale measure(const struct tin *tin) {
    struct cloud_point low = tin->points[0], high = low;
    double farthest = 0;
    for (uint32_t i = 0; i < tin->point_count; i++) {
        const struct cloud_point *point = &tin->points[i];
        low = (struct cloud_point){fmin(low.x, point->x), fmin(low.y, point->y), fmin(low.z, point->z)};
        high = (struct cloud_point){fmax(high.x, point->x), fmax(high.y, point->y), fmax(high.z, point->z)};
        farthest = fmax(farthest, fmax(fabs(point->x), fabs(point->y)));
    }
    const double extent = fmax(fmax(high.x - low.x, high.y - low.y), high.z - low.z);
    return (struct scale){extent, find_rounding(tin, farthest)};
}

/* ---- points in one place ---- */

static uint64_t mix(uint64_t bits) { /* of SplitMix64 */
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
    return bits ^ bits >> 31;
}

static uint64_t hash_of(double value) {
    union {
        double value;
        uint64_t bits;
    } both = {.value = value + 0.0}; /* -0 is 0 */
    return mix(both.bits);
}

/* The first point of the same place in the layer of heights, or the empty slot at the end of the search. */
static size_t find_slot(const struct tin *tin, const uint32_t *slots, size_t slot_mask, const struct cloud_point *point,
                        double layer, double same_height) {
    size_t at = mix(hash_of(point->x) * 3 + hash_of(point->y) * 5 + hash_of(layer) * 7) & slot_mask;
    for (; slots[at] != TIN_NONE; at = (at + 1) & slot_mask) {
        const struct cloud_point *other = &tin->points[slots[at]];
        if (other->x == point->x && other->y == point->y && floor(other->z / same_height) == layer) {
            if (fabs(other->z - point->z) <= same_height) break;
        }
    }
    return at;
}

/* Every corner gets the first point of its place. A point joins one that is in its own layer of heights, which is
 * `same_height` thick, or in the ones below and above. */
static enum scree_status weld(struct tin *tin, double extent, struct tin_mended *mended, struct scree_error *error) {
    const double same_height = fmax(extent * SAME_HEIGHT, 1e-300);
    size_t slot_count = 64;
    while (slot_count < 2 * (size_t)tin->point_count) slot_count *= 2;
    uint32_t *slots = scree_allocate(tin->memory, slot_count, sizeof *slots, "a TIN's points in one place", error);
    uint32_t *first =
        scree_allocate(tin->memory, tin->point_count, sizeof *first, "a TIN's points in one place", error);
    enum scree_status status = slots == NULL || first == NULL ? error->status : SCREE_OK;
    if (status != SCREE_OK) goto cleanup;
    for (size_t i = 0; i < slot_count; i++) slots[i] = TIN_NONE;
    for (uint32_t i = 0; i < tin->point_count; i++) {
        const struct cloud_point *point = &tin->points[i];
        const double layer = floor(point->z / same_height);
        const size_t own = find_slot(tin, slots, slot_count - 1, point, layer, same_height);
        first[i] = slots[own];
        for (int side = -1; side <= 1; side += 2) {
            const size_t next = find_slot(tin, slots, slot_count - 1, point, layer + side, same_height);
            if (slots[next] < first[i]) first[i] = slots[next];
        }
        if (first[i] == TIN_NONE) slots[own] = first[i] = i;
        mended->welded += first[i] != i;
    }
    for (size_t i = 0; i < 3 * (size_t)tin->triangle_count; i++) tin->corners[i] = first[tin->corners[i]];
cleanup:
    scree_release(tin->memory, first);
    scree_release(tin->memory, slots);
    return status;
}

/* ---- triangles one by one ---- */

static double distance2(const struct cloud_point *a, const struct cloud_point *b) {
    const double dx = b->x - a->x, dy = b->y - a->y;
    return dx * dx + dy * dy;
}

struct shape {
    double plan_area2;  /* twice the area in plan, positive when counter-clockwise; 0 where doubles do not tell */
    double longest;     /* edge in plan */
    double space_area2; /* not in plan */
    double space_longest;
    double blur; /* what doubles blur places by */
};

static struct shape shape_of(const struct tin *tin, size_t triangle) {
    const struct cloud_point *p[3] = {corner_of(tin, triangle, 0), corner_of(tin, triangle, 1),
                                      corner_of(tin, triangle, 2)};
    struct shape shape = {0};
    for (int k = 0; k < 3; k++) {
        const double plan2 = distance2(p[k], p[(k + 1) % 3]), dz = p[(k + 1) % 3]->z - p[k]->z;
        shape.longest = fmax(shape.longest, sqrt(plan2));
        shape.space_longest = fmax(shape.space_longest, sqrt(plan2 + dz * dz));
        shape.blur = fmax(shape.blur, ldexp(fmax(fabs(p[k]->x), fabs(p[k]->y)), -DOUBLE_BITS));
    }
    const double ux = p[1]->x - p[0]->x, uy = p[1]->y - p[0]->y, uz = p[1]->z - p[0]->z;
    const double vx = p[2]->x - p[0]->x, vy = p[2]->y - p[0]->y, vz = p[2]->z - p[0]->z;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    shape.space_area2 = sqrt(nx * nx + ny * ny + nz * nz);
    if (fabs(nz) > fmax(ROUNDING * (fabs(ux * vy) + fabs(uy * vx)), shape.blur * shape.longest)) shape.plan_area2 = nz;
    return shape;
}

/* Two corners less than `apart` from each other in plan, and one of them more than `above` higher. */
static bool has_upright_edge(const struct tin *tin, size_t triangle, double apart, double above) {
    for (int k = 0; k < 3; k++) {
        const struct cloud_point *a = corner_of(tin, triangle, k), *b = corner_of(tin, triangle, (k + 1) % 3);
        if (distance2(a, b) <= apart * apart && fabs(a->z - b->z) > above) return true;
    }
    return false;
}

/* What has no area in plan but has in space is a wall when a corner is above another one, or when it is high; else it
 * was a sliver before its corners were rounded. */
static bool is_wall(const struct tin *tin, size_t triangle, const struct shape *shape) {
    return has_upright_edge(tin, triangle, 0, 0) || shape->space_area2 > HIGH * shape->longest * shape->longest;
}

static enum scree_status fail_vertical(const struct tin *tin, size_t triangle, struct scree_error *error) {
    const struct cloud_point *a = corner_of(tin, triangle, 0), *b = corner_of(tin, triangle, 1),
                             *c = corner_of(tin, triangle, 2);
    return scree_fail(error, SCREE_E_CORRUPT, "a vertical face at %.10g %.10g, from height %.6g to %.6g; %s",
                      (a->x + b->x + c->x) / 3, (a->y + b->y + c->y) / 3, fmin(a->z, fmin(b->z, c->z)),
                      fmax(a->z, fmax(b->z, c->z)), advice);
}

/* What is counted of triangles that have an area. */
struct triangles {
    uint32_t turned[2];      /* counter-clockwise, and clockwise */
    double longest_edge_sum; /* in plan */
};

/* Lines go, vertical faces fail. */
static enum scree_status drop_lines(struct tin *tin, const struct scale *scale, struct triangles *counted,
                                    struct tin_mended *mended, struct scree_error *error) {
    const double least = fmin(scale->rounding, NEEDLE * scale->extent);
    for (size_t t = 0; t < tin->triangle_count; t++) {
        const uint32_t *corner = &tin->corners[3 * t];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
            drop(tin, t, mended);
            continue;
        }
        const struct shape shape = shape_of(tin, t);
        const double thinnest = fmax(fmax(least, shape.blur), NEEDLE * shape.space_longest);
        const bool has_area = shape.space_area2 > thinnest * shape.space_longest;
        if (has_area && shape.plan_area2 == 0 && is_wall(tin, t, &shape)) return fail_vertical(tin, t, error);
        if (!has_area || shape.plan_area2 == 0)
            drop(tin, t, mended);
        else
            counted->turned[shape.plan_area2 < 0]++;
        counted->longest_edge_sum += is_gone(tin, t) ? 0 : shape.longest;
    }
    return SCREE_OK;
}

/* Slivers that rounding of positions has turned over go; all others get their corners counter-clockwise. */
static enum scree_status turn(struct tin *tin, double tolerance, bool is_clockwise_rare, struct tin_mended *mended,
                              struct scree_error *error) {
    for (size_t t = 0; t < tin->triangle_count; t++) {
        if (is_gone(tin, t)) continue;
        const struct shape shape = shape_of(tin, t);
        const bool is_clockwise = shape.plan_area2 < 0;
        if (is_clockwise == is_clockwise_rare && fabs(shape.plan_area2) <= tolerance * shape.longest) {
            if (has_upright_edge(tin, t, tolerance, STEEP * tolerance)) return fail_vertical(tin, t, error);
            drop(tin, t, mended);
        } else if (is_clockwise) {
            const uint32_t second = tin->corners[3 * t + 1];
            tin->corners[3 * t + 1] = tin->corners[3 * t + 2];
            tin->corners[3 * t + 2] = second;
            mended->turned++;
        }
    }
    return SCREE_OK;
}

/* ---- edges ---- */

/* Half-edge 3 * t + k leads from corner k of triangle t to the next one; here by the point where they begin. */
struct out_edge {
    uint32_t to, half_edge;
};

struct edges {
    uint32_t *start; /* of each point's in `out`; one more than there are points */
    struct out_edge *out;
};

static int compare_out(const void *first, const void *second) {
    const struct out_edge *a = first, *b = second;
    if (a->to != b->to) return a->to < b->to ? -1 : 1;
    return (a->half_edge > b->half_edge) - (a->half_edge < b->half_edge);
}

static void sort_out(struct out_edge *out, uint32_t count) {
    if (count > SHORT_BUCKET) {
        qsort(out, count, sizeof *out, compare_out);
        return;
    }
    for (uint32_t i = 1; i < count; i++) {
        const struct out_edge edge = out[i];
        uint32_t at = i;
        for (; at > 0 && compare_out(&edge, &out[at - 1]) < 0; at--) out[at] = out[at - 1];
        out[at] = edge;
    }
}

static uint32_t origin_of(const struct tin *tin, uint32_t half_edge) {
    return tin->corners[half_edge];
}

static uint32_t opposite_of(const struct tin *tin, uint32_t half_edge) {
    return tin->corners[half_edge - half_edge % 3 + (half_edge + 2) % 3];
}

static enum scree_status gather_edges(const struct tin *tin, struct edges *edges, struct scree_error *error) {
    const size_t count = 3 * (size_t)tin->triangle_count;
    edges->start =
        scree_allocate(tin->memory, (size_t)tin->point_count + 1, sizeof *edges->start, "the edges of a TIN", error);
    edges->out = scree_allocate(tin->memory, count, sizeof *edges->out, "the edges of a TIN", error);
    if (edges->start == NULL || edges->out == NULL) return error->status;
    for (size_t i = 0; i < count; i++)
        if (!is_gone(tin, i / 3)) edges->start[origin_of(tin, (uint32_t)i)]++;
    uint32_t sum = 0;
    for (uint32_t p = 0; p <= tin->point_count; p++) {
        const uint32_t here = edges->start[p];
        edges->start[p] = sum;
        sum += here;
    }
    for (size_t i = 0; i < count; i++) {
        if (is_gone(tin, i / 3)) continue;
        const uint32_t to = tin->corners[i - i % 3 + (i + 1) % 3];
        edges->out[edges->start[origin_of(tin, (uint32_t)i)]++] = (struct out_edge){to, (uint32_t)i};
    }
    for (uint32_t p = tin->point_count; p > 0; p--) edges->start[p] = edges->start[p - 1];
    edges->start[0] = 0;
    for (uint32_t p = 0; p < tin->point_count; p++)
        sort_out(edges->out + edges->start[p], edges->start[p + 1] - edges->start[p]);
    return SCREE_OK;
}

/* How many triangles have an edge from one point to another, that way round. */
static uint32_t count_edges(const struct tin *tin, const struct edges *edges, uint32_t from, uint32_t to) {
    uint32_t low = edges->start[from], high = edges->start[from + 1], found = 0;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (edges->out[middle].to < to)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < edges->start[from + 1] && edges->out[low].to == to; low++)
        found += !is_gone(tin, edges->out[low].half_edge / 3);
    return found;
}

/* Two different triangles are on the same side of an edge. */
static enum scree_status fail_edge(const struct tin *tin, const struct edges *edges, uint32_t from, uint32_t to,
                                   struct scree_error *error) {
    const uint32_t count = count_edges(tin, edges, from, to) + count_edges(tin, edges, to, from);
    const struct cloud_point *a = &tin->points[from], *b = &tin->points[to];
    if (count > 2)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%" PRIu32 " triangles share the edge from %.10g %.10g %.6g to %.10g %.10g %.6g; %s", count,
                          a->x, a->y, a->z, b->x, b->y, b->z, advice);
    return scree_fail(error, SCREE_E_CORRUPT,
                      "an overhang along the edge from %.10g %.10g %.6g to %.10g %.10g %.6g; %s", a->x, a->y, a->z,
                      b->x, b->y, b->z, advice);
}

/* Copies of a triangle go; first all of them, so that none is counted at an edge. */
static enum scree_status drop_copies(struct tin *tin, const struct edges *edges, struct tin_mended *mended,
                                     struct scree_error *error) {
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t p = 0; p < tin->point_count; p++)
            for (uint32_t i = edges->start[p], first = i; i < edges->start[p + 1]; i++) {
                const struct out_edge *edge = &edges->out[i];
                if (edge->to != edges->out[first].to || is_gone(tin, edges->out[first].half_edge / 3)) first = i;
                if (i == first || is_gone(tin, edge->half_edge / 3)) continue;
                if (opposite_of(tin, edge->half_edge) == opposite_of(tin, edges->out[first].half_edge))
                    drop(tin, edge->half_edge / 3, mended);
                else if (pass == 1)
                    return fail_edge(tin, edges, p, edge->to, error);
            }
    return SCREE_OK;
}

/* Edges with nothing on their other side; counts them where `outline` is NULL. */
static uint32_t gather_outline(const struct tin *tin, const struct edges *edges, uint32_t *outline) {
    uint32_t count = 0;
    for (size_t i = 0; i < 3 * (size_t)tin->triangle_count; i++) {
        if (is_gone(tin, i / 3)) continue;
        const uint32_t to = tin->corners[i - i % 3 + (i + 1) % 3];
        if (count_edges(tin, edges, to, tin->corners[i]) > 0) continue;
        if (outline != NULL) outline[count] = (uint32_t)i;
        count++;
    }
    return count;
}

static enum scree_status check_surface(struct tin *tin, double tolerance, struct tin_mended *mended,
                                       struct scree_error *error) {
    struct edges edges = {0};
    uint32_t *outline = NULL, count = 0;
    enum scree_status status = gather_edges(tin, &edges, error);
    if (status == SCREE_OK) status = drop_copies(tin, &edges, mended, error);
    if (status != SCREE_OK) goto cleanup;
    count = gather_outline(tin, &edges, NULL);
    outline = scree_allocate(tin->memory, count, sizeof *outline, "the outline of a TIN", error);
    if (outline == NULL) {
        status = error->status;
        goto cleanup;
    }
    gather_outline(tin, &edges, outline);
    scree_release(tin->memory, edges.out);
    edges.out = NULL;
    status = tin_find_overlap(tin, outline, count, tolerance, error);
cleanup:
    scree_release(tin->memory, outline);
    scree_release(tin->memory, edges.out);
    scree_release(tin->memory, edges.start);
    return status;
}

enum scree_status tin_mend(struct tin *tin, struct tin_mended *mended, struct scree_error *error) {
    struct triangles counted = {0};
    *mended = (struct tin_mended){0};
    enum scree_status status = check_input(tin, error);
    if (status != SCREE_OK) return status;
    const struct scale scale = measure(tin);
    status = weld(tin, scale.extent, mended, error);
    if (status == SCREE_OK) status = drop_lines(tin, &scale, &counted, mended, error);
    /* of two places, each rounded in two directions */
    const double mean_edge = counted.longest_edge_sum / fmax((double)counted.turned[0] + counted.turned[1], 1);
    const double tolerance = fmin(2 * scale.rounding, LATTICE * mean_edge);
    if (status == SCREE_OK) status = turn(tin, tolerance, counted.turned[0] >= counted.turned[1], mended, error);
    if (status == SCREE_OK) status = check_surface(tin, tolerance, mended, error);
    if (status != SCREE_OK) return status;
    uint32_t kept = 0;
    for (size_t t = 0; t < tin->triangle_count; t++) {
        if (is_gone(tin, t)) continue;
        for (size_t k = 0; k < 3; k++) tin->corners[3 * (size_t)kept + k] = tin->corners[3 * t + k];
        kept++;
    }
    tin->triangle_count = kept;
    if (kept == 0) return scree_fail(error, SCREE_E_CORRUPT, "has no triangle with an area");
    status = tin_drop_unused(tin, &mended->unused, error);
    if (status == SCREE_OK) mended->unused -= mended->welded; /* of which no corner was left */
    return status;
}
