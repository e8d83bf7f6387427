/* What scree compare found, in words and numbers: see the header. */
#include "src/compare_report.h"

#include "src/json_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TRIANGLE_SLACK 0.02
#define OPTIONS_ROOM   384

/* ---- means ---- */

static bool is_near(uint32_t triangles, uint32_t wanted) {
    return fabs((double)triangles - wanted) <= TRIANGLE_SLACK * wanted;
}

struct compare_means compare_means_of(const struct compare_entry *entry, uint32_t tile_count) {
    struct compare_means means = {.has_wanted_triangles = true, .main_low = HUGE_VAL, .main_high = -HUGE_VAL};
    double sum_squares_m2 = 0;
    int64_t posts = 0;
    for (uint32_t i = 0; i < tile_count; i++) {
        const struct compare_figures *tile = &entry->tiles[i];
        means.cpu_s += tile->cpu_s / tile_count;
        means.vertices += (double)tile->vertices / tile_count;
        means.triangles += (double)tile->triangles / tile_count;
        means.bytes += (double)tile->bytes / tile_count;
        means.main_low = fmin(means.main_low, tile->main_value);
        means.main_high = fmax(means.main_high, tile->main_value);
        means.hausdorff_m += tile->distance.max_m / tile_count;
        means.hausdorff_max_m = fmax(means.hausdorff_max_m, tile->distance.max_m);
        means.mean_distance_m += tile->distance.mean_m / tile_count;
        means.max_error_m = fmax(means.max_error_m, tile->max_error_m);
        if (entry->wanted_triangles != 0 && !is_near(tile->triangles, entry->wanted_triangles))
            means.has_wanted_triangles = false;
        sum_squares_m2 += tile->sum_squares_m2;
        posts += tile->posts;
    }
    means.rms_error_m = posts > 0 ? sqrt(sum_squares_m2 / (double)posts) : 0;
    return means;
}

static const struct compare_zoom *zoom_of(const struct compare_report *report, const struct compare_entry *entry) {
    const struct compare_zoom *zoom = report->zooms;
    while (zoom->zoom != entry->zoom) zoom++;
    return zoom;
}

uint32_t compare_tile_count(const struct compare_report *report, const struct compare_entry *entry) {
    return zoom_of(report, entry)->tile_count;
}

static struct compare_means means_of(const struct compare_report *report, const struct compare_entry *entry) {
    return compare_means_of(entry, compare_tile_count(report, entry));
}

/* All options, with the values that the main one took on where a number of triangles was wanted. */
static void tell_options(const struct compare_report *report, const struct compare_entry *entry, char *told,
                         size_t room) {
    const struct compare_means means = means_of(report, entry);
    const char *name = report->main_options[entry->method], *gap = entry->options[0] != '\0' ? " " : "";
    if (entry->wanted_triangles == 0 || name[0] == '\0')
        snprintf(told, room, "%s", entry->options);
    else if (means.main_low == means.main_high)
        snprintf(told, room, "%s=%.4g%s%s", name, means.main_low, gap, entry->options);
    else
        snprintf(told, room, "%s=%.4g..%.4g%s%s", name, means.main_low, means.main_high, gap, entry->options);
}

/* ---- CSV ---- */

void compare_add_csv(const struct compare_report *report, struct text *text) {
    text_add(text, "zoom,method,options,wanted_triangles,tiles,cpu_s,vertices,triangles,hausdorff_m,hausdorff_max_m,"
                   "mean_distance_m,max_error_m,rms_error_m,bytes\n");
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        const struct compare_means means = means_of(report, entry);
        char options[OPTIONS_ROOM];
        text_add(text, "%d,", entry->zoom);
        text_add_csv(text, report->methods[entry->method]);
        text_add(text, ",");
        tell_options(report, entry, options, sizeof options);
        text_add_csv(text, options);
        text_add(text, ",");
        if (entry->wanted_triangles != 0) text_add(text, "%u", (unsigned)entry->wanted_triangles);
        text_add(text, ",%u,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n",
                 (unsigned)compare_tile_count(report, entry), means.cpu_s, means.vertices, means.triangles,
                 means.hausdorff_m, means.hausdorff_max_m, means.mean_distance_m, means.max_error_m, means.rms_error_m,
                 means.bytes);
    }
}

void compare_add_tiles_csv(const struct compare_report *report, struct text *text) {
    text_add(text, "zoom,x,y,method,wanted_triangles,main_option,cpu_s,vertices,triangles,hausdorff_m,"
                   "from_posts_m,from_mesh_m,mean_distance_m,max_error_m,rms_error_m,bytes\n");
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        for (uint32_t k = 0; k < compare_tile_count(report, entry); k++) {
            const struct compare_figures *tile = &entry->tiles[k];
            text_add(text, "%d,%u,%u,", tile->id.zoom, (unsigned)tile->id.x, (unsigned)tile->id.y);
            text_add_csv(text, report->methods[entry->method]);
            text_add(text, ",");
            if (entry->wanted_triangles != 0) text_add(text, "%u", (unsigned)entry->wanted_triangles);
            text_add(text, ",%.9g,%.6g,%u,%u,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%llu\n", tile->main_value, tile->cpu_s,
                     (unsigned)tile->vertices, (unsigned)tile->triangles, tile->distance.max_m,
                     tile->distance.from_first_m, tile->distance.from_second_m, tile->distance.mean_m,
                     tile->max_error_m, sqrt(tile->sum_squares_m2 / (double)tile->posts),
                     (unsigned long long)tile->bytes);
        }
    }
}

/* ---- tables ---- */

/* Whether a table begins with this entry. */
static bool begins_table(const struct compare_report *report, uint32_t i) {
    const struct compare_entry *entry = &report->entries[i];
    return i == 0 || entry->zoom != entry[-1].zoom || entry->wanted_triangles != entry[-1].wanted_triangles;
}

static void add_heading(const struct compare_report *report, const struct compare_entry *entry, struct text *text) {
    const struct compare_zoom *zoom = zoom_of(report, entry);
    text_add(text, "Zoom %d, ", entry->zoom);
    if (zoom->is_cut)
        text_add(text, "one tile, which the raster's border cuts");
    else
        text_add(text, "%u full tile%s of %u", (unsigned)zoom->tile_count, zoom->tile_count == 1 ? "" : "s",
                 (unsigned)zoom->tiles_in_all);
    if (entry->wanted_triangles != 0) text_add(text, ", %u triangles", (unsigned)entry->wanted_triangles);
}

static void add_markdown_table(const struct compare_report *report, uint32_t first, struct text *text) {
    text_add(text, "\n## ");
    add_heading(report, &report->entries[first], text);
    text_add(text, "\n\n| method | options | CPU s | vertices | triangles | Hausdorff m | its largest | max error m | "
                   "RMS m | bytes |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (uint32_t i = first; i < report->entry_count && (i == first || !begins_table(report, i)); i++) {
        const struct compare_entry *entry = &report->entries[i];
        const struct compare_means means = means_of(report, entry);
        char options[OPTIONS_ROOM];
        tell_options(report, entry, options, sizeof options);
        text_add(text, "| %s | %s | %.4f | %.1f | %.1f%s | %.2f | %.2f | %.2f | %.3f | %.0f |\n",
                 report->methods[entry->method], options, means.cpu_s, means.vertices, means.triangles,
                 means.has_wanted_triangles ? "" : " (!)", means.hausdorff_m, means.hausdorff_max_m, means.max_error_m,
                 means.rms_error_m, means.bytes);
    }
}

/* All zooms together: what their table 5 tells. */
static void add_markdown_times(const struct compare_report *report, struct text *text) {
    text_add(text, "\n## CPU time of all tiles together\n\n| method | CPU s |\n|---|---:|\n");
    for (int method = 0; method < report->method_count; method++) {
        double sum_s = 0;
        for (uint32_t i = 0; i < report->entry_count; i++)
            if (report->entries[i].method == method)
                sum_s += means_of(report, &report->entries[i]).cpu_s * compare_tile_count(report, &report->entries[i]);
        text_add(text, "| %s | %.3f |\n", report->methods[method], sum_s);
    }
}

static void add_markdown_pictures(const struct compare_report *report, struct text *text) {
    bool has_begun = false;
    for (uint32_t z = 0; z < report->zoom_count; z++) {
        const struct compare_zoom *zoom = &report->zooms[z];
        if (zoom->picture[0] == '\0') continue;
        if (!has_begun) text_add(text, "\n## Meshes\n\nOne tile of each zoom, from above and from the south.\n");
        has_begun = true;
        text_add(text, "\n### Tile %d/%u/%u\n\nThe posts themselves:\n\n![](%s)\n", zoom->zoom,
                 (unsigned)zoom->picture_tile.x, (unsigned)zoom->picture_tile.y, zoom->picture);
        for (uint32_t i = 0; i < report->entry_count; i++) {
            const struct compare_entry *entry = &report->entries[i];
            if (entry->zoom != zoom->zoom || entry->picture[0] == '\0') continue;
            text_add(text, "\n%s, %u triangles:\n\n![](%s)\n", report->methods[entry->method],
                     (unsigned)entry->picture_triangles, entry->picture);
        }
    }
}

void compare_add_markdown(const struct compare_report *report, struct text *text) {
    text_add(text, "# Methods compared on %s\n\n", report->dem);
    text_add(text,
             "Means over tiles that are full of data. CPU time is that of the method alone, on one thread. Hausdorff\n"
             "is the symmetric distance in space of all vertices and %d points each on faces and edges from the other\n"
             "mesh; its largest is that of the worst tile. The max error is the largest vertical distance of any post\n"
             "of any tile, the RMS is over all posts of all tiles. Bytes are those of the static tile, compressed.\n",
             HAUSDORFF_POINTS);
    for (uint32_t i = 0; i < report->entry_count; i++)
        if (begins_table(report, i)) add_markdown_table(report, i, text);
    for (uint32_t i = 0; i < report->entry_count; i++) {
        if (means_of(report, &report->entries[i]).has_wanted_triangles) continue;
        text_add(text, "\n(!) The method has no option value that gives as many triangles, to 2 %%.\n");
        break;
    }
    add_markdown_times(report, text);
    text_add(text, "\n## Charts\n\n![Hausdorff distances of the tiles, sorted](hausdorff.svg)\n\n"
                   "![RMS error against triangles](error.svg)\n");
    add_markdown_pictures(report, text);
}

void compare_add_table(const struct compare_report *report, struct text *text) {
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        const struct compare_means means = means_of(report, entry);
        if (begins_table(report, i)) {
            if (i > 0) text_add(text, "\n");
            add_heading(report, entry, text);
            text_add(text,
                     "\nmethod              CPU s  vertices triangles Hausdorff m max error m     RMS m     bytes\n");
        }
        text_add(text, "%-16s %8.4f %9.1f %9.1f %11.2f %11.2f %9.3f %9.0f\n", report->methods[entry->method],
                 means.cpu_s, means.vertices, means.triangles, means.hausdorff_m, means.max_error_m, means.rms_error_m,
                 means.bytes);
    }
}

/* ---- JSON ---- */

static void put_number(struct json_text *json, const char *key, double number) {
    json_key(json, key);
    json_number(json, number);
}

static void put_tile(struct json_text *json, const struct compare_figures *tile) {
    json_open_line(json, '{');
    put_number(json, "x", tile->id.x);
    put_number(json, "y", tile->id.y);
    put_number(json, "main_option", tile->main_value);
    put_number(json, "cpu_s", tile->cpu_s);
    put_number(json, "vertices", tile->vertices);
    put_number(json, "triangles", tile->triangles);
    put_number(json, "hausdorff_m", tile->distance.max_m);
    put_number(json, "mean_distance_m", tile->distance.mean_m);
    put_number(json, "max_error_m", tile->max_error_m);
    put_number(json, "rms_error_m", sqrt(tile->sum_squares_m2 / (double)tile->posts));
    put_number(json, "bytes", (double)tile->bytes);
    json_close(json, '}');
}

static void put_entry(struct json_text *json, const struct compare_report *report, const struct compare_entry *entry) {
    const struct compare_means means = means_of(report, entry);
    char options[OPTIONS_ROOM];
    tell_options(report, entry, options, sizeof options);
    json_open(json, '{');
    put_number(json, "zoom", entry->zoom);
    json_key(json, "method");
    json_string(json, report->methods[entry->method]);
    json_key(json, "options");
    json_string(json, options);
    if (entry->wanted_triangles != 0) put_number(json, "wanted_triangles", entry->wanted_triangles);
    put_number(json, "cpu_s", means.cpu_s);
    put_number(json, "vertices", means.vertices);
    put_number(json, "triangles", means.triangles);
    put_number(json, "hausdorff_m", means.hausdorff_m);
    put_number(json, "hausdorff_max_m", means.hausdorff_max_m);
    put_number(json, "mean_distance_m", means.mean_distance_m);
    put_number(json, "max_error_m", means.max_error_m);
    put_number(json, "rms_error_m", means.rms_error_m);
    put_number(json, "bytes", means.bytes);
    json_key(json, "tiles");
    json_open(json, '[');
    for (uint32_t i = 0; i < compare_tile_count(report, entry); i++) put_tile(json, &entry->tiles[i]);
    json_close(json, ']');
    json_close(json, '}');
}

char *compare_json_new(const struct compare_report *report) {
    struct json_text json = {0};
    json_open(&json, '{');
    json_key(&json, "dem");
    json_string(&json, report->dem);
    json_key(&json, "zooms");
    json_open(&json, '[');
    for (uint32_t i = 0; i < report->zoom_count; i++) {
        json_open_line(&json, '{');
        put_number(&json, "zoom", report->zooms[i].zoom);
        put_number(&json, "tiles_compared", report->zooms[i].tile_count);
        put_number(&json, "tiles", report->zooms[i].tiles_in_all);
        json_key(&json, "is_cut");
        json_boolean(&json, report->zooms[i].is_cut);
        put_number(&json, "tolerance_m", report->zooms[i].tolerance_m);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_key(&json, "compared");
    json_open(&json, '[');
    for (uint32_t i = 0; i < report->entry_count; i++) put_entry(&json, report, &report->entries[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    return json_text_take(&json);
}
