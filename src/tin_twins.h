/* Points that rounding has put into one place. Pure. */
#ifndef SCREE_SRC_TIN_TWINS_H
#define SCREE_SRC_TIN_TWINS_H

#include "lod/tin_lattice.h"

/* Gives points in one place one height: the lowest, as of clouds' points that are in one place from the start. They
 * stay as many as they are. */
enum scree_status tin_twins_level(struct scree_memory *memory, struct tin_post *posts, uint32_t count,
                                  struct scree_error *error);

#endif
