/* Walks a terrain product and checks every promise that needs no source: each tile by itself, neighbours against each
 * other, and layer.json against the files. Memory holds the list of tiles and the borders of one row of them. */
#ifndef SCREE_VERIFY_TERRAIN_IO_H
#define SCREE_VERIFY_TERRAIN_IO_H

#include "src/terrain_set_io.h"
#include "src/verify_report.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Called now and then with the share that is done, 0..1; NULL: nobody wants to know. */
typedef void verify_progress(void *context, double share);

/* Fails only for want of memory; files that cannot be read are broken promises. */
enum scree_status verify_terrain(struct scree_memory *memory, const struct terrain_set *set, verify_progress *progress,
                                 void *context, struct verify_report *report, struct scree_error *error);

#endif
