/* A player whose memory its maker sets up and looks at: for tests and for the programs of the project. */
#ifndef SCREE_STREAM_PLAYER_H
#define SCREE_STREAM_PLAYER_H

#include "stream/memory.h"
#include "stream/playback.h"

/* As scree_player_new, with a budget (its limit, its failures asked for) that the player goes on with as its own. */
enum scree_status player_new_in(const struct scree_memory *memory, const struct scree_player_options *options,
                                struct scree_player **player, struct scree_error *error);
const struct scree_memory *player_memory(const struct scree_player *player);
const struct playback *player_playback(const struct scree_player *player);

#endif
