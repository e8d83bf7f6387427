#include "lod/simplify.h"

#include "lod/ahead.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_JOINED_DEGREE 48    /* no collapse makes a larger star: fans are bad for error and for graphics alike */
#define CANDIDATES        2     /* neighbours, the best of the quadric, whose exact errors are looked at */
#define LEAST_CLASS       0.25f /* growths below this share of the squared tolerance are all alike */

enum vertex_state {
    STATE_FIXED,   /* dead, on the border, locked, or of too large a star */
    STATE_QUEUED,  /* in the queue with a target that still holds */
    STATE_CHANGED, /* in the queue; its star has changed since it was looked at */
    STATE_REFUSED  /* not in the queue: no collapse within the tolerance */
};

/* A collapse that has been looked at. */
struct candidate {
    int32_t target;  /* index in the ring; MESH_NONE: none is admissible */
    float growth;    /* of the sum of squared errors, m2 */
    float refused_m; /* where none is: below this tolerance none can be */
    struct triangle_error errors[MESH_MAX_DEGREE];
};

/* The triangles of a closed star that survive a collapse into ring[target] are those of index target + 1 up to
 * target + degree - 2, around the ring. */
static inline int32_t around(int32_t index, int32_t degree) {
    return index >= degree ? index - degree : index;
}

static bool stays_positive(const struct code_frame *codes, const struct star *star, int32_t target) {
    for (int32_t j = 1; j < star->degree - 1; j++) {
        int32_t i = around(target + j, star->degree);
        if (!codes_positive(codes, &star->at[target], &star->at[i], &star->at[i + 1])) return false;
    }
    return true;
}

/* Slopes of the star's triangles and twice their areas: the planes whose quadric proposes. */
struct star_planes {
    double slope_x[MESH_MAX_DEGREE], slope_y[MESH_MAX_DEGREE], area2[MESH_MAX_DEGREE];
};

static void planes_of_star(const struct star *star, const struct sample *at, struct drop drop,
                           struct star_planes *planes) {
    for (int32_t i = 0; i < star->degree; i++) {
        const struct sample *a = &star->at[i], *b = &star->at[i + 1];
        double ax = a->x - at->x, ay = a->y - at->y, az = sample_drawn_m(a, at, drop);
        double bx = b->x - at->x, by = b->y - at->y, bz = sample_drawn_m(b, at, drop);
        double area2 = ax * by - bx * ay, scale = 1 / area2;
        planes->slope_x[i] = (az * by - bz * ay) * scale;
        planes->slope_y[i] = (bz * ax - az * bx) * scale;
        planes->area2[i] = area2;
    }
}

/* The quadric of the star's planes (vertical distances, weighted by area) at a neighbour. */
static double quadric_cost(const struct star *star, const struct sample *at, struct drop drop,
                           const struct star_planes *planes, int32_t neighbour) {
    double x = star->at[neighbour].x - at->x, y = star->at[neighbour].y - at->y;
    double z = sample_drawn_m(&star->at[neighbour], at, drop), cost = 0;
    for (int32_t i = 0; i < star->degree; i++) {
        double distance = z - planes->slope_x[i] * x - planes->slope_y[i] * y;
        cost += distance * distance * planes->area2[i];
    }
    return cost;
}

/* The best admissible neighbours by quadric, in order; returns how many. */
static int propose(const struct simplifier *simplifier, const struct star *star, const struct sample *at,
                   int32_t proposed[CANDIDATES]) {
    struct star_planes planes;
    double costs[CANDIDATES];
    int count = 0;
    struct drop drop = samples_drop(&simplifier->samples, at->y);
    planes_of_star(star, at, drop, &planes);
    for (int32_t k = 0; k < star->degree; k++) {
        double cost = quadric_cost(star, at, drop, &planes, k);
        if (count == CANDIDATES && cost >= costs[count - 1]) continue;
        if (!stays_positive(&simplifier->options.codes, star, k)) continue;
        int place = count < CANDIDATES ? count++ : CANDIDATES - 1;
        for (; place > 0 && costs[place - 1] > cost; place--) {
            costs[place] = costs[place - 1];
            proposed[place] = proposed[place - 1];
        }
        costs[place] = cost;
        proposed[place] = k;
    }
    return count;
}

/* Whether the rungs to come stay within reach. */
static bool keeps_way_open(const struct simplifier *simplifier, const struct star *star, int32_t target,
                           const struct triangle_error errors[MESH_MAX_DEGREE]) {
    if (simplifier->options.ahead == NULL) return true;
    for (int32_t j = 1; j < star->degree - 1; j++) {
        int32_t i = around(target + j, star->degree);
        if (!ahead_admits(simplifier->options.ahead, &star->at[target], &star->at[i], &star->at[i + 1],
                          errors[j].max_m))
            return false;
    }
    return true;
}

/* Looks at one target; improves `best` when it is admissible and cheaper. */
static void measure_target(const struct simplifier *simplifier, const struct star *star, int32_t target,
                           float present_sum, struct candidate *best) {
    struct triangle_error errors[MESH_MAX_DEGREE];
    float sum = -present_sum;
    for (int32_t j = 1; j < star->degree - 1; j++) {
        int32_t i = around(target + j, star->degree);
        errors[j] = samples_triangle_error(&simplifier->samples, &star->at[target], &star->at[i], &star->at[i + 1]);
        sum += errors[j].sum_squares_m2;
        if (errors[j].max_m > simplifier->tolerance_m && !simplifier->options.is_unbounded) {
            if (errors[j].max_m < best->refused_m) best->refused_m = errors[j].max_m;
            return;
        }
        if (sum >= best->growth) return;
    }
    if (!keeps_way_open(simplifier, star, target, errors)) {
        best->refused_m = simplifier->tolerance_m; /* the next rung may allow it */
        return;
    }
    best->target = target;
    best->growth = sum;
    memcpy(best->errors, errors, (size_t)star->degree * sizeof *errors);
}

static float present_sum(const struct mesh *mesh, const struct star *star) {
    float sum = 0;
    for (int32_t i = 0; i < star->degree; i++) sum += mesh->triangles[star->edge[i] >> 2].sum_squares_m2;
    return sum;
}

static void find_candidate(const struct simplifier *simplifier, const struct star *star, struct candidate *best) {
    int32_t proposed[CANDIDATES];
    int count = propose(simplifier, star, &simplifier->mesh->vertices[star->vertex].at, proposed);
    float sum = present_sum(simplifier->mesh, star);
    best->target = MESH_NONE;
    best->growth = best->refused_m = INFINITY;
    for (int i = 0; i < count; i++) measure_target(simplifier, star, proposed[i], sum, best);
}

/* The target found earlier, measured again for the errors of its triangles. */
static void recall_candidate(const struct simplifier *simplifier, const struct star *star, struct candidate *best) {
    int32_t k = 0;
    while (star->ring[k] != simplifier->target[star->vertex]) k++;
    best->target = MESH_NONE;
    best->growth = best->refused_m = INFINITY;
    measure_target(simplifier, star, k, 0, best);
}

int32_t mesh_degree(const struct mesh *mesh, int32_t vertex) {
    int32_t first = mesh->vertices[vertex].edge, edge = first, degree = 0;
    do {
        degree++;
        edge = mesh_twin(mesh, mesh_previous(edge));
    } while (edge != first && edge != MESH_NONE);
    return degree;
}

static void vertex_changed(struct simplifier *simplifier, int32_t vertex) {
    switch (simplifier->state[vertex]) {
    case STATE_QUEUED: simplifier->state[vertex] = STATE_CHANGED; break;
    case STATE_REFUSED:
        simplifier->state[vertex] = STATE_CHANGED;
        queue_push(&simplifier->queue, vertex, simplifier->queue.current);
        break;
    default: break;
    }
}

void simplifier_star_changed(struct simplifier *simplifier, const struct star *star) {
    for (int32_t i = 0; i <= star->degree; i++)
        if (i < star->degree || star->open) vertex_changed(simplifier, star->ring[i]);
}

void simplify_tell(const struct simplifier *simplifier, const struct star *star) {
    const struct simplify_observer *observer = simplifier->options.observer;
    if (observer != NULL) observer->remove(observer->context, star);
}

static void carry_out(struct simplifier *simplifier, const struct star *star, const struct candidate *candidate) {
    simplify_tell(simplifier, star);
    mesh_collapse(simplifier->mesh, star, candidate->target);
    for (int32_t j = 1; j < star->degree - 1; j++) {
        struct mesh_triangle *triangle =
            &simplifier->mesh->triangles[star->edge[around(candidate->target + j, star->degree)] >> 2];
        triangle->max_m = candidate->errors[j].max_m;
        triangle->sum_squares_m2 = candidate->errors[j].sum_squares_m2;
    }
    simplifier->state[star->vertex] = STATE_FIXED;
    simplifier_star_changed(simplifier, star);
}

static void visit(struct simplifier *simplifier, int32_t vertex) {
    struct star star;
    struct candidate candidate;
    if (!mesh_star(simplifier->mesh, vertex, &star)) {
        simplifier->state[vertex] = STATE_FIXED;
        return;
    }
    if (simplifier->state[vertex] == STATE_CHANGED) {
        find_candidate(simplifier, &star, &candidate);
        int32_t class = candidate.target == MESH_NONE ? 0 : queue_class(&simplifier->queue, candidate.growth);
        if (class > simplifier->queue.current) {
            simplifier->state[vertex] = STATE_QUEUED;
            simplifier->target[vertex] = star.ring[candidate.target];
            queue_push(&simplifier->queue, vertex, class);
            return;
        }
    } else {
        recall_candidate(simplifier, &star, &candidate);
    }
    if (candidate.target != MESH_NONE &&
        star.degree + mesh_degree(simplifier->mesh, star.ring[candidate.target]) - 4 <= MAX_JOINED_DEGREE) {
        carry_out(simplifier, &star, &candidate);
        return;
    }
    simplifier->state[vertex] = STATE_REFUSED;
    simplifier->refused_m[vertex] = candidate.refused_m;
}

void simplify_interior(struct simplifier *simplifier, float tolerance_m) {
    struct queue *queue = &simplifier->queue;
    simplifier->tolerance_m = tolerance_m;
    queue_reset(queue, LEAST_CLASS * tolerance_m * tolerance_m);
    for (int32_t i = 0; i < simplifier->mesh->vertex_count; i++) {
        int32_t v = simplifier->order[i];
        unsigned char *state = &simplifier->state[v];
        if (*state == STATE_REFUSED && simplifier->refused_m[v] > tolerance_m) continue;
        if (*state == STATE_FIXED) continue;
        *state = STATE_CHANGED;
        queue_push(queue, v, 0);
    }
    for (int32_t v = queue_pop(queue); v != QUEUE_NONE; v = queue_pop(queue)) {
        if (simplifier->mesh->live_vertices <= simplifier->options.least_vertices) return;
        visit(simplifier, v);
    }
}

bool simplify_vertex(struct simplifier *simplifier, const struct star *star) {
    struct candidate candidate;
    find_candidate(simplifier, star, &candidate);
    if (candidate.target == MESH_NONE) return false;
    carry_out(simplifier, star, &candidate);
    return true;
}

bool simplifier_may_collapse(const struct simplifier *simplifier, int32_t vertex) {
    return simplifier->state[vertex] != STATE_FIXED;
}

#define ORDER_CLASSES 64

/* Which sublattice a vertex is part of, the finest first: its coordinates' common factor of two, then those of whose
 * two coordinates one is odd, then those where both are. On a grid no two of a class are neighbours. */
static int32_t order_class(const struct sample *at) {
    uint32_t both = (uint32_t)at->x | (uint32_t)at->y;
    int32_t level = both == 0 ? 31 : __builtin_ctz(both);
    return 2 * level + (both != 0 && ((at->x & at->y) >> level & 1) != 0);
}

/* Where nothing tells vertices apart, as on water, they go by sublattices: what is left is as regular as a grid, and a
 * vertex waits for few others when it comes back. */
static void order_vertices(struct simplifier *simplifier) {
    const struct mesh *mesh = simplifier->mesh;
    int32_t start[ORDER_CLASSES + 1] = {0};
    for (int32_t v = 0; v < mesh->vertex_count; v++) start[order_class(&mesh->vertices[v].at) + 1]++;
    for (int class = 0; class < ORDER_CLASSES; class ++) start[class + 1] += start[class];
    for (int32_t v = 0; v < mesh->vertex_count; v++) simplifier->order[start[order_class(&mesh->vertices[v].at)]++] = v;
}

enum scree_status simplifier_start(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                                   const struct simplify_options *options, struct simplifier *simplifier,
                                   struct scree_error *error) {
    size_t count = (size_t)mesh->vertex_count;
    memset(simplifier, 0, sizeof *simplifier);
    simplifier->memory = memory;
    simplifier->mesh = mesh;
    simplifier->samples = *samples;
    simplifier->options = *options;
    simplifier->state = scree_allocate(memory, count, sizeof *simplifier->state, "vertex states", error);
    simplifier->order = scree_allocate(memory, count, sizeof *simplifier->order, "vertex order", error);
    simplifier->target = scree_allocate(memory, count, sizeof *simplifier->target, "vertex targets", error);
    simplifier->refused_m = scree_allocate(memory, count, sizeof *simplifier->refused_m, "vertex bounds", error);
    if (simplifier->state == NULL || simplifier->order == NULL || simplifier->target == NULL ||
        simplifier->refused_m == NULL ||
        queue_allocate(memory, mesh->vertex_count, &simplifier->queue, error) != SCREE_OK) {
        simplifier_release(simplifier);
        return SCREE_E_MEMORY;
    }
    order_vertices(simplifier);
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        const struct mesh_vertex *vertex = &mesh->vertices[v];
        if (vertex->edge == MESH_NONE || mesh_twin(mesh, vertex->edge) == MESH_NONE) continue;
        int64_t step = options->locked_step;
        if (step > 0 && vertex->at.x % step == 0 && vertex->at.y % step == 0) continue;
        simplifier->state[v] = STATE_REFUSED; /* with a bound of 0: looked at with the first tolerance */
    }
    return SCREE_OK;
}

void simplifier_release(struct simplifier *simplifier) {
    queue_release(simplifier->memory, &simplifier->queue);
    scree_release(simplifier->memory, simplifier->refused_m);
    scree_release(simplifier->memory, simplifier->target);
    scree_release(simplifier->memory, simplifier->order);
    scree_release(simplifier->memory, simplifier->state);
    memset(simplifier, 0, sizeof *simplifier);
}

static struct triangle_error measure(const struct mesh *mesh, const struct mesh_triangle *triangle,
                                     const struct samples *samples) {
    return samples_triangle_error(samples, &mesh->vertices[triangle->vertex[0]].at,
                                  &mesh->vertices[triangle->vertex[1]].at, &mesh->vertices[triangle->vertex[2]].at);
}

/* A vertex stands at its post, but for the rounding of its height. The smallest triangles hold no other posts, and
 * measuring them leaves their corners out. */
static float vertex_error_m(const struct sample *at, const struct samples *samples) {
    if (samples->posts == NULL) return 0;
    return fabsf(samples->posts[(int64_t)at->y * samples->stride + at->x] - at->height_m);
}

double mesh_max_error_m(const struct mesh *mesh, const struct samples *samples) {
    struct samples at_posts = *samples;
    float max_m = 0;
    at_posts.rounding_steps = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const struct mesh_triangle *triangle = &mesh->triangles[t];
        if (triangle->vertex[0] == MESH_NONE) continue;
        max_m = fmaxf(max_m, measure(mesh, triangle, &at_posts).max_m);
        for (int k = 0; k < 3; k++)
            max_m = fmaxf(max_m, vertex_error_m(&mesh->vertices[triangle->vertex[k]].at, samples));
    }
    return max_m;
}

void mesh_measure(struct mesh *mesh, const struct samples *samples) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        struct mesh_triangle *triangle = &mesh->triangles[t];
        if (triangle->vertex[0] == MESH_NONE) continue;
        struct triangle_error error = measure(mesh, triangle, samples);
        triangle->max_m = error.max_m;
        triangle->sum_squares_m2 = error.sum_squares_m2;
    }
}
