/* What the readers of mesh files share: words of text, and a TIN that grows. Only src/mesh_*.c include this. Pure.
 *
 * No count of a file is believed before as many bytes are left as it needs. */
#ifndef SCREE_MESH_PARTS_H
#define SCREE_MESH_PARTS_H

#include "lod/tin.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A file in memory and the TIN that it becomes; zero what is not named in `mesh_start`. */
struct mesh_source {
    const char *name; /* for errors */
    const unsigned char *bytes;
    size_t size_bytes;
    struct tin *tin;
    size_t point_capacity, triangle_capacity;
    int64_t first, previous; /* corners of the face that grows */
    uint32_t face_corners;
};

enum scree_status mesh_read_ply(struct mesh_source *source, struct scree_error *error);
enum scree_status mesh_read_obj(struct mesh_source *source, struct scree_error *error);
enum scree_status mesh_read_off(struct mesh_source *source, struct scree_error *error);
enum scree_status mesh_read_stl(struct mesh_source *source, struct scree_error *error);
enum scree_status mesh_read_om(struct mesh_source *source, struct scree_error *error); /* by OpenMesh; catches */

/* Room for points and triangles that the bytes left can hold. */
enum scree_status mesh_reserve(struct mesh_source *source, uint64_t point_count, uint64_t triangle_count,
                               struct scree_error *error);

enum scree_status mesh_add_point(struct mesh_source *source, const double xyz[3], struct scree_error *error);

/* A face begins, and its corners follow: numbers of points from 0, which may come later. Below three it is none. */
void mesh_begin_face(struct mesh_source *source);
enum scree_status mesh_add_corner(struct mesh_source *source, int64_t corner, struct scree_error *error);

/* Are there triangles, and a point for each of their corners? */
enum scree_status mesh_check(const struct mesh_source *source, struct scree_error *error);

/* ---- text ---- */

/* Words with blanks, tabs or returns between them; what is behind # is a comment. */
struct mesh_text {
    const char *at, *end;
    uint64_t line;       /* of `at`, from 1 */
    bool has_no_comment; /* # is a character like others */
};

struct mesh_word {
    const char *start;
    size_t length; /* 0: there is none */
};

struct mesh_text mesh_text_of(const struct mesh_source *source);

/* The next word of this line, or of the file. */
struct mesh_word mesh_line_word(struct mesh_text *text);
struct mesh_word mesh_next_word(struct mesh_text *text);

/* Goes behind the end of this line. */
void mesh_skip_line(struct mesh_text *text);

/* Regardless of case. */
bool mesh_word_is(struct mesh_word word, const char *expected);

/* Whether the whole word is a finite number, or an integer below 2^53. */
bool mesh_word_number(struct mesh_word word, double *number);
bool mesh_word_integer(struct mesh_word word, int64_t *integer);

/* Three numbers of this line are a point. */
enum scree_status mesh_take_point(struct mesh_source *source, struct mesh_text *text, struct scree_error *error);

/* SCREE_E_CORRUPT at the line where the text is. */
enum scree_status mesh_fail_line(const struct mesh_source *source, const struct mesh_text *text, const char *what,
                                 struct scree_error *error);

#ifdef __cplusplus
}
#endif
#endif
