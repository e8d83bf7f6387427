/* What the features of a vector source mean for the filter: rules from attributes to uses of the ground. Pure.
 *
 * A rule a line: the use, the attribute, and the value it has to have; `*` is any value but an empty one. The first
 * rule that fits a feature counts. Empty lines, and what follows a #, are skipped.
 *
 *     bridge  bridge=yes
 *     road    highway=*
 *     water   natural=water
 */
#ifndef SCREE_LANDUSE_RULES_H
#define SCREE_LANDUSE_RULES_H

#include "stream/memory.h"
#include <scree/error.h>
#include <stddef.h>

enum landuse {
    LANDUSE_WATER,
    LANDUSE_SHORE,
    LANDUSE_RAILWAY,
    LANDUSE_BRIDGE,
    LANDUSE_ROAD,
    LANDUSE_FOREST,
    LANDUSE_COUNT /* none of them */
};

const char *landuse_name(enum landuse use);

struct landuse_rule {
    enum landuse use;
    const char *attribute, *value; /* value: NULL: any but an empty one */
};

struct landuse_rules {
    struct landuse_rule *rules;
    size_t count;
    char *text; /* what the rules point into */
};

/* Parses `size_bytes` bytes; `name` is for errors, which tell the line. NULL for `bytes` gives the rules that a feature
 * whose attribute `class` is the name of a use has that use. `rules` is to be freed in any case. */
enum scree_status landuse_rules_parse(struct scree_memory *memory, const char *name, const char *bytes,
                                      size_t size_bytes, struct landuse_rules *rules, struct scree_error *error);
void landuse_rules_free(struct scree_memory *memory, struct landuse_rules *rules);

#endif
