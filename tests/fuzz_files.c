/* fuzz_files: any bytes as one of the files that people give: LAS, points as text, PLY, OBJ, STL, OFF, OM. What is read
 * goes on: a mesh is sampled as it is and mended, a small cloud cleaned, thinned and triangulated. Every refusal is one
 * line that names the file, and no memory is kept; what comes out is a surface.
 *
 * Input is such a file as it is; its first bytes tell its kind. `make fuzz` links this with libFuzzer; `make check`
 * with tests/fuzz_replay.c, which runs files. */
#include "lod/cloud_grid.h"
#include "src/cloud_read_io.h"
#include "src/mesh_file_read.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define MEMORY_LIMIT_BYTES ((size_t)32 << 20)
#define MOST_POINTS        20000 /* of a cloud that goes on */
#define MOST_POSTS         4096

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes);

/* Stops here, where a debugger and libFuzzer see it. */
#define DEMAND(condition)                                                               \
    do {                                                                                \
        if (!(condition)) {                                                             \
            fprintf(stderr, "fuzz_files: not so, line %d: %s\n", __LINE__, #condition); \
            abort();                                                                    \
        }                                                                               \
    } while (0)

static bool begins(const uint8_t *data, size_t size_bytes, const char *text) {
    return size_bytes >= strlen(text) && memcmp(data, text, strlen(text)) == 0;
}

static bool has_line(const uint8_t *data, size_t size_bytes, const char *start) {
    for (size_t at = 0; at + 2 < size_bytes; at++)
        if ((at == 0 || data[at - 1] == '\n') && memcmp(data + at, start, 2) == 0) return true;
    return false;
}

/* The name that the bytes are read by. */
static const char *name_of(const uint8_t *data, size_t size_bytes) {
    uint32_t triangles = 0;
    if (size_bytes >= 84) triangles = data[80] | (uint32_t)data[81] << 8 | (uint32_t)data[82] << 16;
    if (begins(data, size_bytes, "LASF")) return "/vsimem/a.las";
    if (begins(data, size_bytes, "ply")) return "/vsimem/a.ply";
    if (begins(data, size_bytes, "OM")) return "/vsimem/a.om";
    if (begins(data, size_bytes, "solid") || (size_bytes >= 84 && size_bytes == 84 + 50 * (size_t)triangles))
        return "/vsimem/a.stl";
    for (size_t at = 0; at + 3 <= size_bytes && at < 6; at++)
        if (memcmp(data + at, "OFF", 3) == 0) return "/vsimem/a.off";
    return has_line(data, size_bytes, "v ") || has_line(data, size_bytes, "f ") ? "/vsimem/a.obj" : "/vsimem/a.xyz";
}

static void check_refusal(const char *name, enum scree_status status, const struct scree_error *error) {
    DEMAND(status == error->status);
    if (status == SCREE_OK) return;
    DEMAND(strchr(error->text, '\n') == NULL && error->text[0] != '\0');
    if (name != NULL && status != SCREE_E_LIMIT) DEMAND(strncmp(error->text, name, strlen(name)) == 0);
}

static void check_surface(const struct tin *tin) {
    DEMAND(tin->triangle_count > 0);
    for (uint32_t t = 0; t < tin->triangle_count; t++) {
        const struct cloud_point *p[3];
        for (size_t k = 0; k < 3; k++) {
            DEMAND(tin->corners[3 * (size_t)t + k] < tin->point_count);
            p[k] = &tin->points[tin->corners[3 * (size_t)t + k]];
        }
        DEMAND((p[1]->x - p[0]->x) * (p[2]->y - p[0]->y) > (p[1]->y - p[0]->y) * (p[2]->x - p[0]->x));
    }
}

/* At posts so far apart that there are not many. */
static void sample(const struct tin *tin) {
    static float heights[MOST_POSTS];
    const struct cloud points = {.points = tin->points, .count = tin->point_count};
    struct cloud_posts posts;
    double bounds[4];
    cloud_bounds(&points, bounds);
    const double spacing = fmax(bounds[2] - bounds[0], bounds[3] - bounds[1]) / 40;
    if (!(spacing > 0) || cloud_posts_choose(&points, spacing, &posts, NULL) != SCREE_OK) return;
    DEMAND((int64_t)posts.columns * posts.rows <= MOST_POSTS);
    const uint64_t covered = tin_sample(tin, &posts, heights);
    uint64_t found = 0;
    for (int32_t i = 0; i < posts.columns * posts.rows; i++) found += !isnan(heights[i]);
    DEMAND(found == covered);
}

static void try_mesh(const char *name, struct scree_memory *memory) {
    struct tin tin = {.memory = memory};
    struct tin_mended mended, again;
    struct scree_error error = {0};
    enum scree_status status = mesh_file_read(name, &tin, &error);
    check_refusal(name, status, &error);
    if (status == SCREE_OK) {
        sample(&tin);
        const uint32_t points = tin.point_count, triangles = tin.triangle_count;
        status = tin_mend(&tin, &mended, &error);
        check_refusal(NULL, status, &error);
        if (status == SCREE_OK) {
            check_surface(&tin);
            DEMAND(points == tin.point_count + mended.welded + mended.unused);
            DEMAND(triangles == tin.triangle_count + mended.dropped);
            sample(&tin);
            if (tin_mend(&tin, &again, &error) == SCREE_OK) /* tolerances may have changed */
                DEMAND(again.turned == 0 && tin.triangle_count == triangles - mended.dropped - again.dropped);
        }
    }
    tin_release(&tin);
}

static void try_cloud(const char *name, uint32_t seed, struct scree_memory *memory) {
    struct cloud cloud = {.memory = memory};
    struct tin tin = {.memory = memory};
    struct cloud_options options = {0};
    struct cloud_crs crs = {0};
    struct scree_error error = {0};
    enum scree_status status = cloud_read(name, &options, &cloud, seed % 4 == 0 ? &crs : NULL, &error);
    check_refusal(name, status, &error);
    if (status == SCREE_OK && cloud.count <= MOST_POINTS) {
        double bounds[4];
        cloud_bounds(&cloud, bounds);
        const double side = fmax(bounds[2] - bounds[0], bounds[3] - bounds[1]);
        if (seed % 3 == 0) status = cloud_drop_outliers(&cloud, side / 10, &error);
        if (status == SCREE_OK && seed % 5 == 0 && side > 0) status = cloud_thin(&cloud, side / 50, &error);
        if (status == SCREE_OK) status = tin_from_cloud(&cloud, seed % 7 == 0 ? side / 4 : INFINITY, &tin, &error);
        check_refusal(NULL, status, &error);
        if (status == SCREE_OK) {
            check_surface(&tin);
            sample(&tin);
        }
    }
    cloud_crs_free(&crs);
    tin_release(&tin);
    cloud_release(&cloud);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes) {
    static bool is_ready;
    if (size_bytes > 1 << 20) return 0;
    if (!is_ready) GDALAllRegister();
    is_ready = true;
    const char *name = name_of(data, size_bytes);
    const uint32_t seed = (uint32_t)crc32(0, data, (uInt)size_bytes);
    struct scree_memory memory = {.limit_bytes = MEMORY_LIMIT_BYTES};
    uint8_t *copy = malloc(size_bytes + (size_bytes == 0)); /* which a reader beyond the end leaves */
    if (copy == NULL) return 0;
    if (size_bytes > 0) memcpy(copy, data, size_bytes);
    VSIFCloseL(VSIFileFromMemBuffer(name, copy, size_bytes, FALSE));
    if (mesh_file_is_mesh(name))
        try_mesh(name, &memory);
    else
        try_cloud(name, seed, &memory);
    VSIUnlink(name);
    free(copy);
    DEMAND(memory.used_bytes == 0);
    return 0;
}
