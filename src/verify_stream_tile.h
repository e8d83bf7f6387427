/* Does one stream keep the promises that it can keep alone? Pure, and exact: the plane is judged in lattice steps. */
#ifndef SCREE_VERIFY_STREAM_TILE_H
#define SCREE_VERIFY_STREAM_TILE_H

#include "src/scree_read_io.h"
#include "src/verify_report.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/player.h>

/* PROMISE_STREAM_PLACE and PROMISE_STREAM_SCALES: the header against the manifest and the tile's name. False when the
 * tile is not where its name says, so that nothing else about it can be judged. */
bool verify_stream_header(const struct scree_stream_header *header, const struct scree_info *info, struct tile_id id,
                          struct verify_report *report);

/* PROMISE_STREAM_FORMAT, PROMISE_ORIENTATION and PROMISE_COVER at every rung of a stream that has arrived as a whole:
 * counts are those of the header, every triangle has a positive area, and the areas add up to the tile's; at the
 * coarsest and at the finest rung, every edge but those along the border has its opposite as well, so that the
 * triangles cover the tile exactly once there (and in between, as each split fills what it takes out). The player is
 * left at its finest rung. Fails only for want of memory. */
enum scree_status verify_stream_rungs(struct scree_memory *memory, struct scree_player *player, struct tile_id id,
                                      struct verify_report *report, struct scree_error *error);

#endif
