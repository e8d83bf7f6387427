#include "tests/bench_rivals.h"

#include "src/gzip.h"
#include "src/lattice.h"
#include "src/quantized_mesh.h"

#include <cpl_string.h>
#include <fcntl.h>
#include <gdal.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { PATH_BYTES = 512 };

static size_t file_bytes(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 ? (size_t)about.st_size : 0;
}

/* ---- quantized-mesh ---- */

static float *vertex_slopes_new(struct scree_memory *memory, const struct scree_mesh *mesh,
                                const struct slope_grid *grid, struct scree_error *error) {
    float *slopes = scree_allocate(memory, 2 * (size_t)mesh->vertex_count, sizeof *slopes, "slopes", error);
    for (uint32_t v = 0; slopes != NULL && v < mesh->vertex_count; v++) {
        struct slope slope = slope_grid_at(grid, mesh->vertices[v].x, mesh->vertices[v].y);
        slopes[2 * v] = slope.east;
        slopes[2 * v + 1] = slope.north;
    }
    return slopes;
}

enum scree_status rival_quantized_mesh(struct scree_memory *memory, const struct scree_mesh *mesh, int32_t columns,
                                       int32_t rows, int height_exponent, double spacing_m,
                                       const struct slope_grid *slopes, size_t *size_bytes, struct scree_error *error) {
    struct lattice lattice;
    unsigned char *bytes = NULL, *gzip = NULL;
    float *vertex_slopes = NULL;
    size_t plain_bytes;
    enum scree_status status =
        lattice_local(columns + 1, rows + 1, 377000, 3790000, spacing_m, spacing_m, 1, &lattice, error);
    if (status != SCREE_OK) return status;
    if (slopes != NULL && (vertex_slopes = vertex_slopes_new(memory, mesh, slopes, error)) == NULL)
        return SCREE_E_MEMORY;
    const struct terrain_tile tile = {.lattice = &lattice,
                                      .mesh = mesh,
                                      .slopes = vertex_slopes,
                                      .height_unit_m = ldexp(1, height_exponent),
                                      .border_step = 1};
    status = quantized_mesh_encode_new(memory, &tile, &bytes, &plain_bytes, error);
    if (status == SCREE_OK) status = gzip_new(bytes, plain_bytes, &gzip, size_bytes, error);
    free(gzip);
    scree_release(memory, bytes);
    scree_release(memory, vertex_slopes);
    return status;
}

/* ---- Draco ---- */

static bool write_ply(const char *path, const struct scree_mesh *mesh) {
    FILE *file = fopen(path, "w");
    if (file == NULL) return false;
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex %u\nproperty int x\nproperty int y\nproperty int z\n"
            "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
            (unsigned)mesh->vertex_count, (unsigned)mesh->triangle_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        fprintf(file, "%d %d %d\n", (int)mesh->vertices[v].x, (int)mesh->vertices[v].y, (int)mesh->vertices[v].height);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        fprintf(file, "3 %u %u %u\n", (unsigned)mesh->corners[3 * t], (unsigned)mesh->corners[3 * t + 1],
                (unsigned)mesh->corners[3 * t + 2]);
    return fclose(file) == 0;
}

/* Runs a program without its words; false unless it exits with 0. */
static bool run_silently(const char *const arguments[]) {
    pid_t child;
    int status = 1;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    int failure = posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failure == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

enum scree_status rival_draco(const char *folder, const struct scree_mesh *mesh, size_t *size_bytes,
                              struct scree_error *error) {
    char ply[PATH_BYTES], drc[PATH_BYTES];
    snprintf(ply, sizeof ply, "%s/mesh.ply", folder);
    snprintf(drc, sizeof drc, "%s/mesh.drc", folder);
    if (!write_ply(ply, mesh)) return scree_fail(error, SCREE_E_IO, "%s could not be written", ply);
    const char *arguments[] = {"draco_encoder", "-i", ply, "-o", drc, "-cl", "10", NULL};
    bool done = run_silently(arguments);
    *size_bytes = file_bytes(drc);
    unlink(ply);
    unlink(drc);
    if (done && *size_bytes > 0) return SCREE_OK;
    return scree_fail(error, SCREE_E_UNSUPPORTED, "draco_encoder is not installed (Debian: draco)");
}

/* ---- JPEG 2000 ---- */

enum scree_status rival_jpeg2000(const char *folder, const float *heights_m, int stride, int columns, int rows,
                                 size_t *size_bytes, struct scree_error *error) {
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/grid.jp2", folder);
    GDALDriverH memory = GDALGetDriverByName("MEM"), jpeg2000 = GDALGetDriverByName("JP2OpenJPEG");
    if (memory == NULL || jpeg2000 == NULL)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "GDAL has no driver JP2OpenJPEG here");
    GDALDatasetH grid = GDALCreate(memory, "", columns, rows, 1, GDT_Int16, NULL);
    bool done = grid != NULL &&
                GDALRasterIO(GDALGetRasterBand(grid, 1), GF_Write, 0, 0, columns, rows, (void *)heights_m, columns,
                             rows, GDT_Float32, sizeof *heights_m, stride * (int)sizeof *heights_m) == CE_None;
    char **options = CSLSetNameValue(NULL, "REVERSIBLE", "YES");
    options = CSLSetNameValue(options, "QUALITY", "100");
    options = CSLSetNameValue(options, "CODEC", "J2K"); /* the codestream alone, without boxes around it */
    GDALDatasetH copy = done ? GDALCreateCopy(jpeg2000, path, grid, FALSE, options, NULL, NULL) : NULL;
    done = copy != NULL;
    if (copy != NULL) GDALClose(copy);
    if (grid != NULL) GDALClose(grid);
    CSLDestroy(options);
    *size_bytes = file_bytes(path);
    unlink(path);
    return done ? SCREE_OK : scree_fail(error, SCREE_E_IO, "JPEG 2000 could not be written to %s", path);
}
