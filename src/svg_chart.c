/* Line charts as SVG: see the header. */
#include "src/svg_chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* All lengths in pixels. */
#define PANEL_WIDE    520
#define PANEL_HIGH    360
#define MARGIN_LEFT   74
#define MARGIN_RIGHT  16
#define MARGIN_TOP    34
#define MARGIN_BOTTOM 52
#define HEAD_HIGH     40
#define LEGEND_ROW    22
#define LEGEND_COLUMN 150
#define MOST_MARKS    60 /* points of a line that are marked with a dot */

#define MOST_TICKS 40

/* Told apart by those who see few colours (Okabe and Ito 2008), and two more. */
static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000",
                                      "#56b4e9", "#e69f00", "#999999", "#8b4513", "#6a3d9a"};

#define COLOUR_COUNT ((int)(sizeof colours / sizeof *colours))

const char *svg_chart_colour(int name) {
    return colours[name % COLOUR_COUNT];
}

/* ---- axes ---- */

struct axis {
    bool is_logarithmic;
    double low, high; /* of the data, widened to what is drawn */
    double from_px, to_px;
    int tick_count;
    double ticks[MOST_TICKS];
};

static bool can_show(const struct axis *axis, double value) {
    return isfinite(value) && (!axis->is_logarithmic || value > 0);
}

static double place_px(const struct axis *axis, double value) {
    double share = axis->is_logarithmic ? log(value / axis->low) / log(axis->high / axis->low)
                                        : (value - axis->low) / (axis->high - axis->low);
    return axis->from_px + share * (axis->to_px - axis->from_px);
}

static void add_tick(struct axis *axis, double value) {
    if (axis->tick_count < MOST_TICKS) axis->ticks[axis->tick_count++] = value;
}

/* Steps of 1, 2 or 5 times a power of ten, about six of them; begins at 0 where the data are above it. */
static void lay_linear(struct axis *axis) {
    if (axis->low > 0) axis->low = 0;
    if (!(axis->high > axis->low)) axis->high = axis->low + 1;
    double rough = (axis->high - axis->low) / 6, power = pow(10, floor(log10(rough)));
    double step = rough / power <= 1   ? power
                  : rough / power <= 2 ? 2 * power
                  : rough / power <= 5 ? 5 * power
                                       : 10 * power;
    axis->low = floor(axis->low / step) * step;
    axis->high = ceil(axis->high / step) * step;
    for (int i = 0; axis->low + i * step <= axis->high * (1 + 1e-9); i++) add_tick(axis, axis->low + i * step);
}

/* Decades, with 2 and 5 in between where there are few. */
static void lay_logarithmic(struct axis *axis) {
    double widen = fmax(1.15, 2 / sqrt(axis->high / axis->low)); /* a factor of 4 at least, for two ticks */
    axis->low /= widen;
    axis->high *= widen;
    double first = floor(log10(axis->low)), last = ceil(log10(axis->high));
    static const double parts[] = {1, 2, 5};
    for (double decade = first; decade <= last; decade++)
        for (int i = 0; i < (last - first > 4 ? 1 : 3); i++) {
            double value = parts[i] * pow(10, decade);
            if (value >= axis->low && value <= axis->high) add_tick(axis, value);
        }
}

static struct axis make_axis(const struct chart_panel *panel, bool is_x, bool is_logarithmic, double from_px,
                             double to_px) {
    struct axis axis = {is_logarithmic, HUGE_VAL, -HUGE_VAL, from_px, to_px, 0, {0}};
    for (uint32_t i = 0; i < panel->line_count; i++)
        for (uint32_t k = 0; k < panel->lines[i].count; k++) {
            double value = is_x ? panel->lines[i].x[k] : panel->lines[i].y[k];
            if (!can_show(&axis, value)) continue;
            axis.low = fmin(axis.low, value);
            axis.high = fmax(axis.high, value);
        }
    if (axis.low > axis.high) axis.low = axis.high = 1;
    if (is_logarithmic)
        lay_logarithmic(&axis);
    else
        lay_linear(&axis);
    return axis;
}

/* ---- drawing ---- */

static void add_words(struct text *text, double x, double y, const char *anchor, const char *more, const char *words) {
    text_add(text, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, more);
    text_add_xml(text, words);
    text_add(text, "</text>\n");
}

static void add_axes(struct text *text, const struct axis *x, const struct axis *y) {
    char words[32];
    text_add(text, "<g stroke=\"#dddddd\">\n");
    for (int i = 0; i < x->tick_count; i++)
        text_add(text, "<path d=\"M%.1f %.1fV%.1f\"/>\n", place_px(x, x->ticks[i]), y->from_px, y->to_px);
    for (int i = 0; i < y->tick_count; i++)
        text_add(text, "<path d=\"M%.1f %.1fH%.1f\"/>\n", x->from_px, place_px(y, y->ticks[i]), x->to_px);
    text_add(text, "</g>\n");
    for (int i = 0; i < x->tick_count; i++) {
        snprintf(words, sizeof words, "%.6g", x->ticks[i]);
        add_words(text, place_px(x, x->ticks[i]), y->from_px + 16, "middle", "", words);
    }
    for (int i = 0; i < y->tick_count; i++) {
        snprintf(words, sizeof words, "%.6g", y->ticks[i]);
        add_words(text, x->from_px - 6, place_px(y, y->ticks[i]) + 4, "end", "", words);
    }
    text_add(text, "<path fill=\"none\" stroke=\"#444444\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", x->from_px, y->to_px,
             y->from_px, x->to_px);
}

static void add_line(struct text *text, const struct axis *x, const struct axis *y, const struct chart_line *line) {
    uint32_t shown = 0;
    text_add(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" d=\"", svg_chart_colour(line->name));
    for (uint32_t i = 0; i < line->count; i++)
        if (can_show(x, line->x[i]) && can_show(y, line->y[i]))
            text_add(text, "%s%.1f %.1f", shown++ == 0 ? "M" : "L", place_px(x, line->x[i]), place_px(y, line->y[i]));
    text_add(text, "%s\"/>\n", shown == 0 ? "M0 0" : "");
    if (line->count > MOST_MARKS) return;
    text_add(text, "<g fill=\"%s\">\n", svg_chart_colour(line->name));
    for (uint32_t i = 0; i < line->count; i++)
        if (can_show(x, line->x[i]) && can_show(y, line->y[i]))
            text_add(text, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\"/>\n", place_px(x, line->x[i]),
                     place_px(y, line->y[i]));
    text_add(text, "</g>\n");
}

static void add_panel(struct text *text, const struct chart_sheet *sheet, uint32_t at, uint32_t across) {
    const struct chart_panel *panel = &sheet->panels[at];
    double left = at % across * PANEL_WIDE, top = HEAD_HIGH + at / across * PANEL_HIGH;
    double right = left + PANEL_WIDE - MARGIN_RIGHT, bottom = top + PANEL_HIGH - MARGIN_BOTTOM;
    left += MARGIN_LEFT;
    top += MARGIN_TOP;
    struct axis x = make_axis(panel, true, sheet->x_is_logarithmic, left, right);
    struct axis y = make_axis(panel, false, sheet->y_is_logarithmic, bottom, top);
    char turned[64];
    double middle = (top + bottom) / 2, label_x = left - MARGIN_LEFT + 18;
    add_words(text, (left + right) / 2, top - 12, "middle", " font-weight=\"bold\"", panel->title);
    add_axes(text, &x, &y);
    add_words(text, (left + right) / 2, bottom + 38, "middle", "", sheet->x_label);
    snprintf(turned, sizeof turned, " transform=\"rotate(-90 %.1f %.1f)\"", label_x, middle);
    add_words(text, label_x, middle, "middle", turned, sheet->y_label);
    for (uint32_t i = 0; i < panel->line_count; i++) add_line(text, &x, &y, &panel->lines[i]);
}

void svg_chart_add(struct text *text, const struct chart_sheet *sheet) {
    uint32_t across = sheet->panel_count > 1 ? 2 : 1, down = (sheet->panel_count + across - 1) / across;
    int names_across = (int)across * PANEL_WIDE / LEGEND_COLUMN;
    int legend_rows = (sheet->name_count + names_across - 1) / names_across;
    int wide = (int)across * PANEL_WIDE, legend_top = HEAD_HIGH + (int)down * PANEL_HIGH;
    int high = legend_top + legend_rows * LEGEND_ROW + 8;
    text_add(text,
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
             "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
             wide, high, wide, high);
    add_words(text, wide / 2.0, 24, "middle", " font-size=\"16\"", sheet->title);
    for (uint32_t i = 0; i < sheet->panel_count; i++) add_panel(text, sheet, i, across);
    for (int i = 0; i < sheet->name_count; i++) {
        double x = 20 + i % names_across * LEGEND_COLUMN, y = legend_top + i / names_across * LEGEND_ROW + 12;
        text_add(text, "<path stroke=\"%s\" stroke-width=\"3\" d=\"M%.1f %.1fh24\"/>\n", svg_chart_colour(i), x, y - 4);
        add_words(text, x + 30, y, "start", "", sheet->names[i]);
    }
    text_add(text, "</svg>\n");
}
