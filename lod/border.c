#include "lod/border.h"

#include "lod/position_code.h"

#include <math.h>
#include <string.h>

#define NEVER INFINITY

enum tile_side border_side(int32_t columns, int32_t rows, const struct sample *at, int32_t *position) {
    bool on_column = at->x == 0 || at->x == columns, on_row = at->y == 0 || at->y == rows;
    if (on_column == on_row) return SIDE_COUNT;
    *position = on_column ? at->y : at->x;
    if (on_column) return at->x == 0 ? SIDE_WEST : SIDE_EAST;
    return at->y == 0 ? SIDE_SOUTH : SIDE_NORTH;
}

/* A line while vertices leave it: links between the kept ones and the cost of each. */
struct work {
    int32_t previous[BORDER_MAX_VERTICES], next[BORDER_MAX_VERTICES];
    int32_t first_sample[BORDER_MAX_VERTICES]; /* the first sample beyond the vertex */
    double cost_m[BORDER_MAX_VERTICES];
};

/* The largest distance of a sample from the chord between vertices a and c. */
static double chord_error_m(const struct border_line *line, const struct work *work, int32_t a, int32_t c) {
    const struct border_sample *from = &line->vertices[a], *to = &line->vertices[c];
    double slope = ((double)to->height_m - from->height_m) / (to->position - from->position), largest_m = 0;
    for (int32_t s = work->first_sample[a]; s < line->sample_count && line->samples[s].position < to->position; s++) {
        double before = line->samples[s].position - from->position, after = to->position - line->samples[s].position;
        double above_chord_m = line->samples[s].height_m - (from->height_m + slope * before);
        double distance_m = fabs(above_chord_m + line->curvature_m * before * after);
        if (distance_m > largest_m) largest_m = distance_m;
    }
    return largest_m;
}

static void price(const struct border_line *line, struct work *work, int32_t vertex, int64_t locked_step) {
    bool locked = locked_step > 0 && line->vertices[vertex].position % locked_step == 0;
    bool end = vertex == 0 || vertex == line->vertex_count - 1;
    work->cost_m[vertex] =
        locked || end ? NEVER : chord_error_m(line, work, work->previous[vertex], work->next[vertex]);
}

/* Of two vertices of equal cost the finer one leaves first. */
static bool finer(int32_t position, int32_t other) {
    int32_t lowest = position & -position, other_lowest = other & -other;
    return lowest != other_lowest ? lowest < other_lowest : position < other;
}

static int32_t cheapest(const struct border_line *line, const struct work *work) {
    int32_t best = 0;
    for (int32_t v = work->next[0]; v < line->vertex_count - 1; v = work->next[v])
        if (work->cost_m[v] < work->cost_m[best] || (work->cost_m[v] == work->cost_m[best] && best != 0 &&
                                                     finer(line->vertices[v].position, line->vertices[best].position)))
            best = v;
    return best;
}

void border_reduce(struct border_line *line, double tolerance_m, int64_t locked_step) {
    struct work work;
    int32_t last = line->vertex_count - 1, sample = 0;
    if (last < 2) return;
    work.cost_m[0] = NEVER;
    work.next[0] = 1;
    for (int32_t v = 0; v <= last; v++) {
        work.previous[v] = v - 1;
        work.next[v] = v + 1;
        while (sample < line->sample_count && line->samples[sample].position <= line->vertices[v].position) sample++;
        work.first_sample[v] = sample;
    }
    for (int32_t v = 0; v <= last; v++) price(line, &work, v, locked_step);
    for (int32_t v = cheapest(line, &work); work.cost_m[v] <= tolerance_m; v = cheapest(line, &work)) {
        int32_t a = work.previous[v], c = work.next[v];
        work.next[a] = c;
        work.previous[c] = a;
        if (a > 0) price(line, &work, a, locked_step);
        if (c < last) price(line, &work, c, locked_step);
    }
    int32_t kept = 0;
    for (int32_t v = 0; v <= last; v = work.next[v]) line->vertices[kept++] = line->vertices[v];
    line->vertex_count = kept;
}

void border_separate_codes(struct border_line *line, int64_t code_span, int32_t offset) {
    if (code_span <= POSITION_TOP) return;
    int32_t kept = 1, last = line->vertex_count - 1;
    int32_t last_code = position_code((int64_t)line->vertices[last].position + offset, code_span);
    int32_t before = position_code((int64_t)line->vertices[0].position + offset, code_span);
    for (int32_t v = 1; v < last; v++) {
        int32_t code = position_code((int64_t)line->vertices[v].position + offset, code_span);
        if (code == before || code == last_code) continue;
        before = code;
        line->vertices[kept++] = line->vertices[v];
    }
    line->vertices[kept++] = line->vertices[last];
    line->vertex_count = kept;
}

int32_t border_before(const struct border_line *line, int32_t position) {
    int32_t low = 0, high = line->vertex_count - 1;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (line->vertices[middle].position <= position)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

bool border_keeps(const struct border_line *line, int32_t position) {
    return line->vertices[border_before(line, position)].position == position;
}

/* Adds the extremes of the samples of one line to those of the closed cells. */
static void gather_extremes(const struct border_line *line, int32_t offset, int32_t cell_span,
                            struct border_sample *lowest, struct border_sample *highest, int32_t cells) {
    for (int32_t s = 0; s < line->sample_count; s++) {
        struct border_sample sample = {line->samples[s].position + offset, line->samples[s].height_m};
        int32_t last_cell = sample.position / cell_span;
        int32_t first_cell = sample.position % cell_span == 0 ? last_cell - 1 : last_cell;
        for (int32_t cell = first_cell < 0 ? 0 : first_cell; cell <= last_cell && cell < cells; cell++) {
            if (lowest[cell].position < 0 || sample.height_m < lowest[cell].height_m) lowest[cell] = sample;
            if (highest[cell].position < 0 || sample.height_m > highest[cell].height_m) highest[cell] = sample;
        }
    }
}

/* All samples of two lines; the joint is the last of the first one and the first of the second. False: too many. */
static bool join_samples(const struct border_line *const lines[2], const int32_t offsets[2], struct border_line *line) {
    int32_t count = lines[0]->sample_count + (lines[1] != NULL ? lines[1]->sample_count : 0);
    if (count > BORDER_MAX_SAMPLES) return false;
    for (int i = 0; i < 2 && lines[i] != NULL; i++)
        for (int32_t s = 0; s < lines[i]->sample_count; s++) {
            struct border_sample sample = {lines[i]->samples[s].position + offsets[i], lines[i]->samples[s].height_m};
            bool is_joint =
                i == 1 && line->sample_count > 0 && line->samples[line->sample_count - 1].position == sample.position;
            if (!is_joint) line->samples[line->sample_count++] = sample;
        }
    return true;
}

bool border_join(const struct border_line *first, const struct border_line *second, int32_t joint, int32_t cell_span,
                 bool keeps_samples, struct border_line *line) {
    struct border_sample lowest[BORDER_MAX_SAMPLES / 2], highest[BORDER_MAX_SAMPLES / 2];
    const struct border_line *lines[2] = {first, second};
    int32_t offsets[2] = {0, joint}, end = 0;
    line->vertex_count = line->sample_count = 0;
    for (int i = 0; i < 2; i++) {
        if (lines[i] == NULL) continue;
        line->curvature_m = lines[i]->curvature_m;
        int32_t common = line->vertex_count > 0; /* the joint is the first of the second line as well */
        if (line->vertex_count - common + lines[i]->vertex_count > BORDER_MAX_VERTICES) return false;
        for (int32_t v = common; v < lines[i]->vertex_count; v++)
            line->vertices[line->vertex_count++] =
                (struct border_sample){lines[i]->vertices[v].position + offsets[i], lines[i]->vertices[v].height_m};
        end = line->vertices[line->vertex_count - 1].position;
    }
    if (keeps_samples && join_samples(lines, offsets, line)) return true;
    int32_t cells = (end + cell_span - 1) / cell_span;
    for (int32_t cell = 0; cell < cells; cell++) lowest[cell].position = highest[cell].position = -1;
    for (int i = 0; i < 2; i++)
        if (lines[i] != NULL) gather_extremes(lines[i], offsets[i], cell_span, lowest, highest, cells);
    for (int32_t cell = 0; cell < cells; cell++) {
        if (lowest[cell].position < 0) continue; /* a level tile may have wider samples */
        bool low_first = lowest[cell].position <= highest[cell].position;
        line->samples[line->sample_count++] = low_first ? lowest[cell] : highest[cell];
        if (lowest[cell].position != highest[cell].position)
            line->samples[line->sample_count++] = low_first ? highest[cell] : lowest[cell];
    }
    return true;
}
