#include "src/verify_report.h"

#include <stdarg.h>
#include <stdio.h>

static const struct {
    const char *name, *text;
} texts[PROMISE_COUNT] = {
    [PROMISE_LAYER] = {"layer", "layer.json says all that clients need"},
    [PROMISE_AVAILABLE] = {"available", "layer.json lists exactly the tiles that are there"},
    [PROMISE_ANCESTORS] = {"ancestors", "every tile has its parent, and the roots are there"},
    [PROMISE_FORMAT] = {"format", "every tile is quantized-mesh-1.0"},
    [PROMISE_VERTICES] = {"vertices", "every vertex is used, and no tile has 65,536"},
    [PROMISE_HEADER] = {"header", "centre, heights and bounding sphere are right"},
    [PROMISE_OCCLUSION] = {"occlusion", "horizon occlusion points hide no visible vertex"},
    [PROMISE_EDGE_LISTS] = {"edge_lists", "edge lists are complete and correct"},
    [PROMISE_ORIENTATION] = {"orientation", "every triangle has a positive area"},
    [PROMISE_COVER] = {"cover", "triangles cover each tile exactly once"},
    [PROMISE_BORDERS] = {"borders", "neighbours meet without a crack"},
    [PROMISE_NORMALS] = {"normals", "normals are equal along shared borders"},
    [PROMISE_COUNTS] = {"counts", "layer.json's counts are those of the files"},
    [PROMISE_LADDER] = {"ladder", "tolerance and SVO shrink from zoom to zoom"},
    [PROMISE_ERROR] = {"error", "the finest zoom is within its tolerance"},
    [PROMISE_STREAM_LISTED] = {"stream_listed", "scree.json lists exactly the streams that are there"},
    [PROMISE_STREAM_COUNTS] = {"stream_counts", "scree.json's figures are those of the streams"},
    [PROMISE_STREAM_FORMAT] = {"stream_format", "every stream decodes, from the first byte to the last"},
    [PROMISE_STREAM_PLACE] = {"stream_place", "headers say what scree.json and file names say"},
    [PROMISE_STREAM_SCALES] = {"stream_scales", "scales are on the ladder and grow finer in order"},
    [PROMISE_STREAM_FAMILIES] = {"stream_families", "a tile at its finest is its children at their coarsest"},
    [PROMISE_STREAM_ERROR] = {"stream_error", "no post or point is farther off than its stream says"},
};

const char *promise_name(enum promise promise) {
    return texts[promise].name;
}

const char *promise_text(enum promise promise) {
    return texts[promise].text;
}

void report_held(struct verify_report *report, enum promise promise) {
    report->promises[promise].checked++;
}

void report_broken(struct verify_report *report, enum promise promise, const char *format, ...) {
    struct promise_state *state = &report->promises[promise];
    state->checked++;
    state->broken++;
    if (state->note_count == REPORT_NOTES) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(state->notes[state->note_count++], REPORT_NOTE_BYTES, format, arguments);
    va_end(arguments);
}

int report_broken_promises(const struct verify_report *report) {
    int broken = 0;
    for (int p = 0; p < PROMISE_COUNT; p++) broken += report->promises[p].broken != 0;
    return broken;
}
