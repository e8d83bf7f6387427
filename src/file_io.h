/* Writing files whole or not at all, and saying in one line why it failed. */
#ifndef SCREE_FILE_IO_H
#define SCREE_FILE_IO_H

#include <scree/error.h>
#include <stddef.h>

/* Temporary files begin with this, so that a later build can tell them from everything else. */
#define FILE_TEMPORARY_PREFIX ".scree-tmp-"

/* Records SCREE_E_IO for a failed system call: what could not be done to which path, why (`code` is errno) and what to
 * do about it. */
enum scree_status file_fail(struct scree_error *error, const char *what, const char *path, int code);

/* Makes a folder and those above it; fine where it is there already. */
enum scree_status file_make_folder(const char *path, struct scree_error *error);

/* Makes a new file in the folder `folder` (a descriptor, or AT_FDCWD), writes it, checks that it was closed well and
 * renames it to `name`, replacing what was there. `temporary` is its name until then; both are relative to `folder`.
 * Returns 0 or errno (EEXIST: `temporary` is somebody else's); nothing is left behind on failure. */
int file_write_beside(int folder, const char *temporary, const char *name, const void *bytes, size_t size_bytes);

/* Writes `path` whole or not at all: beside it first, then renamed into place. What is not a regular file (a terminal,
 * a pipe, /dev/stdout) is written to directly. Nothing is flushed to the disk before the function returns. */
enum scree_status file_replace(const char *path, const void *bytes, size_t size_bytes, struct scree_error *error);

#endif
