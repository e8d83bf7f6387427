/* OFF as text: a first word that may announce colours, normals or textures ("COFF"), numbers of points and faces, one
 * line a point, of which three numbers count, and one a face. */
#include "src/mesh_parts.h"

#include <inttypes.h>

#define LEAST_POINT_BYTES 6 /* "0 0 0" and its line's end */
#define LEAST_FACE_BYTES  2

/* The number behind the first word; without one the file begins with it. */
static enum scree_status read_start(struct mesh_source *source, struct mesh_text *text, int64_t *point_count,
                                    struct scree_error *error) {
    static const char *const known[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    struct mesh_word word = mesh_next_word(text);
    if (mesh_word_integer(word, point_count)) return SCREE_OK;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (!mesh_word_is(word, known[i])) continue;
        word = mesh_next_word(text);
        if (mesh_word_is(word, "BINARY"))
            return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: is binary OFF; save it as text, or as PLY",
                              source->name);
        if (mesh_word_integer(word, point_count)) return SCREE_OK;
        return mesh_fail_line(source, text, "the numbers of points and faces are missing", error);
    }
    return scree_fail(error, SCREE_E_CORRUPT, "%s: does not begin as OFF does", source->name);
}

static enum scree_status read_face(struct mesh_source *source, struct mesh_text *text, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    int64_t corner_count, corner;
    if (!mesh_word_integer(mesh_next_word(text), &corner_count) || corner_count < 0)
        return mesh_fail_line(source, text, "a face is missing, or has no number of corners", error);
    mesh_begin_face(source);
    for (int64_t k = 0; k < corner_count && status == SCREE_OK; k++) {
        if (!mesh_word_integer(mesh_line_word(text), &corner))
            return mesh_fail_line(source, text, "a face has fewer corners than it says", error);
        status = mesh_add_corner(source, corner, error);
    }
    mesh_skip_line(text);
    return status;
}

enum scree_status mesh_read_off(struct mesh_source *source, struct scree_error *error) {
    struct mesh_text text = mesh_text_of(source);
    int64_t point_count, face_count;
    enum scree_status status = read_start(source, &text, &point_count, error);
    if (status != SCREE_OK) return status;
    if (!mesh_word_integer(mesh_next_word(&text), &face_count))
        return mesh_fail_line(source, &text, "the number of faces is missing", error);
    mesh_skip_line(&text);                          /* with the number of edges, which nobody needs */
    size_t left = (size_t)(text.end - text.at) + 1; /* the last line may lack its end */
    if (point_count < 0 || face_count < 0 || (uint64_t)point_count > left / LEAST_POINT_BYTES ||
        (uint64_t)face_count > left / LEAST_FACE_BYTES)
        return scree_fail(error, SCREE_E_CORRUPT,
                          "%s: says it has %" PRId64 " points and %" PRId64 " faces, but is too short for them",
                          source->name, point_count, face_count);
    status = mesh_reserve(source, (uint64_t)point_count, 0, error);
    for (int64_t i = 0; i < point_count && status == SCREE_OK; i++) {
        struct mesh_word word;
        do { /* to the line with the next point */
            struct mesh_text before = text;
            word = mesh_line_word(&text);
            if (word.length > 0)
                text = before;
            else
                mesh_skip_line(&text);
        } while (word.length == 0 && text.at < text.end);
        status = mesh_take_point(source, &text, error);
        mesh_skip_line(&text);
    }
    for (int64_t i = 0; i < face_count && status == SCREE_OK; i++) status = read_face(source, &text, error);
    return status;
}
