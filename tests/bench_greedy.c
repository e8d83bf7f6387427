/* bench_greedy DEM METRES...: greedy insertion of all posts of a raster at each error, once with free borders as other
 * programs do it, once as the method of `scree build --method greedy`, between borders that keep all of their posts.
 * CPU time of the triangulation alone, median of five runs; errors as lod/grid_error and lod/method_error measure them.
 */
#include "lod/greedy.h"
#include "lod/grid_error.h"
#include "lod/method_error.h"
#include "lod/method_greedy.h"

#include <gdal.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { RUNS = 5 };

struct dem {
    int columns, rows;
    float *heights_m; /* row 0 in the south */
};

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_line(const char *what, double error_m, uint32_t vertices, uint32_t triangles, double max_m,
                       double times_s[RUNS]) {
    qsort(times_s, RUNS, sizeof *times_s, compare_doubles);
    printf("%8g m  %-14s %9u %9u  %8.3f  %8.3f\n", error_m, what, (unsigned)vertices, (unsigned)triangles, max_m,
           times_s[RUNS / 2]);
}

static bool read_dem(const char *path, struct dem *dem) {
    GDALDatasetH raster = GDALOpen(path, GA_ReadOnly);
    if (raster == NULL) return false;
    dem->columns = GDALGetRasterXSize(raster);
    dem->rows = GDALGetRasterYSize(raster);
    size_t count = (size_t)dem->columns * (size_t)dem->rows;
    dem->heights_m = malloc(count * sizeof *dem->heights_m);
    bool fine =
        dem->heights_m != NULL && GDALRasterIO(GDALGetRasterBand(raster, 1), GF_Read, 0, 0, dem->columns, dem->rows,
                                               dem->heights_m + count - (size_t)dem->columns, dem->columns, dem->rows,
                                               GDT_Float32, 0, -dem->columns * (int)sizeof *dem->heights_m) == CE_None;
    GDALClose(raster);
    return fine;
}

static enum scree_status with_free_borders(const struct dem *dem, double error_m, struct scree_error *error) {
    const struct greedy_options options = {.tolerance_m = error_m};
    struct scree_memory memory = {0};
    struct scree_mesh mesh = {0};
    struct grid_error judged = {0};
    double times_s[RUNS];
    enum scree_status status = SCREE_OK;
    for (int run = 0; run < RUNS && status == SCREE_OK; run++) {
        greedy_free(&mesh, &memory);
        double start_s = cpu_seconds();
        status = greedy_triangulate(dem->heights_m, dem->columns, dem->rows, dem->columns, &options, &memory, &mesh,
                                    NULL, error);
        times_s[run] = cpu_seconds() - start_s;
    }
    if (status == SCREE_OK)
        status = grid_error_measure(dem->heights_m, dem->columns, dem->rows, dem->columns, &mesh, NULL, &memory,
                                    &judged, error);
    if (status == SCREE_OK)
        print_line("free borders", error_m, mesh.vertex_count, mesh.triangle_count, judged.max_m, times_s);
    greedy_free(&mesh, &memory);
    return status;
}

/* Border lines with all of their posts. */
static void make_lines(const struct dem *dem, struct border_line lines[SIDE_COUNT]) {
    for (int side = 0; side < SIDE_COUNT; side++) {
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
        struct border_line *line = &lines[side];
        line->vertex_count = horizontal ? dem->columns : dem->rows;
        for (int i = 0; i < line->vertex_count; i++) {
            int x = horizontal ? i : side == SIDE_EAST ? dem->columns - 1 : 0;
            int y = horizontal ? side == SIDE_NORTH ? dem->rows - 1 : 0 : i;
            line->vertices[i] = (struct border_sample){i, dem->heights_m[(size_t)y * (size_t)dem->columns + (size_t)x]};
        }
    }
}

static enum scree_status between_borders(const struct dem *dem, double error_m, struct border_line lines[SIDE_COUNT],
                                         struct scree_error *error) {
    const struct method_greedy_options options = {.tolerance_m = error_m};
    struct method_tile tile = {.columns = dem->columns - 1,
                               .rows = dem->rows - 1,
                               .cell_span = 1,
                               .heights_m = dem->heights_m,
                               .stride = dem->columns,
                               .east_m = 1,
                               .north_m = 1};
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0};
    struct method_error judged = {0};
    double times_s[RUNS];
    enum scree_status status = SCREE_OK;
    make_lines(dem, lines);
    for (int side = 0; side < SIDE_COUNT; side++) tile.lines[side] = &lines[side];
    for (int run = 0; run < RUNS && status == SCREE_OK; run++) {
        method_mesh_release(&memory, &mesh);
        double start_s = cpu_seconds();
        status = method_greedy(&memory, &tile, &options, &mesh, error);
        times_s[run] = cpu_seconds() - start_s;
    }
    if (status == SCREE_OK) status = method_error_measure(&memory, &tile, &mesh, &judged, error);
    if (status == SCREE_OK)
        print_line("given borders", error_m, mesh.vertex_count, mesh.triangle_count, judged.max_m, times_s);
    method_mesh_release(&memory, &mesh);
    return status;
}

int main(int argc, char **argv) {
    static struct border_line lines[SIDE_COUNT];
    struct dem dem = {0};
    struct scree_error error = {0};
    if (argc < 3) {
        fprintf(stderr, "Usage: bench_greedy DEM METRES...\n");
        return 2;
    }
    GDALAllRegister();
    if (!read_dem(argv[1], &dem) || dem.columns > BORDER_MAX_VERTICES || dem.rows > BORDER_MAX_VERTICES) {
        fprintf(stderr, "%s: cannot be read, or has more than %d posts a side\n", argv[1], BORDER_MAX_VERTICES);
        free(dem.heights_m);
        return 1;
    }
    printf("%d x %d posts; CPU time is the median of %d runs\n", dem.columns, dem.rows, RUNS);
    printf("     error                  vertices triangles     max m     CPU s\n");
    for (int i = 2; i < argc && error.status == SCREE_OK; i++) {
        if (with_free_borders(&dem, strtod(argv[i], NULL), &error) == SCREE_OK)
            between_borders(&dem, strtod(argv[i], NULL), lines, &error);
    }
    if (error.status != SCREE_OK) fprintf(stderr, "%s\n", error.text);
    free(dem.heights_m);
    return error.status == SCREE_OK ? 0 : 1;
}
