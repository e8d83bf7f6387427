#include "stream/increment.h"

#include "stream/cavity.h"
#include "stream/heights.h"

#include <string.h>

#define POST_CLASSES 12
#define MOST_ROUNDS  1024

struct increment_models {
    struct bit_model more[3][POST_CLASSES]; /* whether one more vertex lies in a triangle */
    struct place_models posts;
    struct bit_model ready[2][3][4];
    struct cavity_models cavity;
    struct height_models heights;
};

static void start_models(struct bit_model *models, size_t count, int percent) {
    for (size_t i = 0; i < count; i++) models[i] = bit_model(percent);
}

#define START(member, percent) \
    start_models((struct bit_model *)(member), sizeof(member) / sizeof(struct bit_model), percent)

void increment_forget(struct increment *increment) {
    struct increment_models *models = increment->models;
    START(models->more, 15);
    place_models_start(&models->posts);
    START(models->ready, 70);
    cavity_models_start(&models->cavity);
    height_models_start(&models->heights);
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
    if (!places_code(increment->coder, &increment->models->posts, increment->surface, triangle, count, coded))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        coded[i].triangle = triangle;
        coded[i].next = at->first;
        at->first = increment->pending_count++;
    }
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
               !surface_has_post(increment->surface, cavity->slots[i], pending->x, pending->y))
            i++;
        charge(increment, i + 1);
        pending->triangle = cavity->slots[i];
        pending->next = increment->surface->triangles[pending->triangle].first;
        increment->surface->triangles[pending->triangle].first = p;
    }
}

static void insert(struct increment *increment, uint32_t p, const struct scree_vertex *vertex) {
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
    split->parent = cavity_parent(surface, cavity, vertex);
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
    const struct increment_plan *plan = increment->plan;
    const struct cavity_walk walk = {increment->coder, &increment->models->cavity, increment->surface,
                                     plan != NULL ? plan->is_inside : NULL, plan != NULL ? plan->context : NULL};
    cavity_code(&walk, pending->triangle, &vertex, increment->cavity);
    if (plan != NULL) vertex.height = plan->height(plan->context);
    increment->coder->cost_bits = increment->height_bits;
    bool fine = height_code(increment->coder, &increment->models->heights, increment->surface, pending->triangle,
                            increment->cavity->open, increment->height_step, &vertex);
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
    if (status == SCREE_OK) insert(increment, p, &vertex);
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

enum scree_status increment_code(struct increment *increment, uint32_t most, struct scree_error *error) {
    uint32_t triangles = increment->surface->triangle_count;
    if (most > increment->pending_capacity) most = increment->pending_capacity;
    increment->pending_count = 0;
    height_models_hurry(&increment->models->heights);
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
