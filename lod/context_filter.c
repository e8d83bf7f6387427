/* The heuristics of context-sensitive filtering: see the header. */
#include "lod/context_filter.h"

#include "lod/spline_filter.h"

#include <math.h>
#include <string.h>

#define MATTERS (GROUND_SHORE | GROUND_RAILWAY | GROUND_BRIDGE | GROUND_RAMP)

/* Bits of the map of neighbourhoods. */
enum { NEAR_IN_ROW = 1, NEAR = 2 };

struct context_options context_defaults(void) {
    return (struct context_options){.spline_steps = 3,
                                    .delta_m = 4,
                                    .least_m = 0.3,
                                    .thresholds_m = {[CONTEXT_NEAR] = {0, 0.1, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.4},
                                                     [CONTEXT_RAILWAY] = {0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1},
                                                     [CONTEXT_HILL] = {0, 0.1, 0.2, 0.2, 0.3, 0.4, 0.5, 0.5, 0.5},
                                                     [CONTEXT_FOREST] = {0, 0.1, 0.2, 0.2, 0.3, 20, 20, 20, 20}}};
}

const char *context_class_name(enum context_class which) {
    static const char *const names[CONTEXT_CLASSES] = {[CONTEXT_NEAR] = "near",
                                                       [CONTEXT_RAILWAY] = "railway",
                                                       [CONTEXT_HILL] = "hill",
                                                       [CONTEXT_FOREST] = "forest",
                                                       [CONTEXT_REST] = "rest"};
    return names[which];
}

/* ---- neighbourhoods ---- */

/* Water beside something else. */
static bool is_shore(const struct context_posts *posts, int32_t x, int32_t y) {
    const uint8_t *use = posts->uses + (size_t)y * (size_t)posts->columns + x;
    if (!(*use & GROUND_WATER)) return false;
    return (x > 0 && !(use[-1] & GROUND_WATER)) || (x + 1 < posts->columns && !(use[1] & GROUND_WATER)) ||
           (y > 0 && !(use[-(ptrdiff_t)posts->columns] & GROUND_WATER)) ||
           (y + 1 < posts->rows && !(use[posts->columns] & GROUND_WATER));
}

static bool matters(const struct context_posts *posts, int32_t x, int32_t y) {
    return posts->uses[(size_t)y * (size_t)posts->columns + x] & MATTERS || is_shore(posts, x, y);
}

/* Marks posts with something that matters in their row, no farther away than CONTEXT_NEAR_POSTS. */
static void mark_row(const struct context_posts *posts, int32_t y, uint8_t *near_row) {
    int32_t until = -1, from = 0; /* the next post to mark, and the last that is to be */
    for (int32_t x = 0; x < posts->columns; x++) {
        if (!matters(posts, x, y)) continue;
        const int32_t first = x - CONTEXT_NEAR_POSTS > from ? x - CONTEXT_NEAR_POSTS : from;
        until = x + CONTEXT_NEAR_POSTS < posts->columns ? x + CONTEXT_NEAR_POSTS : posts->columns - 1;
        for (from = first; from <= until; from++) near_row[from] = NEAR_IN_ROW;
    }
}

/* Marks posts with such a row no farther away; `marked` counts such rows by column. */
static void mark_columns(const struct context_posts *posts, uint8_t *near_posts, uint8_t *marked) {
    const int32_t columns = posts->columns, rows = posts->rows, reach = CONTEXT_NEAR_POSTS;
    for (int32_t y = -reach; y < rows; y++) {
        const uint8_t *enters = near_posts + (size_t)(y + reach < rows ? y + reach : 0) * (size_t)columns;
        const uint8_t *leaves = near_posts + (size_t)(y > reach ? y - reach - 1 : 0) * (size_t)columns;
        for (int32_t x = 0; x < columns && y + reach < rows; x++) marked[x] += enters[x] & NEAR_IN_ROW;
        for (int32_t x = 0; x < columns && y > reach; x++) marked[x] -= leaves[x] & NEAR_IN_ROW;
        uint8_t *row = near_posts + (size_t)(y > 0 ? y : 0) * (size_t)columns;
        for (int32_t x = 0; x < columns && y >= 0; x++)
            if (marked[x] > 0) row[x] |= NEAR;
    }
}

static enum scree_status mark_near(struct scree_memory *memory, const struct context_posts *posts, uint8_t **near_posts,
                                   struct scree_error *error) {
    const size_t columns = (size_t)posts->columns, count = columns * (size_t)posts->rows;
    uint8_t *marked = scree_allocate(memory, columns, 1, "neighbourhoods", error);
    *near_posts = scree_allocate(memory, count, 1, "neighbourhoods", error);
    const bool has_room = marked != NULL && *near_posts != NULL;
    for (int32_t y = 0; y < posts->rows && has_room; y++) mark_row(posts, y, *near_posts + (size_t)y * columns);
    if (has_room) mark_columns(posts, *near_posts, marked);
    scree_release(memory, marked);
    return has_room ? SCREE_OK : SCREE_E_MEMORY;
}

/* ---- heights ---- */

struct filter {
    const struct context_posts *posts;
    const struct context_options *options;
    uint8_t *near_posts; /* or NULL */
    struct haar_block *block;
    float *filtered_m; /* the spline's heights, until a block is done */
    struct context_counts *counts;
};

static enum context_class class_of(const struct filter *filter, size_t post, double away_m) {
    const uint8_t use = filter->near_posts != NULL ? filter->posts->uses[post] : 0;
    if (filter->near_posts != NULL && filter->near_posts[post] & NEAR)
        return use & GROUND_RAILWAY ? CONTEXT_RAILWAY : CONTEXT_NEAR;
    if (away_m <= filter->options->delta_m) return CONTEXT_REST;
    return use & GROUND_FOREST ? CONTEXT_FOREST : CONTEXT_HILL;
}

/* The block's heights; beyond the posts their border is repeated. */
static void load_block(const struct filter *filter, int32_t x, int32_t y) {
    const struct context_posts *posts = filter->posts;
    for (int32_t j = 0; j < HAAR_SIDE; j++) {
        const int32_t row = y + j < posts->rows ? y + j : posts->rows - 1;
        const float *from_m = posts->heights_m + (size_t)row * (size_t)posts->columns;
        double *to_m = filter->block->coefficients + (size_t)j * HAAR_SIDE;
        const int32_t inside = posts->columns - x < HAAR_SIDE ? posts->columns - x : HAAR_SIDE;
        for (int32_t i = 0; i < inside; i++) to_m[i] = from_m[x + i];
        for (int32_t i = inside; i < HAAR_SIDE; i++) to_m[i] = to_m[inside - 1];
    }
}

/* The height that a class gives to a post which differs from the spline; the block is transformed for the first. */
static float detailed_m(const struct filter *filter, int32_t x, int32_t y, size_t post, enum context_class class,
                        bool *is_transformed) {
    const float height_m = filter->posts->heights_m[post], spline_m = filter->filtered_m[post];
    if (filter->options->detail == CONTEXT_UNFILTERED) return height_m;
    if (!*is_transformed) {
        load_block(filter, x & -HAAR_SIDE, y & -HAAR_SIDE);
        haar_transform(filter->block);
        *is_transformed = true;
    }
    const double haar_m = haar_height_m(filter->block, x & (HAAR_SIDE - 1), y & (HAAR_SIDE - 1),
                                        filter->options->thresholds_m[class], filter->options->variant);
    return fabs(haar_m - spline_m) > filter->options->least_m ? (float)haar_m : spline_m;
}

static void filter_block(const struct filter *filter, int32_t west, int32_t south) {
    const struct context_posts *posts = filter->posts;
    const int32_t east = posts->columns - west < HAAR_SIDE ? posts->columns : west + HAAR_SIDE;
    const int32_t north = posts->rows - south < HAAR_SIDE ? posts->rows : south + HAAR_SIDE;
    bool is_transformed = false;
    for (int32_t y = south; y < north; y++)
        for (int32_t x = west; x < east; x++) {
            const size_t post = (size_t)y * (size_t)posts->columns + (size_t)x;
            const double away_m = fabs((double)posts->heights_m[post] - filter->filtered_m[post]);
            const enum context_class class = class_of(filter, post, away_m);
            filter->counts->posts[class]++;
            if (class == CONTEXT_REST || away_m <= filter->options->least_m) continue;
            const float before_m = filter->filtered_m[post];
            filter->filtered_m[post] = detailed_m(filter, x, y, post, class, &is_transformed);
            filter->counts->detailed += filter->filtered_m[post] != before_m;
        }
}

/* ---- water ---- */

struct water {
    double sum_m;
    uint64_t posts;
};

static enum scree_status level_waters(struct scree_memory *memory, const struct context_posts *posts, float *filtered_m,
                                      struct context_counts *counts, struct scree_error *error) {
    const size_t count = (size_t)posts->columns * (size_t)posts->rows;
    struct water *waters = scree_allocate(memory, (size_t)posts->water_count + 1, sizeof *waters, "the waters", error);
    if (waters == NULL) return SCREE_E_MEMORY;
    for (size_t post = 0; post < count; post++) {
        struct water *water = &waters[posts->waters[post]];
        water->sum_m += posts->heights_m[post];
        water->posts++;
    }
    for (size_t post = 0; post < count; post++) {
        const struct water *water = &waters[posts->waters[post]];
        if (water == waters) continue;
        filtered_m[post] = (float)(water->sum_m / (double)water->posts);
        counts->levelled++;
    }
    scree_release(memory, waters);
    return SCREE_OK;
}

static enum scree_status check_waters(const struct context_posts *posts, struct scree_error *error) {
    const size_t count = (size_t)posts->columns * (size_t)posts->rows;
    for (size_t post = 0; post < count; post++)
        if (posts->waters[post] > posts->water_count)
            return scree_fail(error, SCREE_E_ARGUMENT, "there are %u waters, and no water %u",
                              (unsigned)posts->water_count, (unsigned)posts->waters[post]);
    return SCREE_OK;
}

static enum scree_status add_detail(struct scree_memory *memory, struct filter *filter, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    if (filter->posts->uses != NULL) status = mark_near(memory, filter->posts, &filter->near_posts, error);
    filter->block = scree_allocate(memory, 1, sizeof *filter->block, "a block of coefficients", error);
    if (filter->block == NULL) status = SCREE_E_MEMORY;
    for (int32_t y = 0; y < filter->posts->rows && status == SCREE_OK; y += HAAR_SIDE)
        for (int32_t x = 0; x < filter->posts->columns; x += HAAR_SIDE) filter_block(filter, x, y);
    scree_release(memory, filter->block);
    scree_release(memory, filter->near_posts);
    return status;
}

enum scree_status context_filter(struct scree_memory *memory, const struct context_posts *posts,
                                 const struct context_options *options, float *filtered_m,
                                 struct context_counts *counts, struct scree_error *error) {
    struct spline spline;
    struct filter filter = {.posts = posts, .options = options, .filtered_m = filtered_m, .counts = counts};
    *counts = (struct context_counts){0};
    enum scree_status status = posts->waters != NULL ? check_waters(posts, error) : SCREE_OK;
    if (status == SCREE_OK)
        status =
            spline_make(memory, posts->heights_m, posts->columns, posts->rows, options->spline_steps, &spline, error);
    if (status != SCREE_OK) return status;
    for (int32_t y = 0; y < posts->rows; y++)
        spline_row(&spline, y, posts->columns, filtered_m + (size_t)y * (size_t)posts->columns);
    spline_release(memory, &spline);
    if (options->detail != CONTEXT_NONE) status = add_detail(memory, &filter, error);
    if (status == SCREE_OK && posts->waters != NULL) status = level_waters(memory, posts, filtered_m, counts, error);
    return status;
}
