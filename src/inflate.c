#include "src/inflate.h"

#include <limits.h>
#include <zlib.h>

#define GZIP_ONLY (MAX_WBITS + 16) /* how zlib is asked for the gzip wrapping and no other */

bool inflate_is_gzip(const unsigned char *bytes, size_t size_bytes) {
    return size_bytes >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

/* zlib's own memory comes out of the same budget. */
static void *zlib_allocate(void *memory, unsigned count, unsigned size_bytes) {
    return scree_allocate(memory, count, size_bytes, "zlib", NULL);
}

static void zlib_release(void *memory, void *block) {
    scree_release(memory, block);
}

/* The block, grown to take more; NULL when that is not allowed. */
static unsigned char *grow(struct scree_memory *memory, unsigned char *block, size_t *capacity_bytes,
                           size_t limit_bytes, struct scree_error *error) {
    size_t wanted_bytes = *capacity_bytes > limit_bytes / 2 ? limit_bytes : 2 * *capacity_bytes;
    if (*capacity_bytes == limit_bytes) {
        scree_fail(error, SCREE_E_LIMIT, "it holds more than %zu bytes once decompressed", limit_bytes);
        return NULL;
    }
    unsigned char *grown = scree_reallocate(memory, block, wanted_bytes, 1, "decompressed bytes", error);
    if (grown != NULL) *capacity_bytes = wanted_bytes;
    return grown;
}

enum scree_status inflate_new(struct scree_memory *memory, const unsigned char *bytes, size_t size_bytes,
                              size_t limit_bytes, unsigned char **plain, size_t *plain_bytes,
                              struct scree_error *error) {
    z_stream zlib = {.zalloc = zlib_allocate, .zfree = zlib_release, .opaque = memory};
    struct scree_error own = {0};
    size_t capacity_bytes = size_bytes < limit_bytes / 4 ? 4 * size_bytes + 1 : limit_bytes;
    unsigned char *block = NULL;
    int code = Z_OK;
    *plain = NULL;
    *plain_bytes = 0;
    if (error == NULL) error = &own;
    if (size_bytes > UINT_MAX || limit_bytes > UINT_MAX)
        return scree_fail(error, SCREE_E_LIMIT, "%zu gzip'd bytes are too many", size_bytes);
    if (inflateInit2(&zlib, GZIP_ONLY) != Z_OK) return scree_fail(error, SCREE_E_MEMORY, "no memory for zlib");
    block = scree_allocate(memory, capacity_bytes, 1, "decompressed bytes", error);
    if (block == NULL) goto cleanup;
    zlib.next_in = (unsigned char *)bytes; /* zlib does not write there */
    zlib.avail_in = (unsigned)size_bytes;
    while (code != Z_STREAM_END) {
        if (zlib.total_out == capacity_bytes) {
            unsigned char *grown = grow(memory, block, &capacity_bytes, limit_bytes, error);
            if (grown == NULL) goto cleanup;
            block = grown;
        }
        zlib.next_out = block + zlib.total_out;
        zlib.avail_out = (unsigned)(capacity_bytes - zlib.total_out);
        code = inflate(&zlib, Z_NO_FLUSH);
        if (code == Z_MEM_ERROR) {
            scree_fail(error, SCREE_E_MEMORY, "no memory for zlib");
            goto cleanup;
        }
        if (code != Z_OK && code != Z_STREAM_END) {
            scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)zlib.total_in, "the gzip data are cut or damaged");
            goto cleanup;
        }
    }
    if (zlib.avail_in != 0) {
        scree_fail_at(error, SCREE_E_CORRUPT, (int64_t)zlib.total_in, "%u bytes follow the gzip data", zlib.avail_in);
        goto cleanup;
    }
    *plain = block;
    *plain_bytes = zlib.total_out;
    block = NULL;
cleanup:
    scree_release(memory, block);
    inflateEnd(&zlib);
    return error->status;
}
