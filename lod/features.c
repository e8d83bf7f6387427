#include "lod/features.h"

#include "lod/method_place.h"

#include <math.h>

/* The edges of a post lead in eight directions, counter-clockwise from the east; those of direction d come back in
 * direction d + 4. */
enum { DIRECTIONS = 8, BACK = 4 };
static const int32_t step_x[DIRECTIONS] = {1, 1, 0, -1, -1, -1, 0, 1};
static const int32_t step_y[DIRECTIONS] = {0, 1, 1, 1, 0, -1, -1, -1};

/* The two planes of a cell; `rising`: its diagonal leads from the south-western to the north-eastern post. The first
 * plane is the one with the southern side. */
struct cell {
    struct vector3 normal[2];
    bool rising;
};

struct search {
    const struct method_tile *tile;
    double scale_x, scale_y, scale_z; /* of metres, before angles are measured */
    double least_cosine;              /* of an angle that is not sharp */
    struct cell *cells[2];            /* a row, and the one to its south */
    uint8_t *edges;                   /* one a post: bit d, a sharp edge leads in direction d */
    uint8_t *ends;                    /* one a post: lines end here */
};

static size_t post_index(const struct search *search, int32_t column, int32_t row) {
    return (size_t)row * (size_t)(search->tile->columns + 1) + (size_t)column;
}

/* ---- sharp edges ---- */

static struct vector3 cross(struct vector3 a, struct vector3 b) {
    return (struct vector3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static struct vector3 unit_normal(struct vector3 a, struct vector3 b, struct vector3 c) {
    struct vector3 normal = cross(vector3_minus(b, a), vector3_minus(c, a));
    double length = sqrt(vector3_dot(normal, normal));
    return (struct vector3){normal.x / length, normal.y / length, normal.z / length};
}

static struct vector3 scaled_place(const struct search *search, int32_t column, int32_t row) {
    struct vector3 place = method_post_place_m(search->tile, column, row);
    return (struct vector3){place.x * search->scale_x, place.y * search->scale_y, place.z * search->scale_z};
}

/* How much the terrain bends in a diagonal's direction: at the better of its ends, as a crest may begin at a summit.
 * Ends on the border do not count. */
static double bend_m(const struct method_tile *tile, int32_t column, int32_t row, int32_t step) {
    int32_t end_column = column + step, end_row = row + 1, before = column - step, after = end_column + step;
    double start_m = (double)method_post_m(tile, column, row), least_m = INFINITY;
    double end_m = (double)method_post_m(tile, end_column, end_row);
    if (row > 0 && before >= 0 && before <= tile->columns)
        least_m = fabs((double)method_post_m(tile, before, row - 1) - 2 * start_m + end_m);
    if (end_row < tile->rows && after >= 0 && after <= tile->columns)
        least_m = fmin(least_m, fabs(start_m - 2 * end_m + (double)method_post_m(tile, after, end_row + 1)));
    return least_m;
}

static void make_row(const struct search *search, int32_t row, struct cell *cells) {
    for (int32_t column = 0; column < search->tile->columns; column++) {
        struct cell *cell = &cells[column];
        struct vector3 sw = scaled_place(search, column, row), se = scaled_place(search, column + 1, row);
        struct vector3 nw = scaled_place(search, column, row + 1), ne = scaled_place(search, column + 1, row + 1);
        cell->rising = bend_m(search->tile, column, row, 1) <= bend_m(search->tile, column + 1, row, -1);
        cell->normal[0] = cell->rising ? unit_normal(sw, se, ne) : unit_normal(sw, se, nw);
        cell->normal[1] = cell->rising ? unit_normal(sw, ne, nw) : unit_normal(se, ne, nw);
    }
}

/* Whether a line may come to a post: on the border only where the border line keeps a vertex. */
static bool may_end_at(const struct search *search, int32_t column, int32_t row, bool *on_border) {
    const struct method_tile *tile = search->tile;
    bool on_column = column == 0 || column == tile->columns, on_row = row == 0 || row == tile->rows;
    *on_border = on_column || on_row;
    if (on_column && on_row) return true;
    if (on_column) return border_keeps(tile->lines[column == 0 ? SIDE_WEST : SIDE_EAST], row * tile->cell_span);
    if (on_row) return border_keeps(tile->lines[row == 0 ? SIDE_SOUTH : SIDE_NORTH], column * tile->cell_span);
    return true;
}

/* Marks the edge that leads from a post in a direction if its two planes make a sharp angle. */
static void judge_edge(struct search *search, int32_t column, int32_t row, int direction,
                       const struct vector3 normals[2]) {
    int32_t end_column = column + step_x[direction], end_row = row + step_y[direction];
    bool on_border, end_on_border;
    if (vector3_dot(normals[0], normals[1]) >= search->least_cosine) return;
    if (!may_end_at(search, column, row, &on_border) || !may_end_at(search, end_column, end_row, &end_on_border))
        return;
    if (on_border && end_on_border) return;
    search->edges[post_index(search, column, row)] |= (uint8_t)(1u << direction);
    search->edges[post_index(search, end_column, end_row)] |= (uint8_t)(1u << (direction + BACK) % DIRECTIONS);
}

/* The plane of a cell that has its western or its eastern side. */
static struct vector3 western(const struct cell *cell) {
    return cell->normal[cell->rising ? 1 : 0];
}
static struct vector3 eastern(const struct cell *cell) {
    return cell->normal[cell->rising ? 0 : 1];
}

static void mark_sharp_edges(struct search *search) {
    const struct method_tile *tile = search->tile;
    for (int32_t row = 0; row < tile->rows; row++) {
        struct cell *here = search->cells[row % 2];
        const struct cell *south = search->cells[1 - row % 2];
        make_row(search, row, here);
        for (int32_t column = 0; column < tile->columns; column++) {
            if (here[column].rising)
                judge_edge(search, column, row, 1, here[column].normal);
            else
                judge_edge(search, column + 1, row, 3, here[column].normal);
            if (row > 0)
                judge_edge(search, column, row, 0,
                           (const struct vector3[2]){south[column].normal[1], here[column].normal[0]});
            if (column > 0)
                judge_edge(search, column, row, 2,
                           (const struct vector3[2]){eastern(&here[column - 1]), western(&here[column])});
        }
    }
}

static void mark_ends(struct search *search) {
    for (int32_t row = 0; row <= search->tile->rows; row++)
        for (int32_t column = 0; column <= search->tile->columns; column++) {
            size_t post = post_index(search, column, row);
            bool on_border;
            int degree = 0;
            for (int d = 0; d < DIRECTIONS; d++) degree += search->edges[post] >> d & 1;
            may_end_at(search, column, row, &on_border);
            search->ends[post] = on_border || degree != 2;
        }
}

/* ---- lines ---- */

/* Follows the edges from a post, which are taken away, to an end or round to the start. `posts` has room for them. */
static uint32_t trace(struct search *search, struct feature_post at, int direction, struct feature_post *posts) {
    uint32_t count = 0;
    posts[count++] = at;
    while (direction < DIRECTIONS) {
        search->edges[post_index(search, at.column, at.row)] &= (uint8_t) ~(1u << direction);
        at.column += step_x[direction];
        at.row += step_y[direction];
        size_t post = post_index(search, at.column, at.row);
        search->edges[post] &= (uint8_t) ~(1u << (direction + BACK) % DIRECTIONS);
        posts[count++] = at;
        if (search->ends[post]) break;
        for (direction = 0; direction < DIRECTIONS && (search->edges[post] >> direction & 1) == 0;) direction++;
    }
    return count;
}

/* Traces the lines that begin at ends, or those that are left: closed ones. */
static void trace_from(struct search *search, bool ends, uint32_t least_edges, struct feature_lines *lines) {
    for (int32_t row = 0; row <= search->tile->rows; row++)
        for (int32_t column = 0; column <= search->tile->columns; column++) {
            size_t post = post_index(search, column, row);
            if ((search->ends[post] != 0) != ends) continue;
            for (int d = 0; d < DIRECTIONS; d++) {
                if ((search->edges[post] >> d & 1) == 0) continue;
                uint32_t start = lines->starts[lines->line_count];
                uint32_t count = trace(search, (struct feature_post){column, row}, d, lines->posts + start);
                if (count > least_edges) lines->starts[++lines->line_count] = start + count;
            }
        }
}

/* Every edge is traced once, and a line has one post more than edges. */
static enum scree_status make_lines(struct search *search, struct scree_memory *memory, uint32_t least_edges,
                                    struct feature_lines *lines, struct scree_error *error) {
    size_t posts = post_index(search, search->tile->columns, search->tile->rows) + 1, halves = 0;
    for (size_t post = 0; post < posts; post++)
        for (int d = 0; d < DIRECTIONS; d++) halves += search->edges[post] >> d & 1;
    lines->starts = scree_allocate(memory, halves / 2 + 1, sizeof *lines->starts, "feature lines", error);
    lines->posts = scree_allocate(memory, halves, sizeof *lines->posts, "feature lines", error);
    if (lines->starts == NULL || lines->posts == NULL) {
        feature_lines_release(memory, lines);
        return SCREE_E_MEMORY;
    }
    trace_from(search, true, least_edges, lines);
    trace_from(search, false, least_edges, lines);
    return SCREE_OK;
}

/* ---- the whole ---- */

static void set_scale(struct search *search, bool in_unit_cube) {
    const struct method_tile *tile = search->tile;
    double low_m = INFINITY, high_m = -INFINITY;
    search->scale_x = search->scale_y = search->scale_z = 1;
    if (!in_unit_cube) return;
    for (int32_t row = 0; row <= tile->rows; row++)
        for (int32_t column = 0; column <= tile->columns; column++) {
            double height_m = (double)method_post_m(tile, column, row);
            low_m = fmin(low_m, height_m);
            high_m = fmax(high_m, height_m);
        }
    search->scale_x = 1 / (method_width(tile) * tile->east_m);
    search->scale_y = 1 / (method_height(tile) * tile->north_m);
    search->scale_z = high_m > low_m ? 1 / (high_m - low_m) : 1;
}

enum scree_status features_find(struct scree_memory *memory, const struct method_tile *tile,
                                const struct feature_options *options, struct feature_lines *lines,
                                struct scree_error *error) {
    double angle_deg = options->angle_deg != 0 ? options->angle_deg : FEATURE_ANGLE_DEG, sine;
    int32_t least_edges = options->least_edges != 0 ? options->least_edges : FEATURE_EDGES;
    struct search search = {.tile = tile};
    enum scree_status status = SCREE_E_MEMORY;
    *lines = (struct feature_lines){0};
    if (!(angle_deg > 0 && angle_deg <= 180) || least_edges < 1)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "features: an angle of %g degrees and lines of %d edges; it takes 0 to 180, and 1 or more",
                          angle_deg, (int)least_edges);
    sine_cosine_deg(angle_deg, &sine, &search.least_cosine);
    set_scale(&search, options->in_unit_cube);
    size_t posts = post_index(&search, tile->columns, tile->rows) + 1, cells = (size_t)tile->columns;
    search.edges = scree_allocate(memory, posts, 1, "sharp edges", error);
    search.ends = scree_allocate(memory, posts, 1, "ends of sharp edges", error);
    for (int i = 0; i < 2; i++) search.cells[i] = scree_allocate(memory, cells, sizeof **search.cells, "planes", error);
    if (search.edges == NULL || search.ends == NULL || search.cells[0] == NULL || search.cells[1] == NULL) goto cleanup;
    mark_sharp_edges(&search);
    mark_ends(&search);
    status = make_lines(&search, memory, (uint32_t)least_edges, lines, error);
cleanup:
    scree_release(memory, search.cells[1]);
    scree_release(memory, search.cells[0]);
    scree_release(memory, search.ends);
    scree_release(memory, search.edges);
    return status;
}

void feature_lines_release(struct scree_memory *memory, struct feature_lines *lines) {
    scree_release(memory, lines->posts);
    scree_release(memory, lines->starts);
    *lines = (struct feature_lines){0};
}
