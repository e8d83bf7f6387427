/* scree filter: a raster smoothed where nobody looks, and kept where everybody does. */
#include "src/command.h"
#include "src/file_io.h"
#include "src/filter_arguments.h"
#include "src/filter_job_io.h"
#include "src/filter_picture.h"
#include "src/filter_report.h"
#include "src/png.h"
#include "src/raster_arguments.h"

#include <cpl_conv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "Usage: scree filter DEM... -o OUT.tif [OPTION]...\n"
    "Filters a raster so that it needs fewer triangles: the context-sensitive filter of Goebbels and\n"
    "Pohle-Froehlich (\"Context-sensitive filtering of terrain data based on multi scale analysis\"). Heights come "
    "from\n"
    "a coarse spline; those that lie far from it, and what land use says is looked at, keep their detail, filtered by\n"
    "thresholds on Haar wavelets.\n\n"
    "  -o OUT.tif           the file to write: the raster's pixels and CRS, Float32, in metres\n" FILTER_ARGUMENTS_HELP
    "  --report             print tables of triangles: squares of posts, split where they are not flat within 0.2, "
    "0.1\n"
    "                       and 0.05 m, unfiltered and filtered, with 1 to 6 spline steps and other deltas (the\n"
    "                       paper's Tables 2 to 4); -o may be left out then. Takes some 40 times as long\n"
    "  --difference PNG     a picture of what has changed: red where the raster was higher, blue where lower, the\n"
    "                       darker the farther, up to delta\n"
    "  -q                   say nothing but errors\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_READING_HELP
    "\nThe raster's own pixels are the posts. Posts outside of the data stay without, unless --nodata-height gives "
    "them\n"
    "a height. Where a post is near the border of the detail that is kept, it may change by --delta.\n";

struct arguments {
    struct raster_options raster; /* and how it is filtered */
    const char **inputs;
    const char *output, *difference;
    bool reports, quiet;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree filter: %s%s; scree filter --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* One argument that is not about reading and filtering rasters; EXIT_DONE or the code to exit with. */
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
    const bool is_output = strcmp(name, "-o") == 0;
    if (!is_output && strcmp(name, "--difference") != 0) return usage("there is no option ", name);
    if (value == NULL) return usage("a value is missing behind ", name);
    *(is_output ? &arguments->output : &arguments->difference) = value;
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
    struct scree_error error = {0};
    if (arguments->raster.filter.is_wanted) return usage("there is no option --filter", "");
    arguments->raster.filter.is_wanted = true;
    if (!raster_arguments_check(&arguments->raster, &error)) return usage(error.text, "");
    arguments->raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

/* ---- the work ---- */

static enum scree_status tell(const struct arguments *arguments, const struct filter_job *job,
                              struct scree_error *error) {
    struct text text = {0};
    size_t length_bytes;
    if (arguments->output != NULL) text_add(&text, "%s: ", arguments->output);
    filter_job_describe(job, &arguments->raster.filter, &text);
    char *lines = text_take(&text, &length_bytes);
    if (lines == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for words");
    fputs(lines, stdout);
    free(lines);
    return SCREE_OK;
}

static enum scree_status draw(const struct arguments *arguments, struct filter_job *job, struct scree_error *error) {
    const double delta_m = filter_context(&arguments->raster.filter).delta_m;
    const struct filter_difference difference = {job->posts.heights_m, job->filtered_m, job->raster.is_outside,
                                                 job->posts.columns,   job->posts.rows, delta_m > 0 ? delta_m : 1};
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
static enum scree_status report(const struct arguments *arguments, struct filter_job *job, struct scree_error *error) {
    struct text text = {0};
    size_t length_bytes;
    const struct context_options context = filter_context(&arguments->raster.filter);
    enum scree_status status = filter_report(&job->memory, &job->posts, &context, job->filtered_m, &text, error);
    char *tables = text_take(&text, &length_bytes);
    if (status == SCREE_OK && tables == NULL) status = scree_fail(error, SCREE_E_MEMORY, "no memory for the tables");
    if (status == SCREE_OK) fputs(tables, stdout);
    free(tables);
    return status;
}

static enum scree_status filter(const struct arguments *arguments, struct filter_job *job, struct scree_error *error) {
    enum scree_status status = filter_job_run(&arguments->raster, job, error);
    if (status == SCREE_OK && arguments->output != NULL)
        status = filter_raster_write(&job->raster, job->filtered_m, arguments->output, error);
    if (status == SCREE_OK && arguments->difference != NULL) status = draw(arguments, job, error);
    if (status == SCREE_OK && !arguments->quiet) status = tell(arguments, job, error);
    if (status == SCREE_OK && arguments->reports) status = report(arguments, job, error);
    return status;
}

static int run(const struct arguments *arguments) {
    struct scree_error error = {0};
    struct filter_job job = {0};
    enum scree_status status = filter(arguments, &job, &error);
    filter_job_free(&job);
    if (status == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree filter: %s\n", error.text);
    return EXIT_FAILED;
}

int command_filter(int argc, char **argv) {
    struct arguments arguments = {.raster = {.nodata_height_m = FILTER_NO_HEIGHT_M}};
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
