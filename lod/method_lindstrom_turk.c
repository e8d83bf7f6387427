#include "lod/method_lindstrom_turk.h"

#include "lod/post_grid.h"
#include "lod/queue.h"

#include <math.h>
#include <string.h>

#define MAX_JOINED_DEGREE 48   /* no collapse makes a larger star */
#define LEAST_HEIGHT      1e-5 /* share of the relief: volumes below a cell of that height are all alike */

/* What is known of the edge of a half-edge. At most one of its two half-edges waits in the queue. */
enum edge_state {
    EDGE_RESTS,  /* not in the queue: it has been refused, or its other half waits */
    EDGE_PRICED, /* waits with a cost that still holds */
    EDGE_CHANGED /* waits; its stars have changed since */
};

struct work {
    struct method_lindstrom_turk_options options;
    struct code_frame codes; /* in units */
    struct post_grid grid;
    struct queue queue;   /* of half-edges */
    unsigned char *state; /* one a half-edge */
    double scale[3];      /* from units and metres to what costs are computed in */
};

/* A collapse that has been looked at: the star's vertex goes, ring[target] stays and moves to `place`. */
struct collapse {
    struct star gone, kept;
    int32_t target;
    struct sample place;
    double cost;
};

static void scaled(const struct work *work, const struct sample *origin, const struct sample *at, double point[3]) {
    point[0] = (at->x - origin->x) * work->scale[0];
    point[1] = (at->y - origin->y) * work->scale[1];
    point[2] = ((double)at->height_m - origin->height_m) * work->scale[2];
}

/* ---- costs ---- */

/* The triangles and neighbours of a star; those that hold `other`, the edge's second end, belong to the first star. */
static void add_star(const struct work *work, const struct star *star, const struct sample *center,
                     const struct sample *origin, int32_t other, bool second, struct lindstrom_sums *sums) {
    double corner[3], from[3], to[3];
    scaled(work, origin, center, corner);
    scaled(work, center, &star->at[0], from);
    for (int32_t i = 0; i < star->degree; i++) {
        scaled(work, center, &star->at[i + 1], to);
        bool shared = star->ring[i] == other || star->ring[i + 1] == other;
        if (!second || !shared) lindstrom_add_triangle(sums, corner, from, to);
        bool known = second && (shared || (i > 0 && star->ring[i - 1] == other) ||
                                (i == 0 && !star->open && star->ring[star->degree - 1] == other));
        if (star->ring[i] != other && !known)
            lindstrom_add_neighbour(sums, (double[3]){corner[0] + from[0], corner[1] + from[1], corner[2] + from[2]});
        memcpy(from, to, sizeof from);
    }
}

static bool is_corner(const struct work *work, const struct sample *at) {
    int32_t right = work->grid.tile->columns * work->grid.unit, top = work->grid.tile->rows * work->grid.unit;
    return (at->x == 0 || at->x == right) && (at->y == 0 || at->y == top);
}

static int32_t index_in_ring(const struct star *star, int32_t vertex) {
    int32_t i = 0;
    while (star->ring[i] != vertex) i++;
    return i;
}

static bool find_place(const struct work *work, const struct lindstrom_sums *sums, const struct sample *origin,
                       double place[3], struct sample *at) {
    if (!lindstrom_place(sums, place)) return false;
    double x = origin->x + place[0] / work->scale[0], y = origin->y + place[1] / work->scale[1];
    double z = origin->height_m + place[2] / work->scale[2];
    int32_t right = work->grid.tile->columns * work->grid.unit, top = work->grid.tile->rows * work->grid.unit;
    if (!(x > 0 && y > 0 && x < right && y < top && isfinite((float)z))) return false;
    *at = (struct sample){(int32_t)(x + 0.5), (int32_t)(y + 0.5), (float)z};
    return true;
}

/* A border edge: the star's vertex goes along the border to the other end. */
static void price_border(const struct work *work, struct collapse *collapse) {
    const struct star *gone = &collapse->gone;
    const struct sample *at = &work->grid.mesh.vertices[gone->vertex].at;
    struct lindstrom_sums sums = {0};
    double before[3], after[3], place[3];
    add_star(work, gone, at, at, gone->ring[collapse->target], false, &sums);
    scaled(work, at, &gone->at[0], after);
    scaled(work, at, &gone->at[gone->degree], before);
    lindstrom_add_border(&sums, before, (double[3]){0, 0, 0});
    lindstrom_add_border(&sums, (double[3]){0, 0, 0}, after);
    memcpy(place, collapse->target == 0 ? after : before, sizeof place);
    double length2 = place[0] * place[0] + place[1] * place[1] + place[2] * place[2];
    collapse->place = gone->at[collapse->target];
    collapse->cost = lindstrom_cost(&sums, &work->options.weights, length2, place);
}

static bool look_at_border_edge(const struct work *work, int32_t edge, struct collapse *collapse) {
    const struct mesh *mesh = &work->grid.mesh;
    int32_t ends[2] = {mesh_origin(mesh, edge), mesh_origin(mesh, mesh_next(edge))};
    double best = INFINITY;
    int choice = -1;
    for (int k = 0; k < 2; k++) {
        if (is_corner(work, &mesh->vertices[ends[k]].at)) continue;
        if (!mesh_star(mesh, ends[k], &collapse->gone)) continue;
        collapse->target = k == 0 ? 0 : collapse->gone.degree;
        price_border(work, collapse);
        if (collapse->cost < best) {
            best = collapse->cost;
            choice = k;
        }
    }
    if (choice < 0) return false;
    if (choice == 0) { /* the second end has been looked at last */
        mesh_star(mesh, ends[0], &collapse->gone);
        collapse->target = 0;
        price_border(work, collapse);
    }
    return mesh_star(mesh, ends[1 - choice], &collapse->kept);
}

static bool look_at_inner_edge(const struct work *work, int32_t edge, struct collapse *collapse) {
    const struct mesh *mesh = &work->grid.mesh;
    struct star *gone = &collapse->gone, *kept = &collapse->kept;
    if (!mesh_star(mesh, mesh_origin(mesh, edge), gone)) return false;
    if (!mesh_star(mesh, mesh_origin(mesh, mesh_next(edge)), kept)) return false;
    if (gone->open && kept->open) return false;
    if (gone->open) {
        if (!mesh_star(mesh, kept->vertex, gone)) return false;
        if (!mesh_star(mesh, mesh_origin(mesh, edge), kept)) return false;
    }
    collapse->target = index_in_ring(gone, kept->vertex);
    struct sample origin = mesh->vertices[gone->vertex].at, end = mesh->vertices[kept->vertex].at;
    struct lindstrom_sums sums = {0};
    double place[3];
    add_star(work, gone, &origin, &origin, kept->vertex, false, &sums);
    add_star(work, kept, &end, &origin, gone->vertex, true, &sums);
    scaled(work, &origin, &end, place);
    double length2 = place[0] * place[0] + place[1] * place[1] + place[2] * place[2];
    collapse->place = end;
    if (!kept->open && !find_place(work, &sums, &origin, place, &collapse->place)) return false;
    collapse->cost = lindstrom_cost(&sums, &work->options.weights, length2, place);
    return true;
}

static bool look_at(const struct work *work, int32_t edge, struct collapse *collapse) {
    if (mesh_twin(&work->grid.mesh, edge) != MESH_NONE) return look_at_inner_edge(work, edge, collapse);
    return work->options.free_borders && look_at_border_edge(work, edge, collapse);
}

/* ---- admission ---- */

/* The triangles of a star that stay, with its vertex moved to `place`, are positive. */
static bool stay_positive(const struct work *work, const struct star *star, int32_t other, const struct sample *place) {
    for (int32_t i = 0; i < star->degree; i++)
        if (star->ring[i] != other && star->ring[i + 1] != other &&
            !codes_positive(&work->codes, place, &star->at[i], &star->at[i + 1]))
            return false;
    return true;
}

static bool stay_within(const struct work *work, const struct star *star, int32_t other, const struct sample *place) {
    double limit_m = work->options.tolerance_m;
    for (int32_t i = 0; i < star->degree && work->options.is_bounded; i++)
        if (star->ring[i] != other && star->ring[i + 1] != other &&
            post_grid_error_m(&work->grid, place, &star->at[i], &star->at[i + 1], limit_m) > limit_m)
            return false;
    return true;
}

static bool admit(const struct work *work, const struct collapse *collapse) {
    const struct star *gone = &collapse->gone, *kept = &collapse->kept;
    bool moves = !kept->open; /* else the triangles around it stay as they are */
    if (gone->degree + kept->degree - 4 > MAX_JOINED_DEGREE) return false;
    return stay_positive(work, gone, kept->vertex, &collapse->place) &&
           (!moves || stay_positive(work, kept, gone->vertex, &collapse->place)) &&
           stay_within(work, gone, kept->vertex, &collapse->place) &&
           (!moves || stay_within(work, kept, gone->vertex, &collapse->place));
}

/* ---- the walk through the queue ---- */

static void edge_changed(struct work *work, int32_t edge) {
    int32_t twin = mesh_twin(&work->grid.mesh, edge);
    if (work->state[edge] == EDGE_RESTS && twin != MESH_NONE && work->state[twin] != EDGE_RESTS) edge = twin;
    if (work->state[edge] == EDGE_RESTS) queue_push(&work->queue, edge, work->queue.current);
    work->state[edge] = EDGE_CHANGED;
}

static void star_changed(struct work *work, int32_t vertex) {
    const struct mesh *mesh = &work->grid.mesh;
    int32_t first = mesh->vertices[vertex].edge, edge = first;
    for (;;) {
        int32_t previous = mesh_previous(edge);
        edge_changed(work, edge);
        edge = mesh_twin(mesh, previous);
        if (edge == first) return;
        if (edge == MESH_NONE) {
            edge_changed(work, previous);
            return;
        }
    }
}

static void carry_out(struct work *work, const struct collapse *collapse) {
    struct mesh *mesh = &work->grid.mesh;
    struct star star;
    int32_t kept = collapse->kept.vertex;
    mesh_collapse(mesh, &collapse->gone, collapse->target);
    mesh->vertices[kept].at = collapse->place;
    star_changed(work, kept);
    if (!mesh_star(mesh, kept, &star)) return;
    for (int32_t i = 0; i < star.degree + star.open; i++) star_changed(work, star.ring[i]);
}

static void visit(struct work *work, int32_t edge) {
    struct collapse collapse;
    enum edge_state state = work->state[edge];
    int32_t twin;
    work->state[edge] = EDGE_RESTS;
    if (work->grid.mesh.triangles[edge >> 2].vertex[0] == MESH_NONE) return;
    twin = mesh_twin(&work->grid.mesh, edge);
    if (twin != MESH_NONE && work->state[twin] != EDGE_RESTS) return; /* two edges became one: its other half waits */
    if (!look_at(work, edge, &collapse)) return;
    int32_t cost_class = queue_class(&work->queue, (float)collapse.cost);
    if (state == EDGE_CHANGED && cost_class > work->queue.current) {
        work->state[edge] = EDGE_PRICED;
        queue_push(&work->queue, edge, cost_class);
    } else if (admit(work, &collapse)) {
        carry_out(work, &collapse);
    }
}

static void simplify(struct work *work) {
    struct mesh *mesh = &work->grid.mesh;
    for (int32_t edge = 0; edge < 4 * mesh->triangle_count; edge++) {
        if ((edge & 3) == 3 || mesh_twin(mesh, edge) > edge) continue;
        work->state[edge] = EDGE_CHANGED;
        queue_push(&work->queue, edge, 0);
    }
    for (int32_t edge = queue_pop(&work->queue); edge != QUEUE_NONE; edge = queue_pop(&work->queue)) {
        /* Euler: a triangulation of a disc has one edge less than vertices and triangles together */
        if (work->options.edges > 0 &&
            (int64_t)mesh->live_vertices + mesh->live_triangles - 1 <= (int64_t)work->options.edges)
            return;
        visit(work, edge);
    }
}

/* ---- */

static enum scree_status check_options(struct method_lindstrom_turk_options *options, struct scree_error *error) {
    struct lindstrom_weights *weights = &options->weights;
    if (!(weights->volume >= 0 && weights->boundary >= 0 && weights->shape >= 0) ||
        !isfinite(weights->volume + weights->boundary + weights->shape))
        return scree_fail(error, SCREE_E_ARGUMENT, "a weight of the edge collapse is not a number of 0 or more");
    if (options->is_bounded ? !(options->tolerance_m >= 0) : options->edges == 0)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "the edge collapse has neither a number of edges nor a tolerance to stop at");
    if (weights->volume + weights->boundary + weights->shape > 0) return SCREE_OK;
    *weights = (struct lindstrom_weights){0.5, 0.5, 0};
    return SCREE_OK;
}

static void set_scales(struct work *work) {
    const struct method_tile *tile = work->grid.tile;
    const struct mesh *mesh = &work->grid.mesh;
    double width_m = tile->columns * (double)tile->cell_span * tile->east_m;
    double height_m = tile->rows * (double)tile->cell_span * tile->north_m, side_m = fmax(width_m, height_m);
    double lowest_m = INFINITY, highest_m = -INFINITY;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        lowest_m = fmin(lowest_m, mesh->vertices[v].at.height_m);
        highest_m = fmax(highest_m, mesh->vertices[v].at.height_m);
    }
    work->scale[0] = tile->east_m * work->grid.unit_steps / side_m;
    work->scale[1] = tile->north_m * work->grid.unit_steps / side_m;
    work->scale[2] = 1 / (highest_m > lowest_m ? highest_m - lowest_m : side_m);
    double cell = work->scale[0] * work->scale[1] * work->grid.unit * work->grid.unit;
    queue_reset(&work->queue, (float)(cell * cell * LEAST_HEIGHT * LEAST_HEIGHT));
}

enum scree_status method_lindstrom_turk(struct scree_memory *memory, const struct method_tile *tile,
                                        const struct method_lindstrom_turk_options *options, struct method_mesh *mesh,
                                        struct scree_error *error) {
    struct work work = {.options = *options};
    memset(mesh, 0, sizeof *mesh);
    enum scree_status status = method_tile_check(tile, error);
    if (status == SCREE_OK) status = check_options(&work.options, error);
    if (status != SCREE_OK) return status;
    if ((status = post_grid_make(memory, tile, &work.grid, error)) != SCREE_OK) goto cleanup;
    int32_t halves = 4 * work.grid.mesh.triangle_count;
    if ((status = queue_allocate(memory, halves, &work.queue, error)) != SCREE_OK) goto cleanup;
    work.state = scree_allocate(memory, (size_t)halves, sizeof *work.state, "edge states", error);
    if (work.state == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    double steps = work.grid.unit_steps;
    work.codes = (struct code_frame){(int64_t)((double)options->codes.span / steps),
                                     (int32_t)(options->codes.x / steps), (int32_t)(options->codes.y / steps)};
    set_scales(&work);
    simplify(&work);
    status = post_grid_export(memory, &work.grid, mesh, error);
cleanup:
    scree_release(memory, work.state);
    queue_release(memory, &work.queue);
    post_grid_release(memory, &work.grid);
    return status;
}
