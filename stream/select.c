/* Selection (include/scree/select.h). First the tiles that a view may need are visited, each with what a pixel is worth
 * there; then the choice is made along that list, again and again with a larger tolerance where a budget asks for it.
 */
#include <scree/select.h>

#include "stream/tile_box.h"

#include <math.h>
#include <stdlib.h>

#define STEPS_IN_OCTAVE 64 /* in which a budget raises the tolerance */
#define MOST_STEPS      (100 * STEPS_IN_OCTAVE)

/* A tile that is perhaps drawn. Its children follow it, with theirs. */
struct visit {
    double pixel_m; /* so many metres of the measure are a pixel */
    double distance_m;
    uint32_t tile;
    uint32_t end; /* of it and all below it */
    bool seen;
};

struct chooser {
    const struct scree_terrain *terrain;
    const struct scree_select_tile *tiles;
    const struct scree_view *view;
    struct scree_select_options options;
    struct scree_selection *selection;
    struct visit *visits;
    uint32_t visit_count;
    double tolerance_px;
    bool writes; /* false: only sums are wanted */
    uint64_t triangles_drawn, triangles_wanted, bytes;
};

static double error_m(const struct chooser *chooser, const struct scree_rung *rung) {
    double value = chooser->options.measure == SCREE_BY_SVO ? rung->svo_m : rung->max_error_m;
    return value > 0 ? value : 0;
}

static double finest_error_m(const struct chooser *chooser, const struct scree_select_tile *tile) {
    if (tile->header != NULL) return error_m(chooser, &tile->header->rungs[tile->header->rung_count - 1]);
    if (chooser->terrain->zooms == NULL) return 0;
    const struct scree_zoom_scale *zoom = &chooser->terrain->zooms[tile->id.zoom];
    double value = chooser->options.measure == SCREE_BY_SVO ? zoom->finest_svo_m : zoom->finest_max_error_m;
    return value > 0 ? value : 0;
}

/* Rungs that can be drawn. */
static uint32_t ready_of(const struct scree_select_tile *tile) {
    if (tile->header == NULL) return 0;
    return tile->rungs_ready < tile->header->rung_count ? tile->rungs_ready : tile->header->rung_count;
}

static void visit_tile(struct chooser *chooser, uint32_t index, double lowest_m, double highest_m) {
    const struct scree_select_tile *tile = &chooser->tiles[index];
    struct visit *visit = &chooser->visits[chooser->visit_count++];
    if (tile->lowest_m <= tile->highest_m) lowest_m = tile->lowest_m, highest_m = tile->highest_m;
    struct tile_box box = tile_box_of(chooser->terrain, &tile->id, lowest_m, highest_m);
    struct tile_sight sight = tile_sight_of(chooser->terrain, chooser->view, &box);
    visit->tile = index;
    visit->pixel_m = chooser->options.measure == SCREE_BY_SVO ? sight.pixel_m : sight.pixel_any_way_m;
    visit->distance_m = sight.distance_m;
    visit->seen = sight.seen;
    if (sight.seen && finest_error_m(chooser, tile) > chooser->tolerance_px * visit->pixel_m)
        for (uint32_t child = 0; child < tile->child_count; child++)
            visit_tile(chooser, tile->first_child + child, lowest_m, highest_m);
    visit->end = chooser->visit_count;
}

/* The coarsest rung that is good enough, else the finest; and where between it and the one before the limit is met. */
static uint32_t rung_within(const struct chooser *chooser, const struct scree_stream_header *header, double limit_m,
                            double *level) {
    uint32_t rung = 0;
    while (rung + 1 < header->rung_count && !(error_m(chooser, &header->rungs[rung]) <= limit_m)) rung++;
    *level = rung;
    if (rung == 0) return rung;
    double before_m = error_m(chooser, &header->rungs[rung - 1]), after_m = error_m(chooser, &header->rungs[rung]);
    double share = (before_m - limit_m) / (before_m - after_m);
    if (share > 0 && share < 1) *level = rung - 1 + share;
    return rung;
}

static void draw(struct chooser *chooser, const struct visit *visit, uint32_t rung, double level) {
    const struct scree_rung *mesh = &chooser->tiles[visit->tile].header->rungs[rung];
    chooser->triangles_drawn += mesh->triangle_count;
    if (!chooser->writes) return;
    chooser->selection->drawn[chooser->selection->drawn_count++] = (struct scree_select_drawn){
        .tile = visit->tile, .rung = rung, .level = level, .error_px = error_m(chooser, mesh) / visit->pixel_m};
}

static void want(struct chooser *chooser, const struct visit *visit, uint32_t first_rung, uint32_t end_rung,
                 double error_px) {
    if (!chooser->writes) return;
    chooser->selection->wanted[chooser->selection->wanted_count++] =
        (struct scree_select_wanted){.tile = visit->tile,
                                     .first_rung = first_rung,
                                     .end_rung = end_rung,
                                     .error_px = error_px,
                                     .distance_m = visit->distance_m};
}

static bool children_are_ready(const struct chooser *chooser, const struct scree_select_tile *tile) {
    for (uint32_t child = 0; child < tile->child_count; child++)
        if (ready_of(&chooser->tiles[tile->first_child + child]) == 0) return false;
    return true;
}

static uint64_t bytes_up_to(const struct scree_stream_header *header, uint32_t rung) {
    return header->rungs[rung].offset_bytes + header->rungs[rung].size_bytes;
}

/* Chooses for a tile and all below it, and returns the visit after them. `covered`: a tile above is drawn in its place.
 * `above_px`: what is to be seen in its place as long as it has no mesh. */
static uint32_t choose(struct chooser *chooser, uint32_t number, bool covered, double above_px) {
    const struct visit *visit = &chooser->visits[number];
    const struct scree_select_tile *tile = &chooser->tiles[visit->tile];
    const struct scree_stream_header *header = tile->header;
    double limit_m = chooser->tolerance_px * visit->pixel_m, finest_m = finest_error_m(chooser, tile), level = 0;
    uint32_t ready = ready_of(tile);
    bool deeper = visit->end > number + 1 && finest_m > limit_m,
         gives_way = deeper && children_are_ready(chooser, tile);
    if (!visit->seen || header == NULL) {
        if (ready == 0) want(chooser, visit, 0, 1, above_px);
        if (!visit->seen) return visit->end;
    } else {
        uint32_t rung = rung_within(chooser, header, limit_m, &level);
        if (ready <= rung && !gives_way)
            want(chooser, visit, ready, rung + 1,
                 ready == 0 ? above_px : error_m(chooser, &header->rungs[ready - 1]) / visit->pixel_m);
        if (ready > 0 && !covered && !gives_way)
            draw(chooser, visit, rung < ready ? rung : ready - 1, rung < ready ? level : ready - 1);
        if (!deeper) chooser->triangles_wanted += header->rungs[rung].triangle_count;
        chooser->bytes += bytes_up_to(header, gives_way ? 0 : rung);
    }
    if (!deeper) return visit->end;
    for (uint32_t child = number + 1; child < visit->end;)
        child = choose(chooser, child, covered || !gives_way, finest_m / visit->pixel_m);
    return visit->end;
}

static void choose_all(struct chooser *chooser, double tolerance_px, bool writes) {
    chooser->tolerance_px = tolerance_px;
    chooser->writes = writes;
    chooser->triangles_drawn = chooser->triangles_wanted = chooser->bytes = 0;
    for (uint32_t root = 0; root < chooser->visit_count;) {
        if (chooser->visits[root].seen)
            root = choose(chooser, root, false, INFINITY);
        else
            root = chooser->visits[root].end;
    }
}

static bool is_within_budget(struct chooser *chooser, double tolerance_px) {
    const struct scree_select_options *options = &chooser->options;
    choose_all(chooser, tolerance_px, false);
    if (options->triangle_budget > 0 &&
        (chooser->triangles_drawn > options->triangle_budget || chooser->triangles_wanted > options->triangle_budget))
        return false;
    return options->byte_budget == 0 || chooser->bytes <= options->byte_budget;
}

/* The least tolerance within the budget, among those a whole number of steps above the one asked for. */
static double tolerance_within_budget(struct chooser *chooser) {
    double asked_px = chooser->options.tolerance_px;
    int low = 0, high = MOST_STEPS; /* too little; as much as can be done */
    if (chooser->options.triangle_budget == 0 && chooser->options.byte_budget == 0) return asked_px;
    if (is_within_budget(chooser, asked_px)) return asked_px;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (is_within_budget(chooser, asked_px * exp2((double)middle / STEPS_IN_OCTAVE)))
            high = middle;
        else
            low = middle;
    }
    return asked_px * exp2((double)high / STEPS_IN_OCTAVE);
}

static int compare_urgency(const void *left, const void *right) {
    const struct scree_select_wanted *a = left, *b = right;
    if (a->error_px != b->error_px) return a->error_px > b->error_px ? -1 : 1;
    if (a->distance_m != b->distance_m) return a->distance_m < b->distance_m ? -1 : 1;
    return (a->tile > b->tile) - (a->tile < b->tile);
}

size_t scree_select_workspace(uint32_t tile_count) {
    return tile_count * sizeof(struct visit);
}

enum scree_status scree_select(const struct scree_terrain *terrain, const struct scree_select_tile *tiles,
                               uint32_t tile_count, const struct scree_view *view,
                               const struct scree_select_options *options, struct scree_selection *selection,
                               struct scree_error *error) {
    struct chooser chooser = {.terrain = terrain, .tiles = tiles, .view = view, .selection = selection};
    if (options != NULL) chooser.options = *options;
    if (chooser.options.tolerance_px == 0) chooser.options.tolerance_px = 1;
    if (!(chooser.options.tolerance_px > 0) || !isfinite(chooser.options.tolerance_px))
        return scree_fail(error, SCREE_E_ARGUMENT, "a tolerance of %g pixels cannot be kept",
                          chooser.options.tolerance_px);
    if (selection->capacity < tile_count || selection->workspace_bytes < scree_select_workspace(tile_count))
        return scree_fail(error, SCREE_E_LIMIT, "choosing among %u tiles takes room for so many, not %u", tile_count,
                          selection->capacity);
    chooser.visits = selection->workspace;
    chooser.tolerance_px = chooser.options.tolerance_px;
    selection->drawn_count = selection->wanted_count = 0;
    for (uint32_t root = 0; root < tile_count && tiles[root].id.zoom == tiles[0].id.zoom; root++)
        visit_tile(&chooser, root, terrain->lowest_m, terrain->highest_m);
    selection->tolerance_px = tolerance_within_budget(&chooser);
    choose_all(&chooser, selection->tolerance_px, true);
    selection->triangles = chooser.triangles_drawn;
    if (selection->wanted_count > 0)
        qsort(selection->wanted, selection->wanted_count, sizeof *selection->wanted, compare_urgency);
    return SCREE_OK;
}
