/* PLY: a header of lines that says what elements follow and of which numbers they are made; then these numbers, as text
 * or binary in either byte order. Elements and properties that are neither points nor corners of faces are stepped
 * over. (Turk, "The PLY Polygon File Format", 1994.) */
#include "src/mesh_parts.h"

#include <inttypes.h>
#include <string.h>

#define MOST_ELEMENTS   16
#define MOST_PROPERTIES 128 /* of all elements */
#define MOST_WHOLE      0x1p53

enum role { OTHER, X, Y, Z, CORNERS };

enum number_kind { UNSIGNED, SIGNED, FLOAT };

struct number_type {
    const char *names[2];
    enum number_kind kind;
    size_t size_bytes;
};

static const struct number_type number_types[] = {
    {{"char", "int8"}, SIGNED, 1},       {{"uchar", "uint8"}, UNSIGNED, 1}, {{"short", "int16"}, SIGNED, 2},
    {{"ushort", "uint16"}, UNSIGNED, 2}, {{"int", "int32"}, SIGNED, 4},     {{"uint", "uint32"}, UNSIGNED, 4},
    {{"float", "float32"}, FLOAT, 4},    {{"double", "float64"}, FLOAT, 8},
};

struct property {
    enum role role;
    const struct number_type *type, *count_type; /* of its numbers; of a list's length, NULL: no list */
};

struct element {
    struct mesh_word name;
    int64_t count;
    size_t first, end; /* of its properties */
};

enum encoding { TEXT, LITTLE, BIG };

struct ply {
    struct mesh_source *source;
    struct mesh_text text; /* binary data begin at `text.at`, too */
    enum encoding encoding;
    size_t element_count, property_count;
    struct element elements[MOST_ELEMENTS];
    struct property properties[MOST_PROPERTIES];
};

/* ---- header ---- */

static const struct number_type *find_type(struct mesh_word word) {
    for (size_t i = 0; i < sizeof number_types / sizeof *number_types; i++)
        if (mesh_word_is(word, number_types[i].names[0]) || mesh_word_is(word, number_types[i].names[1]))
            return &number_types[i];
    return NULL;
}

static enum scree_status take_format(struct ply *ply, struct scree_error *error) {
    struct mesh_word word = mesh_line_word(&ply->text);
    if (mesh_word_is(word, "ascii"))
        ply->encoding = TEXT;
    else if (mesh_word_is(word, "binary_little_endian"))
        ply->encoding = LITTLE;
    else if (mesh_word_is(word, "binary_big_endian"))
        ply->encoding = BIG;
    else
        return mesh_fail_line(ply->source, &ply->text, "a format that PLY does not have", error);
    return SCREE_OK;
}

static enum scree_status take_element(struct ply *ply, struct scree_error *error) {
    struct element element = {.first = ply->property_count, .end = ply->property_count};
    element.name = mesh_line_word(&ply->text);
    if (element.name.length == 0 || !mesh_word_integer(mesh_line_word(&ply->text), &element.count) || element.count < 0)
        return mesh_fail_line(ply->source, &ply->text, "an element wants a name and a number", error);
    if (ply->element_count == MOST_ELEMENTS) return mesh_fail_line(ply->source, &ply->text, "too many elements", error);
    ply->elements[ply->element_count++] = element;
    return SCREE_OK;
}

static enum role role_of(struct mesh_word element, struct mesh_word name, bool is_list) {
    if (mesh_word_is(element, "vertex") && !is_list) {
        if (mesh_word_is(name, "x")) return X;
        if (mesh_word_is(name, "y")) return Y;
        if (mesh_word_is(name, "z")) return Z;
    }
    return mesh_word_is(element, "face") && is_list &&
                   (mesh_word_is(name, "vertex_indices") || mesh_word_is(name, "vertex_index"))
               ? CORNERS
               : OTHER;
}

static enum scree_status take_property(struct ply *ply, struct scree_error *error) {
    struct property property = {0};
    struct mesh_word word = mesh_line_word(&ply->text);
    bool is_list = mesh_word_is(word, "list");
    if (is_list) {
        property.count_type = find_type(mesh_line_word(&ply->text));
        word = mesh_line_word(&ply->text);
    }
    property.type = find_type(word);
    struct mesh_word name = mesh_line_word(&ply->text);
    if (property.type == NULL || (is_list && (property.count_type == NULL || property.count_type->kind == FLOAT)) ||
        name.length == 0)
        return mesh_fail_line(ply->source, &ply->text, "a property wants types that PLY has, and a name", error);
    if (ply->element_count == 0 || ply->property_count == MOST_PROPERTIES)
        return mesh_fail_line(ply->source, &ply->text, "a property without an element, or one too many", error);
    struct element *element = &ply->elements[ply->element_count - 1];
    property.role = role_of(element->name, name, is_list);
    ply->properties[ply->property_count++] = property;
    element->end = ply->property_count;
    return SCREE_OK;
}

/* Up to the first byte behind the header. */
static enum scree_status read_header(struct ply *ply, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    bool has_format = false;
    if (!mesh_word_is(mesh_line_word(&ply->text), "ply"))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: does not begin as PLY does", ply->source->name);
    while (status == SCREE_OK && ply->text.at < ply->text.end) {
        mesh_skip_line(&ply->text);
        struct mesh_word word = mesh_line_word(&ply->text);
        if (mesh_word_is(word, "end_header")) {
            mesh_skip_line(&ply->text);
            return has_format ? SCREE_OK : mesh_fail_line(ply->source, &ply->text, "the header has no format", error);
        }
        if (mesh_word_is(word, "format")) {
            status = take_format(ply, error);
            has_format = true;
        } else if (mesh_word_is(word, "element")) {
            status = take_element(ply, error);
        } else if (mesh_word_is(word, "property")) {
            status = take_property(ply, error);
        } else if (word.length > 0 && !mesh_word_is(word, "comment") && !mesh_word_is(word, "obj_info")) {
            status = mesh_fail_line(ply->source, &ply->text, "a word that PLY does not have", error);
        }
    }
    return status != SCREE_OK ? status : mesh_fail_line(ply->source, &ply->text, "the header has no end", error);
}

/* ---- numbers ---- */

static bool take_binary(struct ply *ply, const struct number_type *type, double *number) {
    const unsigned char *bytes = (const unsigned char *)ply->text.at;
    const size_t size = type->size_bytes;
    uint64_t bits = 0;
    if ((size_t)(ply->text.end - ply->text.at) < size) return false;
    for (size_t i = 0; i < size; i++) bits = bits << 8 | bytes[ply->encoding == BIG ? i : size - 1 - i];
    ply->text.at += size;
    if (type->kind == FLOAT && size == sizeof(float)) {
        uint32_t low = (uint32_t)bits;
        float narrow;
        memcpy(&narrow, &low, sizeof narrow);
        *number = narrow;
    } else if (type->kind == FLOAT) {
        memcpy(number, &bits, sizeof *number);
    } else {
        const double range = (double)(UINT64_C(1) << (8 * size)), value = (double)bits;
        *number = type->kind == SIGNED && 2 * value >= range ? value - range : value;
    }
    return true;
}

static bool take_number(struct ply *ply, const struct number_type *type, double *number) {
    return ply->encoding == TEXT ? mesh_word_number(mesh_next_word(&ply->text), number)
                                 : take_binary(ply, type, number);
}

static enum scree_status fail_data(const struct ply *ply, const struct element *element, int64_t at,
                                   struct scree_error *error) {
    return scree_fail(error, SCREE_E_CORRUPT,
                      "%s: %.*s %" PRId64 " of %" PRId64 " is cut off, or holds what is no number", ply->source->name,
                      (int)(element->name.length < 40 ? element->name.length : 40), element->name.start, at + 1,
                      element->count);
}

/* At least so many bytes are one of an element. */
static size_t least_bytes(const struct ply *ply, const struct element *element) {
    size_t least = 0;
    for (size_t i = element->first; i < element->end; i++) {
        const struct property *property = &ply->properties[i];
        least += ply->encoding == TEXT
                     ? 2
                     : (property->count_type != NULL ? property->count_type : property->type)->size_bytes;
    }
    return least;
}

/* One list, whose numbers are a face's corners or nothing that counts. False: it is not all there. */
static bool take_list(struct ply *ply, const struct property *property, enum scree_status *status,
                      struct scree_error *error) {
    double length, number;
    if (!take_number(ply, property->count_type, &length) || !(length >= 0)) return false;
    mesh_begin_face(ply->source);
    for (double i = 0; i < length && *status == SCREE_OK; i++) {
        if (!take_number(ply, property->type, &number)) return false;
        if (property->role != CORNERS) continue;
        if (!(number >= -MOST_WHOLE && number <= MOST_WHOLE)) return false;
        *status = mesh_add_corner(ply->source, (int64_t)number, error);
    }
    return true;
}

static enum scree_status read_element(struct ply *ply, const struct element *element, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    const bool are_points = mesh_word_is(element->name, "vertex");
    for (int64_t at = 0; at < element->count && status == SCREE_OK; at++) {
        double xyz[3] = {0}, number;
        for (size_t i = element->first; i < element->end && status == SCREE_OK; i++) {
            const struct property *property = &ply->properties[i];
            bool is_there = property->count_type != NULL ? take_list(ply, property, &status, error)
                                                         : take_number(ply, property->type, &number);
            if (!is_there) return fail_data(ply, element, at, error);
            if (property->role >= X && property->role <= Z) xyz[property->role - X] = number;
        }
        if (are_points && status == SCREE_OK) status = mesh_add_point(ply->source, xyz, error);
    }
    return status;
}

static enum scree_status check_element(const struct ply *ply, const struct element *element,
                                       struct scree_error *error) {
    size_t least = least_bytes(ply, element), left = (size_t)(ply->text.end - ply->text.at) + 1;
    int found[CORNERS + 1] = {0};
    for (size_t i = element->first; i < element->end; i++) found[ply->properties[i].role]++;
    if (mesh_word_is(element->name, "vertex") && (found[X] != 1 || found[Y] != 1 || found[Z] != 1))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: its points have not just one x, y and z each",
                          ply->source->name);
    if (least > 0 && (uint64_t)element->count > left / least)
        return scree_fail(error, SCREE_E_CORRUPT, "%s: says it has %" PRId64 " of \"%.*s\", but is too short for them",
                          ply->source->name, element->count,
                          (int)(element->name.length < 40 ? element->name.length : 40), element->name.start);
    return SCREE_OK;
}

/* Elements behind points and faces do not matter, nor whether they are whole. */
static enum scree_status read_elements(struct ply *ply, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    bool has_points = false, has_faces = false;
    for (size_t i = 0; i < ply->element_count && status == SCREE_OK && !(has_points && has_faces); i++) {
        const struct element *element = &ply->elements[i];
        bool are_points = mesh_word_is(element->name, "vertex"), are_faces = mesh_word_is(element->name, "face");
        if (element->first == element->end) continue;
        status = check_element(ply, element, error);
        if (status == SCREE_OK && (are_points || are_faces))
            status = mesh_reserve(ply->source, are_points ? (uint64_t)element->count : 0,
                                  are_faces ? (uint64_t)element->count : 0, error);
        if (status == SCREE_OK) status = read_element(ply, element, error);
        has_points |= are_points;
        has_faces |= are_faces;
    }
    return status;
}

enum scree_status mesh_read_ply(struct mesh_source *source, struct scree_error *error) {
    struct ply ply = {.source = source, .text = mesh_text_of(source)};
    ply.text.has_no_comment = true;
    enum scree_status status = read_header(&ply, error);
    return status == SCREE_OK ? read_elements(&ply, error) : status;
}
