/* The charts of scree compare (src/compare_report.h): which figures go into which panel. */
#include "src/compare_report.h"
#include "src/svg_chart.h"

#include <stdio.h>
#include <stdlib.h>

#define TITLE_ROOM 64

/* A sheet in the making: a line an entry at the most, a panel an entry at the most. */
struct layout {
    struct chart_sheet sheet;
    struct chart_panel *panels;
    struct chart_line *lines;
    char (*titles)[TITLE_ROOM];
    double *numbers; /* x and y of all lines */
    uint32_t line_count;
    size_t number_count;
};

static void layout_free(struct scree_memory *memory, struct layout *layout) {
    scree_release(memory, layout->numbers);
    scree_release(memory, layout->titles);
    scree_release(memory, layout->lines);
    scree_release(memory, layout->panels);
}

static enum scree_status layout_make(const struct compare_report *report, struct scree_memory *memory,
                                     struct layout *layout, struct scree_error *error) {
    size_t numbers = 2 * (size_t)report->entry_count;
    for (uint32_t i = 0; i < report->entry_count; i++)
        numbers += 2 * (size_t)compare_tile_count(report, &report->entries[i]);
    *layout = (struct layout){.sheet = {.name_count = report->method_count, .names = report->methods}};
    layout->panels = scree_allocate(memory, report->entry_count, sizeof *layout->panels, "a chart", error);
    layout->lines = scree_allocate(memory, report->entry_count, sizeof *layout->lines, "a chart", error);
    layout->titles = scree_allocate(memory, report->entry_count, sizeof *layout->titles, "a chart", error);
    layout->numbers = scree_allocate(memory, numbers, sizeof *layout->numbers, "a chart", error);
    layout->sheet.panels = layout->panels;
    if (layout->panels != NULL && layout->lines != NULL && layout->titles != NULL && layout->numbers != NULL)
        return SCREE_OK;
    layout_free(memory, layout);
    return SCREE_E_MEMORY;
}

/* A new panel whose lines are those that come next. */
static void add_panel(struct layout *layout, const struct compare_entry *entry, bool tells_triangles) {
    uint32_t at = layout->sheet.panel_count++;
    if (tells_triangles)
        snprintf(layout->titles[at], TITLE_ROOM, "zoom %d, %u triangles", entry->zoom,
                 (unsigned)entry->wanted_triangles);
    else
        snprintf(layout->titles[at], TITLE_ROOM, "zoom %d", entry->zoom);
    layout->panels[at] = (struct chart_panel){.title = layout->titles[at], .lines = layout->lines + layout->line_count};
}

/* A new line of `count` points in the last panel; the numbers are to be filled in. */
static void add_line(struct layout *layout, int method, uint32_t count, double **x, double **y) {
    *x = layout->numbers + layout->number_count;
    *y = *x + count;
    layout->number_count += 2 * (size_t)count;
    layout->lines[layout->line_count++] = (struct chart_line){method, count, *x, *y};
    layout->panels[layout->sheet.panel_count - 1].line_count++;
}

static int by_size(const void *left, const void *right) {
    const double *a = left, *b = right;
    return *a < *b ? -1 : *a > *b; /* equal numbers are alike */
}

enum scree_status compare_add_hausdorff_chart(const struct compare_report *report, struct scree_memory *memory,
                                              struct text *text, struct scree_error *error) {
    struct layout layout;
    enum scree_status status = layout_make(report, memory, &layout, error);
    if (status != SCREE_OK) return status;
    layout.sheet.title = "Symmetric Hausdorff distances, sorted";
    layout.sheet.x_label = "tiles";
    layout.sheet.y_label = "distance, m";
    layout.sheet.y_is_logarithmic = true;
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        uint32_t tiles = compare_tile_count(report, entry);
        double *x, *y;
        if (i == 0 || entry->zoom != entry[-1].zoom || entry->wanted_triangles != entry[-1].wanted_triangles)
            add_panel(&layout, entry, entry->wanted_triangles != 0);
        add_line(&layout, entry->method, tiles, &x, &y);
        for (uint32_t k = 0; k < tiles; k++) {
            x[k] = k + 1.0;
            y[k] = entry->tiles[k].distance.max_m;
        }
        qsort(y, tiles, sizeof *y, by_size);
    }
    svg_chart_add(text, &layout.sheet);
    layout_free(memory, &layout);
    return SCREE_OK;
}

/* The points of one method at a zoom, one a wanted number of triangles. */
static void add_trade(const struct compare_report *report, int zoom, int method, struct layout *layout) {
    uint32_t count = 0, at = 0;
    double *x, *y;
    for (uint32_t i = 0; i < report->entry_count; i++)
        count += report->entries[i].zoom == zoom && report->entries[i].method == method;
    add_line(layout, method, count, &x, &y);
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        if (entry->zoom != zoom || entry->method != method) continue;
        const struct compare_means means = compare_means_of(entry, compare_tile_count(report, entry));
        x[at] = means.triangles;
        y[at++] = means.rms_error_m;
    }
}

enum scree_status compare_add_error_chart(const struct compare_report *report, struct scree_memory *memory,
                                          struct text *text, struct scree_error *error) {
    struct layout layout;
    enum scree_status status = layout_make(report, memory, &layout, error);
    if (status != SCREE_OK) return status;
    layout.sheet.title = "Vertical RMS error against triangles";
    layout.sheet.x_label = "triangles a tile";
    layout.sheet.y_label = "RMS error, m";
    layout.sheet.x_is_logarithmic = layout.sheet.y_is_logarithmic = true;
    for (uint32_t i = 0; i < report->entry_count; i++) {
        const struct compare_entry *entry = &report->entries[i];
        if (i > 0 && entry->zoom == entry[-1].zoom) continue;
        add_panel(&layout, entry, false);
        for (int method = 0; method < report->method_count; method++) add_trade(report, entry->zoom, method, &layout);
    }
    svg_chart_add(text, &layout.sheet);
    layout_free(memory, &layout);
    return SCREE_OK;
}
