/* scree verify: does a terrain product keep its promises? */
#include "src/command.h"
#include "src/raster_arguments.h"
#include "src/terrain_set_io.h"
#include "src/verify_against_io.h"
#include "src/verify_print_io.h"
#include "src/verify_terrain_io.h"

#include <cpl_conv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char help[] =
    "Usage: scree verify OUT [--against DEM...] [OPTION]...\n"
    "Decodes every tile of a terrain product, of any producer, and checks what can be checked: the format, the cover\n"
    "of each tile, borders of neighbours, layer.json against the files; with --against the vertical error as well.\n"
    "Exits 1 when a promise is broken.\n\n"
    "  --against DEM...     measure every zoom against the rasters that the terrain was built from\n"
    "  --format json        for machines\n"
    "  -q                   print nothing but broken promises\n\n"
    "With --against, as they were given to scree build:\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_ARGUMENTS_HELP;

struct arguments {
    const char *path;
    struct raster_options raster;
    const char **inputs;
    bool as_json, quiet;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree verify: %s%s; scree verify --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* EXIT_DONE, or the code to exit with. `inputs` has room for argc names. */
static int parse(int argc, char **argv, struct arguments *arguments) {
    bool in_inputs = false;
    for (int at = 1; at < argc;) {
        const char *argument = argv[at];
        struct scree_error error = {0};
        enum argument_result taken = raster_argument_take(argc, argv, &at, &arguments->raster, &error);
        if (taken == ARGUMENT_WRONG) return usage(error.text, "");
        if (taken == ARGUMENT_TAKEN) {
            in_inputs = false;
            continue;
        }
        at++;
        if (strcmp(argument, "--against") == 0) {
            in_inputs = true;
        } else if (strcmp(argument, "-q") == 0) {
            arguments->quiet = true;
            in_inputs = false;
        } else if (strcmp(argument, "--format") == 0) {
            if (at == argc) return usage("--format wants text or json", "");
            if (strcmp(argv[at], "json") != 0 && strcmp(argv[at], "text") != 0)
                return usage("--format wants text or json, not ", argv[at]);
            arguments->as_json = strcmp(argv[at++], "json") == 0;
            in_inputs = false;
        } else if (strcmp(argument, "--config") == 0) {
            if (argc - at < 2) return usage("--config wants a name and a value", "");
            CPLSetConfigOption(argv[at], argv[at + 1]);
            at += 2;
            in_inputs = false;
        } else if (argument[0] == '-' && argument[1] != '\0') {
            return usage("there is no option ", argument);
        } else if (in_inputs) {
            arguments->inputs[arguments->raster.input_count++] = argument;
        } else if (arguments->path != NULL) {
            return usage("one terrain at a time, and then there is ", argument);
        } else {
            arguments->path = argument;
        }
        if (in_inputs && at == argc && arguments->raster.input_count == 0)
            return usage("--against wants the rasters that the terrain was built from", "");
    }
    if (arguments->path == NULL) return usage("which terrain? Name the folder that was built", "");
    arguments->raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

/* A line that overwrites itself, on a terminal. */
static void show_progress(void *context, double share) {
    fprintf(stderr, "\r%s %3.0f %%", (const char *)context, 100 * share);
}

static void end_progress(verify_progress *progress) {
    if (progress != NULL) fputs("\r\033[K", stderr);
}

static enum scree_status verify(const struct arguments *arguments, struct terrain_set *set,
                                struct verify_report *report, struct scree_error *error) {
    struct scree_memory memory = {0};
    struct against against = {0};
    verify_progress *progress = isatty(STDERR_FILENO) && !arguments->quiet ? show_progress : NULL;
    enum scree_status status = terrain_set_open(&memory, arguments->path, set, error);
    if (status != SCREE_OK) return status;
    status = verify_terrain(&memory, set, progress, "checking tiles", report, error);
    end_progress(progress);
    if (status == SCREE_OK && arguments->raster.input_count > 0) {
        status = verify_against(&memory, set, arguments->raster, progress, "measuring", &against, error);
        end_progress(progress);
        if (status == SCREE_OK) verify_against_judge(set, &against, report);
    }
    if (status == SCREE_OK && arguments->as_json) {
        status = verify_print_json(set, report, &against, error);
    } else if (status == SCREE_OK) {
        verify_print_text(set, report, &against, arguments->quiet);
    }
    against_free(&memory, &against);
    terrain_set_free(&memory, set);
    return status;
}

int command_verify(int argc, char **argv) {
    struct arguments arguments = {0};
    struct scree_error error = {0};
    int code = EXIT_FAILED;
    if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        fputs(help, stdout);
        return EXIT_DONE;
    }
    arguments.inputs = calloc((size_t)argc + 1, sizeof *arguments.inputs);
    struct terrain_set *set = calloc(1, sizeof *set);
    struct verify_report *report = calloc(1, sizeof *report);
    if (arguments.inputs == NULL || set == NULL || report == NULL) {
        fputs("scree verify: out of memory\n", stderr);
        goto cleanup;
    }
    code = parse(argc, argv, &arguments);
    if (code != EXIT_DONE) goto cleanup;
    if (verify(&arguments, set, report, &error) != SCREE_OK) {
        fprintf(stderr, "scree verify: %s\n", error.text);
        code = EXIT_FAILED;
    } else if (report_broken_promises(report) != 0) {
        code = EXIT_FAILED;
    }
cleanup:
    free(report);
    free(set);
    free(arguments.inputs);
    return code;
}
