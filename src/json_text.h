/* A growing JSON text. Pure.
 *
 *     struct json_text json = {0};
 *     json_open(&json, '{');
 *     json_key(&json, "svo_m");
 *     json_number(&json, 3.5);
 *     json_close(&json, '}');
 *     char *text = json_text_take(&json);   // NULL: there was no memory at some point
 *
 * Commas, line breaks and quotes are seen to. Text is written two spaces deeper a level, one value a line, unless it
 * lies within json_open_line, which keeps everything up to its json_close on one line. */
#ifndef SCREE_JSON_TEXT_H
#define SCREE_JSON_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct json_text { /* zeroes: empty */
    char *text;
    size_t length_bytes, room_bytes;
    int depth;
    int line_depth;   /* depth of the outermost json_open_line; 0: none */
    bool wants_comma; /* a value stands before the place where the next one goes */
    bool after_key;
    bool failed; /* memory ran out; nothing is written any more */
};

/* Begins an object '{' or an array '['. */
void json_open(struct json_text *json, char bracket);
void json_open_line(struct json_text *json, char bracket);

/* Ends it with '}' or ']'. */
void json_close(struct json_text *json, char bracket);

/* The name of the next value, within an object. */
void json_key(struct json_text *json, const char *key);

/* A string: quotes, backslashes and control characters escaped, bytes that are not UTF-8 replaced by U+FFFD. NULL is
 * written as null. */
void json_string(struct json_text *json, const char *string);

/* The shortest number that reads back as the same double, in any locale; null when it is not finite. */
void json_number(struct json_text *json, double number);
void json_integer(struct json_text *json, int64_t number);
void json_boolean(struct json_text *json, bool value);

/* The finished text with a newline at its end, in a malloc'd block that is the caller's now; `json` is empty again.
 * NULL: memory ran out on the way. */
char *json_text_take(struct json_text *json);

/* Frees what json_text_take did not take; fine on an empty one. */
void json_text_free(struct json_text *json);

#endif
