#include "src/raster_arguments.h"

#include "src/cloud_arguments.h"
#include "src/filter_arguments.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static enum argument_result wrong(struct scree_error *error, const char *option, const char *wanted) {
    scree_fail(error, SCREE_E_ARGUMENT, "%s wants %s", option, wanted);
    return ARGUMENT_WRONG;
}

static enum argument_result take_extent(int argc, char **argv, int *at, struct raster_options *options,
                                        struct scree_error *error) {
    double *extent = options->extent;
    for (int i = 0; i < 4; i++)
        if (*at + 1 + i >= argc || !argument_number(argv[*at + 1 + i], &extent[i]))
            return wrong(error, argv[*at], "four numbers: west south east north");
    if (!(extent[0] < extent[2]) || !(extent[1] < extent[3]))
        return wrong(error, argv[*at], "an extent: west below east, south below north");
    options->has_extent = true;
    *at += 5;
    return ARGUMENT_TAKEN;
}

static enum argument_result take_nodata(const char *option, const char *value, struct raster_options *options,
                                        struct scree_error *error) {
    options->has_nodata = true;
    if (strcmp(value, "nan") == 0 || strcmp(value, "NaN") == 0) {
        options->nodata = NAN;
    } else if (!argument_number(value, &options->nodata)) {
        return wrong(error, option, "a number or nan");
    }
    return ARGUMENT_TAKEN;
}

enum argument_result raster_argument_take(int argc, char **argv, int *at, struct raster_options *options,
                                          struct scree_error *error) {
    static const char *const with_value[] = {"r", "b", "s_srs", "a_nodata", "nodata-height", "fill-distance"};
    const char *option = argv[*at];
    enum argument_result result = ARGUMENT_TAKEN;
    size_t which = 0, known = sizeof with_value / sizeof *with_value;
    if (argument_is(option, "te")) return take_extent(argc, argv, at, options, error);
    if (argument_is(option, "any-height")) {
        options->any_height = true;
        ++*at;
        return ARGUMENT_TAKEN;
    }
    if (argument_is(option, "filter")) {
        options->filter.is_wanted = true;
        ++*at;
        return ARGUMENT_TAKEN;
    }
    while (which < known && !argument_is(option, with_value[which])) which++;
    if (which == known) {
        result = filter_argument_take(argc, argv, at, &options->filter, error);
        return result != ARGUMENT_OTHER ? result : cloud_argument_take(argc, argv, at, &options->cloud, error);
    }
    if (*at + 1 >= argc) return wrong(error, option, "a value");
    const char *value = argv[*at + 1];
    switch (which) {
    case 0: options->resampling = value; break;
    case 1:
        if (!argument_integer(value, 1, INT_MAX, &options->band)) result = wrong(error, option, "a band from 1");
        break;
    case 2: options->source_srs = value; break;
    case 3: result = take_nodata(option, value, options, error); break;
    case 4:
        options->has_nodata_height = true;
        if (!argument_number(value, &options->nodata_height_m)) result = wrong(error, option, "a number of metres");
        break;
    default:
        if (!argument_integer(value, -1, INT_MAX, &options->fill_distance))
            result = wrong(error, option, "a number of posts, or -1");
        break;
    }
    *at += 2;
    return result;
}

bool raster_arguments_check(const struct raster_options *options, struct scree_error *error) {
    const struct filter_options *filter = &options->filter;
    if (filter->named != NULL && !filter->is_wanted) {
        scree_fail(error, SCREE_E_ARGUMENT, "%s goes with --filter", filter->named);
        return false;
    }
    if (filter->rules != NULL && filter->landuse == NULL) {
        scree_fail(error, SCREE_E_ARGUMENT, "--rules goes with --landuse");
        return false;
    }
    return true;
}
