#include "src/extract_stream_io.h"

#include "src/extract_stitch.h"
#include "src/stream_cover.h"

#include <inttypes.h>
#include <math.h>

/* ---- which rung ---- */

int stream_rung_index(const struct scree_stream_header *header, const struct scale_wish *wish) {
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        bool is_last = i + 1 == header->rung_count;
        if ((wish->kind == SCALE_FINEST && is_last) || (wish->kind == SCALE_RUNG && rung->rung >= wish->rung) ||
            (wish->kind == SCALE_SVO && rung->svo_m <= wish->bound_m) ||
            (wish->kind == SCALE_ERROR && rung->max_error_m <= wish->bound_m))
            return (int)i;
    }
    return -1;
}

static enum scree_status no_rung(const char *name, const struct scale_wish *wish, struct scree_error *error) {
    if (wish->kind == SCALE_RUNG)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: no rung is as fine as %" PRId32 "; scree info tells which there are", name, wish->rung);
    return scree_fail(error, SCREE_E_ARGUMENT, "%s: no rung has a%s of at most %g m; scree info tells what there is",
                      name, wish->kind == SCALE_SVO ? "n SVO" : " max error", wish->bound_m);
}

/* The coarsest rung of a zoom at which every tile is within the bound; `possible`: there is one. */
static enum scree_status rung_of_zoom(struct scree_memory *memory, const struct stream_set *set, int zoom,
                                      const struct scale_wish *wish, int32_t *rung, bool *possible,
                                      struct scree_error *error) {
    const struct tile_list *list = &set->tiles[zoom];
    struct scree_stream_header *header = scree_allocate(memory, 1, sizeof *header, "a stream's header", error);
    enum scree_status status = header == NULL ? SCREE_E_MEMORY : SCREE_OK;
    uint64_t file_bytes;
    *rung = INT32_MIN;
    *possible = list->count != 0;
    for (uint32_t i = 0; i < list->count && status == SCREE_OK && *possible; i++) {
        status = stream_set_header(memory, set, list->ids[i], header, &file_bytes, error);
        if (status != SCREE_OK) break;
        int index = stream_rung_index(header, wish);
        *possible = index >= 0;
        if (*possible && header->rungs[index].rung > *rung) *rung = header->rungs[index].rung;
    }
    scree_release(memory, header);
    return status;
}

/* A tile of zoom z has the rungs 4 (z - 1) .. 4 z, the finest zoom those beyond as well. */
static int zoom_of_rung(const struct stream_set *set, int32_t rung) {
    int zoom = (int)ceil(rung / 4.0);
    if (zoom < set->info.min_zoom) zoom = set->info.min_zoom;
    return zoom > set->info.max_zoom ? set->info.max_zoom : zoom;
}

static enum scree_status choose(struct scree_memory *memory, const struct stream_set *set,
                                const struct scale_wish *wish, int *zoom, int32_t *rung, struct scree_error *error) {
    bool possible = false;
    *zoom = set->info.max_zoom;
    *rung = INT32_MAX;
    if (wish->kind == SCALE_RUNG) {
        *rung = wish->rung;
        *zoom = zoom_of_rung(set, *rung);
    }
    if (wish->kind != SCALE_SVO && wish->kind != SCALE_ERROR) return SCREE_OK;
    for (int z = set->info.min_zoom; z <= set->info.max_zoom; z++) {
        *zoom = z;
        enum scree_status status = rung_of_zoom(memory, set, z, wish, rung, &possible, error);
        if (status != SCREE_OK || possible) return status;
    }
    return no_rung(set->folder, wish, error);
}

/* ---- tiles into the mesh ---- */

static void add_place(double all[4], const struct lattice *lattice, const struct lattice_window *window,
                      bool is_first) {
    double bounds[4] = {lattice_x(lattice, (double)window->x), lattice_y(lattice, (double)window->y),
                        lattice_x(lattice, (double)window->x + window->columns),
                        lattice_y(lattice, (double)window->y + window->rows)};
    for (int k = 0; k < 4; k++)
        if (is_first || (k < 2 ? bounds[k] < all[k] : bounds[k] > all[k])) all[k] = bounds[k];
}

static enum scree_status add_mesh(struct scree_memory *memory, struct stream_extract *extract,
                                  struct scree_player *player, uint32_t index, const struct lattice_window *place,
                                  const struct lattice_window *only, struct scree_error *error) {
    const struct scree_stream_header *header = scree_player_header(player);
    const struct scree_rung *rung = &header->rungs[index];
    struct scree_arrays arrays;
    enum scree_status status = scree_player_seek_rung(player, index);
    if (status != SCREE_OK) return scree_fail(error, status, "a decoded rung cannot be shown");
    scree_player_look(player, &arrays);
    struct extract_posts posts = {.x = place->x,
                                  .y = place->y,
                                  .vertex_count = arrays.vertex_count,
                                  .triangle_count = arrays.triangle_count,
                                  .vertices = arrays.vertices,
                                  .corners = arrays.indices,
                                  .height_unit_m = ldexp(1, header->height_exponent),
                                  .only = only};
    status = extract_mesh_add_posts(memory, &extract->mesh, &posts, error);
    if (status != SCREE_OK || only != NULL) return status;
    if (extract->rung < rung->rung) extract->rung = rung->rung;
    extract->svo_m = fmax(extract->svo_m, rung->svo_m);
    extract->max_error_m = fmax(extract->max_error_m, rung->max_error_m);
    return SCREE_OK;
}

/* The stream of the piece before, which the next one may need again. */
struct held {
    struct tile_id id;
    struct scree_player *player;
};

static enum scree_status hold(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                              struct held *held, struct scree_error *error) {
    const struct lattice_window window = lattice_tile_window(&set->info.lattice, id);
    bool is_held = held->player != NULL && held->id.zoom == id.zoom && held->id.x == id.x && held->id.y == id.y;
    if (is_held) return SCREE_OK;
    scree_player_free(held->player);
    held->player = NULL;
    held->id = id;
    enum scree_status status = stream_set_play(memory, set, id, &held->player, NULL, error);
    if (status != SCREE_OK) return status;
    const struct scree_stream_header *header = scree_player_header(held->player);
    if (header->columns != window.columns || header->rows != window.rows)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: tile %d/%" PRIu32 "/%" PRIu32 " covers %d x %d steps, but scree.json wants %d x %d; "
                          "scree verify tells more",
                          set->folder, id.zoom, id.x, id.y, header->columns, header->rows, window.columns, window.rows);
    return SCREE_OK;
}

static enum scree_status add_piece(struct scree_memory *memory, const struct stream_set *set,
                                   const struct stream_piece *piece, int32_t rung, struct held *held,
                                   struct stream_extract *extract, struct scree_error *error) {
    const struct scale_wish wish = {.kind = SCALE_RUNG, .rung = rung};
    struct lattice_window place = lattice_tile_window(&set->info.lattice, piece->id);
    enum scree_status status = hold(memory, set, piece->id, held, error);
    if (status != SCREE_OK) return status;
    const struct scree_stream_header *header = scree_player_header(held->player);
    int index = piece->is_part ? -1 : stream_rung_index(header, &wish);
    if (index < 0) index = (int)header->rung_count - 1;
    return add_mesh(memory, extract, held->player, (uint32_t)index, &place, piece->is_part ? &piece->window : NULL,
                    error);
}

static enum scree_status add_cover(struct scree_memory *memory, const struct stream_set *set,
                                   const struct stream_cover *cover, int32_t rung, struct stream_extract *extract,
                                   struct scree_error *error) {
    struct held held = {0};
    enum scree_status status = SCREE_OK;
    double all[4] = {0};
    bool has_parts = false;
    for (uint32_t i = 0; i < cover->count && status == SCREE_OK; i++) {
        const struct stream_piece *piece = &cover->pieces[i];
        bool is_new = i == 0 || piece->id.x != held.id.x || piece->id.y != held.id.y || piece->id.zoom != held.id.zoom;
        extract->tiles += is_new;
        has_parts = has_parts || piece->is_part;
        add_place(all, &extract->lattice, &piece->window, i == 0);
        status = add_piece(memory, set, piece, rung, &held, extract, error);
    }
    scree_player_free(held.player);
    extract->middle[0] = (all[0] + all[2]) / 2;
    extract->middle[1] = (all[1] + all[3]) / 2;
    if (status == SCREE_OK && has_parts)
        status = extract_mesh_stitch(memory, &extract->mesh, &extract->stitched, error);
    return status;
}

static void begin(struct stream_extract *extract, const struct lattice *lattice, int zoom) {
    extract->lattice = *lattice;
    extract->mesh = (struct extract_mesh){.lattice = &extract->lattice, .in_posts = true};
    extract->zoom = zoom;
    extract->rung = INT32_MIN;
}

/* One tile of the set. */
static enum scree_status extract_tile(struct scree_memory *memory, const struct stream_set *set,
                                      const struct scale_wish *wish, struct tile_id id, struct stream_extract *extract,
                                      struct scree_error *error) {
    struct stream_piece piece = {id, false, lattice_tile_window(&set->info.lattice, id)};
    const struct stream_cover cover = {.count = 1, .pieces = &piece};
    uint64_t file_bytes;
    if (id.zoom > set->info.lattice.finest_zoom || tile_list_find(&set->tiles[id.zoom], id) == TILE_NOT_LISTED)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: there is no tile %d/%" PRIu32 "/%" PRIu32, set->folder, id.zoom,
                          id.x, id.y);
    struct scree_stream_header *header = scree_allocate(memory, 1, sizeof *header, "a stream's header", error);
    if (header == NULL) return SCREE_E_MEMORY;
    enum scree_status status = stream_set_header(memory, set, id, header, &file_bytes, error);
    int index = status == SCREE_OK ? stream_rung_index(header, wish) : -1;
    if (status == SCREE_OK && index < 0) status = no_rung(set->folder, wish, error);
    if (status == SCREE_OK) status = add_cover(memory, set, &cover, header->rungs[index].rung, extract, error);
    scree_release(memory, header);
    return status;
}

enum scree_status extract_stream_set(struct scree_memory *memory, const struct stream_set *set,
                                     const struct scale_wish *wish, const struct tile_id *only,
                                     struct stream_extract *extract, struct scree_error *error) {
    struct stream_cover cover = {0};
    int32_t rung;
    int zoom = only == NULL ? 0 : only->zoom;
    begin(extract, &set->info.lattice, zoom);
    if (only != NULL) return extract_tile(memory, set, wish, *only, extract, error);
    enum scree_status status = choose(memory, set, wish, &extract->zoom, &rung, error);
    if (status != SCREE_OK) return status;
    status = stream_cover_new(memory, &set->info.lattice, set->tiles, set->info.min_zoom, extract->zoom, &cover, error);
    if (status == SCREE_OK) status = add_cover(memory, set, &cover, rung, extract, error);
    if (status == SCREE_OK && wish->kind == SCALE_RUNG && extract->rung < wish->rung)
        status = no_rung(set->folder, wish, error);
    stream_cover_free(memory, &cover);
    return status;
}

/* ---- a file by itself ---- */

/* A lattice for one tile, and where the tile lies on it: the globe's, or one that begins at the tile's corner. */
static enum scree_status lattice_of_file(const char *path, const struct scree_stream_header *header,
                                         struct lattice *lattice, struct lattice_window *window,
                                         struct scree_error *error) {
    struct tile_id id = {header->zoom, header->tile_x, header->tile_y};
    if (header->profile == SCREE_GEODETIC) {
        int finest_zoom = header->zoom;
        while (finest_zoom < MAX_ZOOM && (int64_t)TILE_CELLS << (finest_zoom - header->zoom) < header->columns)
            finest_zoom++;
        *lattice = lattice_geodetic(finest_zoom < MAX_ZOOM ? finest_zoom : MAX_ZOOM);
        if (header->zoom <= MAX_ZOOM) *window = lattice_tile_window(lattice, id);
        if (header->zoom > MAX_ZOOM || window->columns != header->columns || window->rows != header->rows)
            return scree_fail(error, SCREE_E_UNSUPPORTED,
                              "%s: a tile of zoom %d with %d x %d steps is none of the geodetic profile", path,
                              header->zoom, header->columns, header->rows);
        return SCREE_OK;
    }
    *lattice = (struct lattice){.profile = PROFILE_LOCAL,
                                .columns = (int64_t)header->columns + 1,
                                .rows = (int64_t)header->rows + 1,
                                .west = header->west,
                                .south = header->south,
                                .spacing_x = header->spacing_x,
                                .spacing_y = header->spacing_y,
                                .metres_x = header->metres_x,
                                .metres_y = header->metres_y};
    *window = (struct lattice_window){.columns = header->columns, .rows = header->rows};
    return SCREE_OK;
}

enum scree_status extract_stream_file(struct scree_memory *memory, const char *path, const struct scale_wish *wish,
                                      struct stream_extract *extract, struct scree_error *error) {
    struct scree_player *player;
    struct lattice lattice;
    struct lattice_window window;
    double all[4];
    enum scree_status status = stream_file_play(memory, path, &player, NULL, error);
    if (status != SCREE_OK) return status;
    const struct scree_stream_header *header = scree_player_header(player);
    int index = stream_rung_index(header, wish);
    status = lattice_of_file(path, header, &lattice, &window, error);
    if (status == SCREE_OK && index < 0) status = no_rung(path, wish, error);
    if (status != SCREE_OK) goto cleanup;
    begin(extract, &lattice, header->zoom);
    extract->tiles = 1;
    add_place(all, &lattice, &window, true);
    extract->middle[0] = (all[0] + all[2]) / 2;
    extract->middle[1] = (all[1] + all[3]) / 2;
    status = add_mesh(memory, extract, player, (uint32_t)index, &window, NULL, error);
cleanup:
    scree_player_free(player);
    return status;
}

void stream_extract_free(struct scree_memory *memory, struct stream_extract *extract) {
    extract_mesh_free(memory, &extract->mesh);
    *extract = (struct stream_extract){0};
}
