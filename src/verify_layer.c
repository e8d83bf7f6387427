#include "src/verify_layer.h"

#include "src/verify_listed.h"

#include <inttypes.h>

static void check_zooms(const struct terrain_set *set, struct verify_report *report) {
    const struct layer_info *layer = &set->layer;
    int deepest = 0;
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++)
        if (set->tiles[zoom].count != 0) deepest = zoom;
    if (layer->complaint[0] != '\0') {
        report_broken(report, PROMISE_LAYER, "layer.json lacks: %s", layer->complaint);
    } else if (layer->max_zoom < deepest) {
        report_broken(report, PROMISE_LAYER, "maxzoom %d hides the tiles of zoom %d", layer->max_zoom, deepest);
    } else {
        report_held(report, PROMISE_LAYER);
    }
}

enum scree_status verify_layer_tiles(struct scree_memory *memory, const struct terrain_set *set,
                                     struct verify_report *report, struct scree_error *error) {
    const struct layer_info *layer = &set->layer;
    const struct verify_listing listing = {PROMISE_AVAILABLE, "layer.json", &layer->available, set->tiles};
    check_zooms(set, report);
    /* from the coarsest zoom on that the build was asked for; other producers' terrain from the roots on */
    verify_ancestors(set->tiles, layer->lattice.profile, layer->is_ours ? layer->min_zoom : 0, report);
    return layer->has_available ? verify_listed(memory, &listing, report, error) : SCREE_OK;
}

static void check_count(struct verify_report *report, int zoom, const char *what, uint64_t told, uint64_t found) {
    if (told == found) {
        report_held(report, PROMISE_COUNTS);
    } else {
        report_broken(report, PROMISE_COUNTS, "zoom %d: layer.json counts %" PRIu64 " %s, the files have %" PRIu64,
                      zoom, told, what, found);
    }
}

static void check_step(struct verify_report *report, int zoom, const char *what, double coarse, double fine) {
    if (fine <= coarse) { /* false for what is no number */
        report_held(report, PROMISE_LADDER);
    } else {
        report_broken(report, PROMISE_LADDER, "zoom %d: %s is %g m, and %g m a zoom above", zoom, what, fine, coarse);
    }
}

void verify_layer_counts(const struct layer_info *layer, struct verify_report *report) {
    if (!layer->is_ours) return;
    for (int zoom = 0; zoom <= layer->max_zoom; zoom++) {
        const struct layer_zoom_info *told = &layer->zooms[zoom];
        const struct zoom_count *found = &report->zooms[zoom];
        if (!told->is_told) {
            report_broken(report, PROMISE_COUNTS, "zoom %d: layer.json says nothing of it", zoom);
            continue;
        }
        check_count(report, zoom, "tiles", told->tiles, found->tiles);
        check_count(report, zoom, "vertices", told->vertices, found->vertices);
        check_count(report, zoom, "triangles", told->triangles, found->triangles);
        check_count(report, zoom, "bytes", told->bytes, found->bytes);
        if (zoom == 0 || !layer->zooms[zoom - 1].is_told || found->tiles == 0 || report->zooms[zoom - 1].tiles == 0)
            continue;
        check_step(report, zoom, "the tolerance", layer->zooms[zoom - 1].tolerance_m, told->tolerance_m);
        check_step(report, zoom, "the SVO", layer->zooms[zoom - 1].svo_m, told->svo_m);
    }
}
