/* The program `scree`: finds the command by its name and hands the arguments on. */
#include "config.h"
#include "src/command.h"
#include "src/openmesh_version.h"

#include <gdal.h>
#include <proj.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

static const struct command {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *purpose;
} commands[] = {
    {"build", command_build, "elevation in, a pyramid of terrain tiles out"},
    {"verify", command_verify, "check that a terrain keeps its promises"},
    {"info", command_info, "what is in a terrain or a tile"},
    {"extract", command_extract, "a terrain or tile as a mesh file at a scale you choose"},
    {"remesh", command_remesh, "a raster as the mesh that an observer needs, from a quadtree"},
    {"filter", command_filter, "a raster smoothed where nobody looks, for fewer triangles"},
    {"compare", command_compare, "the methods of the literature side by side: error, triangles, time, bytes"},
    {NULL, NULL, NULL},
};

static void print_help(FILE *stream) {
    fputs("Usage: scree COMMAND [OPTION]... [ARGUMENT]...\n"
          "Turns elevation rasters into crack-free progressive terrain.\n\n"
          "Commands:\n",
          stream);
    for (const struct command *command = commands; command->name != NULL; command++)
        fprintf(stream, "  %-10s %s\n", command->name, command->purpose);
    fputs("\n"
          "  --help     this text; scree COMMAND --help tells about one command\n"
          "  --version  the versions of scree and of the libraries it runs with\n\n"
          "Exit codes: 0 done, 1 failed (input, output, or a promise that does not hold), 2 wrong usage.\n",
          stream);
}

static void print_version(void) {
    struct openmesh_version openmesh = openmesh_version();
    printf("scree %s\n", PACKAGE_VERSION);
    printf("GDAL %s\n", GDALVersionInfo("RELEASE_NAME"));
    printf("PROJ %s\n", proj_info().version);
    printf("zlib %s\n", zlibVersion());
    printf("OpenMesh %d.%d.%d\n", openmesh.version, openmesh.major, openmesh.minor);
}

static int dispatch(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_help(stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        print_version();
        return EXIT_DONE;
    }
    for (const struct command *command = commands; command->name != NULL; command++)
        if (strcmp(argv[1], command->name) == 0) return command->run(argc - 1, argv + 1);
    fprintf(stderr, "scree: there is no command '%s'; scree --help lists them\n", argv[1]);
    return EXIT_USAGE;
}

int main(int argc, char **argv) {
    int code = dispatch(argc, argv);
    if (fflush(stdout) != 0 && code == EXIT_DONE) { /* a full disk behind a redirection is a failure too */
        perror("scree: writing to standard output");
        code = EXIT_FAILED;
    }
    return code;
}
