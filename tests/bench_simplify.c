/* bench_simplify: every simplifier on the same posts, one run, one machine. Prints, for each crop of a DEM and each
 * tolerance, triangles, measured errors and CPU time, and the ratio of triangles to those of greedy insertion at the
 * same largest error. What the meshes really are is said by lod/grid_error, not by those who made them.
 *
 * Real DEMs are found by SCREE_TEST_DATA; those that are absent are left out, the fractal is always there. */
#include "lod/greedy.h"
#include "lod/grid_error.h"
#include "tests/bench_method.h"
#include "tests/fractal.h"

#include <gdal.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RUNS = 5 };

#define BORDER_TOLERANCE_M 10

struct crop {
    const char *name, *file; /* file: below the folder of test data; NULL: the fractal */
    int column, row, columns, rows;
    uint32_t vertex_target; /* also compared at so many vertices; 0: not */
};

static const struct crop crops[] = {
    {"Big Tujunga 30 m", "bigtujunga_srtm30m_utm11.tif", 342, 65, 513, 513, 0},
    {"Big Tujunga 30 m", "bigtujunga_srtm30m_utm11.tif", 468, 198, 257, 257, 7740},
    {"Mount St Helens 10 m", "sthelens_2000_10m_utm10.tif", 23, 92, 257, 257, 0},
    {"Mount Rainier 90 m", "large/rainier_srtm3_1201.tif", 656, 736, 257, 257, 0},
    {"Pyrenees 90 m", "large/catalonia_srtm3_1201x2401.tif", 496, 1120, 513, 513, 0},
    {"Fjords at Vancouver 90 m", "large/vancouver_srtm3_2401x1201.tif", 32, 544, 513, 513, 0},
    {"Sagehen 10 m", "large/sagehen_10m_745x690.tif", 116, 88, 513, 513, 0},
    {"fractal", NULL, 0, 0, 513, 513, 0},
};

static const double tolerances_m[] = {2, 5, 10, 20, 50};

struct measurement {
    uint32_t triangles, vertices;
    double cpu_s;
    struct grid_error judged;
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

/* Heights of a crop, row 0 in the south; NULL with a printed line when they cannot be had. */
static float *read_crop(const struct crop *crop, const char *folder) {
    size_t count = (size_t)crop->columns * (size_t)crop->rows;
    float *heights_m = malloc(count * sizeof *heights_m);
    if (heights_m == NULL) return NULL;
    if (crop->file == NULL) {
        struct fractal fractal = {.seed = 1, .whole_metres = true};
        fractal_window(&fractal, 4900, -4900, crop->columns, crop->rows, heights_m, crop->columns);
        return heights_m;
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, crop->file);
    GDALDatasetH raster = GDALOpen(path, GA_ReadOnly);
    GDALRasterBandH band = raster == NULL ? NULL : GDALGetRasterBand(raster, 1);
    float *northern = heights_m + count - (size_t)crop->columns;
    bool fine = band != NULL &&
                GDALRasterIO(band, GF_Read, crop->column, crop->row, crop->columns, crop->rows, northern, crop->columns,
                             crop->rows, GDT_Float32, 0, -crop->columns * (int)sizeof *heights_m) == CE_None;
    int has_nodata = 0;
    double nodata = fine ? GDALGetRasterNoDataValue(band, &has_nodata) : 0;
    size_t voids = 0;
    for (size_t i = 0; fine && has_nodata && i < count; i++) voids += heights_m[i] == (float)nodata;
    if (raster != NULL) GDALClose(raster);
    if (fine && voids == 0) return heights_m;
    if (fine)
        printf("%s: left out, %zu of its posts are void\n", crop->name, voids);
    else
        printf("%s: left out, %s is not there (SCREE_TEST_DATA names the folder)\n", crop->name, path);
    free(heights_m);
    return NULL;
}

/* Runs a method several times, takes the median of its CPU times and has its mesh judged. */
static bool measure(const struct bench_method *method, const struct bench_task *task, struct measurement *result) {
    double times_s[RUNS];
    struct scree_memory memory = {0};
    struct bench_mesh made = {0};
    struct scree_error error = {0};
    for (int run = 0; run < RUNS; run++) {
        bench_mesh_free(&made, &memory);
        double start_s = cpu_seconds();
        if (method->simplify(task, &memory, &made, &error) != SCREE_OK) break;
        times_s[run] = cpu_seconds() - start_s;
    }
    if (error.status == SCREE_OK)
        grid_error_measure(task->heights_m, task->columns, task->rows, task->columns, &made.mesh, made.vertex_heights_m,
                           &memory, &result->judged, &error);
    result->triangles = made.mesh.triangle_count;
    result->vertices = made.mesh.vertex_count;
    bench_mesh_free(&made, &memory);
    if (error.status != SCREE_OK) {
        printf("%s: %s\n", method->name, error.text);
        return false;
    }
    qsort(times_s, RUNS, sizeof *times_s, compare_doubles);
    result->cpu_s = times_s[RUNS / 2];
    return true;
}

/* One line a method; false when a method failed or broke its bound. The first method is what the others are held to. */
static bool compare_methods(const struct bench_task *task) {
    bool fine = true;
    uint32_t reference_triangles = 0;
    for (size_t i = 0; i < bench_method_count; i++) {
        struct measurement m;
        if (!measure(&bench_methods[i], task, &m)) {
            fine = false;
            continue;
        }
        if (i == 0) reference_triangles = m.triangles;
        if (task->vertex_target == 0)
            printf("%8g m", task->tolerance_m);
        else
            printf("%8u v", (unsigned)task->vertex_target);
        printf("  %-24s %8u %8u  %6.3f  %8.3f %8.3f %8.3f  %4u  %8.4f\n", bench_methods[i].name, (unsigned)m.triangles,
               (unsigned)m.vertices, (double)m.triangles / (double)reference_triangles, m.judged.max_m, m.judged.rms_m,
               m.judged.mean_m, (unsigned)(m.judged.turned_triangles + m.judged.flat_triangles), m.cpu_s);
        bool bound_holds = task->vertex_target != 0 || m.judged.max_m <= task->tolerance_m;
        if (!bound_holds || !m.judged.covers) {
            printf("broken: %s %s\n", bench_methods[i].name,
                   bound_holds ? "does not cover the crop" : "exceeds its bound");
            fine = false;
        }
    }
    return fine;
}

/* What shared borders cost: the crop as one tile, then as four. A tile's triangles are those of its area and those of
 * its border; from the two counts follows what a quarter without a border's cost would take. */
static bool price_borders(const struct bench_method *method, const struct bench_task *whole) {
    struct measurement one, part;
    if (!measure(method, whole, &one)) return false;
    double four = 0;
    int columns = whole->columns / 2 + 1, rows = whole->rows / 2 + 1;
    float *heights_m = malloc((size_t)columns * (size_t)rows * sizeof *heights_m);
    if (heights_m == NULL) return false;
    struct bench_task task = {.heights_m = heights_m, .columns = columns, .rows = rows};
    task.tolerance_m = whole->tolerance_m;
    bool fine = true;
    for (int quarter = 0; quarter < 4 && fine; quarter++) {
        int x = quarter % 2 * (columns - 1), y = quarter / 2 * (rows - 1);
        for (int row = 0; row < rows; row++)
            memcpy(heights_m + row * columns, whole->heights_m + (y + row) * whole->columns + x,
                   (size_t)columns * sizeof *heights_m);
        fine = measure(method, &task, &part);
        four += (double)part.triangles;
    }
    free(heights_m);
    if (fine)
        printf("%8g m  %-24s borders of %d x %d tiles: %.3f x the triangles of free borders (estimate)\n",
               whole->tolerance_m, method->name, columns, rows, four / (2 * (double)one.triangles - four));
    return fine;
}

static bool run_crop(const struct crop *crop, const char *folder) {
    float *heights_m = read_crop(crop, folder);
    if (heights_m == NULL) return true;
    if (crop->file != NULL)
        printf("\n%s, %d x %d posts at column %d, row %d\n", crop->name, crop->columns, crop->rows, crop->column,
               crop->row);
    else
        printf("\n%s, %d x %d posts\n", crop->name, crop->columns, crop->rows);
    printf("     bound  %-24s %8s %8s  %6s  %8s %8s %8s  %4s  %8s\n", "method", "triangles", "vertices", "ratio",
           "max m", "RMS m", "mean m", "bad", "CPU s");
    bool fine = true;
    struct bench_task task = {.heights_m = heights_m, .columns = crop->columns, .rows = crop->rows};
    for (size_t i = 0; i < sizeof tolerances_m / sizeof *tolerances_m; i++) {
        task.tolerance_m = tolerances_m[i];
        fine = compare_methods(&task) && fine;
    }
    task.tolerance_m = BORDER_TOLERANCE_M;
    for (size_t i = 0; i < bench_method_count && crop->columns == 513 && crop->rows == 513; i++)
        fine = price_borders(&bench_methods[i], &task) && fine;
    if (crop->vertex_target != 0) {
        task.vertex_target = crop->vertex_target;
        fine = compare_methods(&task) && fine;
    }
    free(heights_m);
    return fine;
}

int main(void) {
    const char *folder = getenv("SCREE_TEST_DATA");
    if (folder == NULL) folder = TEST_DATA_DEFAULT;
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    printf("Simplifiers compared: ratio = triangles over those of %s; CPU time is the median of %d runs.\n",
           bench_methods[0].name, RUNS);
    bool fine = true;
    for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) fine = run_crop(&crops[i], folder) && fine;
    return fine ? 0 : 1;
}
