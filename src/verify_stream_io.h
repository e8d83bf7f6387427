/* Walks a set of streams and checks every promise that needs no source: each stream at every rung, tiles against their
 * children, neighbours against each other, and scree.json against the files. Memory holds the list of tiles, the
 * borders of one row of them, and one tile with a child. */
#ifndef SCREE_VERIFY_STREAM_IO_H
#define SCREE_VERIFY_STREAM_IO_H

#include "src/stream_set_io.h"
#include "src/verify_report.h"
#include "src/verify_terrain_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Fails only for want of memory; files that cannot be read are broken promises. */
enum scree_status verify_streams(struct scree_memory *memory, const struct stream_set *set, verify_progress *progress,
                                 void *context, struct verify_report *report, struct scree_error *error);

#endif
