/* What layer.json promises, against the list of files and the sums over them. Pure. */
#ifndef SCREE_VERIFY_LAYER_H
#define SCREE_VERIFY_LAYER_H

#include "src/terrain_set_io.h"
#include "src/verify_report.h"
#include "stream/memory.h"
#include <scree/error.h>

/* PROMISE_LAYER, PROMISE_AVAILABLE and PROMISE_ANCESTORS. Fails only for want of memory. */
enum scree_status verify_layer_tiles(struct scree_memory *memory, const struct terrain_set *set,
                                     struct verify_report *report, struct scree_error *error);

/* PROMISE_COUNTS and PROMISE_LADDER, once every tile was read; for terrain of ours. */
void verify_layer_counts(const struct layer_info *layer, struct verify_report *report);

#endif
