#include "src/file_read_io.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Reads until `size_bytes` are there or the file ends. Returns how many, or -1. */
static ssize_t read_fully(int file, unsigned char *bytes, size_t size_bytes) {
    size_t done = 0;
    while (done < size_bytes) {
        ssize_t got = read(file, bytes + done, size_bytes - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        done += (size_t)got;
    }
    return (ssize_t)done;
}

enum scree_status file_read_new(struct scree_memory *memory, const char *path, size_t limit_bytes,
                                unsigned char **bytes, size_t *size_bytes, struct scree_error *error) {
    unsigned char *block = NULL;
    enum scree_status status = SCREE_OK;
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a named pipe would wait for ever */
    *bytes = NULL;
    if (file < 0 || fstat(file, &about) != 0) {
        status = scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
        goto cleanup;
    }
    if (!S_ISREG(about.st_mode)) {
        status = scree_fail(error, SCREE_E_IO, "%s: is not a regular file", path);
        goto cleanup;
    }
    if (about.st_size < 0 || (uintmax_t)about.st_size > limit_bytes) {
        status = scree_fail(error, SCREE_E_LIMIT, "%s: has %jd bytes, more than the limit of %zu", path,
                            (intmax_t)about.st_size, limit_bytes);
        goto cleanup;
    }
    block = scree_allocate(memory, (size_t)about.st_size + 1, 1, path, error);
    if (block == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    ssize_t got = read_fully(file, block, (size_t)about.st_size);
    if (got < 0) {
        status = scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
        goto cleanup;
    }
    *size_bytes = (size_t)got;
    *bytes = block;
    block = NULL;
cleanup:
    scree_release(memory, block);
    if (file >= 0) close(file);
    return status;
}
