/* A growing text. Pure.
 *
 *     struct text text = {0};
 *     text_add(&text, "%d vertices\n", 5);
 *     char *all = text_take(&text, &length_bytes);   // NULL: there was no memory at some point
 */
#ifndef SCREE_TEXT_H
#define SCREE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

struct text { /* zeroes: empty */
    char *bytes;
    size_t length_bytes, room_bytes;
    bool failed; /* memory ran out; nothing is written any more */
};

/* Adds to its end, printf style. */
void text_add(struct text *text, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* The same with what means something to XML replaced, and control characters left out. */
void text_add_xml(struct text *text, const char *plain);

/* A field of a CSV line: in quotes where it needs them. */
void text_add_csv(struct text *text, const char *plain);

/* The finished text in a malloc'd block that is the caller's now; `text` is empty again. NULL: memory ran out on the
 * way. */
char *text_take(struct text *text, size_t *length_bytes);

/* Frees what text_take did not take; fine on an empty one. */
void text_free(struct text *text);

#endif
