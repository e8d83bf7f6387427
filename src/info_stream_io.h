/* What scree info tells of streams: of one tile, a table of its rungs; of a set, one of its zooms. */
#ifndef SCREE_INFO_STREAM_IO_H
#define SCREE_INFO_STREAM_IO_H

#include "src/json_text.h"
#include "src/stream_set_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Reads the header of `path` and prints it, or puts it into `json` (NULL: prints). A file that lacks its end is told of
 * and no failure: the rungs whose bytes are there can be played. */
enum scree_status info_stream_file(struct scree_memory *memory, const char *path, struct json_text *json,
                                   struct scree_error *error);

/* The same for the set that `path` names. In `json` it is an object without a key. */
enum scree_status info_stream_set(struct scree_memory *memory, const char *path, struct json_text *json,
                                  struct scree_error *error);

#endif
