/* Errors: one enum for every function that can fail, and an optional context that carries one line for people.
 *
 *     struct scree_error error = {0};
 *     if (scree_something(..., &error) != SCREE_OK)
 *         fprintf(stderr, "scree: %s\n", error.text);
 *
 * Every `struct scree_error *` parameter may be NULL. The first failure wins: a context that already holds a failure
 * is not overwritten, so the line names the cause and not what followed from it. */
#ifndef SCREE_ERROR_H
#define SCREE_ERROR_H

#include <stdint.h>

/* What the library shows to those who link it; everything else in it is hidden. */
#ifdef __GNUC__
#define SCREE_API __attribute__((visibility("default")))
#else
#define SCREE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum scree_status {
    SCREE_OK = 0,
    SCREE_MORE = 1,           /* a decoder wants more bytes; not a failure */
    SCREE_E_ARGUMENT = -1,    /* the caller asked for something that makes no sense */
    SCREE_E_MEMORY = -2,      /* the system has no memory left */
    SCREE_E_LIMIT = -3,       /* a stated limit (memory budget, format maximum) would be passed */
    SCREE_E_IO = -4,          /* a file, a disk or GDAL failed */
    SCREE_E_CORRUPT = -5,     /* bytes that no writer of the format makes */
    SCREE_E_UNSUPPORTED = -6, /* well formed, but of a kind that this version does not read */
    SCREE_E_INTERRUPTED = -7  /* the user asked to stop */
};

#define SCREE_NO_OFFSET (-1)

struct scree_error {
    enum scree_status status; /* SCREE_OK: nothing has failed yet */
    int64_t offset_bytes;     /* where in the input, or SCREE_NO_OFFSET */
    char text[480];           /* one line without a newline: which input, what is wrong, what to do */
};

/* Records a failure (printf style) unless `error` is NULL or already holds one; returns `status` either way. */
SCREE_API enum scree_status scree_fail(struct scree_error *error, enum scree_status status, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* The same for a failure at a known byte of the input. */
SCREE_API enum scree_status scree_fail_at(struct scree_error *error, enum scree_status status, int64_t offset_bytes,
                                          const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/* A short English phrase for a status ("out of memory"); never NULL. */
SCREE_API const char *scree_status_text(enum scree_status status);

#ifdef __cplusplus
}
#endif
#endif
