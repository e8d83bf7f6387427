/* Writing files whole or not at all (src/file_io.h). */
#include "src/file_io.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TEMPORARY_TRIES 1000 /* names that left-over files of killed programs may hold */

static const char *advice(int code) {
    switch (code) {
    case ENOSPC: return "; free some space there or write somewhere else";
    case EDQUOT: return "; free some of your quota or write somewhere else";
    case EFBIG: return "; raise the limit on file sizes (ulimit -f)";
    case EACCES:
    case EPERM:
    case EROFS: return "; choose a place that you may write to";
    case ENOTDIR: return "; a file is where a folder should be: choose another name";
    case EISDIR: return "; a folder is where the file should be: choose another name";
    case EXDEV: return "; the folder spans file systems: write somewhere else";
    default: return "";
    }
}

enum scree_status file_fail(struct scree_error *error, const char *what, const char *path, int code) {
    return scree_fail(error, SCREE_E_IO, "cannot %s %s: %s%s", what, path, strerror(code), advice(code));
}

static int make_one_folder(const char *path) {
    if (mkdir(path, 0777) == 0) return 0;
    int code = errno;
    struct stat status;
    if (stat(path, &status) != 0) return code;
    return S_ISDIR(status.st_mode) ? 0 : ENOTDIR;
}

enum scree_status file_make_folder(const char *path, struct scree_error *error) {
    char *part = strdup(path);
    if (part == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for the name of a folder");
    int code = 0;
    for (char *c = part; code == 0 && *c != '\0'; c++) {
        if (*c != '/' || c == part) continue;
        *c = '\0';
        code = make_one_folder(part);
        *c = '/';
    }
    if (code == 0) code = make_one_folder(part);
    free(part);
    return code == 0 ? SCREE_OK : file_fail(error, "make the folder", path, code);
}

static int write_all(int file, const unsigned char *bytes, size_t size_bytes) {
    while (size_bytes > 0) {
        ssize_t done = write(file, bytes, size_bytes);
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) return errno;
        bytes += done;
        size_bytes -= (size_t)done;
    }
    return 0;
}

static int write_and_close(int file, const void *bytes, size_t size_bytes) {
    int code = write_all(file, bytes, size_bytes);
    if (close(file) != 0 && code == 0 && errno != EINTR) code = errno; /* a full disk may show up only here */
    return code;
}

int file_write_beside(int folder, const char *temporary, const char *name, const void *bytes, size_t size_bytes) {
    int file = openat(folder, temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return errno;
    int code = write_and_close(file, bytes, size_bytes);
    if (code == 0) {
        if (renameat(folder, temporary, folder, name) == 0) return 0;
        code = errno;
    }
    unlinkat(folder, temporary, 0);
    return code;
}

static enum scree_status write_in_place(const char *path, const void *bytes, size_t size_bytes,
                                        struct scree_error *error) {
    int file = open(path, O_WRONLY | O_CLOEXEC);
    int code = file < 0 ? errno : write_and_close(file, bytes, size_bytes);
    return code == 0 ? SCREE_OK : file_fail(error, "write", path, code);
}

enum scree_status file_replace(const char *path, const void *bytes, size_t size_bytes, struct scree_error *error) {
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) return write_in_place(path, bytes, size_bytes, error);
    const char *slash = strrchr(path, '/');
    size_t folder_bytes = slash == NULL ? 0 : (size_t)(slash - path) + 1;
    size_t room = folder_bytes + sizeof FILE_TEMPORARY_PREFIX + 48;
    char *temporary = malloc(room);
    if (temporary == NULL) return scree_fail(error, SCREE_E_MEMORY, "no memory for the name of a file");
    memcpy(temporary, path, folder_bytes);
    int code = EEXIST;
    for (int i = 0; code == EEXIST && i < TEMPORARY_TRIES; i++) {
        snprintf(temporary + folder_bytes, room - folder_bytes, FILE_TEMPORARY_PREFIX "%ld-f%d", (long)getpid(), i);
        code = file_write_beside(AT_FDCWD, temporary, path, bytes, size_bytes);
    }
    free(temporary);
    return code == 0 ? SCREE_OK : file_fail(error, "write", path, code);
}
