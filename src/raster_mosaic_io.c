/* One thread's chain of GDAL's virtual rasters, from files to posts: each input cleaned, inputs of one grid side by
 * side, each group warped onto the lattice, groups on top of each other. Nothing is read before a window is asked for;
 * files are opened when they are first touched, and few are open at a time.
 *
 * Line 0 of what is warped is the southern row, so that posts come out in the order of the lattice. */
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_vrt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_OPEN_INPUTS   24
#define WARP_ERROR_PIXELS 0.02    /* how far GDAL's approximation may move a post, in source pixels */
#define REDUCE_PIXELS     1048576 /* of one read while averaging */

struct field_input {
    struct raster_field *field;
    const struct raster_input *input;
    GDALDatasetH opened;  /* NULL: not open now */
    GDALDatasetH cleaned; /* virtual */
    uint64_t used;
};

struct field_layer {
    struct raster_field *field;
    const struct raster_group *group;
    const struct raster_layer *layer;
    GDALDatasetH mosaic, turned, reduced, warped, shifted; /* each on top of the one before; some are not needed */
    struct raster_transform transform;
    PJ *to_lonlat, *shift;
    int reduced_columns, reduced_rows;
};

struct raster_field {
    const struct raster *raster;
    bool is_enclosed; /* not the heights, but what lies in enclosed voids */
    const struct raster_placement *placement;
    PJ_CONTEXT *proj;
    int input_count, layer_count, open_count;
    uint64_t clock;
    struct field_input *inputs;
    struct field_layer *layers;
    GDALDatasetH posts;
};

/* --- the links of the chain, each called by GDAL for a window of its own grid --- */

static GDALDatasetH opened(struct field_input *link) {
    struct raster_field *field = link->field;
    link->used = ++field->clock;
    if (link->opened != NULL) return link->opened;
    if (field->open_count >= MAX_OPEN_INPUTS) {
        struct field_input *oldest = NULL;
        for (int i = 0; i < field->input_count; i++) {
            struct field_input *other = &field->inputs[i];
            if (other->opened != NULL && (oldest == NULL || other->used < oldest->used)) oldest = other;
        }
        GDALClose(oldest->opened);
        oldest->opened = NULL;
        field->open_count--;
    }
    link->opened =
        GDALOpenEx(link->input->dataset, GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, NULL, NULL, NULL);
    if (link->opened == NULL) return NULL;
    field->open_count++;
    if (GDALGetRasterXSize(link->opened) != link->input->columns ||
        GDALGetRasterYSize(link->opened) != link->input->rows) {
        CPLError(CE_Failure, CPLE_AppDefined, "%s: changed while it was read", link->input->name);
        return NULL;
    }
    return link->opened;
}

static CPLErr read_cleaned(void *argument, int column, int row, int columns, int rows, void *heights_m) {
    struct field_input *link = argument;
    GDALDatasetH dataset = opened(link);
    if (dataset == NULL) return CE_Failure;
    return raster_input_read(link->input, dataset, column, row, columns, rows, heights_m);
}

static CPLErr read_enclosed(void *argument, int column, int row, int columns, int rows, void *heights_m) {
    const struct field_layer *link = argument;
    raster_enclosed_read(link->group, column, row, columns, rows, heights_m);
    return CE_None;
}

/* How a cell of several pixels becomes one: methods that look for an extreme keep it, those that pick a pixel go on
 * picking, all others average. */
static float reduce_cell(GDALResampleAlg method, const float *pixels, int columns, int rows, int stride) {
    if (method == GRA_NearestNeighbour || method == GRA_Mode || method == GRA_Med || method == GRA_Q1 ||
        method == GRA_Q3)
        return pixels[(size_t)(rows / 2) * (size_t)stride + (size_t)(columns / 2)];
    double sum = 0;
    float low = INFINITY, high = -INFINITY;
    int count = 0;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            float h = pixels[(size_t)j * (size_t)stride + (size_t)i];
            if (isnan(h)) continue;
            sum += h;
            count++;
            low = fminf(low, h);
            high = fmaxf(high, h);
        }
    if (count == 0) return NAN;
    if (method == GRA_Min) return low;
    if (method == GRA_Max) return high;
    return (float)(sum / count);
}

static CPLErr read_reduced(void *argument, int column, int row, int columns, int rows, void *heights_m) {
    struct field_layer *link = argument;
    GDALDatasetH source = link->turned != NULL ? link->turned : link->mosaic;
    GDALRasterBandH band = GDALGetRasterBand(source, 1);
    int factor = link->layer->reduction;
    int across = REDUCE_PIXELS / factor / factor < 1 ? 1 : REDUCE_PIXELS / factor / factor;
    if (across > columns) across = columns;
    float *pixels = VSI_MALLOC3_VERBOSE(sizeof *pixels, (size_t)across * (size_t)factor, (size_t)factor);
    if (pixels == NULL) return CE_Failure;
    CPLErr failed = CE_None;
    int source_columns = GDALGetRasterXSize(source), source_rows = GDALGetRasterYSize(source);
    for (int j = 0; j < rows && failed == CE_None; j++)
        for (int i = 0; i < columns && failed == CE_None; i += across) {
            int cells = columns - i < across ? columns - i : across;
            int x = (column + i) * factor, y = (row + j) * factor;
            int width = source_columns - x < cells * factor ? source_columns - x : cells * factor;
            int height = source_rows - y < factor ? source_rows - y : factor;
            failed = GDALRasterIO(band, GF_Read, x, y, width, height, pixels, width, height, GDT_Float32, 0, 0);
            for (int k = 0; k < cells && failed == CE_None; k++) {
                int cell = width - k * factor < factor ? width - k * factor : factor;
                ((float *)heights_m)[(size_t)j * (size_t)columns + (size_t)(i + k)] =
                    reduce_cell(link->field->raster->resampling, pixels + k * factor, cell, height, width);
            }
        }
    VSIFree(pixels);
    return failed;
}

static CPLErr read_shifted(void *argument, int column, int row, int columns, int rows, void *heights_m) {
    struct field_layer *link = argument;
    float *heights = heights_m;
    CPLErr failed = GDALRasterIO(GDALGetRasterBand(link->warped, 1), GF_Read, column, row, columns, rows, heights,
                                 columns, rows, GDT_Float32, 0, 0);
    if (failed != CE_None) return failed;
    const struct lattice *lattice = &link->field->placement->lattice;
    for (int j = 0; j < rows; j++) {
        double west_deg = lattice_x(lattice, (double)(link->layer->x + column));
        double latitude_deg = lattice_y(lattice, (double)(link->layer->y + row + j));
        if (!raster_shift_row(link->shift, link->group->shift_scale, west_deg, lattice->spacing_x, latitude_deg,
                              columns, heights + (size_t)j * (size_t)columns)) {
            CPLError(CE_Failure, CPLE_AppDefined,
                     "PROJ cannot make heights ellipsoidal near longitude %.6g, latitude %.6g: its grid ends there",
                     west_deg, latitude_deg);
            return CE_Failure;
        }
    }
    return CE_None;
}

/* --- building the chain --- */

/* A virtual raster of one band of floats with NaN for void. */
static GDALDatasetH virtual_new(int columns, int rows) {
    GDALDatasetH dataset = VRTCreate(columns, rows);
    if (dataset == NULL) return NULL;
    if (GDALAddBand(dataset, GDT_Float32, NULL) != CE_None ||
        GDALSetRasterNoDataValue(GDALGetRasterBand(dataset, 1), NAN) != CE_None) {
        GDALClose(dataset);
        return NULL;
    }
    return dataset;
}

static GDALDatasetH virtual_by(VRTImageReadFunc read, void *argument, int columns, int rows) {
    GDALDatasetH dataset = virtual_new(columns, rows);
    if (dataset != NULL &&
        VRTAddFuncSource((VRTSourcedRasterBandH)GDALGetRasterBand(dataset, 1), read, argument, NAN) != CE_None) {
        GDALClose(dataset);
        return NULL;
    }
    return dataset;
}

/* Puts `columns` x `rows` pixels of `source` from (from_x, from_y) into `target` at (x, y), its voids left out; what
 * lies outside of the target is cut off. */
static CPLErr put(GDALDatasetH target, GDALDatasetH source, int64_t from_x, int64_t from_y, int64_t x, int64_t y,
                  int64_t columns, int64_t rows) {
    if (x < 0) columns += x, from_x -= x, x = 0;
    if (y < 0) rows += y, from_y -= y, y = 0;
    if (x + columns > GDALGetRasterXSize(target)) columns = GDALGetRasterXSize(target) - x;
    if (y + rows > GDALGetRasterYSize(target)) rows = GDALGetRasterYSize(target) - y;
    if (columns <= 0 || rows <= 0) return CE_None;
    return VRTAddComplexSource((VRTSourcedRasterBandH)GDALGetRasterBand(target, 1), GDALGetRasterBand(source, 1),
                               (int)from_x, (int)from_y, (int)columns, (int)rows, (int)x, (int)y, (int)columns,
                               (int)rows, 0, 1, NAN);
}

static bool mosaic_group(struct raster_field *field, struct field_layer *link) {
    const struct raster_group *group = link->group;
    link->mosaic = field->is_enclosed ? virtual_by(read_enclosed, link, group->columns, group->rows)
                                      : virtual_new(group->columns, group->rows);
    if (link->mosaic == NULL) return false;
    for (int i = 0; i < group->input_count && !field->is_enclosed; i++) {
        const struct field_input *part = &field->inputs[group->first_input + i];
        if (put(link->mosaic, part->cleaned, 0, 0, part->input->group_column, part->input->group_row,
                part->input->columns, part->input->rows) != CE_None)
            return false;
    }
    if (!group->is_around) return true;
    /* Columns that go around the globe are laid out twice: the seam is inside then. */
    link->turned = virtual_new(2 * group->columns, group->rows);
    return link->turned != NULL &&
           put(link->turned, link->mosaic, 0, 0, 0, 0, group->columns, group->rows) == CE_None &&
           put(link->turned, link->mosaic, 0, 0, group->columns, 0, group->columns, group->rows) == CE_None;
}

static bool warp_group(struct raster_field *field, struct field_layer *link) {
    const struct lattice *lattice = &field->placement->lattice;
    const struct raster_layer *layer = link->layer;
    GDALDatasetH source = link->turned != NULL ? link->turned : link->mosaic;
    int columns = GDALGetRasterXSize(source), rows = GDALGetRasterYSize(source);
    double pixels[6];
    memcpy(pixels, link->group->geotransform, sizeof pixels);
    if (layer->reduction > 1) {
        int factor = layer->reduction;
        columns = (columns + factor - 1) / factor;
        rows = (rows + factor - 1) / factor;
        source = link->reduced = virtual_by(read_reduced, link, columns, rows);
        if (source == NULL) return false;
        pixels[1] *= factor, pixels[2] *= factor, pixels[4] *= factor, pixels[5] *= factor;
    }
    if (!raster_transform_make(&link->transform, pixels, columns, rows, link->group->is_geographic, link->to_lonlat))
        return false;
    double posts[6] = {lattice_x(lattice, (double)layer->x - 0.5),
                       lattice->spacing_x,
                       0,
                       lattice_y(lattice, (double)layer->y - 0.5),
                       0,
                       lattice->spacing_y};
    link->transform.west = posts[0];
    link->transform.south = posts[3];
    link->transform.spacing_x = posts[1];
    link->transform.spacing_y = posts[5];

    GDALWarpOptions *options = GDALCreateWarpOptions();
    options->hSrcDS = source;
    options->eResampleAlg = field->raster->resampling;
    options->eWorkingDataType = GDT_Float32;
    GDALWarpInitDefaultBandMapping(options, 1);
    GDALWarpInitNoDataReal(options, NAN);
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "NUM_THREADS", "1");
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg =
        GDALCreateApproxTransformer(raster_transform_points, &link->transform, WARP_ERROR_PIXELS);
    link->warped = GDALCreateWarpedVRT(source, layer->columns, layer->rows, posts, options);
    if (link->warped == NULL) GDALDestroyApproxTransformer(options->pTransformerArg);
    GDALDestroyWarpOptions(options);
    if (link->warped == NULL) return false;
    if (link->group->shift != NULL) link->shifted = virtual_by(read_shifted, link, layer->columns, layer->rows);
    return link->group->shift == NULL || link->shifted != NULL;
}

static bool build_layer(struct raster_field *field, struct field_layer *link) {
    if (!mosaic_group(field, link)) return false;
    if (field->placement->lattice.profile == PROFILE_LOCAL) {
        /* Rows stay as they are in the file: raster_field_read turns them. */
        const struct lattice_window *crop = &field->raster->local_crop;
        return put(field->posts, link->mosaic, crop->x, crop->y, 0, 0, field->placement->columns,
                   field->placement->rows) == CE_None;
    }
    if (link->group->to_lonlat != NULL && (link->to_lonlat = proj_create(field->proj, link->group->to_lonlat)) == NULL)
        return false;
    if (link->group->shift != NULL && (link->shift = proj_create(field->proj, link->group->shift)) == NULL)
        return false;
    if (!warp_group(field, link)) return false;
    const struct raster_layer *layer = link->layer;
    const struct raster_placement *placement = field->placement;
    GDALDatasetH top = link->shifted != NULL ? link->shifted : link->warped;
    int64_t turn = placement->lattice.columns - 1;
    int64_t x = (layer->x - placement->x) % turn;
    for (int64_t at = x - turn; at <= x + turn; at += turn)
        if (put(field->posts, top, 0, 0, at, layer->y - placement->y, layer->columns, layer->rows) != CE_None)
            return false;
    return true;
}

enum scree_status raster_field_new(const struct raster *raster, const struct raster_placement *placement,
                                   bool is_enclosed, struct raster_field **result, struct scree_error *error) {
    struct raster_trap trap;
    raster_trap_set(&trap);
    enum scree_status status = scree_fail(NULL, SCREE_E_MEMORY, "memory");
    struct raster_field *field = calloc(1, sizeof *field);
    if (field == NULL) goto cleanup;
    field->raster = raster;
    field->placement = placement;
    field->is_enclosed = is_enclosed;
    field->proj = raster_proj_new();
    field->inputs = calloc((size_t)raster->input_count, sizeof *field->inputs);
    field->layers = calloc((size_t)raster->group_count, sizeof *field->layers);
    if (field->proj == NULL || field->inputs == NULL || field->layers == NULL) goto cleanup;
    status = SCREE_OK;
    if (placement->columns == 0) goto cleanup;
    status = SCREE_E_IO;
    field->posts = virtual_new(placement->columns, placement->rows);
    if (field->posts == NULL) goto cleanup;
    for (int i = 0; i < raster->input_count && !is_enclosed; i++) {
        struct field_input *link = &field->inputs[i];
        field->input_count++;
        link->field = field;
        link->input = &raster->inputs[i];
        link->cleaned = virtual_by(read_cleaned, link, link->input->columns, link->input->rows);
        if (link->cleaned == NULL) goto cleanup;
    }
    for (int i = 0; i < raster->group_count; i++) {
        struct field_layer *link = &field->layers[i];
        field->layer_count++;
        link->field = field;
        link->group = &raster->groups[i];
        link->layer = &placement->layers[i];
        bool is_needed = link->layer->columns > 0 && (!is_enclosed || link->group->enclosed.heights_m != NULL);
        if (is_needed && !build_layer(field, link)) goto cleanup;
    }
    status = SCREE_OK;
cleanup:
    raster_trap_clear();
    if (status == SCREE_OK) {
        *result = field;
        return SCREE_OK;
    }
    raster_field_free(field);
    if (status == SCREE_E_MEMORY) return scree_fail(error, status, "no memory to read the raster");
    return raster_trap_fail(&trap, raster->inputs[0].name, error);
}

static void close_dataset(GDALDatasetH dataset) {
    if (dataset != NULL) GDALClose(dataset);
}

void raster_field_free(struct raster_field *field) {
    if (field == NULL) return;
    close_dataset(field->posts);
    for (int i = 0; i < field->layer_count; i++) {
        struct field_layer *link = &field->layers[i];
        close_dataset(link->shifted);
        close_dataset(link->warped);
        close_dataset(link->reduced);
        close_dataset(link->turned);
        close_dataset(link->mosaic);
        proj_destroy(link->shift);
        proj_destroy(link->to_lonlat);
    }
    for (int i = 0; i < field->input_count; i++) {
        close_dataset(field->inputs[i].cleaned);
        close_dataset(field->inputs[i].opened);
    }
    if (field->proj != NULL) proj_context_destroy(field->proj);
    free(field->layers);
    free(field->inputs);
    free(field);
}

/* --- reading --- */

static CPLErr read_posts(struct raster_field *field, int64_t x, int64_t y, int columns, int rows, int stride,
                         float *heights_m) {
    const struct raster_placement *placement = field->placement;
    int64_t left = x < 0 ? 0 : x, right = x + columns < placement->columns ? x + columns : placement->columns;
    int64_t south = y < 0 ? 0 : y, north = y + rows < placement->rows ? y + rows : placement->rows;
    if (left >= right || south >= north) return CE_None;
    bool is_local = placement->lattice.profile == PROFILE_LOCAL;
    bool is_flipped = is_local && field->raster->groups[0].geotransform[5] < 0;
    int64_t line = is_flipped ? placement->rows - north : south;
    float *first = heights_m + (south - y) * stride + (left - x);
    int line_bytes = stride * (int)sizeof *first;
    if (is_flipped) {
        first += (north - 1 - south) * stride;
        line_bytes = -line_bytes;
    }
    return GDALRasterIO(GDALGetRasterBand(field->posts, 1), GF_Read, (int)left, (int)line, (int)(right - left),
                        (int)(north - south), first, (int)(right - left), (int)(north - south), GDT_Float32,
                        (int)sizeof *first, line_bytes);
}

enum scree_status raster_field_read(struct raster_field *field, int64_t x, int64_t y, int columns, int rows,
                                    float *heights_m, struct scree_error *error) {
    const struct raster_placement *placement = field->placement;
    for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++) heights_m[i] = NAN;
    if (placement->columns == 0) return SCREE_OK;
    struct raster_trap trap;
    raster_trap_set(&trap);
    CPLErr failed = CE_None;
    if (placement->lattice.profile == PROFILE_LOCAL) {
        failed = read_posts(field, x - placement->x, y - placement->y, columns, rows, columns, heights_m);
    } else {
        /* The window may pass the mosaic's ends, where the globe goes on with its other end. */
        int64_t turn = placement->lattice.columns - 1;
        int64_t at = (x - placement->x) % turn;
        if (at < 0) at += turn;
        failed = read_posts(field, at, y - placement->y, columns, rows, columns, heights_m);
        if (failed == CE_None && at + columns > turn)
            failed = read_posts(field, at - turn, y - placement->y, columns, rows, columns, heights_m);
    }
    raster_trap_clear();
    if (failed == CE_None) return SCREE_OK;
    const char *name = field->input_count == 1 ? field->raster->inputs[0].name : "reading the mosaic";
    return raster_trap_fail(&trap, name, error);
}
