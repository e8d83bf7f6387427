#include "src/cloud_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define LONGEST_WORD 32

static const char *const names[3][5] = {
    {"x", "easting", "longitude", "lon", "long"},
    {"y", "northing", "latitude", "lat", "lat"},
    {"z", "height", "elevation", "elev", "h"},
};

/* The next field of a line: blanks and tabs part fields, and so does a comma or semicolon, alone or among them. False:
 * there is none. */
static bool next_field(const char **at, const char **field, size_t *length) {
    const char *p = *at + strspn(*at, " \t\r");
    if (*p == '\0') return false;
    *field = p;
    *length = strcspn(p, " \t\r,;");
    p += *length;
    p += strspn(p, " \t\r");
    if (*p == ',' || *p == ';') p++;
    *at = p;
    return true;
}

static bool is_number(const char *field, size_t length, double *number) {
    char word[LONGEST_WORD + 1], *end;
    if (length == 0 || length > LONGEST_WORD) return false;
    memcpy(word, field, length);
    word[length] = '\0';
    *number = strtod(word, &end);
    return *end == '\0' && isfinite(*number);
}

static bool is_name(const char *field, size_t length, int axis) {
    if (length >= 2 && field[0] == '"' && field[length - 1] == '"') field++, length -= 2;
    for (int i = 0; i < 5; i++)
        if (strlen(names[axis][i]) == length && strncasecmp(names[axis][i], field, length) == 0) return true;
    return false;
}

static enum scree_status take_names(struct cloud_text *text, const char *line, struct scree_error *error) {
    const char *field;
    size_t length;
    for (int axis = 0; axis < 3; axis++) text->column[axis] = -1;
    for (int column = 0; next_field(&line, &field, &length); column++)
        for (int axis = 0; axis < 3; axis++)
            if (text->column[axis] < 0 && is_name(field, length, axis)) text->column[axis] = column;
    if (text->column[0] < 0 || text->column[1] < 0 || text->column[2] < 0)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: line %" PRIu64 " is neither three numbers nor names of columns with x, y and z",
                          text->name, text->line);
    return SCREE_OK;
}

enum scree_status cloud_text_take(struct cloud_text *text, const char *line, bool *has_point, struct cloud_point *point,
                                  struct scree_error *error) {
    const char *field, *at = line;
    size_t length;
    double value[3] = {0}, number;
    int found = 0;
    text->line++;
    *has_point = false;
    if (text->line == 1 && strncmp(at, "\xEF\xBB\xBF", 3) == 0) at = line += 3; /* UTF-8's mark */
    const char *first = line + strspn(line, " \t\r");
    if (*first == '\0' || *first == '#' || strncmp(first, "//", 2) == 0) return SCREE_OK;
    if (!text->has_begun) {
        text->has_begun = true;
        for (int axis = 0; axis < 3; axis++) text->column[axis] = axis;
        next_field(&at, &field, &length);
        if (!is_number(field, length, &number)) return take_names(text, line, error);
        at = line;
    }
    for (int column = 0; found < 3 && next_field(&at, &field, &length); column++)
        for (int axis = 0; axis < 3; axis++) {
            if (text->column[axis] != column) continue;
            if (!is_number(field, length, &value[axis]))
                return scree_fail(error, SCREE_E_CORRUPT, "%s: line %" PRIu64 ": column %d holds no number", text->name,
                                  text->line, column + 1);
            found++;
        }
    if (found < 3)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: line %" PRIu64 " is too short: it lacks x, y or z", text->name,
                          text->line);
    *point = (struct cloud_point){value[0], value[1], value[2]};
    *has_point = true;
    return SCREE_OK;
}
