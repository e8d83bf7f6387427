#include "lod/tin_overlap.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define LEAF_EDGES 8
#define MOST_DEPTH 40
#define THIN       10   /* times the tolerance: thinner triangles may have been moved over each other by rounding */
#define CLOSE      0.02 /* of a small triangle's height */
#define STEP       10   /* times the tolerance, heights differ: not by rounding */
#define KEY_STEPS  4294967295.0

struct box {
    double west, south, east, north;
};

/* A tree of boxes over the edges in the order of a Z curve: node i has the children 2 i and 2 i + 1, and those of the
 * last level eight edges each. */
struct edge_tree {
    uint32_t *edges;
    uint32_t edge_count, leaf_count; /* a power of two */
    struct box *boxes;
};

struct keyed_edge {
    uint64_t key;
    uint32_t edge;
};

static const struct box nowhere = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static struct box both(struct box a, struct box b) {
    return (struct box){fmin(a.west, b.west), fmin(a.south, b.south), fmax(a.east, b.east), fmax(a.north, b.north)};
}

static bool do_meet(const struct box *a, const struct box *b) {
    return a->west <= b->east && b->west <= a->east && a->south <= b->north && b->south <= a->north;
}

static const struct cloud_point *corner_of(const struct tin *tin, uint32_t half_edge, uint32_t steps) {
    return &tin->points[tin->corners[half_edge - half_edge % 3 + (half_edge + steps) % 3]];
}

static struct box box_of(const struct cloud_point *a, const struct cloud_point *b) {
    return (struct box){fmin(a->x, b->x), fmin(a->y, b->y), fmax(a->x, b->x), fmax(a->y, b->y)};
}

/* ---- the tree ---- */

static uint64_t spread(uint64_t bits) {
    bits = (bits | bits << 16) & UINT64_C(0x0000ffff0000ffff);
    bits = (bits | bits << 8) & UINT64_C(0x00ff00ff00ff00ff);
    bits = (bits | bits << 4) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    bits = (bits | bits << 2) & UINT64_C(0x3333333333333333);
    return (bits | bits << 1) & UINT64_C(0x5555555555555555);
}

static int compare_keyed(const void *first, const void *second) {
    const struct keyed_edge *a = first, *b = second;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return (a->edge > b->edge) - (a->edge < b->edge);
}

static enum scree_status sort_edges(const struct tin *tin, const uint32_t *edges, struct edge_tree *tree,
                                    struct scree_error *error) {
    struct keyed_edge *order =
        scree_allocate(tin->memory, tree->edge_count, sizeof *order, "the outline of a TIN", error);
    if (order == NULL) return error->status;
    struct box all = nowhere;
    for (uint32_t i = 0; i < tree->edge_count; i++) {
        const struct cloud_point *a = corner_of(tin, edges[i], 0);
        all = both(all, box_of(a, a));
    }
    const double side = fmax(fmax(all.east - all.west, all.north - all.south), 1e-300);
    for (uint32_t i = 0; i < tree->edge_count; i++) {
        const struct cloud_point *a = corner_of(tin, edges[i], 0);
        uint64_t x = (uint64_t)((a->x - all.west) / side * KEY_STEPS);
        uint64_t y = (uint64_t)((a->y - all.south) / side * KEY_STEPS);
        order[i] = (struct keyed_edge){spread(x) | spread(y) << 1, edges[i]};
    }
    qsort(order, tree->edge_count, sizeof *order, compare_keyed);
    for (uint32_t i = 0; i < tree->edge_count; i++) tree->edges[i] = order[i].edge;
    scree_release(tin->memory, order);
    return SCREE_OK;
}

static enum scree_status plant(const struct tin *tin, const uint32_t *edges, struct edge_tree *tree,
                               struct scree_error *error) {
    tree->leaf_count = 1;
    while ((uint64_t)tree->leaf_count * LEAF_EDGES < tree->edge_count) tree->leaf_count *= 2;
    tree->edges = scree_allocate(tin->memory, tree->edge_count, sizeof *tree->edges, "the outline of a TIN", error);
    tree->boxes =
        scree_allocate(tin->memory, 2 * (size_t)tree->leaf_count, sizeof *tree->boxes, "the outline of a TIN", error);
    if (tree->edges == NULL || tree->boxes == NULL) return error->status;
    enum scree_status status = sort_edges(tin, edges, tree, error);
    if (status != SCREE_OK) return status;
    for (uint32_t leaf = 0; leaf < tree->leaf_count; leaf++) {
        struct box *box = &tree->boxes[tree->leaf_count + leaf];
        *box = nowhere;
        for (uint64_t i = (uint64_t)leaf * LEAF_EDGES; i < (leaf + UINT64_C(1)) * LEAF_EDGES && i < tree->edge_count;
             i++)
            *box = both(*box, box_of(corner_of(tin, tree->edges[i], 0), corner_of(tin, tree->edges[i], 1)));
    }
    for (uint32_t node = tree->leaf_count - 1; node > 0; node--)
        tree->boxes[node] = both(tree->boxes[2 * node], tree->boxes[2 * node + 1]);
    return SCREE_OK;
}

/* ---- the inner side of an edge ---- */

struct place {
    double x, y;
};

/* The part of a line, from 0 at its start to 1 at its end, that is farther than `depth` inside of a triangle; places
 * count from `origin`. */
static void clip(const struct tin *tin, uint32_t triangle, const struct cloud_point *origin, const struct place line[2],
                 double depth, double range[2]) {
    for (uint32_t k = 0; k < 3; k++) {
        const struct cloud_point *a = corner_of(tin, 3 * triangle, k), *b = corner_of(tin, 3 * triangle, k + 1);
        const double dx = b->x - a->x, dy = b->y - a->y, length = sqrt(dx * dx + dy * dy);
        const double ax = a->x - origin->x, ay = a->y - origin->y;
        double inside[2]; /* how far, at both ends */
        for (int end = 0; end < 2; end++)
            inside[end] = (dx * (line[end].y - ay) - dy * (line[end].x - ax)) / length - depth;
        if (inside[0] <= 0 && inside[1] <= 0) {
            range[1] = -1;
            return;
        }
        if (inside[0] > 0 && inside[1] > 0) continue;
        const double crossing = inside[0] / (inside[0] - inside[1]);
        if (inside[0] <= 0)
            range[0] = fmax(range[0], crossing);
        else
            range[1] = fmin(range[1], crossing);
    }
}

static double height_at(const struct tin *tin, uint32_t triangle, const struct cloud_point *origin,
                        struct place place) {
    const struct cloud_point *a = corner_of(tin, 3 * triangle, 0), *b = corner_of(tin, 3 * triangle, 1);
    const struct cloud_point *c = corner_of(tin, 3 * triangle, 2);
    const double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y, area = bx * cy - by * cx;
    const double x = place.x - (a->x - origin->x), y = place.y - (a->y - origin->y);
    return a->z + (x * cy - y * cx) / area * (b->z - a->z) + (bx * y - by * x) / area * (c->z - a->z);
}

/* A place where the edge's own triangle and another one both are, from the edge. */
struct meeting {
    struct place place;
    double heights[2];
};

/* Looks along the line that is 2 * depth inside of the edge's own triangle, for where `other` is, and by `depth`. */
static bool do_overlap(const struct tin *tin, uint32_t edge, uint32_t other, double depth, struct meeting *meeting) {
    const struct cloud_point *a = corner_of(tin, edge, 0), *b = corner_of(tin, edge, 1);
    const double dx = b->x - a->x, dy = b->y - a->y, length = sqrt(dx * dx + dy * dy);
    const double x = -dy / length * 2 * depth, y = dx / length * 2 * depth;
    const struct place line[2] = {{x, y}, {dx + x, dy + y}};
    double range[2] = {0, 1};
    clip(tin, other, a, line, depth, range);
    if (range[0] < range[1]) clip(tin, edge / 3, a, line, 0, range);
    if (!(range[0] < range[1])) return false;
    const double at = (range[0] + range[1]) / 2;
    meeting->place = (struct place){x + at * dx, y + at * dy};
    meeting->heights[0] = height_at(tin, edge / 3, a, meeting->place);
    meeting->heights[1] = height_at(tin, other, a, meeting->place);
    return true;
}

/* From an edge to the third corner of its triangle, in plan. */
static double apex_distance(const struct tin *tin, uint32_t edge) {
    const struct cloud_point *a = corner_of(tin, edge, 0), *b = corner_of(tin, edge, 1), *c = corner_of(tin, edge, 2);
    const double dx = b->x - a->x, dy = b->y - a->y;
    return (dx * (c->y - a->y) - dy * (c->x - a->x)) / sqrt(dx * dx + dy * dy);
}

/* The heights that a triangle may have near a place: its height there, or, when it is so thin that nobody knows where
 * in it the place really is, all of its own. */
static void heights_near(const struct tin *tin, uint32_t triangle, double height, double thin, double range[2]) {
    range[0] = range[1] = height;
    for (uint32_t k = 0; k < 3; k++)
        if (apex_distance(tin, 3 * triangle + k) < thin)
            for (uint32_t corner = 0; corner < 3; corner++) {
                range[0] = fmin(range[0], corner_of(tin, 3 * triangle, corner)->z);
                range[1] = fmax(range[1], corner_of(tin, 3 * triangle, corner)->z);
            }
}

/* Triangles that are hardly larger than the tolerance are looked at more closely, but there one has to be clearly above
 * the other: such as are next to each other may have been moved over each other by rounding. Smaller ones tell nothing.
 */
static enum scree_status look(const struct tin *tin, uint32_t edge, uint32_t other, double tolerance,
                              struct scree_error *error) {
    const struct cloud_point *a = corner_of(tin, edge, 0);
    const double height = apex_distance(tin, edge), thin = THIN * tolerance;
    struct meeting meeting;
    bool is_overlap = do_overlap(tin, edge, other, tolerance, &meeting);
    if (!is_overlap && height > tolerance && height < thin && do_overlap(tin, edge, other, CLOSE * height, &meeting)) {
        double own[2], others[2];
        heights_near(tin, edge / 3, meeting.heights[0], thin, own);
        heights_near(tin, other, meeting.heights[1], thin, others);
        is_overlap = fmax(own[0] - others[1], others[0] - own[1]) > STEP * tolerance;
    }
    if (!is_overlap) return SCREE_OK;
    return scree_fail(error, SCREE_E_CORRUPT,
                      "triangles lie one above the other at %.10g %.10g, at heights %.6g and %.6g; a terrain has one "
                      "height at a place (--grid takes the highest)",
                      a->x + meeting.place.x, a->y + meeting.place.y, fmin(meeting.heights[0], meeting.heights[1]),
                      fmax(meeting.heights[0], meeting.heights[1]));
}

/* A triangle as the tree is searched for it. */
struct probe {
    struct box box;
    const struct cloud_point *corners[3];
};

/* Neither the triangle's box nor the line of one of its edges parts them: long thin triangles have large boxes. */
static bool may_touch(const struct probe *probe, const struct box *box) {
    if (!do_meet(&probe->box, box)) return false;
    for (int k = 0; k < 3; k++) {
        const struct cloud_point *a = probe->corners[k], *b = probe->corners[(k + 1) % 3];
        const double dx = b->x - a->x, dy = b->y - a->y;
        const double x = dy > 0 ? box->west : box->east, y = dx > 0 ? box->north : box->south; /* farthest inside */
        if (dx * (y - a->y) - dy * (x - a->x) < 0) return false;
    }
    return true;
}

/* Looks along all edges near a triangle. */
static enum scree_status look_around(const struct tin *tin, const struct edge_tree *tree, uint32_t triangle,
                                     double tolerance, struct scree_error *error) {
    struct probe probe;
    enum scree_status status = SCREE_OK;
    uint32_t nodes[MOST_DEPTH], count = 0;
    for (uint32_t k = 0; k < 3; k++) probe.corners[k] = corner_of(tin, 3 * triangle, k);
    probe.box = both(box_of(probe.corners[0], probe.corners[1]), box_of(probe.corners[0], probe.corners[2]));
    nodes[count++] = 1;
    while (count > 0 && status == SCREE_OK) {
        const uint32_t node = nodes[--count];
        if (!may_touch(&probe, &tree->boxes[node])) continue;
        if (node < tree->leaf_count) {
            nodes[count++] = 2 * node;
            nodes[count++] = 2 * node + 1;
            continue;
        }
        const uint64_t first = (uint64_t)(node - tree->leaf_count) * LEAF_EDGES;
        for (uint64_t i = first; i < first + LEAF_EDGES && i < tree->edge_count && status == SCREE_OK; i++) {
            const struct box edge_box = box_of(corner_of(tin, tree->edges[i], 0), corner_of(tin, tree->edges[i], 1));
            if (tree->edges[i] / 3 != triangle && may_touch(&probe, &edge_box))
                status = look(tin, tree->edges[i], triangle, tolerance, error);
        }
    }
    return status;
}

enum scree_status tin_find_overlap(const struct tin *tin, const uint32_t *edges, uint32_t edge_count, double tolerance,
                                   struct scree_error *error) {
    struct edge_tree tree = {.edge_count = edge_count};
    enum scree_status status = plant(tin, edges, &tree, error);
    for (uint32_t t = 0; t < tin->triangle_count && status == SCREE_OK; t++)
        if (tin->corners[3 * (size_t)t] != TIN_NONE) status = look_around(tin, &tree, t, tolerance, error);
    scree_release(tin->memory, tree.boxes);
    scree_release(tin->memory, tree.edges);
    return status;
}
