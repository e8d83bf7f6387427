/* A growing JSON text (src/json_text.h). */
#include "src/json_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER_ROOM 40
#define REPLACEMENT "\xef\xbf\xbd" /* U+FFFD */

static void append(struct json_text *json, const char *bytes, size_t count) {
    if (json->failed) return;
    if (count >= json->room_bytes - json->length_bytes) {
        size_t room_bytes = 2 * json->room_bytes + count + 256;
        char *larger = room_bytes < json->room_bytes ? NULL : realloc(json->text, room_bytes);
        if (larger == NULL) {
            json->failed = true;
            return;
        }
        json->text = larger;
        json->room_bytes = room_bytes;
    }
    memcpy(json->text + json->length_bytes, bytes, count);
    json->length_bytes += count;
    json->text[json->length_bytes] = '\0';
}

static void append_text(struct json_text *json, const char *text) {
    append(json, text, strlen(text));
}

static void break_line(struct json_text *json) {
    if (json->line_depth != 0 && json->depth >= json->line_depth) return;
    append_text(json, "\n");
    for (int i = 0; i < json->depth; i++) append_text(json, "  ");
}

/* What goes between the value before and the next one. */
static void begin_value(struct json_text *json) {
    if (json->after_key) {
        json->after_key = false;
        return;
    }
    if (json->wants_comma) append_text(json, json->line_depth != 0 ? ", " : ",");
    if (json->depth > 0) break_line(json);
}

void json_open(struct json_text *json, char bracket) {
    begin_value(json);
    append(json, &bracket, 1);
    json->depth++;
    json->wants_comma = false;
}

void json_open_line(struct json_text *json, char bracket) {
    json_open(json, bracket);
    if (json->line_depth == 0) json->line_depth = json->depth;
}

void json_close(struct json_text *json, char bracket) {
    bool in_line = json->line_depth != 0;
    if (json->line_depth == json->depth) json->line_depth = 0;
    json->depth--;
    if (json->wants_comma && !in_line) break_line(json);
    append(json, &bracket, 1);
    json->wants_comma = true;
}

/* Length in bytes of the UTF-8 character that `text` begins with; 0: none does (overlong forms, surrogates and what
 * lies beyond U+10FFFF included). */
static size_t utf8_length(const unsigned char *text) {
    size_t length = text[0] < 0x80   ? 1
                    : text[0] < 0xc2 ? 0
                    : text[0] < 0xe0 ? 2
                    : text[0] < 0xf0 ? 3
                    : text[0] < 0xf5 ? 4
                                     : 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    if (text[0] == 0xe0 && text[1] < 0xa0) return 0;
    if (text[0] == 0xed && text[1] > 0x9f) return 0;
    if (text[0] == 0xf0 && text[1] < 0x90) return 0;
    if (text[0] == 0xf4 && text[1] > 0x8f) return 0;
    return length;
}

static void append_quoted(struct json_text *json, const char *string) {
    append_text(json, "\"");
    for (const unsigned char *c = (const unsigned char *)string; *c != '\0';) {
        size_t length = utf8_length(c);
        char escape[8];
        if (length == 0) {
            append_text(json, REPLACEMENT);
            c++;
            continue;
        }
        if (*c == '"' || *c == '\\') append_text(json, "\\");
        if (*c < 0x20 || *c == 0x7f) {
            snprintf(escape, sizeof escape, "\\u%04x", *c);
            append_text(json, escape);
        } else {
            append(json, (const char *)c, length);
        }
        c += length;
    }
    append_text(json, "\"");
}

void json_key(struct json_text *json, const char *key) {
    begin_value(json);
    append_quoted(json, key);
    append_text(json, ": ");
    json->after_key = true;
}

static void append_value(struct json_text *json, const char *text) {
    begin_value(json);
    append_text(json, text);
    json->wants_comma = true;
}

void json_string(struct json_text *json, const char *string) {
    if (string == NULL) {
        append_value(json, "null");
        return;
    }
    begin_value(json);
    append_quoted(json, string);
    json->wants_comma = true;
}

/* Turns the locale's decimal separator, one or more bytes that no number has otherwise, into a point. */
static void make_point(char *number) {
    char *out = number;
    bool in_separator = false;
    for (const char *c = number; *c != '\0'; c++) {
        bool plain = (*c >= '0' && *c <= '9') || *c == '-' || *c == '+' || *c == 'e';
        if (plain) *out++ = *c;
        if (!plain && !in_separator) *out++ = '.';
        in_separator = !plain;
    }
    *out = '\0';
}

void json_number(struct json_text *json, double number) {
    char text[NUMBER_ROOM];
    if (!isfinite(number)) {
        append_value(json, "null");
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number) break;
    }
    make_point(text);
    append_value(json, text);
}

void json_integer(struct json_text *json, int64_t number) {
    char text[NUMBER_ROOM];
    snprintf(text, sizeof text, "%" PRId64, number);
    append_value(json, text);
}

void json_boolean(struct json_text *json, bool value) {
    append_value(json, value ? "true" : "false");
}

char *json_text_take(struct json_text *json) {
    append_text(json, "\n");
    char *text = json->text;
    if (json->failed) {
        free(text);
        text = NULL;
    }
    *json = (struct json_text){0};
    return text;
}

void json_text_free(struct json_text *json) {
    free(json->text);
    *json = (struct json_text){0};
}
