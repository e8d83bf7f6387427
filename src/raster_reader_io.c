/* Reads windows of posts through a cache of square blocks that are aligned to the lattice: a post's height is always
 * computed as a part of the same block, so it does not depend on the window that it was asked in. */
#include "src/raster_parts_io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 128,         /* posts of a block */
    SHIFT = 1,          /* block 0 begins one post before the lattice, as tiles with a margin do */
    MAX_BLOCKS = 160,   /* of 64 KB; a tile with its margin touches 9 */
    MAX_DISTANCE = 2048 /* of filling: bounds the region that a block needs */
};

struct block {
    int64_t x, y; /* in blocks */
    uint64_t used;
    bool has_voids, is_filled;
    float *heights_m; /* NaN for void */
    float *filled_m;  /* only if it has voids and was asked for */
};

struct raster_reader {
    const struct raster *raster;
    struct raster_field *field;
    struct raster_field *enclosed; /* NULL: no input has voids */
    uint64_t clock;
    int block_count;
    struct block blocks[MAX_BLOCKS];
    float *region_m;
};

enum scree_status raster_reader_new(const struct raster *raster, struct raster_reader **result,
                                    struct scree_error *error) {
    if (!raster->is_placed) return scree_fail(error, SCREE_E_ARGUMENT, "the raster has not been placed on a lattice");
    struct raster_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for a reader");
    reader->raster = raster;
    enum scree_status status = raster_field_new(raster, &raster->placement, false, &reader->field, error);
    if (status == SCREE_OK && raster->has_enclosed)
        status = raster_field_new(raster, &raster->placement, true, &reader->enclosed, error);
    if (status != SCREE_OK) {
        raster_reader_free(reader);
        return status;
    }
    *result = reader;
    return SCREE_OK;
}

void raster_reader_free(struct raster_reader *reader) {
    if (reader == NULL) return;
    raster_field_free(reader->enclosed);
    raster_field_free(reader->field);
    for (int i = 0; i < reader->block_count; i++) {
        free(reader->blocks[i].heights_m);
        free(reader->blocks[i].filled_m);
    }
    free(reader->region_m);
    free(reader);
}

/* A pole is one point, so its row has one height. Data that do not go around it keep theirs: beyond them there are
 * tiles that no reader is asked for, with the height of what lies outside. */
static void level_pole(const struct raster_reader *reader, const struct block *block, int64_t post_row, float pole_m,
                       float *heights_m) {
    const struct raster_placement *placement = &reader->raster->placement;
    int64_t row = post_row - (block->y * SIDE - SHIFT);
    if (row < 0 || row >= SIDE || post_row < placement->y || post_row >= placement->y + placement->rows) return;
    for (int i = 0; i < SIDE; i++) heights_m[row * SIDE + i] = pole_m;
}

static void level_poles(const struct raster_reader *reader, const struct block *block, float nodata_m,
                        float *heights_m) {
    const struct lattice *lattice = &reader->raster->placement.lattice;
    bool is_around = reader->raster->placement.columns >= lattice->columns - 1;
    if (lattice->profile != PROFILE_GEODETIC || !is_around) return;
    const float *pole_m = reader->raster->pole_m;
    level_pole(reader, block, 0, isnan(pole_m[0]) ? nodata_m : pole_m[0], heights_m);
    level_pole(reader, block, lattice->rows - 1, isnan(pole_m[1]) ? nodata_m : pole_m[1], heights_m);
}

static enum scree_status load(struct raster_reader *reader, struct block *block, struct scree_error *error) {
    enum scree_status status = raster_field_read(reader->field, block->x * SIDE - SHIFT, block->y * SIDE - SHIFT, SIDE,
                                                 SIDE, block->heights_m, error);
    if (status != SCREE_OK) return status;
    level_poles(reader, block, NAN, block->heights_m);
    /* Voids count inside of the lattice only: nobody asks for what lies beyond. */
    const struct lattice *lattice = &reader->raster->placement.lattice;
    int64_t columns = lattice->columns + SHIFT - block->x * SIDE, rows = lattice->rows + SHIFT - block->y * SIDE;
    if (lattice->profile == PROFILE_GEODETIC || columns > SIDE) columns = SIDE;
    if (rows > SIDE) rows = SIDE;
    int voids = 0;
    for (int row = block->y == 0 ? SHIFT : 0; row < rows; row++)
        for (int column = lattice->profile == PROFILE_LOCAL && block->x == 0 ? SHIFT : 0; column < columns; column++)
            voids += isnan(block->heights_m[row * SIDE + column]) != 0;
    block->has_voids = voids > 0;
    block->is_filled = false;
    return SCREE_OK;
}

static enum scree_status find_block(struct raster_reader *reader, int64_t x, int64_t y, struct block **found,
                                    struct scree_error *error) {
    struct block *oldest = NULL;
    for (int i = 0; i < reader->block_count; i++) {
        struct block *block = &reader->blocks[i];
        if (block->used > 0 && block->x == x && block->y == y) {
            block->used = ++reader->clock;
            *found = block;
            return SCREE_OK;
        }
        if (oldest == NULL || block->used < oldest->used) oldest = block;
    }
    if (reader->block_count < MAX_BLOCKS) {
        oldest = &reader->blocks[reader->block_count];
        oldest->heights_m = malloc(sizeof(float) * SIDE * SIDE);
        if (oldest->heights_m == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for a block of posts");
        reader->block_count++;
    }
    oldest->used = 0; /* holds nothing, should loading fail */
    oldest->x = x;
    oldest->y = y;
    enum scree_status status = load(reader, oldest, error);
    if (status != SCREE_OK) return status;
    oldest->used = ++reader->clock;
    *found = oldest;
    return SCREE_OK;
}

static enum scree_status fill(struct raster_reader *reader, struct block *block, struct scree_error *error);

/* Copies posts out of blocks. Columns wrap around the globe; posts beyond the lattice are NaN. */
static enum scree_status gather(struct raster_reader *reader, int64_t x, int64_t y, int columns, int rows,
                                bool is_filled, float *heights_m, int stride, struct scree_error *error) {
    const struct lattice *lattice = &reader->raster->placement.lattice;
    int64_t turn = lattice->profile == PROFILE_GEODETIC ? lattice->columns - 1 : 0;
    for (int row = 0; row < rows;) {
        int64_t post_row = y + row + SHIFT;
        bool is_inside_rows = post_row >= 0 && post_row < lattice->rows + SHIFT;
        int in_block_row = is_inside_rows ? (int)(post_row % SIDE) : 0;
        int height = is_inside_rows ? SIDE - in_block_row : 1;
        if (height > rows - row) height = rows - row;
        for (int column = 0; column < columns;) {
            int64_t post = x + column + SHIFT;
            if (turn > 0) post = (post % turn + turn) % turn;
            bool is_inside = is_inside_rows && post >= 0 && (turn > 0 || post < lattice->columns + SHIFT);
            int in_block = is_inside ? (int)(post % SIDE) : 0;
            int width = is_inside ? SIDE - in_block : 1;
            if (turn > 0 && width > turn - post) width = (int)(turn - post);
            if (width > columns - column) width = columns - column;
            float *target = heights_m + (size_t)row * (size_t)stride + (size_t)column;
            struct block *block = NULL;
            enum scree_status status = SCREE_OK;
            if (is_inside) status = find_block(reader, post / SIDE, post_row / SIDE, &block, error);
            if (status == SCREE_OK && block != NULL && is_filled && block->has_voids && !block->is_filled)
                status = fill(reader, block, error);
            if (status != SCREE_OK) return status;
            const float *source = block == NULL                   ? NULL
                                  : is_filled && block->has_voids ? block->filled_m
                                                                  : block->heights_m;
            for (int j = 0; j < height; j++, target += stride) {
                if (source == NULL)
                    for (int i = 0; i < width; i++) target[i] = NAN;
                else
                    memcpy(target, source + (in_block_row + j) * SIDE + in_block, (size_t)width * sizeof *target);
            }
            column += width;
        }
        row += height;
    }
    return SCREE_OK;
}

/* What interpolation has left void is enclosed by data on a larger scale, or lies outside of them. */
static enum scree_status fill_rest(struct raster_reader *reader, struct block *block, struct scree_error *error) {
    float *filled_m = block->filled_m, *enclosed_m = reader->region_m;
    float outside_m = (float)reader->raster->options.nodata_height_m;
    int rest = 0;
    for (int i = 0; i < SIDE * SIDE; i++) rest += isnan(filled_m[i]) != 0;
    if (rest > 0 && reader->enclosed != NULL) {
        enum scree_status status = raster_field_read(reader->enclosed, block->x * SIDE - SHIFT, block->y * SIDE - SHIFT,
                                                     SIDE, SIDE, enclosed_m, error);
        if (status != SCREE_OK) return status;
        for (int i = 0; i < SIDE * SIDE; i++)
            if (isnan(filled_m[i])) filled_m[i] = enclosed_m[i];
    }
    for (int i = 0; i < SIDE * SIDE && rest > 0; i++)
        if (isnan(filled_m[i])) filled_m[i] = outside_m;
    level_poles(reader, block, outside_m, filled_m);
    return SCREE_OK;
}

/* Gathers the block with a margin and fills what lies inside of the data. */
static enum scree_status fill(struct raster_reader *reader, struct block *block, struct scree_error *error) {
    int distance = reader->raster->fill_distance;
    int margin = distance + 1;
    int side = SIDE + 2 * margin;
    int64_t x = block->x * SIDE - SHIFT - margin, y = block->y * SIDE - SHIFT - margin;
    if (block->filled_m == NULL) block->filled_m = malloc(sizeof(float) * SIDE * SIDE);
    if (reader->region_m == NULL) reader->region_m = malloc(sizeof(float) * (size_t)side * (size_t)side);
    if (block->filled_m == NULL || reader->region_m == NULL)
        return scree_fail(error, SCREE_E_MEMORY, "no memory to fill voids");
    enum scree_status status = gather(reader, x, y, side, side, false, reader->region_m, side, error);
    if (status == SCREE_OK) status = raster_voids_fill(reader->region_m, side, side, margin, distance, error);
    if (status != SCREE_OK) return status;
    for (int row = 0; row < SIDE; row++)
        memcpy(block->filled_m + row * SIDE, reader->region_m + (size_t)(row + margin) * (size_t)side + margin,
               SIDE * sizeof(float));
    status = fill_rest(reader, block, error);
    block->is_filled = status == SCREE_OK;
    return status;
}

static int64_t clamped(int64_t value, int64_t low, int64_t high) {
    return value < low ? low : value > high ? high : value;
}

enum scree_status raster_read(struct raster_reader *reader, int64_t x, int64_t y, int32_t columns, int32_t rows,
                              float *heights_m, int32_t stride, struct scree_error *error) {
    const struct lattice *lattice = &reader->raster->placement.lattice;
    if (columns < 1 || rows < 1 || stride < columns)
        return scree_fail(error, SCREE_E_ARGUMENT, "a window of %d x %d posts cannot be read", columns, rows);
    /* The part inside of the lattice, and where it goes in the caller's array. */
    int64_t south = clamped(y, 0, lattice->rows - 1), north = clamped(y + rows - 1, 0, lattice->rows - 1);
    int64_t west = x, east = x + columns - 1;
    if (lattice->profile == PROFILE_LOCAL) {
        west = clamped(west, 0, lattice->columns - 1);
        east = clamped(east, 0, lattice->columns - 1);
    }
    int first_row = (int)clamped(south - y, 0, rows - 1), first_column = (int)clamped(west - x, 0, columns - 1);
    int inner_rows = (int)(north - south + 1), inner_columns = (int)(east - west + 1);
    float *inner_m = heights_m + (size_t)first_row * (size_t)stride + (size_t)first_column;
    enum scree_status status = gather(reader, west, south, inner_columns, inner_rows, true, inner_m, stride, error);
    if (status != SCREE_OK) return status;
    /* Beyond the lattice its border is repeated. */
    for (int j = 0; j < inner_rows; j++) {
        float *row_m = inner_m + (size_t)j * (size_t)stride - first_column;
        for (int i = 0; i < first_column; i++) row_m[i] = row_m[first_column];
        for (int i = first_column + inner_columns; i < columns; i++) row_m[i] = row_m[first_column + inner_columns - 1];
    }
    const float *lowest_m = heights_m + (size_t)first_row * (size_t)stride;
    const float *highest_m = lowest_m + (size_t)(inner_rows - 1) * (size_t)stride;
    size_t row_bytes = (size_t)columns * sizeof *heights_m;
    for (int j = 0; j < first_row; j++) memcpy(heights_m + (size_t)j * (size_t)stride, lowest_m, row_bytes);
    for (int j = first_row + inner_rows; j < rows; j++)
        memcpy(heights_m + (size_t)j * (size_t)stride, highest_m, row_bytes);
    return SCREE_OK;
}
