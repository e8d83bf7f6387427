#include "lod/tile_lines.h"

#include <math.h>

void tile_line_start(struct border_line *line, int32_t length, int32_t step, double curvature_m, double height_unit_m,
                     const float *heights_m, int32_t stride) {
    line->curvature_m = curvature_m;
    line->vertex_count = line->sample_count = length / step + 1;
    for (int32_t i = 0; i < line->vertex_count; i++) {
        float height_m = heights_m[(int64_t)i * stride];
        int32_t units = (int32_t)lround((double)height_m / height_unit_m);
        line->samples[i] = (struct border_sample){i * step, height_m};
        line->vertices[i] = (struct border_sample){i * step, (float)(units * height_unit_m)};
    }
}

enum scree_status tile_lines_join(const struct border_line *const children[4], int32_t child_span, int32_t cell_span,
                                  bool keeps_samples, const double side_drop_m[SIDE_COUNT],
                                  struct border_line lines[SIDE_COUNT], struct scree_error *error) {
    static const struct {
        enum tile_side side;
        int first, second;           /* children along the line */
        int first_else, second_else; /* where the window ends before them */
    } joins[SIDE_COUNT] = {
        {SIDE_SOUTH, 0, 1, 0, 1}, {SIDE_EAST, 1, 3, 0, 2}, {SIDE_NORTH, 2, 3, 0, 1}, {SIDE_WEST, 0, 2, 0, 2}};
    for (int i = 0; i < SIDE_COUNT; i++) {
        bool outer = children[joins[i].first] != NULL;
        const struct border_line *first = children[outer ? joins[i].first : joins[i].first_else];
        const struct border_line *second = children[outer ? joins[i].second : joins[i].second_else];
        enum tile_side side = joins[i].side;
        if (!border_join(&first[side], second != NULL ? &second[side] : NULL, child_span, cell_span, keeps_samples,
                         &lines[side]))
            return scree_fail(error, SCREE_E_LIMIT,
                              "the tolerance is too small for so coarse a zoom: a tile's border keeps more than %d "
                              "vertices; raise --error or --error-at, or start at a higher --min-zoom",
                              BORDER_MAX_VERTICES);
        lines[side].curvature_m = side_drop_m[side];
    }
    return SCREE_OK;
}

void tile_lines_reduce(struct border_line lines[SIDE_COUNT], double tolerance_m, int64_t locked_step,
                       const struct code_frame *codes) {
    for (int side = 0; side < SIDE_COUNT; side++) {
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
        border_reduce(&lines[side], BORDER_SHARE * tolerance_m, locked_step);
        if (codes != NULL) border_separate_codes(&lines[side], codes->span, horizontal ? codes->x : codes->y);
    }
}
