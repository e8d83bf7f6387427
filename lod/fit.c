#include "lod/fit.h"

#include "lod/fit_sums.h"
#include "lod/simplify.h"

#include <math.h>

#define LEAST_GAIN      1e-4 /* share of a sum that a change has to save */
#define LEAST_THICKNESS 0.4  /* cells, of a triangle that is no sliver */
#define FINAL_ROUNDS    3    /* of turning edges and moving vertices; measured: nine more gain another 1 % */
#define WORTHWHILE      32   /* a thinning that takes fewer than one vertex in so many is the last */
#define THINNINGS       3    /* of a mesh, each after a round of its own; measured: 10, 3 and 1 % of the triangles go */

struct fit {
    struct mesh *mesh;
    const struct samples *samples;
    struct fit_options options;
    int32_t now;      /* number of the pass */
    int32_t *changed; /* a triangle: the last pass that changed it */
    int32_t *visited; /* a vertex: the last pass that looked at it */
    int32_t *turned;  /* a triangle: the last pass that looked at its edges */
};

/* The triangles of a star with its vertex at `at`. */
struct trial {
    struct sample at;
    int32_t height; /* units */
    double ww, wr, rr_m2;
    double error_m; /* the worst, with the rounding of positions */
};

/* `errors`: one a triangle; NULL when nobody asks. */
static void measure(const struct fit *fit, const struct star *star, struct trial *trial,
                    struct triangle_error *errors) {
    trial->ww = trial->wr = trial->rr_m2 = trial->error_m = 0;
    for (int32_t i = 0; i < star->degree; i++) {
        struct fit_sums sums = {0};
        fit_add_triangle(fit->samples, &trial->at, &star->at[i], &star->at[i + 1], &sums);
        double error_m = sums.max_m + sums.rounding_m;
        trial->ww += sums.ww;
        trial->wr += sums.wr;
        trial->rr_m2 += sums.rr_m2;
        if (errors != NULL) errors[i] = (struct triangle_error){(float)error_m, (float)sums.rr_m2};
        if (error_m > trial->error_m) trial->error_m = error_m;
    }
}

/* ---- heights ---- */

static void set_height(const struct fit *fit, struct trial *trial, double height_m) {
    double unit_m = fit->options.height_unit_m;
    if (unit_m > 0) {
        trial->height = (int32_t)lround(height_m / unit_m);
        height_m = trial->height * unit_m;
    }
    trial->at.height_m = (float)height_m;
}

/* Puts the trial's vertex to its best height that keeps the limit, and measures it there. False when there is none. */
static bool settle(const struct fit *fit, const struct star *star, double limit_m, struct trial *trial,
                   struct triangle_error errors[MESH_MAX_DEGREE]) {
    const struct sample from = trial->at;
    double best_m = trial->ww > 0 ? trial->wr / trial->ww : 0, low_m = -INFINITY, high_m = INFINITY;
    set_height(fit, trial, from.height_m + best_m);
    measure(fit, star, trial, errors);
    if (trial->error_m <= limit_m) return true;
    for (int32_t i = 0; i < star->degree; i++)
        fit_narrow(fit->samples, &from, &star->at[i], &star->at[i + 1], limit_m, &low_m, &high_m);
    if (!(low_m <= high_m)) return false;
    double inward_m = fmin(0.5 * fit->options.height_unit_m, 0.5 * (high_m - low_m)); /* for what rounding takes */
    set_height(fit, trial, from.height_m + fmin(fmax(best_m, low_m + inward_m), high_m - inward_m));
    measure(fit, star, trial, errors);
    return trial->error_m <= limit_m;
}

static void keep(struct fit *fit, const struct star *star, const struct trial *trial,
                 const struct triangle_error errors[MESH_MAX_DEGREE]) {
    struct mesh *mesh = fit->mesh;
    mesh->vertices[star->vertex].at = trial->at;
    if (fit->options.height_unit_m > 0) mesh->heights[star->vertex] = trial->height;
    for (int32_t i = 0; i < star->degree; i++) {
        struct mesh_triangle *triangle = &mesh->triangles[star->edge[i] >> 2];
        triangle->max_m = errors[i].max_m;
        triangle->sum_squares_m2 = errors[i].sum_squares_m2;
        fit->changed[star->edge[i] >> 2] = fit->now;
    }
}

/* ---- places ---- */

/* The squared height of a triangle over its longest side, in steps. */
static double thickness2(const struct sample *a, const struct sample *b, const struct sample *c) {
    const struct sample *corner[3] = {a, b, c};
    double longest2 = 0, area2 = (double)sample_area2(a, b, c);
    for (int k = 0; k < 3; k++) {
        double dx = corner[(k + 1) % 3]->x - corner[k]->x, dy = corner[(k + 1) % 3]->y - corner[k]->y;
        longest2 = fmax(longest2, dx * dx + dy * dy);
    }
    return area2 * area2 / longest2;
}

/* A triangle too thin to hold the posts that would hold it: what no post sees may be anywhere. Measured: letting them
 * be makes the distance in space half as large again on some tiles. */
static bool is_sliver(const struct fit *fit, double thickness2) {
    double least = LEAST_THICKNESS * fit->samples->cell_span;
    return thickness2 < least * least;
}

/* Whether the star's triangles are positive and make no worse slivers with its vertex at `at`. */
static bool stays_sound(const struct fit *fit, const struct star *star, const struct sample *at) {
    const struct sample *from = &fit->mesh->vertices[star->vertex].at;
    for (int32_t i = 0; i < star->degree; i++) {
        const struct sample *b = &star->at[i], *c = &star->at[i + 1];
        if (!codes_positive(&fit->options.codes, at, b, c)) return false;
        double now2 = thickness2(at, b, c);
        if (is_sliver(fit, now2) && now2 < thickness2(from, b, c)) return false;
    }
    return true;
}

static double least_m2(const struct trial *trial) {
    return trial->ww > 0 ? trial->rr_m2 - trial->wr * trial->wr / trial->ww : trial->rr_m2;
}

/* Whether a visit of the vertex may find something new. */
static bool is_stale(const struct fit *fit, const struct star *star) {
    for (int32_t i = 0; i < star->degree; i++)
        if (fit->changed[star->edge[i] >> 2] >= fit->visited[star->vertex]) return true;
    return false;
}

static bool may_move(const struct fit *fit, const struct sample *at) {
    int64_t locked = fit->options.locked_step;
    return !fit->options.in_place && !(locked > 0 && at->x % locked == 0 && at->y % locked == 0);
}

/* Looks at the eight places a cell away; `best` becomes the best of them if it is better. */
static void look_around(const struct fit *fit, const struct star *star, const struct trial *present,
                        struct trial *best) {
    static const int32_t ways[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    for (int k = 0; k < 8; k++) {
        struct trial trial = {.at = present->at, .height = present->height};
        trial.at.x += ways[k][0] * fit->samples->cell_span;
        trial.at.y += ways[k][1] * fit->samples->cell_span;
        if (!stays_sound(fit, star, &trial.at)) continue;
        measure(fit, star, &trial, NULL);
        if (least_m2(&trial) < least_m2(best)) *best = trial;
    }
}

static void visit(struct fit *fit, int32_t vertex, bool moves) {
    const struct mesh *mesh = fit->mesh;
    struct star star;
    struct triangle_error errors[MESH_MAX_DEGREE];
    if (mesh->vertices[vertex].edge == MESH_NONE || !mesh_star(mesh, vertex, &star) || star.open) return;
    if (!is_stale(fit, &star)) return;
    fit->visited[vertex] = fit->now;
    struct trial present = {.at = mesh->vertices[vertex].at, .height = mesh->heights[vertex]}, best;
    measure(fit, &star, &present, NULL);
    double limit_m = fmax(fit->options.tolerance_m, present.error_m), bound_m2 = present.rr_m2 * (1 - LEAST_GAIN);
    best = present;
    if (moves && may_move(fit, &present.at)) look_around(fit, &star, &present, &best);
    if (least_m2(&best) >= bound_m2) return;
    bool has_moved = best.at.x != present.at.x || best.at.y != present.at.y;
    if (settle(fit, &star, limit_m, &best, errors) && best.rr_m2 < bound_m2)
        keep(fit, &star, &best, errors);
    else if (has_moved && settle(fit, &star, limit_m, &present, errors) && present.rr_m2 < bound_m2)
        keep(fit, &star, &present, errors);
}

static void visit_all(struct fit *fit, bool moves) {
    fit->now++;
    for (int32_t v = 0; v < fit->mesh->vertex_count; v++) visit(fit, v, moves);
}

/* ---- edges ---- */

static struct triangle_error error_of(const struct fit *fit, const struct sample *a, const struct sample *b,
                                      const struct sample *c) {
    struct fit_sums sums = {0};
    fit_add_triangle(fit->samples, a, b, c, &sums);
    return (struct triangle_error){(float)(sums.max_m + sums.rounding_m), (float)sums.rr_m2};
}

static void turn(struct fit *fit, int32_t edge) {
    struct mesh *mesh = fit->mesh;
    int32_t twin = mesh_twin(mesh, edge);
    if (twin == MESH_NONE) return;
    struct mesh_triangle *one = &mesh->triangles[edge >> 2], *two = &mesh->triangles[twin >> 2];
    const struct sample *a = &mesh->vertices[mesh_origin(mesh, edge)].at;
    const struct sample *b = &mesh->vertices[mesh_origin(mesh, twin)].at;
    const struct sample *c = &mesh->vertices[mesh_origin(mesh, mesh_previous(edge))].at;
    const struct sample *d = &mesh->vertices[mesh_origin(mesh, mesh_previous(twin))].at;
    if (!codes_positive(&fit->options.codes, d, c, a) || !codes_positive(&fit->options.codes, c, d, b)) return;
    double now2 = fmin(thickness2(d, c, a), thickness2(c, d, b));
    if (is_sliver(fit, now2) && now2 < fmin(thickness2(a, b, c), thickness2(b, a, d))) return;
    float sum = one->sum_squares_m2 + two->sum_squares_m2;
    float limit_m = fmaxf((float)fit->options.tolerance_m, fmaxf(one->max_m, two->max_m));
    if (sum <= 0) return;
    struct triangle_error first = error_of(fit, d, c, a), second = error_of(fit, c, d, b);
    if (first.sum_squares_m2 + second.sum_squares_m2 >= sum * (1 - LEAST_GAIN)) return;
    if (first.max_m > limit_m || second.max_m > limit_m) return;
    mesh_flip(mesh, edge);
    one->max_m = first.max_m;
    one->sum_squares_m2 = first.sum_squares_m2;
    two->max_m = second.max_m;
    two->sum_squares_m2 = second.sum_squares_m2;
    fit->changed[edge >> 2] = fit->changed[twin >> 2] = fit->now;
}

static void turn_all(struct fit *fit) {
    struct mesh *mesh = fit->mesh;
    fit->now++;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->triangles[t].vertex[0] == MESH_NONE || fit->changed[t] < fit->turned[t]) continue;
        fit->turned[t] = fit->now;
        for (int k = 0; k < 3; k++) turn(fit, 4 * t + k);
    }
}

/* ---- */

static void measure_mesh(struct fit *fit) {
    struct mesh *mesh = fit->mesh;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        struct mesh_triangle *triangle = &mesh->triangles[t];
        if (triangle->vertex[0] == MESH_NONE) continue;
        struct triangle_error error =
            error_of(fit, &mesh->vertices[triangle->vertex[0]].at, &mesh->vertices[triangle->vertex[1]].at,
                     &mesh->vertices[triangle->vertex[2]].at);
        triangle->max_m = error.max_m;
        triangle->sum_squares_m2 = error.sum_squares_m2;
    }
}

static enum scree_status fit_rounds(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                                    const struct fit_options *options, int rounds, struct scree_error *error) {
    struct fit fit = {.mesh = mesh, .samples = samples, .options = *options};
    enum scree_status status = SCREE_E_MEMORY;
    size_t vertices = (size_t)mesh->vertex_count, triangles = (size_t)mesh->triangle_count;
    fit.changed = scree_allocate(memory, triangles, sizeof *fit.changed, "the fit's triangles", error);
    fit.turned = scree_allocate(memory, triangles, sizeof *fit.turned, "the fit's triangles", error);
    fit.visited = scree_allocate(memory, vertices, sizeof *fit.visited, "the fit's vertices", error);
    if (fit.changed == NULL || fit.turned == NULL || fit.visited == NULL) goto cleanup;
    measure_mesh(&fit);
    visit_all(&fit, false);
    for (int round = 0; round < rounds; round++) {
        if (!options->keep_edges) turn_all(&fit);
        visit_all(&fit, true);
    }
    status = SCREE_OK;
cleanup:
    scree_release(memory, fit.visited);
    scree_release(memory, fit.turned);
    scree_release(memory, fit.changed);
    return status;
}

/* Vertices that the bound needed while the surface went through the posts go now. */
static enum scree_status thin(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                              const struct fit_options *options, struct scree_error *error) {
    struct simplifier simplifier;
    const struct simplify_options own = {
        .locked_step = options->locked_step, .codes = options->codes, .least_vertices = options->least_vertices};
    mesh_measure(mesh, samples);
    enum scree_status status = simplifier_start(memory, mesh, samples, &own, &simplifier, error);
    if (status != SCREE_OK) return status;
    simplify_interior(&simplifier, (float)options->tolerance_m);
    simplifier_release(&simplifier);
    return SCREE_OK;
}

enum scree_status fit_mesh(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                           const struct fit_options *options, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    bool goes_on = options->thins;
    for (int i = 0; i < THINNINGS && goes_on && status == SCREE_OK; i++) {
        int32_t before = mesh->live_vertices;
        status = fit_rounds(memory, mesh, samples, options, 1, error);
        if (status == SCREE_OK) status = thin(memory, mesh, samples, options, error);
        goes_on = before - mesh->live_vertices > before / WORTHWHILE;
    }
    return status == SCREE_OK ? fit_rounds(memory, mesh, samples, options, FINAL_ROUNDS, error) : status;
}

double fit_sum_squares_m2(const struct mesh *mesh, const struct samples *samples) {
    double sum_m2 = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *corner = mesh->triangles[t].vertex;
        struct fit_sums sums = {0};
        if (corner[0] == MESH_NONE) continue;
        fit_add_triangle(samples, &mesh->vertices[corner[0]].at, &mesh->vertices[corner[1]].at,
                         &mesh->vertices[corner[2]].at, &sums);
        sum_m2 += sums.rr_m2;
    }
    return sum_m2;
}
