/* The tiles that methods are compared on: see the header. */
#include "src/compare_walk.h"

#include <string.h>

struct work {
    const struct compare_walk *walk;
    struct scree_memory *memory;
    struct lattice_window windows[2];
    int window_count;
    bool is_cut;
    uint32_t tiles_done, tiles_in_all; /* of the finest zoom */
};

static bool is_within(struct tile_range range, struct tile_id id) {
    return id.x >= range.x_first && id.x <= range.x_last && id.y >= range.y_first && id.y <= range.y_last;
}

static bool is_touched(const struct work *work, struct tile_id id) {
    const struct lattice *lattice = work->walk->plan->lattice;
    for (int i = 0; i < work->window_count; i++)
        if (is_within(lattice_tiles_touching(lattice, id.zoom, work->windows[i]), id)) return true;
    return false;
}

/* Whether the first window touches a tile of the second one. */
static bool is_met_before(const struct work *work, int window, struct tile_id id) {
    return window > 0 && is_within(lattice_tiles_touching(work->walk->plan->lattice, id.zoom, work->windows[0]), id);
}

static uint32_t count_touched(const struct work *work, int zoom) {
    uint32_t count = 0;
    for (int i = 0; i < work->window_count; i++) {
        struct tile_range range = lattice_tiles_touching(work->walk->plan->lattice, zoom, work->windows[i]);
        for (uint32_t y = range.y_first; y <= range.y_last; y++)
            for (uint32_t x = range.x_first; x <= range.x_last; x++)
                count += !is_met_before(work, i, (struct tile_id){zoom, x, y});
    }
    return count;
}

static bool is_whole(const struct post_tile *tile) {
    return tile->columns == TILE_CELLS && tile->rows == TILE_CELLS;
}

/* Whether all posts of a finest tile are data. */
static enum scree_status look_for_voids(struct work *work, struct tile_id id, const struct post_tile *tile,
                                        bool *has_voids, struct scree_error *error) {
    struct placed_posts other;
    size_t row_bytes = ((size_t)tile->columns + 1) * sizeof *tile->heights_m;
    enum scree_status status =
        placed_posts_read(work->walk->plan, id, work->walk->other_reader, work->memory, &other, error);
    *has_voids = false;
    for (int32_t y = 0; y <= tile->rows && status == SCREE_OK; y++)
        if (memcmp(tile->heights_m + (size_t)y * ((size_t)tile->columns + 1),
                   other.posts.heights_m + (int64_t)y * other.posts.stride, row_bytes) != 0)
            *has_voids = true;
    placed_posts_release(work->memory, &other);
    return status;
}

/* A finest tile; `*is_full` says whether there is one to be released. */
static enum scree_status make_finest(struct work *work, struct tile_id id, struct post_tile *tile, bool *is_full,
                                     struct scree_error *error) {
    bool has_voids = false;
    enum scree_status status = method_build_finest(work->walk->plan, id, work->walk->reader, work->memory, tile, error);
    if (status != SCREE_OK) return status;
    if (is_whole(tile) || work->is_cut) status = look_for_voids(work, id, tile, &has_voids, error);
    *is_full = status == SCREE_OK && !has_voids && (is_whole(tile) || work->is_cut);
    if (!*is_full) post_tile_release(tile);
    return status;
}

static enum scree_status visit_below(struct work *work, struct tile_id id, struct post_tile **coarse,
                                     struct scree_error *error);

/* A tile of full children; `*is_full` as above. */
static enum scree_status make_parent(struct work *work, struct tile_id id, struct post_tile *tile, bool *is_full,
                                     struct scree_error *error) {
    struct post_tile *children[4] = {NULL, NULL, NULL, NULL};
    enum scree_status status = SCREE_OK;
    *is_full = true;
    for (uint32_t i = 0; i < 4 && status == SCREE_OK; i++) {
        struct tile_id child = {id.zoom + 1, 2 * id.x + i % 2, 2 * id.y + i / 2};
        if (is_touched(work, child)) status = visit_below(work, child, &children[i], error);
        if (children[i] == NULL) *is_full = false;
    }
    if (status != SCREE_OK) *is_full = false;
    if (*is_full) {
        const struct post_tile *const whole[4] = {children[0], children[1], children[2], children[3]};
        status = method_build_parent(work->walk->plan, id, whole, work->memory, tile, error);
        if (status != SCREE_OK) *is_full = false;
    }
    for (int i = 0; i < 4; i++) post_tile_free(children[i]);
    return status;
}

/* Visits a tile and all below it. `*coarse` is what it leaves to its parent; NULL: it is not full, or its parent is
 * not asked for. */
static enum scree_status visit_below(struct work *work, struct tile_id id, struct post_tile **coarse,
                                     struct scree_error *error) {
    const struct compare_walk *walk = work->walk;
    struct post_tile tile;
    bool is_full = false, is_finest = id.zoom == walk->plan->lattice->finest_zoom;
    *coarse = NULL;
    enum scree_status status =
        is_finest ? make_finest(work, id, &tile, &is_full, error) : make_parent(work, id, &tile, &is_full, error);
    if (is_full) {
        if (id.zoom <= walk->max_zoom) status = walk->visit(walk->context, id, &tile, error);
        if (status == SCREE_OK && id.zoom > walk->min_zoom)
            status = method_build_hand_up(walk->plan, id, &tile, coarse, error);
        post_tile_release(&tile);
    }
    if (is_finest && walk->progress != NULL && status == SCREE_OK)
        walk->progress(walk->context, ++work->tiles_done, work->tiles_in_all);
    return status;
}

static enum scree_status visit_window(struct work *work, int window, struct scree_error *error) {
    int zoom = work->walk->min_zoom;
    struct tile_range range = lattice_tiles_touching(work->walk->plan->lattice, zoom, work->windows[window]);
    struct post_tile *coarse;
    enum scree_status status = SCREE_OK;
    for (uint32_t y = range.y_first; y <= range.y_last; y++)
        for (uint32_t x = range.x_first; x <= range.x_last && status == SCREE_OK; x++) {
            struct tile_id id = {zoom, x, y};
            if (!is_met_before(work, window, id)) status = visit_below(work, id, &coarse, error);
        }
    return status;
}

enum scree_status compare_walk(const struct compare_walk *walk, struct scree_memory *memory,
                               uint32_t touched[MAX_ZOOM + 1], bool *is_cut, struct scree_error *error) {
    const struct lattice *lattice = walk->plan->lattice;
    struct work work = {.walk = walk, .memory = memory};
    struct post_tile *coarse = NULL;
    enum scree_status status = SCREE_OK;
    work.window_count = raster_windows(walk->raster, work.windows);
    work.is_cut = lattice->columns <= TILE_CELLS || lattice->rows <= TILE_CELLS;
    work.tiles_in_all = count_touched(&work, lattice->finest_zoom);
    *is_cut = work.is_cut;
    for (int zoom = walk->min_zoom; zoom <= walk->max_zoom; zoom++) touched[zoom] = count_touched(&work, zoom);
    if (work.is_cut) {
        status = visit_below(&work, (struct tile_id){lattice->finest_zoom, 0, 0}, &coarse, error);
        post_tile_free(coarse);
        return status;
    }
    for (int i = 0; i < work.window_count && status == SCREE_OK; i++) status = visit_window(&work, i, error);
    return status;
}
