#define _LARGEFILE64_SOURCE /* for VSIStatBufL */
#include "src/cloud_parts_io.h"
#include "src/cloud_text.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FARTHEST    1e15 /* as of geotransforms */
#define CHUNK_BYTES 65536

void cloud_crs_free(struct cloud_crs *crs) {
    free(crs->wkt);
    *crs = (struct cloud_crs){0};
}

enum scree_status cloud_file_read(const struct cloud_file *file, uint64_t at, void *bytes, size_t size_bytes,
                                  struct scree_error *error) {
    if (VSIFSeekL(file->stream, at, SEEK_SET) != 0 || VSIFReadL(bytes, 1, size_bytes, file->stream) != size_bytes)
        return scree_fail(error, SCREE_E_IO, "%s: %zu bytes at byte %" PRIu64 " cannot be read", file->name, size_bytes,
                          at);
    return SCREE_OK;
}

enum scree_status cloud_take(const char *name, struct cloud *cloud, struct cloud_point point,
                             struct scree_error *error) {
    if (!(fabs(point.x) < FARTHEST && fabs(point.y) < FARTHEST && fabs(point.z) < FARTHEST))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: has a point at %g %g %g, which is no position on Earth", name,
                          point.x, point.y, point.z);
    return cloud_add(cloud, point, error);
}

static bool is_text(const char *name) {
    static const char *const endings[] = {"xyz", "csv", "txt", "pts"};
    const char *ending = CPLGetExtension(name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (EQUAL(ending, endings[i])) return true;
    return false;
}

static bool begins_as_las(const char *name) {
    unsigned char bytes[4];
    VSIStatBufL about;
    if (VSIStatExL(name, &about, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) != 0 || !VSI_ISREG(about.st_mode))
        return false;
    VSILFILE *stream = VSIFOpenL(name, "rb");
    if (stream == NULL) return false;
    size_t got = VSIFReadL(bytes, 1, sizeof bytes, stream);
    VSIFCloseL(stream);
    return las_is_las(bytes, got);
}

static bool opens_as(const char *name, unsigned kind) {
    GDALDatasetH dataset = GDALOpenEx(name, kind | GDAL_OF_READONLY, NULL, NULL, NULL);
    GDALClose(dataset);
    return dataset != NULL;
}

static bool is_no_raster(const char *name, bool is_wanted) {
    GDALDriverH raster = GDALIdentifyDriverEx(name, GDAL_OF_RASTER, NULL, NULL);
    if (is_text(name)) {
        VSIStatBufL about;
        bool is_there = VSIStatExL(name, &about, VSI_STAT_EXISTS_FLAG) == 0;
        return is_there && (is_wanted || raster == NULL || !opens_as(name, GDAL_OF_RASTER));
    }
    if (raster != NULL && GDALGetMetadataItem(raster, GDAL_DCAP_VECTOR, NULL) == NULL) return false;
    return (raster == NULL || !opens_as(name, GDAL_OF_RASTER)) && opens_as(name, GDAL_OF_VECTOR);
}

bool cloud_is_cloud(const char *name, bool is_wanted) {
    struct raster_trap trap;
    raster_trap_set(&trap);
    bool is_cloud = begins_as_las(name) || is_no_raster(name, is_wanted);
    raster_trap_clear();
    return is_cloud;
}

static enum scree_status take_line(struct cloud_text *text, const char *line, struct cloud *cloud,
                                   struct scree_error *error) {
    bool has_point;
    struct cloud_point point;
    enum scree_status status = cloud_text_take(text, line, &has_point, &point, error);
    return status == SCREE_OK && has_point ? cloud_take(text->name, cloud, point, error) : status;
}

/* Lines out of chunks; what a chunk begins of a line waits for the next one. */
static enum scree_status read_text(const struct cloud_file *file, struct cloud *cloud, struct scree_error *error) {
    struct cloud_text text = {.name = file->name};
    char line[CLOUD_LONGEST_LINE];
    size_t length = 0, got;
    enum scree_status status = SCREE_OK;
    char *bytes = scree_allocate(cloud->memory, CHUNK_BYTES, 1, "a piece of text", error);
    if (bytes == NULL) return error->status;
    while (status == SCREE_OK && (got = VSIFReadL(bytes, 1, CHUNK_BYTES, file->stream)) > 0)
        for (size_t i = 0; i < got && status == SCREE_OK; i++) {
            if (bytes[i] == '\n') {
                line[length] = '\0';
                status = take_line(&text, line, cloud, error);
                length = 0;
            } else if (bytes[i] == '\0' || length + 1 == sizeof line) {
                status = scree_fail(error, SCREE_E_CORRUPT, "%s: line %" PRIu64 " is no text of points", file->name,
                                    text.line + 1);
            } else {
                line[length++] = bytes[i];
            }
        }
    line[length] = '\0';
    if (status == SCREE_OK) status = take_line(&text, line, cloud, error);
    scree_release(cloud->memory, bytes);
    return status;
}

static enum scree_status read_file(const char *name, bool is_las, const struct cloud_options *options,
                                   struct cloud *cloud, struct cloud_crs *crs, struct scree_error *error) {
    struct cloud_file file = {.name = name, .stream = VSIFOpenL(name, "rb")};
    enum scree_status status = SCREE_OK;
    if (file.stream == NULL) return scree_fail(error, SCREE_E_IO, "%s: cannot be opened", name);
    if (VSIFSeekL(file.stream, 0, SEEK_END) != 0)
        status = scree_fail(error, SCREE_E_IO, "%s: cannot be read from any place", name);
    file.size_bytes = VSIFTellL(file.stream);
    if (status == SCREE_OK && VSIFSeekL(file.stream, 0, SEEK_SET) == 0)
        status = is_las ? cloud_read_las(&file, options, cloud, crs, error) : read_text(&file, cloud, error);
    VSIFCloseL(file.stream);
    return status;
}

enum scree_status cloud_read(const char *name, const struct cloud_options *options, struct cloud *cloud,
                             struct cloud_crs *crs, struct scree_error *error) {
    struct raster_trap trap;
    uint32_t before = cloud->count;
    enum scree_status status = SCREE_OK;
    if (crs != NULL) *crs = (struct cloud_crs){0};
    raster_trap_set(&trap);
    bool is_las = begins_as_las(name);
    if (!is_las && (options->has_classes || options->returns != CLOUD_EVERY_RETURN))
        status = scree_fail(error, SCREE_E_ARGUMENT, "%s: only LAS files tell classes and returns of points", name);
    else if (is_las || is_text(name))
        status = read_file(name, is_las, options, cloud, crs, error);
    else
        status = cloud_read_layers(name, cloud, crs, error);
    if (status == SCREE_OK && cloud->count == before)
        status = scree_fail(error, SCREE_E_CORRUPT, "%s: holds no point%s", name,
                            is_las ? " that --class and --returns let through" : "");
    raster_trap_clear();
    return status;
}
