/* scree compare: the methods of the literature side by side, on tiles of one's own data. */
#include "src/command.h"
#include "src/compare_job_io.h"
#include "src/progress_io.h"
#include "src/raster_arguments.h"

#include <cpl_conv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_PICTURE_PX 480
#define MOST_TRIANGLES     131072 /* of a tile: two a cell */

static const char help[] =
    "Usage: scree compare DEM... -o DIR [OPTION]...\n"
    "Runs methods on every tile that is full of data and measures what they make: CPU time, vertices, triangles, the\n"
    "symmetric Hausdorff distance in space, the exact largest and RMS vertical error over all posts, bytes of the\n"
    "static tile. Writes DIR/compare.md, compare.csv (a line a method and zoom), tiles.csv (a line a tile), charts\n"
    "and pictures of the meshes. scree build --method list tells which methods there are.\n\n"
    "  -o DIR               folder to write to\n"
    "  --methods LIST       methods with commas between them, default: all; LABEL=METHOD gives one another name, and\n"
    "                       lets it come twice, with other options\n"
    "  --method-option METHOD:NAME=VALUE   an option of one of them, as of scree build\n"
    "  --zooms LIST         zooms with commas between them, or FIRST-LAST; default: all that have full tiles\n"
    "  --triangles LIST     as many triangles a tile, to 2 %, whatever the method: its first option is chosen so, or\n"
    "                       the one whose VALUE is ?; several numbers, with commas, make curves\n"
    "  --profile NAME       geodetic (default) or local (the raster's own CRS and pixels)\n"
    "  --max-zoom Z         finest zoom; default: the first that is as fine as the source\n"
    "  --error M            tolerance in metres at zoom 0, halving with each zoom: of the borders, and of methods "
    "that\n"
    "                       take it; default as of scree build\n"
    "  --error-at Z=M       the same for one zoom; may be given for several\n"
    "  --seed N             of the sample points of the Hausdorff distance, default 1\n"
    "  --picture-px N       side of the pictures' views, 16 to 4096, default 480; 0: no pictures\n"
    "  --format json        print for machines in place of the table\n"
    "  -q                   print nothing but errors\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_ARGUMENTS_HELP;

struct arguments {
    struct compare_options compare;
    const char **inputs, **method_options;
    int method_option_count;
    bool as_json, quiet;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree compare: %s%s; scree compare --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* ---- lists ---- */

/* Copies what stands before the next comma; false when it is empty or too long. */
static bool take_item(const char **list, char *item, size_t room) {
    size_t length = strcspn(*list, ",");
    if (length == 0 || length >= room) return false;
    memcpy(item, *list, length);
    item[length] = '\0';
    *list += length;
    if (**list == ',' && (*list)[1] != '\0') ++*list;
    return true;
}

static enum scree_status take_methods(const char *list, struct compare_options *options, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (options->method_count = 0; *list != '\0' && status == SCREE_OK; options->method_count++) {
        char name[sizeof options->names[0]], *method;
        int at = options->method_count;
        if (at == COMPARE_MOST_METHODS || !take_item(&list, name, sizeof name))
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "--methods wants up to %d names with commas between them, not %s", COMPARE_MOST_METHODS,
                              list);
        if ((method = strchr(name, '=')) != NULL) *method++ = '\0'; /* LABEL=METHOD */
        if (name[strcspn(name, ":/")] != '\0' || name[0] == '\0')
            return scree_fail(error, SCREE_E_ARGUMENT, "--methods wants names without : and /, not %s", name);
        for (int i = 0; i < at; i++)
            if (strcmp(options->names[i], name) == 0)
                return scree_fail(error, SCREE_E_ARGUMENT, "--methods names %s twice", name);
        memcpy(options->names[at], name, sizeof name);
        status = method_choose(method != NULL ? method : name, &options->methods[at], error);
    }
    return status;
}

static void take_all_methods(struct compare_options *options) {
    for (const struct method *method = method_table;
         method->name != NULL && options->method_count < COMPARE_MOST_METHODS; method++) {
        int at = options->method_count++;
        options->methods[at] = (struct method_choice){.method = method};
        snprintf(options->names[at], sizeof options->names[at], "%s", method->name);
    }
}

static bool take_zooms(const char *list, struct compare_options *options) {
    options->zooms_are_named = *list != '\0';
    while (*list != '\0') {
        char item[16], *dash;
        int first, last;
        if (!take_item(&list, item, sizeof item)) return false;
        if ((dash = strchr(item, '-')) != NULL) *dash = '\0';
        if (!argument_integer(item, 0, MAX_ZOOM, &first)) return false;
        last = first;
        if (dash != NULL && (!argument_integer(dash + 1, 0, MAX_ZOOM, &last) || last < first)) return false;
        for (int zoom = first; zoom <= last; zoom++) options->zooms[zoom] = true;
    }
    return options->zooms_are_named;
}

static bool take_counts(const char *list, struct compare_options *options) {
    for (options->count_count = 0; *list != '\0'; options->count_count++) {
        char item[16];
        int count;
        if (options->count_count == COMPARE_MOST_COUNTS || !take_item(&list, item, sizeof item)) return false;
        if (!argument_integer(item, 2, MOST_TRIANGLES, &count)) return false;
        options->counts[options->count_count] = (uint32_t)count;
        for (int i = 0; i < options->count_count; i++)
            if (options->counts[i] == (uint32_t)count) return false;
    }
    return options->count_count > 0;
}

static bool take_error_at(const char *text, struct ladder_options *ladder) {
    char *end;
    long zoom = strtol(text, &end, 10);
    double error_m;
    if (end == text || *end != '=' || zoom < 0 || zoom > MAX_ZOOM) return false;
    if (!argument_number(end + 1, &error_m) || error_m <= 0) return false;
    ladder->error_at_m[zoom] = error_m;
    return true;
}

/* NAME=? of one of the methods: what is looked for. */
static enum scree_status set_main_option(const char *text, struct compare_options *options, int at,
                                         struct scree_error *error) {
    const struct method *method = options->methods[at].method;
    size_t length = strlen(text) - 2;
    for (int i = 0; i < method->option_count; i++)
        if (strlen(method->options[i].name) == length && strncmp(method->options[i].name, text, length) == 0)
            return options->main_options[at] = i, SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT, "method %s has no option %.*s", method->name, (int)length, text);
}

/* METHOD:NAME=VALUE, once all methods are known. */
static enum scree_status set_option(const char *text, struct compare_options *options, struct scree_error *error) {
    size_t length = strcspn(text, ":=");
    for (int i = 0; i < options->method_count && text[length] == ':'; i++) {
        const char *assignment = text + length + 1;
        size_t equals = strcspn(assignment, "=");
        if (strlen(options->names[i]) != length || strncmp(options->names[i], text, length) != 0) continue;
        return strcmp(assignment + equals, "=?") == 0 ? set_main_option(assignment, options, i, error)
                                                      : method_set(&options->methods[i], assignment, error);
    }
    if (text[length] != ':')
        return scree_fail(error, SCREE_E_ARGUMENT, "--method-option wants METHOD:NAME=VALUE, not %s", text);
    return scree_fail(error, SCREE_E_ARGUMENT, "--method-option %s: %.*s is not among the methods compared", text,
                      (int)length, text);
}

/* ---- the command line ---- */

/* Options that have a value; NULL when the value is fine, else what is wanted. "" when there is no such option. */
static const char *take_valued(const char *name, const char *value, struct arguments *arguments) {
    struct compare_options *options = &arguments->compare;
    int number = 0;
    if (strcmp(name, "-o") == 0) return options->build.out = value, NULL;
    if (strcmp(name, "--zooms") == 0)
        return take_zooms(value, options) ? NULL
                                          : "--zooms wants 0 to 22 with commas between them, or FIRST-LAST, not ";
    if (strcmp(name, "--triangles") == 0)
        return take_counts(value, options) ? NULL
                                           : "--triangles wants up to 16 different numbers from 2 to 131072, not ";
    if (strcmp(name, "--profile") == 0) {
        options->build.raster.profile = strcmp(value, "local") == 0 ? PROFILE_LOCAL : PROFILE_GEODETIC;
        bool is_known = strcmp(value, "local") == 0 || strcmp(value, "geodetic") == 0;
        return is_known ? NULL : "--profile wants geodetic or local, not ";
    }
    if (strcmp(name, "--max-zoom") == 0)
        return argument_integer(value, 0, MAX_ZOOM, &options->build.max_zoom) ? NULL : "--max-zoom wants 0 to 22, not ";
    if (strcmp(name, "--error") == 0)
        return argument_number(value, &options->build.ladder.root_error_m) && options->build.ladder.root_error_m > 0
                   ? NULL
                   : "--error wants metres above 0, not ";
    if (strcmp(name, "--error-at") == 0)
        return take_error_at(value, &options->build.ladder) ? NULL : "--error-at wants ZOOM=METRES, not ";
    if (strcmp(name, "--seed") == 0) {
        if (!argument_integer(value, 0, INT32_MAX, &number)) return "--seed wants a whole number from 0, not ";
        return options->seed = (uint64_t)number, NULL;
    }
    if (strcmp(name, "--picture-px") == 0) {
        if (!argument_integer(value, 0, 4096, &number) || (number > 0 && number < 16))
            return "--picture-px wants 0 or 16 to 4096, not ";
        return options->picture_px = (uint32_t)number, NULL;
    }
    if (strcmp(name, "--format") == 0) {
        arguments->as_json = strcmp(value, "json") == 0;
        return arguments->as_json || strcmp(value, "text") == 0 ? NULL : "--format wants text or json, not ";
    }
    return "";
}

/* One argument that is not about reading rasters; EXIT_DONE or the code to exit with. */
static int take(int argc, char **argv, int *at, struct arguments *arguments) {
    const char *name = argv[(*at)++], *value = *at < argc ? argv[*at] : NULL;
    struct scree_error error = {0};
    if (strcmp(name, "-q") == 0) return arguments->quiet = true, EXIT_DONE;
    if (strcmp(name, "--config") == 0) {
        if (*at + 1 >= argc) return usage("--config wants a key and a value", "");
        CPLSetConfigOption(argv[*at], argv[*at + 1]);
        *at += 2;
        return EXIT_DONE;
    }
    if (name[0] != '-' || name[1] == '\0') {
        arguments->inputs[arguments->compare.build.raster.input_count++] = name;
        return EXIT_DONE;
    }
    const char *wanted = NULL;
    if (strcmp(name, "--methods") == 0 && value != NULL) {
        if (*value == '\0') return usage("--methods wants names with commas between them", "");
        if (take_methods(value, &arguments->compare, &error) != SCREE_OK) return usage(error.text, "");
    } else if (strcmp(name, "--method-option") == 0 && value != NULL) {
        arguments->method_options[arguments->method_option_count++] = value;
    } else if (strncmp(name, "--method", 8) != 0) {
        wanted = take_valued(name, value != NULL ? value : "", arguments);
    } else if (strcmp(name, "--methods") != 0 && strcmp(name, "--method-option") != 0) {
        wanted = "";
    }
    if (wanted != NULL && wanted[0] == '\0') return usage("there is no option ", name);
    if (value == NULL) return usage("a value is missing behind ", name);
    if (wanted != NULL) return usage(wanted, value);
    ++*at;
    return EXIT_DONE;
}

static int parse(int argc, char **argv, struct arguments *arguments) {
    struct compare_options *options = &arguments->compare;
    struct scree_error error = {0};
    for (int at = 1; at < argc;) {
        enum argument_result taken = raster_argument_take(argc, argv, &at, &options->build.raster, &error);
        if (taken == ARGUMENT_WRONG) return usage(error.text, "");
        if (taken == ARGUMENT_TAKEN) continue;
        int code = take(argc, argv, &at, arguments);
        if (code != EXIT_DONE) return code;
    }
    if (!raster_arguments_check(&options->build.raster, &error)) return usage(error.text, "");
    if (options->build.raster.input_count == 0) return usage("which DEM? Name one raster or several", "");
    if (options->build.out == NULL) return usage("where to? Name a folder with -o", "");
    if (options->method_count == 0) take_all_methods(options);
    for (int i = 0; i < arguments->method_option_count; i++)
        if (set_option(arguments->method_options[i], options, &error) != SCREE_OK) return usage(error.text, "");
    options->build.raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

/* ---- the work ---- */

static void tell_tile(void *context, uint32_t done, uint32_t in_all) {
    progress_tell(context, done, in_all);
}

static enum scree_status print(const struct arguments *arguments, const struct compare_report *report,
                               struct scree_error *error) {
    struct text text = {0};
    size_t length_bytes;
    if (arguments->quiet && !arguments->as_json) return SCREE_OK;
    if (!arguments->as_json) compare_add_table(report, &text);
    char *all = arguments->as_json ? compare_json_new(report) : text_take(&text, &length_bytes);
    if (all == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for the report");
    fputs(all, stdout);
    free(all);
    return SCREE_OK;
}

static int run(const struct arguments *arguments) {
    struct scree_error error = {0};
    struct compare_job *job = NULL;
    struct progress progress;
    progress_start(&progress, "tiles", 0, arguments->quiet);
    enum scree_status status = compare_job_run(&arguments->compare, tell_tile, &progress, &job, &error);
    progress_end(&progress);
    if (status == SCREE_OK) status = print(arguments, compare_job_report(job), &error);
    compare_job_free(job);
    if (status == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree compare: %s\n", error.text);
    return EXIT_FAILED;
}

int command_compare(int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0) return fputs(help, stdout) < 0 ? EXIT_FAILED : EXIT_DONE;
    int code = EXIT_FAILED;
    struct arguments *arguments = calloc(1, sizeof *arguments);
    if (arguments != NULL) {
        arguments->compare.build.max_zoom = ZOOM_FROM_SOURCE;
        arguments->compare.build.needs_posts = true;
        arguments->compare.seed = 1;
        arguments->compare.picture_px = DEFAULT_PICTURE_PX;
        arguments->inputs = calloc((size_t)argc, sizeof *arguments->inputs);
        arguments->method_options = calloc((size_t)argc, sizeof *arguments->method_options);
    }
    if (arguments == NULL || arguments->inputs == NULL || arguments->method_options == NULL) {
        fprintf(stderr, "scree compare: no memory for the arguments\n");
    } else {
        code = parse(argc, argv, arguments);
        if (code == EXIT_DONE) code = run(arguments);
    }
    if (arguments != NULL) {
        free(arguments->method_options);
        free(arguments->inputs);
    }
    free(arguments);
    return code;
}
