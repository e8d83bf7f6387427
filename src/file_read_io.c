#include "src/file_read_io.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
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

/* Opens a regular file and says how large it is; -1 after a failure. */
static int open_regular(const char *path, uint64_t *size_bytes, struct scree_error *error) {
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a named pipe would wait for ever */
    if (file < 0 || fstat(file, &about) != 0) {
        scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
    } else if (!S_ISREG(about.st_mode) || about.st_size < 0) {
        scree_fail(error, SCREE_E_IO, "%s: is not a regular file", path);
    } else {
        *size_bytes = (uint64_t)about.st_size;
        return file;
    }
    if (file >= 0) close(file);
    return -1;
}

enum scree_status file_read_new(struct scree_memory *memory, const char *path, size_t limit_bytes,
                                unsigned char **bytes, size_t *size_bytes, struct scree_error *error) {
    unsigned char *block = NULL;
    enum scree_status status = SCREE_OK;
    uint64_t file_bytes = 0;
    int file = open_regular(path, &file_bytes, error);
    *bytes = NULL;
    if (file < 0) return SCREE_E_IO;
    if (file_bytes > limit_bytes) {
        status = scree_fail(error, SCREE_E_LIMIT, "%s: has %" PRIu64 " bytes, more than the limit of %zu", path,
                            file_bytes, limit_bytes);
        goto cleanup;
    }
    block = scree_allocate(memory, (size_t)file_bytes + 1, 1, path, error);
    if (block == NULL) {
        status = SCREE_E_MEMORY;
        goto cleanup;
    }
    ssize_t got = read_fully(file, block, (size_t)file_bytes);
    if (got < 0) {
        status = scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(errno));
        goto cleanup;
    }
    *size_bytes = (size_t)got;
    *bytes = block;
    block = NULL;
cleanup:
    scree_release(memory, block);
    close(file);
    return status;
}

enum scree_status file_read_begin(const char *path, void *bytes, size_t capacity_bytes, size_t *size_bytes,
                                  uint64_t *file_bytes, struct scree_error *error) {
    int file = open_regular(path, file_bytes, error);
    if (file < 0) return SCREE_E_IO;
    ssize_t got = read_fully(file, bytes, capacity_bytes);
    int why = errno;
    close(file);
    if (got < 0) return scree_fail(error, SCREE_E_IO, "%s: %s", path, strerror(why));
    *size_bytes = (size_t)got;
    return SCREE_OK;
}
