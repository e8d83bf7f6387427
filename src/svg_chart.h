/* Line charts as SVG: a sheet of panels with one legend. Pure. */
#ifndef SCREE_SVG_CHART_H
#define SCREE_SVG_CHART_H

#include "src/text.h"
#include <stdint.h>

struct chart_line {
    int name; /* of the sheet's; says the colour as well */
    uint32_t count;
    const double *x, *y; /* points that are not finite, or not above 0 on a logarithmic axis, are left out */
};

struct chart_panel {
    const char *title;
    uint32_t line_count;
    const struct chart_line *lines;
};

struct chart_sheet {
    const char *title, *x_label, *y_label;
    bool x_is_logarithmic, y_is_logarithmic;
    int name_count;
    const char *const *names; /* what the legend tells */
    uint32_t panel_count;
    const struct chart_panel *panels; /* each has axes of its own */
};

/* Adds the whole SVG document. */
void svg_chart_add(struct text *text, const struct chart_sheet *sheet);

/* The colour of a name of a sheet, as in "#0072b2". */
const char *svg_chart_colour(int name);

#endif
