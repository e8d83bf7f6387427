/* A growing text: see the header. */
#include "src/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for `count` bytes and a terminating zero. */
static bool has_room(struct text *text, size_t count) {
    if (text->failed) return false;
    if (count < text->room_bytes - text->length_bytes) return true;
    size_t room_bytes = 2 * text->room_bytes + count + 256;
    char *larger = room_bytes < text->room_bytes ? NULL : realloc(text->bytes, room_bytes);
    if (larger == NULL) {
        text->failed = true;
        return false;
    }
    text->bytes = larger;
    text->room_bytes = room_bytes;
    return true;
}

void text_add(struct text *text, const char *format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int count = vsnprintf(NULL, 0, format, arguments);
    if (count < 0) text->failed = true;
    if (has_room(text, (size_t)count)) {
        vsnprintf(text->bytes + text->length_bytes, (size_t)count + 1, format, again);
        text->length_bytes += (size_t)count;
    }
    va_end(again);
    va_end(arguments);
}

void text_add_xml(struct text *text, const char *plain) {
    for (; *plain != '\0'; plain++) {
        if (*plain == '&')
            text_add(text, "&amp;");
        else if (*plain == '<')
            text_add(text, "&lt;");
        else if (*plain == '>')
            text_add(text, "&gt;");
        else if (*plain == '"')
            text_add(text, "&quot;");
        else if ((unsigned char)*plain >= ' ')
            text_add(text, "%c", *plain);
    }
}

void text_add_csv(struct text *text, const char *plain) {
    bool is_quoted = strpbrk(plain, ",\"\r\n") != NULL;
    if (is_quoted) text_add(text, "\"");
    for (; *plain != '\0'; plain++) text_add(text, *plain == '"' ? "\"\"" : "%c", *plain);
    if (is_quoted) text_add(text, "\"");
}

char *text_take(struct text *text, size_t *length_bytes) {
    char *bytes = text->bytes;
    if (text->failed || bytes == NULL) {
        text_free(text);
        return NULL;
    }
    *length_bytes = text->length_bytes;
    *text = (struct text){0};
    return bytes;
}

void text_free(struct text *text) {
    free(text->bytes);
    *text = (struct text){0};
}
