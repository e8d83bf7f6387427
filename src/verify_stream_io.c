#include "src/verify_stream_io.h"

#include "src/stream_cover.h"
#include "src/verify_listed.h"
#include "src/verify_stream_border.h"
#include "src/verify_stream_family.h"
#include "src/verify_stream_tile.h"

#include <inttypes.h>

#define TILE       "%d/%" PRIu32 "/%" PRIu32
#define TILE_OF(i) (i).zoom, (i).x, (i).y

/* The borders that tiles yet to come will meet. */
struct row {
    uint32_t count;
    struct tile_id *ids;
    struct stream_border *norths;
};

struct walk {
    struct scree_memory *memory;
    const struct stream_set *set;
    struct verify_report *report;
    struct scree_error *error;
    struct stream_zoom sums;    /* of the zoom that is being walked */
    struct row below, here;     /* northern borders of the row before, and of this one so far */
    struct tile_id before;      /* the tile whose eastern border `east` is */
    struct stream_border east;  /* no rungs: none */
    struct tile_id row_begin;   /* the tile of column 0, which the last column meets around the globe */
    struct stream_border first; /* its western border */
};

/* ---- neighbours ---- */

static void row_clear(struct scree_memory *memory, struct row *row) {
    for (uint32_t i = 0; i < row->count; i++) stream_border_free(memory, &row->norths[i]);
    row->count = 0;
}

static void row_free(struct scree_memory *memory, struct row *row) {
    row_clear(memory, row);
    scree_release(memory, row->norths);
    scree_release(memory, row->ids);
    *row = (struct row){0};
}

static enum scree_status row_new(struct walk *walk, uint32_t room, struct row *row) {
    row->ids = scree_allocate(walk->memory, room, sizeof *row->ids, "a row of tiles", walk->error);
    if (row->ids == NULL) return SCREE_E_MEMORY;
    row->norths = scree_allocate(walk->memory, room, sizeof *row->norths, "a row of borders", walk->error);
    return row->norths == NULL ? SCREE_E_MEMORY : SCREE_OK;
}

static void meet(struct walk *walk, struct tile_id one_id, const struct stream_border *one, struct tile_id other_id,
                 const struct stream_border *other) {
    struct stream_border_difference difference = stream_border_compare(one, other);
    walk->report->borders++;
    if (difference.lone_vertices != 0) {
        report_broken(walk->report, PROMISE_BORDERS,
                      "tiles " TILE " and " TILE ", rung %d: %" PRIu32 " vertices of one are not in the other",
                      TILE_OF(one_id), TILE_OF(other_id), difference.rung, difference.lone_vertices);
    } else if (difference.rungs == 0) {
        report_broken(walk->report, PROMISE_BORDERS, "tiles " TILE " and " TILE " have no rung in common",
                      TILE_OF(one_id), TILE_OF(other_id));
    } else {
        report_held(walk->report, PROMISE_BORDERS);
    }
}

static const struct stream_border *north_of(const struct row *row, struct tile_id id) {
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

/* Takes `border` over and leaves an empty one behind. */
static void keep(struct scree_memory *memory, struct stream_border *kept, struct stream_border *border) {
    stream_border_free(memory, kept);
    *kept = *border;
    *border = (struct stream_border){0};
}

static enum scree_status meet_neighbours(struct walk *walk, struct tile_id id, struct scree_player *player) {
    struct stream_border west = {0}, south = {0}, east = {0};
    struct stream_border *north = &walk->here.norths[walk->here.count];
    bool is_globe = walk->set->info.lattice.profile == PROFILE_GEODETIC;
    enum scree_status status = stream_border_new(walk->memory, player, SCREE_WEST, &west, walk->error);
    if (status == SCREE_OK) status = stream_border_new(walk->memory, player, SCREE_SOUTH, &south, walk->error);
    if (status == SCREE_OK) status = stream_border_new(walk->memory, player, SCREE_EAST, &east, walk->error);
    if (status == SCREE_OK) status = stream_border_new(walk->memory, player, SCREE_NORTH, north, walk->error);
    if (status != SCREE_OK) goto cleanup;
    walk->here.ids[walk->here.count++] = id;
    const struct stream_border *below = north_of(&walk->below, id);
    if (below != NULL) meet(walk, (struct tile_id){id.zoom, id.x, id.y - 1}, below, id, &south);
    if (walk->east.rung_count != 0 && walk->before.y == id.y && walk->before.x + 1 == id.x)
        meet(walk, walk->before, &walk->east, id, &west);
    keep(walk->memory, &walk->east, &east);
    walk->before = id;
    if (is_globe && id.x == 0) {
        keep(walk->memory, &walk->first, &west);
        walk->row_begin = id;
    }
    if (is_globe && walk->first.rung_count != 0 && walk->row_begin.y == id.y &&
        id.x + 1 == lattice_tiles_x(&walk->set->info.lattice, id.zoom))
        meet(walk, id, &walk->east, walk->row_begin, &walk->first);
cleanup:
    stream_border_free(walk->memory, &east);
    stream_border_free(walk->memory, &south);
    stream_border_free(walk->memory, &west);
    return status;
}

/* ---- parents ---- */

static enum scree_status verify_child(struct walk *walk, struct tile_id id, const struct scree_arrays *finest,
                                      int32_t finest_rung, struct tile_id child_id, struct scree_player *child) {
    const struct lattice *lattice = &walk->set->info.lattice;
    struct lattice_window place = lattice_tile_window(lattice, id), window = lattice_tile_window(lattice, child_id);
    struct family_part quarter = {0}, base = {0};
    struct scree_arrays arrays;
    int32_t rung = scree_player_header(child)->rungs[0].rung;
    window.x -= place.x;
    window.y -= place.y;
    scree_player_look(child, &arrays);
    enum scree_status status = family_part_new(walk->memory, finest, 0, 0, &window, &quarter, walk->error);
    if (status == SCREE_OK)
        status =
            family_part_new(walk->memory, &arrays, (int32_t)window.x, (int32_t)window.y, &window, &base, walk->error);
    if (status != SCREE_OK) goto cleanup;
    uint32_t lone = family_part_compare(&quarter, &base) + quarter.crossing + base.crossing;
    if (rung != finest_rung) {
        report_broken(walk->report, PROMISE_STREAM_FAMILIES,
                      "tile " TILE " ends at rung %d, its child " TILE " begins at rung %d", TILE_OF(id), finest_rung,
                      TILE_OF(child_id), rung);
    } else if (lone != 0) {
        report_broken(walk->report, PROMISE_STREAM_FAMILIES,
                      "tile " TILE " and its child " TILE ": %" PRIu32 " triangles of one are not in the other",
                      TILE_OF(id), TILE_OF(child_id), lone);
    } else {
        report_held(walk->report, PROMISE_STREAM_FAMILIES);
    }
cleanup:
    family_part_free(walk->memory, &base);
    family_part_free(walk->memory, &quarter);
    return status;
}

/* The player is at its finest rung. Children that cannot be read are told of when it is their turn. */
static enum scree_status verify_family(struct walk *walk, struct tile_id id, struct scree_player *player) {
    const struct scree_stream_header *header = scree_player_header(player);
    enum scree_status status = SCREE_OK;
    struct scree_arrays finest;
    scree_player_look(player, &finest);
    for (int k = 0; k < 4 && status == SCREE_OK && id.zoom < walk->set->info.lattice.finest_zoom; k++) {
        struct tile_id child_id = stream_child(id, k);
        struct scree_error why = {0};
        struct scree_player *child;
        if (tile_list_find(&walk->set->tiles[child_id.zoom], child_id) == TILE_NOT_LISTED) continue;
        status = stream_set_play_base(walk->memory, walk->set, child_id, &child, &why);
        if (status == SCREE_E_MEMORY) return scree_fail(walk->error, status, "%s", why.text);
        if (status == SCREE_OK)
            status = verify_child(walk, id, &finest, header->rungs[header->rung_count - 1].rung, child_id, child);
        else
            status = SCREE_OK;
        scree_player_free(child);
    }
    return status;
}

/* ---- tiles ---- */

static enum scree_status visit(struct walk *walk, struct tile_id id) {
    struct zoom_count *sums = &walk->report->zooms[id.zoom];
    struct scree_error why = {0};
    struct scree_player *player;
    uint64_t file_bytes = 0;
    enum scree_status status = stream_set_play(walk->memory, walk->set, id, &player, &file_bytes, &why);
    sums->tiles++;
    sums->bytes += file_bytes;
    if (status == SCREE_E_MEMORY) return scree_fail(walk->error, status, "%s", why.text);
    if (status != SCREE_OK) {
        report_broken(walk->report, PROMISE_STREAM_FORMAT, "%s", why.text);
        return SCREE_OK;
    }
    const struct scree_stream_header *header = scree_player_header(player);
    const struct stream_tile_figures figures = stream_tile_figures_of(header, file_bytes);
    stream_zoom_add(&walk->sums, &figures);
    sums->vertices += figures.finest.vertex_count;
    sums->triangles += figures.finest.triangle_count;
    bool is_placed = verify_stream_header(header, &walk->set->info, id, walk->report);
    status = verify_stream_rungs(walk->memory, player, id, walk->report, walk->error);
    if (status == SCREE_OK && is_placed) status = meet_neighbours(walk, id, player);
    if (status == SCREE_OK && is_placed) status = verify_family(walk, id, player);
    scree_player_free(player);
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

/* The row that was being walked becomes the one below, if the next is its northern neighbour. */
static void begin_row(struct walk *walk, uint32_t from_y, uint32_t to_y) {
    struct row emptied = walk->below;
    row_clear(walk->memory, &emptied);
    walk->below = walk->here;
    walk->here = emptied;
    if (to_y != from_y + 1) row_clear(walk->memory, &walk->below);
    stream_border_free(walk->memory, &walk->east);
    stream_border_free(walk->memory, &walk->first);
}

/* ---- scree.json ---- */

static bool is_same_scale(const struct stream_scale *a, const struct stream_scale *b) {
    return a->rung == b->rung && a->vertices == b->vertices && a->triangles == b->triangles &&
           a->svo_min_m == b->svo_min_m && a->svo_max_m == b->svo_max_m && a->error_min_m == b->error_min_m &&
           a->error_max_m == b->error_max_m;
}

static void verify_figures(const struct scree_zoom_info *told, const struct stream_zoom *found, int zoom,
                           struct verify_report *report) {
    if (!told->is_told) {
        report_broken(report, PROMISE_STREAM_COUNTS, "zoom %d: scree.json says nothing of it", zoom);
    } else if (told->tiles != found->tile_count) {
        report_broken(report, PROMISE_STREAM_COUNTS,
                      "zoom %d: scree.json counts %" PRIu64 " tiles, %" PRIu32 " can be read", zoom, told->tiles,
                      found->tile_count);
    } else if (told->bytes != found->bytes) {
        report_broken(report, PROMISE_STREAM_COUNTS,
                      "zoom %d: scree.json counts %" PRIu64 " bytes, the files have %" PRIu64, zoom, told->bytes,
                      found->bytes);
    } else if (!is_same_scale(&told->coarsest, &found->coarsest)) {
        report_broken(report, PROMISE_STREAM_COUNTS,
                      "zoom %d: the figures of its coarsest rungs in scree.json are not those of the streams", zoom);
    } else if (!is_same_scale(&told->finest, &found->finest)) {
        report_broken(report, PROMISE_STREAM_COUNTS,
                      "zoom %d: the figures of its finest rungs in scree.json are not those of the streams", zoom);
    } else {
        report_held(report, PROMISE_STREAM_COUNTS);
    }
}

static enum scree_status walk_zoom(struct walk *walk, int zoom, uint64_t *done, uint64_t total,
                                   verify_progress *progress, void *context) {
    const struct tile_list *list = &walk->set->tiles[zoom];
    const struct scree_info *info = &walk->set->info;
    uint32_t room = longest_row(list);
    walk->sums = (struct stream_zoom){0};
    enum scree_status status = row_new(walk, room, &walk->below);
    if (status == SCREE_OK) status = row_new(walk, room, &walk->here);
    for (uint32_t i = 0; i < list->count && status == SCREE_OK; i++) {
        struct tile_id id = list->ids[i];
        if (i > 0 && list->ids[i - 1].y != id.y) begin_row(walk, list->ids[i - 1].y, id.y);
        if (progress != NULL && ++*done % 16 == 0) progress(context, (double)*done / (double)total);
        if (zoom > info->lattice.finest_zoom || lattice_tile_window(&info->lattice, id).columns == 0) {
            report_broken(walk->report, PROMISE_STREAM_LISTED, "tile " TILE " lies outside of the terrain",
                          TILE_OF(id));
            continue;
        }
        status = visit(walk, id);
    }
    if (status == SCREE_OK && (list->count != 0 || (zoom >= info->min_zoom && zoom <= info->max_zoom)))
        verify_figures(&info->zooms[zoom], &walk->sums, zoom, walk->report);
    stream_border_free(walk->memory, &walk->first);
    stream_border_free(walk->memory, &walk->east);
    row_free(walk->memory, &walk->here);
    row_free(walk->memory, &walk->below);
    return status;
}

enum scree_status verify_streams(struct scree_memory *memory, const struct stream_set *set, verify_progress *progress,
                                 void *context, struct verify_report *report, struct scree_error *error) {
    struct walk walk = {.memory = memory, .set = set, .report = report, .error = error};
    const struct verify_listing listing = {PROMISE_STREAM_LISTED, "scree.json", &set->info.available, set->tiles};
    uint64_t total = 0, done = 0;
    enum scree_status status = verify_listed(memory, &listing, report, error);
    verify_ancestors(set->tiles, set->info.lattice.profile, set->info.min_zoom, report);
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) total += set->tiles[zoom].count;
    for (int zoom = 0; zoom <= MAX_ZOOM && status == SCREE_OK; zoom++)
        status = walk_zoom(&walk, zoom, &done, total, progress, context);
    return status;
}
