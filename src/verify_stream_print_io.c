#include "src/verify_stream_print_io.h"

#include "src/verify_print_io.h"

#include <inttypes.h>
#include <stdio.h>

/* ---- for people ---- */

static void print_errors(const struct stream_against *against) {
    printf("\nLargest vertical error against the source, metres, as drawn; what tiles say, what was measured.\n"
           "Zooms above the finest are made against the extremes of their cells; between those a post may be farther "
           "off.\n\n"
           "       |   coarsest rungs    |    finest rungs     | rungs of tiles farther off than\n"
           "  zoom |      says  measured |      says  measured | they say, and by how much at most\n");
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        const struct stream_against_zoom *sums = &against->zooms[zoom];
        if (sums->meshes == 0) continue;
        printf("  %4d | %9.4g %9.4g | %9.4g %9.4g | %8" PRIu64 " of %" PRIu64, zoom, sums->coarsest.stated_m,
               sums->coarsest.measured_m, sums->finest.stated_m, sums->finest.measured_m, sums->beyond, sums->meshes);
        if (sums->beyond != 0) printf(", %.3g times", sums->worst_share);
        printf("\n");
    }
}

void verify_print_streams(const struct stream_set *set, const struct verify_report *report,
                          const struct stream_against *against, bool quiet) {
    struct zoom_count all = {0};
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        all.tiles += report->zooms[zoom].tiles;
        all.bytes += report->zooms[zoom].bytes;
    }
    if (!quiet)
        printf("%s: streams, %s, zooms %d to %d, %" PRIu64 " tiles, %.1f MB\n\n", set->folder,
               set->info.lattice.profile == PROFILE_GEODETIC ? "geodetic" : "local", set->info.min_zoom,
               set->info.max_zoom, all.tiles, (double)all.bytes / 1e6);
    verify_print_promises(report, quiet);
    if (quiet) return;
    if (against->zooms != NULL) print_errors(against);
    verify_print_end(report);
}

/* ---- for machines ---- */

static void put_measure(struct json_text *json, const char *key, const struct stream_measure *measure) {
    json_key(json, key);
    json_open_line(json, '{');
    json_key(json, "stated_m");
    json_number(json, measure->stated_m);
    json_key(json, "measured_m");
    json_number(json, measure->measured_m);
    json_close(json, '}');
}

static void put_zoom(struct json_text *json, const struct verify_report *report, const struct stream_against *against,
                     int zoom) {
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
    if (against->zooms != NULL && against->zooms[zoom].meshes != 0) {
        const struct stream_against_zoom *sums = &against->zooms[zoom];
        json_key(json, "meshes");
        json_integer(json, (int64_t)sums->meshes);
        json_key(json, "beyond");
        json_integer(json, (int64_t)sums->beyond);
        json_key(json, "worst_share");
        json_number(json, sums->worst_share);
        put_measure(json, "coarsest", &sums->coarsest);
        put_measure(json, "finest", &sums->finest);
    }
    json_close(json, '}');
}

void verify_put_streams(struct json_text *json, const struct stream_set *set, const struct verify_report *report,
                        const struct stream_against *against) {
    json_open(json, '{');
    json_key(json, "folder");
    json_string(json, set->folder);
    json_key(json, "ok");
    json_boolean(json, report_broken_promises(report) == 0);
    json_key(json, "borders");
    json_integer(json, (int64_t)report->borders);
    verify_put_promises(json, report);
    json_key(json, "zooms");
    json_open(json, '[');
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++)
        if (report->zooms[zoom].tiles != 0) put_zoom(json, report, against, zoom);
    json_close(json, ']');
    json_close(json, '}');
}
