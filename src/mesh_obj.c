/* Wavefront OBJ: "v" and "f" lines count; all others are normals, textures, groups and the like. Faces have corners
 * "7", "7/3", "7//2" or "7/3/2"; -1 is the last point before the face. */
#include "src/mesh_parts.h"

#include <string.h>

static enum scree_status take_face(struct mesh_source *source, struct mesh_text *text, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct mesh_word word;
    mesh_begin_face(source);
    while (status == SCREE_OK && (word = mesh_line_word(text)).length > 0) {
        const char *slash = memchr(word.start, '/', word.length);
        int64_t corner;
        if (slash != NULL) word.length = (size_t)(slash - word.start);
        if (!mesh_word_integer(word, &corner) || corner == 0)
            return mesh_fail_line(source, text, "a face wants numbers of points, from 1", error);
        status = mesh_add_corner(source, corner > 0 ? corner - 1 : source->tin->point_count + corner, error);
    }
    return status;
}

enum scree_status mesh_read_obj(struct mesh_source *source, struct scree_error *error) {
    struct mesh_text text = mesh_text_of(source);
    enum scree_status status = SCREE_OK;
    while (status == SCREE_OK && text.at < text.end) {
        struct mesh_word word = mesh_line_word(&text);
        if (mesh_word_is(word, "v")) status = mesh_take_point(source, &text, error);
        if (mesh_word_is(word, "f")) status = take_face(source, &text, error);
        mesh_skip_line(&text);
    }
    return status;
}
