#include "src/verify_print_io.h"

#include <inttypes.h>
#include <stdio.h>

#define QUANTILE 0.99

/* ---- for people ---- */

static void print_notes(const struct promise_state *state) {
    for (int i = 0; i < state->note_count; i++) printf("          %s\n", state->notes[i]);
    if (state->broken > (uint64_t)state->note_count)
        printf("          and %" PRIu64 " more\n", state->broken - (uint64_t)state->note_count);
}

void verify_print_promises(const struct verify_report *report, bool quiet) {
    for (int p = 0; p < PROMISE_COUNT; p++) {
        const struct promise_state *state = &report->promises[p];
        if (state->checked == 0 || (quiet && state->broken == 0)) continue;
        if (state->broken == 0) {
            printf("  ok      %-52s %10" PRIu64 "\n", promise_text((enum promise)p), state->checked);
        } else {
            printf("  BROKEN  %-52s %10" PRIu64 " of %" PRIu64 "\n", promise_text((enum promise)p), state->broken,
                   state->checked);
            print_notes(state);
        }
    }
}

void verify_print_end(const struct verify_report *report) {
    int broken = report_broken_promises(report);
    if (broken == 0) {
        printf("\nAll promises hold.\n");
    } else {
        printf("\n%d %s broken.\n", broken, broken == 1 ? "promise is" : "promises are");
    }
}

static void print_errors(const struct terrain_set *set, const struct against *against) {
    const struct layer_info *layer = &set->layer;
    printf("\nVertical error against the source, metres, at every %s.\n"
           "  height: as a client reads heights; drawn: flat triangles on the curved earth\n\n"
           "                             |                 height                  |             drawn             |\n"
           "  zoom      %s tolerance |       max       p99       RMS      mean |       max       p99       RMS |",
           against->is_of_points ? "point of the triangles" : "post of the finest lattice",
           against->is_of_points ? "points" : " posts");
    printf(" max is at\n");
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        const struct residuals *sums = &against->zooms[zoom];
        if (sums->posts == 0) continue;
        printf("  %4d %11" PRIu64, zoom, sums->posts);
        if (layer->zooms[zoom].is_told) {
            printf(" %9.4g |", layer->zooms[zoom].tolerance_m);
        } else {
            printf(" %9s |", "-");
        }
        printf(" %9.4g %9.4g %9.4g %9.3g |", sums->height.max_m,
               residual_quantile_m(&sums->height, sums->posts, QUANTILE), residual_rms_m(&sums->height, sums->posts),
               residual_mean_m(&sums->height, sums->posts));
        printf(" %9.4g %9.4g %9.4g | %.8g, %.8g\n", sums->drawn.max_m,
               residual_quantile_m(&sums->drawn, sums->posts, QUANTILE), residual_rms_m(&sums->drawn, sums->posts),
               lattice_x(&layer->lattice, (double)sums->drawn.max_x),
               lattice_y(&layer->lattice, (double)sums->drawn.max_y));
    }
}

void verify_print_text(const struct terrain_set *set, const struct verify_report *report, const struct against *against,
                       bool quiet) {
    struct zoom_count all = {0};
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        all.tiles += report->zooms[zoom].tiles;
        all.triangles += report->zooms[zoom].triangles;
        all.bytes += report->zooms[zoom].bytes;
    }
    if (!quiet)
        printf("%s: %s, zooms 0 to %d, %" PRIu64 " tiles, %" PRIu64 " triangles, %.1f MB%s\n\n", set->folder,
               set->layer.lattice.profile == PROFILE_GEODETIC ? "geodetic" : "local", set->layer.max_zoom, all.tiles,
               all.triangles, (double)all.bytes / 1e6,
               set->layer.is_ours ? "" : " (not made by scree: format and geometry are checked)");
    verify_print_promises(report, quiet);
    if (quiet) return;
    printf("\n  largest difference between neighbours: %g m, over %" PRIu64 " shared borders\n",
           report->border_difference_m, report->borders);
    if (against->zooms != NULL) print_errors(set, against);
    verify_print_end(report);
}

/* ---- for machines ---- */

static void put_promise(struct json_text *json, enum promise promise, const struct promise_state *state) {
    json_open(json, '{');
    json_key(json, "name");
    json_string(json, promise_name(promise));
    json_key(json, "text");
    json_string(json, promise_text(promise));
    json_key(json, "ok");
    json_boolean(json, state->broken == 0);
    json_key(json, "checked");
    json_integer(json, (int64_t)state->checked);
    json_key(json, "broken");
    json_integer(json, (int64_t)state->broken);
    json_key(json, "notes");
    json_open(json, '[');
    for (int i = 0; i < state->note_count; i++) json_string(json, state->notes[i]);
    json_close(json, ']');
    json_close(json, '}');
}

static void put_residual(struct json_text *json, const struct lattice *lattice, const struct residual *residual,
                         uint64_t posts) {
    json_open_line(json, '{');
    json_key(json, "max_m");
    json_number(json, residual->max_m);
    json_key(json, "p99_m");
    json_number(json, residual_quantile_m(residual, posts, QUANTILE));
    json_key(json, "rms_m");
    json_number(json, residual_rms_m(residual, posts));
    json_key(json, "mean_m");
    json_number(json, residual_mean_m(residual, posts));
    json_key(json, "max_at");
    json_open_line(json, '[');
    json_number(json, lattice_x(lattice, (double)residual->max_x));
    json_number(json, lattice_y(lattice, (double)residual->max_y));
    json_close(json, ']');
    json_close(json, '}');
}

static void put_zoom(struct json_text *json, const struct terrain_set *set, const struct verify_report *report,
                     const struct against *against, int zoom) {
    const struct zoom_count *count = &report->zooms[zoom];
    json_open(json, '{');
    json_key(json, "zoom");
    json_integer(json, zoom);
    json_key(json, "tiles");
    json_integer(json, (int64_t)count->tiles);
    json_key(json, "vertices");
    json_integer(json, (int64_t)count->vertices);
    json_key(json, "triangles");
    json_integer(json, (int64_t)count->triangles);
    json_key(json, "bytes");
    json_integer(json, (int64_t)count->bytes);
    if (set->layer.zooms[zoom].is_told) {
        json_key(json, "tolerance_m");
        json_number(json, set->layer.zooms[zoom].tolerance_m);
    }
    if (against->zooms != NULL && against->zooms[zoom].posts != 0) {
        const struct residuals *sums = &against->zooms[zoom];
        json_key(json, "posts");
        json_integer(json, (int64_t)sums->posts);
        json_key(json, "height");
        put_residual(json, &set->layer.lattice, &sums->height, sums->posts);
        json_key(json, "drawn");
        put_residual(json, &set->layer.lattice, &sums->drawn, sums->posts);
    }
    json_close(json, '}');
}

void verify_put_promises(struct json_text *json, const struct verify_report *report) {
    json_key(json, "promises");
    json_open(json, '[');
    for (int p = 0; p < PROMISE_COUNT; p++)
        if (report->promises[p].checked != 0) put_promise(json, (enum promise)p, &report->promises[p]);
    json_close(json, ']');
}

void verify_put_terrain(struct json_text *json, const struct terrain_set *set, const struct verify_report *report,
                        const struct against *against) {
    json_key(json, "terrain");
    json_string(json, set->folder);
    json_key(json, "borders");
    json_integer(json, (int64_t)report->borders);
    json_key(json, "border_difference_m");
    json_number(json, report->border_difference_m);
    verify_put_promises(json, report);
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++)
        if (report->zooms[zoom].tiles != 0) put_zoom(json, set, report, against, zoom);
    json_close(json, ']');
}
