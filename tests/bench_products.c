#include "tests/bench_stream.h"

#include <fcntl.h>
#include <ftw.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

#define TARGET_RATIO 0.6

enum { PATH_BYTES = 512 };

/* A file of the test data, or a fractal of so many posts. */
static const struct product_case {
    const char *name, *file, *size, *profile;
} cases[] = {
    {"Big Tujunga 30 m, local", "bigtujunga_srtm30m_utm11.tif", NULL, "local"},
    {"Big Tujunga 30 m, geodetic", "bigtujunga_srtm30m_utm11.tif", NULL, "geodetic"},
    {"Mount Rainier 90 m, geodetic", "large/rainier_srtm3_1201.tif", NULL, "geodetic"},
    {"fractal 1024 x 1024, local", NULL, "1024", "local"},
};

static uint64_t found_bytes; /* nftw has no context */

static int add_file(const char *path, const struct stat *about, int kind, struct FTW *place) {
    (void)place;
    const char *dot = strrchr(path, '.');
    if (kind == FTW_F && dot != NULL && strcmp(dot, ".json") != 0) found_bytes += (uint64_t)about->st_size;
    return 0;
}

/* Bytes of all tiles below a folder. */
static uint64_t tile_bytes(const char *out, const char *product) {
    char path[PATH_BYTES + 16];
    snprintf(path, sizeof path, "%s/%s", out, product);
    found_bytes = 0;
    return nftw(path, add_file, 16, FTW_PHYS) == 0 ? found_bytes : 0;
}

/* Runs a program to its end; false, with a line, unless it exits with 0. Its standard output is not shown. */
static bool run(const char *const arguments[]) {
    pid_t child;
    int status = 1;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    int failure = posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    fprintf(stderr, "bench_stream: %s %s did not succeed\n", arguments[0], arguments[1]);
    return false;
}

static bool bench_case(const struct product_case *product, const char *folder, const char *data) {
    char raster[PATH_BYTES], out[PATH_BYTES];
    snprintf(out, sizeof out, "%s/out", folder);
    if (product->file != NULL)
        snprintf(raster, sizeof raster, "%s/%s", data, product->file);
    else
        snprintf(raster, sizeof raster, "%s/fractal.tif", folder);
    const char *fractal[] = {"tests/fractal_dem", "-o", raster, "--size", product->size, "--epsg", "32611", NULL};
    const char *build[] = {"./scree",          "build", raster, "-o", out, "-q", "--profile", product->profile,
                           "--finest-octaves", "0",     NULL};
    const char *bare[] = {"./scree",
                          "build",
                          raster,
                          "-o",
                          out,
                          "-q",
                          "--products",
                          "terrain",
                          "--profile",
                          product->profile,
                          "--finest-octaves",
                          "0",
                          "--no-normals",
                          NULL};
    const char *clear[] = {"rm", "-rf", out, product->size != NULL ? raster : NULL, NULL};
    if (product->file != NULL && access(raster, R_OK) != 0) {
        printf("%s: left out, %s is not there (SCREE_TEST_DATA names the folder)\n", product->name, raster);
        return true;
    }
    bool fine = (product->size == NULL || run(fractal)) && run(build);
    uint64_t streams = tile_bytes(out, "stream"), terrain = tile_bytes(out, "terrain");
    fine = fine && run(bare);
    if (fine) {
        uint64_t without_normals = tile_bytes(out, "terrain");
        double ratio = (double)streams / (double)terrain;
        printf("%-30s %10llu %10llu %7.3f  %s %10llu %7.3f\n", product->name, (unsigned long long)streams,
               (unsigned long long)terrain, ratio, ratio <= TARGET_RATIO ? "kept  " : "missed",
               (unsigned long long)without_normals, (double)streams / (double)without_normals);
    }
    return run(clear) && fine;
}

bool bench_products(const char *folder, const char *data) {
    bool fine = true;
    printf("\nAll zooms of a build with --finest-octaves 0\n%-30s %10s %10s %7s  %6s %10s %7s\n", "", "streams",
           "terrain", "ratio", "", "no normals", "ratio");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) fine = bench_case(&cases[i], folder, data) && fine;
    return fine;
}
