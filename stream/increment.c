#include "stream/increment.h"

#include <math.h>
#include <string.h>

#define POST_CLASSES  12
#define ANGLE_CLASSES 8 /* a power of two */
#define MOST_ROUNDS   1024
#define HEIGHT_BITS   31
#define HEIGHT_MEMORY 4 /* residuals of earlier increments count as so many */
#define MOST_HEIGHT   (1 << 30)

struct increment_models {
    struct bit_model more[3][POST_CLASSES]; /* whether one more vertex lies in a triangle */
    struct post_models posts;
    struct bit_model ready[2][3][4];
    struct bit_model inside[2][4][ANGLE_CLASSES]; /* whether the walk goes on over an edge */
    struct bit_model height_bits[2][HEIGHT_BITS + 1];
    struct bit_model mantissa[2][HEIGHT_BITS + 1][3];
    struct bit_model sign[4];
};

static void start_models(struct bit_model *models, size_t count, int percent) {
    for (size_t i = 0; i < count; i++) models[i] = bit_model(percent);
}

#define START(member, percent) \
    start_models((struct bit_model *)(member), sizeof(member) / sizeof(struct bit_model), percent)

void increment_forget(struct increment *increment) {
    struct increment_models *models = increment->models;
    START(models->more, 15);
    post_models_start(&models->posts);
    START(models->ready, 70);
    START(models->inside, 40);
    START(models->height_bits, 70);
    START(models->mantissa, 50);
    START(models->sign, 50);
}

/* ---- places ---- */

/* Few posts apart, many by the power of two. */
static int post_class(uint16_t posts) {
    static const unsigned char few[9] = {0, 0, 1, 2, 3, 3, 4, 4, 4};
    if (posts <= 8) return few[posts];
    int class = 5;
    for (uint32_t limit = 16; posts > limit && class < POST_CLASSES - 1; limit *= 2) class ++;
    return class;
}

/* How many vertices lie in the triangle. */
static uint32_t code_count(struct increment *increment, const struct surface_triangle *at, uint32_t count) {
    int class = post_class(at->posts);
    uint32_t coded = 0;
    while (coded < at->posts &&
           code_bit(increment->coder, &increment->models->more[coded < 2 ? coded : 2][class], coded < count))
        coded++;
    return coded;
}

static bool code_places(struct increment *increment, uint32_t triangle, uint32_t most) {
    struct surface_triangle *at = &increment->surface->triangles[triangle];
    struct pending *coded = &increment->pending[increment->pending_count];
    const struct pending *places = NULL;
    uint32_t count = increment->plan != NULL ? increment->plan->places(increment->plan->context, triangle, &places) : 0;
    count = code_count(increment, at, count);
    if (count > most - increment->pending_count) return false;
    if (count == 0) return true;
    if (places != NULL)
        memcpy(coded, places, count * sizeof *coded);
    else
        memset(coded, 0, count * sizeof *coded);
    if (!posts_code(increment->coder, &increment->models->posts, increment->surface, triangle, count, coded))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        coded[i].triangle = triangle;
        coded[i].next = at->first;
        at->first = increment->pending_count++;
    }
    return true;
}

/* ---- the walk ---- */

/* Corners that all triangles of the cavity have in common: of a fan at least one. */
struct common {
    uint32_t count, vertex[3];
};

static bool is_common(const struct common *common, uint32_t vertex) {
    for (uint32_t i = 0; i < common->count; i++)
        if (common->vertex[i] == vertex) return true;
    return false;
}

static void keep_common(struct common *common, uint32_t a, uint32_t b) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < common->count; i++)
        if (common->vertex[i] == a || common->vertex[i] == b) common->vertex[kept++] = common->vertex[i];
    common->count = kept;
}

/* The sum of the cotangents of the angles that face the edge (x, y) from both sides: negative where the edge from v to
 * w is the one that Delaunay would draw. */
static int angle_class(const struct scree_vertex *v, const struct scree_vertex *w, const struct scree_vertex *x,
                       const struct scree_vertex *y) {
    static const double limits[ANGLE_CLASSES - 1] = {-4, -1.5, -0.6, -0.1, 0.5, 1.3, 3};
    double vx_x = (double)x->x - v->x, vx_y = (double)x->y - v->y, vy_x = (double)y->x - v->x,
           vy_y = (double)y->y - v->y;
    double wx_x = (double)x->x - w->x, wx_y = (double)x->y - w->y, wy_x = (double)y->x - w->x,
           wy_y = (double)y->y - w->y;
    double cross_v = vx_x * vy_y - vx_y * vy_x, cross_w = wy_x * wx_y - wy_y * wx_x;
    double dot_v = vx_x * vy_x + vx_y * vy_y, dot_w = wx_x * wy_x + wx_y * wy_y;
    double sum = (dot_v * cross_w + dot_w * cross_v) / (cross_v * cross_w);
    int low = 0;
    for (int step = ANGLE_CLASSES / 2; step > 0; step /= 2) low += sum > limits[low + step - 1] ? step : 0;
    return low;
}

/* Whether the triangle beyond an outer edge makes way too. */
static bool goes_on(struct increment *increment, const struct scree_vertex *at, uint32_t edge,
                    const struct common *common) {
    struct surface *surface = increment->surface;
    uint32_t beyond = surface_twin(surface, edge);
    if (beyond == SURFACE_NONE || increment->cavity->triangle_count == CAVITY_MOST) return false;
    uint32_t x = surface_origin(surface, edge), y = surface_origin(surface, beyond);
    const struct scree_vertex *from = &surface->vertices[x], *to = &surface->vertices[y];
    const struct scree_vertex *apex = &surface->vertices[surface_origin(surface, surface_previous(beyond))];
    if (surface_area2(at, from, apex) <= 0 || surface_area2(at, apex, to) <= 0) return false;
    bool stays_fan = is_common(common, x) || is_common(common, y);
    uint32_t count = increment->cavity->triangle_count;
    struct bit_model *model =
        &increment->models->inside[stays_fan][count < 4 ? count - 1 : 3][angle_class(at, apex, from, to)];
    bool inside = increment->plan != NULL && increment->plan->is_inside(increment->plan->context, x, y);
    return code_bit(increment->coder, model, inside);
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
                             struct cavity *cavity, struct common *common) {
    uint32_t under = edge_under(surface, triangle, at), depth = 0, *stack = cavity->slots;
    uint32_t first = under == SURFACE_NONE ? 4 * triangle : under, beyond = surface_twin(surface, first);
    cavity->edge_count = 0;
    cavity->triangle_count = 1;
    cavity->triangles[0] = triangle;
    cavity->open = under != SURFACE_NONE && beyond == SURFACE_NONE;
    *common = (struct common){3, {0}};
    memcpy(common->vertex, surface->triangles[triangle].vertex, sizeof common->vertex);
    if (under != SURFACE_NONE && beyond != SURFACE_NONE) {
        cavity->triangles[cavity->triangle_count++] = beyond >> 2;
        keep_common(common, surface_origin(surface, first), surface_origin(surface, beyond));
        stack[depth++] = surface_previous(beyond);
        stack[depth++] = surface_next(beyond);
    }
    stack[depth++] = surface_previous(first);
    stack[depth++] = surface_next(first);
    if (under == SURFACE_NONE) stack[depth++] = first;
    return depth;
}

static void walk(struct increment *increment, uint32_t triangle, const struct scree_vertex *at, struct common *common) {
    const struct surface *surface = increment->surface;
    struct cavity *cavity = increment->cavity;
    uint32_t *stack = cavity->slots, depth = begin_cavity(surface, triangle, at, cavity, common);
    while (depth > 0) {
        uint32_t edge = stack[--depth];
        if (!goes_on(increment, at, edge, common)) {
            cavity->edges[cavity->edge_count++] = edge;
            continue;
        }
        uint32_t beyond = surface_twin(surface, edge);
        keep_common(common, surface_origin(surface, edge), surface_origin(surface, beyond));
        cavity->triangles[cavity->triangle_count++] = beyond >> 2;
        stack[depth++] = surface_previous(beyond);
        stack[depth++] = surface_next(beyond);
    }
}

/* ---- heights ---- */

/* The triangle's plane at a place, less the height there of a first vertex. */
static double plane_at(const struct surface *surface, uint32_t triangle, const struct scree_vertex *at) {
    const uint32_t *vertex = surface->triangles[triangle].vertex;
    const struct scree_vertex *a = &surface->vertices[vertex[0]], *b = &surface->vertices[vertex[1]];
    const struct scree_vertex *c = &surface->vertices[vertex[2]];
    double area2 = (double)surface_area2(a, b, c);
    double of_b = (double)surface_area2(a, at, c) / area2, of_c = (double)surface_area2(a, b, at) / area2;
    return a->height + of_b * ((double)b->height - a->height) + of_c * ((double)c->height - a->height);
}

/* How many of the neighbouring triangles' far corners lie above the triangle's plane. */
static int corners_above(const struct surface *surface, uint32_t triangle) {
    int above = 0;
    for (uint32_t edge = 4 * triangle; edge < 4 * triangle + 3; edge++) {
        uint32_t beyond = surface_twin(surface, edge);
        if (beyond == SURFACE_NONE) continue;
        const struct scree_vertex *far = &surface->vertices[surface_origin(surface, surface_previous(beyond))];
        above += far->height > plane_at(surface, triangle, far);
    }
    return above;
}

/* A number without sign: its length in bits, then the bits behind the first one, the upper two of them learned. */
static uint32_t code_size(struct increment *increment, bool on_border, uint32_t size) {
    struct range_coder *coder = increment->coder;
    struct increment_models *models = increment->models;
    uint32_t bits = 0, value = 1, node = 0;
    while (bits < HEIGHT_BITS && code_bit(coder, &models->height_bits[on_border][bits], size >> bits != 0)) bits++;
    if (bits == 0) return 0;
    for (uint32_t below = bits - 1; below > 0; below--) {
        bool bit = (size >> (below - 1) & 1) != 0;
        if (bits - below <= 2) {
            bit = code_bit(coder, &models->mantissa[on_border][bits][node], bit);
            node = 1 + bit;
        } else {
            bit = code_uniform(coder, 2, bit) != 0;
        }
        value = 2 * value + bit;
    }
    return value;
}

static bool code_height(struct increment *increment, uint32_t triangle, struct scree_vertex *at) {
    bool on_border = increment->cavity->open;
    double step = increment->height_step;
    int64_t expected = (int64_t)floor(plane_at(increment->surface, triangle, at) / step + 0.5), off = 0;
    if (increment->plan != NULL)
        off = increment->plan->height(increment->plan->context) / increment->height_step - expected;
    uint32_t size = code_size(increment, on_border, (uint32_t)(off < 0 ? -off : off));
    if (size != 0) {
        struct bit_model *model = &increment->models->sign[corners_above(increment->surface, triangle)];
        off = code_bit(increment->coder, model, off < 0) ? -(int64_t)size : (int64_t)size;
    } else {
        off = 0;
    }
    int64_t height = (expected + off) * increment->height_step;
    if (height < -MOST_HEIGHT || height > MOST_HEIGHT) return false;
    at->height = (int32_t)height;
    return true;
}

/* ---- insertions ---- */

static int pending_in(const struct increment *increment, uint32_t triangle) {
    int count = 0;
    for (uint32_t p = increment->surface->triangles[triangle].first; p != SURFACE_NONE && count < 3;
         p = increment->pending[p].next)
        count++;
    return count;
}

static bool code_ready(struct increment *increment, const struct pending *pending, int round) {
    int own = pending_in(increment, pending->triangle) - 1, near = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t twin = increment->surface->triangles[pending->triangle].twin[i];
        if (twin != SURFACE_NONE) near += pending_in(increment, twin >> 2);
    }
    struct bit_model *model = &increment->models->ready[round > 0][own < 2 ? own : 2][near < 3 ? near : 3];
    bool ready = increment->plan != NULL && increment->plan->ready(increment->plan->context, pending);
    return code_bit(increment->coder, model, ready);
}

/* Where the vertex comes out of: the corner about which the cavity is a fan; the nearest where there are several, or
 * none. */
static uint32_t parent_of(const struct increment *increment, const struct scree_vertex *at,
                          const struct common *common) {
    const struct cavity *cavity = increment->cavity;
    const struct scree_vertex *vertices = increment->surface->vertices;
    uint32_t count = common->count > 0 ? common->count : cavity->edge_count, parent = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t vertex = common->count > 0 ? common->vertex[i] : cavity->from[i];
        double dx = (double)vertices[vertex].x - at->x, dy = (double)vertices[vertex].y - at->y;
        if (dx * dx + dy * dy >= least) continue;
        least = dx * dx + dy * dy;
        parent = vertex;
    }
    return parent;
}

/* Takes the pending vertices out of the triangles that make way; returns the first of them, linked. */
static uint32_t gather(struct increment *increment, uint32_t but) {
    uint32_t gathered = SURFACE_NONE;
    for (uint32_t i = 0; i < increment->cavity->triangle_count; i++) {
        uint32_t *first = &increment->surface->triangles[increment->cavity->triangles[i]].first;
        for (uint32_t p = *first, next; p != SURFACE_NONE; p = next) {
            next = increment->pending[p].next;
            if (p == but) continue;
            increment->pending[p].next = gathered;
            gathered = p;
        }
        *first = SURFACE_NONE;
    }
    return gathered;
}

/* Takes steps off those that are left; none are left where there are too few. */
static void charge(struct increment *increment, uint32_t steps) {
    increment->steps_left = increment->steps_left > steps ? increment->steps_left - steps : 0;
}

static void hand_out(struct increment *increment, uint32_t gathered) {
    const struct cavity *cavity = increment->cavity;
    for (uint32_t p = gathered, next; p != SURFACE_NONE; p = next) {
        struct pending *pending = &increment->pending[p];
        next = pending->next;
        uint32_t i = 0;
        while (i + 1 < cavity->edge_count &&
               !posts_belong(increment->surface, cavity->slots[i], pending->x, pending->y))
            i++;
        charge(increment, i + 1);
        pending->triangle = cavity->slots[i];
        pending->next = increment->surface->triangles[pending->triangle].first;
        increment->surface->triangles[pending->triangle].first = p;
    }
}

static void insert(struct increment *increment, uint32_t p, const struct scree_vertex *vertex,
                   const struct common *common) {
    struct surface *surface = increment->surface;
    struct cavity *cavity = increment->cavity;
    struct progressive *splits = increment->splits;
    uint32_t gathered = gather(increment, p), number = surface->vertex_count;
    surface->vertices[number] = *vertex;
    if (increment->plan != NULL) increment->plan->inserting(increment->plan->context, cavity);
    surface_insert(surface, cavity, splits);
    hand_out(increment, gathered);
    if (increment->plan != NULL) increment->plan->inserted(increment->plan->context, cavity);
    if (splits == NULL) return;
    struct progressive_split *split = &splits->splits[splits->split_count - 1];
    split->parent = parent_of(increment, vertex, common);
    split->triangle_end = surface->triangle_count;
}

static enum scree_status make_room(struct increment *increment, struct scree_error *error) {
    struct progressive *splits = increment->splits;
    uint64_t wanted = splits == NULL ? 0 : splits->fixup_count + 3 * (uint64_t)increment->cavity->triangle_count;
    if (splits == NULL || wanted <= splits->fixup_capacity) return SCREE_OK;
    wanted += wanted / 2;
    if (wanted > UINT32_MAX) return scree_fail(error, SCREE_E_LIMIT, "too many triangles change in one stream");
    struct progressive_fixup *larger =
        scree_reallocate(increment->memory, splits->fixups, (size_t)wanted, sizeof *larger, "a stream's splits", error);
    if (larger == NULL) return error != NULL && error->status == SCREE_E_LIMIT ? SCREE_E_LIMIT : SCREE_E_MEMORY;
    splits->fixups = larger;
    splits->fixup_capacity = (uint32_t)wanted;
    return SCREE_OK;
}

static enum scree_status code_insertion(struct increment *increment, uint32_t p, struct scree_error *error) {
    struct pending *pending = &increment->pending[p];
    struct scree_vertex vertex = {pending->x, pending->y, 0};
    struct common common;
    walk(increment, pending->triangle, &vertex, &common);
    increment->coder->cost_bits = increment->height_bits;
    bool fine = code_height(increment, pending->triangle, &vertex);
    increment->coder->cost_bits = increment->connectivity_bits;
    if (!fine) return scree_fail(error, SCREE_E_CORRUPT, "a vertex is higher than any can be");
    uint32_t opened = increment->cavity->triangle_count, added = increment->cavity->edge_count - opened;
    charge(increment, opened);
    if (increment->steps_left == 0 || increment->openings_left < opened)
        return scree_fail(error, increment->plan != NULL ? SCREE_E_LIMIT : SCREE_E_CORRUPT,
                          "an increment changes more triangles than its vertices are worth");
    increment->openings_left -= opened;
    if (added > increment->surface->triangle_capacity - increment->surface->triangle_count)
        return scree_fail(error, SCREE_E_CORRUPT, "an increment has more triangles than the header says");
    enum scree_status status = make_room(increment, error);
    if (status == SCREE_OK) insert(increment, p, &vertex, &common);
    return status;
}

static void reverse(uint32_t *list, uint32_t count) {
    for (uint32_t i = 0; i < count / 2; i++) {
        uint32_t first = list[i];
        list[i] = list[count - 1 - i];
        list[count - 1 - i] = first;
    }
}

/* Rounds over those that wait, until none does; back and forth, so that a row of vertices that wait for one another
 * comes in one round or two. */
static enum scree_status code_insertions(struct increment *increment, struct scree_error *error) {
    uint32_t waiting = increment->pending_count;
    for (uint32_t p = 0; p < waiting; p++) increment->waiting[p] = p;
    for (int round = 0; waiting > 0; round++) {
        uint32_t left = 0;
        for (uint32_t i = 0; i < waiting; i++) {
            uint32_t p = increment->waiting[i];
            charge(increment, 1);
            if (!code_ready(increment, &increment->pending[p], round)) {
                increment->waiting[left++] = p;
                continue;
            }
            enum scree_status status = code_insertion(increment, p, error);
            if (status != SCREE_OK) return status;
        }
        if (left == waiting || round == MOST_ROUNDS)
            return scree_fail(error, SCREE_E_CORRUPT, "vertices of an increment wait for each other");
        waiting = left;
        if (round > 0) reverse(increment->waiting, waiting);
    }
    return SCREE_OK;
}

/* Residuals shrink from rung to rung: what was learned of them is soon overruled. */
static void hurry_heights(struct increment_models *models) {
    struct bit_model *first = (struct bit_model *)models->height_bits, *sizes = (struct bit_model *)models->mantissa;
    for (size_t i = 0; i < sizeof models->height_bits / sizeof *first; i++)
        if (first[i].seen > HEIGHT_MEMORY) first[i].seen = HEIGHT_MEMORY;
    for (size_t i = 0; i < sizeof models->mantissa / sizeof *sizes; i++)
        if (sizes[i].seen > HEIGHT_MEMORY) sizes[i].seen = HEIGHT_MEMORY;
}

enum scree_status increment_code(struct increment *increment, uint32_t most, struct scree_error *error) {
    uint32_t triangles = increment->surface->triangle_count;
    if (most > increment->pending_capacity) most = increment->pending_capacity;
    increment->pending_count = 0;
    hurry_heights(increment->models);
    increment->coder->cost_bits = increment->position_bits;
    for (uint32_t t = 0; t < triangles; t++)
        if (increment->surface->triangles[t].posts > 0 && !code_places(increment, t, most))
            return scree_fail(error, SCREE_E_CORRUPT, "a place of an increment is not one");
    increment->coder->cost_bits = increment->connectivity_bits;
    increment->steps_left += (uint64_t)INCREMENT_STEPS_PER_VERTEX * increment->pending_count;
    increment->openings_left += (uint64_t)INCREMENT_OPENINGS_PER_VERTEX * increment->pending_count;
    return code_insertions(increment, error);
}

enum scree_status increment_start(struct scree_memory *memory, uint32_t most, struct surface *surface,
                                  struct increment *increment, struct scree_error *error) {
    memset(increment, 0, sizeof *increment);
    increment->memory = memory;
    increment->surface = surface;
    increment->pending_capacity = most;
    increment->steps_left = INCREMENT_STEPS_FREE;
    increment->openings_left = INCREMENT_OPENINGS_FREE;
    increment->models = scree_allocate(memory, 1, sizeof *increment->models, "a stream's models", error);
    increment->cavity = scree_allocate(memory, 1, sizeof *increment->cavity, "a stream's models", error);
    increment->pending = scree_allocate(memory, most, sizeof *increment->pending, "an increment's vertices", error);
    increment->waiting = scree_allocate(memory, most, sizeof *increment->waiting, "an increment's vertices", error);
    if (increment->models == NULL || increment->cavity == NULL || increment->pending == NULL ||
        increment->waiting == NULL) {
        increment_release(increment);
        return SCREE_E_MEMORY;
    }
    increment_forget(increment);
    return SCREE_OK;
}

bool increment_reserve(struct increment *increment, uint32_t most, struct scree_error *error) {
    if (most <= increment->pending_capacity) return true;
    struct pending *pending = scree_reallocate(increment->memory, increment->pending, most, sizeof *pending,
                                               "an increment's vertices", error);
    if (pending == NULL) return false;
    increment->pending = pending;
    uint32_t *waiting = scree_reallocate(increment->memory, increment->waiting, most, sizeof *waiting,
                                         "an increment's vertices", error);
    if (waiting == NULL) return false;
    increment->waiting = waiting;
    increment->pending_capacity = most;
    return true;
}

void increment_release(struct increment *increment) {
    scree_release(increment->memory, increment->waiting);
    scree_release(increment->memory, increment->pending);
    scree_release(increment->memory, increment->cavity);
    scree_release(increment->memory, increment->models);
    memset(increment, 0, sizeof *increment);
}
