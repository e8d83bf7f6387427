/* Writes layer.json (src/layer_json.h). */
#include "src/layer_json.h"

#include "config.h"
#include "src/json_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AUTHORITY_ROOM 80

/* ---- which tiles there are ---- */

struct rectangle { /* of tiles, inclusive */
    uint32_t x_first, y_first, x_last, y_last;
};

struct cover {
    struct rectangle *rectangles;
    uint32_t count;
    uint32_t *open, *still_open; /* rectangles that reach the row before, and those that reach this row, by x */
};

/* The next run of neighbours in a row of tiles that are sorted by y, then x. */
static struct rectangle take_run(const struct tile_id *tiles, uint32_t count, uint32_t *at) {
    const struct tile_id *first = &tiles[*at];
    struct rectangle run = {first->x, first->y, first->x, first->y};
    for (++*at; *at < count && tiles[*at].y == run.y_first && tiles[*at].x == run.x_last + 1; ++*at) run.x_last++;
    return run;
}

/* One row: each run is joined to the same run of the row below, or begins a rectangle. Returns how many there are. */
static uint32_t cover_row(struct cover *cover, uint32_t open_count, const struct tile_id *tiles, uint32_t count,
                          uint32_t *at) {
    uint32_t candidate = 0, still_open_count = 0, y = tiles[*at].y;
    while (*at < count && tiles[*at].y == y) {
        struct rectangle run = take_run(tiles, count, at);
        while (candidate < open_count && cover->rectangles[cover->open[candidate]].x_first < run.x_first) candidate++;
        struct rectangle *below =
            candidate < open_count ? &cover->rectangles[cover->open[candidate]] : &cover->rectangles[cover->count];
        if (candidate < open_count && below->x_first == run.x_first && below->x_last == run.x_last &&
            below->y_last + 1 == y) {
            below->y_last = y;
            cover->still_open[still_open_count++] = cover->open[candidate];
        } else {
            cover->rectangles[cover->count] = run;
            cover->still_open[still_open_count++] = cover->count++;
        }
    }
    return still_open_count;
}

/* Rectangles that cover exactly the given tiles. */
static void cover_tiles(struct cover *cover, const struct tile_id *tiles, uint32_t count) {
    uint32_t open_count = 0;
    cover->count = 0;
    for (uint32_t at = 0; at < count;) {
        open_count = cover_row(cover, open_count, tiles, count, &at);
        uint32_t *swap = cover->open;
        cover->open = cover->still_open;
        cover->still_open = swap;
    }
}

static void put_available(struct json_text *json, const struct layer *layer, struct cover *cover) {
    json_key(json, "available");
    json_open(json, '[');
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        cover_tiles(cover, layer->zooms[zoom].tiles, layer->zooms[zoom].tile_count);
        json_open(json, '[');
        for (uint32_t i = 0; i < cover->count; i++) {
            json_open_line(json, '{');
            json_key(json, "startX");
            json_integer(json, cover->rectangles[i].x_first);
            json_key(json, "startY");
            json_integer(json, cover->rectangles[i].y_first);
            json_key(json, "endX");
            json_integer(json, cover->rectangles[i].x_last);
            json_key(json, "endY");
            json_integer(json, cover->rectangles[i].y_last);
            json_close(json, '}');
        }
        json_close(json, ']');
    }
    json_close(json, ']');
}

/* ---- where they lie ---- */

/* The text between the quotes, or up to a delimiter, that `wkt` begins with. Returns what follows. */
static const char *take_word(const char *wkt, char *word, size_t room) {
    size_t length = 0;
    bool quoted = *wkt == '"';
    for (wkt += quoted; *wkt != '\0' && (quoted ? *wkt != '"' : strchr(",]) \n", *wkt) == NULL); wkt++)
        if (length + 1 < room) word[length++] = *wkt;
    word[length] = '\0';
    return *wkt == '"' ? wkt + 1 : wkt;
}

/* Reads `ID["EPSG",32611]` or `AUTHORITY["EPSG","32611"]` as "EPSG:32611"; false when it is something else. */
static bool read_authority(const char *wkt, char authority[AUTHORITY_ROOM]) {
    static const char *const keywords[] = {"ID[", "AUTHORITY["};
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
        char name[AUTHORITY_ROOM / 2], code[AUTHORITY_ROOM / 2];
        if (strncmp(wkt, keywords[i], strlen(keywords[i])) != 0) continue;
        const char *rest = take_word(wkt + strlen(keywords[i]), name, sizeof name);
        if (*rest != ',') return false;
        take_word(rest + 1, code, sizeof code);
        snprintf(authority, AUTHORITY_ROOM, "%s:%s", name, code);
        return true;
    }
    return false;
}

/* The authority's code of the CRS itself: of the outermost element, not of its parts. */
static bool find_authority(const char *wkt, char authority[AUTHORITY_ROOM]) {
    bool found = false, quoted = false;
    int depth = 0;
    for (const char *c = wkt; *c != '\0'; c++) {
        if (*c == '"') quoted = !quoted;
        if (quoted) continue;
        bool word_begins = c > wkt && strchr(",\n ", c[-1]) != NULL;
        if (depth == 1 && word_begins && read_authority(c, authority)) found = true;
        if (*c == '[') depth++;
        if (*c == ']') depth--;
    }
    return found;
}

static void put_projection(struct json_text *json, const struct layer *layer) {
    char authority[AUTHORITY_ROOM];
    const char *wkt = layer->crs_wkt == NULL ? "" : layer->crs_wkt;
    json_key(json, "projection");
    if (layer->lattice->profile == PROFILE_GEODETIC)
        json_string(json, "EPSG:4326");
    else if (find_authority(wkt, authority))
        json_string(json, authority);
    else
        json_string(json, *wkt == '\0' ? "none" : wkt);
}

static void put_bounds(struct json_text *json, const struct layer *layer) {
    double bounds[4];
    memcpy(bounds, layer->bounds, sizeof bounds);
    if (layer->lattice->profile == PROFILE_GEODETIC) {
        if (bounds[0] < -180 || bounds[2] > 180) { /* data across the antimeridian: clients know no such rectangle */
            bounds[0] = -180;
            bounds[2] = 180;
        }
        bounds[1] = fmax(bounds[1], -90);
        bounds[3] = fmin(bounds[3], 90);
    }
    json_key(json, "bounds");
    json_open_line(json, '[');
    for (int i = 0; i < 4; i++) json_number(json, bounds[i]);
    json_close(json, ']');
}

/* ---- what verify and info want to know ---- */

static void put_lattice(struct json_text *json, const struct lattice *lattice) {
    json_key(json, "lattice");
    json_open(json, '{');
    json_key(json, "finest_zoom");
    json_integer(json, lattice->finest_zoom);
    json_key(json, "west");
    json_number(json, lattice->west);
    json_key(json, "south");
    json_number(json, lattice->south);
    json_key(json, "spacing_x");
    json_number(json, lattice->spacing_x);
    json_key(json, "spacing_y");
    json_number(json, lattice->spacing_y);
    json_key(json, "metres_x");
    json_number(json, lattice->metres_x);
    json_key(json, "metres_y");
    json_number(json, lattice->metres_y);
    json_key(json, "columns");
    json_integer(json, lattice->columns);
    json_key(json, "rows");
    json_integer(json, lattice->rows);
    json_close(json, '}');
}

static void put_zooms(struct json_text *json, const struct layer *layer) {
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom *sums = &layer->zooms[zoom];
        json_open_line(json, '{');
        json_key(json, "zoom");
        json_integer(json, zoom);
        json_key(json, "tolerance_m");
        json_number(json, sums->tolerance_m);
        json_key(json, "height_step_m");
        json_number(json, sums->height_step_m);
        json_key(json, "max_error_m");
        json_number(json, sums->max_error_m);
        json_key(json, "svo_m");
        json_number(json, sums->svo_m);
        json_key(json, "tiles");
        json_integer(json, sums->tile_count);
        json_key(json, "vertices");
        json_integer(json, (int64_t)sums->vertices);
        json_key(json, "triangles");
        json_integer(json, (int64_t)sums->triangles);
        json_key(json, "bytes");
        json_integer(json, (int64_t)sums->bytes);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void put_scree(struct json_text *json, const struct layer *layer) {
    json_key(json, "scree");
    json_open(json, '{');
    json_key(json, "generator");
    json_string(json, "scree " PACKAGE_VERSION);
    json_key(json, "profile");
    json_string(json, layer->lattice->profile == PROFILE_GEODETIC ? "geodetic" : "local");
    put_lattice(json, layer->lattice);
    json_key(json, "min_zoom");
    json_integer(json, layer->min_zoom);
    json_key(json, "max_zoom");
    json_integer(json, layer->max_zoom);
    json_key(json, "data_bounds"); /* not clamped: the east may lie beyond 180 degrees */
    json_open_line(json, '[');
    for (int i = 0; i < 4; i++) json_number(json, layer->bounds[i]);
    json_close(json, ']');
    json_key(json, "crs_wkt");
    json_string(json, layer->crs_wkt);
    json_key(json, "datum");
    json_string(json, layer->datum);
    json_key(json, "nodata_height_m");
    json_number(json, layer->nodata_height_m);
    json_key(json, "gzip");
    json_boolean(json, layer->is_gzipped);
    put_zooms(json, layer);
    json_close(json, '}');
}

/* ---- the whole ---- */

static uint64_t mix(uint64_t hash, const void *bytes, size_t size_bytes) { /* FNV-1a */
    for (const unsigned char *b = bytes; size_bytes-- > 0; b++) hash = (hash ^ *b) * 0x100000001b3u;
    return hash;
}

/* Clients append the version to the tiles' addresses: other tiles get another one, so that no cache mixes two builds.
 */
static void put_version(struct json_text *json, const struct layer *layer) {
    uint64_t hash = mix(0xcbf29ce484222325u, layer->bounds, sizeof layer->bounds);
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom *sums = &layer->zooms[zoom];
        const double figures[] = {sums->tolerance_m, sums->height_step_m, sums->max_error_m, sums->svo_m};
        const uint64_t counts[] = {sums->vertices, sums->triangles, sums->bytes, sums->tile_count};
        hash = mix(mix(hash, figures, sizeof figures), counts, sizeof counts);
    }
    char version[32];
    snprintf(version, sizeof version, "1.0.0-%08" PRIx32, (uint32_t)(hash ^ hash >> 32));
    json_key(json, "version");
    json_string(json, version);
}

static void put_layer(struct json_text *json, const struct layer *layer, struct cover *cover) {
    json_open(json, '{');
    json_key(json, "tilejson");
    json_string(json, "2.1.0");
    json_key(json, "name");
    json_string(json, "terrain");
    json_key(json, "format");
    json_string(json, "quantized-mesh-1.0");
    put_version(json, layer);
    json_key(json, "scheme");
    json_string(json, "tms");
    put_projection(json, layer);
    json_key(json, "tiles");
    json_open_line(json, '[');
    json_string(json, "{z}/{x}/{y}.terrain?v={version}");
    json_close(json, ']');
    json_key(json, "minzoom");
    json_integer(json, layer->min_zoom);
    json_key(json, "maxzoom");
    json_integer(json, layer->max_zoom);
    put_bounds(json, layer);
    json_key(json, "extensions");
    json_open_line(json, '[');
    if (layer->has_normals) json_string(json, "octvertexnormals");
    json_close(json, ']');
    json_key(json, "attribution");
    json_string(json, layer->attribution == NULL ? "" : layer->attribution);
    put_available(json, layer, cover);
    put_scree(json, layer);
    json_close(json, '}');
}

char *layer_json_new(const struct layer *layer, struct scree_error *error) {
    size_t most = 1;
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++)
        if (layer->zooms[zoom].tile_count > most) most = layer->zooms[zoom].tile_count;
    struct cover cover = {.rectangles = calloc(most, sizeof *cover.rectangles),
                          .open = calloc(most, sizeof *cover.open),
                          .still_open = calloc(most, sizeof *cover.still_open)};
    struct json_text json = {0};
    char *text = NULL;
    if (cover.rectangles != NULL && cover.open != NULL && cover.still_open != NULL) {
        put_layer(&json, layer, &cover);
        text = json_text_take(&json);
    }
    if (text == NULL) scree_fail(error, SCREE_E_MEMORY, "no memory for the text of layer.json");
    free(cover.still_open);
    free(cover.open);
    free(cover.rectangles);
    return text;
}
