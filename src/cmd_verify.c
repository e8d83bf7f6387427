/* scree verify: do static tiles and streams keep their promises? */
#include "src/command.h"
#include "src/json_text.h"
#include "src/raster_arguments.h"
#include "src/stream_set_io.h"
#include "src/terrain_set_io.h"
#include "src/verify_against_io.h"
#include "src/verify_print_io.h"
#include "src/verify_stream_against_io.h"
#include "src/verify_stream_io.h"
#include "src/verify_stream_print_io.h"
#include "src/verify_terrain_io.h"

#include <cpl_conv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char help[] =
    "Usage: scree verify OUT [--against DEM...] [OPTION]...\n"
    "Decodes every static tile, of any producer, and every stream in OUT, and checks what can be checked.\n"
    "Static tiles: the format, the cover of each tile, borders of neighbours, layer.json against the files.\n"
    "Streams: the format to the last byte, triangles at every rung, borders of neighbours at every rung that both "
    "have,\n"
    "each tile at its finest rung against its children at their coarsest, scree.json against headers and files.\n"
    "With --against the vertical error as well. Exits 1 when a promise is broken.\n\n"
    "  --against DEM...     measure against the rasters, clouds or meshes that the terrain was built from: every zoom\n"
    "                       of static tiles, every rung of every stream, at every post or every point\n"
    "  --format json        for machines; streams are the member \"streams\"\n"
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
            return usage("--against wants what the terrain was built from", "");
    }
    struct scree_error error = {0};
    if (!raster_arguments_check(&arguments->raster, &error)) return usage(error.text, "");
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

/* What was looked at, and what was found. */
struct terrain_findings {
    bool is_there;
    struct terrain_set set;
    struct verify_report report;
    struct against against;
};

struct stream_findings {
    bool is_there;
    struct stream_set set;
    struct verify_report report;
    struct stream_against against;
};

struct findings {
    struct scree_memory memory;
    struct terrain_findings terrain;
    struct stream_findings streams;
};

static enum scree_status verify_terrain_in(const struct arguments *arguments, verify_progress *progress,
                                           struct scree_memory *memory, struct terrain_findings *found,
                                           struct scree_error *error) {
    enum scree_status status = terrain_set_open(memory, arguments->path, &found->set, error);
    if (status != SCREE_OK) return status;
    found->is_there = true;
    status = verify_terrain(memory, &found->set, progress, "checking tiles", &found->report, error);
    end_progress(progress);
    if (status != SCREE_OK || arguments->raster.input_count == 0) return status;
    status = verify_against(memory, &found->set, arguments->raster, progress, "measuring", &found->against, error);
    end_progress(progress);
    if (status == SCREE_OK) verify_against_judge(&found->set, &found->against, &found->report);
    return status;
}

static enum scree_status verify_streams_in(const struct arguments *arguments, verify_progress *progress,
                                           struct scree_memory *memory, struct stream_findings *found,
                                           struct scree_error *error) {
    enum scree_status status = stream_set_open(memory, arguments->path, &found->set, error);
    if (status != SCREE_OK) return status;
    found->is_there = true;
    status = verify_streams(memory, &found->set, progress, "checking streams", &found->report, error);
    end_progress(progress);
    if (status != SCREE_OK || arguments->raster.input_count == 0) return status;
    status = verify_streams_against(memory, &found->set, arguments->raster, progress, "measuring streams",
                                    &found->against, &found->report, error);
    end_progress(progress);
    return status;
}

static bool all_hold(const struct findings *found) {
    return report_broken_promises(&found->terrain.report) == 0 && report_broken_promises(&found->streams.report) == 0;
}

static void print_text(const struct findings *found, bool quiet) {
    const struct terrain_findings *terrain = &found->terrain;
    const struct stream_findings *streams = &found->streams;
    if (terrain->is_there) verify_print_text(&terrain->set, &terrain->report, &terrain->against, quiet);
    if (terrain->is_there && streams->is_there && !quiet) printf("\n");
    if (streams->is_there) verify_print_streams(&streams->set, &streams->report, &streams->against, quiet);
}

static enum scree_status print_json(const struct findings *found, struct scree_error *error) {
    const struct terrain_findings *terrain = &found->terrain;
    const struct stream_findings *streams = &found->streams;
    struct json_text json = {0};
    json_open(&json, '{');
    json_key(&json, "ok");
    json_boolean(&json, all_hold(found));
    if (terrain->is_there) verify_put_terrain(&json, &terrain->set, &terrain->report, &terrain->against);
    if (streams->is_there) json_key(&json, "streams");
    if (streams->is_there) verify_put_streams(&json, &streams->set, &streams->report, &streams->against);
    json_close(&json, '}');
    char *text = json_text_take(&json);
    if (text == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for the report");
    fputs(text, stdout);
    free(text);
    return SCREE_OK;
}

static enum scree_status verify(const struct arguments *arguments, struct findings *found, struct scree_error *error) {
    const char *path = arguments->path;
    bool has_terrain = product_is_there(path, PRODUCT_TERRAIN), has_streams = product_is_there(path, PRODUCT_STREAM);
    verify_progress *progress = isatty(STDERR_FILENO) && !arguments->quiet ? show_progress : NULL;
    enum scree_status status = SCREE_OK;
    if (!has_terrain && !has_streams) return product_fail_none(path, error);
    if (has_terrain) status = verify_terrain_in(arguments, progress, &found->memory, &found->terrain, error);
    if (has_streams && status == SCREE_OK)
        status = verify_streams_in(arguments, progress, &found->memory, &found->streams, error);
    if (status != SCREE_OK) return status;
    if (arguments->as_json) return print_json(found, error);
    print_text(found, arguments->quiet);
    return SCREE_OK;
}

static void findings_free(struct findings *found) {
    if (found == NULL) return;
    against_free(&found->memory, &found->terrain.against);
    terrain_set_free(&found->memory, &found->terrain.set);
    stream_against_free(&found->memory, &found->streams.against);
    stream_set_free(&found->memory, &found->streams.set);
    free(found);
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
    struct findings *found = calloc(1, sizeof *found);
    if (arguments.inputs == NULL || found == NULL) {
        fputs("scree verify: out of memory\n", stderr);
        goto cleanup;
    }
    code = parse(argc, argv, &arguments);
    if (code != EXIT_DONE) goto cleanup;
    if (verify(&arguments, found, &error) != SCREE_OK) {
        fprintf(stderr, "scree verify: %s\n", error.text);
        code = EXIT_FAILED;
    } else if (!all_hold(found)) {
        code = EXIT_FAILED;
    }
cleanup:
    findings_free(found);
    free(arguments.inputs);
    return code;
}
