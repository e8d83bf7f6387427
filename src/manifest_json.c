#include "src/manifest_json.h"

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

void manifest_put_ranges(struct json_text *json, const struct tile_id *tiles, uint32_t count) {
    size_t room = (size_t)count + 1;
    struct cover cover = {.rectangles = calloc(room, sizeof *cover.rectangles),
                          .open = calloc(room, sizeof *cover.open),
                          .still_open = calloc(room, sizeof *cover.still_open)};
    if (cover.rectangles != NULL && cover.open != NULL && cover.still_open != NULL) {
        cover_tiles(&cover, tiles, count);
    } else {
        json->failed = true;
    }
    json_open(json, '[');
    for (uint32_t i = 0; i < cover.count; i++) {
        json_open_line(json, '{');
        json_key(json, "startX");
        json_integer(json, cover.rectangles[i].x_first);
        json_key(json, "startY");
        json_integer(json, cover.rectangles[i].y_first);
        json_key(json, "endX");
        json_integer(json, cover.rectangles[i].x_last);
        json_key(json, "endY");
        json_integer(json, cover.rectangles[i].y_last);
        json_close(json, '}');
    }
    json_close(json, ']');
    free(cover.still_open);
    free(cover.open);
    free(cover.rectangles);
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

void manifest_put_projection(struct json_text *json, const struct lattice *lattice, const char *crs_wkt) {
    char authority[AUTHORITY_ROOM];
    const char *wkt = crs_wkt == NULL ? "" : crs_wkt;
    json_key(json, "projection");
    if (lattice->profile == PROFILE_GEODETIC)
        json_string(json, "EPSG:4326");
    else if (find_authority(wkt, authority))
        json_string(json, authority);
    else
        json_string(json, *wkt == '\0' ? "none" : wkt);
}

void manifest_put_rectangle(struct json_text *json, const char *key, const double rectangle[4]) {
    json_key(json, key);
    json_open_line(json, '[');
    for (int i = 0; i < 4; i++) json_number(json, rectangle[i]);
    json_close(json, ']');
}

void manifest_put_bounds(struct json_text *json, const struct lattice *lattice, const double data_bounds[4]) {
    double bounds[4];
    memcpy(bounds, data_bounds, sizeof bounds);
    if (lattice->profile == PROFILE_GEODETIC) {
        if (bounds[0] < -180 || bounds[2] > 180) { /* data across the antimeridian: clients know no such rectangle */
            bounds[0] = -180;
            bounds[2] = 180;
        }
        bounds[1] = fmax(bounds[1], -90);
        bounds[3] = fmin(bounds[3], 90);
    }
    manifest_put_rectangle(json, "bounds", bounds);
}

void manifest_put_lattice(struct json_text *json, const struct lattice *lattice) {
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

/* ---- which build ---- */

uint64_t manifest_mix(uint64_t hash, const void *bytes, size_t size_bytes) { /* FNV-1a */
    for (const unsigned char *b = bytes; size_bytes-- > 0; b++) hash = (hash ^ *b) * 0x100000001b3u;
    return hash;
}

void manifest_put_version(struct json_text *json, uint64_t hash) {
    char version[32];
    snprintf(version, sizeof version, "1.0.0-%08" PRIx32, (uint32_t)(hash ^ hash >> 32));
    json_key(json, "version");
    json_string(json, version);
}
