#include <scree/error.h>

#include <stdarg.h>
#include <stdio.h>

static void record(struct scree_error *error, enum scree_status status, int64_t offset_bytes, const char *format,
                   va_list arguments) {
    if (error == NULL || error->status < 0) return;
    error->status = status;
    error->offset_bytes = offset_bytes;
    vsnprintf(error->text, sizeof error->text, format, arguments);
    for (char *c = error->text; *c != '\0'; c++)
        if (*c == '\n' || *c == '\r') *c = ' '; /* libraries like to end their messages with one */
}

enum scree_status scree_fail(struct scree_error *error, enum scree_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    record(error, status, SCREE_NO_OFFSET, format, arguments);
    va_end(arguments);
    return status;
}

enum scree_status scree_fail_at(struct scree_error *error, enum scree_status status, int64_t offset_bytes,
                                const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    record(error, status, offset_bytes, format, arguments);
    va_end(arguments);
    return status;
}

const char *scree_status_text(enum scree_status status) {
    switch (status) {
    case SCREE_OK: return "no error";
    case SCREE_MORE: return "more bytes are needed";
    case SCREE_E_ARGUMENT: return "invalid argument";
    case SCREE_E_MEMORY: return "out of memory";
    case SCREE_E_LIMIT: return "a limit would be exceeded";
    case SCREE_E_IO: return "input or output failed";
    case SCREE_E_CORRUPT: return "corrupt data";
    case SCREE_E_UNSUPPORTED: return "unsupported data";
    case SCREE_E_INTERRUPTED: return "interrupted";
    }
    return "unknown error";
}
