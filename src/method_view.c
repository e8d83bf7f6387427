#include "src/method_view.h"

#include <math.h>

/* Post `index` of those at equal distances, as a post of the tile and the way on to the next one. */
static int32_t post_before(int32_t index, int32_t count, int32_t length, int32_t span, double *share) {
    double position = (double)index * length / count;
    int32_t before = (int32_t)(position / span);
    if (before > count - 1) before = count - 1;
    double next = fmin((before + 1.0) * span, length);
    *share = (position - (double)before * span) / (next - (double)before * span);
    return before;
}

static enum scree_status stretch_posts(const struct post_tile *tile, struct method_view *view,
                                       struct scree_error *error) {
    int32_t across = tile->columns + 1;
    view->stretched_m = scree_allocate(tile->memory, (size_t)across * (size_t)(tile->rows + 1),
                                       sizeof *view->stretched_m, "posts at the end of the lattice", error);
    if (view->stretched_m == NULL) return SCREE_E_MEMORY;
    for (int32_t row = 0; row <= tile->rows; row++)
        for (int32_t column = 0; column <= tile->columns; column++) {
            double right, up;
            int32_t x = post_before(column, tile->columns, tile->width, tile->cell_span, &right);
            int32_t y = post_before(row, tile->rows, tile->height, tile->cell_span, &up);
            const float *low = tile->heights_m + (int64_t)y * across + x, *high = low + across;
            double south_m = low[0] + right * (low[1] - low[0]), north_m = high[0] + right * (high[1] - high[0]);
            view->stretched_m[(int64_t)row * across + column] = (float)(south_m + up * (north_m - south_m));
        }
    return SCREE_OK;
}

/* Positions grow by a factor of at least 1, so those of different vertices stay apart. */
static enum scree_status stretch_lines(const struct post_tile *tile, struct method_view *view,
                                       struct scree_error *error) {
    view->border = scree_allocate(tile->memory, SIDE_COUNT, sizeof *view->border, "a tile's border", error);
    if (view->border == NULL) return SCREE_E_MEMORY;
    for (int side = 0; side < SIDE_COUNT; side++) {
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
        double whole = (double)(horizontal ? tile->columns : tile->rows) * tile->cell_span;
        double factor = whole / (horizontal ? tile->width : tile->height);
        struct border_line *line = &view->border[side];
        *line = tile->lines[side];
        for (int32_t v = 0; v < line->vertex_count; v++)
            line->vertices[v].position = (int32_t)floor(line->vertices[v].position * factor + 0.5);
        line->curvature_m /= factor * factor;
        view->tile.lines[side] = line;
    }
    return SCREE_OK;
}

enum scree_status method_view_make(const struct tile_plan *plan, struct tile_id id, const struct post_tile *tile,
                                   struct method_view *view, struct scree_error *error) {
    struct lattice_window window = lattice_tile_window(plan->lattice, id);
    double middle = (double)window.y + 0.5 * window.rows;
    double stretch_x = (double)tile->columns * tile->cell_span / tile->width;
    double stretch_y = (double)tile->rows * tile->cell_span / tile->height;
    *view = (struct method_view){.tile = {.columns = tile->columns,
                                          .rows = tile->rows,
                                          .cell_span = tile->cell_span,
                                          .heights_m = tile->heights_m,
                                          .stride = tile->columns + 1},
                                 .frame = {.span = lattice_tile_span(plan->lattice, id.zoom),
                                           .width = tile->width,
                                           .height = tile->height,
                                           .height_unit_m = plan->ladder->height_unit_m}};
    lattice_steps_m(plan->lattice, middle, &view->tile.east_m, &view->tile.north_m);
    view->tile.east_m /= stretch_x;
    view->tile.north_m /= stretch_y;
    if (plan->lattice->profile == PROFILE_GEODETIC) {
        view->tile.east_drop_m = lattice_parallel_drop_m(plan->lattice, middle) / (stretch_x * stretch_x);
        view->tile.north_drop_m = lattice_meridian_drop_m(plan->lattice) / (stretch_y * stretch_y);
    }
    for (int side = 0; side < SIDE_COUNT; side++) view->tile.lines[side] = view->frame.lines[side] = &tile->lines[side];
    if (stretch_x == 1 && stretch_y == 1) return SCREE_OK;
    enum scree_status status = stretch_posts(tile, view, error);
    if (status != SCREE_OK) return status;
    view->tile.heights_m = view->stretched_m;
    return stretch_lines(tile, view, error);
}

void method_view_release(struct scree_memory *memory, struct method_view *view) {
    scree_release(memory, view->border);
    scree_release(memory, view->stretched_m);
    view->border = NULL;
    view->stretched_m = NULL;
}
