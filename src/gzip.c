/* gzip in memory (src/gzip.h). */
#include "src/gzip.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

#define LEVEL        6
#define MEMORY_LEVEL 9
#define GZIP_WINDOW  (15 + 16) /* 32 KiB, and a gzip header rather than zlib's */
#define OS_UNKNOWN   255

enum scree_status gzip_new(const void *bytes, size_t size_bytes, unsigned char **gzip, size_t *gzip_bytes,
                           struct scree_error *error) {
    z_stream stream = {0};
    if (size_bytes > INT_MAX)
        return scree_fail(error, SCREE_E_LIMIT, "%zu bytes are too many to compress at once", size_bytes);
    if (deflateInit2(&stream, LEVEL, Z_DEFLATED, GZIP_WINDOW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) != Z_OK)
        return scree_fail(error, SCREE_E_MEMORY, "no memory to compress %zu bytes", size_bytes);
    gz_header header = {.os = OS_UNKNOWN};
    deflateSetHeader(&stream, &header);
    size_t room_bytes = deflateBound(&stream, size_bytes);
    enum scree_status status = SCREE_OK;
    *gzip = malloc(room_bytes);
    if (*gzip == NULL) {
        status = scree_fail(error, SCREE_E_MEMORY, "no memory for %zu compressed bytes", room_bytes);
    } else {
        stream.next_in = (unsigned char *)bytes; /* zlib does not write to it */
        stream.avail_in = (uInt)size_bytes;
        stream.next_out = *gzip;
        stream.avail_out = (uInt)room_bytes;
        deflate(&stream, Z_FINISH); /* cannot fail: the room is enough */
        *gzip_bytes = stream.total_out;
    }
    deflateEnd(&stream);
    return status;
}
