#include "src/verify_terrain_io.h"

#include "src/verify_border.h"
#include "src/verify_layer.h"
#include "src/verify_tile.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define TILE       "%d/%" PRIu32 "/%" PRIu32
#define TILE_OF(i) (i).zoom, (i).x, (i).y

/* The borders that tiles yet to come will meet. */
struct border_row {
    uint32_t count;
    struct tile_id *ids;
    struct tile_border *norths;
};

struct walk {
    struct scree_memory *memory;
    const struct terrain_set *set;
    struct verify_report *report;
    struct scree_error *error;
    struct border_row below, here; /* northern borders of the row before, and of this one so far */
    struct tile_id before;         /* the tile whose eastern border `east` is */
    struct tile_border east;
    struct tile_id row_begin; /* the tile of column 0, which the last column meets around the globe */
    struct tile_border first_west;
    bool has_east, has_first_west;
};

static void border_row_clear(struct scree_memory *memory, struct border_row *row) {
    for (uint32_t i = 0; i < row->count; i++) tile_border_free(memory, &row->norths[i]);
    row->count = 0;
}

static void forget_east(struct walk *walk) {
    tile_border_free(walk->memory, &walk->east);
    walk->has_east = false;
}

static void forget_first_west(struct walk *walk) {
    tile_border_free(walk->memory, &walk->first_west);
    walk->has_first_west = false;
}

static void meet(struct walk *walk, struct tile_id one_id, const struct tile_border *one, struct tile_id other_id,
                 const struct tile_border *other) {
    struct verify_report *report = walk->report;
    struct border_difference difference = tile_border_compare(one, other);
    report->borders++;
    report->border_difference_m = fmax(report->border_difference_m, difference.largest_m);
    if (difference.lone_vertices != 0 || difference.largest_m != 0) {
        report_broken(report, PROMISE_BORDERS,
                      "tiles " TILE " and " TILE ": %g m apart, %" PRIu32 " vertices of one are not in the other",
                      TILE_OF(one_id), TILE_OF(other_id), difference.largest_m, difference.lone_vertices);
    } else {
        report_held(report, PROMISE_BORDERS);
    }
    if (one->has_normals != other->has_normals) {
        report_broken(report, PROMISE_NORMALS, "tiles " TILE " and " TILE ": only one of them has normals",
                      TILE_OF(one_id), TILE_OF(other_id));
    } else if (difference.normals != 0) {
        report_broken(report, PROMISE_NORMALS,
                      "tiles " TILE " and " TILE ": %" PRIu32 " shared vertices differ, the first at %u",
                      TILE_OF(one_id), TILE_OF(other_id), difference.normals, (unsigned)difference.normal_at);
    } else if (one->has_normals) {
        report_held(report, PROMISE_NORMALS);
    }
}

static const struct tile_border *border_below(const struct border_row *row, struct tile_id id) {
    uint32_t low = 0, high = row->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (row->ids[middle].x < id.x) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < row->count && row->ids[low].x == id.x ? &row->norths[low] : NULL;
}

static enum scree_status meet_neighbours(struct walk *walk, struct tile_id id, const struct decoded_tile *tile,
                                         const struct tile_frame *frame) {
    struct tile_border west = {0}, south = {0}, east = {0};
    struct tile_border *north = &walk->here.norths[walk->here.count];
    enum scree_status status = tile_border_new(walk->memory, tile, frame, EDGE_WEST, &west, walk->error);
    if (status == SCREE_OK) status = tile_border_new(walk->memory, tile, frame, EDGE_SOUTH, &south, walk->error);
    if (status == SCREE_OK) status = tile_border_new(walk->memory, tile, frame, EDGE_EAST, &east, walk->error);
    if (status == SCREE_OK) status = tile_border_new(walk->memory, tile, frame, EDGE_NORTH, north, walk->error);
    if (status != SCREE_OK) goto cleanup;
    walk->here.ids[walk->here.count++] = id;
    const struct tile_border *below = border_below(&walk->below, id);
    if (below != NULL && id.y > 0) meet(walk, (struct tile_id){id.zoom, id.x, id.y - 1}, below, id, &south);
    if (walk->has_east && walk->before.y == id.y && walk->before.x + 1 == id.x)
        meet(walk, walk->before, &walk->east, id, &west);
    forget_east(walk);
    walk->east = east;
    east = (struct tile_border){0};
    walk->has_east = true;
    walk->before = id;
    bool is_around = frame->profile == PROFILE_GEODETIC;
    if (is_around && id.x == 0) {
        forget_first_west(walk);
        walk->first_west = west;
        west = (struct tile_border){0};
        walk->row_begin = id;
        walk->has_first_west = true;
    }
    if (is_around && walk->has_first_west && walk->row_begin.y == id.y &&
        id.x + 1 == lattice_tiles_x(&walk->set->layer.lattice, id.zoom))
        meet(walk, id, &walk->east, walk->row_begin, &walk->first_west);
cleanup:
    tile_border_free(walk->memory, &east);
    tile_border_free(walk->memory, &south);
    tile_border_free(walk->memory, &west);
    return status;
}

static enum scree_status visit(struct walk *walk, struct tile_id id) {
    const struct layer_info *layer = &walk->set->layer;
    struct decoded_tile tile;
    struct scree_error why = {0};
    struct zoom_count *sums = &walk->report->zooms[id.zoom];
    uint64_t file_bytes = 0;
    enum scree_status status = terrain_set_read(walk->memory, walk->set, id, &tile, &file_bytes, &why);
    sums->tiles++;
    sums->bytes += file_bytes;
    if (status == SCREE_E_MEMORY) return scree_fail(walk->error, status, "%s", why.text);
    if (status != SCREE_OK) {
        report_broken(walk->report, PROMISE_FORMAT, "%s", why.text);
        return SCREE_OK;
    }
    report_held(walk->report, PROMISE_FORMAT);
    sums->vertices += tile.vertex_count;
    sums->triangles += tile.triangle_count;
    struct tile_frame frame = tile_frame_of(&layer->lattice, id, layer->is_ours);
    status = verify_tile(walk->memory, &tile, &frame, walk->report, walk->error);
    if (status == SCREE_OK && isfinite(decoded_step_m(&tile)) && isfinite(tile.height_min_m))
        status = meet_neighbours(walk, id, &tile, &frame);
    decoded_tile_free(walk->memory, &tile);
    return status;
}

/* Most tiles in a row, for the room that its borders need. */
static uint32_t longest_row(const struct tile_list *list) {
    uint32_t longest = 0, begin = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->ids[i].y != list->ids[begin].y) begin = i;
        if (i - begin + 1 > longest) longest = i - begin + 1;
    }
    return longest;
}

static enum scree_status border_row_new(struct walk *walk, uint32_t room, struct border_row *row) {
    row->ids = scree_allocate(walk->memory, room, sizeof *row->ids, "a row of tiles", walk->error);
    if (row->ids == NULL) return walk->error->status;
    row->norths = scree_allocate(walk->memory, room, sizeof *row->norths, "a row of borders", walk->error);
    return row->norths == NULL ? walk->error->status : SCREE_OK;
}

static void border_row_free(struct scree_memory *memory, struct border_row *row) {
    border_row_clear(memory, row);
    scree_release(memory, row->norths);
    scree_release(memory, row->ids);
    *row = (struct border_row){0};
}

/* The row that was being walked becomes the one below, if the next is its northern neighbour. */
static void begin_row(struct walk *walk, uint32_t from_y, uint32_t to_y) {
    struct border_row emptied = walk->below;
    border_row_clear(walk->memory, &emptied);
    walk->below = walk->here;
    walk->here = emptied;
    if (to_y != from_y + 1) border_row_clear(walk->memory, &walk->below);
    forget_east(walk);
    forget_first_west(walk);
}

static enum scree_status walk_zoom(struct walk *walk, int zoom, uint64_t *done, uint64_t total,
                                   verify_progress *progress, void *context) {
    const struct tile_list *list = &walk->set->tiles[zoom];
    const struct lattice *lattice = &walk->set->layer.lattice;
    uint32_t room = longest_row(list);
    enum scree_status status = border_row_new(walk, room, &walk->below);
    if (status == SCREE_OK) status = border_row_new(walk, room, &walk->here);
    for (uint32_t i = 0; i < list->count && status == SCREE_OK; i++) {
        struct tile_id id = list->ids[i];
        if (i > 0 && list->ids[i - 1].y != id.y) begin_row(walk, list->ids[i - 1].y, id.y);
        if (progress != NULL && ++*done % 16 == 0) progress(context, (double)*done / (double)total);
        if (zoom > lattice->finest_zoom || lattice_tile_window(lattice, id).columns == 0) {
            report_broken(walk->report, PROMISE_AVAILABLE, "tile " TILE " lies outside of the terrain", TILE_OF(id));
            continue;
        }
        status = visit(walk, id);
    }
    forget_first_west(walk);
    forget_east(walk);
    border_row_free(walk->memory, &walk->here);
    border_row_free(walk->memory, &walk->below);
    return status;
}

enum scree_status verify_terrain(struct scree_memory *memory, const struct terrain_set *set, verify_progress *progress,
                                 void *context, struct verify_report *report, struct scree_error *error) {
    struct walk walk = {.memory = memory, .set = set, .report = report, .error = error};
    uint64_t total = 0, done = 0;
    enum scree_status status = verify_layer_tiles(memory, set, report, error);
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) total += set->tiles[zoom].count;
    for (int zoom = 0; zoom <= MAX_ZOOM && status == SCREE_OK; zoom++)
        status = walk_zoom(&walk, zoom, &done, total, progress, context);
    if (status == SCREE_OK) verify_layer_counts(&set->layer, report);
    return status;
}
