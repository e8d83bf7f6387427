#include "src/mesh_parts.h"
#include "src/mesh_file_read.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FARTHEST       1e15 /* as of clouds */
#define FIRST_COUNT    4096
#define MOST_TRIANGLES 1400000000 /* half-edges have 32 bits */
#define LONGEST_NUMBER 63
#define LARGEST_WHOLE  0x1p53

/* ---- the TIN ---- */

static enum scree_status grow(struct mesh_source *source, size_t point_capacity, size_t triangle_capacity,
                              struct scree_error *error) {
    struct tin *tin = source->tin;
    if (point_capacity > CLOUD_MOST_POINTS || triangle_capacity > MOST_TRIANGLES)
        return scree_fail(error, SCREE_E_LIMIT, "%s: has more than %d points or %d triangles", source->name,
                          CLOUD_MOST_POINTS, MOST_TRIANGLES);
    if (point_capacity > source->point_capacity) {
        struct cloud_point *points =
            scree_reallocate(tin->memory, tin->points, point_capacity, sizeof *points, "a mesh's points", error);
        if (points == NULL) return error->status;
        tin->points = points;
        source->point_capacity = point_capacity;
    }
    if (triangle_capacity > source->triangle_capacity) {
        uint32_t *corners = scree_reallocate(tin->memory, tin->corners, triangle_capacity, 3 * sizeof *corners,
                                             "a mesh's triangles", error);
        if (corners == NULL) return error->status;
        tin->corners = corners;
        source->triangle_capacity = triangle_capacity;
    }
    return SCREE_OK;
}

enum scree_status mesh_reserve(struct mesh_source *source, uint64_t point_count, uint64_t triangle_count,
                               struct scree_error *error) {
    return grow(source, point_count, triangle_count, error);
}

static size_t next_capacity(size_t capacity, size_t most) {
    size_t larger = capacity < FIRST_COUNT ? FIRST_COUNT : capacity + capacity / 2;
    return capacity < most && larger > most ? most : larger;
}

enum scree_status mesh_add_point(struct mesh_source *source, const double xyz[3], struct scree_error *error) {
    struct tin *tin = source->tin;
    if (!(fabs(xyz[0]) < FARTHEST && fabs(xyz[1]) < FARTHEST && fabs(xyz[2]) < FARTHEST))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: has a point at %g %g %g, which is no position on Earth",
                          source->name, xyz[0], xyz[1], xyz[2]);
    if (tin->point_count == source->point_capacity) {
        enum scree_status status =
            grow(source, next_capacity(source->point_capacity, CLOUD_MOST_POINTS), source->triangle_capacity, error);
        if (status != SCREE_OK) return status;
    }
    tin->points[tin->point_count++] = (struct cloud_point){xyz[0], xyz[1], xyz[2]};
    return SCREE_OK;
}

void mesh_begin_face(struct mesh_source *source) {
    source->face_corners = 0;
}

enum scree_status mesh_add_corner(struct mesh_source *source, int64_t corner, struct scree_error *error) {
    struct tin *tin = source->tin;
    if (corner < 0 || corner >= CLOUD_MOST_POINTS)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: a face has a corner at point %" PRId64 ", which there is not",
                          source->name, corner);
    if (++source->face_corners > MESH_MOST_CORNERS)
        return scree_fail(error, SCREE_E_UNSUPPORTED,
                          "%s: has a face with more than %d corners; cut its faces into triangles", source->name,
                          MESH_MOST_CORNERS);
    if (source->face_corners == 1) source->first = corner;
    if (source->face_corners > 2) {
        if (tin->triangle_count == source->triangle_capacity) {
            enum scree_status status =
                grow(source, source->point_capacity, next_capacity(source->triangle_capacity, MOST_TRIANGLES), error);
            if (status != SCREE_OK) return status;
        }
        uint32_t *corners = &tin->corners[3 * (size_t)tin->triangle_count++];
        corners[0] = (uint32_t)source->first;
        corners[1] = (uint32_t)source->previous;
        corners[2] = (uint32_t)corner;
    }
    source->previous = corner;
    return SCREE_OK;
}

enum scree_status mesh_check(const struct mesh_source *source, struct scree_error *error) {
    const struct tin *tin = source->tin;
    if (tin->triangle_count == 0)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: holds no triangles; points alone are read from LAS or text (.xyz, .csv)", source->name);
    for (size_t i = 0; i < 3 * (size_t)tin->triangle_count; i++)
        if (tin->corners[i] >= tin->point_count)
            return scree_fail(error, SCREE_E_CORRUPT,
                              "%s: a face has a corner at point %" PRIu32 ", counted from 0, but there are %" PRIu32,
                              source->name, tin->corners[i], tin->point_count);
    return SCREE_OK;
}

/* ---- text ---- */

struct mesh_text mesh_text_of(const struct mesh_source *source) {
    const char *bytes = (const char *)source->bytes;
    return (struct mesh_text){.at = bytes, .end = bytes + source->size_bytes, .line = 1};
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

struct mesh_word mesh_line_word(struct mesh_text *text) {
    while (text->at < text->end && is_blank(*text->at)) text->at++;
    if (text->at < text->end && *text->at == '#' && !text->has_no_comment)
        while (text->at < text->end && *text->at != '\n') text->at++;
    struct mesh_word word = {.start = text->at};
    while (text->at < text->end && !is_blank(*text->at) && *text->at != '\n') text->at++;
    word.length = (size_t)(text->at - word.start);
    return word;
}

struct mesh_word mesh_next_word(struct mesh_text *text) {
    for (;;) {
        struct mesh_word word = mesh_line_word(text);
        if (word.length > 0 || text->at == text->end) return word;
        text->at++;
        text->line++;
    }
}

void mesh_skip_line(struct mesh_text *text) {
    while (text->at < text->end && *text->at != '\n') text->at++;
    if (text->at == text->end) return;
    text->at++;
    text->line++;
}

bool mesh_word_is(struct mesh_word word, const char *expected) {
    return strlen(expected) == word.length && strncasecmp(word.start, expected, word.length) == 0;
}

bool mesh_word_number(struct mesh_word word, double *number) {
    char copy[LONGEST_NUMBER + 1], *end;
    if (word.length == 0 || word.length > LONGEST_NUMBER) return false;
    memcpy(copy, word.start, word.length);
    copy[word.length] = '\0';
    *number = strtod(copy, &end);
    return end == copy + word.length && isfinite(*number);
}

bool mesh_word_integer(struct mesh_word word, int64_t *integer) {
    double number;
    if (!mesh_word_number(word, &number) || fabs(number) >= LARGEST_WHOLE || number != floor(number)) return false;
    *integer = (int64_t)number;
    return true;
}

enum scree_status mesh_fail_line(const struct mesh_source *source, const struct mesh_text *text, const char *what,
                                 struct scree_error *error) {
    return scree_fail(error, SCREE_E_CORRUPT, "%s: line %" PRIu64 ": %s", source->name, text->line, what);
}

enum scree_status mesh_take_point(struct mesh_source *source, struct mesh_text *text, struct scree_error *error) {
    double xyz[3];
    for (int axis = 0; axis < 3; axis++)
        if (!mesh_word_number(mesh_line_word(text), &xyz[axis]))
            return mesh_fail_line(source, text, "a point wants three numbers", error);
    return mesh_add_point(source, xyz, error);
}
