/* Reading the manifests of both products with json-c: members by name and kind, never believed. What is of another
 * kind, out of range or not finite counts as not there. */
#ifndef SCREE_MANIFEST_READ_IO_H
#define SCREE_MANIFEST_READ_IO_H

#include "src/lattice.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>
#include <stdint.h>

struct json_object; /* of json-c */

/* NULL where there is none; the object's own. */
const char *manifest_text(struct json_object *parent, const char *name);
struct json_object *manifest_array(struct json_object *parent, const char *name);
struct json_object *manifest_object(struct json_object *parent, const char *name);

/* Numbers of any JSON kind; `otherwise` where there is none or it is not finite. */
double manifest_number(struct json_object *parent, const char *name, double otherwise);

/* A whole number within 0..highest, or -1. */
int64_t manifest_count(struct json_object *parent, const char *name, int64_t highest);

/* A whole number within low..high; false where there is none. */
bool manifest_integer(struct json_object *parent, const char *name, int64_t low, int64_t high, int64_t *number);

bool manifest_is_true(struct json_object *parent, const char *name);

/* Four numbers; false, and all 0, where they are not there. */
bool manifest_rectangle(struct json_object *parent, const char *name, double rectangle[4]);

/* A copy that is never NULL ("" for NULL), or NULL on SCREE_E_MEMORY. */
char *manifest_copy_text(struct scree_memory *memory, const char *text, struct scree_error *error);

/* The lattice that the members "profile" and "lattice" tell of; `where` ("scree." or "") goes before their names in an
 * error's line. */
enum scree_status manifest_read_lattice(struct json_object *parent, const char *where, struct lattice *lattice,
                                        struct scree_error *error);

/* Rectangles of tiles. */
struct layer_range { /* inclusive */
    uint32_t x_first, y_first, x_last, y_last;
};

struct manifest_ranges {
    uint32_t counts[MAX_ZOOM + 1];
    struct layer_range *ranges[MAX_ZOOM + 1];
};

/* Reads the lists of "available"; every range lies on the lattice. */
enum scree_status manifest_read_ranges(struct scree_memory *memory, struct json_object *available,
                                       const struct lattice *lattice, struct manifest_ranges *ranges,
                                       struct scree_error *error);
void manifest_ranges_free(struct scree_memory *memory, struct manifest_ranges *ranges);

/* Reads a file that holds one JSON object and hands it to `take`, whose failures are told with the file's name. */
typedef enum scree_status manifest_take(void *context, struct json_object *root, struct scree_error *error);
enum scree_status manifest_read(struct scree_memory *memory, const char *path, manifest_take *take, void *context,
                                struct scree_error *error);

#endif
