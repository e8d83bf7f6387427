/* scree build: elevation in, crack-free terrain out. */
#include "src/build.h"
#include "src/command.h"
#include "src/methods.h"
#include "src/progress_io.h"
#include "src/raster_arguments.h"

#include <cpl_conv.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define EXIT_INTERRUPTED 130
#define MAX_THREADS      256
#define MAX_BLOCK        1000000

static const char help[] =
    "Usage: scree build DEM... -o OUT [OPTION]...\n"
    "Makes OUT/terrain, a pyramid of quantized-mesh tiles, and OUT/stream, the same tiles at every scale as streams "
    "of\n"
    "detail increments, from rasters that GDAL reads, point clouds or mesh files; later rasters lie on top.\n"
    "The same input and options give the same bytes on any number of threads.\n\n"
    "  -o OUT               folder to write to; an earlier build in it is replaced\n"
    "  --profile NAME       geodetic (default; EPSG:4326, for Cesium) or local (the raster's own CRS and pixels)\n"
    "  --max-zoom Z         finest zoom; default: the first that is as fine as the source\n"
    "  --min-zoom Z         coarsest zoom that is written, default 0 (Cesium needs 0)\n"
    "  --error M            largest vertical error in metres at zoom 0, halving with each zoom;\n"
    "                       default: an eighth of Cesium's level error, 9633\n"
    "  --error-at Z=M       the same for one zoom; may be given for several\n"
    "  --products LIST      terrain, stream or terrain,stream (default); what is not named is left as it is\n"
    "  --finest-octaves N   how often the finest zoom halves its error below that of its static tile, 0 to 8,\n"
    "                       default 2, for TINs as often as their heights are exact; both products are made of\n"
    "                       meshes that come from there\n"
    "  --lossless           streams end with every post; heights that are no multiple of the heights' step, which\n"
    "                       is a power of two of at most 1 m, are rounded to it\n"
    "  --rungs-per-increment N   rungs that each increment of a stream spans, default 1\n"
    "  --block N            most points of a sub-block that a TIN is cut into, default 8192\n"
    "  --base WHAT          mesh that a TIN's streams end with: 20% (default) of its triangles, 5000 of them, or the\n"
    "                       first with an SVO of 0.5m\n"
    "  --fit                static tiles are fitted to the posts by least squares, within the same error: fewer\n"
    "                       triangles, and closer in the mean; streams stay as they are\n"
    "  --method NAME        static tiles by a method of the literature, without streams; list names them all\n"
    "  --method-option NAME=VALUE   an option of it: 50, a list by zoom 0:50,5:20, or 400/2 or 4*2, which halve or\n"
    "                       double from zoom 0 on; may be given for several\n"
    "  --no-normals         leave out the octvertexnormals extension\n"
    "  --plain              no gzip: for servers that do not send Content-Encoding\n"
    "  -j N                 threads, default all cores\n"
    "  -q                   say nothing but errors\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_ARGUMENTS_HELP;

struct arguments {
    struct build_options build;
    const char **inputs;
    const char *method_name, **method_settings;
    int method_setting_count;
    struct method_choice method;
    bool has_products, lists_methods, quiet;
};

static volatile sig_atomic_t stop_asked;

static void ask_to_stop(int signal_number) {
    (void)signal_number;
    stop_asked = 1;
}

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree build: %s%s; scree build --help tells how\n", what, argument);
    return EXIT_USAGE;
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

static bool take_products(const char *text, struct build_options *build) {
    bool terrain = strcmp(text, "terrain") == 0, stream = strcmp(text, "stream") == 0;
    bool both = strcmp(text, "terrain,stream") == 0 || strcmp(text, "stream,terrain") == 0;
    build->no_terrain = stream;
    build->no_stream = terrain;
    return terrain || stream || both;
}

static bool take_count(const char *text, int least, int most, uint32_t *count) {
    int value;
    if (!argument_integer(text, least, most, &value)) return false;
    *count = (uint32_t)value;
    return true;
}

static bool take_profile(const char *text, enum profile *profile) {
    *profile = strcmp(text, "local") == 0 ? PROFILE_LOCAL : PROFILE_GEODETIC;
    return *profile == PROFILE_LOCAL || strcmp(text, "geodetic") == 0;
}

/* Options that have a value; NULL when the value is fine, else what is wanted. "" when there is no such option. */
static const char *take_valued(const char *name, const char *value, struct build_options *build) {
    if (strcmp(name, "-o") == 0) return build->out = value, NULL;
    if (strcmp(name, "--profile") == 0)
        return take_profile(value, &build->raster.profile) ? NULL : "--profile wants geodetic or local, not ";
    if (strcmp(name, "--max-zoom") == 0)
        return argument_integer(value, 0, MAX_ZOOM, &build->max_zoom) ? NULL : "--max-zoom wants 0 to 22, not ";
    if (strcmp(name, "--min-zoom") == 0)
        return argument_integer(value, 0, MAX_ZOOM, &build->min_zoom) ? NULL : "--min-zoom wants 0 to 22, not ";
    if (strcmp(name, "--error") == 0)
        return argument_number(value, &build->ladder.root_error_m) && build->ladder.root_error_m > 0
                   ? NULL
                   : "--error wants metres above 0, not ";
    if (strcmp(name, "--error-at") == 0)
        return take_error_at(value, &build->ladder) ? NULL : "--error-at wants ZOOM=METRES, not ";
    if (strcmp(name, "--products") == 0)
        return take_products(value, build) ? NULL : "--products wants terrain, stream or terrain,stream, not ";
    if (strcmp(name, "--finest-octaves") == 0)
        return argument_integer(value, 0, MAX_FINEST_OCTAVES, &build->ladder.finest_octaves)
                   ? NULL
                   : "--finest-octaves wants 0 to 8, not ";
    if (strcmp(name, "--rungs-per-increment") == 0)
        return take_count(value, 1, SCREE_MAX_RUNGS, &build->rungs_per_increment)
                   ? NULL
                   : "--rungs-per-increment wants 1 to 256, not ";
    if (strcmp(name, "--block") == 0)
        return build->tin_option = name, take_count(value, 100, MAX_BLOCK, &build->block_points)
                                             ? NULL
                                             : "--block wants 100 to 1000000 points, not ";
    if (strcmp(name, "--base") == 0)
        return build->tin_option = name, base_parse(value, &build->base)
                                             ? NULL
                                             : "--base wants 20%, a number of triangles, or an SVO as 0.5m, not ";
    if (strcmp(name, "-j") == 0)
        return argument_integer(value, 1, MAX_THREADS, &build->threads) ? NULL : "-j wants 1 to 256 threads, not ";
    return "";
}

/* Methods and their options are looked at when all are there; false when it is neither, or there is no value. */
static bool take_method(const char *name, const char *value, struct arguments *arguments) {
    bool is_option = strcmp(name, "--method-option") == 0;
    if (value == NULL || (!is_option && strcmp(name, "--method") != 0)) return false;
    if (is_option)
        arguments->method_settings[arguments->method_setting_count++] = value;
    else
        arguments->method_name = value;
    return true;
}

static int choose_method(struct arguments *arguments) {
    struct scree_error error = {0};
    const char *name = arguments->method_name;
    if (name == NULL && arguments->method_setting_count > 0)
        return usage("which method? Name it with --method, for --method-option ", arguments->method_settings[0]);
    if (name == NULL && arguments->build.fits && arguments->build.no_terrain)
        return usage("--fit is for static tiles: ask for --products with terrain", "");
    if (name == NULL) return EXIT_DONE;
    if (arguments->build.fits) return usage("--fit is for Scree's own way, not for --method ", name);
    arguments->lists_methods = strcmp(name, "list") == 0;
    if (arguments->lists_methods) return EXIT_DONE;
    enum scree_status status = method_choose(name, &arguments->method, &error);
    for (int i = 0; i < arguments->method_setting_count && status == SCREE_OK; i++)
        status = method_set(&arguments->method, arguments->method_settings[i], &error);
    if (status != SCREE_OK) return usage(error.text, "");
    arguments->build.method = &arguments->method;
    if (!arguments->has_products) arguments->build.no_stream = true;
    if (!arguments->build.no_stream)
        return usage("a method makes static tiles only: ask for --products terrain with --method ", name);
    return EXIT_DONE;
}

/* One argument that is not about reading rasters; EXIT_DONE or the code to exit with. */
static int take(int argc, char **argv, int *at, struct arguments *arguments) {
    const char *name = argv[(*at)++], *value = *at < argc ? argv[*at] : NULL;
    if (strcmp(name, "-q") == 0) return arguments->quiet = true, EXIT_DONE;
    if (strcmp(name, "--plain") == 0) return arguments->build.plain = true, EXIT_DONE;
    if (strcmp(name, "--lossless") == 0) return arguments->build.ladder.lossless = true, EXIT_DONE;
    if (strcmp(name, "--fit") == 0) return arguments->build.fits = true, EXIT_DONE;
    if (strcmp(name, "--no-normals") == 0) return arguments->build.no_normals = true, EXIT_DONE;
    if (strcmp(name, "--config") == 0) {
        if (*at + 1 >= argc) return usage("--config wants a key and a value", "");
        CPLSetConfigOption(argv[*at], argv[*at + 1]);
        *at += 2;
        return EXIT_DONE;
    }
    if (name[0] != '-' || name[1] == '\0') {
        arguments->inputs[arguments->build.raster.input_count++] = name;
        return EXIT_DONE;
    }
    if (strncmp(name, "-j", 2) == 0 && name[2] != '\0') { /* -j4, as make has it */
        const char *wanted = take_valued("-j", name + 2, &arguments->build);
        return wanted == NULL ? EXIT_DONE : usage(wanted, name + 2);
    }
    if (strncmp(name, "--method", 8) == 0 && take_method(name, value, arguments)) return ++*at, EXIT_DONE;
    if (strcmp(name, "--products") == 0) arguments->has_products = true;
    const char *wanted = take_valued(name, value != NULL ? value : "", &arguments->build);
    bool is_method = strcmp(name, "--method") == 0 || strcmp(name, "--method-option") == 0;
    if (wanted != NULL && wanted[0] == '\0' && !is_method) return usage("there is no option ", name);
    if (value == NULL) return usage("a value is missing behind ", name);
    if (wanted != NULL) return usage(wanted, value);
    ++*at;
    return EXIT_DONE;
}

static int parse(int argc, char **argv, struct arguments *arguments) {
    for (int at = 1; at < argc;) {
        struct scree_error error = {0};
        enum argument_result taken = raster_argument_take(argc, argv, &at, &arguments->build.raster, &error);
        if (taken == ARGUMENT_WRONG) return usage(error.text, "");
        if (taken == ARGUMENT_TAKEN) continue;
        int code = take(argc, argv, &at, arguments);
        if (code != EXIT_DONE) return code;
    }
    struct scree_error error = {0};
    if (!raster_arguments_check(&arguments->build.raster, &error)) return usage(error.text, "");
    int code = choose_method(arguments);
    if (code != EXIT_DONE || arguments->lists_methods) return code;
    if (arguments->build.raster.input_count == 0) return usage("which DEM? Name one raster or several", "");
    if (arguments->build.out == NULL) return usage("where to? Name a folder with -o", "");
    arguments->build.raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

static void tell_tile(void *context, uint32_t done, uint32_t in_all) {
    progress_tell(context, done, in_all);
}

static void print_tin(const struct build *build) {
    const struct tin_source *tin = &build->tin;
    fprintf(stderr, "a TIN of %u points and %u triangles, in steps of %g, cut at zoom %d\n",
            (unsigned)tin->placed.point_count, (unsigned)tin->placed.triangle_count, tin->lattice.spacing_x,
            tin->leaf_zoom);
    if (tin->mended.welded + tin->mended.dropped + tin->mended.turned + tin->mended.unused > 0)
        fprintf(stderr, "mended: %u points welded, %u triangles dropped, %u turned, %u points without triangles\n",
                (unsigned)tin->mended.welded, (unsigned)tin->mended.dropped, (unsigned)tin->mended.turned,
                (unsigned)tin->mended.unused);
}

static void print_plan(const struct build *build, bool has_streams) {
    const struct raster_summary *summary = build_summary(build);
    int finest = build->ladder.finest_zoom;
    if (build->is_tin) print_tin(build);
    if (summary->filtered != NULL) fprintf(stderr, "filtered: %s", summary->filtered);
    fprintf(stderr, "%.6g to %.6g m; %s\n", summary->height_min_m, summary->height_max_m, summary->datum);
    fprintf(stderr, "finest zoom %d, largest error there %.4g m\n", finest, build->ladder.tolerance_m[finest]);
    if (!has_streams) return;
    fprintf(stderr, "finest rung %d, %s%.4g m; heights in steps of %.4g m\n", build->ladder.finest_rung,
            build->is_tin            ? "the whole TIN; the one before: "
            : build->ladder.lossless ? "every post; the one before: "
                                     : "largest error there ",
            ladder_rung_tolerance_m(&build->ladder, build->ladder.finest_rung), build->ladder.height_unit_m);
}

static void print_terrain(const struct build *build, int min_zoom) {
    printf("zoom    tiles  vertices  triangles      bytes  tolerance m  max error m    SVO m\n");
    for (int zoom = min_zoom; zoom <= build->max_zoom; zoom++) {
        const struct layer_zoom *sum = &build->zooms[zoom];
        printf("%4d %8u %9llu %10llu %10llu %12.5g %12.5g %8.4g\n", zoom, sum->tile_count,
               (unsigned long long)sum->vertices, (unsigned long long)sum->triangles, (unsigned long long)sum->bytes,
               sum->tolerance_m, sum->max_error_m, sum->svo_m);
    }
}

static void print_streams(const struct build *build) {
    printf("zoom    tiles rungs         vertices                 bytes  max error m          SVO m\n");
    for (int zoom = build->stream_min_zoom; zoom <= build->max_zoom; zoom++) {
        const struct stream_zoom *sum = &build->streams[zoom];
        printf("%4d %8u %3d..%-3d %9llu..%-10llu %10llu %8.4g..%-8.4g %8.4g..%-8.4g\n", zoom, sum->tile_count,
               sum->coarsest.rung, sum->finest.rung, (unsigned long long)sum->coarsest.vertices,
               (unsigned long long)sum->finest.vertices, (unsigned long long)sum->bytes, sum->coarsest.error_max_m,
               sum->finest.error_max_m, sum->coarsest.svo_max_m, sum->finest.svo_max_m);
    }
}

static void print_result(const struct build *build, const struct build_options *options, double seconds) {
    if (!options->no_terrain) print_terrain(build, options->min_zoom);
    if (!options->no_stream) print_streams(build);
    double posts = (double)TILE_CELLS * TILE_CELLS * build->pyramid.zooms[build->ladder.finest_zoom].tiles.count;
    if (build->is_tin) posts = build->tin.placed.point_count;
    printf("%s: %.1f s, %.2f million %s a second\n", options->out, seconds, posts * 1e-6 / seconds,
           build->is_tin ? "points" : "posts");
}

static void print_methods(void) {
    for (const struct method *method = method_table; method->name != NULL; method++) {
        printf("%s: %s\n", method->name, method->what);
        for (int i = 0; i < method->option_count; i++)
            printf("    %-8s %s (%g to %g)\n", method->options[i].name, method->options[i].what,
                   method->options[i].least, method->options[i].most);
    }
}

static int run(const struct arguments *arguments) {
    struct scree_error error = {0};
    struct build build = {0};
    struct progress progress;
    enum scree_status status = build_prepare(&arguments->build, &build, &error);
    if (status == SCREE_OK) {
        if (!arguments->quiet) print_plan(&build, !arguments->build.no_stream);
        double posts = build.is_tin ? 0 : (double)TILE_CELLS * TILE_CELLS; /* of tiles of a TIN, who knows */
        progress_start(&progress, "tiles", posts, arguments->quiet);
        struct pyramid_options watch = {.stop = &stop_asked, .progress = tell_tile, .progress_context = &progress};
        status = build_run(&arguments->build, &watch, &build, &error);
        double seconds = progress_end(&progress);
        if (status == SCREE_OK && !arguments->quiet) print_result(&build, &arguments->build, seconds);
    }
    build_release(&build);
    if (status == SCREE_OK) return EXIT_DONE;
    if (stop_asked) {
        fprintf(stderr, "scree build: interrupted; the tiles that are there are whole, no manifest is written\n");
        return EXIT_INTERRUPTED;
    }
    fprintf(stderr, "scree build: %s\n", error.text);
    return EXIT_FAILED;
}

int command_build(int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0) return fputs(help, stdout) < 0 ? EXIT_FAILED : EXIT_DONE;
    struct arguments arguments = {
        .build = {.max_zoom = ZOOM_FROM_SOURCE, .ladder = {.finest_octaves = FINEST_OCTAVES_UNSAID}}};
    arguments.build.threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (arguments.build.threads < 1) arguments.build.threads = 1;
    arguments.inputs = calloc((size_t)argc, sizeof *arguments.inputs);
    arguments.method_settings = calloc((size_t)argc, sizeof *arguments.method_settings);
    int code = EXIT_FAILED;
    if (arguments.inputs == NULL || arguments.method_settings == NULL) {
        fprintf(stderr, "scree build: no memory for the arguments\n");
        goto cleanup;
    }
    if ((code = parse(argc, argv, &arguments)) != EXIT_DONE) goto cleanup;
    if (arguments.lists_methods) {
        print_methods();
    } else {
        struct sigaction action = {.sa_handler = ask_to_stop, .sa_flags = SA_RESETHAND}; /* a second one kills */
        sigaction(SIGINT, &action, NULL);
        sigaction(SIGTERM, &action, NULL);
        code = run(&arguments);
    }
cleanup:
    free(arguments.method_settings);
    free(arguments.inputs);
    return code;
}
