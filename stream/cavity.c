#include "stream/cavity.h"

#include <math.h>
#include <string.h>

void cavity_models_start(struct cavity_models *models) {
    for (int fan = 0; fan < 2; fan++)
        for (int count = 0; count < 4; count++)
            for (int angle = 0; angle < CAVITY_ANGLES; angle++) models->inside[fan][count][angle] = bit_model(40);
}

static bool is_common(const struct cavity *cavity, uint32_t vertex) {
    for (uint32_t i = 0; i < cavity->common_count; i++)
        if (cavity->common[i] == vertex) return true;
    return false;
}

static void keep_common(struct cavity *cavity, uint32_t a, uint32_t b) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < cavity->common_count; i++)
        if (cavity->common[i] == a || cavity->common[i] == b) cavity->common[kept++] = cavity->common[i];
    cavity->common_count = kept;
}

/* The sum of the cotangents of the angles that face the edge (x, y) from both sides: negative where the edge from v to
 * w is the one that Delaunay would draw. */
static int angle_class(const struct scree_vertex *v, const struct scree_vertex *w, const struct scree_vertex *x,
                       const struct scree_vertex *y) {
    static const double limits[CAVITY_ANGLES - 1] = {-4, -1.5, -0.6, -0.1, 0.5, 1.3, 3};
    double vx_x = (double)x->x - v->x, vx_y = (double)x->y - v->y, vy_x = (double)y->x - v->x,
           vy_y = (double)y->y - v->y;
    double wx_x = (double)x->x - w->x, wx_y = (double)x->y - w->y, wy_x = (double)y->x - w->x,
           wy_y = (double)y->y - w->y;
    double cross_v = vx_x * vy_y - vx_y * vy_x, cross_w = wy_x * wx_y - wy_y * wx_x;
    double dot_v = vx_x * vy_x + vx_y * vy_y, dot_w = wx_x * wy_x + wx_y * wy_y;
    double sum = (dot_v * cross_w + dot_w * cross_v) / (cross_v * cross_w);
    int low = 0;
    for (int step = CAVITY_ANGLES / 2; step > 0; step /= 2) low += sum > limits[low + step - 1] ? step : 0;
    return low;
}

/* Whether the triangle beyond an outer edge makes way too. */
static bool goes_on(const struct cavity_walk *walk, const struct scree_vertex *at, uint32_t edge,
                    const struct cavity *cavity) {
    const struct surface *surface = walk->surface;
    uint32_t beyond = surface_twin(surface, edge);
    if (beyond == SURFACE_NONE || cavity->triangle_count == CAVITY_MOST) return false;
    uint32_t x = surface_origin(surface, edge), y = surface_origin(surface, beyond);
    const struct scree_vertex *from = &surface->vertices[x], *to = &surface->vertices[y];
    const struct scree_vertex *apex = &surface->vertices[surface_origin(surface, surface_previous(beyond))];
    if (surface_area2(at, from, apex) <= 0 || surface_area2(at, apex, to) <= 0) return false;
    bool stays_fan = is_common(cavity, x) || is_common(cavity, y);
    uint32_t count = cavity->triangle_count;
    struct bit_model *model =
        &walk->models->inside[stays_fan][count < 4 ? count - 1 : 3][angle_class(at, apex, from, to)];
    return code_bit(walk->coder, model, walk->coder->writing && walk->is_inside(walk->context, x, y));
}

/* The edge of the triangle on which the point lies, or SURFACE_NONE. */
static uint32_t edge_under(const struct surface *surface, uint32_t triangle, const struct scree_vertex *at) {
    for (uint32_t edge = 4 * triangle; edge < 4 * triangle + 3; edge++) {
        const struct scree_vertex *from = &surface->vertices[surface_origin(surface, edge)];
        const struct scree_vertex *to = &surface->vertices[surface_origin(surface, surface_next(edge))];
        if (surface_area2(from, to, at) == 0) return edge;
    }
    return SURFACE_NONE;
}

/* Begins a cavity with the triangle, or with both at the edge on which the point lies; puts the outer edges on a stack,
 * the first on top. */
static uint32_t begin_cavity(const struct surface *surface, uint32_t triangle, const struct scree_vertex *at,
                             struct cavity *cavity) {
    uint32_t under = edge_under(surface, triangle, at), depth = 0, *stack = cavity->slots;
    uint32_t first = under == SURFACE_NONE ? 4 * triangle : under, beyond = surface_twin(surface, first);
    cavity->edge_count = 0;
    cavity->triangle_count = 1;
    cavity->triangles[0] = triangle;
    cavity->open = under != SURFACE_NONE && beyond == SURFACE_NONE;
    cavity->common_count = 3;
    memcpy(cavity->common, surface->triangles[triangle].vertex, sizeof cavity->common);
    if (under != SURFACE_NONE && beyond != SURFACE_NONE) {
        cavity->triangles[cavity->triangle_count++] = beyond >> 2;
        keep_common(cavity, surface_origin(surface, first), surface_origin(surface, beyond));
        stack[depth++] = surface_previous(beyond);
        stack[depth++] = surface_next(beyond);
    }
    stack[depth++] = surface_previous(first);
    stack[depth++] = surface_next(first);
    if (under == SURFACE_NONE) stack[depth++] = first;
    return depth;
}

void cavity_code(const struct cavity_walk *walk, uint32_t triangle, const struct scree_vertex *at,
                 struct cavity *cavity) {
    const struct surface *surface = walk->surface;
    uint32_t *stack = cavity->slots, depth = begin_cavity(surface, triangle, at, cavity);
    while (depth > 0) {
        uint32_t edge = stack[--depth];
        if (!goes_on(walk, at, edge, cavity)) {
            cavity->edges[cavity->edge_count++] = edge;
            continue;
        }
        uint32_t beyond = surface_twin(surface, edge);
        keep_common(cavity, surface_origin(surface, edge), surface_origin(surface, beyond));
        cavity->triangles[cavity->triangle_count++] = beyond >> 2;
        stack[depth++] = surface_previous(beyond);
        stack[depth++] = surface_next(beyond);
    }
}

uint32_t cavity_parent(const struct surface *surface, const struct cavity *cavity, const struct scree_vertex *at) {
    const struct scree_vertex *vertices = surface->vertices;
    bool is_fan = cavity->common_count > 0;
    uint32_t count = is_fan ? cavity->common_count : cavity->edge_count, parent = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t vertex = is_fan ? cavity->common[i] : cavity->from[i];
        double dx = (double)vertices[vertex].x - at->x, dy = (double)vertices[vertex].y - at->y;
        if (dx * dx + dy * dy >= least) continue;
        least = dx * dx + dy * dy;
        parent = vertex;
    }
    return parent;
}
