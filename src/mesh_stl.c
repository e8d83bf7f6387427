/* STL, text or binary. What has the size that its number of triangles asks for is binary, whatever its first word:
 * many writers begin binary files with "solid". */
#include "src/mesh_parts.h"
#include "stream/cursor.h"

#include <inttypes.h>
#include <string.h>

#define HEADER_BYTES   80
#define TRIANGLE_BYTES 50 /* a normal, three points, two bytes of anything */

static enum scree_status add_own_corner(struct mesh_source *source, struct scree_error *error) {
    return mesh_add_corner(source, source->tin->point_count - 1, error);
}

static enum scree_status read_binary(struct mesh_source *source, uint32_t count, struct scree_error *error) {
    struct scree_reader reader = scree_reader(source->bytes, source->size_bytes);
    enum scree_status status = mesh_reserve(source, 3 * (uint64_t)count, count, error);
    scree_read_bytes(&reader, HEADER_BYTES + sizeof count);
    for (uint32_t t = 0; t < count && status == SCREE_OK; t++) {
        scree_read_bytes(&reader, 3 * sizeof(float));
        mesh_begin_face(source);
        for (int k = 0; k < 3 && status == SCREE_OK; k++) {
            double xyz[3];
            for (int axis = 0; axis < 3; axis++) xyz[axis] = scree_read_f32(&reader);
            status = mesh_add_point(source, xyz, error);
            if (status == SCREE_OK) status = add_own_corner(source, error);
        }
        scree_read_u16(&reader);
    }
    return status;
}

static enum scree_status read_text(struct mesh_source *source, struct scree_error *error) {
    struct mesh_text text = mesh_text_of(source);
    enum scree_status status = SCREE_OK;
    bool is_in_loop = false, has_ended = false;
    struct mesh_word word;
    text.has_no_comment = true;
    while (status == SCREE_OK && (word = mesh_next_word(&text)).length > 0) {
        has_ended = mesh_word_is(word, "endsolid");
        if (has_ended || mesh_word_is(word, "solid")) {
            mesh_skip_line(&text); /* a name */
        } else if (mesh_word_is(word, "facet")) {
            for (int i = 0; i < 4; i++) mesh_next_word(&text); /* "normal" and three numbers, which may be wrong */
        } else if (mesh_word_is(word, "loop")) {
            mesh_begin_face(source);
            is_in_loop = true;
        } else if (mesh_word_is(word, "endloop")) {
            if (!is_in_loop || source->face_corners != 3)
                return mesh_fail_line(source, &text, "a facet has other than three vertices", error);
            is_in_loop = false;
        } else if (mesh_word_is(word, "vertex")) {
            if (!is_in_loop) return mesh_fail_line(source, &text, "a vertex is outside of a loop", error);
            status = mesh_take_point(source, &text, error);
            if (status == SCREE_OK) status = add_own_corner(source, error);
        } else if (!mesh_word_is(word, "outer") && !mesh_word_is(word, "endfacet")) {
            return mesh_fail_line(source, &text, "a word that STL does not have", error);
        }
    }
    if (status == SCREE_OK && (is_in_loop || !has_ended))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: is cut off: it lacks its last \"endsolid\"", source->name);
    return status;
}

enum scree_status mesh_read_stl(struct mesh_source *source, struct scree_error *error) {
    struct scree_reader reader = scree_reader(source->bytes, source->size_bytes);
    struct mesh_text text = mesh_text_of(source);
    scree_read_bytes(&reader, HEADER_BYTES);
    uint32_t count = scree_read_u32(&reader);
    if (!reader.ran_out && scree_reader_left(&reader) == (uint64_t)count * TRIANGLE_BYTES)
        return read_binary(source, count, error);
    if (mesh_word_is(mesh_next_word(&text), "solid")) return read_text(source, error);
    if (reader.ran_out) return scree_fail(error, SCREE_E_CORRUPT, "%s: is too short for STL", source->name);
    return scree_fail(error, SCREE_E_CORRUPT,
                      "%s: is no STL, or cut off: %" PRIu32 " triangles take %" PRIu64 " bytes, but it has %zu",
                      source->name, count, HEADER_BYTES + 4 + (uint64_t)count * TRIANGLE_BYTES, source->size_bytes);
}
