/* scree filter: a raster smoothed where nobody looks, and kept where everybody does. */
#include "lod/context_filter.h"
#include "lod/spline_filter.h"
#include "src/command.h"
#include "src/file_io.h"
#include "src/filter_picture.h"
#include "src/filter_raster_io.h"
#include "src/filter_report.h"
#include "src/landuse_io.h"
#include "src/png.h"
#include "src/raster_arguments.h"

#include <cpl_conv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_MEMORY_MB 4000
#define MOST_MEMORY_MB    100000000
#define BYTES_A_MB        1000000

static const char help[] =
    "Usage: scree filter DEM... -o OUT.tif [OPTION]...\n"
    "Filters a raster so that it needs fewer triangles: the context-sensitive filter of Goebbels and\n"
    "Pohle-Froehlich (\"Context-sensitive filtering of terrain data based on multi scale analysis\"). Heights come "
    "from\n"
    "a coarse spline; those that lie far from it, and what land use says is looked at, keep their detail, filtered by\n"
    "thresholds on Haar wavelets.\n\n"
    "  -o OUT.tif           the file to write: the raster's pixels and CRS, Float32, in metres\n"
    "  --landuse FILE       polygons of land use, any vector source that OGR reads: posts near shores, railways,\n"
    "                       bridges and roads that meet bridges keep detail, waters are levelled to their mean\n"
    "  --rules FILE         what attributes mean, a rule a line, the first that fits counts: USE ATTRIBUTE=VALUE;\n"
    "                       uses are water, shore, railway, bridge, road and forest, and * is any value. Default:\n"
    "                       the attribute class has the name of the use\n"
    "  --spline-steps N     halve the grid so often for the spline, 1 to 9, default 3\n"
    "  --delta M            keep detail where the spline is farther away than this, default 4\n"
    "  --least M            differences up to this cannot be seen, and stay with the spline; default 0.3\n"
    "  --variant N          2 (default): of the wavelets only what is finer than all that reach their thresholds\n"
    "                       goes (the paper's eq. 4); 1: whatever stays below its threshold goes (eq. 3)\n"
    "  --thresholds CLASS=T0,T1,...,T8   nine thresholds in metres, from coarse (512 posts) to fine (2 posts); may\n"
    "                       be given once a class. Classes and their defaults (the paper's Table 1):\n"
    "                       near, no farther than 4 posts from what has to be kept: 0,.1,.1,.2,.2,.2,.3,.3,.4\n"
    "                       railway, on an embankment: 0,.1,.1,.1,.1,.1,.1,.1,.1\n"
    "                       hill, farther than delta from the spline: 0,.1,.2,.2,.3,.4,.5,.5,.5\n"
    "                       forest, the same under trees: 0,.1,.2,.2,.3,20,20,20,20\n"
    "  --report             print tables of triangles: squares of posts, split where they are not flat within 0.2, "
    "0.1\n"
    "                       and 0.05 m, unfiltered and filtered, with 1 to 6 spline steps and other deltas (the\n"
    "                       paper's Tables 2 to 4); -o may be left out then. Takes some 40 times as long\n"
    "  --difference PNG     a picture of what has changed: red where the raster was higher, blue where lower, the\n"
    "                       darker the farther, up to delta\n"
    "  --filter-memory MB   refuse rasters that need more, default 4000; a post takes 24 bytes\n"
    "  -q                   say nothing but errors\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_ARGUMENTS_HELP
    "\nThe raster's own pixels are the posts. Posts outside of the data stay without, unless --nodata-height gives "
    "them\n"
    "a height. Where a post is near the border of the detail that is kept, it may change by --delta.\n";

static const char *const class_names[CONTEXT_REST] = {
    [CONTEXT_NEAR] = "near", [CONTEXT_RAILWAY] = "railway", [CONTEXT_HILL] = "hill", [CONTEXT_FOREST] = "forest"};

struct arguments {
    struct raster_options raster;
    struct context_options filter;
    const char **inputs;
    const char *output, *landuse, *rules, *difference;
    int memory_mb;
    bool reports, quiet;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree filter: %s%s; scree filter --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* CLASS=T0,...,T8 */
static bool take_thresholds(const char *text, struct context_options *filter) {
    const char *equals = strchr(text, '=');
    int class = 0;
    if (equals == NULL) return false;
    const size_t length = (size_t)(equals - text);
    while (class < CONTEXT_REST &&
           (strlen(class_names[class]) != length || strncmp(class_names[class], text, length) != 0))
        class ++;
    if (class == CONTEXT_REST) return false;
    const char *at = equals + 1;
    for (int i = 0; i < HAAR_LEVELS; i++) {
        char *end;
        const double threshold_m = strtod(at, &end);
        if (end == at || !isfinite(threshold_m) || threshold_m < 0) return false;
        if (*end != (i + 1 < HAAR_LEVELS ? ',' : '\0')) return false;
        filter->thresholds_m[class][i] = threshold_m;
        at = end + 1;
    }
    return true;
}

static bool take_metres(const char *text, double *metres) {
    return argument_number(text, metres) && *metres >= 0;
}

/* Options that have a value; NULL when the value is fine, else what is wanted. "" when there is no such option. */
static const char *take_valued(const char *name, const char *value, struct arguments *arguments) {
    struct context_options *filter = &arguments->filter;
    int number;
    if (strcmp(name, "-o") == 0) return arguments->output = value, NULL;
    if (strcmp(name, "--landuse") == 0) return arguments->landuse = value, NULL;
    if (strcmp(name, "--difference") == 0) return arguments->difference = value, NULL;
    if (strcmp(name, "--rules") == 0) return arguments->rules = value, NULL;
    if (strcmp(name, "--spline-steps") == 0)
        return argument_integer(value, 1, SPLINE_MAX_STEPS, &filter->spline_steps)
                   ? NULL
                   : "--spline-steps wants 1 to 9, not ";
    if (strcmp(name, "--delta") == 0)
        return take_metres(value, &filter->delta_m) ? NULL : "--delta wants metres from 0, not ";
    if (strcmp(name, "--least") == 0)
        return take_metres(value, &filter->least_m) ? NULL : "--least wants metres from 0, not ";
    if (strcmp(name, "--variant") == 0) {
        if (!argument_integer(value, 1, 2, &number)) return "--variant wants 1 or 2, not ";
        filter->variant = number == 1 ? HAAR_EACH : HAAR_TAIL;
        return NULL;
    }
    if (strcmp(name, "--thresholds") == 0)
        return take_thresholds(value, filter) ? NULL : "--thresholds wants CLASS=T0,...,T8 of a class, not ";
    if (strcmp(name, "--filter-memory") == 0)
        return argument_integer(value, 1, MOST_MEMORY_MB, &arguments->memory_mb)
                   ? NULL
                   : "--filter-memory wants megabytes, not ";
    return "";
}

/* One argument that is not about reading rasters; EXIT_DONE or the code to exit with. */
static int take(int argc, char **argv, int *at, struct arguments *arguments) {
    const char *name = argv[(*at)++], *value = *at < argc ? argv[*at] : NULL;
    if (strcmp(name, "-q") == 0) return arguments->quiet = true, EXIT_DONE;
    if (strcmp(name, "--report") == 0) return arguments->reports = true, EXIT_DONE;
    if (name[0] != '-' || name[1] == '\0') {
        arguments->inputs[arguments->raster.input_count++] = name;
        return EXIT_DONE;
    }
    if (strcmp(name, "--config") == 0) {
        if (*at + 1 >= argc) return usage("--config wants a key and a value", "");
        CPLSetConfigOption(argv[*at], argv[*at + 1]);
        *at += 2;
        return EXIT_DONE;
    }
    const char *wanted = take_valued(name, value != NULL ? value : "", arguments);
    if (wanted != NULL && wanted[0] == '\0') return usage("there is no option ", name);
    if (value == NULL) return usage("a value is missing behind ", name);
    if (wanted != NULL) return usage(wanted, value);
    ++*at;
    return EXIT_DONE;
}

static int parse(int argc, char **argv, struct arguments *arguments) {
    for (int at = 1; at < argc;) {
        struct scree_error error = {0};
        enum argument_result taken = raster_argument_take(argc, argv, &at, &arguments->raster, &error);
        if (taken == ARGUMENT_WRONG) return usage(error.text, "");
        if (taken == ARGUMENT_TAKEN) continue;
        int code = take(argc, argv, &at, arguments);
        if (code != EXIT_DONE) return code;
    }
    if (arguments->raster.input_count == 0) return usage("which DEM? Name one raster or several", "");
    if (arguments->output == NULL && arguments->difference == NULL && !arguments->reports)
        return usage("-o names the GeoTIFF to write", "");
    if (arguments->rules != NULL && arguments->landuse == NULL) return usage("--rules goes with --landuse", "");
    arguments->raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

/* ---- the work ---- */

struct job {
    struct scree_memory memory;
    struct filter_raster raster;
    struct context_posts posts;
    struct landuse_posts landuse;
    struct context_counts counts;
    float *filtered_m;
};

static enum scree_status read_all(const struct arguments *arguments, struct job *job, struct scree_error *error) {
    enum scree_status status = filter_raster_read(&job->memory, &arguments->raster, &job->raster, error);
    const struct filter_raster *raster = &job->raster;
    if (status == SCREE_OK && arguments->landuse != NULL)
        status = landuse_read(&job->memory, arguments->landuse, arguments->rules, raster, &job->landuse, error);
    if (status != SCREE_OK) return status;
    job->posts = (struct context_posts){.heights_m = raster->heights_m,
                                        .columns = raster->columns,
                                        .rows = raster->rows,
                                        .uses = job->landuse.uses,
                                        .waters = job->landuse.waters,
                                        .water_count = job->landuse.water_count};
    job->filtered_m = scree_allocate(&job->memory, (size_t)raster->columns * (size_t)raster->rows,
                                     sizeof *job->filtered_m, "the filtered heights", error);
    return job->filtered_m != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

static void tell_landuse(const char *path, const struct landuse_posts *landuse) {
    printf("%s: ", path);
    for (int use = 0; use < LANDUSE_COUNT; use++)
        printf("%s%u %s", use > 0 ? ", " : "", (unsigned)landuse->features[use], landuse_name((enum landuse)use));
    printf("; %u roads meet a bridge\n", (unsigned)landuse->ramps);
    if (landuse->outside > 0) printf("%s: %u lie outside of the raster\n", path, (unsigned)landuse->outside);
    if (landuse->repaired > 0) printf("%s: %u are invalid and were repaired\n", path, (unsigned)landuse->repaired);
    if (landuse->empty > 0) printf("%s: %u have no usable geometry\n", path, (unsigned)landuse->empty);
}

static void tell_classes(const struct context_counts *counts, size_t count) {
    printf("of the posts");
    for (int class = 0; class < CONTEXT_REST; class ++)
        printf("%s %.3g %% are %s", class > 0 ? "," : "", 100 * (double)counts->posts[class] / (double)count,
               class_names[class]);
    printf("; %.3g %% keep detail, %.3g %% are levelled\n", 100 * (double)counts->detailed / (double)count,
           100 * (double)counts->levelled / (double)count);
}

static void tell(const struct arguments *arguments, const struct job *job) {
    const size_t count = (size_t)job->posts.columns * (size_t)job->posts.rows;
    double max_m = 0, sum_m2 = 0;
    for (size_t post = 0; post < count; post++) {
        const double away_m = fabs((double)job->filtered_m[post] - job->posts.heights_m[post]);
        max_m = fmax(max_m, away_m);
        sum_m2 += away_m * away_m;
    }
    if (arguments->output != NULL) printf("%s: ", arguments->output);
    printf("%d x %d posts; heights changed by RMS %.4g m, at most %.4g m\n", (int)job->posts.columns,
           (int)job->posts.rows, sqrt(sum_m2 / (double)count), max_m);
    if (arguments->landuse != NULL) tell_landuse(arguments->landuse, &job->landuse);
    tell_classes(&job->counts, count);
}

static enum scree_status draw(const struct arguments *arguments, struct job *job, struct scree_error *error) {
    const struct filter_difference difference = {
        job->posts.heights_m, job->filtered_m, job->raster.is_outside,
        job->posts.columns,   job->posts.rows, arguments->filter.delta_m > 0 ? arguments->filter.delta_m : 1};
    struct filter_picture picture;
    unsigned char *bytes = NULL;
    size_t size_bytes = 0;
    enum scree_status status = filter_picture_new(&job->memory, &difference, &picture, error);
    if (status == SCREE_OK)
        status =
            png_encode_new(&job->memory, picture.rgb, picture.width_px, picture.height_px, &bytes, &size_bytes, error);
    if (status == SCREE_OK) status = file_replace(arguments->difference, bytes, size_bytes, error);
    scree_release(&job->memory, bytes);
    scree_release(&job->memory, picture.rgb);
    return status;
}

/* Last, as the filtered heights are lost on the way. */
static enum scree_status report(const struct arguments *arguments, struct job *job, struct scree_error *error) {
    struct text text = {0};
    size_t length_bytes;
    enum scree_status status =
        filter_report(&job->memory, &job->posts, &arguments->filter, job->filtered_m, &text, error);
    char *tables = text_take(&text, &length_bytes);
    if (status == SCREE_OK && tables == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for the tables");
    if (status == SCREE_OK) fputs(tables, stdout);
    free(tables);
    return status;
}

static enum scree_status filter(const struct arguments *arguments, struct job *job, struct scree_error *error) {
    enum scree_status status = read_all(arguments, job, error);
    if (status == SCREE_OK)
        status = context_filter(&job->memory, &job->posts, &arguments->filter, job->filtered_m, &job->counts, error);
    if (status == SCREE_OK && arguments->output != NULL)
        status = filter_raster_write(&job->raster, job->filtered_m, arguments->output, error);
    if (status == SCREE_OK && arguments->difference != NULL) status = draw(arguments, job, error);
    if (status == SCREE_OK && !arguments->quiet) tell(arguments, job);
    if (status == SCREE_OK && arguments->reports) status = report(arguments, job, error);
    return status;
}

static int run(const struct arguments *arguments) {
    struct scree_error error = {0};
    struct job job = {.memory = {.limit_bytes = (size_t)arguments->memory_mb * BYTES_A_MB}};
    enum scree_status status = filter(arguments, &job, &error);
    scree_release(&job.memory, job.filtered_m);
    landuse_free(&job.memory, &job.landuse);
    filter_raster_free(&job.memory, &job.raster);
    if (status == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree filter: %s\n", error.text);
    return EXIT_FAILED;
}

int command_filter(int argc, char **argv) {
    struct arguments arguments = {.raster = {.profile = PROFILE_LOCAL, .nodata_height_m = FILTER_NO_HEIGHT_M},
                                  .filter = context_defaults(),
                                  .memory_mb = DEFAULT_MEMORY_MB};
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return fputs(help, stdout) < 0 ? EXIT_FAILED : EXIT_DONE;
    if ((arguments.inputs = calloc((size_t)argc, sizeof *arguments.inputs)) == NULL) {
        fprintf(stderr, "scree filter: no memory for the arguments\n");
        return EXIT_FAILED;
    }
    int code = parse(argc, argv, &arguments);
    if (code == EXIT_DONE) code = run(&arguments);
    free(arguments.inputs);
    return code;
}
