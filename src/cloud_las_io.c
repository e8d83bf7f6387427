/* The points of a LAS file, read in chunks. */
#include "src/cloud_parts_io.h"

#define CHUNK_BYTES (1 << 20)
enum { NOISE = 7, HIGH_NOISE = 18 };

static bool is_wanted(const struct las_point *point, const struct cloud_options *options) {
    if (point->is_withheld) return false;
    if (options->has_classes ? !options->classes[point->class_number]
                             : point->class_number == NOISE || point->class_number == HIGH_NOISE)
        return false;
    switch (options->returns) {
    case CLOUD_FIRST_RETURN: return point->return_number <= 1;
    case CLOUD_LAST_RETURN: return point->return_number >= point->return_count;
    case CLOUD_ONLY_RETURN: return point->return_count <= 1;
    default: return true;
    }
}

enum scree_status cloud_read_las(const struct cloud_file *file, const struct cloud_options *options,
                                 struct cloud *cloud, struct cloud_crs *crs, struct scree_error *error) {
    unsigned char begin[LAS_HEADER_BYTES];
    struct las_header header;
    size_t size = file->size_bytes < sizeof begin ? (size_t)file->size_bytes : sizeof begin;
    unsigned char *bytes = NULL;
    enum scree_status status = cloud_file_read(file, 0, begin, size, error);
    if (status == SCREE_OK) status = las_header_read(file->name, begin, size, file->size_bytes, &header, error);
    if (status == SCREE_OK && crs != NULL) status = cloud_las_crs(file, &header, crs, error);
    if (status != SCREE_OK) return status;
    uint64_t chunk = CHUNK_BYTES / header.point_bytes; /* 16 at least */
    bytes = scree_allocate(cloud->memory, chunk, header.point_bytes, "a piece of a LAS file", error);
    if (bytes == NULL) return error->status;
    for (uint64_t done = 0; done < header.point_count && status == SCREE_OK; done += chunk) {
        uint64_t count = header.point_count - done < chunk ? header.point_count - done : chunk;
        status = cloud_file_read(file, header.points_at + done * header.point_bytes, bytes,
                                 (size_t)count * header.point_bytes, error);
        for (uint64_t i = 0; i < count && status == SCREE_OK; i++) {
            struct las_point point = las_point_read(&header, bytes + i * header.point_bytes);
            if (is_wanted(&point, options))
                status = cloud_take(file->name, cloud, (struct cloud_point){point.x, point.y, point.z}, error);
        }
    }
    scree_release(cloud->memory, bytes);
    return status;
}
